//! `Law`: the short-range force as a function of the gap.

use super::{ContactError, Dissipation};

/// Which law, with its strength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LawKind {
    /// F = (r - d)^2 / epsilon for d < r; finite at contact (@glowinski2001, @wan2006).
    Quadratic {
        /// Small number (m2/N; m3/N planar): the force at contact is r^2 / epsilon.
        epsilon: f64,
    },
    /// Energy -kappa (d - r)^2 ln(d / r) for 0 < d < r: twice continuously differentiable at r,
    /// without bound at contact (@li2020).
    Barrier {
        /// Stiffness kappa (N/m; N/m2 planar).
        stiffness: f64,
    },
}

/// A force between surfaces nearer to each other than a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    kind: LawKind,
    range: f64,
    dissipation: Option<Dissipation>,
}

impl Law {
    /// A law with a range (m).
    ///
    /// # Errors
    /// [`ContactError::Law`] when a number is not positive and finite.
    pub fn new(kind: LawKind, range: f64) -> Result<Self, ContactError> {
        let strength = match kind {
            LawKind::Quadratic { epsilon } => ("epsilon", epsilon),
            LawKind::Barrier { stiffness } => ("stiffness", stiffness),
        };
        for (what, value) in [("range", range), strength] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ContactError::Law { what, value });
            }
        }
        Ok(Self { kind, range, dissipation: None })
    }

    /// The same with forces that take energy.
    ///
    /// # Errors
    /// [`ContactError::Law`] when one of their numbers is not what it can be.
    pub fn with_dissipation(self, dissipation: Dissipation) -> Result<Self, ContactError> {
        Ok(Self { dissipation: Some(dissipation.checked()?), ..self })
    }

    /// What takes energy, if anything.
    #[must_use]
    pub fn dissipation(&self) -> Option<&Dissipation> {
        self.dissipation.as_ref()
    }

    /// Whether contact turns bodies that are round, too.
    #[must_use]
    pub fn turns_round_bodies(&self) -> bool {
        self.dissipation.is_some_and(|dissipation| dissipation.friction > 0.0)
    }

    /// Which law.
    #[must_use]
    pub fn kind(&self) -> LawKind {
        self.kind
    }

    /// Gap at which the force begins (m).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// Repulsive force at a gap (N; N/m planar); infinite for a barrier that is broken through.
    #[must_use]
    pub fn force(&self, gap: f64) -> f64 {
        let short = self.range - gap;
        if short <= 0.0 {
            return 0.0;
        }
        match self.kind {
            LawKind::Quadratic { epsilon } => short * short / epsilon,
            LawKind::Barrier { .. } if gap <= 0.0 => f64::INFINITY,
            LawKind::Barrier { stiffness } => {
                stiffness * (short * short / gap - 2.0 * short * self.logarithm(gap))
            }
        }
    }

    /// Derivative of the force by the gap (N/m; N/m2 planar), not positive.
    #[must_use]
    pub fn slope(&self, gap: f64) -> f64 {
        let short = self.range - gap;
        if short <= 0.0 {
            return 0.0;
        }
        match self.kind {
            LawKind::Quadratic { epsilon } => -2.0 * short / epsilon,
            LawKind::Barrier { .. } if gap <= 0.0 => f64::NEG_INFINITY,
            LawKind::Barrier { stiffness } => {
                let ratio = short / gap;
                stiffness * (2.0 * self.logarithm(gap) - 4.0 * ratio - ratio * ratio)
            }
        }
    }

    /// Energy whose derivative by the gap is minus the force (J; J/m planar).
    #[must_use]
    pub fn energy(&self, gap: f64) -> f64 {
        let short = self.range - gap;
        if short <= 0.0 {
            return 0.0;
        }
        match self.kind {
            LawKind::Quadratic { epsilon } => short.powi(3) / (3.0 * epsilon),
            LawKind::Barrier { .. } if gap <= 0.0 => f64::INFINITY,
            LawKind::Barrier { stiffness } => -stiffness * short * short * self.logarithm(gap),
        }
    }

    /// ln(d / r), without cancellation near the range.
    fn logarithm(&self, gap: f64) -> f64 {
        ((gap - self.range) / self.range).ln_1p()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGE: f64 = 0.03;

    fn laws() -> [Law; 2] {
        [LawKind::Quadratic { epsilon: 1e-6 }, LawKind::Barrier { stiffness: 250.0 }]
            .map(|kind| Law::new(kind, RANGE).unwrap())
    }

    #[test]
    fn force_and_slope_are_derivatives_of_the_energy() {
        for law in laws() {
            for gap in [1e-4f64, 1e-3, 0.004, 0.01, 0.02, 0.029, 0.0299] {
                let h = 1e-4 * gap.min(RANGE - gap);
                let difference = |f: &dyn Fn(f64) -> f64| (f(gap + h) - f(gap - h)) / (2.0 * h);
                let force = -difference(&|d| law.energy(d));
                assert!((force / law.force(gap) - 1.0).abs() < 1e-6, "{law:?} {gap}");
                let slope = difference(&|d| law.force(d));
                assert!((slope / law.slope(gap) - 1.0).abs() < 1e-6, "{law:?} {gap}");
            }
        }
    }

    #[test]
    fn the_force_begins_smoothly_at_the_range_and_never_attracts() {
        for law in laws() {
            for beyond in [0.0, 1e-9, 1.0] {
                let gap = RANGE + beyond;
                assert_eq!((law.force(gap), law.slope(gap), law.energy(gap)), (0.0, 0.0, 0.0));
            }
            let near = RANGE * (1.0 - 1e-6);
            assert!(law.force(near) > 0.0 && law.force(near) < 1e-10 * law.force(0.1 * RANGE));
            // Continuous slope: of the order of the distance from the range
            assert!(law.slope(near).abs() < 1e-5 * law.slope(0.1 * RANGE).abs());
        }
    }

    #[test]
    fn at_contact_the_quadratic_law_is_finite_and_the_barrier_is_not() {
        let [quadratic, barrier] = laws();
        assert!((quadratic.force(0.0) - RANGE * RANGE / 1e-6).abs() < 1e-9);
        assert!(quadratic.force(-0.01) > quadratic.force(0.0));
        assert_eq!(barrier.force(0.0), f64::INFINITY);
        // kappa r^2 / d for small gaps
        assert!((barrier.force(1e-9) / (250.0 * RANGE * RANGE / 1e-9) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn numbers_that_are_not_positive_are_refused() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let kind = LawKind::Barrier { stiffness: 1.0 };
            assert!(matches!(Law::new(kind, value), Err(ContactError::Law { what: "range", .. })));
            let quadratic = Law::new(LawKind::Quadratic { epsilon: value }, 1.0);
            assert!(matches!(quadratic, Err(ContactError::Law { what: "epsilon", .. })));
        }
    }
}
