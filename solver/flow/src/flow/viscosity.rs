//! `Viscosity`: a number, or a law of the rate of shear; what it is at a rate, and its derivative.

/// Rates of shear (1/s) between which that of a given stress is looked for.
const RATES: [f64; 2] = [1e-60, 1e60];
/// Rates that matter over that below which a regularised law is Newtonian.
const TYPICAL: f64 = 1e3;
/// Halvings of the logarithm of that interval, to the last bits.
const HALVINGS: usize = 64;

/// Dynamic viscosity of a generalised Newtonian fluid: sigma = -p I + 2 mu(g) D, with the rate of shear
/// g = sqrt(2 D : D) (@bird1987).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viscosity {
    /// The same at all rates (Pa s).
    Newtonian(f64),
    /// infinite + (zero - infinite) (1 + (time g)^2)^((index - 1) / 2) (@carreau1972).
    Carreau(Plateaus),
    /// infinite + (zero - infinite) / (1 + (time g)^(1 - index)) (@cross1965).
    Cross(Plateaus),
    /// yield stress / G + consistency G^(index - 1), with G^2 = g^2 + least_rate^2 (@bercovier1980).
    HerschelBulkley(YieldLaw),
}

/// What a law with a viscosity at small rates and one at large rates depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plateaus {
    /// Viscosity at small rates (Pa s).
    pub zero: f64,
    /// Viscosity at large rates (Pa s).
    pub infinite: f64,
    /// Time (s): the inverse of the rate at which the viscosity begins to change.
    pub time: f64,
    /// Power of the rate in the stress between the two (1).
    pub index: f64,
}

/// What a power law with a yield stress depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldLaw {
    /// Stress below which the fluid hardly flows (Pa), 0 of a power law.
    pub yield_stress: f64,
    /// Factor of the rate's power (Pa s^index).
    pub consistency: f64,
    /// Power of the rate in the stress (1).
    pub index: f64,
    /// Rate (1/s) below which the viscosity no longer changes.
    pub least_rate: f64,
}

/// The viscosity at one rate of shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscosityAtRate {
    /// mu (Pa s).
    pub value: f64,
    /// d mu / d(g^2) (Pa s^3).
    pub slope: f64,
}

impl Viscosity {
    /// Whether it is the same at all rates.
    #[must_use]
    pub fn is_newtonian(&self) -> bool {
        matches!(self, Self::Newtonian(_))
    }

    /// The viscosity where the square of the rate of shear, 2 D : D, is given (1/s2).
    #[must_use]
    #[inline]
    pub fn at(&self, squared_rate: f64) -> ViscosityAtRate {
        match self {
            Self::Newtonian(value) => ViscosityAtRate { value: *value, slope: 0.0 },
            Self::Carreau(law) => {
                let squared_time = law.time * law.time;
                let base = 1.0 + squared_time * squared_rate;
                let power = 0.5 * (law.index - 1.0);
                let part = (law.zero - law.infinite) * base.powf(power);
                let slope = part * power * squared_time / base;
                ViscosityAtRate { value: law.infinite + part, slope }
            }
            Self::Cross(law) => {
                let power = 0.5 * (1.0 - law.index);
                let ratio = (law.time * law.time * squared_rate).powf(power);
                let part = (law.zero - law.infinite) / (1.0 + ratio);
                // At rest the slope has no limit, but its product with the squared rate has: zero
                let is_rest = squared_rate < f64::MIN_POSITIVE.sqrt();
                let relative =
                    if is_rest { 0.0 } else { power * ratio / ((1.0 + ratio) * squared_rate) };
                ViscosityAtRate { value: law.infinite + part, slope: -part * relative }
            }
            Self::HerschelBulkley(law) => {
                let squared = squared_rate + law.least_rate * law.least_rate;
                let power = 0.5 * (law.index - 1.0);
                let viscous = law.consistency * squared.powf(power);
                let plastic = law.yield_stress / squared.sqrt();
                let slope = (power * viscous - 0.5 * plastic) / squared;
                ViscosityAtRate { value: viscous + plastic, slope }
            }
        }
    }

    /// The viscosity (Pa s) at a rate of shear (1/s).
    #[must_use]
    pub fn at_rate(&self, rate: f64) -> f64 {
        self.at(rate * rate).value
    }

    /// The viscosity at rest (Pa s): the largest of a fluid that is thinned by shear.
    #[must_use]
    pub fn zero_shear(&self) -> f64 {
        self.at(0.0).value
    }

    /// The viscosity (Pa s) of a simple shear with this stress (Pa): what a load makes of the fluid.
    #[must_use]
    pub fn at_stress(&self, stress: f64) -> f64 {
        if let Self::Newtonian(value) = self {
            return *value;
        }
        // The stress grows with the rate
        let [mut low, mut high] = RATES.map(f64::ln);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let rate = middle.exp();
            if rate * self.at_rate(rate) < stress {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.at_rate(low.exp())
    }

    /// A law between one that is Newtonian at the rates that matter (`part` 0) and this one (1), for continuation: with an
    /// index nearer to 1, a shorter time or a larger least rate.
    #[must_use]
    pub fn part(&self, part: f64) -> Self {
        let index = |index: f64| 1.0 + part * (index - 1.0);
        match *self {
            Self::Newtonian(_) => *self,
            _ if part >= 1.0 => *self,
            Self::Carreau(law) => Self::Carreau(Plateaus { index: index(law.index), ..law }),
            Self::Cross(law) => Self::Cross(Plateaus { time: part * law.time, ..law }),
            Self::HerschelBulkley(law) => {
                let least_rate = law.least_rate * TYPICAL.powf(1.0 - part);
                Self::HerschelBulkley(YieldLaw { least_rate, ..law })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLATEAUS: Plateaus = Plateaus { zero: 1.0, infinite: 0.1, time: 2.0, index: 0.25 };
    const YIELD: YieldLaw =
        YieldLaw { yield_stress: 0.7, consistency: 1.3, index: 0.4, least_rate: 1e-2 };
    const LAWS: [Viscosity; 4] = [
        Viscosity::Newtonian(0.7),
        Viscosity::Carreau(PLATEAUS),
        Viscosity::Cross(PLATEAUS),
        Viscosity::HerschelBulkley(YIELD),
    ];

    #[test]
    fn slopes_are_derivatives_by_the_squared_rate() {
        for law in LAWS {
            for squared in [1e-3, 0.2, 1.0, 40.0] {
                let step = 1e-5 * squared;
                let [less, more] = [-step, step].map(|change| law.at(squared + change).value);
                let (slope, expected) = (law.at(squared).slope, (more - less) / (2.0 * step));
                assert!(
                    (slope - expected).abs() < 1e-8 * law.at(squared).value / squared,
                    "{law:?}"
                );
            }
            let at_rest = law.at(0.0);
            assert!(at_rest.value.is_finite() && at_rest.slope.is_finite(), "{law:?} {at_rest:?}");
        }
    }

    #[test]
    fn laws_have_their_limits() {
        for law in [Viscosity::Carreau(PLATEAUS), Viscosity::Cross(PLATEAUS)] {
            assert_eq!(law.zero_shear(), 1.0);
            assert!((law.at_rate(1e9) - 0.1).abs() < 1e-6, "{law:?}");
            // Between them the stress grows as the power `index` of the rate
            let thin = |rate: f64| law.at_rate(rate) - 0.1;
            let power = (thin(2e4) / thin(1e4)).log2();
            assert!((power + 0.75).abs() < 2e-3, "{law:?} {power}");
        }
        // sqrt(1 + 4) to the power -0.75 of the difference
        let carreau = Viscosity::Carreau(PLATEAUS).at_rate(1.0);
        assert!((carreau - (0.1 + 0.9 * 5f64.powf(-0.375))).abs() < 1e-15);
        let cross = Viscosity::Cross(PLATEAUS).at_rate(1.0);
        assert!((cross - (0.1 + 0.9 / (1.0 + 2f64.powf(0.75)))).abs() < 1e-15);
        let stress = 3.0 * Viscosity::HerschelBulkley(YIELD).at_rate(3.0);
        assert!((stress - (0.7 + 1.3 * 3f64.powf(0.4))).abs() < 1e-4, "{stress}");
    }

    #[test]
    fn a_part_of_a_law_lies_between_a_newtonian_fluid_and_the_law() {
        for law in LAWS {
            assert_eq!(law.part(1.0), law);
            // With a least rate of 10
            let newtonian = law.part(0.0);
            let [slow, fast] = [0.0, 0.1].map(|rate| newtonian.at_rate(rate));
            assert!((fast / slow - 1.0).abs() < 1e-4, "{law:?} {slow} {fast}");
            let [least, half, most] = [1.0, 0.5, 0.0].map(|part| law.part(part).at_rate(3.0));
            let is_between = least <= half && half <= most || least >= half && half >= most;
            assert!(is_between, "{law:?} {least} {half} {most}");
        }
    }

    #[test]
    fn the_viscosity_of_a_stress_gives_it_back() {
        for law in LAWS {
            for stress in [0.8, 3.0, 50.0] {
                let viscosity = law.at_stress(stress);
                assert!(
                    (law.at_rate(stress / viscosity) / viscosity - 1.0).abs() < 1e-10,
                    "{law:?}"
                );
            }
            assert!(law.at_stress(0.0).is_finite(), "{law:?}");
        }
    }
}
