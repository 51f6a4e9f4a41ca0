//! `Twist`, `Wrench`, `Symmetric` and `Pose`: rigid motion in space over any kind of number.

use nalgebra::{Matrix3, Vector3};
use num_dual::DualNum;

/// Reals, and dual numbers over them, with which derivatives of whole motions are exact.
pub trait Number: DualNum<Primitive = f64> + Copy + Send + Sync {}

impl<T: DualNum<Primitive = f64> + Copy + Send + Sync> Number for T {}

/// A real as a number without derivatives.
#[must_use]
pub fn real<T: Number>(value: f64) -> T {
    T::from(value)
}

/// A vector of reals as one of numbers.
#[must_use]
pub fn vector<T: Number>(v: [f64; 3]) -> Vector3<T> {
    Vector3::new(real(v[0]), real(v[1]), real(v[2]))
}

/// The length of a vector; zero, without derivatives, where the vector is.
#[must_use]
pub fn norm<T: Number>(v: &Vector3<T>) -> T {
    let square = v.dot(v);
    if square.re() > 0.0 { square.sqrt() } else { real(0.0) }
}

/// Velocity of a point of a body, and the body's angular velocity (m/s, rad/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist<T: Number> {
    /// Velocity of the point (m/s).
    pub linear: Vector3<T>,
    /// Angular velocity (rad/s).
    pub angular: Vector3<T>,
}

/// A force through a point, and the torque about it (N, N m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench<T: Number> {
    /// Force (N).
    pub force: Vector3<T>,
    /// Torque about the point (N m).
    pub torque: Vector3<T>,
}

impl<T: Number> Twist<T> {
    /// No motion.
    #[must_use]
    pub fn zero() -> Self {
        Self { linear: vector([0.0; 3]), angular: vector([0.0; 3]) }
    }

    /// This and `factor` times another.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: T) -> Self {
        Self {
            linear: self.linear + other.linear * factor,
            angular: self.angular + other.angular * factor,
        }
    }

    /// How a twist fixed to a body that moves with this one changes: the commutator of both.
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        Self {
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
            angular: self.angular.cross(&other.angular),
        }
    }

    /// How a momentum fixed to a body that moves with this twist changes.
    #[must_use]
    pub fn cross_momentum(&self, momentum: &Wrench<T>) -> Wrench<T> {
        Wrench {
            force: self.angular.cross(&momentum.force),
            torque: self.angular.cross(&momentum.torque) + self.linear.cross(&momentum.force),
        }
    }

    /// Power of a wrench about the same point (W).
    #[must_use]
    pub fn dot(&self, wrench: &Wrench<T>) -> T {
        self.linear.dot(&wrench.force) + self.angular.dot(&wrench.torque)
    }
}

impl<T: Number> Wrench<T> {
    /// No load.
    #[must_use]
    pub fn zero() -> Self {
        Self { force: vector([0.0; 3]), torque: vector([0.0; 3]) }
    }

    /// This and `factor` times another.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: T) -> Self {
        Self {
            force: self.force + other.force * factor,
            torque: self.torque + other.torque * factor,
        }
    }
}

/// A symmetric matrix that makes a wrench of a twist, about one point: masses, or resistances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symmetric<T: Number> {
    /// Force by velocity, symmetric.
    pub linear: Matrix3<T>,
    /// Force by angular velocity; transposed, torque by velocity.
    pub mixed: Matrix3<T>,
    /// Torque by angular velocity, symmetric.
    pub angular: Matrix3<T>,
}

/// A matrix times [p], where [p] x = p x x.
fn times_cross<T: Number>(matrix: &Matrix3<T>, p: &Vector3<T>) -> Matrix3<T> {
    let m = matrix;
    Matrix3::from_columns(&[
        m.column(1) * p.z - m.column(2) * p.y,
        m.column(2) * p.x - m.column(0) * p.z,
        m.column(0) * p.y - m.column(1) * p.x,
    ])
}

/// [p] times a matrix.
fn cross_times<T: Number>(p: &Vector3<T>, matrix: &Matrix3<T>) -> Matrix3<T> {
    let column = |k: usize| p.cross(&matrix.column(k));
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}

impl<T: Number> Symmetric<T> {
    /// Nothing.
    #[must_use]
    pub fn zero() -> Self {
        let zero = Matrix3::from_element(real(0.0));
        Self { linear: zero, mixed: zero, angular: zero }
    }

    /// Six numbers on the diagonal, those of the velocity first.
    #[must_use]
    pub fn diagonal(linear: Vector3<T>, angular: Vector3<T>) -> Self {
        let mut made = Self::zero();
        for axis in 0..3 {
            made.linear[(axis, axis)] = linear[axis];
            made.angular[(axis, axis)] = angular[axis];
        }
        made
    }

    /// Mass (kg) and moments of inertia (kg m2) about the principal axes through a centre of mass that is at
    /// the origin.
    #[must_use]
    pub fn rigid(mass: T, moments: Vector3<T>) -> Self {
        Self::diagonal(Vector3::from_element(mass), moments)
    }

    /// This and `factor` times another about the same point.
    #[must_use]
    pub fn plus(&self, other: &Self, factor: T) -> Self {
        Self {
            linear: self.linear + other.linear * factor,
            mixed: self.mixed + other.mixed * factor,
            angular: self.angular + other.angular * factor,
        }
    }

    /// The wrench of a twist.
    #[must_use]
    pub fn times(&self, twist: &Twist<T>) -> Wrench<T> {
        Wrench {
            force: self.linear * twist.linear + self.mixed * twist.angular,
            torque: self.mixed.tr_mul(&twist.linear) + self.angular * twist.angular,
        }
    }

    /// The same law in the axes and about the origin of a frame in which its own frame has a pose.
    #[must_use]
    pub fn seen_from(&self, pose: &Pose<T>) -> Self {
        let (r, p) = (&pose.rotation, &pose.position);
        let turned = |m: &Matrix3<T>| r * m * r.transpose();
        let (a, b, c) = (turned(&self.linear), turned(&self.mixed), turned(&self.angular));
        let mixed = b - times_cross(&a, p);
        // C - B^T [p] + [p] B - [p] A [p], with [p] mixed = [p] B - [p] A [p]
        let angular = c - times_cross(&b.transpose(), p) + cross_times(p, &mixed);
        Self { linear: a, mixed, angular }
    }
}

/// Where a frame is in another: the axes of the first are the columns of `rotation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<T: Number> {
    /// Rotation matrix.
    pub rotation: Matrix3<T>,
    /// Origin (m).
    pub position: Vector3<T>,
}

impl<T: Number> Pose<T> {
    /// The same frame.
    #[must_use]
    pub fn identity() -> Self {
        Self::at(vector([0.0; 3]))
    }

    /// A frame that is not turned.
    #[must_use]
    pub fn at(position: Vector3<T>) -> Self {
        let one = vector([1.0; 3]);
        Self { rotation: Matrix3::from_diagonal(&one), position }
    }

    /// A pose seen from this one.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            position: self.position + self.rotation * next.position,
        }
    }

    /// A twist about the outer origin, in outer axes, as one about the inner origin, in inner axes.
    #[must_use]
    pub fn twist_inside(&self, outer: &Twist<T>) -> Twist<T> {
        let at = outer.linear + outer.angular.cross(&self.position);
        Twist { linear: self.rotation.tr_mul(&at), angular: self.rotation.tr_mul(&outer.angular) }
    }

    /// A twist about the inner origin, in inner axes, as one about the outer origin, in outer axes.
    #[must_use]
    pub fn twist_outside(&self, inner: &Twist<T>) -> Twist<T> {
        let angular = self.rotation * inner.angular;
        Twist { linear: self.rotation * inner.linear + self.position.cross(&angular), angular }
    }

    /// A wrench about the inner origin, in inner axes, as one about the outer origin, in outer axes.
    #[must_use]
    pub fn wrench_outside(&self, inner: &Wrench<T>) -> Wrench<T> {
        let force = self.rotation * inner.force;
        Wrench { force, torque: self.rotation * inner.torque + self.position.cross(&force) }
    }
}

/// The rotation matrix about a unit vector by an angle (rad).
#[must_use]
pub fn rotation<T: Number>(axis: &Vector3<T>, angle: T) -> Matrix3<T> {
    let (sine, cosine) = angle.sin_cos();
    let rest = -cosine + 1.0;
    let (x, y, z) = (axis.x, axis.y, axis.z);
    Matrix3::new(
        cosine + x * x * rest,
        x * y * rest - z * sine,
        x * z * rest + y * sine,
        x * y * rest + z * sine,
        cosine + y * y * rest,
        y * z * rest - x * sine,
        x * z * rest - y * sine,
        y * z * rest + x * sine,
        cosine + z * z * rest,
    )
}
