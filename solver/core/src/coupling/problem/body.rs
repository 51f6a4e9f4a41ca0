//! `RigidBody`: a body in the fluid: what moves it, its inertia, loads, gait and joint.

use std::sync::Arc;

use alewife_mesh::{BoundaryId, Moments, SecondMoments};
use nalgebra::{Matrix3, Vector3};

use super::attachment::Attachment;
use super::in_time::TimeValue;
use super::joint::Joint;
use super::lever::Lever;
use super::magnet::Magnet;
use crate::body::{Inertia, Mode, Pose, RigidVector, Twist, Wrench};
use crate::gait::{DeformedOutline, Gait, ShapeMotion};
use crate::structure::{Flexible, GivenLoad};

/// What determines one rigid velocity of a body.
pub enum Drive {
    /// It is an unknown of the system.
    Free,
    /// It is zero; the reaction is a result.
    Held,
    /// It is given in time (m/s or rad/s); the reaction is a result.
    Given(TimeValue),
    /// It follows from the body at the other end of the joint.
    Linked,
}

impl Drive {
    /// The value at a time (s), where it is given.
    #[must_use]
    pub fn given(&self, time: f64) -> Option<f64> {
        match self {
            Self::Held => Some(0.0),
            Self::Given(value) => Some(value(time)),
            Self::Free | Self::Linked => None,
        }
    }
}

/// A linear spring and damper between a body and a pose, by the six rigid motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Force per way (N/m), torque per angle (N m/rad).
    pub stiffness: RigidVector,
    /// Force per velocity (N s/m), torque per angular velocity (N m s/rad).
    pub damping: RigidVector,
    /// Where it is at rest.
    pub rest: Pose,
}

/// A body in the fluid.
pub struct RigidBody {
    /// Name in the case file.
    pub name: String,
    /// Its boundary in the mesh.
    pub boundary: BoundaryId,
    /// Pose at time zero.
    pub pose: Pose,
    /// What determines its velocities, by [`Mode`].
    pub drives: [Drive; 6],
    /// Velocity at time zero, as far as it is free.
    pub initial: Twist,
    /// Mass and inertia tensor, zero without inertia; of the shape at rest where it deforms.
    pub inertia: Inertia,
    /// Volume (m3; area planar, m2) and second moments: the inertia of unit density.
    pub volume: Inertia,
    /// Weight less buoyancy, at the centre of mass.
    pub weight: Wrench,
    /// Buoyancy where it acts, if elsewhere: its torque.
    pub buoyancy: Option<Lever>,
    /// External load besides, at the time its factor is one.
    pub load: Wrench,
    /// Factor of the external load in time.
    pub load_factor: Option<TimeValue>,
    /// Whether the external load is given in the frame of the body, with which it turns.
    pub load_in_body: bool,
    /// Spring and damper.
    pub spring: Option<Spring>,
    /// Magnetic moment in a field.
    pub magnet: Option<Magnet>,
    /// Slip of the surface.
    pub gait: Option<Box<dyn Gait>>,
    /// How its outline deforms: in time, or with coordinates of its own, whose rates are further unknowns.
    pub shape: Option<Arc<dyn ShapeMotion>>,
    /// What of its coordinates is fixed to another body.
    pub attachment: Option<Attachment>,
    /// The joint by which it hangs on another body; its pose and velocity follow from it, but for the
    /// rotation in a free pivot.
    pub joint: Option<Joint>,
}

impl RigidBody {
    /// A force-free and torque-free body without inertia or gait, held in all motions.
    #[must_use]
    pub fn held(name: impl Into<String>, boundary: BoundaryId, pose: Pose) -> Self {
        Self {
            name: name.into(),
            boundary,
            pose,
            drives: [const { Drive::Held }; 6],
            initial: Twist::default(),
            inertia: Inertia::default(),
            volume: Inertia::default(),
            weight: Wrench::default(),
            buoyancy: None,
            load: Wrench::default(),
            load_factor: None,
            load_in_body: false,
            spring: None,
            magnet: None,
            gait: None,
            shape: None,
            attachment: None,
            joint: None,
        }
    }

    /// The loads that are given at its ends at a time (s), in the frame of its coordinates, those that turn with an end as they are
    /// in the shape it starts in; none of a rigid one.
    #[must_use]
    pub fn given_load_at_ends(&self, time: f64) -> GivenLoad {
        let load = |flexible: &dyn Flexible| flexible.given_load(&flexible.initial(), time);
        self.flexible().map(|flexible| load(flexible.as_ref())).unwrap_or_default()
    }

    /// The same body, free in all motions.
    #[must_use]
    pub fn free(self) -> Self {
        Self { drives: [const { Drive::Free }; 6], ..self }
    }

    /// The same body with a shape that follows coordinates of its own, which have its mass; weight and loads act at
    /// its centre.
    #[must_use]
    pub fn with_coordinates(self, shape: Arc<dyn ShapeMotion>) -> Self {
        let drives =
            Mode::ALL.map(|mode| if mode.is_rotation() { Drive::Held } else { Drive::Free });
        Self { drives, inertia: Inertia::default(), shape: Some(shape), ..self }
    }

    /// What has coordinates beside the pose, if anything has.
    #[must_use]
    pub fn flexible(&self) -> Option<&Arc<dyn Flexible>> {
        self.shape.as_ref()?.flexible()
    }

    /// What determines a velocity.
    #[must_use]
    pub fn drive(&self, mode: Mode) -> &Drive {
        &self.drives[mode]
    }

    /// Load from outside (N, N m) at a time (s) on the body at a pose, without those of fluid, springs
    /// and contact.
    #[must_use]
    pub fn external(&self, time: f64, pose: &Pose) -> RigidVector {
        let factor = self.load_factor.as_ref().map_or(1.0, |factor| factor(time));
        let load = if self.load_in_body {
            let Wrench { force, torque } = &self.load;
            Wrench { force: pose.to_world(force), torque: pose.to_world(torque) }
        } else {
            self.load
        };
        let given = self.weight.to_vector() + load.to_vector() * factor;
        let mut external = given;
        if let Some(magnet) = &self.magnet {
            external += magnet.load(time, pose).to_vector();
        }
        if let Some(lever) = &self.buoyancy {
            let torque = lever.torque(pose);
            external += Wrench { force: Vector3::zeros(), torque }.to_vector();
        }
        external
    }

    /// K of the torque T(pose) - K turn of all that turns the body with its pose, by which a step takes it implicitly
    /// (N m/rad); `None` where nothing does.
    #[must_use]
    pub fn turning_stiffness(&self, time: f64, pose: &Pose) -> Option<Matrix3<f64>> {
        let magnetic = self.magnet.as_ref().map(|magnet| magnet.turning_stiffness(time, pose));
        let buoyant = self.buoyancy.as_ref().map(|lever| lever.turning_stiffness(pose));
        match (magnetic, buoyant) {
            (Some(one), Some(other)) => Some(one + other),
            (one, other) => one.or(other),
        }
    }

    /// Mass and inertia tensor with an outline, those at rest for a body that does not deform.
    #[must_use]
    pub fn inertia_with(&self, outline: Option<&DeformedOutline>) -> Inertia {
        let Some(outline) = outline.filter(|_| !self.inertia.is_zero()) else {
            return self.inertia;
        };
        let (deformed, rest) = (second_moments(&outline.moments), self.volume.tensor);
        if let SecondMoments::Spatial { .. } = outline.moments.second {
            // Of one density everywhere
            let tensor = deformed * (self.inertia.mass / self.volume.mass);
            return Inertia { tensor, ..self.inertia };
        }
        let tensor = Matrix3::from_fn(|i, j| {
            let at_rest = self.inertia.tensor[(i, j)];
            if at_rest == 0.0 { 0.0 } else { at_rest * deformed[(i, j)] / rest[(i, j)] }
        });
        Inertia { tensor, ..self.inertia }
    }
}

/// Tensor of inertia of a body of unit density (m5; m4 planar) about its centroid.
#[must_use]
pub fn second_moments(moments: &Moments) -> Matrix3<f64> {
    let [along, across, about_z] = match moments.second {
        // In the plane only the moment about z is known, and needed
        SecondMoments::Planar { polar } => [0.0, 0.0, polar],
        SecondMoments::Revolved { along, across } => [along, across, across],
        SecondMoments::Spatial { tensor } => return tensor,
    };
    Matrix3::from_diagonal(&Vector3::new(along, across, about_z))
}
