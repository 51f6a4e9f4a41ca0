//! Probes that ride on a body that moves and turns.

use tests::cases::{case, column, last, run};

/// A disc travels and turns; on its surface the fluid has the velocity of the body, also on a new mesh.
#[test]
fn a_probe_on_a_surface_has_the_velocity_of_the_body_there() {
    let outcome = run(&case(
        r#"
        title = "a disc travels and turns"
        geometry = "planar"
        fluid = { model = "navier-stokes", viscosity = 0.1, density = 1.0 }
        domain.box = { min = [-1.5, -1.0], max = [1.5, 1.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 0.3, surface = 0.06, moving.quality = 0.85 }
        time.unsteady = { step = 0.05, end = 1.5 }
        [[body]]
        name = "disc"
        shape.disc.radius = 0.3
        center = [-0.5, 0.0]
        angle = 0.4
        motion.imposed = { velocity = [0.6, 0.0], angular_velocity = 2.0 }
        [[probe]]
        name = "side"
        point = [0.0, 0.3]
        body = "disc"
        [[probe]]
        name = "across"
        point = [0.3, 0.0]
        minus = [-0.3, 0.0]
        body = "disc"
        [[probe]]
        name = "left-behind"
        point = [-0.5, 0.3]
        "#,
    ));
    assert!(last(&outcome, "flow.remeshes") >= 1.0);
    let at = |name: &str| column(&outcome, name);
    let [x, y] = ["x", "y"].map(|axis| at(&format!("side.velocity.{axis}")));
    let across = at("across.velocity.y");
    for (step, time) in outcome.series.times.iter().enumerate().skip(1) {
        let (sin, cos) = (0.4 + 2.0 * time).sin_cos();
        // The lever of `side` is 0.3 (-sin, cos)
        let wanted = [0.6 - 0.6 * cos, -0.6 * sin, 1.2 * cos];
        let found = [x[step], y[step], across[step]];
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 2e-3, "{time}: {found} {wanted}");
        }
    }
    assert!(last(&outcome, "left-behind.velocity.x").abs() < 0.5, "it stays where it was");
}
