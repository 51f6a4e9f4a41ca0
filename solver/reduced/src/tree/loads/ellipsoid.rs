//! `Ellipsoid`: the loads of an ellipsoid with five coefficients.

use nalgebra::{Matrix3, Vector3};

use super::Resistance;
use crate::tree::spatial::{Number, Symmetric, Twist, Wrench, norm, real};

use std::f64::consts::PI;

/// Nodes and weights of the Kronrod rule of 15 points on [-1, 1], from the outermost to the middle.
const KRONROD: [[f64; 2]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_55],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18],
    [0.741_531_185_599_394_4, 0.140_653_259_715_525_92],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_89],
    [0.0, 0.209_482_141_084_727_83],
];

/// What the fluid about the ellipsoid does by its inertia.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AddedMass {
    /// It resists accelerations, and the momentum it has turns with the body.
    #[default]
    Full,
    /// As `MuJoCo` has it: no resistance to accelerations, but the forces of the momentum that turns.
    Mujoco,
}

/// The lift by the angle of attack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lift {
    /// By the formula, at any size.
    #[default]
    Full,
    /// As `MuJoCo` 3 has it (3.3.7; 4.0 has it full): it fades out where parts are small and slow.
    Mujoco3,
}

/// What the denominators of projections are at least in `MuJoCo` 3 (SI units).
const LEAST: f64 = 1e-15;

/// Coefficients without dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipsoidCoefficients<T: Number> {
    /// Drag on the area across the velocity.
    pub blunt: T,
    /// Drag on what is left of the largest area.
    pub slender: T,
    /// Drag against turning.
    pub angular: T,
    /// Lift by the angle of attack.
    pub kutta: T,
    /// Lift by turning.
    pub magnus: T,
}

impl<T: Number> EllipsoidCoefficients<T> {
    /// The numbers in this order: blunt, slender, angular, Kutta, Magnus.
    #[must_use]
    pub fn from_array(c: [T; 5]) -> Self {
        Self { blunt: c[0], slender: c[1], angular: c[2], kutta: c[3], magnus: c[4] }
    }
}

/// An ellipsoid of the semi-axes r in a fluid of density rho and dynamic viscosity mu, in the model of `MuJoCo`
/// (its documentation, chapter "Fluid forces", by G. Novati). For the velocity v of its centre and the angular
/// velocity w, both in its axes, with the area `A_p` across v, the largest one A = pi `r_max` `r_mid`, the volume
/// V, the mean radius R, and n the normal of the surface where it meets the flow,
///
/// ```text
/// f = -rho (C_b A_p + C_s (A - A_p)) |v| v - 6 pi mu R v + C_m rho V w x v + C_k rho A_p (v.n/|v|) (n x v) x v
/// g = -rho |C_a I w + C_s (I_max - I) w| w - 8 pi mu R^3 w
/// ```
///
/// where I = 8/15 pi `r_i` max(`r_j`, `r_k`)^4. `MuJoCo` 3 divides by what is `LEAST` at least: with the fourth powers
/// of areas in m2 that takes most of the lift from a part of some centimetres, and `Lift::Mujoco3` does the same. To this comes the momentum of the fluid: masses m and moments of
/// inertia J of the potential flow (Lamb, Hydrodynamics, art. 114 and 373), their integrals exact or, as
/// `AddedMass::Mujoco`, by the rule of 15 points that `MuJoCo` takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Ellipsoid<T: Number> {
    semi_axes: Vector3<T>,
    density: T,
    viscosity: T,
    coefficients: EllipsoidCoefficients<T>,
    inertia: AddedMass,
    lift: Lift,
    masses: Vector3<T>,
    moments: Vector3<T>,
    /// C_a I + C_s (I_max - I).
    turning: Vector3<T>,
    largest_area: T,
    volume: T,
}

/// Carlson's integral `R_D`(x, y, z) = 3/2 int dt / ((t + z) sqrt((t + x) (t + y) (t + z))) from 0 on, to 1e-15 by his
/// theorem of duplication (Carlson 1979, Numer. Math. 33, 1).
fn carlson<T: Number>(mut x: T, mut y: T, mut z: T) -> T {
    let (mut sum, mut share): (T, f64) = (real(0.0), 1.0);
    loop {
        let mean = (x + y + z * 3.0) / 5.0;
        let [a, b, c] = [x, y, z].map(|part| (mean - part) / mean);
        if [a, b, c].iter().all(|part| part.re().abs() < 5e-4) {
            let (ab, cc) = (a * b, c * c);
            let (less, lesser) = (ab - cc, ab - cc * 6.0);
            let both = lesser + less * 2.0;
            let first = lesser * (lesser * (9.0 / 88.0) - c * both * (9.0 / 52.0) - 3.0 / 14.0);
            let inner = c * (c * ab * (3.0 / 26.0) - less * (9.0 / 22.0));
            let series = first + c * (both / 6.0 + inner) + 1.0;
            return sum * 3.0 + series * share / (mean * mean.sqrt());
        }
        let [p, q, r] = [x.sqrt(), y.sqrt(), z.sqrt()];
        let lambda = p * q + q * r + r * p;
        sum += (r * (z + lambda)).recip() * share;
        share *= 0.25;
        [x, y, z] = [x, y, z].map(|part| (part + lambda) * 0.25);
    }
}

/// The numbers kappa of the potential flow about an ellipsoid: `r_x` `r_y` `r_z` times the integral from 0 on of
/// dl / sqrt((`r_i`^2 + l)^3 (`r_j`^2 + l) (`r_k`^2 + l)).
fn kappa<T: Number>(r: &Vector3<T>) -> Vector3<T> {
    let (product, square) = (r.x * r.y * r.z, r.map(|a| a * a));
    let of = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        product * carlson(square[j], square[k], square[i]) * (2.0 / 3.0)
    };
    Vector3::new(of(0), of(1), of(2))
}

/// The same by the rule of 15 points of `MuJoCo`.
fn kappa_by_points<T: Number>(r: &Vector3<T>) -> Vector3<T> {
    let product = r.x * r.y * r.z;
    let of = |i: usize| {
        let (a, b, c) = (r[i], r[(i + 1) % 3], r[(i + 2) % 3]);
        let scale = (a * a * a * b * c).powf(0.4);
        let at = |x: f64| {
            let l = scale * (x * x * x / ((1.0 - x) * (1.0 - x)));
            let slope = scale * (x * x * (3.0 - x) / (1.0 - x).powi(3));
            let a = a * a + l;
            product * slope / (a * a * a * (b * b + l) * (c * c + l)).sqrt()
        };
        let mut sum: T = real(0.0);
        for [node, weight] in KRONROD {
            sum += at(0.5 * (1.0 - node)) * (0.5 * weight);
            if node > 0.0 {
                sum += at(0.5 * (1.0 + node)) * (0.5 * weight);
            }
        }
        sum
    };
    Vector3::new(of(0), of(1), of(2))
}

fn cube<T: Number>(a: T) -> T {
    a * a * a
}

impl<T: Number> Ellipsoid<T> {
    /// An ellipsoid of semi-axes (m) in a fluid of a density (kg/m3) and a dynamic viscosity (Pa s).
    #[must_use]
    pub fn new(
        semi_axes: [T; 3],
        density: T,
        viscosity: T,
        coefficients: EllipsoidCoefficients<T>,
        inertia: AddedMass,
    ) -> Self {
        let r = Vector3::from(semi_axes);
        let mut sorted = semi_axes;
        sorted.sort_by(|a, b| a.re().total_cmp(&b.re()));
        let [_, mid, max] = sorted;
        let volume = r.x * r.y * r.z * (4.0 / 3.0 * PI);
        let k = match inertia {
            AddedMass::Full => kappa(&r),
            AddedMass::Mujoco => kappa_by_points(&r),
        };
        let around = density * volume;
        let masses = k.map(|k| around * k / (-k + 2.0));
        let moment = |i: usize| {
            let (b, c) = (r[(i + 1) % 3], r[(i + 2) % 3]);
            let (less, sum) = (b * b - c * c, b * b + c * c);
            let by = k[(i + 2) % 3] - k[(i + 1) % 3];
            let under = less * 2.0 - sum * by;
            if under.re().abs() < 1e-300 {
                return real(0.0);
            }
            around * 0.2 * less * less * (by / under).abs()
        };
        let largest = |b: T, c: T| if b.re() > c.re() { b } else { c };
        let turn_max = mid * max.powi(4) * (8.0 / 15.0 * PI);
        let turning = |i: usize| {
            let across = largest(r[(i + 1) % 3], r[(i + 2) % 3]);
            let turn = r[i] * across.powi(4) * (8.0 / 15.0 * PI);
            coefficients.angular * turn + coefficients.slender * (turn_max - turn)
        };
        Self {
            semi_axes: r,
            density,
            viscosity,
            coefficients,
            inertia,
            lift: Lift::Full,
            masses,
            moments: Vector3::new(moment(0), moment(1), moment(2)),
            turning: Vector3::new(turning(0), turning(1), turning(2)),
            largest_area: max * mid * PI,
            volume,
        }
    }

    /// The same ellipsoid with another lift by the angle of attack.
    #[must_use]
    pub fn lifted(self, lift: Lift) -> Self {
        Self { lift, ..self }
    }

    /// Volume (m3).
    pub fn volume(&self) -> T {
        self.volume
    }

    pub(super) fn added_mass(&self) -> Symmetric<T> {
        match self.inertia {
            AddedMass::Full => Symmetric::diagonal(self.masses, self.moments),
            AddedMass::Mujoco => Symmetric::zero(),
        }
    }

    pub(super) fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        let mut found = self.viscous();
        let slope = found.slope;
        found.wrench = slope.times(twist).plus(&Wrench::zero(), real(1.0));
        found.wrench.force = -found.wrench.force;
        found.wrench.torque = -found.wrench.torque;
        self.translate(twist, &mut found);
        self.turn(twist, &mut found);
        if self.inertia == AddedMass::Mujoco {
            let momentum = Symmetric::diagonal(self.masses, self.moments).times(twist);
            found.wrench = found.wrench.plus(&twist.cross_momentum(&momentum), real(-1.0));
        }
        found
    }

    /// What the viscosity resists, as a sphere of the mean radius meets it.
    fn viscous(&self) -> Resistance<T> {
        let r = &self.semi_axes;
        let radius = (r.x + r.y + r.z) / 3.0;
        let along = self.viscosity * radius * (6.0 * PI);
        let about = self.viscosity * cube(radius) * (8.0 * PI);
        let slope = Symmetric::diagonal(Vector3::from_element(along), Vector3::from_element(about));
        Resistance { wrench: Wrench::zero(), slope }
    }

    /// Drag and lift of a translation.
    fn translate(&self, twist: &Twist<T>, found: &mut Resistance<T>) {
        let (v, c) = (&twist.linear, &self.coefficients);
        found.wrench.force += twist.angular.cross(v) * (c.magnus * self.density * self.volume);
        let speed = norm(v);
        if speed.re() <= 0.0 {
            return;
        }
        let r = &self.semi_axes;
        let square = Vector3::new(r.y * r.z, r.z * r.x, r.x * r.y).map(|a| a * a);
        let steep = square.component_mul(v);
        let upper = steep.dot(&steep);
        let mut lower = v.dot(&steep);
        let mut share: T = real(1.0);
        if self.lift == Lift::Mujoco3 {
            let under = speed * upper;
            if under.re() < LEAST {
                share = under / LEAST;
            }
            if lower.re() < LEAST {
                lower = real(LEAST);
            }
        }
        let area = (upper / lower).sqrt() * PI;
        let size = self.density * (c.blunt * area + c.slender * (self.largest_area - area));
        let normal = steep / upper.sqrt();
        let lift = c.kutta * self.density * area * share;
        found.wrench.force -= v * (size * speed);
        found.wrench.force += normal.cross(v).cross(v) * (lift * v.dot(&normal) / speed);
        let identity = Matrix3::from_diagonal(&Vector3::from_element(size * speed));
        found.slope.linear += identity
            + v * v.transpose() * (size / speed)
            + normal * normal.transpose() * (lift * speed);
    }

    /// Drag of a rotation.
    fn turn(&self, twist: &Twist<T>, found: &mut Resistance<T>) {
        let w = &twist.angular;
        let size = self.density * norm(&self.turning.component_mul(w));
        let square = w.dot(w);
        if size.re() <= 0.0 || square.re() <= 0.0 {
            return;
        }
        found.wrench.torque -= w * size;
        let identity = Matrix3::from_diagonal(&Vector3::from_element(size));
        found.slope.angular += identity + w * w.transpose() * (size / square);
    }
}
