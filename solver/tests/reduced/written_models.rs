//! Models of `MuJoCo` as people write them: several joints of a body, and geoms of which nothing is said.

use alewife::reduced::{RobotFormat, export, import, simulate};

use super::exchange::{WRITTEN, imported};

/// Geoms that say nothing of the fluid have the loads of what they are, where they are.
#[test]
fn what_is_not_said_to_be_in_the_fluid_is_met_by_it_where_it_is() {
    let end = |text: &str| {
        let series = simulate(&imported(text, &["time.unsteady.end=0.05"]).model).unwrap();
        let last = |name: &str| *series.column(name).unwrap().last().unwrap();
        [last("tail-2.joint.angle"), last("head.y")]
    };
    let geom = r#"fromto="0 0 0 -0.1 0.01 0" size="0.015"/>"#;
    let with =
        |more: &str| WRITTEN.replace(geom, &format!("{}{more}/>", geom.trim_end_matches("/>")));
    let (told, untold) = (with(""), with(r#" fluidshape="none""#));
    assert_ne!(told, untold);
    assert_eq!(end(&told), end(&untold));
    let notes = import(&untold, "swimmer.xml").unwrap().notes;
    assert!(notes.iter().any(|one| one.to_string().contains("place of its largest geom")));
}

/// A trunk with a fin, which moves in a plane: freely, or on two slides and a hinge.
fn in_a_plane(joints: &str) -> String {
    format!(
        r#"<mujoco><option timestep="0.001"/><worldbody><body name="trunk">{joints}
        <geom type="ellipsoid" size="0.1 0.03 0.04"/>
        <body name="fin" pos="-0.1 0 0.02"><joint name="bend" axis="0 1 0" stiffness="0.8" springref="60"/>
        <geom type="capsule" fromto="0 0 0 -0.12 0 0" size="0.02"/></body></body></worldbody>
        <actuator><motor joint="{}" ctrlrange="-1 1"/></actuator></mujoco>"#,
        if joints.contains("turn") { "turn" } else { "bend" }
    )
}

/// All but the last joint of a body move bodies without mass, and it goes as one that is free does where nothing leads out
/// of the plane: to the second order of the steps, as its coordinates are others.
#[test]
fn several_joints_of_a_body_move_it_as_one_that_is_free() {
    let joints = r#"<joint name="along" type="slide" axis="1 0 0"/><joint name="up" type="slide" axis="0 0 1"/>
        <joint name="turn" axis="0 1 0"/>"#;
    let ends = |joints: &str, step: &str| {
        let settings = ["time.unsteady.end=0.2", step];
        let series = simulate(&imported(&in_a_plane(joints), &settings).model).unwrap();
        ["trunk.x", "trunk.z", "fin.joint.angle"]
            .map(|name| *series.column(name).unwrap().last().unwrap())
    };
    let off = ["time.unsteady.step=0.002", "time.unsteady.step=0.001"].map(|step| {
        let (free, led) = (ends("<freejoint/>", step), ends(joints, step));
        // It falls, and its fin has swung
        assert!(free[1] < -0.1 && free[2].abs() > 0.1, "{free:?}");
        (0..3).map(|k| (free[k] - led[k]).abs()).fold(0.0, f64::max)
    });
    assert!(off[1] < 1e-4 && off[1] < 0.3 * off[0], "{off:?}");
    let found = import(&in_a_plane(joints), "plane.xml").unwrap();
    let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|one| one.contains("trunk-1, trunk-2")), "{notes:?}");
    let file = imported(&in_a_plane(joints), &[]);
    let back = export(&file.model, "plane", RobotFormat::Mjcf).unwrap();
    assert!(!back.text.contains("NaN"), "{}", back.text);
    assert!(
        back.notes.iter().any(|one| one.contains("\"trunk-1\" has no mass")),
        "{:?}",
        back.notes
    );
    // The motor drives the joint it names
    let turned = found.text.split("[[joint]]").find(|text| text.contains("torque.constant"));
    assert!(turned.unwrap().contains("child = \"trunk\"\n"), "{}", found.text);
}

/// The first joint of a file is the one next to the parent: what comes later turns with it.
#[test]
fn joints_of_a_body_turn_it_in_the_order_of_the_file() {
    let text = r#"<mujoco><worldbody><body name="arm" pos="0 0 1"><joint axis="0 0 1"/><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02"/></body></worldbody>
        <keyframe><key qpos="0.3 0.5"/></keyframe></mujoco>"#;
    let file = imported(text, &[]);
    let arm = file.model.bodies.iter().find(|body| body.name == "arm").unwrap();
    let along = arm.pose_in_space().rotation * nalgebra::Vector3::x();
    let (a, b) = (0.3_f64, 0.5_f64);
    let wanted = nalgebra::Vector3::new(a.cos() * b.cos(), a.sin() * b.cos(), -b.sin());
    assert!((along - wanted).norm() < 1e-14, "{along} {wanted}");
}
