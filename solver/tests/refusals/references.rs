//! Wrong references, statistics and numbers.

use super::{RIGHT, assert_accepted, assert_refused, check, refused, unsteady};

#[test]
fn a_reynolds_number_that_disagrees_is_shown_with_the_derived_one() {
    refused(
        "reynolds = 20.0",
        "reynolds = 100.0",
        &[
            "declared as 100, but the case gives 20 = density * scales.velocity * scales.length / \
             viscosity",
            "wrong.toml:36:12",
            "correct it, write fluid.viscosity = 2.00000e-4, or sweep numbers.reynolds",
        ],
    );
}

#[test]
fn an_unknown_quantity_is_refused_with_the_nearest_one() {
    refused(
        "quantity = \"disc.drag_coefficient\"",
        "quantity = \"disc.drag_coeficient\"",
        &[
            "there is no quantity `disc.drag_coeficient`",
            "wrong.toml:44:12",
            "did you mean `disc.drag_coefficient`?",
            "`disc` has x, y, angle, velocity.x",
        ],
    );
}

#[test]
fn a_reference_has_one_tolerance_and_a_statistic_has_what_it_needs() {
    refused("relative = 0.05\n", "", &["has no tolerance", "wrong.toml:43:", "relative = ..."]);
    refused("relative = 0.05", "relative = 0.05\nabsolute = 1.0", &["both", "wrong.toml:47:12"]);
    refused("relative = 0.05", "relative = 0.05\nstatistic = \"at\"", &["add at = ..."]);
    refused("relative = 0.05", "relative = 0.05\nstatistic = \"strouhal\"", &["no period"]);
}

#[test]
fn a_reference_says_what_kind_of_evidence_it_is() {
    let kind = "kind = \"literature\"";
    refused(kind, "", &["missing key `kind`", "wrong.toml:43:", "measured, literature, exact"]);
    refused(kind, "kind = \"exakt\"", &["did you mean `exact`?", "wrong.toml:47:8"]);
    refused(kind, "kind = \"regression\"", &["add uncertainty = \"... %\"", "add date = "]);
    let regression = "kind = \"regression\"\ndate = \"2026-11-21\"\nuncertainty = \"1 %\"";
    assert_accepted(&check(&RIGHT.replace(kind, regression), &[]));
    refused(
        kind,
        &regression.replace("1 %", "6 %"),
        &["6 % is not within 0 and the tolerance 5 %"],
    );
    refused(kind, &regression.replace("2026-11-21", "21.11.2026"), &["is no date"]);
    refused(kind, &regression.replace("2026-11-21", "2026-13-21"), &["is no date"]);
    refused(kind, &format!("{kind}\ndate = \"2026-11-21\""), &["\"regression\" only"]);
    refused(kind, &format!("{kind}\noutside = \"\""), &["known to be outside is empty"]);
}

#[test]
fn an_uncertainty_can_be_read_in_one_way_only() {
    let relative = "relative = 0.05";
    let absolute = "absolute = 0.05";
    for (lines, accepted) in [(relative, "\"1 %\""), (absolute, "0.01"), (absolute, "\"0.1 %\"")] {
        let text = RIGHT.replace(relative, &format!("{lines}\nuncertainty = {accepted}"));
        assert_accepted(&check(&text, &[]));
    }
    let wrong = |lines: &str, uncertainty: &str, wanted: &[&str]| {
        refused(relative, &format!("{lines}\nuncertainty = {uncertainty}"), wanted);
    };
    // What it was read as before, and what it may be meant as
    wrong(relative, "0.01", &["plain number beside `relative`", "\"1 %\" if it is relative"]);
    wrong(relative, "1", &["plain number beside `relative`", "is in its unit"]);
    wrong(relative, "\"1\"", &["a text such as \"0.5 %\" of it"]);
    wrong(relative, "\"1 percent\"", &["a text such as \"0.5 %\" of it"]);
    wrong(relative, "\"-1 %\"", &["is not within 0"]);
    wrong(absolute, "0.06", &["0.06 is not within 0 and the tolerance 0.05"]);
    wrong(absolute, "\"50 %\"", &["50 % is not within 0 and the tolerance 0.05"]);
}

#[test]
fn a_quantity_by_its_old_name_is_refused_with_the_new_one() {
    for (old, new) in
        [("flow.least_gap", "flow.minimum_gap"), ("fish.spent_power", "fish.expended_power")]
    {
        let quantity = format!("quantity = \"{old}\"");
        refused(
            "quantity = \"disc.drag_coefficient\"",
            &quantity,
            &[&format!("it is called `{new}`")],
        );
    }
}

#[test]
fn statistics_of_moving_bodies_have_what_they_need() {
    let text =
        unsteady("").replace("quantity = \"disc.drag_coefficient\"", "quantity = \"disc.y\"");
    let with = |lines: &str| text.replace("relative = 0.05", &format!("relative = 0.05\n{lines}"));
    for lines in [
        "statistic = \"crossing\"\nlevel = 0.3",
        "statistic = \"when\"\nof = \"disc.x\"\nlevel = 0.3",
        "statistic = \"range\"",
        "statistic = \"max\"\nminus = \"disc.x\"",
        "statistic = \"final\"",
    ] {
        assert_accepted(&check(&with(lines), &[]));
    }
    for (lines, wanted) in [
        ("statistic = \"crossing\"", "the statistic `crossing` needs a value"),
        ("statistic = \"when\"\nof = \"disc.x\"", "the statistic `when` needs a value"),
        ("statistic = \"when\"\nlevel = 0.3", "`when` needs a quantity to wait for"),
        ("statistic = \"when\"\nof = \"disc.z\"\nlevel = 1", "there is no quantity `disc.z`"),
        ("level = 1.0", "`level` goes with the statistics `crossing` and `when` only"),
        ("of = \"disc.x\"", "`of` goes with the statistic `when` only"),
        ("statistic = \"crossing\"\nlevel = 1\nat = 0.5", "`at` goes with the statistic `at` only"),
        ("statistic = \"at\"\nat = -2.0", "the time -2 is not within the run"),
        ("minus = \"disk.y\"", "there is no quantity `disk.y`"),
        ("minus = \"disc.y\"", "`disc.y` less itself is 0"),
        ("statistic = \"morison-drag\"", "is one of forces, not of `disc.y`"),
    ] {
        assert_refused(&check(&with(lines), &[]), &[wanted]);
    }
    refused(
        "relative = 0.05",
        "relative = 0.05\nstatistic = \"crossing\"\nlevel = 1.0",
        &["a steady solution has no course in time", "wrong.toml:47:13"],
    );
}

#[test]
fn morisons_equation_has_a_force_a_diameter_and_a_density() {
    let text = unsteady("")
        .replace("quantity = \"disc.drag_coefficient\"", "quantity = \"disc.force.x\"")
        .replace("relative = 0.05", "relative = 0.05\nstatistic = \"morison-inertia\"");
    assert_accepted(&check(&text, &[]));
    let refused = |from: &str, to: &str, wanted: &str| {
        assert!(text.contains(from), "{from}");
        assert_refused(&check(&text.replace(from, to), &[]), &[wanted]);
    };
    let scales = "[scales]\nlength = 0.1\nvelocity = 0.2\n\n[numbers]\nreynolds = 20.0\n";
    refused(scales, "", "needs a diameter and a density");
    refused("relative = 0.05", "relative = 0.05\nminus = \"disc.force.y\"", "that of one body");
    refused("disc.force.x", "drop.velocity.x", "not of `drop.velocity.x`");
}
