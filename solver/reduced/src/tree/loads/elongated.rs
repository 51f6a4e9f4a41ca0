//! Elongated-body theory: links of a slender swimmer, and its speed from the motion of its tail.

use super::{Resistance, Strips};
use crate::tree::spatial::{Number, Symmetric, Twist, real};

/// A slender swimmer whose tail moves sideways by h, at a speed U that is steady in the mean. By the theory of
/// Lighthill (1970, J. Fluid Mech. 44, 265) its mean thrust is, by the mass m of the fluid that a length of its tail
/// moves,
///
/// ```text
/// T = m/2 (<h_t^2> - U^2 <h_x^2>),    m = pi/4 beta rho H^2
/// ```
///
/// with the height H of the tail, and with the drag rho/2 `c_D` S U^2 its speed is the one where both are as large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElongatedBody<T: Number> {
    /// Density of the fluid (kg/m3).
    pub density: T,
    /// Height H of the tail (m).
    pub height: T,
    /// Area S that the drag is referred to (m2).
    pub area: T,
    /// Coefficient of drag `c_D`.
    pub drag: T,
    /// Part beta of the mass of a cylinder about the tail.
    pub added_mass: T,
}

impl<T: Number> ElongatedBody<T> {
    /// Mass of the fluid that a length of the tail moves (kg/m).
    #[must_use]
    pub fn mass_per_length(&self) -> T {
        let quarter = std::f64::consts::FRAC_PI_4;
        self.added_mass * self.density * self.height * self.height * quarter
    }

    /// Mean thrust (N) less drag at a speed (m/s), from the mean squares of the tail's lateral velocity (m2/s2) and
    /// of its slope.
    #[must_use]
    pub fn surplus(&self, speed: T, velocity_square: T, slope_square: T) -> T {
        let square = speed * speed;
        let thrust = self.mass_per_length() * (velocity_square - square * slope_square) * 0.5;
        thrust - self.density * self.drag * self.area * square * 0.5
    }

    /// The steady speed (m/s) from the same.
    #[must_use]
    pub fn speed(&self, velocity_square: T, slope_square: T) -> T {
        let mass = self.mass_per_length();
        let resisting = self.drag * self.density * self.area + mass * slope_square;
        (mass * velocity_square / resisting).sqrt()
    }
}

/// A link of a slender swimmer, of length L along its x axis, by the theory of Lighthill (1971, Proc. R. Soc. B 179, 125)
/// for motions of any size. A length of it moves the mass m of fluid across itself, so that its momentum is m w n, by the
/// velocity w along the normal n. The force on the swimmer is
///
/// ```text
/// F = -d/dt (integral of m w n over its length) + [m w^2 / 2 t - m u w n] at the tail,    m = pi/4 beta rho H^2
/// ```
///
/// with the unit vector t towards the head and the velocity u along it: the fluid behind the tail keeps the momentum it has
/// got there. Over a link the first part is that of the masses m L across and m L^3/12 about its middle, momentum that
/// goes from link to link included; the last link has the second part, too. Drag is by strips beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElongatedLink<T: Number> {
    /// Its drag, and its half length L/2.
    pub drag: Strips<T>,
    /// The mass m (kg/m; kg/m2 a depth in the plane).
    pub mass: T,
    /// Where the head is from a tail, 1 along x or -1; none of links that are no tail.
    pub tail: Option<f64>,
}

impl<T: Number> ElongatedLink<T> {
    pub(super) fn added_mass(&self) -> Symmetric<T> {
        let length = self.drag.half_length * 2.0;
        let mut masses = Symmetric::zero();
        masses.linear[(1, 1)] = self.mass * length;
        masses.angular[(2, 2)] = self.mass * length * length * length / 12.0;
        masses
    }

    pub(super) fn resist(&self, twist: &Twist<T>) -> Resistance<T> {
        let mut made = self.drag.resist(twist);
        let Some(ahead) = self.tail else { return made };
        let place = self.drag.half_length * -ahead;
        let (along, across) = (twist.linear.x, twist.linear.y + place * twist.angular.z);
        let lateral = -self.mass * along * across * ahead;
        made.wrench.force.x += self.mass * across * across * (0.5 * ahead);
        made.wrench.force.y += lateral;
        made.wrench.torque.z += place * lateral;
        // What is left behind resists where the swimmer goes ahead
        if along.re() * ahead > 0.0 {
            let resistance = self.mass * along * ahead;
            made.slope.linear[(1, 1)] += resistance;
            made.slope.mixed[(1, 2)] += resistance * place;
            made.slope.angular[(2, 2)] += resistance * place * place;
        }
        made
    }
}

/// The mass (kg/m) of the fluid that a length of a body of a height (m) moves, by the part beta of that of a cylinder.
#[must_use]
pub fn elongated_mass<T: Number>(density: T, height: T, beta: T) -> T {
    beta * density * height * height * real::<T>(std::f64::consts::FRAC_PI_4)
}
