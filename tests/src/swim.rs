//! A case marched step by step on a mesh that is given.

use alewife_core::body::Twist;
use alewife_core::case::{Convection, Model, Steady};
use alewife_core::coupling::{BodyLoads, FluidSystem, Levels, Problem, body_loads};
use alewife_core::simulation::{
    Follower, March, MeshPath, State, Timing, build_problem, shape_motion, solve_steady,
};
use alewife_core::time::Bdf;
use alewife_mesh::{Mesh, PlacedShape, Point};

/// A march on one mesh, which follows its bodies.
pub struct Swim {
    /// What is solved.
    pub problem: Problem,
    /// What evolves.
    pub state: State,
    /// Loads of the fluid after the last step.
    pub loads: Vec<BodyLoads>,
    system: FluidSystem,
    follower: Follower,
}

impl Swim {
    /// A case on a mesh of it, at rest at time zero.
    ///
    /// # Panics
    /// When the case makes no problem on this mesh.
    #[must_use]
    pub fn new(model: &Model, mesh: Mesh<2>) -> Self {
        let problem = build_problem(model, &mesh).expect("the case is a problem");
        let shapes: Vec<PlacedShape> = model
            .bodies
            .iter()
            .map(|body| {
                let mut placed = body.placed(model.case.mesh.scale);
                if let Some(motion) = shape_motion(body).expect("the gait fits") {
                    placed.shape = motion.at(0.0).expect("the gait has a shape").shape();
                }
                placed
            })
            .collect();
        let poses: Vec<_> = problem.bodies.iter().map(|body| body.pose).collect();
        let system = FluidSystem::new(&problem, &mesh, &poses, false);
        let state = State::at_rest(&problem, mesh);
        let domain = model.case.mesh_domain();
        let made_at = (state.places.clone(), 0.0);
        let follower = Follower::new(model, &problem, &state.mesh, domain, shapes, made_at)
            .expect("the mesh follows");
        let loads = vec![BodyLoads::default(); problem.bodies.len()];
        Self { problem, state, loads, system, follower }
    }

    /// Sets fluid and bodies going with the same velocity (m/s).
    pub fn stream(&mut self, velocity: Point<2>) {
        for level in [&mut self.state.now, &mut self.state.previous] {
            level.velocity.fill(velocity);
            level.twists.fill(Twist::planar([velocity.x, velocity.y, 0.0]));
        }
    }

    /// The Stokes flow at time zero.
    ///
    /// # Panics
    /// When it is not found.
    pub fn begin(&mut self) {
        let Self { problem, state, loads, system, .. } = self;
        let poses: Vec<_> = problem.bodies.iter().map(|body| body.pose).collect();
        let settings = Steady { tolerance: 1e-10, max_iterations: 5 };
        let levels = Levels::steady(problem, 0.0);
        let mut timing = Timing::default();
        let at = (0.0, &levels);
        let flow = solve_steady(system, problem, &state.mesh, &poses, at, &settings, &mut timing);
        let flow = flow.expect("the flow is found");
        let (layout, sides) = (&system.layout, &system.sides);
        let velocity = &flow.solution.velocity;
        *loads = body_loads(problem, &state.mesh, layout, sides, &poses, &flow.residual, velocity);
        state.now = flow.solution.clone();
        state.previous = flow.solution;
    }

    /// One step (s): explicit without inertia, else by BDF2, the first one by backward Euler.
    ///
    /// # Panics
    /// When the step cannot be made.
    pub fn step(&mut self, step: f64) {
        let Self { problem, state, loads, system, follower } = self;
        let march = March {
            problem,
            choice: Convection::Extrapolated,
            path: MeshPath::Bodies(follower),
            contact: None,
        };
        let mut timing = Timing::default();
        let before = state.last_step;
        let made = if problem.has_inertia {
            let bdf =
                if before > 0.0 { Bdf::second_order(step, before) } else { Bdf::first_order(step) };
            march.advance(system, state, &bdf, &mut timing)
        } else {
            march.advance_explicit(system, state, step, false, &mut timing)
        };
        *loads = made.expect("the step is made").loads;
    }

    /// Rate of work of all bodies on the fluid (W).
    #[must_use]
    pub fn power(&self) -> f64 {
        self.loads.iter().map(|load| load.power).sum()
    }
}
