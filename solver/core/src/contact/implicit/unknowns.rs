//! The unknowns of a step with contact: velocities of bodies by row, and the poses they lead to.
//!
//! In the plane a pose is linear in the velocity. In space a body turns by the rotation vector
//! t = t_p + c (w - w_p), R = exp([t]) R_0, from the rotation R_0 before the step, as its backward
//! difference has it ([`Pose::advanced`]); R changes by the displacement J(t) dt with the left
//! Jacobian J of the rotations (@sola2018).

use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};

use super::placed::Placed;
use super::step::ContactStep;
use crate::body::{Mode, Pose, RigidVector, Twist};
use crate::contact::{ContactPair, PairMatrix, PairVector, Partner};

/// Angle below which the left Jacobian is taken from its series (rad).
const SMALL_ANGLE: f64 = 1e-2;

/// A row with what it counts in the displacements of both sides of a pair.
struct RowOfPair {
    row: usize,
    weights: PairVector,
}

impl ContactStep<'_> {
    /// Rows of rigid motions; those of all coordinates follow them.
    pub(super) fn n_rigid_rows(&self) -> usize {
        self.modes.len() * self.bodies.len()
    }

    pub(super) fn n_rows(&self) -> usize {
        self.n_rigid_rows() + self.elastic.map_or(0, |elastic| elastic.n_coordinates())
    }

    /// For each row the position of its body among those of the step, and its motion.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, Mode)> {
        (0..self.bodies.len()).flat_map(|index| self.modes.iter().map(move |mode| (index, mode)))
    }

    /// A number for each row, by the position of the body among those of the step and the motion, and of each coordinate.
    pub(super) fn by_row(
        &self,
        value: impl Fn(usize, Mode) -> f64,
        of_coordinate: impl Fn(usize) -> f64,
    ) -> DVector<f64> {
        let rigid = self.rows().map(|(index, mode)| value(index, mode));
        let coordinates = (0..self.n_rows() - self.n_rigid_rows()).map(of_coordinate);
        DVector::from_vec(rigid.chain(coordinates).collect())
    }

    /// Rates of all coordinates.
    pub(super) fn rates<'b>(&self, velocity: &'b DVector<f64>) -> &'b [f64] {
        &velocity.as_slice()[self.n_rigid_rows()..]
    }

    /// Coordinates that rates lead to, before their ends go with the bodies these are attached to.
    pub(super) fn coordinates(&self, velocity: &DVector<f64>) -> Vec<f64> {
        let Some(elastic) = self.elastic else { return Vec::new() };
        let levels = elastic.unmoved.iter().zip(self.rates(velocity));
        levels.map(|(unmoved, rate)| unmoved + self.coefficient * rate).collect()
    }

    /// Where velocities lead; `None` where a body has no shape there.
    pub(super) fn place(&self, velocity: &DVector<f64>) -> Option<Placed> {
        let mut poses = self.poses(velocity);
        let mut coordinates = self.coordinates(velocity);
        let gaps = match self.elastic {
            Some(elastic) => Some(elastic.bodies.place(&mut poses, &mut coordinates)?),
            None => None,
        };
        Some(Placed { poses, coordinates, own_gaps: gaps })
    }

    /// The part of a change of velocities, at most 1, within which no body can get to the far side of another.
    pub(super) fn max_step_fraction(&self, from: &Placed, velocity: &DVector<f64>) -> f64 {
        let (gaps, full) = (from.gaps(self.gaps), self.poses(velocity));
        let Some(elastic) = self.elastic else {
            return gaps.max_step_fraction(&from.poses, &full);
        };
        let bodies = elastic.bodies;
        let mut bounds = gaps.displacement_bounds(&from.poses, &full);
        let own = bodies.displacement_bounds(&from.coordinates, &self.coordinates(velocity));
        for ((bound, own), range) in bounds.iter_mut().zip(own).zip(bodies.ranges()) {
            *bound = if range.is_empty() { *bound } else { own };
        }
        gaps.max_part_of(&from.poses, &bounds)
    }

    /// Components of one of the bodies, zero in motions that have no row.
    fn components(&self, vector: &DVector<f64>, index: usize) -> RigidVector {
        let mut components = RigidVector::zeros();
        for (position, mode) in self.modes.iter().enumerate() {
            components[mode] = vector[self.modes.len() * index + position];
        }
        components
    }

    pub(super) fn twists(&self, velocity: &DVector<f64>) -> Vec<Twist> {
        let of = |index| Twist::from_vector(&self.components(velocity, index));
        (0..self.bodies.len()).map(of).collect()
    }

    /// Poses of all bodies.
    pub(super) fn poses(&self, velocity: &DVector<f64>) -> Vec<Pose> {
        let mut poses = self.predicted.to_vec();
        for (index, &body) in self.bodies.iter().enumerate() {
            let mut change = self.change(velocity, index);
            let turn: Vector3<f64> = change.fixed_rows::<3>(3).into_owned();
            let turn = beyond(&self.predicted_turn(index), &turn);
            change.fixed_rows_mut::<3>(3).copy_from(&turn);
            poses[body] = self.predicted[body].displaced(&change);
        }
        poses
    }

    /// c (U - U_p) of one of the bodies.
    fn change(&self, velocity: &DVector<f64>, index: usize) -> RigidVector {
        let mut change = RigidVector::zeros();
        for (position, mode) in self.modes.iter().enumerate() {
            let velocity = velocity[self.modes.len() * index + position];
            let predicted = self.predicted_velocities[index].component(mode);
            change[mode] = self.coefficient * (velocity - predicted);
        }
        change
    }

    /// Rotation vector by which one of the bodies is predicted to turn in the step.
    fn predicted_turn(&self, index: usize) -> Vector3<f64> {
        let body = self.bodies[index];
        let displacement = self.predicted[body].displacement_from(&self.start[body]);
        displacement.fixed_rows::<3>(3).into_owned()
    }

    /// Derivative of displacements over c by velocities; `None` where it is the identity.
    pub(super) fn rotation_jacobian(&self, velocity: &DVector<f64>) -> Option<DMatrix<f64>> {
        if self.modes.rotations().count() < 2 {
            return None;
        }
        let mut jacobian = DMatrix::identity(self.n_rows(), self.n_rows());
        for index in 0..self.bodies.len() {
            let change = self.change(velocity, index);
            let turn = self.predicted_turn(index) + change.fixed_rows::<3>(3);
            let block = left_jacobian(&turn);
            let first = self.modes.len() * index;
            let rotations = || self.modes.iter().enumerate().filter(|(_, mode)| mode.is_rotation());
            for (i, row) in rotations() {
                for (j, column) in rotations() {
                    jacobian[(first + i, first + j)] = block[(row.axis(), column.axis())];
                }
            }
        }
        Some(jacobian)
    }

    /// Displacement over c by a change of velocities, to first order.
    pub(super) fn displacement_rate(
        &self,
        velocity: &DVector<f64>,
        change: &DVector<f64>,
    ) -> DVector<f64> {
        match self.rotation_jacobian(velocity) {
            Some(jacobian) => jacobian * change,
            None => change.clone(),
        }
    }

    /// Rows of the motions of both sides of a pair.
    fn rows_of(&self, pair: &ContactPair) -> [Option<usize>; 12] {
        let index = |body: usize| self.bodies.iter().position(|known| *known == body);
        let second = match pair.partner {
            Partner::Body(other) => index(other),
            Partner::Wall(_) => None,
        };
        let sides = [index(pair.body), second];
        std::array::from_fn(|entry| {
            let position = self.modes.position(Mode::ALL[entry % 6]);
            sides[entry / 6].zip(position).map(|(index, row)| self.modes.len() * index + row)
        })
    }

    /// The same where a side moves with a section of a body with coordinates.
    fn rows_with_sections(&self, pair: &ContactPair) -> Vec<RowOfPair> {
        let Some(elastic) = self.elastic else { return Vec::new() };
        let partner = match pair.partner {
            Partner::Body(other) => Some(other),
            Partner::Wall(_) => None,
        };
        let mut found = Vec::new();
        let rigid = self.rows_of(pair);
        for (side, body) in [Some(pair.body), partner].into_iter().enumerate() {
            let Some(body) = body else { continue };
            let Some(section) = &pair.sections[side] else {
                for entry in 6 * side..6 * side + 6 {
                    let unit = PairVector::ith(entry, 1.0);
                    found.extend(rigid[entry].map(|row| RowOfPair { row, weights: unit }));
                }
                continue;
            };
            let first = self.n_rigid_rows() + elastic.bodies.ranges()[body].start + section.first;
            for (i, column) in section.weights.column_iter().enumerate() {
                let mut weights = PairVector::zeros();
                weights.fixed_rows_mut::<6>(6 * side).copy_from(&column);
                found.push(RowOfPair { row: first + i, weights });
            }
        }
        found
    }

    /// Gives the entries of a vector over both sides of a pair to the rows they belong to.
    pub(super) fn scatter(
        &self,
        pair: &ContactPair,
        entries: &PairVector,
        mut add: impl FnMut(usize, f64),
    ) {
        if pair.moves_by_sections() {
            for RowOfPair { row, weights } in self.rows_with_sections(pair) {
                add(row, weights.dot(entries));
            }
            return;
        }
        for (row, entry) in self.rows_of(pair).into_iter().zip(entries) {
            if let Some(row) = row {
                add(row, *entry);
            }
        }
    }

    /// Adds a matrix over both sides of a pair to the rows and columns it belongs to.
    pub(super) fn add_block(
        &self,
        matrix: &mut DMatrix<f64>,
        pair: &ContactPair,
        block: &PairMatrix,
    ) {
        if pair.moves_by_sections() {
            let rows = self.rows_with_sections(pair);
            for RowOfPair { row, weights } in &rows {
                let of_row = block.tr_mul(weights);
                for RowOfPair { row: column, weights: by } in &rows {
                    matrix[(*row, *column)] += of_row.dot(by);
                }
            }
            return;
        }
        let rows = self.rows_of(pair);
        for (i, row) in rows.into_iter().enumerate() {
            for (j, column) in rows.into_iter().enumerate() {
                if let (Some(row), Some(column)) = (row, column) {
                    matrix[(row, column)] += block[(i, j)];
                }
            }
        }
    }

    /// Change of the gap of a pair by displacements, to first order.
    pub(super) fn gap_change(&self, pair: &ContactPair, displacement: &DVector<f64>) -> f64 {
        let mut change = 0.0;
        self.scatter(pair, &pair.gradient_of_both(), |row, g| change += g * displacement[row]);
        change
    }

    /// Length by which a component counts as a displacement.
    pub(super) fn length(&self, index: usize, mode: Mode) -> f64 {
        self.gaps.length(self.bodies[index], mode)
    }

    /// Lengths of all rows.
    pub(super) fn lengths(&self) -> DVector<f64> {
        let of_coordinate =
            |at: usize| self.elastic.map_or(1.0, |elastic| elastic.bodies.lengths()[at]);
        self.by_row(|index, mode| self.length(index, mode), of_coordinate)
    }

    /// Largest displacement of a point of a body by a change of velocities (m), by component.
    pub(super) fn size(&self, step: &DVector<f64>) -> f64 {
        if self.elastic.is_some() {
            let sizes = step.component_mul(&self.lengths()).map(f64::abs);
            // Not a number where one of them is not
            let larger =
                |most: f64, one: &f64| if *one > most || one.is_nan() { *one } else { most };
            return self.coefficient * sizes.iter().fold(0.0, larger);
        }
        self.coefficient * self.gaps.largest_displacement(self.bodies, self.modes, step)
    }
}

/// The rotation vector that leads on from exp(turn) to exp(turn + change).
fn beyond(turn: &Vector3<f64>, change: &Vector3<f64>) -> Vector3<f64> {
    // Rotations about one axis commute, in the plane always
    if turn.cross(change) == Vector3::zeros() {
        return *change;
    }
    let [end, begin] = [turn + change, *turn].map(UnitQuaternion::from_scaled_axis);
    (end * begin.inverse()).scaled_axis()
}

/// J with exp([t + dt]) = exp([J dt]) exp([t]) to first order.
fn left_jacobian(turn: &Vector3<f64>) -> Matrix3<f64> {
    let angle = turn.norm();
    let [first, second] = if angle < SMALL_ANGLE {
        [0.5 - angle * angle / 24.0, 1.0 / 6.0 - angle * angle / 120.0]
    } else {
        let half = (0.5 * angle).sin() / angle;
        [2.0 * half * half, (angle - angle.sin()) / angle.powi(3)]
    };
    let cross = turn.cross_matrix();
    Matrix3::identity() + cross * first + cross * cross * second
}
