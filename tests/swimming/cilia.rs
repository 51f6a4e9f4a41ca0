//! Two cilia whose muscles wait for commands.

use alewife_core::run::Session;
use tests::cases::case;

/// Two cilia on the floor of a box, whose muscles wait for commands.
fn pair() -> String {
    let cilium = |name: &str, x: f64, start: f64| {
        format!(
            r#"
            [[body]]
            name = "{name}"
            shape.fish = {{ length = 1.0, head_width = 0.04, head_end = 0.04, tail_start = 0.92, tail_width = 0.038, tip_radius = 0.016, corner_radius = 0.04 }}
            center = [{x}, 0.56]
            angle = "-90 deg"
            motion = "free"
            rod = {{ bending = 1.0, elements = 8 }}
            attached.hold = "clamped"
            activation.curvature.command = {{ start = {start}, limits = [-2.0, 2.0], filter = 0.02 }}
            "#
        )
    };
    format!(
        r#"
        title = "two cilia"
        geometry = "planar"
        fluid = {{ model = "stokes", viscosity = 1.0 }}
        domain.box = {{ min = [-3.0, 0.0], max = [3.0, 3.0] }}
        boundary = {{ left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }}
        mesh = {{ growth = 0.5, gap_layers = 1, moving.layers = 1, size = 0.8, surface = 0.1 }}
        time.unsteady = {{ step = 0.01, end = 10.0 }}
        {} {}
        "#,
        cilium("one", -0.5, 2.0),
        cilium("two", 0.5, 2.0),
    )
}

/// The first one is told to bend the other way, and does.
#[test]
fn commands_reach_the_muscles_of_rods() {
    let mut session: Session<2> = Session::open(&case(&pair()), Vec::new()).expect("it opens");
    session.command("one.activation", -1.0).expect("it is a command");
    session.advance_to(0.05).expect("it goes on");
    let bent = session.observe(&["one.curvature", "two.curvature"]).expect("they are rods");
    assert!(bent[1] > 0.5 && bent[0] < 0.5 * bent[1], "{bent:?}");
    assert!(session.command("one.angle", 0.1).is_err(), "its foot is clamped");
}
