//! `ElasticInStep`: bodies with coordinates as contact asks for them in a step.

use std::fmt;
use std::ops::Range;

use nalgebra::{DMatrix, DVector, Vector3};

use super::context::StepContext;
use crate::body::Pose;
use crate::contact::{ElasticBodies, ElasticContact, Gaps, InnerForces};
use crate::coupling::{ForcesBeyond, RigidBodyEquations};
use crate::motion::GapsAt;

/// The bodies with coordinates of a step, in a mesh.
struct ElasticInStep<'a, const D: usize> {
    step: &'a StepContext<'a, D>,
    /// Where the frame is (m).
    origin: Vector3<f64>,
    ranges: Vec<Range<usize>>,
    lengths: Vec<f64>,
    bases: Vec<usize>,
}

impl<const D: usize> fmt::Debug for ElasticInStep<'_, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ElasticInStep").field("ranges", &self.ranges).finish_non_exhaustive()
    }
}

impl<const D: usize> ElasticBodies for ElasticInStep<'_, D> {
    fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }

    fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    fn bases(&self) -> &[usize] {
        &self.bases
    }

    fn place(&self, poses: &mut [Pose], coordinates: &mut [f64]) -> Option<Box<dyn Gaps>> {
        let StepContext { stepper, state, history, .. } = self.step;
        let problem = stepper.problem;
        let moved =
            |shift: Vector3<f64>, pose: &Pose| Pose { center: pose.center + shift, ..*pose };
        let shifts: Vec<Vector3<f64>> =
            state.image_shifts.iter().map(|shift| shift - self.origin).collect();
        let pairs = poses.iter().zip(&shifts);
        let mut own: Vec<Pose> = pairs.map(|(pose, shift)| moved(-shift, pose)).collect();
        problem.follow_attachments(&own, coordinates);
        problem.follow_coordinates(&mut own, coordinates);
        for ((pose, own), (shift, range)) in
            poses.iter_mut().zip(&own).zip(shifts.iter().zip(&self.ranges))
        {
            if !range.is_empty() {
                *pose = moved(*shift, own);
            }
        }
        let shapes = history.shapes.with_coordinates(&problem.bodies, coordinates).ok()?;
        match stepper.path.gaps(&shapes)? {
            GapsAt::Deformed(gaps) => Some(gaps),
            GapsAt::Reference(_) => None,
        }
    }

    fn displacement_bounds(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let StepContext { stepper, history, .. } = self.step;
        let bodies = &stepper.problem.bodies;
        match stepper.path.moving_mesh() {
            Some(moving) => moving.ways_of_surfaces(bodies, &history.shapes, [from, to]),
            None => vec![0.0; bodies.len()],
        }
    }
}

/// The forces beyond the linear part of the equations of coordinates.
pub(super) struct Beyond(pub ForcesBeyond);

impl InnerForces for Beyond {
    fn beyond_linear(&self, rates: &[f64]) -> DVector<f64> {
        self.0.forces(rates)
    }

    fn tangent(&self, rates: &[f64]) -> DMatrix<f64> {
        self.0.tangent(rates)
    }
}

impl<const D: usize> StepContext<'_, D> {
    /// Whether bodies with coordinates may be in contact.
    pub fn has_elastic_contact(&self) -> bool {
        self.stepper.contact.is_some() && self.stepper.problem.n_coordinates() > 0
    }

    /// What contact is to know of bodies with coordinates, seen from a frame (m); none where there are no such bodies.
    pub fn elastic_at(
        &self,
        origin: Vector3<f64>,
        equations: &RigidBodyEquations,
    ) -> Option<ElasticContact<'_>> {
        let Self { stepper, state, .. } = self;
        let problem = stepper.problem;
        if !self.has_elastic_contact() {
            return None;
        }
        let ranges = problem.coordinates();
        let mut lengths = vec![1.0; problem.n_coordinates()];
        let mut unmoved = vec![0.0; problem.n_coordinates()];
        for equation in &equations.flexible {
            for (own, value) in equation.unmoved.iter().enumerate() {
                unmoved[equation.first + own] = *value;
                lengths[equation.first + own] = equation.body.length_of(own);
            }
        }
        let attachments = problem.bodies.iter().filter_map(|body| body.attachment.as_ref());
        let bases = attachments.map(|attachment| attachment.to).collect();
        let bodies = Box::new(ElasticInStep { step: self, origin, ranges, lengths, bases });
        Some(ElasticContact { bodies, unmoved, start: state.shapes.now.clone() })
    }
}
