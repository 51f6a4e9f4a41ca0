//! Order in time of flows whose viscosity depends on the rate of shear, with extrapolated strain and by Newton's method.

use tests::cases::{PERIODIC_CHANNEL, case, last, run};
use tests::figure;

use super::CARREAU;

/// A channel in which the fluid is driven from rest, at a time when its viscosity still changes.
fn started(step: f64, convection: &str) -> f64 {
    let text = format!(
        r#"
        title = "a channel from rest"
        geometry = "planar"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = {CARREAU} }}
        flow = {{ pressure_gradient = [-3.0, 0.0], factor.smooth-ramp.duration = 0.4 }}
        domain.box = {{ min = [0.0, -1.0], max = [0.4, 1.0] }}
        {PERIODIC_CHANNEL}
        mesh = {{ size = 0.2 }}
        time.unsteady = {{ step = {step}, end = 0.8, convection = "{convection}" }}
        probe = [{{ name = "side", point = [0.2, 0.6] }}]
        "#
    );
    last(&run(&case(&text)), "side.velocity.x")
}

#[test]
fn steps_are_right_to_second_order() {
    let mut limits = Vec::new();
    for convection in ["extrapolated", "newton"] {
        let [coarse, middle, fine] = [0.1, 0.05, 0.025].map(|step| started(step, convection));
        let order = ((coarse - middle) / (middle - fine)).abs().log2();
        println!("{convection}: {coarse} {middle} {fine}, order {order}");
        assert!((1.7..2.6).contains(&order), "{convection}: {order}");
        figure!(order, "order in time, {convection}");
        limits.push(fine + (fine - middle) / 3.0);
    }
    assert!((limits[0] / limits[1] - 1.0).abs() < 2e-4, "{limits:?}");
}
