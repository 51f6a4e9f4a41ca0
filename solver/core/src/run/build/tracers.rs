//! `Tracers`: the particles of a case, from `[[tracer]]` to their paths through each step of a run.

use alewife_mesh::Point;

use crate::body::on_mesh;
use crate::case::{Case, TracerRegion, TracerSpec};
use crate::coupling::{Problem, Side};
use crate::motion::MovingMesh;
use crate::state::{Evolving, State};
use crate::tracer::{Cloud, FlowStep, Passage, Region, Source, carry};

/// What the flow carries, and what happens to it at the sides.
#[derive(Debug, Clone)]
pub struct Tracers<const D: usize> {
    sources: Vec<Source<D>>,
    passages: Vec<Passage>,
    /// Vectors by which a mesh that stays repeats (m), zero first.
    images: Vec<Point<D>>,
}

impl<const D: usize> Tracers<D> {
    /// Those of a case, whose mesh repeats by these vectors (m); none where it has no tracers.
    pub(in crate::run) fn of(
        case: &Case,
        problem: &Problem<D>,
        images: Vec<Point<D>>,
    ) -> Option<Self> {
        let has_frame = problem.frame.is_some();
        let passage = |side: &Option<Side<D>>| match side {
            Some(side) if side.is_open() => Passage::Open,
            Some(Side::Velocity { is_wall: false, .. }) => Passage::WithFluid,
            // Sides that travel leave the fluid behind, and particles with it
            Some(Side::Velocity { .. } | Side::Symmetry { .. }) if has_frame => Passage::WithFluid,
            _ => Passage::Closed,
        };
        (!case.tracer.is_empty()).then(|| Self {
            sources: case.tracer.iter().map(source).collect(),
            passages: problem.sides.iter().map(passage).collect(),
            images,
        })
    }

    /// Carries particles through the last step of a state; after a jump of the rates by its last flow.
    pub(in crate::run) fn carry(
        &self,
        problem: &Problem<D>,
        state: &mut State<D>,
        moving: Option<&MovingMesh<D>>,
        jumps: bool,
    ) {
        let origin = on_mesh::<D>(&state.origin_at(problem, &state.previous_poses));
        let nodes: Vec<Point<D>> = state.nodes_before.iter().map(|node| node + origin).collect();
        let images = moving.map(|moving| {
            let seen = state.mesh_in_frame();
            moving.scene().images([&seen, &seen])
        });
        let times = [state.time_before(), state.time];
        state.carry_tracers(|state, clouds| {
            let now = state.now.velocity.as_slice();
            let before = if jumps { now } else { state.previous.velocity.as_slice() };
            let step = FlowStep {
                mesh: &state.mesh,
                nodes_before: &nodes,
                velocities: [before, now],
                times,
                images: images.as_ref().unwrap_or(&self.images),
                passages: &self.passages,
            };
            carry(clouds, &self.sources, &step);
        });
    }

    /// Releases what is there at the start.
    pub(in crate::run) fn begin(&self, state: &Evolving<D>, clouds: &mut Vec<Cloud<D>>) {
        *clouds = self.sources.iter().map(|_| Cloud::default()).collect();
        let step = FlowStep {
            mesh: &state.mesh,
            nodes_before: &state.mesh.nodes,
            velocities: [&state.now.velocity; 2],
            times: [state.time; 2],
            images: &self.images,
            passages: &self.passages,
        };
        carry(clouds, &self.sources, &step);
    }
}

/// Where and when the particles of a `[[tracer]]` are released.
fn source<const D: usize>(spec: &TracerSpec) -> Source<D> {
    let point = |values: &Vec<f64>| Point::<D>::from_fn(|axis, _| values[axis]);
    let region =
        |region: &TracerRegion| Region { min: point(&region.min), max: point(&region.max) };
    Source {
        name: spec.name.clone(),
        seeds: spec.seeds().iter().map(point).collect(),
        start: spec.start,
        every: spec.every,
        region: spec.region.as_ref().map(region),
    }
}
