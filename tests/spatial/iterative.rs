//! Iterative solution of fluid and bodies: against factors, on finer meshes, on more threads.

use alewife_core::algebra::IterativeSettings;
use alewife_core::body::{Inertia, LoadedBody, MeshPoses, Mode, Pose, Wrench};
use alewife_core::case::Steady;
use alewife_core::coupling::{
    BodiesAt, BodyShapes, DivergenceFreeProjection, Drive, FluidSystem, Problem, RigidBody, Side,
    Solution, SolveError, SolverChoice,
};
use alewife_core::space::Metric;
use alewife_core::step::SteadyFlow;
use alewife_core::timing::Timing;
use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, Point};
use nalgebra::{DMatrix, Matrix3, UnitQuaternion, Vector3};
use tests::{BoxOfTetrahedra, figure, fluid_only, one_system_from_rest, steady_with, workspace};

/// Viscosity and density far from one: sizes of forces and pressures are not those of velocities.
const VISCOSITY: f64 = 2e-3;
const DENSITY: f64 = 30.0;

/// How a flow is driven and bounded.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Setting {
    box_of: BoxOfTetrahedra,
    /// Whether the side on the right lets the fluid out.
    is_open: bool,
    /// Factor of the new velocity in its rate (1/s).
    rate: f64,
}

impl Setting {
    fn stokes(cubes: usize, has_body: bool) -> Self {
        Self { box_of: BoxOfTetrahedra { cubes, has_body }, is_open: false, rate: 0.0 }
    }

    /// A lid that moves, or where the box is open, fluid that is driven in.
    fn problem(&self, mesh: &Mesh<3>) -> Problem<3> {
        let given = |is_open: bool| -> Side<3> {
            let profile = move |x: &Point<3>, _: f64| {
                let at = |inside: bool, value: f64| if inside { value } else { 0.0 };
                let bump = (1.0 - x[0] * x[0]) * (1.0 - x[1] * x[1]);
                let inflow = (1.0 - x[2] * x[2]) * (1.0 - x[1] * x[1]);
                if is_open {
                    Point::<3>::new(at(x[0] < -1.0 + 1e-9, inflow), 0.0, 0.0)
                } else {
                    Point::<3>::new(
                        at(x[2] > 1.0 - 1e-9, bump),
                        0.3 * at(x[2] > 1.0 - 1e-9, bump),
                        0.0,
                    )
                }
            };
            Side::Velocity { profile: Box::new(profile), is_wall: true }
        };
        let sides = mesh.boundaries.iter().map(|boundary| match boundary.kind {
            BoundaryKind::Body(_) => None,
            _ if self.is_open && boundary.name == "right" => Some(Side::TractionFree),
            _ => Some(given(self.is_open)),
        });
        let fluid = fluid_only(mesh, sides.collect(), DENSITY, VISCOSITY, Metric::Cartesian);
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1);
        let body = || RigidBody {
            inertia: Inertia { mass: 2.1, tensor: Matrix3::identity() * 0.1 },
            load: Wrench {
                force: Vector3::new(0.4, -1.1, 0.7) * VISCOSITY,
                torque: Vector3::new(-0.6, 0.2, 0.9) * VISCOSITY,
            },
            ..RigidBody::held("body", BoundaryId::new(0), Pose::spatial(Vector3::zeros(), turn))
                .free()
        };
        let bodies = fluid.bodies.iter().map(|_| body()).collect();
        Problem { bodies, has_convection: false, ..fluid }
    }

    /// One linear system from rest.
    fn solve(&self, choice: SolverChoice) -> Solved {
        self.try_solve(choice).expect("the system is solved")
    }

    fn try_solve(&self, choice: SolverChoice) -> Result<Solved, SolveError> {
        let mesh = self.box_of.mesh();
        solve_from_rest(&self.problem(&mesh), &mesh, self.rate, choice)
    }

    fn iterations(&self) -> usize {
        let solved = self.solve(SolverChoice::Iterative(IterativeSettings::default()));
        println!("{self:?}: {} unknowns, {} iterations", solved.n_unknowns, solved.iterations);
        solved.iterations
    }
}

pub(super) struct Solved {
    solution: Solution<3>,
    pub n_unknowns: usize,
    pub iterations: usize,
}

/// One linear system from rest, with the factor `rate` (1/s) of the new velocity in its rate.
pub(super) fn solve_from_rest(
    problem: &Problem<3>,
    mesh: &Mesh<3>,
    rate: f64,
    choice: SolverChoice,
) -> Result<Solved, SolveError> {
    let poses = MeshPoses::of(problem.bodies.iter().map(|body| body.pose));
    let mut system = FluidSystem::with_solver(problem, mesh, &poses, false, choice);
    let next = one_system_from_rest(&mut system, problem, mesh, rate, &mut Timing::default());
    let iterations = system.accuracy().refinements;
    next.map(|solution| Solved { solution, n_unknowns: system.n_unknowns, iterations })
}

/// Largest difference of two flows over the largest value, of velocities and pressures.
fn difference(one: &Solution<3>, other: &Solution<3>) -> [f64; 2] {
    let (mut velocity, mut size) = (0.0f64, 0.0f64);
    for (a, b) in one.velocity.iter().zip(&other.velocity) {
        velocity = velocity.max((a - b).amax());
        size = size.max(a.amax());
    }
    let (mut pressure, mut level) = (0.0f64, 0.0f64);
    for (a, b) in one.pressure.iter().zip(&other.pressure) {
        pressure = pressure.max((a - b).abs());
        level = level.max(a.abs());
    }
    for (a, b) in one.twists.iter().zip(&other.twists) {
        velocity = velocity.max((a.linear - b.linear).amax()).max((a.angular - b.angular).amax());
    }
    [velocity / size, pressure / level]
}

#[test]
fn iterations_and_factors_give_the_same_flow() {
    let settings = IterativeSettings { tolerance: 1e-11, ..IterativeSettings::default() };
    for has_body in [false, true] {
        for is_open in [false, true] {
            for rate in [0.0, 2e-3, 2.0] {
                let box_of = BoxOfTetrahedra { cubes: 6, has_body };
                let setting = Setting { box_of, is_open, rate };
                let iterative = setting.solve(SolverChoice::Iterative(settings));
                let direct = setting.solve(SolverChoice::Direct);
                let differences = difference(&direct.solution, &iterative.solution);
                println!("{setting:?}: {differences:?}, {} iterations", iterative.iterations);
                assert!(
                    differences.iter().all(|difference| *difference < 1e-8),
                    "{setting:?}: {differences:?}"
                );
            }
        }
    }
}

/// However much of all equations iterations leave, no part of the fluid gains or loses more than 1e-8 of the flux through
/// the domain: what enters, or half the integral of the speed of the lid.
#[test]
fn mass_is_kept_to_a_tolerance_of_its_own() {
    let rough = IterativeSettings { tolerance: 1e-4, ..IterativeSettings::default() };
    for (is_open, flux) in [(true, 0.5 * 16.0 / 9.0), (false, 0.5 * 16.0 / 9.0 * 1.09f64.sqrt())] {
        for rate in [0.0, 2e-3, 2.0] {
            let box_of = BoxOfTetrahedra { cubes: 6, has_body: true };
            let setting = Setting { box_of, is_open, rate };
            let solved = setting.solve(SolverChoice::Iterative(rough));
            let mesh = box_of.mesh();
            let projection = DivergenceFreeProjection::new(&setting.problem(&mesh), &mesh);
            let defect = projection.defect(&mesh, &solved.solution.velocity);
            let lost = defect.iter().map(|part| part.abs()).sum::<f64>() / flux;
            println!("{setting:?}: {lost:.1e}, {} iterations", solved.iterations);
            // Speeds are averaged over the nodes of a facet
            assert!(lost < 1.5e-8, "{setting:?}: {lost:e}");
        }
    }
}

/// One of the two blocks of their velocities has no unknown.
#[test]
fn bodies_that_only_move_or_only_turn_take_no_more_iterations() {
    let setting = Setting::stokes(6, true);
    let mesh = setting.box_of.mesh();
    let alone = IterativeSettings { max_factor_entries: 0, ..IterativeSettings::default() };
    for rate in [0.0, 2.0] {
        let iterations = |held: &[Mode]| {
            let mut problem = setting.problem(&mesh);
            held.iter().for_each(|&mode| problem.bodies[0].drives[mode.index()] = Drive::Held);
            let solved = solve_from_rest(&problem, &mesh, rate, SolverChoice::Iterative(alone));
            solved.expect("the system is solved").iterations
        };
        let free = iterations(&[]);
        for held in [&Mode::ALL[..3], &Mode::ALL[3..], &[Mode::ALL[0], Mode::ALL[4]]] {
            let with_held = iterations(held);
            println!("rate {rate}, {held:?} held: {with_held} iterations, {free} of a free body");
            assert!(with_held <= free + free / 4, "{held:?}: {with_held}, {free}");
        }
    }
}

#[test]
fn finer_meshes_take_no_more_iterations() {
    for has_body in [false, true] {
        let [coarse, middle, fine] =
            [6, 9, 12].map(|cubes| Setting::stokes(cubes, has_body).iterations());
        let most = 1.3 * coarse as f64;
        assert!(middle as f64 <= most && fine as f64 <= most, "{coarse} {middle} {fine}");
    }
}

/// The steady flow through an open box around a body at a Reynolds number.
fn steady_flow(reynolds: f64, choice: SolverChoice) -> SteadyFlow<3> {
    let box_of = BoxOfTetrahedra { cubes: 6, has_body: true };
    let mesh = box_of.mesh();
    let setting = Setting { box_of, is_open: true, rate: 0.0 };
    let density = reynolds * VISCOSITY / 2.0;
    let problem = Problem { density, has_convection: true, ..setting.problem(&mesh) };
    let mut work = workspace(&problem, &mesh);
    let poses = MeshPoses::of(problem.bodies.iter().map(|body| body.pose));
    work.system = FluidSystem::with_solver(&problem, &mesh, &poses, false, choice);
    let settings = Steady { tolerance: 1e-9, max_iterations: 12 };
    steady_with(&mut work, &problem, &settings, true)
}

#[test]
fn steady_flow_with_convection_is_found_by_iterations() {
    for (reynolds, max_iterations) in [(1.0, 30), (20.0, 40), (100.0, 60)] {
        let direct = steady_flow(reynolds, SolverChoice::Direct);
        // More iterations than that would be an error
        let settings = IterativeSettings {
            max_iterations,
            max_factor_entries: 0,
            ..IterativeSettings::default()
        };
        let flow = steady_flow(reynolds, SolverChoice::Iterative(settings));
        let differences = difference(&direct.solution, &flow.solution);
        figure!(differences[0].max(differences[1]), "Reynolds number {reynolds}");
        assert!(differences.iter().all(|difference| *difference < 1e-6), "{differences:?}");
    }
}

#[test]
fn the_same_bits_follow_on_any_number_of_threads() {
    let setting = Setting::stokes(6, true);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let choice = SolverChoice::Iterative(IterativeSettings::default());
        pool.expect("threads can be made").install(|| setting.solve(choice).solution)
    };
    let [one, two, three] = [1, 2, 3].map(on);
    assert!(one == two && one == three);
}

#[test]
fn stalled_iterations_leave_it_to_factors_or_say_what_to_do() {
    let setting = Setting::stokes(3, true);
    let stalling = IterativeSettings { max_iterations: 3, ..IterativeSettings::default() };
    let taken_over = setting.solve(SolverChoice::Iterative(stalling)).solution;
    let direct = setting.solve(SolverChoice::Direct).solution;
    assert!(difference(&direct, &taken_over).iter().all(|difference| *difference < 1e-12));
    let without = IterativeSettings { max_factor_entries: 0, ..stalling };
    let error = setting.try_solve(SolverChoice::Iterative(without)).err();
    let message = error.map(|error| error.to_string()).unwrap_or_default();
    assert!(message.starts_with("3 iterations") && message.contains("flat cells"), "{message}");
}

/// Another load on the body is met with the directions that the flow has left first, unless they are given up: fewer
/// iterations, and the same flow. It is a few of them here, where no film makes some directions slow.
#[test]
fn solutions_with_one_matrix_share_their_directions() {
    let setting = Setting::stokes(6, true);
    let mesh = setting.box_of.mesh();
    let first = setting.problem(&mesh);
    let mut second = setting.problem(&mesh);
    second.bodies[0].load = Wrench {
        force: Vector3::new(-0.8, 0.1, 0.5) * VISCOSITY,
        torque: Vector3::new(0.2, 0.7, -0.3) * VISCOSITY,
    };
    let poses = MeshPoses::of(first.bodies.iter().map(|body| body.pose));
    let settings = IterativeSettings { tolerance: 1e-11, ..IterativeSettings::default() };
    let choice = SolverChoice::Iterative(settings);
    let second_of_two = |gives_up: bool| {
        let mut system = FluidSystem::with_solver(&first, &mesh, &poses, false, choice);
        let mut timing = Timing::default();
        let mut solve = |system: &mut FluidSystem<3>, problem: &Problem<3>| {
            one_system_from_rest(system, problem, &mesh, 0.0, &mut timing).expect("it is solved")
        };
        solve(&mut system, &first);
        if gives_up {
            system.mark_solver();
        }
        let solution = solve(&mut system, &second);
        (solution, system.accuracy().refinements)
    };
    let ((with, few), (without, many)) = (second_of_two(false), second_of_two(true));
    figure!(few as f64, "iterations that share");
    figure!(many as f64, "iterations that do not");
    assert!(few < many, "{few} {many}");
    let differences = difference(&with, &without);
    assert!(differences.iter().all(|difference| *difference < 1e-8), "{differences:?}");
}

/// The mobility of the body of a box, with its turns or without.
fn mobility(setting: &Setting, choice: SolverChoice, turns: bool) -> DMatrix<f64> {
    let mesh = setting.box_of.mesh();
    let problem = setting.problem(&mesh);
    let poses = MeshPoses::of(problem.bodies.iter().map(|body| body.pose));
    let mut system = FluidSystem::with_solver(&problem, &mesh, &poses, false, choice);
    let mut timing = Timing::default();
    one_system_from_rest(&mut system, &problem, &mesh, 0.0, &mut timing).expect("it is solved");
    let shapes = BodyShapes::rigid(poses.len());
    let bodies = BodiesAt { poses: &poses, shapes: &shapes };
    let constraints = system.constraints(&problem, &mesh, bodies);
    let loaded = [LoadedBody { body: 0, turns }];
    system.mobility(&constraints, &loaded, false, &mut timing).expect("it is solved")
}

/// Of a body that contact does not turn half the columns are left out, and the others are the same.
#[test]
fn mobilities_by_iterations_are_those_by_factors() {
    let setting = Setting::stokes(6, true);
    let iterative = SolverChoice::Iterative(IterativeSettings::default());
    let exact = mobility(&setting, SolverChoice::Direct, true);
    assert_eq!(exact, mobility(&setting, SolverChoice::Direct, false));
    let all = mobility(&setting, iterative, true);
    let moves = mobility(&setting, iterative, false);
    let off = [(0, &all), (3, &all), (0, &moves)].map(|(first, found)| {
        let block = |matrix: &DMatrix<f64>| matrix.view((first, first), (3, 3)).into_owned();
        (block(found) - block(&exact)).norm() / block(&exact).norm()
    });
    let block = |matrix: &DMatrix<f64>| matrix.view((0, 0), (3, 3)).into_owned();
    assert_eq!(block(&all), block(&moves));
    figure!(off.iter().copied().fold(0.0, f64::max), "mobility");
    assert!(off.iter().all(|off| *off < 1e-7), "{off:?}");
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).filter(|(i, j)| i.max(j) > &2) {
        assert_eq!(moves[(i, j)], 0.0);
    }
}
