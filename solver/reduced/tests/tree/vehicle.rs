//! A vehicle with the coefficients of the `BlueROV2` Heavy (von Benzon et al. 2022): speeds, ballast, thrusters.

use alewife_reduced::tree::loads::{ElongatedBody, Load, Vehicle};
use alewife_reduced::tree::{
    Command, Inputs, Lag, Link, Root, Scheme, State, Stepper, Symmetric, Thruster, Thrusters, Tree,
    Weight, Wrench, vector,
};
use nalgebra::Matrix3;

const GRAVITY: f64 = 9.82;

const VOLUME: f64 = 0.0134;

/// Of the forces at full power along the axes, and the torques about them.
const FULL: [f64; 6] = [85.0, 85.0, 120.0, 26.0, 14.0, 22.0];

fn vehicle(ballast: f64, gravity: f64) -> Tree<f64> {
    let mass = 13.5 + ballast;
    let law = Vehicle {
        added: [6.36, 7.12, 18.68, 0.189, 0.135, 0.222],
        linear: [13.7, 0.0, 33.0, 0.0, 0.8, 0.0],
        quadratic: [141.0, 217.0, 190.0, 1.19, 0.47, 1.5],
    };
    let weight = Weight {
        mass,
        mass_center: vector([0.0; 3]),
        displaced: 1000.0 * VOLUME,
        buoyancy_center: vector([0.0, 0.0, 0.01]),
    };
    let body = Symmetric::rigid(mass, vector([0.26, 0.23, 0.37]));
    let link = Link { weight: Some(weight), ..Link::root(body).loaded(Load::Vehicle(law)) };
    let tree = Tree::new(Root::Free, vec![link]).expect("a vehicle is a tree");
    tree.in_gravity([0.0, 0.0, -gravity])
}

struct Push([f64; 6]);

impl Inputs<f64> for Push {
    fn command(&self, _: f64, _: usize) -> Command<f64> {
        Command::none()
    }

    fn wrench(&self, _: f64, _: usize, _: &Matrix3<f64>) -> Option<Wrench<f64>> {
        let [x, y, z, u, v, w] = self.0;
        Some(Wrench { force: vector([x, y, z]), torque: vector([u, v, w]) })
    }
}

fn run(tree: &Tree<f64>, push: [f64; 6], end: f64) -> State<f64> {
    let mut state = tree.rest();
    let mut stepper = Stepper::new(tree, Scheme::Euler);
    for _ in 0..2000 {
        stepper.step(tree, &mut state, end / 2000.0, &Push(push)).expect("it moves");
    }
    state
}

#[test]
fn it_reaches_its_terminal_speeds() {
    let tree = vehicle(0.0, 0.0);
    let expected = [0.7294, 0.6259, 0.7126, 4.674, 4.673, 3.830];
    for (axis, expected) in expected.into_iter().enumerate() {
        let mut push = [0.0; 6];
        push[axis] = FULL[axis];
        let found = run(&tree, push, 20.0).velocities[axis];
        assert!((found / expected - 1.0).abs() < 1e-3, "{axis}: {found} {expected}");
    }
}

#[test]
fn ballast_weighs_and_displaces_nothing() {
    for (ballast, sign) in [(0.0, -1.0), (-0.3, 1.0), (0.6, -1.0)] {
        let state = run(&vehicle(ballast, GRAVITY), [0.0; 6], 20.0);
        let net: f64 = (13.5 + ballast - 1000.0 * VOLUME) * GRAVITY;
        // 33 w + 190 w^2 = |net|
        let size = (-33.0 + (33.0_f64.powi(2) + 4.0 * 190.0 * net.abs()).sqrt()) / 380.0;
        let found = state.velocities[2];
        assert!((found - sign * size).abs() < 1e-6, "{ballast}: {found} {size}");
    }
}

/// The centre of buoyancy above that of mass turns a tilted vehicle upright; it swings, and comes to rest.
#[test]
fn buoyancy_rights_it() {
    let tree = vehicle(-0.1, GRAVITY);
    let mut state = tree.rest();
    state.root =
        alewife_reduced::tree::Placement::turned(vector([0.0; 3]), &vector([1.0, 0.0, 0.0]), 1.0);
    let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
    let tilt = |state: &State<f64>| state.root.rotation()[(2, 2)].acos();
    let energy = |state: &State<f64>| {
        let center = state.root.rotation()[(2, 2)] * 0.01;
        tree.kinetic_energy(state) - 1000.0 * VOLUME * GRAVITY * center
    };
    let mut before = energy(&state);
    for _ in 0..20_000 {
        stepper.step(&tree, &mut state, 0.005, &Push([0.0; 6])).expect("it moves");
        let now = energy(&state);
        assert!(now < before + 1e-9, "energy grew from {before} to {now}");
        before = now;
    }
    assert!(tilt(&state) < 0.1, "{}", tilt(&state));
}

/// Four horizontal thrusters at 45 degrees, as their curve and lag are published.
#[test]
fn thrusters_follow_their_curve_after_their_lag() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let curve = vec![8.9, 176.0, -404.1, 389.9, -140.3];
    let thrusters: Vec<Thruster<f64>> = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
        .map(|[x, y]| Thruster {
            position: vector([0.156 * x, 0.111 * y, 0.085]),
            direction: vector([half, -half * x * y, 0.0]),
            curve: curve.clone(),
        })
        .into();
    let full = thrusters[0].force(1.0);
    assert!(
        (full - 30.4).abs() < 1e-9
            && (thrusters[0].force(-0.5) + thrusters[0].force(0.5)).abs() < 1e-12
    );
    assert!((thrusters[0].force(7.0) - full).abs() < 1e-12);
    let lag = Lag { numerator: [108_700.0, 6136.0], denominator: [108_700.0, 9258.0, 89.0] };
    let reached = |time: f64, n: u32| {
        let mut thrusters = Thrusters::new(thrusters.clone(), Some(lag));
        let mut wrench = Wrench::zero();
        for _ in 0..n {
            wrench = thrusters.advance(time / f64::from(n), &[1.0; 4]);
        }
        wrench
    };
    let settled = reached(1.0, 1000);
    assert!((settled.force.x / (4.0 * half * full) - 1.0).abs() < 1e-4);
    assert!(settled.force.y.abs() < 1e-9 && settled.torque.z.abs() < 1e-9);
    // The step response at 20 ms by the poles of the transfer function
    let step = reached(0.02, 20_000).force.x / settled.force.x;
    let coarse = reached(0.02, 40).force.x / settled.force.x;
    assert!((step - coarse).abs() < 2e-3 && (0.2..0.9).contains(&step), "{step} {coarse}");
}

/// A slender body whose thrust and drag balance at its speed; without drag it swims at the speed of its wave.
#[test]
fn an_elongated_body_swims_where_thrust_is_drag() {
    let body =
        ElongatedBody { density: 1000.0, height: 0.1, area: 0.1, drag: 1.35, added_mass: 0.94 };
    // h = 0.1 sin(7 x - 5 t)
    let [velocity, slope] = [0.5 * 0.5_f64.powi(2), 0.5 * 0.7_f64.powi(2)];
    let speed = body.speed(velocity, slope);
    assert!(body.surplus(speed, velocity, slope).abs() < 1e-12 && speed < 5.0 / 7.0);
    let ideal = ElongatedBody { drag: 0.0, ..body }.speed(velocity, slope);
    assert!((ideal - 5.0 / 7.0).abs() < 1e-14);
}
