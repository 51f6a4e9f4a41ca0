//! The quantities of sides: loads of the fluid, flux, pressure.

use super::value::Value;
use crate::body::Wrench;
use crate::case::{Model, SideQuantity, reports_sides};
use crate::coupling::{SideFlow, SurfaceLoads};
use crate::run::simulation::Simulation;

/// What is measured on a side.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SideMeasurement {
    load: Wrench,
    flow: SideFlow,
}

impl SideMeasurement {
    pub(super) fn value(&self, quantity: SideQuantity) -> Value {
        let Self { load, flow } = self;
        match quantity {
            SideQuantity::Force => load.force.into(),
            SideQuantity::Torque => load.torque.into(),
            SideQuantity::Flux => flow.influx.into(),
            SideQuantity::MeanPressure => (flow.pressure / flow.area).into(),
            SideQuantity::MeanTraction => (load.force / flow.area).into(),
        }
    }
}

/// All sides of the domain, in the order of their names in the case.
pub(super) fn measure_sides<const D: usize>(
    model_sides: &[String],
    simulation: &Simulation<D>,
    loads: &SurfaceLoads,
) -> Vec<SideMeasurement> {
    let Simulation { problem, state, work, .. } = simulation;
    let stress = work.system.surface_stress(problem, &state.mesh, &state.now);
    let frame_velocity = problem.frame_velocity(&state.now.twists);
    let of_side = |name: &String| {
        let Some(boundary) = state.mesh.boundary_named(name) else {
            return SideMeasurement::default();
        };
        let load = loads.sides.get(boundary.index()).copied().unwrap_or_default();
        SideMeasurement { load, flow: stress.side_flow(boundary, &frame_velocity) }
    };
    model_sides.iter().map(of_side).collect()
}

/// Names of the sides of a case, if any of them is measured.
pub(super) fn side_names(model: &Model) -> Vec<String> {
    if !reports_sides(model) {
        return Vec::new();
    }
    model.case.sides().into_iter().map(str::to_owned).collect()
}
