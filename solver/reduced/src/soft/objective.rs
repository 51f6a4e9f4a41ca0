//! `Objective`: what a search makes small, of a motion, with its derivatives.

use alewife_solid::solid::Level;

use super::SoftError;

/// A sum over the levels of a motion.
pub trait Objective {
    /// The part of a level, number 0 at the start, with its derivatives added to `by_places` and, as far as it
    /// depends on the places at rest, to `by_rest`; all lists have all components.
    fn at(
        &self,
        number: usize,
        level: &Level,
        rest: &[f64],
        by_places: &mut [f64],
        by_rest: &mut [f64],
    ) -> f64;
}

/// Squared distances (m2) of nodes from where a recording has them, as displacements from rest:
/// the mark of frame i is compared at the end of each step that ends in it or at it, that is the level n with
/// the frame n / substeps (@du2021).
#[derive(Debug, Clone, PartialEq)]
pub struct Markers {
    /// Number of components of a place, D.
    pub dimension: usize,
    /// Nodes that carry marks.
    pub nodes: Vec<usize>,
    /// Weight of each of them.
    pub weights: Vec<f64>,
    /// The components that were recorded.
    pub axes: Vec<usize>,
    /// Steps of a frame.
    pub substeps: usize,
    /// Displacements (m) by frame, mark and recorded axis; not a number where there is a gap.
    pub displacements: Vec<Vec<Vec<f64>>>,
}

impl Markers {
    /// Checks that all lists fit.
    ///
    /// # Errors
    /// [`SoftError::Plan`] says which does not.
    pub fn check(&self, n_frames: usize) -> Result<(), SoftError> {
        let n = self.nodes.len();
        let wrong = |what: String| Err(SoftError::Plan(what));
        if self.weights.len() != n {
            return wrong(format!("{n} marks have {} weights", self.weights.len()));
        }
        if self.axes.iter().any(|axis| *axis >= self.dimension) {
            return wrong(format!("axes {:?} of {} are recorded", self.axes, self.dimension));
        }
        // The end of the last frame is one more
        if self.displacements.len() <= n_frames {
            return wrong(format!(
                "the control has {n_frames} frames, which end at frame {n_frames} of the record, and the \
                 record has {}: shorten the control",
                self.displacements.len()
            ));
        }
        for (frame, marks) in self.displacements.iter().enumerate() {
            if marks.len() != n || marks.iter().any(|mark| mark.len() != self.axes.len()) {
                return wrong(format!("frame {frame} of the record has not all marks and axes"));
            }
        }
        Ok(())
    }
}

impl Objective for Markers {
    fn at(
        &self,
        number: usize,
        level: &Level,
        rest: &[f64],
        by_places: &mut [f64],
        by_rest: &mut [f64],
    ) -> f64 {
        if number == 0 {
            return 0.0;
        }
        let mut sum = 0.0;
        let marks = &self.displacements[number / self.substeps];
        for ((node, weight), mark) in self.nodes.iter().zip(&self.weights).zip(marks) {
            for (axis, recorded) in self.axes.iter().zip(mark) {
                if recorded.is_nan() {
                    continue;
                }
                let component = self.dimension * node + axis;
                let apart = level.places[component] - rest[component] - recorded;
                sum += weight * apart * apart;
                by_places[component] += 2.0 * weight * apart;
                by_rest[component] -= 2.0 * weight * apart;
            }
        }
        sum
    }
}

/// How far (m) nodes get, on average along a direction, with the sign that makes a long way a small number.
#[derive(Debug, Clone, PartialEq)]
pub struct Travel {
    /// What the way of each frame counts.
    pub shares: Vec<f64>,
    /// Steps of a frame.
    pub substeps: usize,
    /// Nodes that count.
    pub nodes: Vec<usize>,
    /// The direction, D numbers.
    pub direction: Vec<f64>,
}

impl Travel {
    /// The way (m) of the nodes from places to others, all components each, on average along the direction.
    #[must_use]
    pub fn way(&self, from: &[f64], to: &[f64]) -> f64 {
        let along = |node: &usize| -> f64 {
            let first = self.direction.len() * node;
            let axes = self.direction.iter().enumerate();
            axes.map(|(axis, along)| along * (to[first + axis] - from[first + axis])).sum()
        };
        self.nodes.iter().map(along).sum::<f64>() / self.nodes.len() as f64
    }
}

impl Objective for Travel {
    fn at(
        &self,
        number: usize,
        level: &Level,
        rest: &[f64],
        by_places: &mut [f64],
        by_rest: &mut [f64],
    ) -> f64 {
        let mut sum = 0.0;
        // The sum of ways of steps, by the places between them; the start is at rest
        let share = |step: usize| self.shares.get(step / self.substeps).copied().unwrap_or(0.0);
        let counts = number.checked_sub(1).map_or(0.0, |before| share(before) - share(number));
        if counts != 0.0 {
            let weight = counts / self.nodes.len() as f64;
            for node in &self.nodes {
                for (axis, along) in self.direction.iter().enumerate() {
                    let component = self.direction.len() * node + axis;
                    sum -= weight * along * (level.places[component] - rest[component]);
                    by_places[component] -= weight * along;
                    by_rest[component] += weight * along;
                }
            }
        }
        sum
    }
}
