//! Time of a step of three trees on one core: an eel of six links, a fish of ellipsoids, a vehicle.
//!
//! ```sh
//! cargo run --release -p alewife-reduced --example tree_speed
//! ```

use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

use alewife_reduced::tree::loads::{
    AddedMass, Ellipsoid, EllipsoidCoefficients, Load, StripCoefficients, Strips, Vehicle,
};
use alewife_reduced::tree::{
    Command, Drive, Inputs, Joint, JointKind, Link, PlacedLoad, Pose, Root, Scheme, Stepper,
    Symmetric, Tree, Wrench, vector,
};
use nalgebra::Matrix3;

/// Few, so that a try often ends before another program takes the core.
const STEPS: u32 = 500;

const TRIES: u32 = 400;

/// Six links in the plane whose joints are given.
fn eel() -> Result<Tree<f64>, Box<dyn Error>> {
    let strips = Strips {
        half_length: 0.5,
        half_width: 0.06,
        depth: 1.0,
        density: 1.0,
        viscosity: 0.02,
        coefficients: StripCoefficients {
            added_mass: 1.0,
            normal_linear: 4.0,
            normal_quadratic: 2.0,
            tangential_linear: 2.0,
            tangential_quadratic: 0.1,
        },
    };
    let body = Symmetric::rigid(0.0942, vector([0.0, 0.0, 0.006]));
    let links = (0..6).map(|number| {
        if number == 0 {
            return Link::root(body).loaded(Load::Strips(strips));
        }
        let center = Pose::at(vector([-0.55, 0.0, 0.0]));
        let joint = Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]).driven(Drive::Given);
        let mut link = Link::new(number - 1, joint, body.seen_from(&center));
        link.loads.push(PlacedLoad { pose: Some(center), load: Load::Strips(strips) });
        link.placed([if number == 1 { -0.55 } else { -1.1 }, 0.0, 0.0])
    });
    Ok(Tree::new(Root::Planar, links.collect())?)
}

/// A body that is free in space and seven links behind it with stiff hinges, twelve velocities as the published
/// fish has, with 33 ellipsoids.
fn fish() -> Result<Tree<f64>, Box<dyn Error>> {
    let coefficients = EllipsoidCoefficients::from_array([0.4, 7.79, 2.81, 3.84, 0.27]);
    let ellipsoid = |axes| {
        let law = Ellipsoid::new(axes, 1000.0, 0.0013, coefficients, AddedMass::Full);
        Load::Ellipsoid(Box::new(law))
    };
    let placed = |axes, at| PlacedLoad { pose: Some(Pose::at(vector(at))), load: ellipsoid(axes) };
    let mut root = Link::root(Symmetric::rigid(1.2, vector([1e-3, 5e-3, 5e-3])));
    root.loads =
        (0..3).map(|k| placed([0.077, 0.01, 0.05], [0.0, 0.0, 0.01 * f64::from(k)])).collect();
    let mut links = vec![root];
    for number in 1..7 {
        let kind = JointKind::Hinge;
        let joint = Joint { stiffness: 0.65, ..Joint::new(kind, [0.0, 0.0, 1.0]) };
        let body = Symmetric::rigid(0.02, vector([2e-5, 2e-5, 1e-6]));
        let mut link = Link::new(number - 1, joint, body).placed([-0.03, 0.0, 0.0]);
        link.loads = (0..5)
            .map(|k| placed([0.0075, 0.0015, 0.04], [-0.004 * f64::from(k), 0.0, 0.0]))
            .collect();
        links.push(link);
    }
    Ok(Tree::new(Root::Free, links)?)
}

fn vehicle() -> Result<Tree<f64>, Box<dyn Error>> {
    let law = Vehicle {
        added: [6.36, 7.12, 18.68, 0.189, 0.135, 0.222],
        linear: [13.7, 0.0, 33.0, 0.0, 0.8, 0.0],
        quadratic: [141.0, 217.0, 190.0, 1.19, 0.47, 1.5],
    };
    let body = Symmetric::rigid(13.5, vector([0.26, 0.23, 0.37]));
    Ok(Tree::new(Root::Free, vec![Link::root(body).loaded(Load::Vehicle(law))])?)
}

/// A wave along the joints, as angles and as torques, and a thrust on the root.
struct Wave {
    amplitude: f64,
    torque: f64,
    thrust: f64,
}

impl Inputs<f64> for Wave {
    fn command(&self, time: f64, link: usize) -> Command<f64> {
        let (sine, cosine) = (TAU * time - 0.9 * link as f64).sin_cos();
        Command {
            place: self.amplitude * sine,
            rate: TAU * self.amplitude * cosine,
            effort: self.torque * sine,
        }
    }

    fn wrench(&self, _: f64, link: usize, _: &Matrix3<f64>) -> Option<Wrench<f64>> {
        let push =
            Wrench { force: vector([self.thrust, 0.0, 0.0]), torque: vector([0.0, 0.0, 1.0]) };
        (link == 0 && self.thrust > 0.0).then_some(push)
    }
}

/// Shortest time of a step (us) of many tries.
fn measure(
    tree: &Tree<f64>,
    scheme: Scheme,
    step: f64,
    wave: &Wave,
) -> Result<f64, Box<dyn Error>> {
    let mut best = f64::INFINITY;
    let mut way = 0.0;
    for _ in 0..TRIES {
        let mut stepper = Stepper::new(tree, scheme);
        let mut state = tree.rest();
        let begun = Instant::now();
        for _ in 0..STEPS {
            stepper.step(tree, &mut state, step, wave)?;
        }
        best = f64::min(best, begun.elapsed().as_secs_f64() * 1e6 / f64::from(STEPS));
        way = state.root.position.norm();
    }
    // What is not used need not be computed
    assert!(way.is_finite());
    Ok(best)
}

fn main() -> Result<(), Box<dyn Error>> {
    let swim = Wave { amplitude: 0.35, torque: 0.05, thrust: 0.0 };
    let push = Wave { amplitude: 0.0, torque: 0.0, thrust: 40.0 };
    println!("time of a step (us)      Euler  midpoint");
    let trees = [
        ("eel", eel()?, 0.01, &swim),
        ("fish", fish()?, 1e-3, &swim),
        ("vehicle", vehicle()?, 0.01, &push),
    ];
    for (name, tree, step, wave) in trees {
        let [euler, midpoint] =
            [Scheme::Euler, Scheme::Midpoint].map(|s| measure(&tree, s, step, wave));
        let n = tree.n_velocities();
        println!("{name:8} {n:3} velocities  {:8.3}  {:8.3}", euler?, midpoint?);
    }
    Ok(())
}
