//! A waving sheet drives the fluid above it.

use tests::cases::{case, last, run};
use tests::figure;

/// One wavelength of 2 pi under a box of twice that height, amplitude over wavelength 0.2 / 2 pi;
/// the speed far above over that of the wave.
fn speed(frequency: f64, extensible: bool, top: f64, step: f64) -> f64 {
    let (end, period) = (4.0 * step, 1.0 / frequency);
    let text = format!(
        r#"
        title = "a waving sheet"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [0.0, 0.0], max = [6.283185307179586, {top}] }}
        mesh = {{ size = 2.0, sides.bottom = 0.3, growth = 0.2 }}
        time.unsteady = {{ step = {step}, end = {end} }}
        [boundary]
        left.periodic = "right"
        top = "symmetry"
        [boundary.bottom.waving-sheet]
        amplitude = 0.2
        wavelength = 6.283185307179586
        period = {period}
        extensible = {extensible}
        [[probe]]
        name = "far"
        point = [3.0, {top}]
        "#
    );
    let outcome = run(&case(&text));
    assert!(last(&outcome, "flow.mass_defect").abs() < 1e-9);
    last(&outcome, "far.velocity.x") / (frequency * std::f64::consts::TAU)
}

/// Against Taylor's law, (bk)^2/2 (1 - 19/16 (bk)^2) and, where it is extensible, (bk)^2/2 (1 -
/// (bk)^2), with terms of the next order from a collocation in Fourier modes. The fluid goes with the
/// wave, whichever way and however fast that runs.
#[test]
fn the_fluid_far_above_a_sheet_has_the_speed_of_taylors_law() {
    for (extensible, exact) in [(false, 0.019_089_31), (true, 0.019_235_69)] {
        for frequency in [0.2, -3.0] {
            let found = speed(frequency, extensible, 15.0, 0.1 / f64::abs(frequency));
            figure!(found / exact - 1.0, "extensible {extensible}, frequency {frequency}");
            assert!((found / exact - 1.0).abs() < 2e-3, "{found} for {exact}");
        }
    }
}
