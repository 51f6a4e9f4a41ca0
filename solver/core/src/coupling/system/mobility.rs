//! How bodies in a flow answer to loads: their mobility, and the change of the flow.

use nalgebra::DMatrix;

use super::super::constrain::constrain_rigid_velocities;
use super::super::error::SolveError;
use super::super::problem::Problem;
use super::super::solution::Solution;
use super::FluidSystem;
use crate::algebra::{AffineConstraints, ConstraintBuilder, Term};
use crate::body::{BodyLoad, LoadedBody, MeshPoses, Mode};
use crate::space::DofLayout;
use crate::timing::Timing;

impl<const D: usize> FluidSystem<D> {
    /// Velocities (m/s, rad/s) of some bodies by unit loads in each of their rigid motions, with the
    /// matrix last assembled: n m x n m for n bodies with m motions, zero for motions that are given. Where
    /// each unknown takes iterations it is zero, too, for turns of bodies that do not need them. If `with_coordinates`, rates
    /// of the coordinates of all bodies, by unit loads on these, follow.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn mobility(
        &mut self,
        constraints: &AffineConstraints,
        bodies: &[LoadedBody],
        with_coordinates: bool,
        timing: &mut Timing,
    ) -> Result<DMatrix<f64>, SolveError> {
        let mut rows = self.rows_of(constraints, bodies);
        if with_coordinates {
            let rates = (0..self.layout.n_coordinates).map(|at| self.layout.rate(at));
            rows.extend(rates.map(|raw| constraints.row(raw)));
        }
        let Masters { unknowns, weights } = Masters::of(&rows);
        let inverse = self.linear.inverse_of(&unknowns, timing)?;
        // Velocities by loads on the masters, one column each
        let inverse = DMatrix::from_column_slice(unknowns.len(), unknowns.len(), &inverse);
        let mobility = &weights * inverse * weights.transpose();
        Ok(self.at_mean_velocity(mobility, &rows))
    }

    /// How the velocities of some bodies follow from the unknowns they depend on: n m rows for n bodies with m
    /// motions, a column for each unknown; zero rows as in [`Self::mobility`].
    #[must_use]
    pub fn free_motions(
        &self,
        constraints: &AffineConstraints,
        bodies: &[LoadedBody],
    ) -> DMatrix<f64> {
        Masters::of(&self.rows_of(constraints, bodies)).weights
    }

    /// The same with bodies at poses in the mesh at a time (s), whatever the mesh.
    #[must_use]
    pub fn free_motions_at(
        &self,
        problem: &Problem<D>,
        poses: &MeshPoses,
        time: f64,
        bodies: &[LoadedBody],
    ) -> DMatrix<f64> {
        let n_modes = self.modes.len();
        let n_coordinates = problem.n_coordinates();
        let n_bodies = problem.bodies.len();
        let layout = DofLayout::<D> { n_nodes: 0, n_vertices: 0, n_bodies, n_modes, n_coordinates };
        let mut builder = ConstraintBuilder::new(layout.n_raw());
        constrain_rigid_velocities(problem, poses, time, &layout, &mut builder);
        let raw = |body: usize, position: usize| layout.rigid(body, position);
        Masters::of(&self.rows(&builder.build(), raw, bodies)).weights
    }

    /// What each motion of some bodies is made of, nothing where it does not count.
    fn rows_of<'a>(
        &self,
        constraints: &'a AffineConstraints,
        bodies: &[LoadedBody],
    ) -> Vec<&'a [Term<u32>]> {
        self.rows(constraints, |body, position| self.layout.rigid(body, position), bodies)
    }

    /// The same, `raw(body, position)` being the raw unknown of a motion.
    fn rows<'a>(
        &self,
        constraints: &'a AffineConstraints,
        raw: impl Fn(usize, usize) -> usize,
        bodies: &[LoadedBody],
    ) -> Vec<&'a [Term<u32>]> {
        let modes = self.modes;
        let counts_all = !self.is_iterative();
        let row = |loaded: &LoadedBody, (position, mode): (usize, Mode)| -> &'a [Term<u32>] {
            let counts = counts_all || loaded.turns || !mode.is_rotation();
            if counts { constraints.row(raw(loaded.body, position)) } else { &[] }
        };
        let row = &row;
        let of_body = |loaded| modes.iter().enumerate().map(move |mode| row(loaded, mode));
        bodies.iter().flat_map(of_body).collect()
    }

    /// A mobility at constant mean velocity: loads change the pressure gradient where that is given. By
    /// reciprocity, which convection breaks a little, what a gradient does to bodies is what loads
    /// do to the mean velocity.
    fn at_mean_velocity(&self, mobility: DMatrix<f64>, rows: &[&[Term<u32>]]) -> DMatrix<f64> {
        if self.response.is_empty() {
            return mobility;
        }
        let of_body = |answer: &Vec<f64>, row: &[Term<u32>]| -> f64 {
            row.iter().map(|term| term.weight * answer[term.unknown as usize]).sum()
        };
        let answers = self.response.answers();
        let by_gradient =
            DMatrix::from_fn(rows.len(), answers.len(), |i, j| of_body(&answers[j], rows[i]));
        let mut constrained = mobility;
        for load in 0..rows.len() {
            let flows: Vec<f64> = by_gradient.row(load).iter().copied().collect();
            let Some(gradients) = self.response.gradients(&flows) else { continue };
            for (axis, gradient) in gradients.iter().enumerate() {
                for body in 0..rows.len() {
                    constrained[(body, load)] -= gradient * by_gradient[(body, axis)];
                }
            }
        }
        constrained
    }

    /// Adds to a solution what further loads (N, N m) on some bodies, and such on the coordinates of all bodies if there are
    /// any, change, with the matrix last assembled. Where the solution takes iterations, these leave `reduction` of the
    /// loads, by default as much as those of the flow.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn apply_body_loads(
        &mut self,
        constraints: &AffineConstraints,
        AddedLoads { on_bodies, on_coordinates }: AddedLoads<'_>,
        reduction: Option<f64>,
        solution: &mut Solution<D>,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        let mut change = vec![0.0; self.n_unknowns];
        for BodyLoad { body, load } in on_bodies {
            for (position, mode) in self.modes.iter().enumerate() {
                for term in constraints.row(self.layout.rigid(*body, position)) {
                    change[term.unknown as usize] += term.weight * load[mode];
                }
            }
        }
        for (coordinate, load) in on_coordinates.iter().enumerate() {
            for term in constraints.row(self.layout.rate(coordinate)) {
                change[term.unknown as usize] += term.weight * load;
            }
        }
        self.linear.solve(&mut change, reduction, timing)?;
        let mut pressure_gradient = solution.pressure_gradient;
        if !self.response.is_empty() {
            // Loads leave a given mean velocity as it is
            let flows = self.response.flows(&change);
            pressure_gradient += self.response.take_off::<D>(&flows, &mut change)?;
        }
        let mean = self.mean_velocity(solution);
        let mut free = constraints.pick(&self.pinned(solution).to_raw(self.modes));
        free.iter_mut().zip(&change).for_each(|(value, change)| *value += change);
        let raw = constraints.expand(&free);
        let next = Solution::from_raw(&self.layout, self.modes, &raw);
        let next = Solution { pressure_gradient, ..next };
        *solution = self.centered(next, &mean);
        Ok(())
    }
}

/// Further loads on bodies in a flow.
#[derive(Debug, Clone, Copy)]
pub struct AddedLoads<'a> {
    /// On rigid bodies.
    pub on_bodies: &'a [BodyLoad],
    /// On the coordinates of all bodies that have some; none at all, or one for each.
    pub on_coordinates: &'a [f64],
}

/// The unknowns that some motions depend on.
struct Masters {
    /// Ascending.
    unknowns: Vec<usize>,
    /// The motions by them, a row each.
    weights: DMatrix<f64>,
}

impl Masters {
    fn of(rows: &[&[Term<u32>]]) -> Self {
        let mut unknowns: Vec<usize> =
            rows.iter().flat_map(|row| row.iter().map(|term| term.unknown as usize)).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let mut weights: DMatrix<f64> = DMatrix::zeros(rows.len(), unknowns.len());
        for (at, row) in rows.iter().enumerate() {
            for term in *row {
                if let Ok(column) = unknowns.binary_search(&(term.unknown as usize)) {
                    weights[(at, column)] += term.weight;
                }
            }
        }
        Self { unknowns, weights }
    }
}
