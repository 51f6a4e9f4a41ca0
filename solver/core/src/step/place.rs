//! Where mesh and bodies are put for the flow of a step to be solved.

use alewife_mesh::Point;

use super::configuration::StepConfiguration;
use super::context::StepContext;
use super::error::StepError;
use super::placement::Placement;
use super::workspace::Workspace;
use crate::coupling::BodiesAt;

impl<const D: usize> StepContext<'_, D> {
    /// Puts mesh and bodies where bodies are to be, the mesh in `work` as well.
    ///
    /// # Errors
    /// When the equation of mesh motion cannot be solved, or a cell degenerates.
    pub fn place(
        &self,
        work: &mut Workspace<D>,
        placement: Placement,
    ) -> Result<StepConfiguration<D>, StepError> {
        let Self { stepper, state, history, .. } = self;
        let problem = stepper.problem;
        let Placement { poses, coordinates, shapes } = &placement;
        let nodes = stepper.path.move_mesh(work, problem, state, poses, shapes)?;
        if !stepper.path.is_fixed() {
            work.system.move_to(problem, &work.mesh);
        }
        let in_mesh = state.in_mesh(poses);
        let shapes = history.boundary_shapes_with(problem, coordinates, shapes)?;
        let bodies = BodiesAt { poses: &in_mesh, shapes: &shapes };
        let constraints = work.system.constraints(problem, &work.mesh, bodies);
        work.system.fit_to(problem, &work.mesh, &constraints);
        Ok(StepConfiguration {
            constraints,
            mesh_velocity: self.mesh_velocity(&nodes),
            bodies: history.body_equations(problem, poses),
            mean_flow: problem.mean_flow_at(history.boundary_shapes().time()),
            nodes,
            placement,
        })
    }

    /// The backward difference of the positions of the nodes (m/s); none where it makes no difference.
    fn mesh_velocity(&self, nodes: &[Point<D>]) -> Vec<Point<D>> {
        let Self { stepper, state, history, .. } = self;
        if stepper.path.is_fixed() || !stepper.problem.has_inertia {
            return Vec::new();
        }
        let bdf = &history.step.bdf;
        let levels = nodes.iter().zip(&state.nodes).zip(&state.nodes_before);
        levels.map(|((next, now), before)| bdf.rate(*next, *now, *before)).collect()
    }
}
