//! Rotations in space, in a fluid too thin to matter: against Euler's equations, integrated here.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use alewife_core::body::{Pose, Twist, Wrench};
use alewife_core::case::Convection;
use alewife_core::coupling::{FieldPart, Magnet, MagneticField, Problem, Spring};
use alewife_core::flow::Viscosity;
use alewife_core::run::simulate;
use alewife_core::step::MeshPath;
use alewife_core::time::Bdf;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector6};
use tests::cases::{case, column, last};
use tests::{Stepping, Study, figure, two_tetrahedra};

/// Density and viscosity of the fluid against those of the body, about 1.
const THIN: f64 = 1e-9;

/// An orientation, and the angular velocity in the frame of the body (rad/s).
#[derive(Debug, Clone, Copy)]
struct Turning {
    turn: UnitQuaternion<f64>,
    spin: Vector3<f64>,
}

impl Turning {
    fn spin_in_world(&self) -> Vector3<f64> {
        self.turn * self.spin
    }

    fn distance(&self, other: &Self) -> f64 {
        self.turn.angle_to(&other.turn) + (self.spin - other.spin).norm()
    }
}

/// The end of a step.
struct Turn {
    end: Turning,
    /// Rate of the angular velocity in the world (rad/s2).
    rate: Vector3<f64>,
}

/// A body that turns about its centre.
struct Top<'a> {
    /// Tensor of inertia in its frame (kg m2).
    inertia: Matrix3<f64>,
    /// Torque in its frame (N m) when it is turned so.
    torque: &'a dyn Fn(&UnitQuaternion<f64>) -> Vector3<f64>,
}

impl Top<'_> {
    fn rate(&self, turn: &Quaternion<f64>, spin: &Vector3<f64>) -> (Quaternion<f64>, Vector3<f64>) {
        let momentum = self.inertia * spin;
        let torque = (self.torque)(&UnitQuaternion::new_normalize(*turn));
        let inverse = self.inertia.try_inverse().expect("a body has inertia");
        let spinning = turn * Quaternion::from_imag(*spin) * 0.5;
        (spinning, inverse * (torque + momentum.cross(spin)))
    }

    /// The motion after a time (s), which may be negative, by the method of Runge and Kutta.
    fn after(&self, start: &Turning, time: f64) -> Turning {
        let n_steps = (time.abs() * 2000.0).ceil().max(1.0);
        let step = time / n_steps;
        let (mut turn, mut spin) = (start.turn.into_inner(), start.spin);
        for _ in 0..n_steps as usize {
            let a = self.rate(&turn, &spin);
            let b = self.rate(&(turn + a.0 * (step / 2.0)), &(spin + a.1 * (step / 2.0)));
            let c = self.rate(&(turn + b.0 * (step / 2.0)), &(spin + b.1 * (step / 2.0)));
            let d = self.rate(&(turn + c.0 * step), &(spin + c.1 * step));
            turn += (a.0 + (b.0 + c.0) * 2.0 + d.0) * (step / 6.0);
            spin += (a.1 + (b.1 + c.1) * 2.0 + d.1) * (step / 6.0);
        }
        Turning { turn: UnitQuaternion::new_normalize(turn), spin }
    }

    /// Steps of the solver, both of whose first levels are exact; the motion at the end of each.
    fn solved(
        &self,
        problem: &mut Problem<3>,
        start: &Turning,
        step: f64,
        n: usize,
    ) -> Vec<Turning> {
        self.steps(problem, start, step, n).iter().map(|step| step.end).collect()
    }

    /// The same with the rates of the angular velocity.
    fn steps(&self, problem: &mut Problem<3>, start: &Turning, step: f64, n: usize) -> Vec<Turn> {
        let mesh = two_tetrahedra();
        problem.density = THIN;
        problem.viscosity = Viscosity::Newtonian(THIN);
        let center = problem.bodies[0].pose.center;
        problem.bodies[0].inertia.tensor = self.inertia;
        problem.bodies[0].pose = Pose::spatial(center, start.turn);
        let mut run = Stepping::new(problem, &mesh, Convection::Extrapolated, MeshPath::Fixed);
        let before = self.after(start, -step);
        let twist = |at: &Turning| Twist { linear: Vector3::zeros(), angular: at.spin_in_world() };
        let mut levels = run.state.levels();
        levels.previous_poses = Some(vec![Pose::spatial(center, before.turn)]);
        levels.now.twists = vec![twist(start)];
        levels.previous.twists = vec![twist(&before)];
        run.state.begin(levels);
        (0..n)
            .map(|_| {
                run.advance(Bdf::second_order(step, step));
                let turn = run.state.poses[0].rotation();
                let spin = turn.inverse() * run.state.now.twists[0].angular;
                Turn { end: Turning { turn, spin }, rate: run.state.twist_rates[0].angular }
            })
            .collect()
    }

    /// Asserts that the motion after three seconds is of second order in the step.
    fn assert_second_order(&self, name: &str, mut problem: Problem<3>) {
        const END: f64 = 3.0;
        let start = Turning { turn: problem.bodies[0].pose.rotation(), spin: start_spin() };
        let exact = self.after(&start, END);
        let study = Study::run(&[0.03, 0.015, 0.0075], |step| {
            let n_steps = (END / step).round() as usize;
            let steps = self.solved(&mut problem, &start, step, n_steps);
            steps[n_steps - 1].distance(&exact)
        });
        study.assert_order(name, 2.0, 0.2);
    }
}

fn start_spin() -> Vector3<f64> {
    Vector3::new(1.1, -0.8, 0.6)
}

/// The body of the other tests of this folder, without a load.
fn problem() -> (Problem<3>, Matrix3<f64>) {
    let problem = super::problem(&two_tetrahedra(), false);
    let inertia = problem.bodies[0].inertia.tensor;
    (problem, inertia)
}

#[test]
fn a_free_asymmetric_top_turns_by_eulers_equations_to_second_order() {
    let (problem, inertia) = problem();
    Top { inertia, torque: &|_| Vector3::zeros() }.assert_second_order("free top", problem);
}

/// Each step keeps the momentum at the poses it was solved for, which the poses it ends at follow to
/// second order.
#[test]
fn a_free_top_keeps_its_angular_momentum_and_its_energy_to_second_order() {
    let (mut problem, inertia) = problem();
    let top = Top { inertia, torque: &|_| Vector3::zeros() };
    let start = Turning { turn: problem.bodies[0].pose.rotation(), spin: start_spin() };
    let momentum = |at: &Turning| at.turn * (inertia * at.spin);
    let energy = |at: &Turning| at.spin.dot(&(inertia * at.spin)) / 2.0;
    let mut energies = Study { sizes: Vec::new(), errors: Vec::new() };
    let momenta = Study::run(&[0.04, 0.02, 0.01], |step| {
        let steps = top.solved(&mut problem, &start, step, (4.0 / step).round() as usize);
        let end = steps[steps.len() - 1];
        energies.sizes.push(step);
        energies.errors.push((energy(&end) / energy(&start) - 1.0).abs());
        let off = |at: &Turning| (momentum(at) - momentum(&start)).norm();
        steps.iter().map(off).fold(0.0, f64::max) / momentum(&start).norm()
    });
    for (name, study) in [("angular momentum", momenta), ("energy", energies)] {
        study.record(&format!("free top, {name}"));
        assert!(study.order() > 1.8 && study.errors[2] < 1e-3, "{name}: {study:?}");
    }
}

/// A body that turns about its middle axis of inertia turns over (Dzhanibekov's nut, the tennis racket).
#[test]
fn a_top_about_its_middle_axis_turns_over_when_it_should() {
    let (mut problem, _) = problem();
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let top = Top { inertia, torque: &|_| Vector3::zeros() };
    let start = Turning { turn: UnitQuaternion::identity(), spin: Vector3::new(0.2, 2.0, 0.1) };
    let (step, n_steps) = (0.005, 3200);
    // Times at which the spin about the middle axis changes its sign
    let flips = |spins: &[f64]| -> Vec<f64> {
        let changes = (1..spins.len()).filter(|i| spins[i - 1] * spins[*i] < 0.0);
        changes.map(|i| step * (i as f64 + spins[i] / (spins[i - 1] - spins[i]))).collect()
    };
    let (mut at, mut exact) = (start, vec![start.spin.y]);
    for _ in 0..n_steps {
        at = top.after(&at, step);
        exact.push(at.spin.y);
    }
    let solved = top.solved(&mut problem, &start, step, n_steps);
    let found = flips(&[start].iter().chain(&solved).map(|at| at.spin.y).collect::<Vec<_>>());
    let wanted = flips(&exact);
    println!("a top turns over at {found:?}, by Euler's equations at {wanted:?}");
    assert!(wanted.len() >= 2 && found.len() == wanted.len(), "{found:?} {wanted:?}");
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
    }
}

/// The torque is along the rotation vector from rest, about which an asymmetric body does not just swing.
#[test]
fn a_spring_against_turning_in_space_is_of_second_order() {
    let (mut problem, inertia) = problem();
    let rest = UnitQuaternion::from_euler_angles(-0.2, 0.1, 0.7);
    let (stiffness, damping) = (3.0, 0.4);
    let rotational = |value: f64| Vector6::new(0.0, 0.0, 0.0, value, value, value);
    problem.bodies[0].spring = Some(Spring {
        stiffness: rotational(stiffness),
        damping: Vector6::zeros(),
        rest: Pose::spatial(problem.bodies[0].pose.center, rest),
    });
    let torque = |turn: &UnitQuaternion<f64>| {
        turn.inverse() * ((turn * rest.inverse()).scaled_axis() * -stiffness)
    };
    Top { inertia, torque: &torque }.assert_second_order("spring against turning", problem);

    // What a damper takes is the loss of energy
    let (mut problem, _) = self::problem();
    problem.bodies[0].spring = Some(Spring {
        stiffness: Vector6::zeros(),
        damping: rotational(damping),
        rest: problem.bodies[0].pose,
    });
    let inertia = Matrix3::identity() * 2.0;
    let top = Top { inertia, torque: &|_| Vector3::zeros() };
    let start = Turning { turn: problem.bodies[0].pose.rotation(), spin: Vector3::zeros() };
    let spinning = Turning { spin: start_spin(), ..start };
    let end = *top.solved(&mut problem, &spinning, 0.005, 200).last().expect("steps were made");
    let left = end.spin.norm() / start_spin().norm();
    // The level before the start is one without the damper, which is of first order in the step
    assert!((left / (-damping / 2.0f64).exp() - 1.0).abs() < 1e-3, "{left}");
}

/// Thrusters on a body push along axes that turn with it.
#[test]
fn a_torque_in_the_frame_of_the_body_turns_it_to_second_order() {
    let (mut problem, inertia) = problem();
    let torque = Vector3::new(0.9, -0.5, 1.2);
    problem.bodies[0].load = Wrench { force: Vector3::zeros(), torque };
    problem.bodies[0].load_in_body = true;
    Top { inertia, torque: &|_| torque }.assert_second_order("torque of the body", problem);
}

/// A sphere on a spring against turning, once a second in vacuum, in a fluid of a millionth of its density.
#[test]
fn a_sphere_swings_about_an_oblique_axis_at_the_frequency_of_spring_and_inertia() {
    let angle_after_half_a_second = |damping: f64| {
        let text = format!(
            r#"
            title = "a sphere on a spring against turning"
            geometry = "spatial"
            fluid = {{ model = "navier-stokes", density = 1e-6, viscosity = 1e-7 }}
            domain.sphere.radius = 1.5
            boundary.wall = "no-slip"
            mesh = {{ size = 1.2, surface = 0.6, growth = 1.0, gap_layers = 1 }}
            time.unsteady = {{ step = 0.01, end = 0.5 }}
            [[body]]
            name = "sphere"
            shape.sphere.radius = 0.5
            center = [0.0, 0.0, 0.0]
            density = {density}
            motion = "free"
            locked = ["x", "y", "z"]
            orientation.turned = {{ axis = [1.0, 2.0, 2.0], angle = 0.4 }}
            spring = {{ torsion = 39.47841760435743, torsion_damping = {damping}, rest_orientation.quaternion = [1.0, 0.0, 0.0, 0.0] }}
            "#,
            // A moment of inertia of 1 kg m2
            density = 1.0 / (0.4 * 0.25 * std::f64::consts::PI / 6.0)
        );
        let outcome = simulate::<3>(&case(&text), &mut []).expect("the case runs");
        let [w, x, y, z] =
            ["w", "x", "y", "z"].map(|part| last(&outcome, &format!("sphere.orientation.{part}")));
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).scaled_axis();
        let axis = Vector3::new(1.0, 2.0, 2.0) / 3.0;
        assert!(turn.cross(&axis).norm() < 1e-6, "{turn}");
        // About the axis of a single turn the frames of body and laboratory agree
        let [own, spin] = ["body_angular_velocity", "angular_velocity"]
            .map(|name| column(&outcome, &format!("sphere.{name}.y")));
        assert!(own.iter().zip(&spin).all(|(own, spin)| (own - spin).abs() < 1e-9));
        turn.dot(&axis)
    };
    // Half a period: on the other side, less what the scheme takes in 50 steps
    let free = angle_after_half_a_second(0.0);
    assert!((free + 0.4).abs() < 2e-3, "{free}");
    let damped = angle_after_half_a_second(0.5);
    let (rate, frequency) = (0.25f64, (4.0 * std::f64::consts::PI.powi(2) - 0.0625f64).sqrt());
    let [turned, decay] = [frequency / 2.0, (-rate / 2.0).exp()];
    let exact = 0.4 * decay * (turned.cos() + rate / frequency * turned.sin());
    assert!((damped - exact).abs() < 2e-3, "{damped} {exact}");
}

/// A load along axes of the body is the same load along those of the laboratory.
#[test]
fn a_load_in_the_frame_of_the_body_is_turned_with_it() {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(1.0, 2.0, 2.0) * (0.8 / 3.0));
    let (force, torque) = (Vector3::new(1.0, 0.5, -0.3), Vector3::new(0.2, -0.4, 0.6));
    let velocities = [("body", force, torque), ("laboratory", turn * force, turn * torque)].map(
        |(frame, force, torque)| {
            let list = |of: Vector3<f64>| format!("[{:e}, {:e}, {:e}]", of.x, of.y, of.z);
            let text = format!(
                r#"
                title = "an ellipsoid that is pulled and turned"
                geometry = "spatial"
                fluid = {{ model = "stokes", viscosity = 1.0 }}
                domain.sphere.radius = 3.0
                boundary.wall = "no-slip"
                mesh = {{ size = 2.0, surface = 0.8, growth = 1.0, gap_layers = 1 }}
                time.steady = {{}}
                [[body]]
                name = "body"
                shape.ellipsoid.semi_axes = [1.0, 0.7, 0.5]
                center = [0.2, 0.0, 0.0]
                motion = "free"
                orientation.turned = {{ axis = [1.0, 2.0, 2.0], angle = 0.8 }}
                force = {force}
                torque = {torque}
                load_frame = "{frame}"
                "#,
                force = list(force),
                torque = list(torque),
            );
            let outcome = simulate::<3>(&case(&text), &mut []).expect("the case runs");
            ["velocity.x", "velocity.y", "velocity.z", "angular_velocity.x", "angular_velocity.z"]
                .map(|what| last(&outcome, &format!("body.{what}")))
        },
    );
    for (own, other) in velocities[0].iter().zip(&velocities[1]) {
        assert!((own - other).abs() < 1e-8, "{velocities:?}");
        assert!(own.abs() > 1e-4, "{velocities:?}");
    }
}

/// The error of a step is estimated with the rate of the velocity, which is not that of the momentum over the inertia where
/// that turns with the body.
#[test]
fn the_rate_of_a_free_tops_spin_is_that_of_eulers_equations_to_second_order() {
    let (mut problem, inertia) = problem();
    let top = Top { inertia, torque: &|_| Vector3::zeros() };
    let start = Turning { turn: problem.bodies[0].pose.rotation(), spin: start_spin() };
    Study::run(&[0.04, 0.02, 0.01], |step| {
        let steps = top.steps(&mut problem, &start, step, (1.0 / step).round() as usize);
        let off = |Turn { end, rate }: &Turn| {
            let exact = end.turn * top.rate(&end.turn, &end.spin).1;
            (rate - exact).norm()
        };
        steps.iter().map(off).fold(0.0, f64::max)
    })
    .assert_order("free top, rate of its spin", 2.0, 0.3);
}

/// A magnet in a field about which it does not just swing, of m B = 3 (rad/s)^2 kg m2.
#[test]
fn a_magnet_in_a_field_turns_to_second_order() {
    let (mut problem, inertia) = problem();
    let (moment, field) = (Vector3::new(0.5, -1.0, 0.3), Vector3::new(1.5, 1.0, -1.8));
    let uniform = FieldPart::Uniform(Box::new(move |_| field));
    problem.bodies[0].magnet =
        Some(Magnet { moment, field: Arc::new(MagneticField { parts: vec![uniform] }) });
    let torque = |turn: &UnitQuaternion<f64>| moment.cross(&(turn.inverse() * field));
    Top { inertia, torque: &torque }.assert_second_order("magnet", problem);
}

/// A sphere in a sphere follows a field that turns about an oblique axis, and lags behind it.
#[test]
fn a_magnetic_sphere_follows_a_field_in_space() {
    let drag = 8.0 * PI / (1.0 - 0.125);
    let text = format!(
        r#"
        title = "a magnetic sphere in a sphere"
        geometry = "spatial"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.sphere.radius = 2.0
        boundary.wall = "no-slip"
        mesh = {{ size = 0.8, surface = 0.4, gap_layers = 2 }}
        time.unsteady = {{ step = 0.4, end = 4.8 }}
        field.magnetic.rotating = {{ strength = 1.0, frequency = {frequency:e}, axis = [2.0, 3.0, 6.0], phase = 0.1 }}
        [[body]]
        name = "sphere"
        shape.sphere.radius = 1.0
        center = [0.0, 0.0, 0.0]
        motion = "free"
        locked = ["x", "y", "z"]
        magnetic_moment = [{moment}]
        "#,
        // Where a field about this axis points to at a phase of zero
        moment = [15.0, -2.0, -4.0]
            .map(|part: f64| format!("{:e}", part / 245f64.sqrt() * drag))
            .join(", "),
        frequency = 0.6 / TAU,
    );
    let outcome = simulate::<3>(&case(&text), &mut []).expect("the case runs");
    let spin =
        ["x", "y", "z"].map(|axis| last(&outcome, &format!("sphere.angular_velocity.{axis}")));
    let off = (Vector3::from(spin) - Vector3::new(2.0, 3.0, 6.0) * (0.6 / 7.0)).norm() / 0.6;
    assert!(off < 5e-3, "{spin:?}");
    let lag = last(&outcome, "sphere.magnetic_lag");
    figure!((lag.sin() / 0.6 - 1.0).abs(), "lag of a sphere");
    assert!((lag.sin() / 0.6 - 1.0).abs() < 5e-3, "{lag}");
    let [power, lost] =
        ["sphere.magnetic_power", "flow.dissipation"].map(|what| last(&outcome, what));
    assert!((power / lost - 1.0).abs() < 1e-4, "{power} {lost}");
}
