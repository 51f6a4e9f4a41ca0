//! The files of a run on a mesh of two triangles, written and read back.

mod damage;
mod failure;
mod frames;
mod two_triangles;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use self::two_triangles::two_triangles;
use super::*;
use crate::body::{Pose, Twist, Wrench};
use crate::case::{Case, Model};
use crate::run::{BodyReport, Observer, RunError, Snapshot};
use crate::step::FlowError;
use crate::timing::{Timing, cpu_seconds};

const CASE: &str = r#"
title = "Two triangles"
geometry = "planar"
[fluid]
model = "navier-stokes"
viscosity = 0.1
density = 1.0
[domain.channel]
length = 1.0
height = 1.0
[[body]]
name = "swimmer"
shape = { disc = { radius = 0.5 } }
center = [0.0, 0.0]
motion = "free"
gait = { squirmer = { modes = [1.0] } }
[mesh]
size = 1.0
[time.unsteady]
step = 0.1
end = 4.0
[output]
fields = { steps = 10 }
"#;

/// A run that is only looked at, never computed.
struct Run {
    model: Model,
    mesh: Mesh<2>,
    velocity: Vec<Point<2>>,
    pressure: Vec<f64>,
    names: Vec<String>,
    timing: Timing,
}

const STEPS: usize = 40;

impl Run {
    fn new() -> Self {
        let mesh = two_triangles();
        Self {
            model: Model::new(toml::from_str(CASE).unwrap()).unwrap(),
            // Vorticity of (-y^2 / 2 + x y, x^2) is 2 x - (x - y) = x + y.
            velocity: mesh
                .nodes
                .iter()
                .map(|x| Point::<2>::new(x.x * x.y - x.y * x.y / 2.0, x.x * x.x))
                .collect(),
            pressure: mesh.nodes[..mesh.n_vertices].iter().map(|x| x.x + 2.0 * x.y).collect(),
            mesh,
            names: vec!["swimmer.speed".to_owned(), "swimmer.force.x".to_owned()],
            timing: Timing { cpu: [1.0; 8], wall: [0.5; 8] },
        }
    }

    fn values(step: usize) -> Vec<f64> {
        vec![(step as f64).sqrt() / 3.0, -1.0e-17 * step as f64]
    }

    /// Shows one step to `everyone`.
    fn step(&self, everyone: &mut [Box<dyn Observer<2>>], step: usize) {
        let time = step as f64 * 0.1;
        let bodies = [BodyReport {
            name: "swimmer".to_owned(),
            pose: Pose::planar(0.3 * time, 0.0, 0.1 * time),
            twist: Twist { linear: Vector3::new(0.3, 0.0, 0.0), angular: Vector3::z() * 0.1 },
            load: Wrench::default(),
            surface_load: Wrench::default(),
            friction: 0.0,
            contact: Wrench::default(),
            power: 0.25,
            recoil: None,
        }];
        let snapshot = Snapshot {
            case: &self.model.case,
            step,
            time,
            time_step: 0.1,
            mesh: &self.mesh,
            velocity: &self.velocity,
            pressure: &self.pressure,
            tracers: &[],
            scalars: &[],
            bodies: &bodies,
            names: &self.names,
            values: &Self::values(step),
            n_dofs: 22,
            iterations: 1,
            step_errors: None,
            timing: &self.timing,
            is_last: step == STEPS,
        };
        for observer in everyone {
            observer.on_step(&snapshot).unwrap();
        }
    }

    /// A complete run in `path`.
    fn complete(&self, path: &Path) {
        let directory =
            RunDirectory::create(path, &self.model.case, Start::with_threads(1), Earlier::Keep)
                .unwrap();
        self.to_its_end(&mut everyone_at(&self.model, &directory, None));
    }

    /// Shows all steps and the end to `everyone`.
    fn to_its_end(&self, everyone: &mut [Box<dyn Observer<2>>]) {
        (0..=STEPS).for_each(|step| self.step(everyone, step));
        everyone.iter_mut().for_each(|observer| observer.on_end(&self.timing).unwrap());
    }
}

/// All observers without progress on the terminal.
fn everyone_at(
    model: &Model,
    directory: &RunDirectory,
    history: Option<&History>,
) -> Vec<Box<dyn Observer<2>>> {
    let shown = Shown { quiet: true, live: None };
    observers(model, directory, history, shown, &WriteTimes::default()).unwrap()
}

/// The files below `path`, sorted.
fn files(path: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(path).unwrap() {
        let entry = entry.unwrap().path();
        if entry.is_dir() { found.extend(files(&entry)) } else { found.push(entry) }
    }
    found.sort();
    found
}

/// What can be read of a `run.mcap`.
#[derive(Debug, PartialEq)]
struct Messages {
    all: Vec<Message>,
    /// Whether the file ends as it should.
    is_whole: bool,
}

#[derive(Debug, PartialEq)]
struct Message {
    topic: String,
    /// Nanoseconds.
    time: u64,
    content: serde_json::Value,
}

fn messages(bytes: &[u8]) -> Messages {
    let mut all = Vec::new();
    let options = [::mcap::read::Options::IgnoreEndMagic].into_iter().collect();
    for message in ::mcap::MessageStream::new_with_options(bytes, options).unwrap() {
        let Ok(message) = message else { return Messages { all, is_whole: false } };
        let content = serde_json::from_slice(&message.data).unwrap();
        let topic = message.channel.topic.clone();
        all.push(Message { topic, time: message.log_time, content });
    }
    let is_whole = ::mcap::Summary::read(bytes).is_ok_and(|summary| summary.is_some());
    Messages { all, is_whole }
}

#[test]
fn a_run_leaves_exactly_the_promised_files() {
    let place = tempfile::tempdir().unwrap();
    Run::new().complete(place.path());
    let name = |file: &PathBuf| file.strip_prefix(place.path()).unwrap().display().to_string();
    let names: Vec<String> = files(place.path()).iter().map(name).collect();
    assert_eq!(
        names,
        [
            ".alewife-run",
            "bodies.json",
            "case.toml",
            "fields/000000.vtu",
            "fields/000010.vtu",
            "fields/000020.vtu",
            "fields/000030.vtu",
            "fields/000040.vtu",
            "fields.pvd",
            "lock",
            "provenance.json",
            "run.mcap",
            "series.csv",
            "status.json",
        ]
    );
}

#[test]
fn the_resolved_case_reads_back_as_the_same_case() {
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    run.complete(place.path());
    let text = std::fs::read_to_string(place.path().join("case.toml")).unwrap();
    assert_eq!(toml::from_str::<Case>(&text).unwrap(), run.model.case);
}

#[test]
fn the_series_reads_back_to_the_last_bit() {
    let place = tempfile::tempdir().unwrap();
    Run::new().complete(place.path());
    let text = std::fs::read_to_string(place.path().join("series.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time,swimmer.speed,swimmer.force.x"));
    for step in 0..=STEPS {
        let row: Vec<f64> =
            lines.next().unwrap().split(',').map(|number| number.parse().unwrap()).collect();
        assert_eq!(row[0], step as f64 * 0.1);
        assert_eq!(row[1..], Run::values(step));
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn the_status_tells_state_and_cost() {
    while cpu_seconds() < 0.2 {} // Earlier work of the process
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    let directory =
        RunDirectory::create(place.path(), &run.model.case, Start::with_threads(1), Earlier::Keep)
            .unwrap();
    let mut everyone = everyone_at(&run.model, &directory, None);
    let before = Status::read(place.path()).unwrap();
    assert_eq!((before.state, before.step, before.steps), (RunState::Running, 0, Some(40)));

    run.to_its_end(&mut everyone);
    let after = Status::read(place.path()).unwrap();
    assert_eq!((after.state, after.step, after.dofs), (RunState::Finished, STEPS, 22));
    assert_eq!((after.time, after.end), (4.0, Some(4.0)));
    assert_eq!(after.cpu_seconds["factorisation"], 1.0);
    assert_eq!(after.wall_seconds["mesh_motion"], 0.5);
    assert!(after.wall_seconds["total"] >= 0.0 && after.cpu_seconds["total"] < cpu_seconds() - 0.1);
}

#[test]
fn a_killed_run_leaves_whole_files_and_readable_messages() {
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    let directory =
        RunDirectory::create(place.path(), &run.model.case, Start::with_threads(1), Earlier::Keep)
            .unwrap();
    let mut everyone = everyone_at(&run.model, &directory, None);
    (0..20).for_each(|step| run.step(&mut everyone, step));

    // What is on the disk now is what a kill would leave: nothing of this process is written any
    // more.
    let Messages { all, is_whole } =
        messages(&std::fs::read(place.path().join("run.mcap")).unwrap());
    assert!(!is_whole);
    let last = all.iter().rfind(|message| message.topic == "/step").unwrap();
    assert_eq!((last.time, &last.content["step"]), (1_600_000_000, &16.into()));
    assert_eq!(Status::read(place.path()).unwrap().state, RunState::Running);
    let series = std::fs::read_to_string(place.path().join("series.csv")).unwrap();
    assert!(series.is_empty() || series.ends_with('\n'));
    assert!(files(place.path()).iter().all(|file| !file.to_string_lossy().contains("unfinished")));
}

#[test]
fn messages_tell_every_step_of_every_body() {
    let place = tempfile::tempdir().unwrap();
    Run::new().complete(place.path());
    let bytes = std::fs::read(place.path().join("run.mcap")).unwrap();
    let Messages { all, is_whole } = messages(&bytes);
    assert!(is_whole);
    let mut count = BTreeMap::<&str, usize>::new();
    all.iter().for_each(|message| *count.entry(&message.topic).or_default() += 1);
    let expected = [
        ("/body/swimmer", 41),
        ("/forces", 41),
        ("/log", 2),
        ("/quantities/swimmer", 41),
        ("/scene", 1),
        ("/step", 41),
        ("/tf", 41),
        ("/walls", 1),
    ];
    assert_eq!(count, expected.into());

    let last = all.iter().rfind(|message| message.topic == "/body/swimmer").unwrap();
    assert_eq!(last.time, 4_000_000_000);
    let body = &last.content;
    assert_eq!(body["pose"]["center"]["x"], 0.3 * 4.0);
    assert_eq!(body["twist"]["angular"]["z"], 0.1);
    assert_eq!(body["power"], 0.25);
    let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.attachment_indexes[0].name, "case.toml");
    assert_eq!(summary.metadata_indexes[0].name, "provenance");
}

#[test]
fn two_runs_write_the_same_bytes_after_the_provenance() {
    let run = Run::new();
    let bytes = [(); 2].map(|()| {
        let place = tempfile::tempdir().unwrap();
        run.complete(place.path());
        // Both runs are of this process and, as a rule, of one second: only the second can differ.
        let provenance: Provenance =
            serde_json::from_slice(&std::fs::read(place.path().join("provenance.json")).unwrap())
                .unwrap();
        (std::fs::read(place.path().join("run.mcap")).unwrap(), provenance.origin.started_at)
    });
    let [(first, first_start), (second, second_start)] = bytes;
    assert_eq!(first.len(), second.len());
    assert_eq!(messages(&first), messages(&second));
    if first_start == second_start {
        assert!(first == second);
    }
}

#[test]
fn a_finished_run_is_refused_and_an_unfinished_one_replaced() {
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    let create = |earlier| {
        RunDirectory::create(place.path(), &run.model.case, Start::with_threads(1), earlier)
    };
    let held = create(Earlier::Keep).unwrap();
    assert!(matches!(create(Earlier::Replace), Err(RunDirectoryError::Lock(_))));
    drop(held);
    run.complete(place.path());
    assert!(matches!(create(Earlier::Keep), Err(RunDirectoryError::Finished { .. })));
    assert!(place.path().join("series.csv").exists());
    drop(create(Earlier::Replace).unwrap());
    assert!(!place.path().join("series.csv").exists());
}

#[test]
fn a_run_that_resumes_goes_on_in_its_files() {
    let (whole, halves) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let run = Run::new();
    run.complete(whole.path());
    let begin = |earlier| {
        RunDirectory::create(halves.path(), &run.model.case, Start::with_threads(1), earlier)
            .unwrap()
    };
    let mut everyone = everyone_at(&run.model, &begin(Earlier::Keep), None);
    (0..=17).for_each(|step| run.step(&mut everyone, step));
    let time = 17.0 * 0.1;
    let error = RunError::Flow(FlowError::Stopped { step: 17, time });
    everyone.iter_mut().for_each(|observer| observer.on_failure(&error, None).unwrap());

    let history = History::read(halves.path(), 17, time).unwrap();
    let directory = begin(Earlier::Continue);
    let mut everyone = everyone_at(&run.model, &directory, Some(&history));
    // A run that is killed at once still says that it has made steps
    assert_eq!(Status::read(halves.path()).unwrap().step, 17);
    (18..=STEPS).for_each(|step| run.step(&mut everyone, step));
    for file in ["series.csv", "fields.pvd"] {
        let read = |place: &Path| std::fs::read_to_string(place.join(file)).unwrap();
        assert_eq!(read(whole.path()), read(halves.path()), "{file}");
    }
    let reported = |place: &Path| {
        let mut found = messages(&std::fs::read(place.join("run.mcap")).unwrap());
        found.all.retain(|message| message.topic != "/log");
        found
    };
    assert_eq!(reported(whole.path()), reported(halves.path()));
}
