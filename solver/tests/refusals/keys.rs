//! Keys in a wrong place, under another name, with brackets too many or too few, or missing.

use super::{assert_refused, check, edited, refused};

#[test]
fn headers_have_two_brackets_where_there_may_be_several() {
    for key in ["body", "probe", "reference", "variant"] {
        let double = format!("[[{key}]]");
        let wanted = format!("there may be several: write {double}, in double brackets");
        let message = format!("`{key}` is a table where an array is wanted");
        refused(&double, &format!("[{key}]"), &[&message, &wanted, "--> wrong.toml:"]);
    }
    refused(
        "[mesh]",
        "[mesh.box]\nmin = [0.0, 0.0]\n[mesh]",
        &["write [[mesh.box]], in double brackets"],
    );
    refused(
        "[fluid]",
        "[[fluid]]",
        &["`fluid` is an array where a table is wanted", "write [fluid], in single brackets"],
    );
}

#[test]
fn a_key_of_the_top_level_below_a_header_is_sent_there() {
    let text = edited(
        "motion = \"held\"",
        "motion = \"held\"\noutput.fields = { time = 0.1 }\nquick = true\njoint = []",
    );
    let said = check(&text, &[]);
    let before = "is a key of the top level: put it before the first [header]";
    assert_refused(
        &said,
        &[
            "unknown key `output` in `body.0`",
            &format!("`output` {before}, or write it under a header of its own, [output]"),
            "wrong.toml:24:1",
            &format!("`quick` {before}\n"),
            &format!("`joint` {before}, or write it under a header of its own, [[joint]]"),
        ],
    );
    assert!(!said.stderr.contains("missing"), "{}", said.stderr);
    // Between braces it is a slip of another kind
    let inline = edited("radius = 0.05", "radius = 0.05, mesh = 1.0");
    let said = check(&inline, &[]);
    assert!(!said.stderr.contains("top level"), "{}", said.stderr);
}

#[test]
fn words_of_formulae_lead_to_those_of_cases() {
    for (from, to, wanted) in [
        ("viscosity =", "mu =", "write `viscosity = ...`, the dynamic viscosity"),
        (
            "viscosity =",
            "nu =",
            "write `viscosity = ...`, the kinematic viscosity times the density",
        ),
        ("density =", "rho =", "write `density = ...`"),
        ("size = 0.1", "h = 0.1", "write `size = ...`, the length of an edge"),
        ("radius = 0.05", "diameter = 0.1", "write `radius = ...`, half of the diameter"),
        ("center =", "position =", "write `center = ...`"),
        ("{ disc = {", "{ circle = {", "did you mean `disc`? planar shapes: disc, ellipse, spline"),
        (
            "\"do-nothing\"",
            "\"outflow\"",
            "did you mean `do-nothing` (fluid leaves undisturbed)? accepted: no-slip",
        ),
        ("{ parabolic = {", "{ inlet = {", "did you mean `parabolic`"),
        ("motion = \"held\"", "motion = \"fixed\"", "did you mean `held`?"),
        ("left = {", "inlet = {", "did you mean `left`? accepted: left, right"),
    ] {
        refused(from, to, &[wanted]);
    }
    let unsteady = "[time.unsteady]\ndt = 0.1\nend = 1.0";
    refused(
        "[time.steady]",
        unsteady,
        &["unknown key `dt`", "write `step = ...`, the time of a step"],
    );
    let text =
        edited("motion = \"held\"", "motion = \"held\"\ngait.squirmer = { B1 = 1.0, beta = 2.0 }");
    let said = check(&text, &[]);
    let modes = "write `modes = ...`, [B1, B2, ...], where beta is B2 / B1";
    assert_refused(&said, &["unknown key `B1`", "unknown key `beta`", modes]);
    assert!(!said.stderr.contains("array is wanted"), "{}", said.stderr);
}

#[test]
fn what_a_missing_key_may_hold_is_told() {
    refused(
        "model = \"navier-stokes\"",
        "",
        &["missing key `model`", "one of: stokes, unsteady-stokes, navier-stokes"],
    );
    refused(
        "viscosity = 0.001",
        "",
        &["missing key `viscosity`", "`viscosity = ...` there, a number"],
    );
    refused("[time.steady]", "[time.unsteady]\nstep = 0.1", &["`end = ...` there, a number"]);
    refused(
        "shape = { disc = { radius = 0.05 } }",
        "",
        &[
            "`shape = ...` there, one of: disc, ellipse, spline, polygon, box, side, fish, flagellate\n",
        ],
    );
}
