//! `Unknowns`: what of the bodies is found by integration, and what a flow is asked for.

use super::course::Rates;
use crate::body::{Mode, Modes, Pose, RigidVector, Twist};
use crate::case::{BodyQuantity, Column, Component, Source, SwimmerQuantity};
use crate::coupling::Problem;

/// The motions of bodies that are found by integration, and whether powers count.
#[derive(Debug, Clone)]
pub(super) struct Unknowns {
    /// Bodies and their motions.
    motions: Vec<(usize, Mode)>,
    /// Groups whose powers are asked for.
    groups: Vec<usize>,
    n_bodies: usize,
    n_groups: usize,
}

impl Unknowns {
    /// Those of a problem, whose powers are asked for or not.
    pub fn new<const D: usize>(problem: &Problem<D>, with_powers: bool) -> Self {
        let modes: Modes = problem.modes();
        let bodies = problem.bodies.iter().enumerate();
        // Those that hang on others without a motion of their own follow from these
        let integrated = bodies
            .filter(|(_, body)| body.joint.as_ref().is_none_or(|joint| joint.is_free()))
            .map(|(number, _)| number);
        let n_groups = problem.groups.len();
        Self {
            motions: integrated
                .flat_map(|body| modes.iter().map(move |mode| (body, mode)))
                .collect(),
            groups: if with_powers { (0..n_groups).collect() } else { Vec::new() },
            n_bodies: problem.bodies.len(),
            n_groups,
        }
    }

    /// How many motions are integrated.
    pub fn n_motions(&self) -> usize {
        self.motions.len()
    }

    /// The quantities of a flow that are asked for: the velocities of the motions, then powers.
    pub fn columns(&self) -> Vec<Column> {
        let velocity = |(body, mode): &(usize, Mode)| {
            let quantity = if mode.is_rotation() {
                BodyQuantity::AngularVelocity
            } else {
                BodyQuantity::Velocity
            };
            let component = [Component::X, Component::Y, Component::Z][mode.axis()];
            Column { name: String::new(), source: Source::Body(*body, quantity), component }
        };
        let power = |group: &usize| Column {
            name: String::new(),
            source: Source::Swimmer(*group, SwimmerQuantity::Power),
            component: Component::Whole,
        };
        self.motions.iter().map(velocity).chain(self.groups.iter().map(power)).collect()
    }

    /// What values of these quantities say of a course.
    pub fn rates(&self, values: &[f64]) -> Rates {
        let (velocities, found) = values.split_at(self.motions.len());
        let mut vectors = vec![RigidVector::zeros(); self.n_bodies];
        for ((body, mode), velocity) in self.motions.iter().zip(velocities) {
            vectors[*body][*mode] = *velocity;
        }
        let mut powers = vec![0.0; self.n_groups];
        self.groups.iter().zip(found).for_each(|(group, power)| powers[*group] = *power);
        Rates { twists: vectors.iter().map(Twist::from_vector).collect(), powers }
    }

    /// How far the motions have brought bodies from poses (m, rad).
    pub fn displacements(&self, from: &[Pose], to: &[Pose]) -> Vec<f64> {
        let way = |(body, mode): &(usize, Mode)| to[*body].displacement_from(&from[*body])[*mode];
        self.motions.iter().map(way).collect()
    }

    /// Poses from which one of the motions has led by a way (m, rad).
    pub fn displaced(&self, poses: &[Pose], nth: usize, way: f64) -> Vec<Pose> {
        let (body, mode) = self.motions[nth];
        let mut displacement = RigidVector::zeros();
        displacement[mode] = way;
        let mut poses = poses.to_vec();
        poses[body] = poses[body].displaced(&displacement);
        poses
    }

    /// Whether one of the motions is a rotation.
    pub fn is_rotation(&self, nth: usize) -> bool {
        self.motions[nth].1.is_rotation()
    }
}
