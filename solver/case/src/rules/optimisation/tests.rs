//! What is said of a search of a steady flow that cannot be made.

use crate::{Case, Severity, check, check_starts};

const CASE: &str = r#"title = "spheroid"
geometry = "axisymmetric"
fluid = { model = "stokes", viscosity = 1.0 }
domain.half-disc = { radius = 50.0 }
boundary = { wall = "no-slip" }
mesh = { size = 10.0, surface = 0.2, growth = 0.2 }
time.steady = {}
[[body]]
name = "spheroid"
shape = { spheroid = { semi_axes = [1.2, 1.0] } }
center = [0.0, 0.0]
motion = { imposed = { velocity = [1.0, 0.0] } }
[optimisation.objective]
sum = [{ quantity = "spheroid.force.x" }]
[[optimisation.parameter]]
name = "aspect"
keys = ["body.0.shape.spheroid.semi_axes.0", "body.0.shape.spheroid.semi_axes.1"]
values = ["aspect^(2/3)", "aspect^(-1/3)"]
start = 1.2
bounds = [0.5, 4.0]
[optimisation.search]
evaluations = 20
[[optimisation.reference]]
quantity = "aspect"
value = 1.952
relative = 0.01
kind = "exact"
source = "Oberbeck's drag"
"#;

/// All that is said of the case with a text replaced.
fn said(from: &str, to: &str) -> String {
    assert!(CASE.contains(from), "{from}");
    let file = Case::parse("case.toml", &CASE.replace(from, to), &[]).unwrap();
    check(&file).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[track_caller]
fn refuses(from: &str, to: &str, parts: &[&str]) {
    let found = said(from, to);
    assert!(parts.iter().all(|part| found.contains(part)), "{found}");
}

#[test]
fn a_search_that_can_be_made_is_not_refused() {
    assert_eq!(said("spheroid.force.x", "spheroid.force.x"), "");
    let expression = "expression = { value = \"-f / u^2\", quantities = { f = \"spheroid.force.x\", u = \
                      \"spheroid.velocity.x\" } }";
    assert_eq!(said("sum = [{ quantity = \"spheroid.force.x\" }]", expression), "");
    let aspect = CASE.split("name = \"aspect\"\n").nth(1).unwrap().split("[optimisation.se").next();
    let viscosity = "keys = [\"fluid.viscosity\"]\nbounds = [0.5, 4.0]\n";
    assert_eq!(said(aspect.unwrap(), viscosity), "");
}

#[test]
fn keys_are_those_of_numbers_that_are_solved_and_can_change() {
    refuses("semi_axes.1\"]", "semi_axis.1\"]", &["did you mean", "semi_axes.1", "case.toml:17"]);
    refuses("body.0.shape.spheroid.semi_axes.1\"]", "mesh.size\"]", &["no derivative", ":17"]);
    refuses("semi_axes.1\"]", "semi_axes.0\"]", &["sought twice", ":17"]);
    refuses("semi_axes.1\"]", "semi_axes\"]", &["different lengths", ":17"]);
}

#[test]
fn expressions_bounds_and_starts_are_checked() {
    refuses("aspect^(2/3)", "aspct^(2/3)", &["`aspct`", "aspect", ":18"]);
    refuses("aspect^(2/3)", "aspect*x", &["a place or a time", ":18"]);
    refuses(", \"aspect^(-1/3)\"]", "]", &["2 keys and 1 values", ":18"]);
    refuses("start = 1.2\n", "", &["nothing says where", "start"]);
    refuses("[0.5, 4.0]", "[4.0, 0.5]", &["smaller number first", ":20"]);
    refuses("[0.5, 4.0]", "[0.0, 4.0]", &["no logarithm", "scale", ":20"]);
    refuses("name = \"aspect\"", "name = \"a ratio\"", &["cannot be called", ":16"]);
    refuses("evaluations = 20", "evaluations = 0", &["1 or more", ":22"]);
    refuses("evaluations = 20", "decrease = 0.0", &["positive", ":22"]);
}

#[test]
fn numbers_beyond_their_bounds_are_no_start_of_a_search_and_do_not_keep_a_run() {
    let starts = |from: &str, to: &str| {
        let file = Case::parse("case.toml", &CASE.replace(from, to), &[]).unwrap();
        check_starts(&file).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(starts("start = 1.2", "start = 4.0"), "");
    let found = starts("start = 1.2", "start = 5.0");
    assert!(found.contains("not between its bounds") && found.contains("case.toml:20"), "{found}");
    assert_eq!(said("start = 1.2", "start = 5.0"), "");
    // So are coefficients of a calibration
    let setting = "reduced.coefficients.added_mass=5.0".to_owned();
    let file = Case::read("eel-calibration", &[setting]).unwrap();
    assert!(check(&file).iter().all(|one| one.severity == Severity::Warning));
    let found = check_starts(&file);
    assert_eq!(found[0].key, "calibration.bounds.added_mass");
    assert!(found[0].message.contains("starts at 5"), "{}", found[0].message);
}

#[test]
fn quantities_are_those_with_a_gradient_of_a_steady_flow() {
    refuses("\"spheroid.force.x\"", "\"spheroid.force.X\"", &["no quantity", ":14"]);
    refuses(
        "\"spheroid.force.x\"",
        "\"flow.dissipation\"",
        &["not known", "spheroid.power", ":14"],
    );
    refuses("time.steady = {}", "time.unsteady = { step = 0.1, end = 1.0 }", &["[time.steady]"]);
    let sum = "sum = [{ quantity = \"spheroid.force.x\" }]";
    let expression = |value: &str, name: &str| {
        format!(
            "expression = {{ value = \"{value}\", quantities = {{ {name} = \"spheroid.force.x\" }} }}"
        )
    };
    refuses(sum, &expression("-g", "f"), &["`g`", ":14"]);
    refuses(sum, &expression("-f*t", "f"), &["a place or a time", ":14"]);
    // One error of a name that nothing can have, and it is not offered
    for name in ["x", "y", "t", "my-force"] {
        let found = said(sum, &expression(&format!("-{name}"), name));
        assert!(found.contains(&format!("cannot be called `{name}`")), "{found}");
        assert_eq!(found.matches("error: ").count(), 1, "{found}");
    }
    refuses(sum, &expression("-f*t", "f"), &["write an expression of f"]);
    refuses(sum, "sum = []", &["sum"]);
}

#[test]
fn a_cycle_that_has_not_ended_has_no_average() {
    let said = |end: &str| {
        let settings = [format!("time.unsteady.end={end}")];
        let file = Case::read("three-sphere-optimum", &settings).unwrap();
        check(&file).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert!(!said("1.0").contains("error: "), "{}", said("1.0"));
    let found = said("0.5");
    let wanted =
        "`swimmer.cycle.cost_of_transport` has no value: a cycle takes 1, and the run ends at 0.5";
    assert!(found.contains(wanted) && found.contains("end = 1 or more"), "{found}");
}

#[test]
fn references_are_those_of_an_optimum() {
    refuses("quantity = \"aspect\"", "quantity = \"aspekt\"", &["did you mean `aspect`", ":24"]);
    refuses("relative = 0.01\n", "", &["no single tolerance"]);
    refuses("relative = 0.01", "relative = 0.01\nabsolute = 1.0", &["no single tolerance"]);
    refuses("Oberbeck's drag", "", &["where its value is from"]);
}

/// The curve of a turned profile is known on the axis.
#[test]
fn the_volume_of_a_turned_profile_is_held() {
    let case = CASE
        .replace("spheroid = { semi_axes = [1.2, 1.0] }", "revolved.profile = [[-1.2, 0.0], [0.0, 1.0], [1.2, 0.0]]")
        .replace(
            "keys = [\"body.0.shape.spheroid.semi_axes.0\", \"body.0.shape.spheroid.semi_axes.1\"]\nvalues = \
             [\"aspect^(2/3)\", \"aspect^(-1/3)\"]",
            "keys = [\"body.0.shape.revolved.profile.1.1\"]",
        )
        .replace(
            "[optimisation.search]",
            "[[optimisation.constraint]]\nvolume = \"spheroid\"\nequals = 4.2\n[optimisation.search]",
        );
    let file = Case::parse("case.toml", &case, &[]).unwrap();
    let found: Vec<String> = check(&file).iter().map(ToString::to_string).collect();
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn what_is_held_is_a_quantity_or_a_volume_at_one_value() {
    let with = |lines: &str| {
        let table = "[optimisation.search]";
        said(table, &format!("[[optimisation.constraint]]\n{lines}\n{table}"))
    };
    assert_eq!(with("volume = \"spheroid\"\nequals = 4.2"), "");
    assert_eq!(with("quantity = \"spheroid.power\"\nat_most = 4.2\ntolerance = 1e-3"), "");
    for (lines, parts) in [
        ("equals = 4.2", ["holds nothing", "volume = \"BODY\""]),
        (
            "volume = \"spheroid\"\nquantity = \"spheroid.power\"\nequals = 1.0",
            ["two things", "one of"],
        ),
        ("volume = \"speroid\"\nequals = 4.2", ["no body `speroid`", "did you mean `spheroid`"]),
        ("quantity = \"spheroid.x\"\nequals = 4.2", ["gradient of `spheroid.x`", "spheroid.power"]),
        ("volume = \"spheroid\"", ["has 0 of three values", "at_most"]),
        ("volume = \"spheroid\"\nequals = 1.0\nat_least = 2.0", ["has 2 of three", "case.toml:"]),
        ("volume = \"spheroid\"\nequals = 0.0", ["held at 0", "above 0"]),
        ("volume = \"spheroid\"\nequals = 1.0\ntolerance = 0.0", ["tolerance", "case.toml:"]),
    ] {
        let found = with(lines);
        assert!(parts.iter().all(|part| found.contains(part)), "{lines}: {found}");
    }
}
