//! `Mass`: mass, centre and moments of bodies that are joined, and of the shapes of MJCF.

use std::f64::consts::PI;

use alewife_reduced::tree::Pose;
use nalgebra::{Matrix3, Vector3};

/// Mass (kg), centre (m), and inertia about it (kg m2).
#[derive(Debug, Clone, Copy)]
pub(super) struct Mass {
    pub mass: f64,
    pub center: Vector3<f64>,
    pub inertia: Matrix3<f64>,
}

impl Mass {
    pub fn zero() -> Self {
        Self { mass: 0.0, center: Vector3::zeros(), inertia: Matrix3::zeros() }
    }

    /// The same, seen from the frame in which its own has a pose.
    pub fn seen_from(&self, pose: &Pose<f64>) -> Self {
        let turn = &pose.rotation;
        Self {
            mass: self.mass,
            center: pose.position + turn * self.center,
            inertia: turn * self.inertia * turn.transpose(),
        }
    }

    /// Both as one body.
    pub fn with(&self, other: &Self) -> Self {
        if other.mass == 0.0 {
            return *self;
        }
        if self.mass == 0.0 {
            return *other;
        }
        let mass = self.mass + other.mass;
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        let about = |one: &Self| {
            let arm = one.center - center;
            let square = Matrix3::from_diagonal_element(arm.norm_squared());
            one.inertia + (square - arm * arm.transpose()) * one.mass
        };
        Self { mass, center, inertia: about(self) + about(other) }
    }

    /// Half lengths along its axes of the ellipsoid of even density with this mass and these moments (m).
    pub fn ellipsoid(&self) -> Vector3<f64> {
        let moments = self.inertia.diagonal();
        let largest = moments.max();
        let square = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let twice = (moments[j] + moments[k] - moments[i]).max(1e-6 * largest);
            2.5 * twice / self.mass
        };
        Vector3::new(square(0), square(1), square(2)).map(f64::sqrt)
    }
}

/// A solid in its own frame, half lengths (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Solid {
    Ellipsoid(Vector3<f64>),
    Box(Vector3<f64>),
    /// About z.
    Cylinder {
        radius: f64,
        half: f64,
    },
    /// About z, half of the length of the cylinder between its half spheres.
    Capsule {
        radius: f64,
        half: f64,
    },
}

impl Solid {
    pub fn volume(&self) -> f64 {
        match self {
            Self::Ellipsoid(r) => 4.0 / 3.0 * PI * r.product(),
            Self::Box(r) => 8.0 * r.product(),
            Self::Cylinder { radius, half } => 2.0 * PI * radius * radius * half,
            Self::Capsule { radius, half } => {
                PI * radius * radius * (2.0 * half + 4.0 / 3.0 * radius)
            }
        }
    }

    /// Half lengths of the ellipsoid that `MuJoCo` has in its place in a fluid.
    pub fn semi_axes(&self) -> Vector3<f64> {
        match self {
            Self::Ellipsoid(r) | Self::Box(r) => *r,
            Self::Cylinder { radius, half } => Vector3::new(*radius, *radius, *half),
            Self::Capsule { radius, half } => Vector3::new(*radius, *radius, half + radius),
        }
    }

    /// Of even density with a mass (kg), about its middle.
    pub fn of_mass(&self, mass: f64) -> Mass {
        let of_squares = |squares: Vector3<f64>| Vector3::repeat(squares.sum()) - squares;
        let round = |across: f64, about: f64| Vector3::new(across, across, about);
        let moments = match self {
            Self::Ellipsoid(r) => of_squares(r.component_mul(r)) * (0.2 * mass),
            Self::Box(r) => of_squares(r.component_mul(r)) * (mass / 3.0),
            Self::Cylinder { radius, half } => {
                let square = radius * radius;
                round(mass * (square / 4.0 + half * half / 3.0), 0.5 * mass * square)
            }
            Self::Capsule { radius, half } => {
                let square = radius * radius;
                let part = 2.0 * half / (2.0 * half + 4.0 / 3.0 * radius);
                let (middle, ends) = (mass * part, mass * (1.0 - part));
                let across = middle * (square / 4.0 + half * half / 3.0)
                    + ends * (0.4 * square + half * half + 0.75 * half * radius);
                round(across, 0.5 * middle * square + 0.4 * ends * square)
            }
        };
        Mass { mass, center: Vector3::zeros(), inertia: Matrix3::from_diagonal(&moments) }
    }
}
