//! Tendons, servos and a keel of a case, in its tree.

use alewife_reduced::tree::{
    Drive, JointKind as Kind, Link, Pose, Site, State, Symmetric, Tendon, Tree,
};
use nalgebra::{Isometry3, Matrix3, Vector3};

use super::told::Told;
use crate::case::{KeelSpec, TendonSpec};
use crate::reduced::build::{Builder, lone};
use crate::reduced::inertia::in_space;
use crate::reduced::part::Part;

impl Builder<'_> {
    /// The tendons of a case, as long at rest as they are at the start unless it says so.
    pub fn tendons(
        &self,
        tree: &Tree<f64>,
        parts: &[Part],
        start: &State<f64>,
    ) -> Vec<Tendon<f64>> {
        let poses = tree.poses(start);
        let made = |spec: &TendonSpec| {
            let sites: Vec<Site<f64>> = spec
                .sites
                .iter()
                .filter_map(|site| {
                    let body = self.model.body_index(&site.body)?;
                    let frame = parts[body].inside.then(&Pose::at(-self.solids[body].center));
                    let place = frame.position + frame.rotation * in_space(&site.position);
                    Some(Site { link: parts[body].link, place })
                })
                .collect();
            let at = |site: &Site<f64>| {
                poses[site.link].position + poses[site.link].rotation * site.place
            };
            let length = sites.windows(2).map(|pair| (at(&pair[1]) - at(&pair[0])).norm()).sum();
            let (stiffness, damping, pushes) = (spec.stiffness, spec.damping, spec.pushes);
            Tendon { sites, stiffness, damping, rest: spec.rest.unwrap_or(length), pushes }
        };
        self.spec.tendon.iter().map(made).collect()
    }

    /// The servo of the joint above a body, if it has one.
    pub fn serve(
        &self,
        child: usize,
        joint: &mut alewife_reduced::tree::Joint<f64>,
    ) -> Option<Told> {
        let name = &self.model.bodies[child].name;
        let servo = self.spec.servo.iter().find(|servo| servo.joint == *name)?;
        let (gain, limit) = (servo.gain, servo.limit.unwrap_or(f64::INFINITY));
        joint.drive = Drive::Servo { gain, limit };
        Some(Told::Rate(servo.rate, None))
    }

    /// Puts the first body, whose centre of mass has a frame in the world, on the springs of its keel, and gives where they
    /// are.
    pub fn keep(&mut self, body: usize, keel: &KeelSpec, frame: &Isometry3<f64>) -> Vector3<f64> {
        let lever = keel.position.map_or_else(Vector3::zeros, |position| {
            Vector3::from(position) - self.solids[body].center
        });
        let rotation = *frame.rotation.to_rotation_matrix().matrix();
        let inside = Pose { rotation, position: -(rotation * lever) };
        self.push(Link::root(Symmetric::zero()), Told::Nothing, [0.0; 2]);
        for (nth, kind) in [Kind::Slider, Kind::Hinge].into_iter().enumerate() {
            for axis in 0..3 {
                let mut joint = lone(kind, Vector3::ith(axis, 1.0));
                if kind == Kind::Slider && axis == 2 {
                    (joint.stiffness, joint.damping) = (keel.heave_stiffness, keel.heave_damping);
                } else if kind == Kind::Hinge && axis < 2 {
                    (joint.stiffness, joint.damping) = (keel.tilt_stiffness, keel.tilt_damping);
                }
                let mut link = Link::new(3 * nth + axis, joint, Symmetric::zero());
                if kind == Kind::Hinge && axis == 2 {
                    self.fill(body, &inside, &mut link);
                }
                self.push(link, Told::Nothing, [0.0; 2]);
            }
        }
        frame.translation.vector + Matrix3::from(rotation) * lever
    }
}
