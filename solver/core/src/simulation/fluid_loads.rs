//! What a flow does to bodies, and groups of bodies to it.

use super::newton::{Flow, FlowEquations, flow_residual};
use super::state::State;
use super::{Stage, Timing};
use crate::body::Pose;
use crate::coupling::{Configuration, FluidSystem, PropulsionPower, SurfaceLoads};

/// Loads of the fluid on bodies, and the powers of groups.
pub(super) struct FluidLoads {
    pub surfaces: SurfaceLoads,
    pub propulsion: Vec<PropulsionPower>,
}

/// The configuration a flow was solved for.
pub(super) struct SolvedConfiguration<'a, const D: usize> {
    pub system: &'a FluidSystem<D>,
    pub at: Configuration<'a, D>,
    pub state: &'a State<D>,
    /// Poses of the bodies in the laboratory.
    pub poses: &'a [Pose],
}

impl<const D: usize> SolvedConfiguration<'_, D> {
    /// Gives the pressure of a flow its level, and finds its loads.
    pub fn loads(
        &self,
        equations: &impl FlowEquations<D>,
        flow: &mut Flow<D>,
        timing: &mut Timing,
    ) -> FluidLoads {
        let Self { system, at, state, poses } = self;
        system.center_pressure(at.problem, &mut flow.solution);
        if at.problem.power_depends_on_pressure_level() {
            flow.residual = timing
                .measure(Stage::Loads, || flow_residual(system, at, equations, &flow.solution));
        }
        let Flow { solution, residual, .. } = flow;
        let in_mesh = state.in_mesh(poses);
        let surfaces = system.surface_loads(at.problem, at.mesh, &in_mesh, solution, residual);
        let stress = system.surface_stress(at.problem, at.mesh, solution);
        let twists = &solution.twists;
        let propulsion =
            state.propulsion_powers(at.problem, poses, twists, &surfaces.bodies, &stress);
        FluidLoads { surfaces, propulsion }
    }
}
