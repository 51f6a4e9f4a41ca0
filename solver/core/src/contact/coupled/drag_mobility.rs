//! `DragMobility`: a first estimate of the mobility of bodies in contact: inertia, drag, and the films between them.
//!
//! It has to be of the right size only: secants correct it. In the plane, where loads are per length, the drag of spheres is
//! not even that for bodies much smaller or larger than the unit of length. Each body has
//! the drag of a sphere in an unbounded fluid, 6 pi mu R and 8 pi mu R^3 with its reach R, and a film of the
//! thickness g between surfaces with the mean relative curvature 1 / r resists their approach by
//! 6 pi mu r^2 / g, the leading term of lubrication between spheres (@kim1991).

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, Matrix6};

use super::secant_mobility::SecantMobility;
use crate::body::{Pose, RigidVector};
use crate::contact::{ContactPair, Gaps, Law, Partner};

/// Smallest thickness of a film over the range.
const THINNEST: f64 = 0.05;
/// Bodies within this times the range are in one cluster.
const NEAR: f64 = 2.0;
/// Singular value below which motions depend on each other, of a matrix scaled to a unit diagonal.
const DEPENDENT: f64 = 1e-10;

/// Inertia and damping of the bodies themselves, and the viscosity of the fluid they are in.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyDynamics {
    /// Leading coefficient of the backward difference: the factor of the new velocity in its rate (1/s).
    pub rate: f64,
    /// Mass matrix of each body in the world (kg, kg m2).
    pub inertia: Vec<Matrix6<f64>>,
    /// Load per velocity of each body from springs and dampers (N s/m, N m s/rad).
    pub resistance: Vec<RigidVector>,
    /// Dynamic viscosity of the fluid (Pa s), at rest where it depends on the rate of shear.
    pub viscosity: f64,
}

/// The bodies of an estimate.
pub(super) struct DragMobility<'a> {
    pub gaps: &'a dyn Gaps,
    pub law: &'a Law,
    /// Their numbers, ascending.
    pub bodies: &'a [usize],
    /// Their motions by the unknowns they depend on, a row each.
    pub motions: DMatrix<f64>,
    /// Of all bodies.
    pub dynamics: &'a BodyDynamics,
}

impl DragMobility<'_> {
    /// The estimate with all bodies in these poses.
    pub fn estimate(&self, poses: &[Pose]) -> SecantMobility {
        let pairs = self.near_pairs(poses);
        SecantMobility::new(self.mobility(&self.resistance(&pairs)), self.clusters(&pairs))
    }

    /// Velocities by loads, for a resistance of motions that are all free.
    pub fn mobility(&self, resistance: &DMatrix<f64>) -> DMatrix<f64> {
        let of_unknowns = self.motions.transpose() * resistance * &self.motions;
        let mobility = &self.motions * inverse(&of_unknowns) * self.motions.transpose();
        0.5 * (&mobility + mobility.transpose())
    }

    fn near_pairs(&self, poses: &[Pose]) -> Vec<ContactPair> {
        self.gaps.pairs(poses, NEAR * self.law.range())
    }

    /// Loads by velocities in motions that are all free, with all bodies in these poses.
    pub fn resistance_at(&self, poses: &[Pose]) -> DMatrix<f64> {
        self.resistance(&self.near_pairs(poses))
    }

    /// The mass matrix.
    pub fn inertia(&self) -> DMatrix<f64> {
        let modes = self.gaps.modes();
        let n = modes.len() * self.bodies.len();
        let mut inertia = DMatrix::zeros(n, n);
        for (index, &body) in self.bodies.iter().enumerate() {
            let first = modes.len() * index;
            for (i, row) in modes.iter().enumerate() {
                for (j, column) in modes.iter().enumerate() {
                    inertia[(first + i, first + j)] =
                        self.dynamics.inertia[body][(row.index(), column.index())];
                }
            }
        }
        inertia
    }

    fn resistance(&self, pairs: &[ContactPair]) -> DMatrix<f64> {
        let BodyDynamics { rate, viscosity, .. } = *self.dynamics;
        let modes = self.gaps.modes();
        let mut resistance = rate * self.inertia();
        for (index, &body) in self.bodies.iter().enumerate() {
            let own = &self.dynamics.resistance[body];
            let reach = self.gaps.reach(body);
            let drags = [6.0 * PI * viscosity * reach, 8.0 * PI * viscosity * reach.powi(3)];
            let first = modes.len() * index;
            for (i, row) in modes.iter().enumerate() {
                let drag = drags[usize::from(row.is_rotation())];
                resistance[(first + i, first + i)] += own[row] + drag;
            }
        }
        for pair in pairs.iter().filter(|pair| pair.curvatures.of_gap() > 0.0) {
            let gap = pair.gap.max(THINNEST * self.law.range());
            let film = 6.0 * PI * viscosity / (pair.curvatures.of_gap().powi(2) * gap);
            let gradient = pair.gradient_by(self.bodies);
            resistance += film * &gradient * gradient.transpose();
        }
        resistance
    }

    /// Rows of bodies that are near each other, or depend on the same unknowns.
    fn clusters(&self, pairs: &[ContactPair]) -> Vec<Vec<usize>> {
        let m = self.gaps.modes().len();
        let mut labels: Vec<usize> = (0..self.bodies.len()).collect();
        let mut join = |one: usize, other: usize| {
            let (kept, lost) = (labels[one], labels[other]);
            labels.iter_mut().filter(|label| **label == lost).for_each(|label| *label = kept);
        };
        let index = |body: usize| self.bodies.binary_search(&body).ok();
        for pair in pairs {
            let Partner::Body(other) = pair.partner else { continue };
            if let (Some(one), Some(other)) = (index(pair.body), index(other)) {
                join(one, other);
            }
        }
        for unknown in self.motions.column_iter() {
            let rows = unknown.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
            let bodies: Vec<usize> = rows.map(|(row, _)| row / m).collect();
            bodies.windows(2).for_each(|two| join(two[0], two[1]));
        }
        let of_label = |label: usize| -> Vec<usize> {
            let bodies = labels.iter().enumerate().filter(|(_, own)| **own == label);
            bodies.flat_map(|(index, _)| m * index..m * (index + 1)).collect()
        };
        (0..labels.len()).map(of_label).filter(|rows| !rows.is_empty()).collect()
    }
}

/// The inverse of a symmetric positive matrix, zero for combinations of motions that do nothing.
fn inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    if matrix.is_empty() {
        return matrix.clone();
    }
    let scales = DVector::from_fn(matrix.nrows(), |row, _| matrix[(row, row)].sqrt().recip());
    let scales = DMatrix::from_diagonal(&scales);
    let scaled = &scales * matrix * &scales;
    let inverse = scaled.pseudo_inverse(DEPENDENT).expect("the threshold is not negative");
    &scales * inverse * &scales
}
