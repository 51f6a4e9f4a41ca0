//! Cases as MJCF and URDF, and back: masses, places, motions; what is refused, by its line.

use std::path::Path;

use alewife::case::{Case, CaseFile, Severity, check, check_reduced};
use alewife::reduced::{RobotFormat, export, import, simulate};
use alewife::run::Series;

use super::read;

/// A free trunk, a fin on a skew hinge, a weight on a slider, a rod; a servo, a motor, a tendon, weight and buoyancy.
const ROBOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reduced/robot.toml");

fn exported(file: &CaseFile, format: RobotFormat) -> String {
    export(&file.model, &file.full_name(), format).unwrap().text
}

/// The case of a model, with a step and an end.
pub(super) fn imported(text: &str, settings: &[&str]) -> CaseFile {
    let found = import(text, "model.xml").unwrap_or_else(|remark| panic!("{remark}"));
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    let file = Case::parse("back.toml", &found.text, &settings).unwrap();
    let wrong: Vec<_> = check(&file).into_iter().chain(check_reduced(&file)).collect();
    assert!(wrong.iter().all(|one| one.severity != Severity::Error), "{wrong:?}");
    file
}

/// Largest difference of columns that both have, over the size of each, and how many there are.
struct Difference {
    off: f64,
    n: usize,
}

fn difference(one: &Series, other: &Series) -> Difference {
    let (mut largest, mut n) = (0.0_f64, 0);
    for name in &one.names {
        let (Some(a), Some(b)) = (one.column(name), other.column(name)) else { continue };
        let size = a.iter().fold(1e-3_f64, |size, value| size.max(value.abs()));
        for (a, b) in a.iter().zip(&b) {
            largest = largest.max((a - b).abs() / size);
        }
        n += 1;
    }
    Difference { off: largest, n }
}

#[test]
fn cases_come_back_from_mjcf_and_move_as_before() {
    let end = "time.unsteady.end=0.05";
    for (name, n_columns) in [("tendon-fish", 150), (ROBOT, 90)] {
        let file = read(name, &[end]);
        let back = imported(&exported(&file, RobotFormat::Mjcf), &[end]);
        for (one, other) in file.model.bodies.iter().zip(&back.model.bodies) {
            assert_eq!(one.name, other.name);
            let [a, b] = [one, other].map(|body| body.mass.unwrap());
            assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}");
            let off = one.pose_in_space().inverse() * other.pose_in_space();
            assert!(off.translation.vector.norm() < 1e-14, "{}: {off}", one.name);
            assert!(off.rotation.angle() < 1e-14, "{}: {off}", one.name);
        }
        let (first, second) = (simulate(&file.model).unwrap(), simulate(&back.model).unwrap());
        let Difference { off, n } = difference(&first, &second);
        assert!(off < 1e-10 && n >= n_columns, "{name}: {off} in {n} columns");
    }
}

/// The case of a model whose motors are told what to do: each joint by the line that stands above it as a comment.
fn on_command(text: &str) -> CaseFile {
    let found = import(text, "model.xml").unwrap().text;
    let mut lines: Vec<&str> = Vec::new();
    for line in found.lines() {
        match lines.last().and_then(|before| before.strip_prefix("# kind.")) {
            Some(_) => {
                let told = lines.pop().unwrap_or_default();
                lines.push(told.trim_start_matches("# "));
            }
            None => lines.push(line),
        }
    }
    Case::parse("back.toml", &lines.join("\n"), &[]).unwrap()
}

#[test]
fn a_case_comes_back_from_its_own_export_the_second_time_to_the_letter() {
    let text = exported(&read(ROBOT, &[]), RobotFormat::Mjcf);
    let back = on_command(&text);
    let again = exported(&back, RobotFormat::Mjcf);
    let body = |text: &str| text[text.find("<worldbody>").unwrap()..].to_owned();
    // Names of what is only seen and the last digits aside
    let (one, other) = (body(&text), body(&again));
    let words =
        |text: &str| -> Vec<String> { text.split(['"', ' ', '\n']).map(str::to_owned).collect() };
    let (one, other) = (words(&one), words(&other));
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => assert!((a - b).abs() < 1e-13 * a.abs().max(1.0), "{a} {b}"),
            _ => assert_eq!(a, b),
        }
    }
}

#[test]
fn bodies_and_hinges_come_back_from_urdf() {
    let file = read(ROBOT, &["fluid.gravity=[0, 0, 0]"]);
    let text = exported(&file, RobotFormat::Urdf);
    let back = imported(&text, &[]);
    let [one, other] = [&file, &back].map(|file| {
        let case = file.case();
        let total: f64 = case.body.iter().map(|body| body.mass.unwrap()).sum();
        let axes: Vec<String> = case.joint.iter().map(|joint| joint.child.clone()).collect();
        (total, axes)
    });
    assert!((one.0 / other.0 - 1.0).abs() < 1e-14);
    assert_eq!(one.1, other.1);
    // What URDF cannot have is named
    let notes = export(&file.model, "robot", RobotFormat::Urdf).unwrap().notes.join("\n");
    for what in ["springs", "motors", "tendons", "fluid", "start", "freely"] {
        assert!(notes.contains(what), "{what}: {notes}");
    }
}

/// A model as people write it: classes, degrees, capsules by their ends, masses by density, a part without a joint.
pub(super) const WRITTEN: &str = r#"<mujoco model="swimmer">
  <compiler angle="degree"/>
  <option timestep="0.001" gravity="0 0 0" density="1000" viscosity="0.0009"/>
  <default>
    <geom fluidshape="ellipsoid" density="1100"/>
    <default class="tail"><joint damping="0.002" stiffness="0.1"/><geom size="0.02"/></default>
  </default>
  <worldbody>
    <light pos="0 0 3"/>
    <body name="head">
      <freejoint/>
      <geom type="ellipsoid" size="0.1 0.03 0.04"/>
      <body name="battery" pos="-0.02 0 0.01"><geom type="box" size="0.02 0.01 0.01" mass="0.1" fluidshape="none"/></body>
      <body name="tail/1" pos="-0.1 0 0" childclass="tail">
        <joint name="bend" axis="0 0 2" range="-40 40" springref="5"/>
        <geom type="capsule" fromto="0 0 0 -0.12 0 0"/>
        <body name="tail/2" pos="-0.14 0 0">
          <joint name="flap" axis="0 0 1" ref="10"/>
          <geom type="capsule" fromto="0 0 0 -0.1 0.01 0" size="0.015"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="servo" joint="bend" kp="2" kv="0.1" ctrlrange="-0.5 0.5"/>
    <motor name="wheel" joint="flap" gear="3" ctrlrange="-1 1"/>
  </actuator>
</mujoco>"#;

#[test]
fn a_written_model_of_mujoco_becomes_a_case_that_runs() {
    let found = import(WRITTEN, "swimmer.xml").unwrap();
    let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    for note in [
        "13: <body name=\"battery\">: it has no joint: it is part of \"head\"",
        "14: <body name=\"tail/1\">: it is called \"tail-1\" in the case",
        "15: <joint name=\"bend\">: its limits are left out",
    ] {
        assert!(notes.iter().any(|one| one == note), "{note}\n{notes:#?}");
    }
    let geared = WRITTEN.replace("ref=\"10\"", "ref=\"10\" armature=\"0.25\"");
    let geared = imported(&geared, &[]);
    assert_eq!(geared.case().reduced_model().armature["tail-2"], 0.25);
    assert!(exported(&geared, RobotFormat::Mjcf).contains("armature=\"0.25\""));
    let damped = WRITTEN.replace("<freejoint/>", "<joint type='free' damping='0.1' armature='0'/>");
    let notes = import(&damped, "swimmer.xml").unwrap().notes;
    assert!(notes.iter().any(|one| one.to_string() == "11: <joint>: its `damping` is left out"));
    let file = imported(WRITTEN, &["time.unsteady.end=0.1"]);
    let case = file.case();
    let density = 1100.0;
    // A capsule of 0.12 by 0.02, and head with battery
    let capsule = std::f64::consts::PI * 0.02 * 0.02 * (0.12 + 4.0 / 3.0 * 0.02) * density;
    assert!((case.body[1].mass.unwrap() / capsule - 1.0).abs() < 1e-14);
    let head = 4.0 / 3.0 * std::f64::consts::PI * 0.1 * 0.03 * 0.04 * density;
    assert!((case.body[0].mass.unwrap() / (head + 0.1) - 1.0).abs() < 1e-14);
    let text = toml::to_string(&case.joint).unwrap_or_else(|_| format!("{:?}", case.joint));
    // Spring of the joint and of its servo: 0.1 (5 degrees - q) - 2 q - (0.002 + 0.1) q'
    assert!(text.contains("2.1") && text.contains("0.102"), "{text}");
    let series = simulate(&file.model).unwrap();
    let end = *series.column("tail-1.joint.angle").unwrap().last().unwrap();
    assert!(end > 1e-4 && end < 0.1 * 5_f64.to_radians(), "{end}");
    // Motors keep what they start with, or wait for what they are told
    assert!(file.model.commands.is_empty());
    let told = on_command(WRITTEN);
    assert_eq!(told.model.commands.names().len(), 2);
}

/// A joint whose coordinate is 10 degrees where the file has it: spring and servo pull by 0.1 (5 - 10) - 2 10 degrees there, in
/// place of 0.1 5.
#[test]
fn springs_and_targets_count_from_where_a_joint_does() {
    let end = |text: &str| {
        let series = simulate(&imported(text, &["time.unsteady.end=0.003"]).model).unwrap();
        *series.column("tail-1.joint.angle").unwrap().last().unwrap()
    };
    // Its neighbour is left to itself
    let alone = WRITTEN.replace("axis=\"0 0 1\" ref=\"10\"", "axis=\"0 0 1\" stiffness=\"0\"");
    let shifted = alone.replace("springref=\"5\"", "springref=\"5\" ref=\"10\"");
    // The way is proportional to the load so soon, but for the drag
    let ratio = end(&shifted) / end(&alone);
    assert!((ratio / -41.0 - 1.0).abs() < 0.02, "{ratio}");
}

#[test]
fn what_no_case_has_is_refused_by_its_line() {
    let with = |from: &str, to: &str| {
        assert!(WRITTEN.contains(from), "{from}");
        import(&WRITTEN.replace(from, to), "swimmer.xml").unwrap_err().to_string()
    };
    let cases = [
        ("<light pos=\"0 0 3\"/>", "<frame/>", "9: <frame>: <frame> in the world is not known"),
        (
            "axis=\"0 0 1\" ref=\"10\"",
            "type=\"ball\"",
            "18: <joint name=\"flap\">: joints of the type",
        ),
        (
            "axis=\"0 0 2\"",
            "axis=\"0 0 0\"",
            "15: <joint name=\"bend\">: `axis` has the length zero",
        ),
        ("axis=\"0 0 2\"", "axis=\"0 0\"", "15: <joint name=\"bend\">: `axis` has 2 numbers"),
        ("kp=\"2\"", "kp=\"two\"", "25: <position name=\"servo\">: `kp` has \"two\""),
        ("kp=\"2\"", "kp=\"-3\"", "25: <position name=\"servo\">: `kp` is -3"),
        (
            "joint=\"flap\" gear",
            "joint=\"flip\" gear",
            "26: <motor name=\"wheel\">: there is no joint",
        ),
        (
            "<geom type=\"capsule\" fromto=\"0 0 0 -0.12 0 0\"/>",
            "<geom type=\"mesh\" mesh=\"fin\"/>",
            "16: <geom>: the loads of a mesh are not known here",
        ),
        (
            "</actuator>",
            "</actuator><equality><connect body1=\"head\" anchor=\"0 0 0\"/></equality>",
            "27: <connect>: the reduced model is a tree",
        ),
        ("</mujoco>", "", "it is no XML"),
        ("<mujoco", "<mojoco", "it is no XML"),
    ];
    for (from, to, message) in cases {
        let found = with(from, to);
        assert!(found.contains(message), "{message}\n{found}");
        assert!(found.contains("\n  help: "), "{found}");
    }
    let other = import("<svg/>", "picture.svg").unwrap_err().to_string();
    assert!(other.contains("1: <svg>: it is no model that is known"), "{other}");
}

/// A file of URDF whose first link is the world: what floats in it is free, what is fixed is part of it.
#[test]
fn a_world_of_urdf_holds_what_floats_in_it() {
    let link = |name: &str, mass: f64| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.1 0 0'/><mass value='{mass}'/><inertia ixx='0.1' \
             ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.2'/></inertial></link>"
        )
    };
    let joint = |kind: &str, parent: &str, child: &str, more: &str| {
        format!(
            "<joint name='to-{child}' type='{kind}'><origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><parent \
             link='{parent}'/><child link='{child}'/>{more}</joint>"
        )
    };
    let text = [
        "<robot name='r'><link name='world'/>".to_owned(),
        link("base", 2.0) + &link("box", 0.5) + &link("arm", 1.0),
        joint("floating", "world", "base", ""),
        joint("fixed", "base", "box", ""),
        joint(
            "revolute",
            "base",
            "arm",
            "<axis xyz='0 2 0'/><dynamics damping='0.3'/><limit effort='1'/>",
        ),
        "</robot>".to_owned(),
    ]
    .concat();
    let found = import(&text, "r.urdf").unwrap();
    let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes.len(), 2, "{notes:?}");
    let case = imported(&text, &[]).case().clone();
    assert!((case.body[0].mass.unwrap() - 2.5).abs() < 1e-14);
    // 2 kg at 0.1 along x, and half a kilogram at 0.1 along y, one above
    let expected = [0.08, 0.02, 0.2];
    for (value, expected) in case.body[0].center_of_mass.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-14, "{value} {expected}");
    }
    assert_eq!(case.body[1].center, [0.0, 0.0, 2.0]);
    let loop_ = text.replace("link='base'/><child link='arm'", "link='arm'/><child link='box'");
    let error = import(&loop_, "r.urdf").unwrap_err().to_string();
    assert!(error.contains("two joints are above \"box\""), "{error}");
    let light = text.replace("<mass value='2'/>", "\n<mass value='-2'/>");
    let error = import(&light, "r.urdf").unwrap_err().to_string();
    assert!(error.contains("2: <mass>: `value` is -2\n  help: a number of 0 or more"), "{error}");
}

/// However deep a file is, it is read or refused.
#[test]
fn files_without_an_end_are_refused() {
    for (outer, inner) in [("worldbody", "body"), ("default", "default class='a'")] {
        let tag = inner.split(' ').next().unwrap_or_default();
        let text = format!(
            "<mujoco><{outer}>{}{}</{outer}></mujoco>",
            format!("<{inner}>").repeat(5000),
            format!("</{tag}>").repeat(5000)
        );
        assert!(import(&text, "deep.xml").is_err());
    }
}

#[test]
fn a_case_without_inertia_is_no_robot() {
    let file = read("purcell-three-link", &[]);
    let error = export(&file.model, "purcell", RobotFormat::Mjcf).unwrap_err().to_string();
    assert!(error.contains("navier-stokes"), "{error}");
}

#[test]
fn the_commands_write_whole_files_and_none_over_a_case() {
    let place = tempfile::tempdir().unwrap();
    let call = |words: &[&str]| {
        let out = super::Command::new(env!("CARGO_BIN_EXE_alewife"))
            .current_dir(place.path())
            .args(words)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&out.stdout).into_owned();
        (out.status.code(), text + &String::from_utf8_lossy(&out.stderr))
    };
    assert_eq!(call(&["export", "tendon-fish", "fish.xml"]).0, Some(0));
    assert_eq!(call(&["import", "fish.xml", "fish.toml"]).0, Some(0));
    let (code, text) = call(&["import", "fish.xml", "fish.toml"]);
    assert!(code == Some(2) && text.contains("--overwrite"), "{text}");
    assert_eq!(call(&["import", "fish.xml", "fish.toml", "--overwrite"]).0, Some(0));
    let (code, text) = call(&["export", "tendon-fish", "fish.mjb"]);
    assert!(code == Some(2) && text.contains(".urdf"), "{text}");
    let (code, text) = call(&["import", "none.xml", "none.toml"]);
    assert!(code == Some(66) && text.contains("none.xml"), "{text}");
    std::fs::write(place.path().join("bad.xml"), "<mujoco><worldbody/></mujoco>").unwrap();
    let (code, text) = call(&["import", "bad.xml", "bad.toml"]);
    assert!(code == Some(65) && text.contains("bad.xml:1: "), "{text}");
    assert!(!Path::new(&place.path().join("bad.toml")).exists());
}
