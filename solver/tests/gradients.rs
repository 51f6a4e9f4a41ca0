//! `gradient`: what it prints, checks and refuses.

use serde_json::Value;

use crate::command_line::{alewife, done};

const CASE: &str = r#"
title = "a ball in a shell"
geometry = "axisymmetric"
fluid = { model = "stokes", viscosity = 2.0 }
domain.half-disc = { radius = 5.0 }
boundary = { wall = "no-slip" }
mesh = { size = 1.0, surface = 0.3 }
time.steady = {}
[[body]]
name = "ball"
shape = { sphere = { radius = 1.0 } }
center = [0.0, 0.0]
motion = { imposed = { velocity = [1.0, 0.0] } }
"#;

#[test]
fn derivatives_are_printed_checked_and_told_as_json() {
    let place = tempfile::tempdir().unwrap();
    let at = place.path();
    std::fs::write(at.join("ball.toml"), CASE).unwrap();
    let keys = "fluid.viscosity,body.0.shape.sphere.radius";
    let asked = ["gradient", "ball.toml", "--of", "ball.force.x,ball.power", "--by", keys];
    let said = done(at, &[&asked[..], &["--check"]].concat());
    assert!(said.contains("ball.force.x = -") && said.contains("difference"), "{said}");
    let said = done(at, &[&asked[..], &["--json", "--set", "fluid.viscosity=4.0"]].concat());
    let json: Value = serde_json::from_str(&said).unwrap();
    let power = &json["quantities"][1];
    // Proportional to the viscosity
    let [value, by] =
        [&power["value"], &power["by"][0]["derivative"]].map(|of| of.as_f64().unwrap());
    assert!((value / by / 4.0 - 1.0).abs() < 1e-8, "{said}");
    assert!(power["by"][0]["difference"].is_null());
}

#[test]
fn what_has_no_gradient_is_told_with_what_has_one() {
    let place = tempfile::tempdir().unwrap();
    let at = place.path();
    std::fs::write(at.join("ball.toml"), CASE).unwrap();
    let refused = |of: &str, by: &str, wanted: &str| {
        let output = alewife(at, &["gradient", "ball.toml", "--of", of, "--by", by]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(65), "{said}");
        assert!(said.contains(wanted), "{said}");
    };
    refused("ball.forcex", "fluid.viscosity", "do you mean `ball.force.x`?");
    refused("flow.dissipation", "fluid.viscosity", "is a quantity of the case, and its gradient");
    refused("ball.force.x", "fluid.viscosty", "do you mean `fluid.viscosity`?");
    refused("ball.force.x", "mesh.size", "ball.toml:7:");
}
