//! Velocities of bodies in the linear system: their equations, and which of them are unknowns.

use alewife_mesh::Mesh;

use super::super::constrain::BodiesAt;
use super::super::linear_system::{NewSystem, saddle_point, system_solver};
use super::super::problem::{Drive, Problem};
use super::super::shapes::BodyShapes;
use super::numbering::{blocks_of_bodies, free_velocities};
use super::{Configuration, FluidSystem};
use crate::algebra::{AffineConstraints, Term};
use crate::body::MeshPoses;
use crate::flow::Assembly;

impl<const D: usize> FluidSystem<D> {
    /// Makes the system one for these constraints: where joints have turned so that other velocities of
    /// bodies on them are the unknowns, cells and matrix are numbered again.
    pub fn fit_to(
        &mut self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        constraints: &AffineConstraints,
    ) {
        if !problem.has_joints() {
            return;
        }
        let n_bodies = problem.bodies.len();
        let is_free = free_velocities(&self.layout, n_bodies, self.modes, constraints);
        if is_free == self.numbering.is_free {
            return;
        }
        // A run that is stopped within this step resumes from the last state, whose numbering is the old one
        let before = self.linear.memory();
        self.kept_memory.get_or_insert(before);
        let sides = problem.open_sides();
        let (layout, frame) = (self.layout, self.numbering.frame);
        self.assembly = Assembly::new(mesh, layout, constraints, problem.metric, &sides, frame);
        let saddle_point = saddle_point(&layout, constraints, self.modes, &problem.coordinates());
        let choice = self.numbering.choice;
        let blocks = blocks_of_bodies(problem, &layout, constraints);
        let system = NewSystem { constraints, saddle_point, blocks };
        self.linear = system_solver(&self.assembly, system, choice);
        self.n_unknowns = constraints.n_unknowns();
        self.numbering.is_free = is_free;
    }

    /// Makes the system one as [`Self::new`] numbers it for bodies at these poses: those that are reached may be
    /// beyond a diagonal that those the flow was solved for have not passed.
    pub fn fit_to_poses(&mut self, problem: &Problem<D>, mesh: &Mesh<D>, poses: &MeshPoses) {
        if !problem.has_joints() || self.is_numbered_for(problem, poses) {
            return;
        }
        let shapes = BodyShapes::rigid(problem.bodies.len());
        let constraints = self.constraints(problem, mesh, BodiesAt { poses, shapes: &shapes });
        self.fit_to(problem, mesh, &constraints);
    }

    /// Whether the velocities of bodies on joints that are unknowns are those for bodies at these poses.
    fn is_numbered_for(&self, problem: &Problem<D>, poses: &MeshPoses) -> bool {
        // Which those are depends on poses only
        let rows = problem.rigid_rows(poses, 0.0);
        let is_free = self.numbering.is_free.chunks_exact(self.modes.len());
        let mut bodies = problem.bodies.iter().zip(rows).zip(is_free).enumerate();
        bodies.all(|(body, ((rigid, rows), is_free))| {
            let mut modes = self.modes.iter().zip(is_free);
            modes.all(|(mode, is_free)| {
                let is_linked = matches!(rigid.drive(mode), Drive::Linked);
                !is_linked || rows[mode].is(body, mode) == *is_free
            })
        })
    }

    /// Adds what the equations of bodies have of the matrix at rates of coordinates.
    pub(super) fn add_body_matrix(&mut self, at: &Configuration<'_, D>, rates: &[f64]) {
        let layout = self.layout;
        let row = |body: usize, position: usize| at.constraints.row(layout.rigid(body, position));
        let modes = self.modes;
        for (body, equation) in at.bodies.bodies.iter().enumerate() {
            for (i, one) in modes.iter().enumerate() {
                for (j, other) in modes.iter().enumerate() {
                    let mut factor =
                        equation.inertia[(one.index(), other.index())] * at.bodies.rate;
                    if i == j {
                        factor += equation.resistance[one];
                    }
                    if let Some(resistance) = equation.magnetic_resistance(one, other) {
                        factor += resistance;
                    }
                    self.linear.add_product(row(body, i), row(body, j), factor);
                }
            }
        }
        for joint in &at.bodies.joints {
            let mut rate: Vec<Term<u32>> = Vec::new();
            let parent = joint.parent.map(|parent| (parent, joint.on_parent));
            for (body, share) in std::iter::once((joint.child, joint.on_child)).chain(parent) {
                for (position, mode) in modes.iter().enumerate() {
                    let scaled =
                        |term: &Term<u32>| Term { weight: share[mode] * term.weight, ..*term };
                    rate.extend(row(body, position).iter().map(scaled));
                }
            }
            self.linear.add_product(&rate, &rate, joint.resistance);
        }
        self.rate_response.keep_tangents(&at.bodies.flexible, rates);
        for (equation, tangent) in at.bodies.flexible.iter().zip(self.rate_response.tangents()) {
            let row = |own: usize| at.constraints.row(layout.rate(equation.first + own));
            for (j, column) in tangent.column_iter().enumerate() {
                for (i, factor) in column.iter().enumerate() {
                    self.linear.add_product(row(i), row(j), *factor);
                }
            }
        }
    }
}
