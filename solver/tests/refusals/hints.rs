//! Messages name what stands in the file, and what helps there: swimmers, quantities, paths.

use super::{RIGHT, Said, alewife, assert_accepted, assert_refused, check, edited_in};

/// Three discs in a row that swim in a box, and a disc beside them.
const ROW: &str = r#"
title = "a row"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.box = { min = [-5.0, -5.0], max = [5.0, 5.0] }
boundary = { left = "no-slip", right = "no-slip", bottom = "no-slip", top = "no-slip" }
mesh = { size = 0.5, surface = 0.1 }
time.unsteady = { step = 0.1, end = 1.0 }

[[body]]
name = "rock"
shape.disc.radius = 0.3
center = [-3.0, -3.0]
motion = "held"

[[swimmer]]
name = "tri"
center = [0.0, 3.0]
[swimmer.kind.linked-spheres]
radii = [0.2, 0.2, 0.2]
arms = [{ sine = { mean = 1.0, amplitude = 0.1, period = 1.0 } }, { constant = 1.0 }]
"#;

#[track_caller]
fn refused_row(from: &str, to: &str, wanted: &[&str]) {
    assert_refused(&check(&edited_in(ROW, from, to), &[]), wanted);
}

#[test]
fn what_is_wrong_with_a_swimmer_is_told_by_its_own_keys() {
    assert_accepted(&check(ROW, &[]));
    refused_row(
        "radii = [0.2, 0.2, 0.2]",
        "radii = [0.2, -0.8, 0.2]",
        &[
            "`swimmer.0.kind.linked-spheres.radii.1` is -0.8, but must be positive",
            "--> wrong.toml:20:15",
        ],
    );
    refused_row(
        "name = \"rock\"",
        "name = \"tri-1\"",
        &[
            "\"tri-1\" is that of a body of the swimmer \"tri\", which has \"tri-1\" to \"tri-3\"",
            "--> wrong.toml:11:8",
            "give the body another name",
        ],
    );
    refused_row(
        "radii = [0.2, 0.2, 0.2]",
        "radii = [0.2, 0.2, 0.2, 0.2]",
        &["2 arms are given, and 3 are wanted", "one for each pair of neighbours in `radii`"],
    );
    let star = "[swimmer.kind.star]\nradius = 0.3\nradii = [0.2, -0.1]";
    let arms = "arms = [{ constant = 1.0 }, { constant = 1.0 }]";
    let (head, _) = ROW.split_once("[swimmer.kind").unwrap();
    let said = check(&format!("{head}{star}\n{arms}"), &[]);
    assert_refused(&said, &["`swimmer.0.kind.star.radii.1` is -0.1", "wrong.toml:21:15"]);
}

#[test]
fn a_scale_that_asks_for_too_much_is_pointed_at() {
    let said = check(ROW, &["--set", "mesh.scale=0.01"]);
    assert_refused(&said, &["--> --set:1:12"]);
    assert!(!said.stderr.contains("wrong.toml:"), "{}", said.stderr);
}

#[test]
fn of_quantities_those_of_the_same_owner_are_named() {
    let compared = |quantity: &str| {
        let lines = "value = 1.0\nrelative = 0.1\nkind = \"literature\"\nsource = \"a paper\"\n";
        check(&format!("{ROW}[[reference]]\nquantity = \"{quantity}\"\n{lines}"), &[])
    };
    let said = compared("tri.speed");
    assert_refused(&said, &["did you mean `tri.cycle.speed`? `tri` has x, y, angle"]);
    assert!(!said.stderr.contains("rock.force.x"), "{}", said.stderr);
    let said = compared("sphere.force.x");
    assert_refused(&said, &["owners of quantities: rock, tri-1, tri-2, tri-3, tri, flow\n"]);
}

#[test]
fn columns_between_semicolons_are_told() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("a.csv"), "t;x\n0.0;1.0\n1.0;1.1\n").unwrap();
    let file = "{ file = { path = \"a.csv\", time = \"t\", column = \"x\" } }";
    let text = ROW.replace("{ constant = 1.0 }", file);
    std::fs::write(directory.path().join("row.toml"), text).unwrap();
    let said = alewife(directory.path(), &["check", "--no-mesh", "row.toml"]);
    assert_refused(&said, &["has its columns between ';'", "separate columns by commas"]);
}

#[test]
fn rows_that_are_longer_or_shorter_than_the_header_are_refused_where_they_stand() {
    let directory = tempfile::tempdir().unwrap();
    let file = "{ file = { path = \"a.csv\", time = \"t\", column = \"x\" } }";
    let text = ROW.replace("{ constant = 1.0 }", file);
    std::fs::write(directory.path().join("row.toml"), text).unwrap();
    let check = |rows: &str| {
        std::fs::write(directory.path().join("a.csv"), rows).unwrap();
        alewife(directory.path(), &["check", "--no-mesh", "row.toml"])
    };
    let long = check("t,x\n0.0,1.0\n# angle\n1,1,5\n9,1.0\n");
    let place = "a.csv:4:1";
    assert_refused(&long, &["this row has 3 cells, and the header has 2", place, "decimal point"]);
    let short = check("t,x,y\n0.0,1.0,2.0\n1.0,1.1\n");
    assert_refused(&short, &["this row has 2 cells, and the header has 3", "a.csv:3:1"]);
    // The same in columns that are not read
    let other = check("t,x,y\n0.0,1.0,1,5\n9.0,1.0,1\n");
    assert_refused(&other, &["this row has 4 cells, and the header has 3", "a.csv:2:1"]);
    assert_eq!(check("t,x\n0.0,1.0\n\n 9.0 , 1.1 \n").code, 0);
}

#[test]
fn paths_that_lead_to_no_case_or_no_run_say_so() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| -> Said { alewife(directory.path(), arguments) };
    std::fs::create_dir(directory.path().join("empty")).unwrap();
    let absolute = directory.path().join("empty").display().to_string();
    for path in ["empty", &absolute] {
        let said = run(&["check", path]);
        assert_eq!(said.code, 66);
        let wanted = format!("the directory {path} holds no case.toml");
        assert!(said.stderr.contains(&wanted), "{}", said.stderr);
    }
    std::fs::write(directory.path().join("self.toml"), "extends = \"./self.toml\"\n").unwrap();
    let said = run(&["check", "self.toml"]);
    assert_refused(&said, &["self.toml extends itself", "--> self.toml:1:11"]);

    std::fs::write(directory.path().join("right.toml"), RIGHT).unwrap();
    let said = run(&["run", "right.toml", "--out", "self.toml"]);
    assert_eq!(said.code, 2, "{}", said.stderr);
    assert!(said.stderr.contains("self.toml is a file, and a run takes a dir"), "{}", said.stderr);
    let said = run(&["run", "right.toml", "--out", "self.toml/below"]);
    assert_eq!(said.code, 74, "{}", said.stderr);
    assert!(said.stderr.contains("cannot be made"), "{}", said.stderr);
    assert!(said.stderr.contains("give one you may write to with --out"), "{}", said.stderr);
}

/// A disc whose motion is given, 7.5 away from the left side, and one that is held 3 to its right.
fn moved(motion: &str, end: &str) -> String {
    let (head, _) = ROW.split_once("[[body]]").unwrap();
    let bodies = format!(
        "[[body]]\nname = \"one\"\nshape.disc.radius = 0.5\ncenter = [-2.0, 0.0]\n\
         motion = {{ imposed = {{ {motion} }} }}\n[[body]]\nname = \"two\"\nshape.disc.radius = 0.5\n\
         center = [2.0, 0.0]\nmotion = \"held\"\n"
    );
    let head = head.replace("end = 1.0", &format!("end = {end}"));
    format!("{head}{bodies}")
}

#[test]
fn a_given_motion_that_cannot_be_made_is_refused_with_its_time() {
    let away = "velocity = [-1.0, 0.0]";
    let said = check(&moved(away, "20.0"), &[]);
    assert_refused(&said, &["by its motion \"one\" comes to the boundary", "before the end at 20"]);
    let towards = check(&moved("velocity = [1.5, 0.0]", "20.0"), &[]);
    assert_refused(&towards, &["comes to \"two\" at (1.5000, 0.0000) at t = 2,"]);
    // 0.5 to and fro, and back before it is there
    for (motion, end) in [
        (away, "1.0"),
        ("velocity = [-1.0, 0.0], factor.sine = { period = 3.14 }", "20.0"),
        ("velocity = [-1.0, 0.0], factor.table = [[0.0, 1.0], [1.0, 1.0], [1.1, 0.0]]", "20.0"),
    ] {
        assert_accepted(&check(&moved(motion, end), &[]));
    }
    let turning = check(&moved("angular_velocity = 360.0", "1.0"), &[]);
    assert_accepted(&turning);
    assert!(turning.stderr.contains("turns by 36 rad in a step"), "{}", turning.stderr);
    assert!(turning.stderr.contains("write 6.28319"), "{}", turning.stderr);
}

#[test]
fn motions_by_axis_that_cannot_be_made_are_refused_with_their_time() {
    let by_axis = |motion: &str, end: &str| {
        let text = moved("velocity = [0.0, 0.0]", end);
        let motion = format!("motion = {{ {motion} }}");
        check(&text.replace("motion = { imposed = { velocity = [0.0, 0.0] } }", &motion), &[])
    };
    // 7.5 to the left side, and 3 to the other body
    for (motion, said) in [
        ("x = { velocity = { value = -1.0 } }", "the boundary"),
        ("x = { imposed = { steady = { rate = -1.0 } } }", "the boundary"),
        ("x = { imposed = { sine = { amplitude = 8.0, period = 4.0 } } }", "\"two\" at"),
        ("x = { velocity = { value = 1.5 } }", "at t = 2,"),
        ("x = { imposed = { steady = { rate = 1.5 } } }, rotation = \"free\"", "at t = 2,"),
        // Wherever it is along y
        ("x = { velocity = { value = -1.0 } }, y = \"free\"", "the boundary"),
    ] {
        let found = by_axis(motion, "20.0");
        assert_refused(&found, &["by its motion \"one\" comes to", said, "before the end at 20"]);
    }
    for motion in [
        "x = { imposed = { sine = { amplitude = 1.0, period = 4.0 } } }",
        "x = { velocity = { value = 1.0, factor.sine = { period = 2.0 } } }",
        // The other body may be passed
        "x = { velocity = { value = 0.2 } }, y = \"free\"",
        "x = \"free\", rotation = { imposed = { steady = { rate = 1.0 } } }",
    ] {
        assert_accepted(&by_axis(motion, "20.0"));
    }
}
