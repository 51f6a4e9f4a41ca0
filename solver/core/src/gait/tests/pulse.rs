//! Bodies that pulsate: rates are the derivatives of positions, and tables of radii have their areas.

use super::*;

#[test]
fn the_rates_of_pulses_are_the_derivatives_of_positions() {
    let table = vec![[0.0, 1.0], [1.0, 2.0], [2.0, 1.0]];
    let laws = [
        PulseLaw::Sine { amplitude: 0.5, period: 2.0, phase: 0.1 },
        PulseLaw::Table { knots: table, period: Some(3.0) },
    ];
    for law in laws {
        for is_sphere in [false, true] {
            let pulse = Pulse { radius: 0.7, is_sphere, law: law.clone() };
            for time in [0.4, 1.3, 4.7, 8.6] {
                let now = pulse.at(time).unwrap();
                let rate = difference(|t| pulse.at(t).unwrap().position(0.6), time, 1e-2);
                assert!((rate - now.rate(0.6)).norm() < 1e-7);
                let inertia = |t: f64| polar(&pulse.at(t).unwrap());
                assert!((difference(inertia, time, 1e-2) - now.inertia_rate).abs() < 1e-7);
            }
        }
    }
    let pulse = Pulse {
        radius: 1.0,
        is_sphere: false,
        law: PulseLaw::Table { knots: vec![[0.0, 1.0], [1.0, 2.0], [2.0, 1.0]], period: Some(2.0) },
    };
    assert_eq!(pulse.discontinuities(0.5, 4.5), vec![1.0, 2.0, 3.0, 4.0]);
    let area = pulse.at(3.25).unwrap().moments.measure / std::f64::consts::PI;
    assert!((area - 1.75).abs() < 1e-14);
}
