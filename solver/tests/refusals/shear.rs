//! Wrong laws of a viscosity that depends on the rate of shear.

use super::{assert_accepted, assert_refused, check, edited, refused, unsteady};

fn wrong(law: &str, said: &[&str]) {
    refused("viscosity = 0.001", &format!("viscosity = {law}"), said);
}

fn carreau(numbers: &str) -> String {
    format!("{{ carreau = {{ {numbers} }} }}")
}

#[test]
fn numbers_of_a_law_have_their_ranges() {
    for (numbers, said) in [
        (
            "zero = 0.001, infinite = 0.0001, time = 1.0, index = 0.0",
            "index` is 0, but must be positive",
        ),
        ("zero = 0.001, infinite = 0.0001, time = 1.0, index = -0.5", "index` is -0.5"),
        (
            "zero = 0.001, infinite = 0.0001, time = -1.0, index = 0.5",
            "time` is -1, but must not be negative",
        ),
        ("zero = 0.0, infinite = 0.0, time = 1.0, index = 0.5", "zero` is 0, but must be positive"),
        ("zero = 0.001, infinite = -1.0, time = 1.0, index = 0.5", "infinite` is -1"),
        ("zero = nan, time = 1.0, index = 0.5", "not a finite number"),
    ] {
        wrong(&carreau(numbers), &[said, "fluid.viscosity.carreau.", "wrong.toml:6:"]);
    }
    let yields = "{ herschel-bulkley = { yield_stress = -1.0, consistency = 1.0, index = 0.5, \
                  regularised = 0.0 } }";
    wrong(
        yields,
        &["yield_stress` is -1", "regularised` is 0, but must be positive", "wrong.toml:6:"],
    );
}

#[test]
fn the_viscosity_at_rest_is_the_larger_one() {
    wrong(
        &carreau("zero = 0.001, infinite = 0.002, time = 1.0, index = 0.5"),
        &["infinite` is 0.002", "zero = 0.001", "wrong.toml:6:", "exchange them"],
    );
    wrong(
        "{ cross = { zero = 0.001, time = 1.0, index = 1.0 } }",
        &["`cross`", "below 1", "wrong.toml:6:", "take `carreau`"],
    );
}

#[test]
fn one_law_is_wanted_with_all_its_keys() {
    let full = "{ zero = 0.001, time = 1.0, index = 0.5 }";
    for (law, said) in [
        ("{}", "exactly one law"),
        (&format!("{{ careau = {full} }}")[..], "`carreau`?"),
        (&format!("{{ carreau = {full}, cross = {full} }}")[..], "exactly one law"),
        ("{ carreau = { zero = 0.001, index = 0.5 } }", "missing key `time`"),
        ("{ carreau = { zero = 0.001, time = 1.0, n = 0.5 } }", "unknown key `n`"),
        ("{ power-law = { consistency = 0.001, index = 0.5 } }", "missing key `regularised`"),
        ("{ carreau = 1.0 }", "fluid.viscosity.carreau"),
        ("[0.001]", "a number, or a law"),
        ("\"thick\"", "where a number is wanted"),
    ] {
        wrong(law, &[said, "wrong.toml:"]);
    }
}

#[test]
fn a_fluid_that_shear_thickens_takes_no_contact() {
    let law = "{ power-law = { consistency = 0.001, index = 1.5, regularised = 1e-3 } }";
    let text = unsteady("").replace("viscosity = 0.001", &format!("viscosity = {law}"))
        + "[contact.barrier]\nrange = 0.01\nstiffness = 1.0\n";
    assert_refused(&check(&text, &[]), &["index` is 1.5", "4/3", "wrong.toml:6:"]);
}

#[test]
fn explicit_steps_take_no_contact_in_such_a_fluid() {
    let text = r#"
        title = "two discs"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = { carreau = { zero = 1.0, time = 1.0, index = 0.5 } } }
        domain.disc.radius = 4.0
        boundary.wall = "no-slip"
        mesh = { size = 0.5 }
        contact.barrier = { range = 0.1, stiffness = 1.0 }
        time.unsteady = { step = 0.1, end = 1.0, scheme = "rk3" }
        [[body]]
        name = "a"
        shape.disc.radius = 0.5
        center = [0.0, 0.0]
        motion = "free"
        gait.squirmer.modes = [1.0]
    "#;
    let said = check(text, &[]);
    let told = format!("{}{}", said.stdout, said.stderr);
    for part in ["`rk3` cannot be used", "rate of shear", "leave [contact] out"] {
        assert!(told.contains(part), "{told}");
    }
    let without = check(&text.replace("scheme = \"rk3\"", "scheme = \"bdf2\""), &[]);
    assert!(!format!("{}{}", without.stdout, without.stderr).contains("rk3"));
}

#[test]
fn a_right_law_is_accepted() {
    let law = carreau("zero = 0.001, infinite = 0.0001, time = 1.0, index = 0.5");
    assert_accepted(&check(&edited("viscosity = 0.001", &format!("viscosity = {law}")), &[]));
}
