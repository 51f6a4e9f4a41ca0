//! A first body that is guided: sliders along the axes of the laboratory and a pivot, of which some are given or locked.

use alewife_reduced::tree::{Drive, JointKind as Kind, Link, Pose, Symmetric};
use nalgebra::{Isometry3, Vector3};

use super::build::{Builder, in_space, lone};
use super::told::Told;
use crate::case::{Body, Geometry, ImposedMotion, Lock, Motion};

/// How the body goes along or about an axis.
enum Way {
    Free,
    Locked,
    Given(Told),
}

/// What is said of a motion.
fn way(body: &Body, motion: Lock, along: usize) -> Way {
    if let Motion::Imposed(imposed) = &body.motion {
        return Way::Given(imposed_rate(imposed, motion, along));
    }
    match body.driven.iter().find(|driven| driven.motion == motion) {
        Some(driven) => Way::Given(Told::driven(&driven.law)),
        None if body.locked.contains(&motion) => Way::Locked,
        None => Way::Free,
    }
}

fn imposed_rate(imposed: &ImposedMotion, motion: Lock, along: usize) -> Told {
    if motion == Lock::Rotation {
        let size = Vector3::from(imposed.angular_velocity.0).norm();
        return Told::Rate(size, imposed.factor_of_turn().cloned());
    }
    let value = imposed.velocity.get(along).copied().unwrap_or(0.0);
    Told::Rate(value, imposed.factor.clone())
}

/// The axis of a rotation that is given or free, in the laboratory.
fn turning_axis(body: &Body, geometry: Geometry) -> Vector3<f64> {
    let imposed = match &body.motion {
        Motion::Imposed(imposed) => Some(imposed.angular_velocity.0),
        _ => None,
    };
    let driven = body.driven.iter().find(|driven| driven.motion == Lock::Rotation);
    let axis = imposed.or_else(|| driven.map(|driven| driven.axis)).map(Vector3::from);
    // The sign of an angular velocity is in its axis
    axis.filter(|axis| (geometry == Geometry::Spatial || imposed.is_some()) && axis.norm() > 0.0)
        .map_or_else(Vector3::z, |axis| axis.normalize())
}

impl Builder<'_> {
    /// Puts the first body, whose centre has a frame in the world, on its guides.
    pub fn guide(&mut self, body: usize, frame: &Isometry3<f64>) {
        let one = &self.model.bodies[body];
        let geometry = self.geometry();
        let mut chain = vec![(Link::root(Symmetric::zero()), Told::Nothing, [0.0; 2])];
        let spring = one.spring.as_ref();
        let number = |v: &[f64], k: usize| v.get(k).copied().unwrap_or(0.0);
        let translations = [Lock::X, Lock::Y, Lock::Z];
        for (along, motion) in translations.into_iter().take(geometry.dimensions()).enumerate() {
            let mut joint = lone(Kind::Slider, Vector3::ith(along, 1.0));
            if let Some(spring) = spring {
                joint.stiffness = number(&spring.stiffness, along);
                joint.damping = number(&spring.damping, along);
                if !spring.anchor.is_empty() {
                    joint.rest = number(&spring.anchor, along) - frame.translation.vector[along];
                }
            }
            let rate = number(&one.velocity, along);
            hang(&mut chain, joint, way(one, motion, along), rate);
        }
        let axis = turning_axis(one, geometry);
        let mut joint = lone(Kind::Hinge, axis);
        if let Some(spring) = spring {
            (joint.stiffness, joint.damping) = (spring.torsion, spring.torsion_damping);
            joint.rest = spring.rest_angle.map_or(0.0, |rest| rest - one.angle);
        }
        let rate = in_space(&one.angular_velocity.0).z;
        hang(&mut chain, joint, way(one, Lock::Rotation, 0), rate);
        let last = chain.len() - 1;
        let rotation = *frame.rotation.to_rotation_matrix().matrix();
        let inside = Pose { rotation, position: Vector3::zeros() };
        for (number, (mut link, told, start)) in chain.into_iter().enumerate() {
            if number == last {
                self.fill(body, &inside, &mut link);
            }
            self.push(link, told, start);
        }
    }
}

/// Adds a joint to a chain, but one that is locked.
fn hang(
    chain: &mut Vec<(Link<f64>, Told, [f64; 2])>,
    joint: alewife_reduced::tree::Joint<f64>,
    way: Way,
    rate: f64,
) {
    let (joint, told, rate) = match way {
        Way::Locked => return,
        Way::Free => (joint, Told::Nothing, rate),
        Way::Given(told) => {
            let drive = if matches!(told, Told::Rate(..)) { Drive::Rate } else { Drive::Given };
            let rate = told.command(0.0).rate;
            (joint.driven(drive), told, rate)
        }
    };
    let parent = chain.len() - 1;
    chain.push((Link::new(parent, joint, Symmetric::zero()), told, [0.0, rate]));
}
