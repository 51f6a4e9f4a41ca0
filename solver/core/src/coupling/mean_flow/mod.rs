//! Mean flow along periodic directions: its pressure gradient, given or such that a mean velocity is.
//!
//! The pressure is gamma . x plus a periodic part, which is the field that is solved for. Against
//! test functions gamma is a force -gamma per volume of fluid and of bodies: R(x, gamma) = R(x) +
//! b gamma, with b the integrals of the basis functions over the fluid on velocities and the volumes
//! of bodies on their rigid velocities. The mean velocity of fluid and bodies is b . x over the volume
//! of the cell. Where it is given, gamma is one more unknown: with J dy + b dgamma = -R a step of Newton's
//! method is that without dgamma and the answer of the flow to b, J^-1 b.

mod driven;

use alewife_mesh::{Mesh, Point, Simplex};
use nalgebra::{DMatrix, DVector, Vector3};

use super::error::SolveError;
use super::linear_system::SystemSolver;
use super::problem::{MeanFlowAlong, MeanFlowAt, Problem};
use super::solution::Solution;
use crate::algebra::{AffineConstraints, LinearError};
use crate::body::{Mode, Modes, on_mesh};
use crate::flow::integrate_basis;
use crate::space::{DofLayout, Tables};
use crate::timing::Timing;

/// Integrals over the cell of a periodic domain.
#[derive(Debug, Clone)]
pub(super) struct CellIntegrals<const D: usize> {
    /// Of the basis function of each node, over the fluid (m3; m2 planar).
    nodes: Vec<f64>,
    /// Volume of each body.
    bodies: Vec<f64>,
    /// Volume of fluid and bodies.
    volume: f64,
}

impl<const D: usize> CellIntegrals<D> {
    /// Integrates over a mesh.
    pub fn new(problem: &Problem<D>, mesh: &Mesh<D>, tables: &Tables<D>) -> Self {
        let mut nodes = vec![0.0; mesh.n_nodes()];
        integrate_basis(mesh, tables, Simplex::<D>::N_NODES, |at| at.phi, &mut nodes);
        let bodies: Vec<f64> = problem.bodies.iter().map(|body| body.volume.mass).collect();
        let volume = nodes.iter().sum::<f64>() + bodies.iter().sum::<f64>();
        Self { nodes, bodies, volume }
    }

    /// Adds `fluid` times the integrals over the fluid and `bodies` times those over bodies to raw
    /// residuals.
    pub fn add(
        &self,
        layout: &DofLayout<D>,
        modes: Modes,
        [fluid, bodies]: [&Point<D>; 2],
        raw: &mut [f64],
    ) {
        for (node, integral) in layout.nodes().zip(&self.nodes) {
            for axis in 0..D {
                raw[layout.velocity(node, axis)] += fluid[axis] * integral;
            }
        }
        for (body, volume) in self.bodies.iter().enumerate() {
            for axis in 0..D {
                if let Some(position) = modes.position(Mode::along(axis)) {
                    raw[layout.rigid(body, position)] += bodies[axis] * volume;
                }
            }
        }
    }

    /// b along a coordinate.
    fn raw(&self, layout: &DofLayout<D>, modes: Modes, axis: usize) -> Vec<f64> {
        let mut raw = vec![0.0; layout.n_raw()];
        let along = Point::<D>::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
        self.add(layout, modes, [&along; 2], &mut raw);
        raw
    }

    /// Integral of the velocity over the fluid (m4/s; m3/s planar).
    pub fn fluid_integral(&self, solution: &Solution<D>) -> Point<D> {
        let nodes = solution.velocity.iter().zip(&self.nodes);
        nodes.fold(Point::<D>::zeros(), |sum, (velocity, integral)| sum + velocity * *integral)
    }

    /// Mean velocity of fluid and bodies (m/s).
    pub fn mean_velocity(&self, solution: &Solution<D>) -> Point<D> {
        let bodies = solution.twists.iter().zip(&self.bodies);
        let bodies = bodies.map(|(twist, volume)| on_mesh::<D>(&twist.linear) * *volume);
        let sum = bodies.fold(self.fluid_integral(solution), |sum, part| sum + part);
        sum / self.volume
    }

    /// The largest integral of a node.
    pub fn largest_node(&self) -> f64 {
        self.nodes.iter().fold(0.0, |most, integral| most.max(integral.abs()))
    }

    /// Volume of fluid and bodies (m3; m2 planar).
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Volume of the fluid (m3; m2 planar).
    pub fn fluid_volume(&self) -> f64 {
        self.nodes.iter().sum()
    }

    /// Volume of a body (m3; m2 planar).
    pub fn body_volume(&self, body: usize) -> f64 {
        self.bodies[body]
    }
}

/// A mean flow as it is reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanFlowReport {
    /// Mean gradient of the pressure (Pa/m).
    pub pressure_gradient: Vector3<f64>,
    /// Mean velocity of fluid and bodies (m/s).
    pub velocity: Vector3<f64>,
    /// Rate of work of pressure gradient and body force on fluid and bodies (W; W/m planar).
    pub power: f64,
    /// Force of both on the fluid (N; N/m planar).
    pub force: Vector3<f64>,
}

/// How a flow answers to pressure gradients, along the coordinates where mean velocities are given.
#[derive(Debug, Clone, Default)]
pub(super) struct MeanFlowResponse {
    axes: Vec<usize>,
    /// J^-1 b of each of these coordinates, on the free unknowns.
    answers: Vec<Vec<f64>>,
    /// b of each, on the free unknowns.
    integrals: Vec<Vec<f64>>,
}

impl MeanFlowResponse {
    /// Solves for it with the matrix of a linear system; `self` holds the answers for the matrix before.
    pub fn update<const D: usize>(
        &mut self,
        at: &ResponseSystem<'_, D>,
        linear: &mut dyn SystemSolver,
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let earlier = std::mem::take(&mut self.answers);
        // These are flows of another size, which are met to a part of their own
        linear.limit_mass(f64::INFINITY);
        self.integrals.clear();
        self.axes.clone_from(&at.axes);
        for (nth, &axis) in at.axes.iter().enumerate() {
            let integral = at.constraints.restrict(&at.cell.raw(at.layout, at.modes, axis));
            let mut answer = integral.clone();
            match earlier.get(nth).filter(|earlier| earlier.len() == answer.len()) {
                Some(typical) => linear.solve_correction(typical, &mut answer, None, timing)?,
                None => linear.solve(&mut answer, None, timing)?,
            }
            self.answers.push(answer);
            self.integrals.push(integral);
        }
        Ok(())
    }

    /// Whether no mean velocity is given.
    pub fn is_empty(&self) -> bool {
        self.axes.is_empty()
    }

    /// Changes of the pressure gradient that take away `excess` flows (m4/s; m3/s planar), which are
    /// integrals of velocities; nothing where a flow does not answer.
    pub fn gradients(&self, excess: &[f64]) -> Option<Vec<f64>> {
        let dot = |one: &[f64], other: &[f64]| -> f64 {
            one.iter().zip(other).map(|(one, other)| one * other).sum()
        };
        let n = self.axes.len();
        let answers = DMatrix::from_fn(n, n, |i, j| dot(&self.integrals[i], &self.answers[j]));
        let solved = answers.lu().solve(&DVector::from_column_slice(excess))?;
        Some(solved.iter().copied().collect())
    }

    /// Takes `excess` flows (as in [`Self::gradients`]) off the free unknowns; the change of the pressure
    /// gradient that does.
    pub fn take_off<const D: usize>(
        &self,
        excess: &[f64],
        free: &mut [f64],
    ) -> Result<Point<D>, SolveError> {
        let gradients = self.gradients(excess).ok_or(SolveError::NoResistance)?;
        let mut change = Point::<D>::zeros();
        for ((&axis, gradient), answer) in self.axes.iter().zip(&gradients).zip(&self.answers) {
            change[axis] = *gradient;
            for (value, answer) in free.iter_mut().zip(answer) {
                *value -= gradient * answer;
            }
        }
        Ok(change)
    }

    /// Integrals of a change of the free unknowns over the cell.
    pub fn flows(&self, change: &[f64]) -> Vec<f64> {
        let flow = |integral: &Vec<f64>| integral.iter().zip(change).map(|(b, dx)| b * dx).sum();
        self.integrals.iter().map(flow).collect()
    }

    /// The coordinates, each with the answer at a sum of free unknowns.
    pub fn axes(&self) -> &[usize] {
        &self.axes
    }

    /// J^-1 b of each coordinate.
    pub fn answers(&self) -> &[Vec<f64>] {
        &self.answers
    }
}

/// What [`MeanFlowResponse::update`] needs besides the matrix.
pub(super) struct ResponseSystem<'a, const D: usize> {
    pub cell: &'a CellIntegrals<D>,
    pub layout: &'a DofLayout<D>,
    pub modes: Modes,
    pub constraints: &'a AffineConstraints,
    /// Coordinates along which the mean velocity is given, and something holds the fluid.
    pub axes: Vec<usize>,
}

/// A solution with the pressure gradients that are given.
pub(super) fn with_given_gradients<const D: usize>(
    mut solution: Solution<D>,
    given: &MeanFlowAt<D>,
) -> Solution<D> {
    for (axis, along) in given.along.iter().enumerate() {
        match along {
            MeanFlowAlong::Nothing => solution.pressure_gradient[axis] = 0.0,
            MeanFlowAlong::PressureGradient(value) => solution.pressure_gradient[axis] = *value,
            MeanFlowAlong::Velocity(_) => {}
        }
    }
    solution
}
