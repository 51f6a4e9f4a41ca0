//! Commands of a session: exact in time, its own, and refused where they cannot be.

use std::thread;

use alewife_core::case::{Asked, Model, Recording};
use alewife_core::run::{RunError, Session, Start, replay, simulate};

use super::{act, chain, targets};

fn open(model: &Model) -> Session<2> {
    Session::open(model, Vec::new()).unwrap()
}

fn observe(session: &Session<2>, name: &str) -> f64 {
    session.observe(&[name]).unwrap()[0]
}

/// The angle of a joint is what the law has exactly, at each step and whatever its size.
#[test]
fn angles_are_those_of_the_law_whatever_the_step() {
    let names = ["eel-1.joint.angle", "eel-1.joint.rate", "eel-3.joint.angle", "eel-3.joint.rate"];
    let angles = |settings: &str| {
        let mut session = open(&chain(settings));
        for (name, target) in ["eel.joint.1", "eel.joint.2"].iter().zip([-0.5, 9.0]) {
            session.command(name, target).unwrap();
        }
        let mut seen = Vec::new();
        for time in [0.1, 0.3] {
            session.advance_to(time).unwrap();
            let observed = session.observe(&names).unwrap();
            for (nth, name) in ["eel.joint.1", "eel.joint.2"].iter().enumerate() {
                let [value, rate, target] = session.commanded(name).unwrap();
                assert!((observed[2 * nth] - value).abs() < 1e-12, "{observed:?} {value}");
                assert!((observed[2 * nth + 1] - rate).abs() < 1e-10, "{observed:?} {rate}");
                // What is asked for is clipped
                assert_eq!(target, [-0.5, 0.6][nth]);
            }
            seen.push(observed);
        }
        seen
    };
    let [whole, adaptive] = ["", ", adaptive = { tolerance = 1e-2, largest = 0.1 }"].map(angles);
    for (one, other) in whole.iter().flatten().zip(adaptive.iter().flatten()) {
        assert!((one - other).abs() < 1e-10, "{whole:?} {adaptive:?}");
    }
    // Limited to 3 per time, and through a filter of 0.05: the lag of a ramp is twice that
    assert!((whole[0][0] - 0.1).abs() < 0.3 && whole[1][0] < -0.4, "{whole:?}");
}

#[test]
fn a_fork_goes_its_own_way_and_a_state_is_gone_back_to() {
    let mut session = open(&chain(""));
    act(&mut session, 0.2, 0.05);
    let saved = session.save().unwrap();
    let mut fork = session.fork().unwrap();
    act(&mut session, 0.4, 0.05);
    let expected = observe(&session, "eel.x");
    fork.command("eel.joint.1", -0.6).unwrap();
    fork.advance_to(0.4).unwrap();
    assert!((observe(&fork, "eel.x") - expected).abs() > 1e-6);
    assert_eq!(session.commanded("eel.joint.1").unwrap()[2], targets(session.time() - 0.05)[0]);
    for session in [&mut session, &mut fork] {
        session.restore(&saved).unwrap();
        assert_eq!(session.time(), 0.2);
        act(session, 0.4, 0.05);
        assert_eq!(observe(session, "eel.x").to_bits(), expected.to_bits());
    }
}

#[test]
fn ten_sessions_at_once_do_what_each_does_alone() {
    let model = chain("");
    let way = |nth: u32| {
        let mut session = open(&model);
        session.command("eel.joint.2", 0.05 * f64::from(nth)).unwrap();
        session.advance_to(0.1).unwrap();
        observe(&session, "eel.x").to_bits()
    };
    let together: Vec<u64> = thread::scope(|scope| {
        let all: Vec<_> = (0..10).map(|nth| scope.spawn(move || way(nth))).collect();
        all.into_iter().map(|one| one.join().unwrap()).collect()
    });
    assert_eq!(together, (0..10).map(way).collect::<Vec<_>>());
}

#[test]
fn the_flow_is_seen_as_it_is() {
    let mut session = open(&chain(""));
    session.command("eel.joint.2", 0.5).unwrap();
    session.advance_to(0.1).unwrap();
    let fields = session.fields();
    assert_eq!(fields.velocity.len(), fields.mesh.nodes.len());
    assert_eq!(fields.pressure.len(), fields.mesh.n_vertices);
    assert!(fields.velocity.iter().any(|velocity| velocity.norm() > 0.1));
    assert_eq!(observe(&session, "time"), 0.1);
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let model = chain("");
    let refused = |result: Result<(), RunError>, wanted: &str| {
        let message = result.unwrap_err().to_string();
        assert!(message.contains(wanted), "{message}");
    };
    let mut session = open(&model);
    refused(session.command("eel.joint.3", 0.1), "did you mean eel.joint.1, eel.joint.2?");
    refused(session.command("eel.joint.1", f64::NAN), "finite number");
    refused(session.command("eel.joint.1", f64::INFINITY), "finite number");
    session.advance_to(0.1).unwrap();
    refused(session.advance_to(0.05), "restore a state");
    refused(session.advance_to(7.0), "raise time.unsteady.end");
    refused(session.advance_to(f64::NAN), "give a time");
    refused(session.observe(&["eel.q"]).map(drop), "eel.");
    // None of it has done any harm
    session.command("eel.joint.1", 0.3).unwrap();
    session.advance_to(0.15).unwrap();

    let run = |recording: Option<&Recording>, model: &Model| {
        replay::<2>(model, Start { saved: None, recording }, &mut []).map(drop)
    };
    refused(simulate::<2>(&model, &mut []).map(drop), "eel.joint.1, eel.joint.2");
    let mut recording = Recording::default();
    recording.ask(Asked { time: 0.0, command: "eel.joint.4".to_owned(), target: 0.0 });
    refused(run(Some(&recording), &model), "there is no command `eel.joint.4`");
    // The past is not what is recorded
    let saved = session.save().unwrap();
    let start = Start { saved: Some(&saved), recording: Some(&Recording::default()) };
    refused(replay::<2>(&model, start, &mut []).map(drop), "repeat the recording from the start");
}

/// A run resumes with the values of a file that has become longer, and not with another past.
#[test]
fn a_stroke_may_go_on_for_longer() {
    let knots = |end: u32, factor: f64| {
        let value = |time: f64| 0.4 * factor * (5.0 * time).sin();
        let slope = |time: f64| 2.0 * factor * (5.0 * time).cos();
        let knot = |nth: u32| {
            let time = 0.1 * f64::from(nth);
            // As of a spline whose end is free
            let rate = if nth == end { 0.5 * slope(time) } else { slope(time) };
            format!("[{time}, {}, {rate}]", value(time))
        };
        (0..=end).map(knot).collect::<Vec<_>>().join(", ")
    };
    let model = |end: u32, factor: f64| {
        let key = "swimmer.0.kind.chain.joints";
        let time = 0.1 * f64::from(end);
        let (angle, other) = (knots(end, factor), "{ bent.angle = 0.0 }");
        let settings = [
            format!("{key}=[{{ bent.angle.cubic = [{angle}] }}, {other}]"),
            format!("time.unsteady.end={time}"),
        ];
        super::chain_with(&settings)
    };
    let mut session = open(&model(2, 1.0));
    session.advance_to(0.2).unwrap();
    let saved = session.save().unwrap();
    let mut longer = Session::<2>::resume(&model(3, 1.0), &saved, Vec::new()).unwrap();
    longer.advance_to(0.3).unwrap();
    assert!((observe(&longer, "eel-1.joint.angle") - 0.4 * 1.5f64.sin()).abs() < 1e-12);
    let other = Session::<2>::resume(&model(3, 1.1), &saved, Vec::new()).unwrap_err().to_string();
    assert!(other.contains("bent.angle.cubic"), "{other}");
}
