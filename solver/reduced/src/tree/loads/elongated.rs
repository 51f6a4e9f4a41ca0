//! `ElongatedBody`: the speed of a slender swimmer by elongated-body theory, from the motion of its tail.

use crate::tree::spatial::Number;

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
