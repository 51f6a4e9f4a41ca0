//! Backward differences of first and second order with variable steps.
//!
//! With w = dt / dt_before, du/dt at the new time is a0 u_next + a1 u_now + a2 u_previous,
//! a0 = (1 + 2w) / (dt (1 + w)), a1 = -(1 + w) / dt, a2 = w^2 / (dt (1 + w)) (@hairer1993, III.5).

/// Coefficients of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bdf {
    /// Factor of the new level (1/s).
    pub next: f64,
    /// Factor of the present level (1/s).
    pub now: f64,
    /// Factor of the previous level (1/s).
    pub previous: f64,
    /// Size of the step (s).
    pub step: f64,
    /// The step over the one before; 0 for a first-order step.
    ratio: f64,
}

impl Bdf {
    /// Backward Euler.
    #[must_use]
    pub fn first_order(step: f64) -> Self {
        Self { next: 1.0 / step, now: -1.0 / step, previous: 0.0, step, ratio: 0.0 }
    }

    /// BDF2 after a step of size `before` (s).
    #[must_use]
    pub fn second_order(step: f64, before: f64) -> Self {
        let ratio = step / before;
        Self {
            next: (1.0 + 2.0 * ratio) / (step * (1.0 + ratio)),
            now: -(1.0 + ratio) / step,
            previous: ratio * ratio / (step * (1.0 + ratio)),
            step,
            ratio,
        }
    }

    /// Of second order after a step of a size (s), of first order where what was before does not count, after a size of zero.
    #[must_use]
    pub fn after(step: f64, before: f64) -> Self {
        if before > 0.0 { Self::second_order(step, before) } else { Self::first_order(step) }
    }

    /// The part of the rate known from older levels: a1 u_now + a2 u_previous.
    pub fn history<T>(&self, now: T, previous: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        now * self.now + previous * self.previous
    }

    /// A value at the new time from those before it, to the order of the step.
    pub fn extrapolate<T>(&self, now: T, previous: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        now * (1.0 + self.ratio) + previous * (-self.ratio)
    }

    /// The new value of a quantity whose rate at the new time is known; what rests stays where it
    /// is to the last bit.
    pub fn integrate<T>(&self, rate: T, now: T, previous: T) -> T
    where
        T: std::ops::Mul<f64, Output = T>
            + std::ops::Add<Output = T>
            + std::ops::Sub<Output = T>
            + Copy,
    {
        now + (rate + (now - previous) * self.previous) * (1.0 / self.next)
    }

    /// The rate at the new time of a quantity with these values; exactly zero for one that rests.
    pub fn rate<T>(&self, next: T, now: T, previous: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Sub<Output = T> + Copy,
    {
        (next - now) * self.next - (now - previous) * self.previous
    }

    /// The increment over the step of a quantity whose rate at the new time is known, from its increment
    /// over the step before: [`Self::integrate`] for quantities that have increments only, such as
    /// rotations.
    pub fn increment<T>(&self, rate: T, last: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        (rate + last * self.previous) * (1.0 / self.next)
    }

    /// The rate at the new time from the increments over this step and over the one before.
    pub fn rate_of_increments<T>(&self, [this, last]: [T; 2]) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Sub<Output = T>,
    {
        this * self.next - last * self.previous
    }

    /// Whether the step is of second order.
    #[must_use]
    pub fn is_second_order(&self) -> bool {
        self.ratio > 0.0
    }

    /// The error of the new value, over its difference from what [`Self::predict`] gives
    /// (the idea in @gresho1998, derived here for these formulas).
    #[must_use]
    pub fn error_share(&self) -> f64 {
        (1.0 + self.ratio) / (2.0 + 3.0 * self.ratio)
    }

    /// A value at the new time to second order, from two before and the rate now.
    pub fn predict<T>(&self, now: T, previous: T, rate: T) -> T
    where
        T: std::ops::Mul<f64, Output = T>
            + std::ops::Add<Output = T>
            + std::ops::Sub<Output = T>
            + Copy,
    {
        let w = self.ratio;
        now + rate * ((1.0 + w) * self.step) - (now - previous) * (w * w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_order_steps_of_any_ratio_are_exact_for_parabolas() {
        let parabola = |t: f64| 2.0 + 3.0 * t - 1.5 * t * t;
        for before in [0.05, 0.1, 0.2] {
            let bdf = Bdf::second_order(0.1, before);
            let (now, previous) = (parabola(1.0), parabola(1.0 - before));
            let rate = bdf.next * parabola(1.1) + bdf.history(now, previous);
            assert!((rate - (3.0 - 3.0 * 1.1)).abs() < 1e-12);
            assert!((bdf.integrate(rate, now, previous) - parabola(1.1)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_error_of_a_step_is_that_of_a_cubic() {
        // After exact values of t^3 a step errs by a known amount, and so does the prediction.
        let cubic = |t: f64| t * t * t;
        for before in [0.05, 0.1, 0.2] {
            let bdf = Bdf::second_order(0.1, before);
            let (now, previous) = (cubic(1.0), cubic(1.0 - before));
            let new = bdf.integrate(3.0 * 1.1 * 1.1, now, previous);
            let predicted = bdf.predict(now, previous, 3.0);
            let estimate = bdf.error_share() * (new - predicted);
            assert!((estimate.abs() - (new - cubic(1.1)).abs()).abs() < 1e-12);
        }
    }

    #[test]
    fn what_rests_stays_to_the_last_bit() {
        let bdf = Bdf::second_order(0.1, 0.07);
        assert_eq!(bdf.integrate(0.0, 0.3, 0.3), 0.3);
        assert_eq!(bdf.rate(0.3, 0.3, 0.3), 0.0);
    }

    #[test]
    fn extrapolation_is_exact_for_lines() {
        let bdf = Bdf::second_order(0.1, 0.3);
        assert!((bdf.extrapolate(2.0, 2.0 - 0.3) - 2.1).abs() < 1e-14);
        assert_eq!(Bdf::first_order(0.1).extrapolate(2.0, 7.0), 2.0);
    }
}
