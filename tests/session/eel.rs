//! The robotic eel by commands that sample its sines swims as far as the case.

use std::f64::consts::PI;

use alewife_core::case::{Case, Model, Pivot, Stroke, SwimmerKind};
use alewife_core::run::{Session, simulate};

/// Time between samples (s), and the time constant of the filters (s).
const PAUSE: f64 = 0.02;
const FILTER: f64 = 0.12;

fn eel(settings: &[&str]) -> (Model, Vec<Stroke>) {
    let settings: Vec<String> = settings.iter().map(|&one| one.to_owned()).collect();
    let model = Case::read("robot-eel", &settings).unwrap().model;
    let SwimmerKind::Chain { joints, .. } = &model.case.swimmer[0].kind else { panic!("a chain") };
    let angle = |joint: &Pivot| match joint {
        Pivot::Bent { angle } => angle.clone(),
        Pivot::Hinge(_) => panic!("it is bent"),
    };
    let strokes = joints.iter().map(angle).collect();
    (model, strokes)
}

/// Way over a cycle at the end of the case, and of the same on command (links).
fn ways(settings: &[&str]) -> [f64; 2] {
    let (model, sines) = eel(settings);
    let command =
        format!("{{ bent.angle.command = {{ limits = [-1.0, 1.0], filter = {FILTER} }} }}");
    let joints = vec![command; sines.len()].join(", ");
    let joints = format!("swimmer.0.kind.chain.joints=[{joints}]");
    let (on_command, _) = eel(&[settings, &[&joints, "swimmer.0.period=1.0"]].concat());
    let mut session = Session::<2>::open(&on_command, Vec::new()).unwrap();
    while !session.is_over() {
        // It is held for a pause: what is due in its middle, and what the filter takes of it, is asked for
        let due = session.time() + 0.5 * PAUSE;
        for (nth, sine) in sines.iter().enumerate() {
            let [before, now, after] = [-1e-4, 0.0, 1e-4].map(|off| sine.at(due + off));
            let acceleration = (after[1] - before[1]) / 2e-4;
            let target = now[0] + 2.0 * FILTER * now[1] + FILTER * FILTER * acceleration;
            // What is held has a smaller fundamental than what it is sampled from
            let target = target * (PI * PAUSE) / (PI * PAUSE).sin();
            session.command(&format!("eel.joint.{}", nth + 1), target).unwrap();
        }
        session.advance_to((session.time() + PAUSE).min(session.end())).unwrap();
    }
    let summary = simulate::<2>(&model, &mut []).unwrap();
    let way = |x: &[f64], times: &[f64]| {
        let end = times[times.len() - 1];
        let from = times.iter().position(|time| *time > end - 1.0 - 1e-9).unwrap_or(0);
        x[x.len() - 1] - x[from]
    };
    let whole = way(&summary.series.column("eel.x").unwrap(), &summary.series.times);
    let series = session.close().unwrap().series;
    [whole, way(&series.column("eel.x").unwrap(), &series.times)]
}

/// Of the third cycle, on the mesh and with the steps of the case.
#[test]
#[ignore = "long: 200 s; small: sampled_sines_move_the_eel_as_the_sines_do"]
fn the_third_cycle_of_the_eel_on_command_is_that_of_the_case() {
    let [whole, sampled] = ways(&[]);
    println!("way of the third cycle: {whole:.5}, on command {sampled:.5}");
    assert!((sampled / whole - 1.0).abs() < 2e-3, "{sampled} {whole}");
}

/// On a coarse mesh in the viscous limit, a part of a cycle in which it is set in motion.
#[test]
fn sampled_sines_move_the_eel_as_the_sines_do() {
    let coarse = ["mesh.scale=3", "fluid.model=\"stokes\"", "time.unsteady.end=0.3"];
    let [whole, sampled] = ways(&coarse);
    println!("way: {whole:.6}, on command {sampled:.6}");
    assert!((sampled - whole).abs() < 0.02 * whole.abs(), "{sampled} {whole}");
}
