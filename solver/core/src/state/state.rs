//! `State`: what evolves: mesh, fields, bodies, at the present level and the one before.

use std::ops::Deref;

use alewife_mesh::{Boundary, Mesh, Point};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::energy::{EnergyBalance, EnergyRecord};
use super::energy_supply::{Drives, EnergySupply};
use super::initial_levels::InitialLevels;
use super::momentum::{MomentumBalance, MomentumRecord};
use super::new_level::{NewLevel, TransferredState};
use super::propulsion_history::PropulsionHistory;
use super::saved_mesh;
use super::shape_state::ShapeState;
use super::step_errors::StepErrors;
use crate::body::{MeshPoses, Pose, Twist, on_mesh};
use crate::contact::{ContactLoads, MinimumGap};
use crate::coupling::{
    BodyLoads, LoadedBodies, Problem, PropulsionPower, Solution, SurfaceStress, mean_motion,
    propulsion_power,
};
use crate::scalar::{Level, ScalarField};
use crate::space::DofLayout;
use crate::time::Bdf;
use crate::tracer::Cloud;

/// Everything that evolves. It can be read everywhere and changes in this file only: it moves on in [`State::accept`], to another
/// mesh in [`State::replace_mesh`]; [`State::restart`] lets rates jump. `begin`, `settle` and `complete_mesh` set it up;
/// the `record_` methods and their like keep the books.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct State<const D: usize>(pub(super) Evolving<D>);

impl<const D: usize> Deref for State<D> {
    type Target = Evolving<D>;

    fn deref(&self) -> &Evolving<D> {
        &self.0
    }
}

/// What a [`State`] holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Evolving<const D: usize> {
    /// Number of steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// The last step (s), zero before the first and where rates jump.
    pub last_step: f64,
    /// Meshes generated since the first.
    pub remeshes: usize,
    /// The mesh at present, in the laboratory.
    #[serde(with = "saved_mesh")]
    pub mesh: Mesh<D>,
    /// Where the frame of reference is at present (m).
    pub origin: Vector3<f64>,
    /// Positions of the nodes at present, seen from the frame (m).
    pub nodes: Vec<Point<D>>,
    /// Positions of the same nodes one step before, seen from the frame (m).
    pub nodes_before: Vec<Point<D>>,
    /// Fields and rigid velocities at present.
    pub now: Solution<D>,
    /// Fields and rigid velocities one step before.
    pub previous: Solution<D>,
    /// Poses of the bodies at present, in the laboratory.
    pub poses: Vec<Pose>,
    /// Poses of the bodies one step before.
    pub previous_poses: Vec<Pose>,
    /// Coordinates of bodies that have some.
    pub shapes: ShapeState,
    /// What is added to the centre of a body for where it is in the mesh (m): whole periods.
    pub image_shifts: Vec<Vector3<f64>>,
    /// Rates of change of the velocities at the nodes (m/s2).
    pub rates: Vec<Point<D>>,
    /// Rates of change of the momenta of the bodies, over their inertia (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
    /// Rates of change of their velocities (m/s2, rad/s2): others, where the inertia of a body turns with it.
    pub twist_rates: Vec<Twist>,
    /// The largest speed so far, or that is known to come (m/s).
    pub top_speed: f64,
    /// The work done on fluid and bodies so far, and what drives them.
    pub supply: EnergySupply,
    /// What the errors of the steps amount to.
    pub step_errors: StepErrors,
    /// Loads of contact, and the smallest gap.
    pub contact: ContactLoads,
    /// What each group of bodies does and has done.
    pub propulsion: Vec<PropulsionHistory>,
    /// Where the work of the bodies went so far.
    pub energy: EnergyBalance,
    /// Impulses and momenta so far.
    pub momentum: MomentumBalance,
    /// Particles that the flow carries, a cloud for each `[[tracer]]`.
    pub tracers: Vec<Cloud<D>>,
    /// What the flow carries and what diffuses, one for each `[[scalar]]`.
    pub scalars: Vec<ScalarField>,
}

impl<const D: usize> State<D> {
    /// Everything at rest at time zero.
    #[must_use]
    pub fn at_rest(problem: &Problem<D>, mesh: Mesh<D>) -> Self {
        let n_bodies = problem.bodies.len();
        let layout = DofLayout::new(&mesh, n_bodies, problem.modes().len());
        let at_rest = Solution::at_rest(&layout.with_coordinates(problem.n_coordinates()));
        let mut poses: Vec<Pose> = problem.bodies.iter().map(|body| body.pose).collect();
        let shapes = ShapeState::at_rest(problem.initial_coordinates());
        problem.follow_coordinates(&mut poses, &shapes.now);
        Self(Evolving {
            step: 0,
            time: 0.0,
            last_step: 0.0,
            remeshes: 0,
            origin: Vector3::zeros(),
            nodes: mesh.nodes.clone(),
            nodes_before: mesh.nodes.clone(),
            now: at_rest.clone(),
            previous: at_rest,
            previous_poses: poses.clone(),
            shapes,
            image_shifts: vec![Vector3::zeros(); n_bodies],
            rates: vec![Point::<D>::zeros(); mesh.n_nodes()],
            accelerations: vec![Twist::default(); n_bodies],
            twist_rates: vec![Twist::default(); n_bodies],
            top_speed: 0.0,
            supply: EnergySupply::default(),
            step_errors: StepErrors::default(),
            contact: ContactLoads::none(n_bodies),
            propulsion: vec![PropulsionHistory::default(); problem.groups.len()],
            energy: EnergyBalance::default(),
            momentum: MomentumBalance::default(),
            tracers: Vec::new(),
            scalars: Vec::new(),
            poses,
            mesh,
        })
    }

    /// The same with bodies moved by whole periods (m) to where they are in the mesh.
    #[must_use]
    pub fn with_image_shifts(mut self, image_shifts: Vec<Vector3<f64>>) -> Self {
        self.0.image_shifts = image_shifts;
        self
    }

    /// The flow of a state, with both levels.
    #[must_use]
    pub fn levels(&self) -> InitialLevels<D> {
        InitialLevels {
            now: self.now.clone(),
            previous: self.previous.clone(),
            nodes_before: Some(self.nodes_before.clone()),
            previous_poses: Some(self.previous_poses.clone()),
        }
    }

    /// Gives a state at its start a flow.
    pub fn begin(&mut self, levels: InitialLevels<D>) {
        let InitialLevels { now, previous, nodes_before, previous_poses } = levels;
        let own = &mut self.0;
        (own.now, own.previous) = (now, previous);
        own.nodes_before = nodes_before.unwrap_or_else(|| own.nodes.clone());
        own.previous_poses = previous_poses.unwrap_or_else(|| own.poses.clone());
    }

    /// Puts the nodes (m) of a state at its start where sides that move have them, and finds the smallest gap.
    pub fn settle(&mut self, nodes: Option<Vec<Point<D>>>, minimum_gap: Option<MinimumGap>) {
        let own = &mut self.0;
        if let Some(nodes) = nodes {
            own.nodes_before.clone_from(&nodes);
            own.mesh.nodes.clone_from(&nodes);
            own.nodes = nodes;
        }
        own.contact.minimum_gap = minimum_gap;
    }

    /// Lets rates jump at present: what was before does not count for what comes.
    pub fn restart(&mut self) {
        self.0.last_step = 0.0;
    }

    /// Notes a speed (m/s) that is known to come.
    pub fn expect_speed(&mut self, speed: f64) {
        self.0.top_speed = self.top_speed.max(speed);
    }

    /// Says of the step that was accepted last that it is a piece of one that is not over: it does not count yet.
    pub fn continue_step(&mut self) {
        self.0.step -= 1;
    }

    /// Replaces the time (s), a sum of steps, by what it is without their rounding.
    pub fn round_time(&mut self, time: f64) {
        self.0.time = time;
    }

    /// Replaces the mesh.
    pub fn replace_mesh(&mut self, transferred: TransferredState<D>) {
        let own = &mut self.0;
        let TransferredState { mesh, nodes_before, now, previous, rates, image_shifts, scalars } =
            transferred;
        (own.now, own.previous, own.rates) = (now, previous, rates);
        (own.image_shifts, own.scalars) = (image_shifts, scalars);
        own.nodes.clone_from(&mesh.nodes);
        own.nodes_before = nodes_before;
        own.mesh = mesh;
        let origin = on_mesh::<D>(&own.origin);
        for node in &mut own.mesh.nodes {
            *node += origin;
        }
        own.remeshes += 1;
    }

    /// Gives the state the flow that its mesh has at present, where velocities have no memory; those of bodies one step
    /// before are changed by as much.
    pub fn replace_flow(&mut self, now: Solution<D>) {
        let own = &mut self.0;
        own.previous.shift_bodies(&own.now, &now);
        own.now = now;
    }

    /// The same without what is known from elsewhere or follows from the rest, as a file has it: boundaries and nodes of
    /// the mesh, single contacts.
    #[must_use]
    pub fn without_derived(&self) -> Self {
        let mut state = self.clone();
        state.0.mesh.nodes = Vec::new();
        state.0.mesh.topology_mut().boundaries = Vec::new();
        state.0.contact.contacts = Vec::new();
        state.0.contact.on_coordinates = Vec::new();
        state
    }

    /// Gives a state that was read from a file the boundaries of its mesh, and the positions of its nodes.
    pub fn complete_mesh(&mut self, boundaries: &[Boundary]) {
        let own = &mut self.0;
        let origin = on_mesh::<D>(&own.origin);
        own.mesh.nodes = own.nodes.iter().map(|node| node + origin).collect();
        own.mesh.topology_mut().boundaries = boundaries.to_vec();
    }

    /// Notes the powers of the groups at the start, or where rates jump.
    pub fn start_propulsion(&mut self, powers: &[PropulsionPower]) {
        let histories = self.0.propulsion.iter_mut();
        histories.zip(powers).for_each(|(own, power)| own.start(power));
    }

    /// Notes where swimmers are.
    pub fn record_cycles(&mut self, problem: &Problem<D>) {
        let own = &mut self.0;
        for (group, history) in problem.groups.iter().zip(&mut own.propulsion) {
            let Some(period) = group.period else { continue };
            let center = mean_motion(problem, group, &own.poses, &own.now.twists).center;
            let orientation = own.poses[group.bodies[0]].orientation;
            let record = history.record(own.time, center, orientation);
            history.cycles.push(record, period);
        }
    }

    /// Ends the estimate of the error of a group's first cycle: it has been reported.
    pub fn end_cycle_error(&mut self, group: usize) {
        self.0.propulsion[group].error.end();
    }

    /// Adds to the balance of energy; its defect.
    pub fn record_energy(&mut self, has_memory: bool, record: EnergyRecord) -> f64 {
        self.0.energy.add(has_memory, record)
    }

    /// Notes the forces (N) on the fluid and on the bodies at the end of the last step.
    pub fn record_forces(&mut self, forces: &[Vector3<f64>], bdf: &Bdf) {
        self.0.momentum.add_forces(forces, bdf);
    }

    /// Adds to the balance of momentum; its defect.
    pub fn record_momentum(&mut self, record: MomentumRecord) -> f64 {
        self.0.momentum.add(record)
    }

    /// Notes what drives fluid and bodies in the last step, or at the start.
    pub fn record_drives(&mut self, drives: &Drives) {
        let step = self.last_step;
        self.0.supply.add(step, drives);
    }

    /// Notes the kinetic and elastic energy of fluid and bodies at the start (J), and the speed they have or
    /// get of it (m/s).
    pub fn record_start(&mut self, energy: f64, speed: f64) {
        (self.0.supply.initial, self.0.supply.initial_speed) = (Some(energy), speed);
    }

    /// Notes the errors of the last step.
    pub fn record_step_errors(&mut self, errors: &StepErrors) {
        self.0.step_errors.add(errors);
    }

    /// Has particles carried from the level before to the present one.
    pub fn carry_tracers(&mut self, carry: impl FnOnce(&Evolving<D>, &mut Vec<Cloud<D>>)) {
        let mut clouds = std::mem::take(&mut self.0.tracers);
        carry(&self.0, &mut clouds);
        self.0.tracers = clouds;
    }

    /// Gives a state at its start its scalars.
    pub fn begin_scalars(&mut self, scalars: Vec<ScalarField>) {
        self.0.scalars = scalars;
    }

    /// Takes over the scalars of the level that was accepted, after a step by these differences.
    pub fn accept_scalars(&mut self, levels: Vec<Level>, bdf: Option<&Bdf>) {
        for (own, level) in self.0.scalars.iter_mut().zip(levels) {
            own.accept(level, bdf);
        }
    }

    /// Time of the level before (s).
    #[must_use]
    pub fn time_before(&self) -> f64 {
        self.time - self.last_step
    }

    /// Moves on in time.
    pub fn accept(&mut self, problem: &Problem<D>, level: NewLevel<D>) {
        let origin = self.origin_at(problem, &level.poses);
        let own = &mut self.0;
        own.top_speed = own.top_speed.max(level.solution.top_speed());
        own.origin = origin;
        let origin = on_mesh::<D>(&origin);
        for (node, seen) in own.mesh.nodes.iter_mut().zip(&level.nodes) {
            *node = seen + origin;
        }
        for (history, step) in own.propulsion.iter_mut().zip(&level.propulsion) {
            history.add_step(level.step, step);
        }
        own.nodes_before = std::mem::replace(&mut own.nodes, level.nodes);
        own.previous_poses = std::mem::replace(&mut own.poses, level.poses);
        own.shapes.before = std::mem::replace(&mut own.shapes.now, level.coordinates);
        own.shapes.accelerations = level.coordinate_accelerations;
        own.previous = std::mem::replace(&mut own.now, level.solution);
        if let Some(rates) = level.rates {
            own.rates = rates;
        }
        (own.accelerations, own.contact) = (level.accelerations, level.contact);
        own.twist_rates = level.twist_rates;
        own.step += 1;
        (own.time, own.last_step) = (level.time, level.step);
    }

    /// Poses where bodies would be in the mesh.
    #[must_use]
    pub fn in_mesh(&self, poses: &[Pose]) -> MeshPoses {
        self.in_frame(&Vector3::zeros(), poses)
    }

    /// Poses where bodies would be in the mesh, seen from a frame at `origin` (m).
    #[must_use]
    pub fn in_frame(&self, origin: &Vector3<f64>, poses: &[Pose]) -> MeshPoses {
        MeshPoses::seen_from(origin, poses, &self.image_shifts)
    }

    /// Poses where bodies would be in the mesh, seen from the frame that goes with them.
    #[must_use]
    pub fn in_own_frame(&self, problem: &Problem<D>, poses: &[Pose]) -> MeshPoses {
        self.in_frame(&self.origin_at(problem, poses), poses)
    }

    /// The mesh at present, seen from the frame.
    #[must_use]
    pub fn mesh_in_frame(&self) -> Mesh<D> {
        self.mesh.with_nodes(self.nodes.clone())
    }

    /// What the groups do in a flow, with bodies at these poses in the laboratory.
    #[must_use]
    pub fn propulsion_powers(
        &self,
        problem: &Problem<D>,
        poses: &[Pose],
        twists: &[Twist],
        loads: &[BodyLoads],
        stress: &SurfaceStress<'_, D>,
    ) -> Vec<PropulsionPower> {
        let bodies = LoadedBodies { poses, image_shifts: &self.image_shifts, twists, loads };
        let groups = problem.groups.iter();
        groups.map(|group| propulsion_power(problem, group, &bodies, stress)).collect()
    }

    /// Where the frame is with bodies at these poses (m).
    #[must_use]
    pub fn origin_at(&self, problem: &Problem<D>, poses: &[Pose]) -> Vector3<f64> {
        problem
            .frame
            .map_or(Vector3::zeros(), |body| poses[body].center - problem.bodies[body].pose.center)
    }
}
