//! Why a run failed is in its status and its messages.

use super::*;

#[test]
fn a_failure_is_reported_with_its_reason() {
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    let directory =
        RunDirectory::create(place.path(), &run.model.case, Start::with_threads(1), Earlier::Keep)
            .unwrap();
    let mut everyone = everyone_at(&run.model, &directory, None);
    run.step(&mut everyone, 0);
    let error = RunError::Unsupported("mesh: no room between the bodies".to_owned());
    everyone.iter_mut().for_each(|observer| observer.on_failure(&error, None).unwrap());

    let status = Status::read(place.path()).unwrap();
    assert_eq!(status.state, RunState::Failed);
    assert_eq!(status.reason.as_deref(), Some("mesh: no room between the bodies"));
    let Messages { all, is_whole } =
        messages(&std::fs::read(place.path().join("run.mcap")).unwrap());
    assert!(is_whole);
    assert_eq!(all.last().unwrap().content["message"], "mesh: no room between the bodies");

    for observer in &mut everyone {
        observer
            .on_failure(&RunError::Flow(FlowError::Stopped { step: 0, time: 0.0 }), None)
            .unwrap();
    }
    assert_eq!(Status::read(place.path()).unwrap().state, RunState::Stopped);
}
