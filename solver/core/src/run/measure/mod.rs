//! `Measure`: the quantities of a run, one value per column of `series.csv`.
//!
//! What is measured, under which name and when, is the table in `case/quantity`; the files of this
//! folder have the value of each, by its owner.

mod bodies;
mod flow;
mod integrals;
mod momentum;
mod probes;
mod scalars;
mod sides;
mod steady;
mod swimmers;
mod tracers;
mod value;

use alewife_mesh::{Mesh, Point};

use self::bodies::{
    BodyMotion, Coefficients, MagneticReport, RodReport, body_reports, joint_value,
};
pub(super) use self::bodies::{flexible_states, measure_joints};
pub(super) use self::flow::FlowMeasurement;
use self::momentum::momentum_record;
use self::probes::{ProbePlaces, Probes};
use self::scalars::{boundary_of, measure_scalars};
use self::sides::{measure_sides, side_names};
pub use self::steady::{BodiesInFlow, steady_value};
use self::swimmers::SwimmerMeasurement;
use self::tracers::tracer_value;
use super::RunError;
use super::simulation::{CellCrossing, Simulation};
use super::snapshot::BodyReport;
use crate::case::{Case, Column, Model, Source, TimeSettings, columns};
use crate::coupling::{Group, Problem, SurfaceLoads};
use crate::state::State;
use crate::timing::Stage;
use crate::tracer::Cloud;

/// Measures a run; made once a mesh.
pub(super) struct Measure<const D: usize> {
    columns: Vec<Column>,
    names: Vec<String>,
    probes: Probes<D>,
    /// Names of all sides, if any is measured.
    sides: Vec<String>,
    /// Names of all sides.
    all_sides: Vec<String>,
    places: ProbePlaces,
    /// Vectors by which the first mesh repeats (m).
    images: Vec<Point<D>>,
    coefficients: Coefficients,
    balances_energy: bool,
    balances_momentum: bool,
    is_unsteady: bool,
}

/// What is reported of a state.
pub(super) struct Measured {
    /// All bodies.
    pub bodies: Vec<BodyReport>,
    /// The values of all quantities, in the order of their names.
    pub values: Vec<f64>,
    /// The whole flow.
    pub flow: FlowMeasurement,
}

impl<const D: usize> Measure<D> {
    /// Finds the probes in the mesh, or in its images by these shifts (m), and names the quantities.
    ///
    /// # Errors
    /// When a probe is not in the fluid.
    pub(super) fn new(
        model: &Model,
        mesh: &Mesh<D>,
        images: &[Point<D>],
    ) -> Result<Self, RunError> {
        let case = &model.case;
        let columns = columns(model);
        let places = ProbePlaces::of(model);
        Ok(Self {
            sides: side_names(model),
            all_sides: case.sides().into_iter().map(str::to_owned).collect(),
            names: columns.iter().map(|column| column.name.clone()).collect(),
            columns,
            probes: Probes::in_fluid(case, &places, mesh, images)?,
            places,
            images: images.to_vec(),
            coefficients: Coefficients::of(case),
            balances_energy: model.balances_energy(),
            balances_momentum: model.balances_momentum(),
            is_unsteady: matches!(case.time, TimeSettings::Unsteady(_)),
        })
    }

    /// Finds the probes in the mesh of a state, seen from the frame.
    pub(super) fn find_probes(
        &mut self,
        case: &Case,
        problem: &Problem<D>,
        state: &State<D>,
        images: &[Point<D>],
    ) {
        let poses = state.in_own_frame(problem, &state.poses);
        let places = self.places.now(problem, &poses);
        self.probes = Probes::find(case, &places, &state.mesh_in_frame(), images);
    }

    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Reports of all bodies and the values of all quantities.
    ///
    /// # Errors
    /// When a gait fails.
    pub(super) fn measure(
        &mut self,
        case: &Case,
        simulation: &mut Simulation<D>,
        loads: &SurfaceLoads,
        crossing: Option<CellCrossing>,
    ) -> Result<Measured, RunError> {
        let Simulation { problem, state, work, moving_mesh, .. } = simulation;
        if !self.probes.is_empty() && (moving_mesh.is_some() || self.places.ride()) {
            work.timing.measure(Stage::Loads, || {
                let images = moving_mesh.as_ref().map(|moving| {
                    let seen = state.mesh_in_frame();
                    moving.scene().images([&seen, &seen])
                });
                let images = images.unwrap_or_else(|| self.images.clone());
                self.find_probes(case, problem, state, &images);
            });
        }
        let mut timing = simulation.work.timing;
        let measured = timing.measure(Stage::Loads, || self.values(simulation, loads, crossing));
        simulation.work.timing = timing;
        measured
    }

    fn values(
        &self,
        simulation: &mut Simulation<D>,
        loads: &SurfaceLoads,
        crossing: Option<CellCrossing>,
    ) -> Result<Measured, RunError> {
        let bodies = body_reports(simulation, &loads.bodies)?;
        let mut flow = FlowMeasurement::new(simulation, crossing);
        let sides = measure_sides(&self.sides, simulation, loads);
        let Simulation { problem, state, moving_mesh, scalars, .. } = simulation;
        // One body has no gaps of its own
        let has_gaps = problem.groups.iter().any(|group| group.bodies.len() > 1);
        let moving = moving_mesh.as_ref().filter(|_| has_gaps);
        let gaps = moving.map(|moving| moving.present_gaps(problem, state)).transpose()?;
        let minimum_gap = |group: &Group| gaps.as_ref()?.minimum_gap_among(&group.bodies);
        let joints = measure_joints(problem, state, &loads.bodies)?;
        let groups = problem.groups.iter().zip(&state.propulsion);
        let swimmers: Vec<_> = groups
            .map(|(group, history)| {
                SwimmerMeasurement::new(problem, state, group, history, &loads.bodies)
                    .with_minimum_gap(minimum_gap(group))
            })
            .collect();
        let probes = self.probes.values(state);
        let scalars = measure_scalars(scalars.as_ref(), state, &self.probes);
        let tallies: Vec<_> = state.tracers.iter().map(Cloud::tally).collect();
        let rods: Vec<_> = (0..problem.bodies.len())
            .map(|body| RodReport::of(problem, state, &loads.bodies, body))
            .collect();
        self.balance(problem, state, loads, &mut flow);
        let value = |column: &Column| match column.source {
            Source::Body(body, quantity) => BodyMotion {
                report: &bodies[body],
                angle: state.poses[body].angle(),
                acceleration: &state.accelerations[body],
                coefficients: &self.coefficients,
                magnetic: MagneticReport::of(problem, state, body),
                rod: rods[body],
            }
            .value(quantity),
            Source::Joint(joint, quantity) => joint_value(&joints[joint], quantity),
            Source::Swimmer(swimmer, quantity) => swimmers[swimmer].value(quantity),
            Source::Probe(probe, quantity) => probes[probe].value(quantity),
            Source::Tracer(tracer, quantity) => tracer_value(&tallies[tracer], quantity),
            Source::Scalar(scalar, quantity) => scalars[scalar].value(quantity),
            Source::ScalarSurface(scalar, surface, quantity) => {
                let boundary = boundary_of(&state.mesh, surface, &self.all_sides);
                scalars[scalar].of_surface(boundary, quantity)
            }
            Source::ScalarProbe(scalar, probe, _) => scalars[scalar].at_probe(probe),
            Source::Flow(quantity) => flow.value(quantity),
            Source::Side(side, quantity) => sides[side].value(quantity),
        };
        let of_column = |column: &Column| value(column).component(column.component);
        let values = self.columns.iter().map(of_column).collect();
        Ok(Measured { bodies, values, flow })
    }

    /// Adds to the balances of energy and momentum.
    fn balance(
        &self,
        problem: &Problem<D>,
        state: &mut State<D>,
        loads: &SurfaceLoads,
        flow: &mut FlowMeasurement,
    ) {
        if self.balances_energy {
            let has_memory = self.is_unsteady && problem.has_inertia;
            flow.energy_defect =
                state.record_energy(has_memory, flow.energy_record(problem, state.time, loads));
        }
        if self.balances_momentum {
            let fluid = flow.fluid_momentum(problem.density);
            let record = momentum_record(problem, state, loads, &fluid);
            flow.momentum_defect = state.record_momentum(record);
        }
    }

    /// Adds a piece of a step to the balances: bodies that rebound within a step exchange more than its ends tell.
    pub fn balance_piece(&self, simulation: &mut Simulation<D>, loads: &SurfaceLoads) {
        if !(self.balances_energy || self.balances_momentum) {
            return;
        }
        let mut flow = FlowMeasurement::new(simulation, Some(CellCrossing::default()));
        let Simulation { problem, state, .. } = simulation;
        self.balance(problem, state, loads, &mut flow);
    }
}
