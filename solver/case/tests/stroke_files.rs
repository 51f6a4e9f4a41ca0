//! A case whose joints move as a file says stands for itself once it is read.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::fs;
use std::path::Path;

use alewife_case::{Case, JointKind};

const CASE: &str = r#"
title = "a robot"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.1, end = 1.0 }
[[swimmer]]
name = "robot"
[swimmer.kind.chain]
links = [[0.4, 0.1], [0.4, 0.1]]
gap = 0.2
joints = [{ bent.angle.file = { path = "../log.csv", time = "t", column = "q" } }]
"#;

fn read(path: &Path, settings: &[&str]) -> Case {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Case::read(path.to_str().unwrap(), &settings).unwrap().model.case
}

#[test]
fn the_values_of_a_file_become_part_of_the_case() {
    let directory = tempfile::tempdir().unwrap();
    let [cases, others] = ["cases", "others/deeper"].map(|name| directory.path().join(name));
    fs::create_dir_all(&cases).unwrap();
    fs::create_dir_all(&others).unwrap();
    let log = directory.path().join("log.csv");
    fs::write(&log, "t,q,r\n0,0.0,0.0\n0.4,0.3,0.1\n0.7,0.1,0.2\n1,-0.2,0.3\n").unwrap();
    let path = cases.join("robot.toml");
    fs::write(&path, CASE).unwrap();
    let case = read(&path, &[]);

    // A file is found from the text that names it, also where another one extends that
    let child = others.join("child.toml");
    let parent = path.to_str().unwrap();
    fs::write(&child, format!("extends = '{parent}'\ntitle = \"another\"\n")).unwrap();
    assert_eq!(read(&child, &[]).swimmer, case.swimmer);

    // Another column, and another value, are another problem
    let keys = case.problem_keys().unwrap();
    let key = "swimmer.0.kind.chain.joints.0.bent.angle";
    let other = read(&path, &[&format!("{key}.file.column=r")]).problem_keys().unwrap();
    let differ: Vec<&String> = keys.keys().filter(|key| keys[*key] != other[*key]).collect();
    assert_eq!(differ, [&format!("{key}.cubic")]);

    // Nothing of the file is needed when the case is read back
    let text = case.to_toml().unwrap();
    fs::remove_file(&log).unwrap();
    let back = Case::parse("case.toml", &text, &[]).unwrap().model;
    assert_eq!(back.case, case);
    let JointKind::Bent { angle, .. } = &back.joints[0].kind else { panic!("{:?}", back.joints) };
    for (time, value) in [(0.0, 0.0), (0.4, 0.3), (0.7, 0.1), (1.0, -0.2)] {
        assert!((angle.at(time)[0] - value).abs() < 1e-14);
    }
    // Rates are continuous, and so are their slopes
    for knot in [0.4, 0.7] {
        let rate = |time: f64| angle.at(time)[1];
        let slopes = [rate(knot) - rate(knot - 1e-6), rate(knot + 1e-6) - rate(knot)];
        assert!(slopes.iter().all(|slope| slope.abs() < 1e-4), "{slopes:?}");
        assert!((slopes[0] - slopes[1]).abs() < 1e-9, "{slopes:?}");
    }
}

#[test]
fn a_field_follows_a_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("field.toml");
    fs::write(directory.path().join("log.csv"), "t,b\n0,0.0\n0.5,2.0\n1,1.0\n").unwrap();
    let text = r#"
title = "a magnet"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.disc.radius = 5.0
boundary.wall = "no-slip"
mesh = { size = 0.5 }
time.unsteady = { step = 0.02, end = 1.0 }
field.magnetic.components = [{ file = { path = "log.csv", time = "t", column = "b" } }, { constant = 1.0 }]
[[body]]
name = "disc"
shape.disc.radius = 1.0
center = [0.0, 0.0]
motion = "free"
magnetic_moment = [1.0, 0.0]
"#;
    fs::write(&path, text).unwrap();
    let case = read(&path, &[]);
    let field = case.magnetic_field().unwrap();
    assert_eq!(field.components[0].at(0.5)[0], 2.0);
    assert!(case.problem_keys().unwrap().contains_key("field.magnetic.components.0.cubic"));
}

/// A value of a column `q` is sign * scale * q + offset, in the unit of the column.
#[test]
fn angles_of_a_file_have_unit_sign_scale_and_offset() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.toml");
    fs::write(directory.path().join("log.csv"), "t,q\n0,0\n0.5,20\n1,10\n").unwrap();
    let with = |more: &str| {
        let text = CASE.replace("../log.csv", "log.csv");
        fs::write(&path, text.replace("column = \"q\"", &format!("column = \"q\", {more}")))
            .unwrap();
        Case::read(path.to_str().unwrap(), &[])
    };
    let angle = |more: &str, time: f64| {
        let model = with(more).unwrap().model;
        let JointKind::Bent { angle, .. } = &model.joints[0].kind else { panic!("{more}") };
        angle.at(time)[0]
    };
    for (more, time, exact) in [
        ("scale = 0.01", 0.5, 0.2),
        ("unit = \"deg\"", 1.0, 10_f64.to_radians()),
        ("unit = \"deg\", sign = -1, scale = 0.5, offset = 3", 0.5, -7_f64.to_radians()),
        ("unit = \"turn\", scale = 0.01", 1.0, 0.1 * std::f64::consts::TAU),
    ] {
        let error = angle(more, time) - exact;
        assert!(error.abs() < 1e-15, "{more}: {error:e}");
    }
    for (more, said) in [
        ("sign = 2", ["`sign` is 2", "scale"]),
        ("unit = \"grad\"", ["grad", "deg"]),
        ("factor = 2", ["factor", "scale"]),
    ] {
        let message = with(more).unwrap_err().to_string();
        assert!(said.iter().all(|part| message.contains(part)), "{more}: {message}");
    }
}
