//! A free elastic strip in Stokes flow relaxes at the rate of plate theory.

use tests::cases::{case, column, run};
use tests::figure;

/// Rate of the slowest mode over bending stiffness by viscosity and length cubed: of B y'''' = -f, where a line of forces f
/// moves the plate by the integral of -ln |s - s'| f / 4 pi mu; by Galerkin's method with sixteen polynomials.
///
/// An infinite sheet of wavenumber k relaxes at k^3 / 4 by the same kernel.
const RATE: f64 = 15.31842;

/// Muscles want a small curvature of a straight strip.
#[test]
fn a_free_strip_relaxes_at_the_rate_of_plate_theory() {
    const STEP: f64 = 0.004;
    let summary = run(&case(&format!(
        r#"
        title = "a strip in a circle"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.disc.radius = 8.0
        boundary.wall = "no-slip"
        mesh = {{ growth = 0.6, gap_layers = 1, moving.layers = 1, size = 3.0, surface = 0.08 }}
        time.unsteady = {{ step = {STEP}, end = 0.1 }}
        [[body]]
        name = "strip"
        shape.fish = {{ length = 1.0, head_width = 0.02, head_end = 0.02, tail_start = 0.96, tail_width = 0.0198, tip_radius = 0.008, corner_radius = 0.02 }}
        center = [0.0, 0.0]
        motion = "free"
        rod = {{ bending = 1.0, elements = 10 }}
        activation.curvature.constant = 0.3
        "#
    )));
    // Faster modes have died out
    let energy = column(&summary, "strip.elastic_energy");
    let last = energy.len() - 1;
    let rate = (energy[last - 10] / energy[last]).ln() / (2.0 * 10.0 * STEP);
    let off = rate / RATE - 1.0;
    figure!(off, "rate");
    // On a finer mesh in a circle of 20, and with half of the thickness, it is off by 1e-3
    assert!(off.abs() < 1e-2, "{rate}");
}
