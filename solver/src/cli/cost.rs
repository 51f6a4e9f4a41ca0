//! What a run would cost: steps, linear systems, new meshes, and the CPU time and memory for them.

use crate::case::{
    Adaptive, Body, Convection, FlowModel, Geometry, Model, Motion, Scheme, TimeSettings, Unsteady,
};
use crate::coupling::memory_estimate;
use crate::run::DOFS_OF_CELL;

// All constants are fitted to the shipped cases of over 3 s of CPU time in `docs/validation.md`, one
// core of the machine of `docs/performance.md`; `solver/tests/command_line/estimates.rs` compares.

/// CPU time of a pass with 10^4 unknowns on a moving mesh (s): mesh motion, assembly, factorisation or
/// iterations with old factors, solve, loads.
const PASS: f64 = 0.0114;
/// Power of the unknowns it goes with.
const GROWTH: f64 = 1.15;
/// Part of it on a mesh that stays, where it goes with the unknowns: without convection, where the matrix
/// stays as well, and with it.
const ON_FIXED_MESH: [f64; 2] = [0.5, 0.8];
/// Linear systems of the start of an unsteady run besides its steps: the flow there, and pieces of the
/// first step.
const START_SYSTEMS: f64 = 5.0;
/// Linear systems of a step in which convection is solved by Newton's method.
const NEWTON_SYSTEMS: f64 = 2.7;
/// Linear systems of a steady flow with convection.
const STEADY_SYSTEMS: f64 = 6.0;
/// Part of a pass that one takes once nothing moves any more, on a mesh that could: old factors serve.
const OF_STILL_PASS: f64 = 0.55;
/// Part of a pass that a stage of `rk3` takes where arms move bodies straight on: half of them are solved
/// with old factors.
const OF_EXPLICIT_PASS: f64 = 0.8;
/// The same where the mesh turns with a body, which nearly always asks for new factors.
const OF_TURNING_PASS: f64 = 1.35;
/// Steps of an adaptive run until their size is that of its error, without and with inertia, where it
/// begins with an acceleration and steps get longer by a fifth each (24 to 40).
const FIRST_STEPS: [f64; 2] = [12.0, 40.0];
/// Part of a gap that closes in a step, over the third root of the tolerance: errors of gaps count ten times,
/// and go with the third power of that part.
const CLOSING: f64 = 0.5;
/// Steps in which a body in contact loses its speed down to a thousandth, where steps no longer follow it.
const SETTLING_STEPS: f64 = 60.0;
/// Most of what bouncing multiplies them by: what bounces more leaves contact, and flies in longer steps.
const MOST_BOUNCING: f64 = 2.0;
/// Passes of these steps with inertia besides the first: of a round body, and of one that contact turns as
/// well.
const MORE_PASSES: [f64; 2] = [0.4, 1.8];
/// CPU time of a new mesh with 10^4 unknowns (s), and with inertia, which asks for projections.
const NEW_MESH: [f64; 2] = [0.0265, 0.0636];
/// New meshes for each reach that bodies move.
const MESHES_OF_PATH: f64 = 0.7;
/// New meshes in each period of a swimmer that deforms.
const MESHES_OF_PERIOD: f64 = 4.0;
/// Memory of a run with new meshes over that of one system, and with inertia.
const REMESHED_MEMORY: [f64; 2] = [1.7, 2.3];

// In space, fitted to runs with 7 10^4 to 7 10^5 unknowns, which are solved for by iterations.

/// CPU time of a linear system of a steady flow with 10^5 unknowns (s), without convection and with it:
/// assembly, preconditioner, iterations, loads. It goes with the unknowns.
const SYSTEM_IN_SPACE: [f64; 2] = [0.87, 1.35];
/// Part of it that a system of a time step takes.
const OF_STEP_IN_SPACE: f64 = 0.45;
/// The same on a moving mesh, with its motion and the meshes that replace it.
const OF_MOVING_STEP_IN_SPACE: f64 = 0.8;
/// Memory with convection over that without: matrices are upwinded, and more iterations kept.
const CONVECTIVE_MEMORY: f64 = 1.3;

/// An estimate of what a run costs.
///
/// A run is made of passes, each of which solves one linear system, and of new meshes; both go with the
/// unknowns, of which films that close bring more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Linear systems.
    pub systems: f64,
    /// New meshes.
    pub new_meshes: f64,
    /// Unknowns that films bring with them, at most.
    pub in_films: f64,
    /// CPU time on one core (s).
    pub seconds: f64,
    /// That of one step of an unsteady run (s).
    pub step_seconds: Option<f64>,
    /// Memory at most (bytes).
    pub memory: f64,
}

/// What is known of the first mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstMesh {
    /// Free unknowns.
    pub free: usize,
    /// Velocities and pressures at its nodes.
    pub on_mesh: usize,
    /// Length of its shortest edge (m).
    pub shortest_edge: f64,
    /// CPU time it took (s).
    pub seconds: f64,
}

impl Cost {
    /// The cost of a case whose first mesh is known.
    #[must_use]
    pub fn of(model: &Model, mesh: &FirstMesh) -> Self {
        if model.case.geometry == Geometry::Spatial {
            return Self::in_space(model, mesh);
        }
        let Films { most, mean } = Films::of(model);
        let unknowns = mesh.free as f64 + mean;
        let systems = n_systems(model, mesh.shortest_edge);
        let steps = steps_of(model, mesh.shortest_edge);
        let is_fixed = steps.is_some() && !model.mesh_moves();
        let growth = if is_fixed { 1.0 } else { GROWTH };
        let pass = PASS * (unknowns / 1e4).powf(growth);
        let flow = model.case.fluid.model;
        let part = part_of_pass(model);
        let new_meshes = n_new_meshes(model);
        let inertia = usize::from(flow != FlowModel::Stokes);
        let start = NEW_MESH[0] * mesh.free as f64 / 1e4;
        let seconds =
            start + systems * part * pass + new_meshes * NEW_MESH[inertia] * unknowns / 1e4;
        let memory = memory_estimate(2, mesh.on_mesh as f64 + most);
        let memory = if new_meshes >= 1.0 { REMESHED_MEMORY[inertia] * memory } else { memory };
        let in_steps = (seconds - start) * (1.0 - START_SYSTEMS / systems);
        let step_seconds = steps.map(|steps| in_steps / steps);
        Self { systems, new_meshes, in_films: most, seconds, step_seconds, memory }
    }

    /// That in space.
    fn in_space(model: &Model, mesh: &FirstMesh) -> Self {
        let unknowns = mesh.free as f64 / 1e5;
        let systems = n_systems(model, mesh.shortest_edge);
        let steps = steps_of(model, mesh.shortest_edge);
        let part = match steps {
            Some(_) if model.mesh_moves() => OF_MOVING_STEP_IN_SPACE,
            Some(_) => OF_STEP_IN_SPACE,
            None => 1.0,
        };
        let has_convection = model.case.fluid.model == FlowModel::NavierStokes;
        let system = SYSTEM_IN_SPACE[usize::from(has_convection)];
        let in_systems = systems * part * system * unknowns;
        let growth = if has_convection { CONVECTIVE_MEMORY } else { 1.0 };
        Self {
            systems,
            new_meshes: 0.0,
            in_films: 0.0,
            seconds: mesh.seconds + in_systems,
            step_seconds: steps.map(|steps| in_systems * (1.0 - START_SYSTEMS / systems) / steps),
            memory: growth * memory_estimate(3, mesh.on_mesh as f64),
        }
    }
}

/// What a pass takes over one on a moving mesh.
fn part_of_pass(model: &Model) -> f64 {
    let TimeSettings::Unsteady(time) = &model.case.time else { return 1.0 };
    if !model.mesh_moves() {
        return ON_FIXED_MESH[usize::from(model.case.fluid.model == FlowModel::NavierStokes)];
    }
    let still = model.time_to_stop().map_or(0.0, |stop| (1.0 - stop / time.end).max(0.0));
    let turns = |body: &Body| {
        body.motion == Motion::Free && body.turns() && !body.is_round() && !body.deforms()
    };
    let case = &model.case;
    let has_arms = model.joints.iter().all(|joint| joint.kind.is_arm());
    let deforms = model.bodies.iter().any(Body::deforms);
    let part = if time.scheme == Scheme::Rk3 && has_arms && !deforms {
        OF_EXPLICIT_PASS
    } else if model.joints.is_empty() && case.contact.is_none() && model.bodies.iter().any(turns) {
        OF_TURNING_PASS
    } else {
        1.0
    };
    part * (1.0 - still * (1.0 - OF_STILL_PASS))
}

/// Unknowns that films bring with them.
struct Films {
    /// With all of them.
    most: f64,
    /// Averaged in time.
    mean: f64,
}

impl Films {
    fn of(model: &Model) -> Self {
        let mut films = Self { most: 0.0, mean: 0.0 };
        let TimeSettings::Unsteady(time) = &model.case.time else { return films };
        for met in model.encounters() {
            let unknowns = DOFS_OF_CELL * met.film_cells;
            let share = 1.0 - met.time / time.end;
            if share > 0.0 {
                films.most += unknowns;
                films.mean += share * unknowns;
            }
        }
        films
    }
}

/// Steps of a run: exact where they are fixed.
#[must_use]
pub fn n_steps(model: &Model, time: &Unsteady, shortest_edge: f64) -> f64 {
    let Some(adaptive) = &time.adaptive else { return (time.end / time.step).ceil() };
    let largest = adaptive.largest.unwrap_or(time.end / 10.0);
    let crossing = model.expected_speed().map(|speed| adaptive.cfl * shortest_edge / speed);
    let moving = crossing.unwrap_or(largest).min(largest);
    let rest = model.time_to_rest().unwrap_or(time.end).min(time.end);
    let longest = rest / moving + (time.end - rest) / largest;
    let StepsByError { first, closing, settling } = StepsByError::of(model, time, adaptive);
    // A gap without contact closes until the end
    let closes =
        if model.case.contact.is_some() { longest + closing } else { longest.max(closing) };
    first + closes + settling
}

/// Steps of an adaptive run that are as long as their error allows.
struct StepsByError {
    /// Until they have that length.
    first: f64,
    /// While a gap closes.
    closing: f64,
    /// While a body in contact comes to rest.
    settling: f64,
}

impl StepsByError {
    fn of(model: &Model, time: &Unsteady, adaptive: &Adaptive) -> Self {
        let has_inertia = model.case.fluid.model != FlowModel::Stokes;
        let met = model.encounters();
        let met = met.iter().filter(|met| met.time < time.end);
        let closing = met.clone().map(|met| met.closing).fold(0.0, f64::max);
        let part = (CLOSING * adaptive.tolerance.cbrt()).min(adaptive.gap);
        let settles = has_inertia && model.case.contact.is_some() && met.count() > 0;
        let settling =
            if settles { SETTLING_STEPS * model.bouncing().clamp(1.0, MOST_BOUNCING) } else { 0.0 };
        let first = FIRST_STEPS[usize::from(has_inertia)];
        Self { first, closing: closing / part, settling }
    }
}

/// Steps of an unsteady run.
fn steps_of(model: &Model, shortest_edge: f64) -> Option<f64> {
    match &model.case.time {
        TimeSettings::Steady(_) => None,
        TimeSettings::Unsteady(time) => Some(n_steps(model, time, shortest_edge).max(1.0)),
    }
}

/// Linear systems a run solves: exact for steady Stokes flow.
fn n_systems(model: &Model, shortest_edge: f64) -> f64 {
    let case = &model.case;
    let time = match (&case.time, case.fluid.model) {
        (TimeSettings::Steady(_), FlowModel::NavierStokes) => return STEADY_SYSTEMS,
        (TimeSettings::Steady(_), _) => return 1.0,
        (TimeSettings::Unsteady(time), _) => time,
    };
    let is_newton =
        time.convection == Convection::Newton && case.fluid.model == FlowModel::NavierStokes;
    let iterations = if is_newton { NEWTON_SYSTEMS } else { 1.0 };
    let steps = n_steps(model, time, shortest_edge) + more_passes(model, time);
    START_SYSTEMS + (steps + trial_steps(model, time)) * passes(model, time) * iterations
}

/// Steps of the first cycle with steps twice as long, which a run without inertia makes beforehand.
fn trial_steps(model: &Model, time: &Unsteady) -> f64 {
    let periods = model.swimmers.iter().filter_map(|swimmer| swimmer.period);
    let longest = periods.fold(0.0, f64::max);
    let is_made = model.case.fluid.model == FlowModel::Stokes && time.adaptive.is_none();
    if is_made && longest <= time.end { 0.5 * longest / time.step } else { 0.0 }
}

/// Passes of an adaptive run with contact besides one of each step.
fn more_passes(model: &Model, time: &Unsteady) -> f64 {
    let has_contact = model.case.fluid.model != FlowModel::Stokes && model.case.contact.is_some();
    let Some(adaptive) = time.adaptive.as_ref().filter(|_| has_contact) else { return 0.0 };
    let is_turned = model.bodies.iter().any(|body| body.turns() && !body.is_round());
    let StepsByError { first, closing, settling } = StepsByError::of(model, time, adaptive);
    MORE_PASSES[usize::from(is_turned)] * (first + closing + settling)
}

/// Passes of a step: until bodies are where the mesh was made for.
fn passes(model: &Model, time: &Unsteady) -> f64 {
    if time.scheme == Scheme::Rk3 {
        // One for each stage
        return 3.0;
    }
    let bends = model.joints.iter().any(|joint| !joint.kind.is_arm());
    let free = model.bodies.iter().filter(|body| body.motion == Motion::Free);
    let n_free = free.clone().filter(|body| body.translates(model.case.geometry)).count() as f64;
    if bends || free.clone().any(|body| body.deforms()) {
        return 2.0;
    }
    // Among many some are always in contact, which stops them within a step, if that is not shortened
    let crowd = if model.case.contact.is_some() && time.adaptive.is_none() {
        (n_free - 2.0).max(0.0)
    } else {
        0.0
    };
    3.0 - 2.0 * (-crowd / 6.0).exp()
}

/// New meshes of a run.
fn n_new_meshes(model: &Model) -> f64 {
    let TimeSettings::Unsteady(time) = &model.case.time else { return 0.0 };
    if !model.mesh_moves() {
        return 0.0;
    }
    let periods = model.swimmers.iter().filter_map(|swimmer| {
        let bends = |body: &usize| {
            let joint = model.joint_above(*body).map(|joint| &model.joints[joint].kind);
            model.bodies[*body].deforms() || joint.is_some_and(|kind| !kind.is_arm())
        };
        swimmer.bodies.iter().any(bends).then_some(time.end / swimmer.period?)
    });
    // All that deform ask for new meshes at the same times
    let cycles = periods.fold(0.0, f64::max);
    MESHES_OF_PATH * model.expected_paths(time.end) + MESHES_OF_PERIOD * cycles
}
