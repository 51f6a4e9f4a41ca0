//! Trees that several tests move: chains of ellipsoids in space, and of slender links in the plane.

use std::f64::consts::TAU;

use alewife_reduced::tree::loads::{
    AddedMass, Ellipsoid, EllipsoidCoefficients, Load, StripCoefficients, Strips,
};
use alewife_reduced::tree::{
    Command, Drive, Joint, JointKind, Link, Number, Pose, Root, State, Symmetric, Tree, real,
    rotation, vector,
};
use nalgebra::Vector3;

/// A free chain of three ellipsoids that are lighter than the fluid, its hinges about different axes.
pub fn ellipsoids<T: Number>(coefficients: [T; 5], viscosity: T, springs: T) -> Tree<T> {
    let part = |axes: [f64; 3]| {
        let semi = axes.map(|a| real::<T>(a));
        let law = Ellipsoid::new(
            semi,
            real(1000.0),
            viscosity,
            EllipsoidCoefficients::from_array(coefficients),
            AddedMass::Full,
        );
        let mass = law.volume() * 700.0;
        let square = |k: usize| semi[k] * semi[k];
        let moments =
            Vector3::new(square(1) + square(2), square(2) + square(0), square(0) + square(1))
                * (mass * 0.2);
        let body = Symmetric::rigid(mass, moments);
        // Its centre is not where it is joined
        let pose = Pose {
            rotation: rotation(&vector([0.0, 1.0, 0.0]), real(0.2)),
            position: vector([-axes[0] - 0.01, 0.0, 0.005]),
        };
        let mut link = Link::root(body.seen_from(&pose));
        link.loads.push(alewife_reduced::tree::PlacedLoad {
            pose: Some(pose),
            load: Load::Ellipsoid(Box::new(law)),
        });
        link
    };
    let joined = |axes: [f64; 3], parent: usize, axis: [f64; 3]| {
        let link = part(axes);
        let joint = Joint { stiffness: springs, ..Joint::new(JointKind::Hinge, axis) };
        Link { parent, joint, ..link }.placed([-0.14, 0.01, 0.0])
    };
    let links = vec![
        part([0.06, 0.02, 0.03]),
        joined([0.05, 0.01, 0.03], 0, [0.0, 0.0, 1.0]),
        joined([0.04, 0.01, 0.02], 1, [0.0, 0.8, 0.6]),
    ];
    Tree::new(Root::Free, links).expect("a chain is a tree")
}

/// A chain that drifts, turns and bends.
pub fn moving<T: Number>(tree: &Tree<T>) -> State<T> {
    let mut state = tree.rest();
    let rates = [0.3, -0.2, 0.1, 1.0, -0.5, 0.8, 2.0, -1.5];
    state.velocities = rates.map(|rate| real(rate)).to_vec();
    state.coordinates[6] = real(0.4);
    state.coordinates[7] = real(-0.3);
    state
}

/// Coefficients of a chain of slender links, and its gait.
#[derive(Clone, Copy)]
pub struct Eel<T: Number> {
    pub coefficients: StripCoefficients<T>,
    pub amplitude: T,
    pub lag: T,
    pub links: usize,
}

impl<T: Number> Eel<T> {
    pub fn of(values: [T; 7], links: usize) -> Self {
        let [
            added_mass,
            normal_linear,
            normal_quadratic,
            tangential_linear,
            tangential_quadratic,
            amplitude,
            lag,
        ] = values;
        let coefficients = StripCoefficients {
            added_mass,
            normal_linear,
            normal_quadratic,
            tangential_linear,
            tangential_quadratic,
        };
        Self { coefficients, amplitude, lag, links }
    }

    /// Ellipses of semi-axes 0.5 and 0.06, 0.1 apart, as dense as the fluid; the first is in front.
    pub fn tree(&self) -> Tree<T> {
        let (a, b) = (0.5, 0.06);
        let mass = std::f64::consts::PI * a * b;
        let moment = 0.25 * mass * (a * a + b * b);
        let pivot = a + 0.05;
        let strips = Strips {
            half_length: real(a),
            half_width: real(b),
            depth: real(1.0),
            density: real(1.0),
            viscosity: real(0.02),
            coefficients: self.coefficients,
        };
        let body = Symmetric::rigid(real(mass), vector([0.0, 0.0, moment]));
        let links = (0..self.links).map(|number| {
            if number == 0 {
                return Link::root(body).loaded(Load::Strips(strips));
            }
            let center = Pose::at(vector([-pivot, 0.0, 0.0]));
            let joint = Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]).driven(Drive::Given);
            let mut link = Link::new(number - 1, joint, body.seen_from(&center));
            let pose = Some(center);
            let load = Load::Strips(strips);
            link.loads.push(alewife_reduced::tree::PlacedLoad { pose, load });
            link.placed([if number == 1 { -pivot } else { -2.0 * pivot }, 0.0, 0.0])
        });
        Tree::new(Root::Planar, links.collect()).expect("an eel is a tree")
    }

    /// A wave that runs to the back, begun smoothly over a period of one.
    pub fn command(&self, time: f64, link: usize) -> Command<T> {
        let ramp = if time < 1.0 { time * time * (3.0 - 2.0 * time) } else { 1.0 };
        let slope = if time < 1.0 { 6.0 * time * (1.0 - time) } else { 0.0 };
        let phase = -self.lag * (link as f64 - 1.0) + TAU * time;
        let (sine, cosine) = phase.sin_cos();
        Command {
            place: self.amplitude * sine * ramp,
            rate: self.amplitude * (sine * slope + cosine * (ramp * TAU)),
            effort: real(0.0),
        }
    }
}
