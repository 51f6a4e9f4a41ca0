//! Wrong joints and swimmers.

use super::{Said, alewife, assert_accepted, assert_refused, check, check_within, edited_in};

/// Swimmers and joints in an unsteady run: nothing wrong in it.
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
    assert_refused(&check(&edited_in(SWIMMING, from, to), &[]), wanted);
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
    let told =
        ["the joints make a loop: \"root\" hangs on \"leaf\" hangs on \"root\"", "hang on nothing"];
    refused_swimming("[[swimmer]]", back, &told);
    // Where the loop cannot close either, it is the loop that is wrong
    refused_swimming("[[swimmer]]", &back.replace("1.0, dir", "1.5, dir"), &told);
    refused_swimming("child = \"leaf\"", "child = \"root\"", &["\"root\" hangs on itself"]);
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
        &["2 arms are given, and 1 is wanted"],
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
        &[&why("there are joints with stiffness")],
    );
    let spring = "motion = \"free\"\nspring.stiffness = [1.0, 1.0]";
    refused_swimming("motion = \"free\"", spring, &[&why("there are springs")]);
}

#[test]
fn numbers_of_copies_are_limited() {
    for counts in ["[100000, 100000]", "[9223372036854775807, 9223372036854775807]"] {
        let lattice =
            format!("name = \"chain\"\ncopies.lattice = {{ counts = {counts}, spacing = [2, 2] }}");
        let told = ["make more than the 20000 bodies a case may have", "lattice", "at most 9997"];
        refused_swimming("name = \"chain\"", &lattice, &told);
    }
    let lattice = "name = \"chain\"\ncopies.lattice = { counts = [4294967296, 4294967296], spacing = [2, 2] }";
    refused_swimming("name = \"chain\"", lattice, &["make more than", "counts"]);
    let random = "name = \"chain\"\ncopies.random = { count = 1000000000, seed = 1, gap = 0.5 }";
    refused_swimming(
        "name = \"chain\"",
        random,
        &["1000000000 copies of \"chain\" make more than"],
    );
}

/// Pairs of bodies are found by their places, not by going through all pairs.
#[test]
fn two_thousand_bodies_are_checked_at_once() {
    let text = r#"
        title = "many discs"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [0.0, 0.0], max = [200.0, 160.0] }
        boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
        mesh = { size = 2.0, surface = 0.5 }
        time.unsteady = { step = 0.1, end = 1.0 }
        [[swimmer]]
        name = "disc"
        center = [4.0, 4.0]
        copies.lattice = { counts = [50, 40], spacing = [3.9, 3.9] }
        kind.body = { shape.disc.radius = 1.0, gait.squirmer.modes = [1.0] }
    "#;
    let said = check_within(2, text, &[]);
    assert_accepted(&said);
    assert!(said.stdout.contains("disc-2000"), "{}", said.stdout);
}

#[test]
fn names_of_swimmers_are_words_of_some_length() {
    refused_swimming(
        "name = \"chain\"",
        "name = \"a chain\"",
        &["cannot be a name", "wrong.toml:"],
    );
    let long = format!("name = \"{}\"", "c".repeat(65_536));
    refused_swimming("name = \"chain\"", &long, &["has 65536 characters", "at most 64"]);
}

#[test]
fn cycles_are_longer_than_steps() {
    let told = ["1e-9, shorter than a step of 1e-1", "lower time.unsteady.step", "wrong.toml:"];
    refused_swimming(
        "legs = { period = 1.0, knots = [[0.0, 1.0], [0.5, 0.8]]",
        "legs = { period = 1e-9, knots = [[0.0, 1.0], [5e-10, 0.8]]",
        &told,
    );
}

#[test]
fn copies_that_are_wrong_in_the_same_way_are_not_told_of_one_by_one() {
    let copies = "name = \"chain\"\ncopies.lattice = { counts = [3, 3], spacing = [1.5, 1.5] }\ndensity = -1.0";
    let text = SWIMMING.replacen("name = \"chain\"", copies, 1);
    let said = check(&text, &["--set", "mesh.surface=1.0"]);
    assert_refused(&said, &["must not be negative"]);
    assert_eq!(said.stderr.matches("must not be negative").count(), 1, "{}", said.stderr);
    assert_eq!(said.stderr.matches("outline of \"chain").count(), 1, "{}", said.stderr);
    let far = text.replace("spacing = [1.5, 1.5]", "spacing = [900.0, 900.0]");
    let said = check(&far.replace("density = -1.0", ""), &["--set", "mesh.surface=0.1"]);
    assert_eq!(said.stderr.matches("leaves the domain").count(), 3, "{}", said.stderr);
}

#[test]
fn links_have_a_shape_and_a_density_of_their_own() {
    let links = "links = [[0.4, 0.1], [0.4, 0.1]]";
    let kite = "shape.spline.points = [[0.4, 0.0], [0.0, 0.1], [-0.4, 0.0], [0.0, -0.1]]";
    let with = |link: &str| format!("links = [[0.4, 0.1], {link}]");
    let heavy = with(&format!("{{ {kite}, density = 2.0 }}"));
    assert_accepted(&check(&SWIMMING.replacen(links, &heavy, 1), &[]));
    for (link, wanted) in [
        ("[0.4]", ["links.1` is an array of 1", "an array of 2 numbers is wanted"]),
        ("[0.4, 0.1, 0.1]", ["links.1` is an array of 3", "an array of 2 numbers is wanted"]),
        ("0.4", ["links.1` is `0.4`", "or { shape = ..., density = ... }"]),
        ("{ density = 2.0 }", ["missing key `shape` in `swimmer.1.kind.chain.links.1`", "add"]),
        (
            "{ shape.disc.radius = 0.4, densty = 2.0 }",
            ["unknown key `densty` in `swimmer.1.kind.chain.links.1`", "did you mean `density`?"],
        ),
        ("{ shape.disc.radius = 0.4, density = -2.0 }", ["is -2", "must not be negative"]),
        ("{ shape.disc.radius = -0.4 }", ["is -0.4", "must be positive"]),
        ("{ shape.sphere.radius = 0.4 }", ["a sphere cannot stand", "planar shapes: disc"]),
        (
            "{ shape.spline.points = [[0.0, 0.0], [0.4, 0.4], [0.4, 0.0], [0.0, 0.4]] }",
            ["link 2 of the chain has no outline", "points that run counter-clockwise"],
        ),
    ] {
        refused_swimming(links, &with(link), &wanted);
    }
}

/// The chain above bent as a file says, its text and where its name stands being given.
fn bent_by(file: &str, text: &str) -> Said {
    let directory = tempfile::tempdir().unwrap();
    let bent = format!("joints = [{{ bent.angle.file = {file} }}]");
    let case = SWIMMING.replacen("joints = [{ hinge = { damping = 0.1 } }]", &bent, 1);
    let folder = directory.path().join("robot");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("case.toml"), case).unwrap();
    std::fs::write(folder.join("angles.csv"), text).unwrap();
    alewife(directory.path(), &["check", "--no-mesh", "robot/case.toml"])
}

#[test]
fn angles_come_from_the_columns_of_a_file() {
    let file = "{ path = \"angles.csv\", time = \"t, s\", column = \"q2\" }";
    let right = "\"t, s\",q1,q2\r\n# logged\r\n0.0, 0.0, 0.0\r\n0.5,0.1,0.2\r\n\r\n1.0,0.0,0.1\r\n";
    assert_accepted(&bent_by(file, right));
    assert_accepted(&bent_by(file, &format!("\u{feff}{right}")));
    for (from, to, wanted) in [
        ("0.1,0.2", "0.1,x0.2", ["column `q2`: `x0.2` is not a finite number", "angles.csv:4:1"]),
        ("1.0,0.0,0.1", "1.0,0.0,nan", ["`nan` is not a finite number", "angles.csv:6:1"]),
        ("1.0,0.0,0.1", "1.0,0.0", ["column `q2` is empty here", "angles.csv:6:1"]),
        ("1.0,0.0", "0.5,0.0", ["`t, s`: time 0.5 does not come after 0.5", "angles.csv:6:1"]),
        ("\r\n1.0,0.0", "\n0.9,0.0", ["go from 0 to 0.9, and the run from 0 to 1", "whole run"]),
        ("\n0.0, 0.0,", "\n0.1,0.0,", ["go from 0.1 to 1, and the run", "robot/case.toml:35:"]),
        (",q1,", ",q2,", ["`column`: robot/angles.csv has 2 columns `q2`", "a name of its own"]),
    ] {
        assert!(right.contains(from), "`{from}`");
        assert_refused(&bent_by(file, &right.replacen(from, to, 1)), &wanted);
    }
    let with = |from: &str, to: &str| bent_by(&file.replacen(from, to, 1), right);
    let no_column = ["`column`: robot/angles.csv has no column `q3`", "t, s, q1, q2"];
    assert_refused(&with("q2", "q3"), &no_column);
    assert_refused(&with("angles.csv", "angle.csv"), &["no file robot/angle.csv", "relative to"]);
    assert_refused(&with("angles.csv", ""), &["is a directory, not a file"]);
    let file_key = "swimmer.1.kind.chain.joints.0.bent.angle.file";
    let missing = format!("missing key `column` in `{file_key}`");
    assert_refused(&with(", column = \"q2\"", ""), &[&missing, "robot/case.toml:35:"]);
    assert_refused(&with("time =", "times ="), &["unknown key `times`", "did you mean `time`?"]);
    assert_refused(&bent_by("\"angles.csv\"", right), &["the string \"angles.csv\"", "{ path ="]);
    assert_refused(&bent_by(file, "\"t, s\",q2\n0.0,0.0\n"), &["has 1 rows of numbers"]);
    let degrees = bent_by(file, &right.replace("0.2", "20.0").replace("0.1\r", "10.0\r"));
    assert_eq!(degrees.stderr.matches("more than a turn").count(), 1, "{}", degrees.stderr);
}
