//! Wrong cases are refused with exit code 65, the place in the file, and a remedy.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::path::Path;
use std::process::Command;

/// A case with nothing wrong in it: a disc held in a channel. Lines are counted from 1.
const RIGHT: &str = r#"title = "A disc in a channel"
geometry = "planar"

[fluid]
model = "navier-stokes"
viscosity = 0.001
density = 1.0

[domain.channel]
length = 2.2
height = 0.41

[boundary]
left = { parabolic = { peak = 0.3 } }
right = "do-nothing"
bottom = "no-slip"
top = "no-slip"

[[body]]
name = "disc"
shape = { disc = { radius = 0.05 } }
center = [0.2, 0.2]
motion = "held"

[mesh]
size = 0.1
surface = 0.02

[time.steady]

[scales]
length = 0.1
velocity = 0.2

[numbers]
reynolds = 20.0

[[probe]]
name = "drop"
point = [0.15, 0.2]
minus = [0.25, 0.2]

[[reference]]
quantity = "disc.drag_coefficient"
value = 5.579535
relative = 0.05
source = "a published benchmark"

[[variant]]
name = "slow"
set = { "boundary.left.parabolic.peak" = 0.03, "numbers.reynolds" = 2.0, "scales.velocity" = 0.02 }
"#;

struct Said {
    code: i32,
    stdout: String,
    stderr: String,
}

fn alewife(directory: &Path, arguments: &[&str]) -> Said {
    let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(arguments)
        .current_dir(directory)
        .env_remove("RUST_BACKTRACE")
        .output()
        .unwrap();
    Said {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Checks a text as `wrong.toml`, with more arguments behind it.
fn check(text: &str, arguments: &[&str]) -> Said {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("wrong.toml"), text).unwrap();
    let all: Vec<&str> =
        ["check", "--no-mesh", "wrong.toml"].iter().chain(arguments).copied().collect();
    alewife(directory.path(), &all)
}

/// The right case with one stretch of it replaced.
fn edited(from: &str, to: &str) -> String {
    assert!(RIGHT.contains(from), "`{from}` is not in the right case");
    RIGHT.replacen(from, to, 1)
}

fn without_variant(text: &str) -> &str {
    text.split("[[variant]]").next().unwrap()
}

#[track_caller]
fn assert_accepted(said: &Said) {
    assert_eq!(said.code, 0, "{}{}", said.stdout, said.stderr);
}

#[track_caller]
fn assert_refused(said: &Said, wanted: &[&str]) {
    assert_eq!(said.code, 65, "{}{}", said.stdout, said.stderr);
    for text in wanted {
        assert!(said.stderr.contains(text), "`{text}` is not in:\n{}", said.stderr);
    }
}

#[track_caller]
fn refused(from: &str, to: &str, wanted: &[&str]) {
    assert_refused(&check(&edited(from, to), &[]), wanted);
}

#[test]
fn a_right_case_is_accepted_with_its_variants() {
    let said = check(RIGHT, &[]);
    assert_accepted(&said);
    assert_eq!(said.stderr, "");
    assert!(said.stdout.contains("Reynolds number"), "{}", said.stdout);
    assert!(said.stdout.contains("no solve is made"), "{}", said.stdout);
}

#[test]
fn a_misspelt_key_is_named_with_the_nearest_one_and_all_others() {
    refused(
        "viscosity = 0.001",
        "viscocity = 0.001",
        &[
            "unknown key `viscocity` in `fluid`",
            "--> wrong.toml:6:1",
            "6 | viscocity = 0.001",
            "  | ^^^^^^^^^",
            "did you mean `viscosity`? accepted: model, viscosity, density, gravity",
        ],
    );
}

#[test]
fn all_misspelt_keys_are_named_at_once() {
    let text = edited("size = 0.1", "sise = 0.1").replace("length = 2.2", "lenght = 2.2");
    let said = check(&text, &[]);
    assert_refused(&said, &["wrong.toml:10:1", "`length`", "wrong.toml:26:1", "`size`"]);
    assert!(!said.stderr.contains("missing key"), "{}", said.stderr);
}

#[test]
fn a_misspelt_key_inside_an_alternative_is_pointed_at() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ disc = { radios = 0.05 } }",
        &["unknown key `radios` in `body.0.shape.disc`", "wrong.toml:21:20", "`radius`?"],
    );
}

#[test]
fn a_quoted_number_is_a_wrong_type() {
    refused(
        "viscosity = 0.001",
        "viscosity = \"0.001 Pa s\"",
        &[
            "`fluid.viscosity` is the string \"0.001 Pa s\" where a number is wanted",
            "wrong.toml:6:13",
            "without quotes",
        ],
    );
}

#[test]
fn an_unknown_alternative_is_refused_with_the_known_ones() {
    refused(
        "model = \"navier-stokes\"",
        "model = \"navier-stoks\"",
        &["wrong.toml:5:9", "`navier-stokes`?", "accepted: stokes, unsteady-stokes"],
    );
    refused(
        "motion = \"held\"",
        "motion = \"imposed\"",
        &["wrong.toml:23:10", "{ imposed = ... }"],
    );
    refused("[time.steady]", "[time]", &["wrong.toml:29:", "exactly one", "steady, unsteady"]);
}

#[test]
fn a_missing_radius_is_named_with_its_table() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ disc = { } }",
        &["missing key `radius` in `body.0.shape.disc`", "wrong.toml:21:18", "radius = ..."],
    );
}

#[test]
fn text_that_is_not_toml_is_pointed_at() {
    refused("size = 0.1", "size = 0,1", &["this is not TOML", "wrong.toml:26:"]);
}

#[test]
fn overlapping_bodies_are_named_with_their_gap() {
    let second = "[[body]]\nname = \"other\"\nshape = { disc = { radius = 0.05 } }\n\
                  center = [0.28, 0.2]\nmotion = \"held\"\n\n[mesh]";
    refused(
        "[mesh]",
        second,
        &[
            "bodies \"disc\" and \"other\" touch or overlap",
            "gap -2.0",
            "wrong.toml:28:10",
            "move them apart",
        ],
    );
}

#[test]
fn a_body_outside_the_domain_is_refused_and_so_is_one_that_touches_it() {
    let remedy = ["body \"disc\" touches or leaves the domain", "wrong.toml:22:10", "enlarge"];
    refused("center = [0.2, 0.2]", "center = [0.2, 0.5]", &remedy);
    refused("center = [0.2, 0.2]", "center = [0.2, 0.05]", &remedy);
}

#[test]
fn a_negative_viscosity_is_refused() {
    refused(
        "viscosity = 0.001",
        "viscosity = -0.001",
        &["`fluid.viscosity` is -0.001, but must be positive", "wrong.toml:6:13", "larger than 0"],
    );
    refused("viscosity = 0.001", "viscosity = nan", &["not a finite number", "wrong.toml:6:13"]);
}

#[test]
fn inertia_needs_a_density() {
    refused("density = 1.0\n", "", &["the fluid has no density", "wrong.toml:4:", "add `density"]);
}

#[test]
fn an_unknown_side_is_refused_and_a_side_without_condition_too() {
    refused(
        "top = \"no-slip\"",
        "topp = \"no-slip\"",
        &[
            "this domain has no side `topp`",
            "wrong.toml:17:8",
            "did you mean `top`? accepted: left",
            "nothing is said about the side `top`",
        ],
    );
    refused(
        "surface = 0.02",
        "surface = 0.02\nsides = { wall = 0.1 }",
        &["no side `wall`", "wrong.toml:28:18", "accepted: left, right, bottom, top"],
    );
}

#[test]
fn inflow_without_outflow_is_refused_with_its_flux() {
    // 2/3 of 0.3 times 0.41.
    refused(
        "right = \"do-nothing\"",
        "right = \"no-slip\"",
        &["net inflow 0.082000 m2/s", "wrong.toml:13:", "do-nothing"],
    );
    let balanced = edited("right = \"do-nothing\"", "right = { parabolic = { peak = 0.3 } }");
    assert_accepted(&check(without_variant(&balanced), &[]));
}

#[test]
fn conditions_that_cannot_hold_on_a_side_are_refused() {
    refused("top = \"no-slip\"", "top = \"axis\"", &["wrong.toml:17:7", "symmetry"]);
    refused(
        "top = \"no-slip\"",
        "top = { periodic = \"left\" }",
        &["`top` cannot be periodic with `left`", "top = { periodic = \"bottom\" }"],
    );
    refused(
        "top = \"no-slip\"",
        "top = { periodic = \"bottom\" }",
        &["`bottom` has another condition", "wrong.toml:16:10"],
    );
    refused(
        "top = \"no-slip\"",
        "top = { parabolic = { peak = 1.0 } }",
        &["enters through `left` or `right`", "wrong.toml:17:"],
    );
}

#[test]
fn a_periodic_partner_may_be_left_out() {
    let sides = "left = { parabolic = { peak = 0.3 } }\nright = \"do-nothing\"";
    let text = edited(sides, "left = { periodic = \"right\" }");
    assert_accepted(&check(without_variant(&text), &[]));
}

#[test]
fn a_vector_of_the_wrong_length_is_refused() {
    refused(
        "center = [0.2, 0.2]",
        "center = [0.2, 0.2, 0.0]",
        &[
            "`body.0.center` has 3 numbers, but this case has 2 dimensions",
            "wrong.toml:22:10",
            "write [x, y]",
        ],
    );
    refused(
        "minus = [0.25, 0.2]",
        "minus = [0.25]",
        &["`probe.0.minus` has 1 number,", "wrong.toml:41:9"],
    );
}

#[test]
fn probes_are_in_the_fluid_or_on_its_boundary() {
    let outside = ["outside the domain", "wrong.toml:40:9"];
    refused("point = [0.15, 0.2]", "point = [0.15, 0.6]", &outside);
    refused("point = [0.15, 0.2]", "point = [0.17, 0.2]", &["inside the body \"disc\""]);
}

#[test]
fn shapes_fit_the_geometry() {
    refused(
        "{ disc = { radius = 0.05 } }",
        "{ sphere = { radius = 0.05 } }",
        &["a sphere cannot stand", "wrong.toml:21:9", "disc, ellipse, spline"],
    );
    refused("geometry = \"planar\"", "geometry = \"axisymmetric\"", &["half-disc, cylinder"]);
}

#[test]
fn names_mean_one_thing() {
    refused(
        "name = \"disc\"",
        "name = \"left\"",
        &["stands for something else", "wrong.toml:20:8"],
    );
    refused("name = \"drop\"", "name = \"disc\"", &["is taken", "wrong.toml:39:8"]);
    refused("name = \"disc\"", "name = \"a disc\"", &["cannot be a name"]);
}

/// The right case marching in time with its disc free, and these lines of the body.
fn marching(lines: &str) -> String {
    without_variant(RIGHT)
        .replace("[time.steady]", "[time.unsteady]\nstep = 0.1\nend = 1.0")
        .replace("motion = \"held\"", &format!("motion = \"free\"\n{lines}"))
}

#[test]
fn bodies_move_through_the_mesh() {
    let free = check(&marching(""), &[]);
    assert_accepted(&free);
    assert_eq!(free.stderr, "");
    assert_accepted(&check(&marching("").replace("navier-stokes", "stokes"), &[]));
    let ellipse = marching("")
        .replace("{ disc = { radius = 0.05 } }", "{ ellipse = { semi_axes = [0.05, 0.02] } }");
    assert_accepted(&check(&ellipse, &[]));
    let contact = "[contact.barrier]\nrange = 0.02\nstiffness = 1.0\n\n[mesh]";
    let with_contact = marching("").replace("[mesh]", contact);
    let said = check(&with_contact, &[]);
    assert_accepted(&said);
    assert_eq!(said.stderr, "");
    // A gap within the range at the start is a contact, not a mistake.
    assert_accepted(&check(&with_contact, &["--set", "body.0.center=[0.2, 0.06]"]));
    assert_refused(
        &check(&with_contact, &["--set", "time.unsteady.convection=newton"]),
        &["contact is solved together with extrapolated convection only", "--> --set:1:"],
    );
    assert_refused(
        &check(&with_contact, &["--set", "time.steady={}"]),
        &["a steady solution knows no contact", "wrong.toml:26:2", "march in time"],
    );
}

#[test]
fn springs_hold_free_bodies_in_unsteady_runs() {
    let spring = marching("spring = { stiffness = [0.0, 2.0], damping = [0.0, 0.1] }");
    let said = check(&spring, &[]);
    assert_accepted(&said);
    assert_eq!(said.stderr, "");
    assert_refused(
        &check(&spring, &["--set", "body.0.motion=held"]),
        &["not free to follow it", "wrong.toml:24:10", "motion = \"free\""],
    );
    assert_refused(
        &check(&spring, &["--set", "time.steady={}"]),
        &["acts in unsteady runs only", "wrong.toml:24:10"],
    );
    assert_refused(
        &check(&marching("spring = { stiffness = [-1.0, 2.0] }"), &[]),
        &["`body.0.spring.stiffness.0` is -1, but must not be negative", "wrong.toml:24:25"],
    );
}

#[test]
fn springs_and_factors_of_loads_on_the_axis_are_along_it() {
    let text = r#"title = "A sphere on a spring"
geometry = "axisymmetric"
fluid = { model = "stokes", viscosity = 1.0 }
domain.half-disc = { radius = 4.0 }
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }

[[body]]
name = "sphere"
shape.sphere = { radius = 1.0 }
center = [0.0, 0.0]
motion = "free"
spring = { stiffness = [1.0, 0.0], damping = [0.1, 0.0], anchor = [0.1, 0.0] }
force = [1.0, 0.0]
load_factor.sine = { frequency = 1.0 }
"#;
    assert_accepted(&check(text, &[]));
    for (setting, wanted) in [
        ("body.0.spring.stiffness.1=1", "the stiffness across the axis of \"sphere\" breaks"),
        ("body.0.spring.damping.1=1", "the damping across the axis"),
        ("body.0.spring.anchor.1=1", "the anchor off the axis"),
        ("body.0.spring.torsion=1", "the torsion of \"sphere\" breaks the symmetry"),
        ("body.0.load_factor.sine.frequency=0", "must be positive"),
        ("body.0.load_factor.table=[[1, 0], [0, 1]]", "must rise"),
    ] {
        assert_refused(&check(text, &["--set", setting]), &[wanted]);
    }
}

#[test]
fn a_factor_of_no_load_is_warned_about() {
    let factor = "load_factor = { ramp = { duration = 1.0 } }";
    let said = check(&marching(factor), &[]);
    assert_accepted(&said);
    assert!(said.stderr.contains("no force or torque of \"disc\""), "{}", said.stderr);
    assert!(said.stderr.contains("wrong.toml:24:15"), "{}", said.stderr);
    let loaded = check(&marching(&format!("torque = 1.0\n{factor}")), &[]);
    assert_accepted(&loaded);
    assert_eq!(loaded.stderr, "");
    let held = check(&marching(factor), &["--set", "body.0.motion=held"]);
    assert_accepted(&held);
    assert!(held.stderr.contains("`load_factor` has no effect"), "{}", held.stderr);
}

#[test]
fn adaptive_steps_have_bounds_around_the_first_one() {
    let text = marching("").replace(
        "end = 1.0",
        "end = 0.95\n\n[time.unsteady.adaptive]\ntolerance = 1e-3\nlargest = 0.2\nsmallest = 1e-4",
    );
    let said = check(&text, &[]);
    assert_accepted(&said);
    // Nobody expects adaptive steps to divide the end.
    assert_eq!(said.stderr, "");
    for (setting, wanted) in [
        ("tolerance=0", "must be positive"),
        ("tolerance=1", "is no accuracy"),
        ("largest=-1", "must be positive"),
        ("largest=0.05", "the largest step, 0.05, is shorter than the first one, 0.1"),
        ("smallest=0", "must be positive"),
        ("smallest=0.15", "the smallest step, 0.15, is longer than the first one, 0.1"),
        ("cfl=0", "must be positive"),
        ("gap=0", "must be positive"),
        ("gap=1", "may close"),
    ] {
        let setting = format!("time.unsteady.adaptive.{setting}");
        assert_refused(&check(&text, &["--set", &setting]), &[wanted, "--> --set:1:"]);
    }
}

#[test]
fn a_moving_mesh_has_limits_a_new_one_meets() {
    let text = marching("");
    for (setting, wanted) in [
        ("quality=0", "must be positive"),
        ("quality=1", "keeps 1 of its quality"),
        ("layers=0.5", "a gap needs a layer of cells"),
        ("layers=5", "has only 4 itself"),
        ("equation=elastc", "`elastic`?"),
    ] {
        let setting = format!("mesh.moving.{setting}");
        assert_refused(&check(&text, &["--set", &setting]), &[wanted, "--> --set:1:"]);
    }
    // The default is right on every mesh, and so is what the scale of the mesh makes of it.
    for setting in ["mesh.gap_layers=1", "mesh.scale=4", "mesh.moving.layers=4"] {
        assert_accepted(&check(&text, &["--set", setting]));
    }
    let still = check(RIGHT, &["--set", "mesh.moving.quality=0.3"]);
    assert_accepted(&still);
    assert!(still.stderr.contains("`mesh.moving` has no effect"), "{}", still.stderr);
}

#[test]
fn the_frame_is_that_of_a_body() {
    refused(
        "[fluid]",
        "frame = \"disk\"\n[fluid]",
        &["no body or swimmer has that name", "`disc`?"],
    );
}

#[test]
fn unsteady_stokes_is_not_steady() {
    refused(
        "model = \"navier-stokes\"",
        "model = \"unsteady-stokes\"",
        &["no steady solution", "wrong.toml:29:7", "[time.unsteady]"],
    );
}

#[test]
fn a_squirmer_is_round() {
    let gait = "motion = \"held\"\ngait = { squirmer = { modes = [1.0] } }";
    let ellipse =
        edited("{ disc = { radius = 0.05 } }", "{ ellipse = { semi_axes = [0.05, 0.02] } }")
            .replace("motion = \"held\"", gait);
    assert_refused(&check(&ellipse, &[]), &["a squirmer is a disc or a sphere", "wrong.toml:24:8"]);
}

#[test]
fn a_reynolds_number_that_disagrees_is_shown_with_the_derived_one() {
    refused(
        "reynolds = 20.0",
        "reynolds = 100.0",
        &[
            "declared as 100, but the case gives 20 = density * scales.velocity * scales.length / \
             viscosity",
            "wrong.toml:36:12",
            "correct the declared number",
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
            "drop.pressure",
            "flow.dissipation",
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
fn statistics_of_moving_bodies_have_what_they_need() {
    let text =
        marching("").replace("quantity = \"disc.drag_coefficient\"", "quantity = \"disc.y\"");
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
        ("statistic = \"at\"\nat = 2.0", "the time 2 is not within the run"),
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
    let text = marching("")
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

#[test]
fn an_unknown_variant_is_refused_with_the_known_ones() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("wrong.toml"), RIGHT).unwrap();
    let said = alewife(directory.path(), &["check", "--no-mesh", "wrong.toml/slaw"]);
    assert_refused(&said, &["there is no variant `slaw`", "wrong.toml:49:", "`slow`?"]);
    assert_accepted(&alewife(directory.path(), &["check", "--no-mesh", "wrong.toml/slow"]));
}

#[test]
fn a_variant_that_is_wrong_is_found_from_its_case() {
    refused(
        "\"numbers.reynolds\" = 2.0",
        "\"numbers.reynolds\" = 3.0",
        &["in variant wrong.toml/slow", "declared as 3", "wrong.toml:51:"],
    );
}

#[test]
fn a_wrong_setting_is_refused() {
    let refused = |setting: &str, wanted: &[&str]| {
        assert_refused(&check(RIGHT, &["--set", setting]), wanted);
    };
    refused(
        "fluid.viscocity=2",
        &["unknown key `viscocity`", "--> --set:1:1", "did you mean `viscosity`?"],
    );
    refused("body.1.center=[1, 1]", &["there is no `body.1`", "`body` has 1 of them"]);
    refused("fluid.viscosity", &["sets nothing", "--set KEY=VALUE"]);
    refused("fluid.viscosity=-1", &["must be positive", "--> --set:1:17"]);
}

#[test]
fn settings_reach_into_arrays_and_take_words_without_quotes() {
    let said = check(RIGHT, &["--set", "body.0.center.0=0.3", "--set", "fluid.model=stokes"]);
    assert_accepted(&said);
    assert!(said.stdout.contains("at [0.3, 0.2]"), "{}", said.stdout);
    assert!(said.stdout.contains("Stokes, viscosity"), "{}", said.stdout);
}

#[test]
fn a_file_extends_another_one_for_one_level() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
    let check = |name: &str| alewife(directory.path(), &["check", "--no-mesh", name]);
    let child = "extends = \"base.toml\"\n[fluid]\nviscosity = 0.002\n[numbers]\nreynolds = 10\n";
    write("base.toml", RIGHT);
    write("child.toml", child);
    write("grandchild.toml", "extends = \"child.toml\"\n");
    write("orphan.toml", "extends = \"bass.toml\"\n");

    let said = check("child.toml");
    assert_accepted(&said);
    assert!(said.stdout.contains("viscosity 0.002, density 1"), "{}", said.stdout);
    assert!(said.stdout.contains("none: nothing tells"), "{}", said.stdout);
    assert_refused(&check("grandchild.toml"), &["child.toml:1:1", "one level of `extends`"]);
    assert_refused(&check("orphan.toml"), &["orphan.toml:1:11", "there is no file bass.toml"]);

    write("base.toml", &edited("density = 1.0", "densty = 1.0"));
    assert_refused(&check("child.toml"), &["base.toml:7:1", "`density`?"]);
}

#[test]
fn what_is_not_there_is_exit_code_66() {
    let directory = tempfile::tempdir().unwrap();
    let said = alewife(directory.path(), &["check", "absent.toml"]);
    assert_eq!(said.code, 66, "{}", said.stderr);
    let said = alewife(directory.path(), &["show", "squirmer-alon"]);
    assert_eq!(said.code, 66);
    assert!(said.stderr.contains("did you mean `squirmer-alone`?"), "{}", said.stderr);
}

#[test]
fn usage_is_exit_code_2() {
    let directory = tempfile::tempdir().unwrap();
    assert_eq!(alewife(directory.path(), &["fly"]).code, 2);
    assert_eq!(alewife(directory.path(), &["run"]).code, 2);
}

#[test]
fn factors_belong_to_modes_and_axes_turn_in_the_plane_only() {
    let motion = "motion = \"held\"";
    let swimmer =
        |gait: &str| format!("motion = \"free\"\ngait.squirmer = {{ modes = [1.0], {gait} }}");
    refused(
        motion,
        &swimmer("factors = { 2 = { sine = { frequency = 1.0 } } }"),
        &["has 1 modes, and none is `2`", "by the number of their mode"],
    );
    refused(
        motion,
        &swimmer("turn.table = [[1.0, 0.0], [0.0, 1.0]]"),
        &["the times of a table must rise"],
    );
    let ball = r#"
        title = "a ball"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.half-disc = { radius = 4.0 }
        boundary.wall = "no-slip"
        mesh = { size = 0.2 }
        time.unsteady = { step = 0.1, end = 1.0 }
        [[body]]
        name = "ball"
        shape.sphere = { radius = 1.0 }
        center = [0.0, 0.0]
        motion = "free"
        gait.squirmer = { modes = [1.0], turn.ramp.duration = 1.0 }
    "#;
    assert_refused(&check(ball, &[]), &["breaks the symmetry", "to swim to and fro"]);
}

#[test]
fn a_sheet_waves_on_the_bottom_of_a_periodic_box_and_alone() {
    let sheet = |wavelength: &str, more: &str| {
        let text = format!(
            r#"
            title = "a sheet"
            geometry = "planar"
            fluid = {{ model = "stokes", viscosity = 1.0 }}
            domain.box = {{ min = [0.0, 0.0], max = [2.0, 3.0] }}
            mesh = {{ size = 0.2 }}
            [boundary]
            left.periodic = "right"
            top = "symmetry"
            [boundary.bottom.waving-sheet]
            amplitude = 0.05
            wavelength = {wavelength}
            frequency = 1.0
            {more}
            "#
        );
        check(&text, &[])
    };
    let unsteady = "[time.unsteady]\nstep = 0.1\nend = 1.0";
    assert_accepted(&sheet("1.0", unsteady));
    assert_refused(&sheet("1.5", unsteady), &["1.333333 wavelengths fit", "divides the length"]);
    assert_refused(&sheet("0.5", unsteady), &["cannot follow a sheet of amplitude 0.05"]);
    assert_refused(&sheet("1.0", "[time.steady]"), &["the solution is steady"]);
    refused(
        "bottom = \"no-slip\"",
        "bottom.waving-sheet = { amplitude = 0.01, wavelength = 1.0, frequency = 1.0 }",
        &["the bottom of a box that is periodic along x"],
    );
}

/// Swimmers, joints and a march in time: nothing wrong in it.
const SWIMMING: &str = r#"
title = "swimmers"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0, density = 1.0 }
domain.box = { min = [-5.0, -5.0], max = [5.0, 5.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.5, surface = 0.1 }
time.unsteady = { step = 0.1, end = 1.0, scheme = "rk3" }
[[body]]
name = "root"
shape.disc.radius = 0.3
center = [-3.0, -3.0]
motion = "free"
[[body]]
name = "leaf"
shape.disc.radius = 0.3
center = [-2.0, -3.0]
motion = "free"
[[joint]]
parent = "root"
child = "leaf"
kind.arm.length.sine = { mean = 1.0, amplitude = 0.2, period = 1.0 }
[[swimmer]]
name = "three"
center = [0.0, 3.0]
[swimmer.kind.linked-spheres]
radii = [0.2, 0.2, 0.2]
arms = [{ constant = 1.0 }, { legs = { period = 1.0, knots = [[0.0, 1.0], [0.5, 0.8]] } }]
[[swimmer]]
name = "chain"
center = [1.0, -1.0]
[swimmer.kind.chain]
links = [[0.4, 0.1], [0.4, 0.1]]
gap = 0.2
joints = [{ hinge = { damping = 0.1 } }]
"#;

/// The case above with one stretch of it replaced is refused in these words.
#[track_caller]
fn refused_swimming(from: &str, to: &str, wanted: &[&str]) {
    assert!(SWIMMING.contains(from), "`{from}` is not in the right case");
    assert_refused(&check(&SWIMMING.replacen(from, to, 1), &[]), wanted);
}

#[test]
fn strokes_have_lengths_and_times_that_rise() {
    assert_accepted(&check(SWIMMING, &[]));
    let is_short = "its length must be positive at all times";
    refused_swimming("amplitude = 0.2", "amplitude = 1.0", &["the arm is as short as 0", is_short]);
    refused_swimming("{ constant = 1.0 }", "{ constant = 0.0 }", &[is_short]);
    refused_swimming("[0.5, 0.8]", "[0.5, -0.1]", &["as short as -0.1"]);
    refused_swimming("[0.5, 0.8]", "[1.5, 0.8]", &["must rise from 0 to below the period"]);
    refused_swimming("[0.0, 1.0], ", "[0.1, 1.0], ", &["must rise from 0 to below the period"]);
    refused_swimming(
        "amplitude = 0.2, period = 1.0",
        "amplitude = 0.2, period = 0.0",
        &["must be positive"],
    );
    let table = "{ table = [[0.0, 1.0], [0.5, 0.8], [0.4, 1.0]] }";
    refused_swimming("{ constant = 1.0 }", table, &["must rise from knot to knot"]);
    refused_swimming("damping = 0.1", "damping = -0.1", &["must not be negative"]);
    refused_swimming("gap = 0.2", "gap = 0.0", &["must be positive"]);
}

#[test]
fn links_that_meet_in_their_strokes_are_foreseen() {
    let folds = |amplitude: f64| {
        format!(
            "links = [[0.4, 0.1], [0.4, 0.1], [0.4, 0.1]]\ngap = 0.2\njoints = [\
             {{ bent.angle.sine = {{ amplitude = {amplitude}, period = 1.0 }} }}, \
             {{ bent.angle.sine = {{ amplitude = -{amplitude}, period = 1.0 }} }}]\n#"
        )
    };
    let with = |amplitude: f64| {
        let rest =
            "links = [[0.4, 0.1], [0.4, 0.1]]\ngap = 0.2\njoints = [{ hinge = { damping = 0.1 } }]";
        SWIMMING.replacen(rest, &folds(amplitude), 1)
    };
    assert_accepted(&check(&with(0.8), &[]));
    assert_refused(
        &check(&with(2.6), &[]),
        &["in their strokes \"chain-1\" and \"chain-3\" meet at time 0.", "bend less"],
    );
}

#[test]
fn bodies_and_joints_make_trees() {
    let back = "[[joint]]\nparent = \"leaf\"\nchild = \"root\"\n\
                kind.arm = { length.constant = 1.0, direction = 3.141592653589793 }\n[[swimmer]]";
    refused_swimming("[[swimmer]]", back, &["the joints make a circle", "must hang on nothing"]);
    refused_swimming(
        "child = \"leaf\"",
        "child = \"root\"",
        &["hangs on two bodies, or on itself"],
    );
    refused_swimming(
        "parent = \"root\"",
        "parent = \"rot\"",
        &["no body has that name", "`root`?"],
    );
    let held = SWIMMING.replacen("motion = \"free\"\n[[joint]]", "motion = \"held\"\n[[joint]]", 1);
    assert_refused(
        &check(&held, &[]),
        &["cannot be held or moved besides", "may be held or moved"],
    );
    let away = SWIMMING.replacen("center = [-2.0, -3.0]", "center = [-2.0, -2.9]", 1);
    assert_refused(&check(&away, &[]), &["the joint puts \"leaf\" at [-2, -3]", "write center"]);
    let bent = "kind.bent.angle.constant = 0.5\non_parent = [1.0, 0.0]\n#";
    refused_swimming("kind.arm", bent, &["turns \"leaf\" to 0.5", "write angle = 0.5"]);
}

#[test]
fn swimmers_have_names_of_their_own_and_parts_that_fit() {
    refused_swimming("name = \"chain\"", "name = \"three\"", &["three-1"]);
    refused_swimming("name = \"chain\"", "name = \"leaf\"", &["the name \"leaf\" is taken"]);
    refused_swimming(
        "radii = [0.2, 0.2, 0.2]",
        "radii = [0.2, 0.2]",
        &["2 arms are given, and 1 are wanted"],
    );
    refused_swimming(
        "joints = [{",
        "joints = [{ bent.angle.constant = 0.0 }, {",
        &["2 joints are given"],
    );
    refused_swimming(
        "name = \"chain\"",
        "name = \"chain\"\ncopies.random = { count = 40, seed = 1, gap = 0.5 }",
        &["no space was found for copy", "fewer copies, a smaller gap"],
    );
    let none = "[[swimmer]]\nname = \"all\"\nkind.bodies = [\"root\", \"twig\"]\n[[swimmer]]";
    refused_swimming("[[swimmer]]", none, &["there is no body \"twig\" before it"]);
}

#[test]
fn a_chain_does_not_stand_on_the_axis() {
    let text = r#"
        title = "on the axis"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.half-disc.radius = 5.0
        boundary.wall = "no-slip"
        mesh = { size = 0.5, surface = 0.1 }
        time.unsteady = { step = 0.1, end = 1.0 }
        [[swimmer]]
        name = "swimmer"
        [swimmer.kind]
    "#;
    let chain =
        "chain = { links = [[0.4, 0.1], [0.4, 0.1]], gap = 0.2, joints = [{ hinge = {} }] }";
    let star = "star = { radius = 0.3, radii = [0.2], arms = [{ constant = 1.0 }] }";
    for (name, kind) in [("chain", chain), ("star", star)] {
        let told = format!("a {name} cannot stand in an axisymmetric case");
        assert_refused(&check(&format!("{text}{kind}"), &[]), &[&told]);
    }
    let spheres = "linked-spheres = { radii = [0.3, 0.2], arms = [{ constant = 1.0 }] }";
    assert_accepted(&check(&format!("{text}{spheres}"), &[]));
    let turned = "body.shape.sphere.radius = 1.0\n[[swimmer]]\nname = \"other\"\ncenter = [3.0, 0.0]\n\
                  angle = 3.141592653589793\nkind.body.shape.sphere.radius = 1.0";
    let told = ["the angle of \"other\" breaks the symmetry", "gait.squirmer.heading = 3.14"];
    assert_refused(&check(&format!("{text}{turned}"), &[]), &told);
}

#[test]
fn explicit_steps_have_no_inertia_and_nothing_stiff() {
    let why = |what: &str| format!("the scheme `rk3` cannot be used: {what}");
    refused_swimming(
        "model = \"stokes\"",
        "model = \"navier-stokes\"",
        &[&why("the model has inertia")],
    );
    refused_swimming(
        "damping = 0.1",
        "stiffness = 0.1",
        &[&why("there are hinges with stiffness")],
    );
    let contact = "contact.barrier = { range = 0.1, stiffness = 1.0 }\n[[body]]";
    refused_swimming("[[body]]", contact, &[&why("there is [contact]")]);
    let spring = "motion = \"free\"\nspring.stiffness = [1.0, 1.0]";
    refused_swimming("motion = \"free\"", spring, &[&why("there are springs")]);
}
