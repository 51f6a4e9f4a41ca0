//! Gauss-Legendre rule with eight points on [0, 1], for arc lengths and boundary integrals.

/// Abscissae in (0, 1).
const ABSCISSAE: [f64; 8] = [
    0.019_855_071_751_231_856,
    0.101_666_761_293_186_64,
    0.237_233_795_041_835_5,
    0.408_282_678_752_175_1,
    0.591_717_321_247_825,
    0.762_766_204_958_164_5,
    0.898_333_238_706_813_4,
    0.980_144_928_248_768_1,
];

/// Weights; they add to one.
const WEIGHTS: [f64; 8] = [
    0.050_614_268_145_188_13,
    0.111_190_517_226_687_24,
    0.156_853_322_938_943_64,
    0.181_341_891_689_181,
    0.181_341_891_689_181,
    0.156_853_322_938_943_64,
    0.111_190_517_226_687_24,
    0.050_614_268_145_188_13,
];

/// Integral of `f` over [a, b]; exact for polynomials of degree 15.
///
/// # Source
/// @abramowitz1964, table 25.4.
pub fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sum: f64 =
        ABSCISSAE.iter().zip(WEIGHTS).map(|(x, weight)| weight * f(a + (b - a) * x)).sum();
    (b - a) * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_to_degree_fifteen() {
        for degree in 0..16 {
            let value = integrate(0.0, 1.0, |x| x.powi(degree));
            assert!((value * f64::from(degree + 1) - 1.0).abs() < 4e-15, "degree {degree}");
        }
    }
}
