//! The tree of a case over any kind of number, with other coefficients: what derivatives by these are made with.

use alewife_reduced::tree::{
    Drive, Joint, Link, Number, Placement, Site, State, Stops, Symmetric, Tendon, Tree, TreeError,
    Weight, real,
};

use super::build::Reduced;
use super::part::pose;

fn symmetric<T: Number>(one: &Symmetric<f64>) -> Symmetric<T> {
    Symmetric {
        linear: one.linear.map(real),
        mixed: one.mixed.map(real),
        angular: one.angular.map(real),
    }
}

fn joint<T: Number>(joint: &Joint<f64>) -> Joint<T> {
    let stops = joint.stops.map(|stops| Stops {
        lower: real(stops.lower),
        upper: real(stops.upper),
        stiffness: real(stops.stiffness),
        damping: real(stops.damping),
    });
    let drive = match joint.drive {
        Drive::Effort => Drive::Effort,
        Drive::Given => Drive::Given,
        Drive::Rate => Drive::Rate,
        Drive::Servo { gain, limit } => Drive::Servo { gain: real(gain), limit: real(limit) },
    };
    Joint {
        kind: joint.kind,
        axis: joint.axis.map(real),
        drive,
        stiffness: real(joint.stiffness),
        rest: real(joint.rest),
        damping: real(joint.damping),
        armature: real(joint.armature),
        stops,
    }
}

fn link<T: Number>(link: &Link<f64>) -> Link<T> {
    let weight = link.weight.map(|weight| Weight {
        mass: real(weight.mass),
        mass_center: weight.mass_center.map(real),
        displaced: real(weight.displaced),
        buoyancy_center: weight.buoyancy_center.map(real),
    });
    Link {
        parent: link.parent,
        at: pose(&link.at),
        joint: joint(&link.joint),
        inertia: symmetric(&link.inertia),
        weight,
        loads: Vec::new(),
    }
}

fn tendon<T: Number>(tendon: &Tendon<f64>) -> Tendon<T> {
    let site = |site: &Site<f64>| Site { link: site.link, place: site.place.map(real) };
    Tendon {
        sites: tendon.sites.iter().map(site).collect(),
        stiffness: real(tendon.stiffness),
        damping: real(tendon.damping),
        rest: real(tendon.rest),
        pushes: tendon.pushes,
    }
}

/// The state that a case starts from.
pub(super) fn state<T: Number>(state: &State<f64>) -> State<T> {
    let all = |values: &[f64]| values.iter().map(|value| real(*value)).collect();
    State {
        time: state.time,
        root: Placement {
            position: state.root.position.map(real),
            quaternion: state.root.quaternion.map(real),
        },
        coordinates: all(&state.coordinates),
        velocities: all(&state.velocities),
        accelerations: all(&state.accelerations),
        efforts: all(&state.efforts),
    }
}

impl Reduced {
    /// Its tree with the coefficients that are given of each body.
    ///
    /// # Errors
    /// None that its own tree has not.
    pub fn tree_with<T: Number>(
        &self,
        coefficients: impl Fn(usize, &[f64]) -> Vec<T>,
    ) -> Result<Tree<T>, TreeError> {
        self.tree_of(coefficients, |_, _| ())
    }

    /// The same with joints that are changed, by the numbers of their links.
    ///
    /// # Errors
    /// None that its own tree has not.
    pub fn tree_of<T: Number>(
        &self,
        coefficients: impl Fn(usize, &[f64]) -> Vec<T>,
        change: impl Fn(usize, &mut Joint<T>),
    ) -> Result<Tree<T>, TreeError> {
        let mut links: Vec<Link<T>> = self.tree.links().iter().map(link).collect();
        links.iter_mut().enumerate().for_each(|(nth, link)| change(nth, &mut link.joint));
        for (body, part) in self.parts.iter().enumerate() {
            let own = coefficients(body, &part.coefficients);
            links[part.link].loads.extend(part.loads(&own));
        }
        let tendons = self.tree.tendons().iter().map(tendon).collect();
        Tree::new(self.root, links)?.in_gravity(self.gravity).with_tendons(tendons)
    }
}
