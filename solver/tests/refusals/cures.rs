//! Messages of mistakes in physics and in writing: they name the cure that fits.

use super::{assert_accepted, assert_refused, check};

/// Two discs in a box, with what is asked for in the first one.
fn discs(head: &str, first: &str) -> String {
    format!(
        r#"title = "two discs"
geometry = "planar"
{head}
mesh = {{ size = 1.5, surface = 0.3 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = "one"
shape.disc.radius = 0.5
center = [-2.0, 0.0]
motion = "free"
{first}
[[body]]
name = "two"
shape.disc.radius = 0.5
center = [2.0, 0.0]
motion = "free"
"#
    )
}

const BOX: &str = r#"fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-10.0, -5.0], max = [10.0, 5.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }"#;

const PERIODIC: &str = r#"fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-10.0, -5.0], max = [10.0, 5.0] }
boundary = { left.periodic = "right", bottom.periodic = "top" }"#;

#[test]
fn loads_that_nothing_balances_are_refused_with_their_sum() {
    let pulled = check(&discs(PERIODIC, "force = [1.5, 0.0]"), &[]);
    assert_refused(
        &pulled,
        &["the loads on the bodies sum up to 1.5 along x", "force = [1.5, 0.0]"],
    );
    let balanced = discs(PERIODIC, "force = [1.5, 0.0]") + "force = [-1.5, 0.0]\n";
    assert_accepted(&check(&balanced, &[]));
    assert_accepted(&check(&discs(BOX, "force = [1.5, 0.0]"), &[]));
}

#[test]
fn what_can_only_be_an_oversight_is_warned_of() {
    let weight = BOX.replace("1.0 }\n", "1.0, gravity = [0.0, -1.0] }\n");
    for (text, told, is_told) in [
        (discs(BOX, ""), "nothing drives this case", true),
        (discs(BOX, "force = [0.1, 0.0]"), "nothing drives this case", false),
        (discs(BOX, "torque = 0.1"), "nothing drives this case", false),
        (discs(&weight, "density = 2.0"), "nothing is buoyant", true),
        (
            discs(&weight.replace("1.0, g", "1.0, density = 1.0, g"), "density = 2.0"),
            "buoyant",
            false,
        ),
    ] {
        let said = check(&text, &[]);
        assert_accepted(&said);
        assert_eq!(said.stderr.contains(told), is_told, "{told}: {}", said.stderr);
    }
    // What follows from degrees comes behind them
    let said = check(&discs(BOX, "angle = -60\nsize = 0.6"), &[]).stderr;
    let [angle, edges] = ["angles are in radians", "edges long"].map(|told| said.find(told));
    assert!(angle.is_some() && angle < edges, "{said}");
}

#[test]
fn a_body_larger_than_the_period_touches_its_own_image() {
    let narrow =
        PERIODIC.replace("[-10.0, -5.0], max = [10.0, 5.0]", "[-2.4, -5.0], max = [2.4, 5.0]");
    let text = discs(&narrow, "").replacen("radius = 0.5", "radius = 2.5", 1);
    let said = check(&text.replace("center = [2.0, 0.0]", "center = [2.0, 3.5]"), &[]);
    assert_refused(&said, &["\"one\" touches or overlaps its own image across a periodic side"]);
}

#[test]
fn numbers_written_otherwise_are_told_how() {
    let text = discs(BOX, "");
    for (setting, told) in [
        ("body.0.shape.disc.radius=0,6", "write it with a decimal point: 0.6"),
        ("fluid.viscosity=1:10:3", "ranges are for `alewife sweep run`"),
        ("fluid.viscosity=1 Pas", "without quotes and without its unit"),
        ("mesh.curved='yes'", "write true or false, without quotes"),
        ("body.0.center=[[1.0], 0.0]", "write one number there"),
    ] {
        assert_refused(&check(&text, &["--set", setting]), &[told]);
    }
    let arithmetic = check(&text.replace("viscosity = 1.0", "viscosity = 2*0.5"), &[]);
    assert_refused(&arithmetic, &["`2*0.5` is not evaluated: write the number itself"]);
}
