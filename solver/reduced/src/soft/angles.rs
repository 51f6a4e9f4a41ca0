//! `Angles`: angles between marks of a body in the plane, compared with those of a recording.

use alewife_solid::solid::Level;
use nalgebra::Vector2;

use super::Objective;

/// How a body is bent at a mark: from the line to it to the line from it, anticlockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bend {
    /// Nodes of the mark before, of the mark, and of the one after it.
    pub nodes: [usize; 3],
}

/// A bend and its derivatives by the places of its nodes.
struct BendAt {
    /// Angle (rad).
    angle: f64,
    /// By the places of the three nodes (rad/m).
    by: [Vector2<f64>; 3],
}

impl Bend {
    /// The angle (rad) with nodes at these places, two components each.
    #[must_use]
    pub fn angle(&self, places: &[f64]) -> f64 {
        self.at(places).angle
    }

    fn at(&self, places: &[f64]) -> BendAt {
        let [before, here, after] =
            self.nodes.map(|node| Vector2::new(places[2 * node], places[2 * node + 1]));
        let (to, from) = (here - before, after - here);
        let turned = |line: &Vector2<f64>| Vector2::new(-line.y, line.x) / line.norm_squared();
        let (by_to, by_from) = (-turned(&to), turned(&from));
        BendAt {
            angle: to.perp(&from).atan2(to.dot(&from)),
            by: [-by_to, by_to - by_from, by_from],
        }
    }
}

/// Squared differences (rad2) of bends from recorded ones, as changes from rest; frames are compared with levels as those
/// of [`super::Markers`] are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Angles {
    /// The bends.
    pub bends: Vec<Bend>,
    /// Weight of each of them.
    pub weights: Vec<f64>,
    /// Steps of a frame.
    pub substeps: usize,
    /// Changes (rad) by frame and bend; not a number where there is a gap.
    pub changes: Vec<Vec<f64>>,
}

impl Objective for Angles {
    fn at(
        &self,
        number: usize,
        level: &Level,
        rest: &[f64],
        by_places: &mut [f64],
        by_rest: &mut [f64],
    ) -> f64 {
        if number == 0 || self.bends.is_empty() {
            return 0.0;
        }
        let mut sum = 0.0;
        let recorded = &self.changes[number / self.substeps];
        for ((bend, weight), recorded) in self.bends.iter().zip(&self.weights).zip(recorded) {
            if recorded.is_nan() {
                continue;
            }
            let (now, begin) = (bend.at(&level.places), bend.at(rest));
            let apart = now.angle - begin.angle - recorded;
            sum += weight * apart * apart;
            for (nth, node) in bend.nodes.iter().enumerate() {
                for axis in 0..2 {
                    by_places[2 * node + axis] += 2.0 * weight * apart * now.by[nth][axis];
                    by_rest[2 * node + axis] -= 2.0 * weight * apart * begin.by[nth][axis];
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three marks: a line to the right that turns left by 30 degrees.
    #[test]
    fn a_bend_to_the_left_is_positive() {
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let places = [0.0, 0.0, 2.0, 0.0, 2.0 + 3.0 * cos, 3.0 * sin];
        let bend = Bend { nodes: [0, 1, 2] };
        assert!((bend.angle(&places) - 30f64.to_radians()).abs() < 1e-15);
        let mirrored: Vec<f64> =
            places.iter().enumerate().map(|(at, x)| if at % 2 == 1 { -x } else { *x }).collect();
        assert!((bend.angle(&mirrored) + 30f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn differences_of_angles_have_their_derivatives() {
        let angles = Angles {
            bends: vec![Bend { nodes: [0, 1, 2] }, Bend { nodes: [2, 3, 1] }],
            weights: vec![0.7, 2.0],
            substeps: 2,
            changes: vec![vec![0.0, 0.0], vec![0.2, -0.4]],
        };
        let rest = [0.1, 0.2, 1.1, -0.3, 2.0, 0.4, 2.5, 1.3];
        let places = [0.0, 0.1, 1.0, -0.2, 2.3, 0.3, 2.2, 1.5];
        let value = |rest: &[f64], places: &[f64], by_places: &mut [f64], by_rest: &mut [f64]| {
            let level = Level { places: places.to_vec(), velocities: vec![0.0; 8] };
            angles.at(3, &level, rest, by_places, by_rest)
        };
        let [mut by_places, mut by_rest] = [[0.0; 8]; 2];
        let here = value(&rest, &places, &mut by_places, &mut by_rest);
        assert!(here > 0.1);
        let step = 1e-6;
        let of = |rest: &[f64], places: &[f64]| value(rest, places, &mut [0.0; 8], &mut [0.0; 8]);
        for at in 0..8 {
            let moved = |from: &[f64; 8], by: f64| {
                let mut moved = *from;
                moved[at] += by;
                moved
            };
            let wanted = [step, -step].map(|by| of(&rest, &moved(&places, by)));
            let wanted_rest = [step, -step].map(|by| of(&moved(&rest, by), &places));
            let slope = |[above, below]: [f64; 2]| (above - below) / (2.0 * step);
            assert!((by_places[at] - slope(wanted)).abs() < 1e-8, "places {at}");
            assert!((by_rest[at] - slope(wanted_rest)).abs() < 1e-8, "rest {at}");
        }
    }
}
