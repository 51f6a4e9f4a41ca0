//! `ContactPair`: a close pair of points, and how its gap changes as the bodies move.

use nalgebra::{DVector, Vector3};
use serde::{Deserialize, Serialize};

use super::Curvatures;
use super::Section;
use super::pair_vector::{PairMatrix, PairVector};
use crate::body::{Modes, RigidVector, Wrench};

/// What a body faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Partner {
    /// Another body, or an image of one across a periodic side.
    Body(usize),
    /// A side of the domain, by its number.
    Wall(usize),
}

/// A point of a body and the point of its partner that it is nearest to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPair {
    /// The body.
    pub body: usize,
    /// What it faces.
    pub partner: Partner,
    /// Distance along the normal (m); where the surfaces overlap, minus the depth.
    pub gap: f64,
    /// Unit normal out of the partner, into the body.
    pub normal: Vector3<f64>,
    /// From the centres of mass of body and partner to their points (m); zero for a wall.
    pub levers: [Vector3<f64>; 2],
    /// What of body and partner moves with their points, where they have coordinates.
    pub sections: [Option<Section>; 2],
    /// Curvatures of body and partner at their points.
    pub curvatures: Curvatures,
    /// Share of the law's force, from 0 to 1.
    pub weight: f64,
    /// The motions that bodies have; others change no gap and take no load.
    pub modes: Modes,
}

/// Regularity of a pair times the reach of the smaller body above which it has its full weight.
const REGULAR: f64 = 0.5;

/// Gives the pairs of points of one pair of surfaces their weights.
///
/// A pair ends where the minimum of the distance meets a maximum, as a hollow fills up that a body
/// rolls through. Its force must have faded before, or there may be no balance of forces at all.
/// The weight goes to zero there with the square of the regularity; the nearest pair, and all that
/// are as regular as that, have the weight one whatever their own regularity. `size` is the reach
/// of the smaller body (m).
pub(super) fn blend_weights(pairs: &mut [ContactPair], size: f64, range: f64) {
    let raw = |pair: &ContactPair| {
        let s = (pair.regularity() * size / REGULAR).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    let nearest = pairs.iter().map(|pair| pair.gap).fold(f64::INFINITY, f64::min);
    // A pair at the range has no force, and does not count
    let closeness = |pair: &ContactPair| (range - pair.gap) / (range - nearest);
    let largest = pairs.iter().map(|pair| raw(pair) * closeness(pair)).fold(0.0, f64::max);
    for pair in pairs {
        pair.weight = if largest > 0.0 { (raw(pair) / largest).min(1.0) } else { 1.0 };
    }
}

impl ContactPair {
    /// Whether a side of it moves with a section of a body with coordinates.
    #[must_use]
    pub fn moves_by_sections(&self) -> bool {
        self.sections.iter().any(Option::is_some)
    }

    /// From what moves with the points of body and partner to them (m): from the centres of mass, or from those of sections.
    fn arms(&self) -> [Vector3<f64>; 2] {
        let [body, partner] = self.sections.each_ref().map(Option::as_ref);
        let arm = |lever: Vector3<f64>, section: Option<&Section>| match section {
            Some(section) => lever - section.center,
            None => lever,
        };
        [arm(self.levers[0], body), arm(self.levers[1], partner)]
    }

    /// Derivatives of the gap by the displacements of the body and of its partner, of their sections where they have
    /// coordinates.
    ///
    /// They are also the directions of the load: the force times them acts on both.
    #[must_use]
    pub fn gradient(&self) -> [RigidVector; 2] {
        self.gradient_along(&self.normal)
    }

    /// Derivatives of the relative displacement of both points along a vector by the displacements of the body and of
    /// its partner; also the loads of that vector as a force on the body.
    #[must_use]
    pub fn gradient_along(&self, vector: &Vector3<f64>) -> [RigidVector; 2] {
        self.on_both(vector, &self.arms())
    }

    /// A force on the body, and the opposite one on its partner, at these levers.
    fn on_both(&self, force: &Vector3<f64>, levers: &[Vector3<f64>; 2]) -> [RigidVector; 2] {
        let [on_body, on_partner] = levers.map(|lever| lever.cross(force));
        [join(force, &on_body), join(&-force, &-on_partner)]
            .map(|gradient| self.modes.project(&gradient))
    }

    /// Both sides of [`Self::gradient_along`] in one vector.
    pub(in crate::contact) fn gradient_along_both(&self, vector: &Vector3<f64>) -> PairVector {
        let [body, partner] = self.gradient_along(vector);
        PairVector::from_fn(|i, _| if i < 6 { body[i] } else { partner[i - 6] })
    }

    /// Derivative of the gap by the motions of some bodies (ascending): body by body, and of each body
    /// motion by motion.
    #[must_use]
    pub fn gradient_by(&self, bodies: &[usize]) -> DVector<f64> {
        let mut gradient = DVector::zeros(self.modes.len() * bodies.len());
        let mut add = |body: usize, of_body: &RigidVector| {
            let Ok(index) = bodies.binary_search(&body) else { return };
            for (position, mode) in self.modes.iter().enumerate() {
                gradient[index * self.modes.len() + position] += of_body[mode];
            }
        };
        let [on_body, on_partner] = self.gradient();
        add(self.body, &on_body);
        if let Partner::Body(other) = self.partner {
            add(other, &on_partner);
        }
        gradient
    }

    /// Both sides of [`Self::gradient`] in one vector.
    pub(in crate::contact) fn gradient_of_both(&self) -> PairVector {
        self.gradient_along_both(&self.normal)
    }

    /// Derivative of [`Self::gradient`]: column j is its change by a displacement
    /// ([`crate::body::Pose::displaced`]) of component j.
    ///
    /// In the plane these are the second derivatives of the gap. In space displacements about
    /// different axes do not commute, and the matrix is not symmetric: its symmetric part is the
    /// second derivative along displacements. Zero for parallel surfaces, which have no definite
    /// points.
    #[must_use]
    pub fn gradient_derivative(&self) -> PairMatrix {
        let arms = self.arms();
        let mut matrix = self.curvatures.gradient_derivative(&self.normal, self.gap, &arms);
        let counts = |i: usize| self.modes.iter().any(|mode| mode.index() == i % 6);
        for i in (0..12).filter(|i| !counts(*i)) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
        }
        matrix
    }

    /// How far the pair is from one where minimum and maximum of the distance annihilate each other
    /// (1/m): zero there and positive at every minimum.
    #[must_use]
    pub fn regularity(&self) -> f64 {
        self.curvatures.regularity(self.gap)
    }

    /// Loads on the body and on its partner by a repulsive force (N; N/m planar), about their centres of mass.
    #[must_use]
    pub fn loads(&self, force: f64) -> [Wrench; 2] {
        let sides = self.on_both(&self.normal, &self.levers);
        // Projected last, since no motion means no load even by an infinite force
        sides.map(|side| Wrench::from_vector(&self.modes.project(&(side * force))))
    }

    /// The same of a force of any direction on the body (N; N/m planar).
    pub(in crate::contact) fn loads_along(&self, force: &Vector3<f64>) -> [Wrench; 2] {
        self.on_both(force, &self.levers).map(|side| Wrench::from_vector(&side))
    }
}

fn join(linear: &Vector3<f64>, angular: &Vector3<f64>) -> RigidVector {
    RigidVector::from_fn(|i, _| if i < 3 { linear[i] } else { angular[i - 3] })
}
