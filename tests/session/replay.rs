//! What was recorded of a session gives the same bits again.

use std::sync::{Arc, Mutex};

use alewife_core::case::{Case, Model, Recording};
use alewife_core::run::{
    Dimension, Observer, SavedState, Series, Session, Snapshot, Solve, Start, replay,
};

use super::{act, chain};

/// Keeps the state after each step.
struct States<const D: usize>(Arc<Mutex<Vec<SavedState<D>>>>);

impl<const D: usize> Observer<D> for States<D> {
    fn on_step(&mut self, _: &Snapshot<'_, D>) -> std::io::Result<()> {
        Ok(())
    }

    fn wants_state(&mut self, _: &Snapshot<'_, D>) -> bool {
        true
    }

    fn on_state(&mut self, state: &Arc<SavedState<D>>) -> std::io::Result<()> {
        self.0.lock().expect("nobody else holds it").push((**state).clone());
        Ok(())
    }
}

fn bits(series: &Series) -> Vec<Vec<u64>> {
    let rows = series.times.iter().zip(&series.rows);
    rows.map(|(time, row)| [time].into_iter().chain(row).map(|x| x.to_bits()).collect()).collect()
}

/// A session with pauses of a size, repeated from its start and from states on the way.
fn repeats<const D: usize>(model: &Model, pause: f64)
where
    Dimension<D>: Solve<D>,
{
    let states = Arc::new(Mutex::new(Vec::new()));
    let mut session =
        Session::<D>::open(model, vec![Box::new(States(Arc::clone(&states)))]).unwrap();
    act(&mut session, model_end(model), pause);
    assert!(session.is_over());
    let recording = Recording::parse(&session.recording().to_csv()).unwrap();
    assert_eq!(&recording, session.recording());
    let expected = bits(&session.close().unwrap().series);

    let again = |saved: Option<&SavedState<D>>| {
        let start = Start { saved, recording: Some(&recording) };
        bits(&replay(model, start, &mut []).unwrap().series)
    };
    let title = &model.case.title;
    assert!(again(None) == expected, "{title}: from the start");
    let states = states.lock().expect("nobody else holds it");
    for nth in [states.len() / 3, states.len() - 2] {
        assert!(again(Some(&states[nth])) == expected, "{title}: from state {nth}");
    }
}

fn model_end(model: &Model) -> f64 {
    match &model.case.time {
        alewife_core::case::TimeSettings::Unsteady(settings) => settings.end,
        alewife_core::case::TimeSettings::Steady(_) => 0.0,
    }
}

#[test]
fn a_session_of_fixed_steps_is_repeated_with_its_bits() {
    repeats::<2>(&chain(""), 0.05);
    // Pauses within steps
    repeats::<2>(&chain(""), 0.07);
}

#[test]
fn a_session_of_adaptive_steps_is_repeated_with_its_bits() {
    repeats::<2>(&chain(", adaptive = { tolerance = 1e-2, largest = 0.1 }"), 0.08);
}

/// Slip, arms, loads, sides and torques: what is asked for is a stroke or a factor of any kind.
#[test]
fn whatever_waits_is_repeated_with_its_bits() {
    let command = "{ start = 0.2, limits = [-1.0, 1.0], filter = 0.05 }";
    let arms = r#"
        geometry = "axisymmetric"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.cylinder = { radius = 4.0, x = [-5.0, 5.0] }
        boundary = { left = "no-slip", right = "no-slip", wall = "no-slip" }
        mesh = { size = 2.0, surface = 0.8 }
        time.unsteady = { step = 0.1, end = 0.3, scheme = "SCHEME" }
        [[swimmer]]
        name = "s"
        kind.linked-spheres = { radii = [0.5, 0.5, 0.5], arms = [
            { command = { start = 2.0, limits = [1.6, 2.6], filter = 0.1 } },
            { command = { start = 2.0, limits = [1.6, 2.6], filter = 0.1 } }] }
    "#;
    let others = r#"
        geometry = "planar"
        fluid = { model = "stokes", viscosity = 1.0 }
        domain.box = { min = [-3.0, -3.0], max = [3.0, 3.0] }
        boundary = { left = { velocity = { value = [0.0, 1.0], factor.command = COMMAND } }, right = "do-nothing",
                     bottom = "no-slip", top = "no-slip" }
        mesh = { size = 1.2, surface = 0.4 }
        time.unsteady = { step = 0.1, end = 0.3 }
        [[body]]
        name = "ball"
        shape.disc.radius = 0.5
        center = [-1.2, 0.3]
        motion = "free"
        force = [1.0, 0.0]
        load_factor.command = COMMAND
        gait.squirmer = { modes = [1.0, 0.5], factors = { 2.command = COMMAND }, turn.command = COMMAND }
        [[body]]
        name = "rower"
        shape.ellipse.semi_axes = [0.5, 0.2]
        center = [1.0, -0.5]
        motion = "free"
        [[body]]
        name = "arm"
        shape.ellipse.semi_axes = [0.5, 0.2]
        center = [2.2, -0.5]
        motion = "free"
        [[joint]]
        parent = "rower"
        child = "arm"
        on_parent = [0.6, 0.0]
        on_child = [-0.6, 0.0]
        kind.hinge = { stiffness = 1.0, torque.command = COMMAND }
    "#;
    for (text, names) in [
        (arms.replace("SCHEME", "bdf2"), vec!["s.joint.1", "s.joint.2"]),
        (arms.replace("SCHEME", "rk3"), vec!["s.joint.1", "s.joint.2"]),
        (
            others.replace("COMMAND", command),
            vec!["arm.joint", "ball.load", "ball.mode.2", "ball.turn", "left.factor"],
        ),
    ] {
        let text = format!("title = \"{}\"\n{text}", names[0]);
        let model = Case::parse("t.toml", &text, &[]).unwrap().model;
        assert_eq!(model.commands.names(), names);
        repeats::<2>(&model, 0.1);
    }
}
