//! Wrong bodies: places, names, motions, springs and gaits.

use super::{assert_accepted, assert_refused, check, edited, refused, unsteady};

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
fn names_mean_one_thing() {
    refused(
        "name = \"disc\"",
        "name = \"left\"",
        &["stands for something else", "wrong.toml:20:8"],
    );
    refused("name = \"drop\"", "name = \"disc\"", &["is taken", "wrong.toml:39:8"]);
    refused("name = \"disc\"", "name = \"a disc\"", &["cannot be a name"]);
}

#[test]
fn bodies_move_through_the_mesh() {
    let free = check(&unsteady(""), &[]);
    assert_accepted(&free);
    assert_eq!(free.stderr, "");
    assert_accepted(&check(&unsteady("").replace("navier-stokes", "stokes"), &[]));
    let ellipse = unsteady("")
        .replace("{ disc = { radius = 0.05 } }", "{ ellipse = { semi_axes = [0.05, 0.02] } }");
    assert_accepted(&check(&ellipse, &[]));
    let contact = "[contact.barrier]\nrange = 0.02\nstiffness = 1.0\n\n[mesh]";
    let with_contact = unsteady("").replace("[mesh]", contact);
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
        &["a steady solution knows no contact", "wrong.toml:26:2", "use [time.unsteady]"],
    );
}

#[test]
fn springs_hold_free_bodies_in_unsteady_runs() {
    let spring = unsteady("spring = { stiffness = [0.0, 2.0], damping = [0.0, 0.1] }");
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
        &check(&unsteady("spring = { stiffness = [-1.0, 2.0] }"), &[]),
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
load_factor.sine = { period = 1.0 }
"#;
    assert_accepted(&check(text, &[]));
    for (setting, wanted) in [
        ("body.0.spring.stiffness.1=1", "the stiffness across the axis of \"sphere\" breaks"),
        ("body.0.spring.damping.1=1", "the damping across the axis"),
        ("body.0.spring.anchor.1=1", "the anchor off the axis"),
        ("body.0.spring.torsion=1", "the torsion of \"sphere\" breaks the symmetry"),
        ("body.0.load_factor.sine.period=0", "must be positive"),
        ("body.0.load_factor.table=[[1, 0], [0, 1]]", "must rise"),
    ] {
        assert_refused(&check(text, &["--set", setting]), &[wanted]);
    }
}

#[test]
fn a_factor_of_no_load_is_warned_about() {
    let factor = "load_factor = { ramp = { duration = 1.0 } }";
    let said = check(&unsteady(factor), &[]);
    assert_accepted(&said);
    assert!(said.stderr.contains("no force or torque of \"disc\""), "{}", said.stderr);
    assert!(said.stderr.contains("wrong.toml:24:15"), "{}", said.stderr);
    let loaded = check(&unsteady(&format!("torque = 1.0\n{factor}")), &[]);
    assert_accepted(&loaded);
    assert_eq!(loaded.stderr, "");
    let held = check(&unsteady(factor), &["--set", "body.0.motion=held"]);
    assert_accepted(&held);
    assert!(held.stderr.contains("`load_factor` has no effect"), "{}", held.stderr);
}

#[test]
fn a_squirmer_is_round() {
    let gait = "motion = \"held\"\ngait = { squirmer = { modes = [1.0] } }";
    let ellipse =
        edited("{ disc = { radius = 0.05 } }", "{ ellipse = { semi_axes = [0.05, 0.02] } }")
            .replace("motion = \"held\"", gait);
    assert_refused(&check(&ellipse, &[]), &["is that of a disc, but", "wrong.toml:24:8"]);
}

#[test]
fn factors_belong_to_modes_and_axes_turn_in_the_plane_only() {
    let motion = "motion = \"held\"";
    let swimmer =
        |gait: &str| format!("motion = \"free\"\ngait.squirmer = {{ modes = [1.0], {gait} }}");
    refused(
        motion,
        &swimmer("factors = { 2 = { sine = { period = 1.0 } } }"),
        &["has 1 mode, and none is `2`", "by the number of their mode"],
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
fn names_have_at_most_64_letters() {
    let name = |n: usize| format!("name = \"{}\"", "d".repeat(n));
    for n in [65, 65_536] {
        let told = [format!("has {n} characters"), "at most 64".to_owned()];
        let told: Vec<&str> = told.iter().map(String::as_str).collect();
        refused("name = \"drop\"", &name(n), &told);
        refused("name = \"disc\"", &name(n), &told);
    }
    let text = edited("name = \"drop\"", &name(64));
    assert_accepted(&check(&text, &[]));
}

#[test]
fn gaps_too_thin_for_a_mesh_are_told_with_the_threshold() {
    let told = ["from the boundary", "gaps below 1e-7 of the size of a body cannot be meshed"];
    refused("center = [0.2, 0.2]", "center = [0.2, 0.050000000001]", &told);
    let second = "[[body]]\nname = \"other\"\nshape = { disc = { radius = 0.05 } }\n\
                  center = [0.300000000001, 0.2]\nmotion = \"held\"\n\n[mesh]";
    refused("[mesh]", second, &["are 1.0", "apart at", "gaps below 1e-7"]);
}

#[test]
fn what_is_lost_to_rounding_is_refused() {
    let thin = ["\"disc\" is 1.000e-20 thin in a domain of", "lost to rounding", "wrong.toml:21:9"];
    refused("radius = 0.05", "radius = 1e-20", &thin);
    refused("radius = 0.05", "radius = 1e-100", &["beyond what can be computed with"]);
    refused("length = 2.2", "length = 1e200", &["beyond what can be computed with", "1e200"]);
    let far = "domain.box = { min = [1e12, 0.0], max = [1000000000002.2, 0.41] }\n[mesh]";
    let text =
        edited("[domain.channel]\nlength = 2.2\nheight = 0.41\n", "").replace("[mesh]", "[MESH]");
    let text = text
        .replacen("[fluid]", &far.replace("\n[mesh]", "\n[fluid]"), 1)
        .replace("[MESH]", "[mesh]");
    assert_refused(&check(&text, &[]), &["from the origin", "move domain and bodies"]);
}

#[test]
fn what_is_hardly_meant_is_warned_about() {
    let warned = |text: &str, settings: &[&str], wanted: &str| {
        let said = check(text, settings);
        assert_accepted(&said);
        assert!(said.stderr.contains(wanted), "`{wanted}` is not in:\n{}", said.stderr);
    };
    let free = unsteady("");
    warned(&free, &["--set", "body.0.locked=['x', 'y', 'rotation']"], "all its motions are locked");
    warned(&free, &["--set", "body.0.density=7e9"], "7.000e9 times the density of the fluid");
    warned(&free, &["--set", "mesh.gap_layers=1"], "too few for the pressure");
    let outside = "mesh.box=[{ min = [3, 0], max = [4, 1], size = 0.1 }]";
    warned(&free, &["--set", outside], "lies outside the domain and refines nothing");
    let modes = format!("body.0.gait.squirmer.modes=[{}]", vec!["1.0"; 100].join(", "));
    warned(&free, &["--set", &modes], "mode 100 of \"disc\" is not resolved");
}

#[test]
fn bodies_that_may_meet_are_told_of_contact() {
    let hinted = |text: &str, settings: &[&str], wanted: &str| {
        let said = check(text, settings);
        assert_accepted(&said);
        for wanted in [wanted, "nothing keeps them apart", "if they may meet, add contact.barrier"]
        {
            assert!(said.stderr.contains(wanted), "`{wanted}` is not in:\n{}", said.stderr);
        }
    };
    let text = unsteady("");
    let near_wall = ["--set", "body.0.center=[0.2, 0.0505]"];
    hinted(&text, &near_wall, "\"disc\" is within 5.0e-4 of the side `bottom` at the start");
    let contact = "[contact.barrier]\nrange = 0.02\nstiffness = 1.0\n\n[mesh]";
    let with_contact = check(&text.replace("[mesh]", contact), &near_wall);
    assert_eq!(with_contact.stderr, "");
    // An open side is no wall, and a body that is held does not come nearer
    assert_eq!(check(&text, &["--set", "body.0.center=[2.1495, 0.2]"]).stderr, "");
    let held = [&near_wall[..], &["--set", "body.0.motion=held"]].concat();
    assert_eq!(check(&text, &held).stderr, "");
    let second = "[[body]]\nname = \"other\"\nshape = { disc = { radius = 0.05 } }\n\
                  center = [0.301, 0.2]\nmotion = \"held\"\n\n[mesh]";
    hinted(
        &text.replace("[mesh]", second),
        &[],
        "\"other\" is within 1.0e-3 of \"disc\" at the start",
    );
}
