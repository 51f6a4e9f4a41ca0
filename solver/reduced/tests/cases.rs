//! Soft cases from their files: motions, gradients by key, records, searches and what is refused.

use std::fs;

use alewife_case::soft::search::ObjectiveSpec;
use alewife_case::soft::{SoftFile, check};
use alewife_reduced::search::Sought as _;
use alewife_reduced::tier::{
    Job, Kind, Model, Perturbed, Rounds, Seeker, TierError, Which, series,
};
use tempfile::TempDir;

use crate::bar::{BAR, Folder, agrees, record, sought};

/// Derivatives by all keys that a case has, against central differences.
#[test]
fn derivatives_by_every_key_are_those_of_differences() {
    let folder = Folder::new(BAR, &record());
    let keys = [
        ("young", "solid.0.material.young", 1e4),
        ("poisson", "solid.0.material.poisson", 0.1),
        ("stiffness", "solid.0.fibre.0.stiffness", 1e5),
        ("mean", "solid.0.fibre.0.stretch.wave.mean", 0.1),
        ("amplitude", "solid.0.fibre.0.stretch.wave.amplitude", 0.1),
        ("frequency", "solid.0.fibre.0.stretch.wave.frequency", 1.0),
        ("phase", "solid.0.fibre.0.stretch.wave.phase", 0.1),
        ("drag", "loads.drag.bezier.2", 1.0),
        ("thrust", "loads.thrust.bezier.3", 1.0),
    ];
    let file = folder.read(&[]);
    let sought = sought(&file, &keys);
    let model = Model::<2>::new(&file).expect("it is a body");
    let optimisation = file.case.optimisation.as_ref().expect("it has one").objective.clone();
    let way_per_work =
        ObjectiveSpec::WayPerWork { direction: vec![1.0, 0.5], standing_power: 0.0, after: None };
    let tapered = ObjectiveSpec::WayPerWork {
        direction: vec![1.0, 0.5],
        standing_power: 0.3,
        after: Some(0.13),
    };
    let calibration = Kind::Calibration(model.tracks(model.recorded.as_ref().expect("it has one")));
    let objectives = [optimisation, way_per_work, tapered].map(Kind::Optimisation);
    for kind in [calibration].into_iter().chain(objectives) {
        let mut seeker = Seeker { model: model.clone(), sought: sought.clone(), kind };
        let start: Vec<f64> = sought.bounded.iter().map(|one| one.start).collect();
        let found = seeker.evaluate(&start).expect("it moves");
        if let Kind::Optimisation(objective) = &seeker.kind {
            // The same by frames, as the series has it
            let mut model = seeker.model.clone();
            let own = model.case.optimisation.as_mut().expect("it has one");
            own.objective = objective.clone();
            let motion = model.body.simulate(&model.plan).expect("it moves");
            let table = series(&model, &motion).expect("it has a series");
            let last = table.last("objective").expect("it is a column");
            assert!((last / -found.objective - 1.0).abs() < 1e-9, "{last} {}", found.objective);
        }
        agrees(&mut seeker, &start, &keys, &found.slopes);
    }
}

#[test]
fn energy_put_in_by_the_fibres_is_what_there_is_and_what_was_lost() {
    let folder = Folder::new(BAR, &record());
    // In vacuum, undamped, and driven so gently that the steps resolve it: nothing is lost
    let mut file = folder.read(&[
        "soft.scheme=bdf2",
        "soft.frame=0.002",
        "soft.frames=120",
        "solid.0.material.viscosity=0.0",
        "solid.0.fibre.0.stretch.wave={amplitude=0.02, frequency=1.0, ramp=0.2}",
    ]);
    file.case.loads = None;
    file.case.record = None;
    file.case.calibration = None;
    file.case.marker[0].columns = Default::default();
    let model = Model::<2>::new(&file).expect("it is a body");
    let motion = model.body.simulate(&model.plan).expect("it moves");
    let table = series(&model, &motion).expect("it has energies");
    let last = |name: &str| table.last(name).expect("it is a column");
    let there = last("energy.kinetic") + last("energy.elastic");
    assert!((there / last("work") - 1.0).abs() < 0.02, "{there} {}", last("work"));
    let all = vec![1.0; model.plan.targets.len()];
    assert!((model.body.work(&model.plan, &motion, &all) / last("work") - 1.0).abs() < 1e-12);
}

#[test]
fn a_calibration_finds_the_number_of_the_model_that_made_the_record() {
    let folder = Folder::new(BAR, &record());
    let robot = folder.read(&["solid.0.material.young=6e4", "record.gaps=kept"]);
    let model = Model::<2>::new(&robot).expect("it is a body");
    let motion = model.body.simulate(&model.plan).expect("it moves");
    let table = series(&model, &motion).expect("it has markers");
    let column = |name: &str| table.names.iter().position(|own| own == name).expect("it is there");
    let (x, y) = (column("tip.x"), column("tip.y"));
    let mut text = "time (ms),tip x,tip y\n".to_owned();
    for row in &table.rows {
        text += &format!("{:.6},{:?},{:?}\n", 1e3 * row[0], 1e3 * row[x], -1e3 * row[y]);
    }
    fs::write(folder.0.path().join("record.csv"), text).expect("it is written");
    let file = folder.read(&[]);
    let seek = |out: &std::path::Path| {
        let job = Job::<2>::new(&file, Which::Calibration).expect("it is a search");
        job.seek(out, &mut |_| ()).expect("it searches")
    };
    let out = TempDir::new().expect("there is room");
    let whole = seek(out.path());
    let young = whole.found.best.values[0];
    assert!((young / 6e4 - 1.0).abs() < 1e-3, "{young}");
    let known = whole.certainties.as_ref().expect("it is known");
    assert!(known[0].is_determined, "{known:?}");
    // Killed in the middle of a line, it goes on to the same bits
    let journal = out.path().join("search.journal");
    let written = fs::read_to_string(&journal).expect("it is text");
    let lines: Vec<&str> = written.lines().collect();
    assert!(lines.len() > 4, "{written}");
    fs::write(&journal, format!("{}\n{}", lines[..3].join("\n"), &lines[3][..9])).expect("written");
    let again = seek(out.path());
    assert_eq!(again.found, whole.found);
    assert_eq!(fs::read_to_string(&journal).expect("it is text"), written);
    // What is written runs, with what was found
    whole.write(out.path(), &file, Which::Calibration).expect("it is written");
    let result = out.path().join("case.toml").display().to_string();
    let result = SoftFile::read(&result, &[]).expect("it is a case");
    assert_eq!(result.case.solid[0].material.young, young);
    assert!(check(&result).is_empty());
    assert!(Model::<2>::new(&result).is_ok());
}

#[test]
fn rounds_with_a_robot_close_the_gap() {
    let folder = Folder::new(BAR, &record());
    let file =
        folder.read(&["optimisation.search.evaluations=4", "calibration.search.evaluations=12"]);
    let mut rounds = Rounds::<2>::new(&file).expect("it is a loop");
    let mut robot = Perturbed::<2>::new(&file).expect("it has a robot");
    let out = TempDir::new().expect("there is room");
    let mut told = |_: &str, _: &_| ();
    let mut round =
        |number| rounds.round(number, out.path(), &mut robot, &mut told).expect("it goes round");
    let (first, second) = (round(1), round(2));
    assert!((first.calibrated[0] / 6e4 - 1.0).abs() < 1e-2, "{first:?}");
    let gap = |round: &alewife_reduced::tier::Round| (round.robot - round.model).abs();
    assert!(gap(&second) < 0.1 * gap(&first), "{first:?} {second:?}");
    assert!(second.robot >= first.robot, "{first:?} {second:?}");
}

/// The first thing that is wrong with a case, with its key and line.
fn said(case: &str, record: &str) -> String {
    let folder = Folder::new(case, record);
    let found = match SoftFile::read(&folder.case().display().to_string(), &[]) {
        Err(error) => return error.to_string(),
        Ok(file) => match Model::<2>::new(&file) {
            Err(TierError::Case(found)) => found,
            Err(other) => return other.to_string(),
            Ok(_) => match Job::<2>::new(&file, Which::Calibration) {
                Err(TierError::Case(found)) => found,
                _ => Vec::new(),
            },
        },
    };
    found.first().map_or_else(String::new, |one| format!("{} | {one}", one.key))
}

#[test]
fn wrong_cases_and_records_are_refused_with_key_line_and_remedy() {
    let good = record();
    assert_eq!(said(BAR, &good), "");
    let row = |k: usize, text: &str| {
        let mut rows: Vec<&str> = good.lines().collect();
        rows[k] = text;
        rows.join("\n") + "\n"
    };
    let changed = |from: &str, to: &str| {
        assert!(BAR.contains(from), "{from}");
        BAR.replace(from, to)
    };
    let cases = [
        (
            changed("bounds = [1e4, 1e6]", "bounds = [5e4, 1e6]"),
            good.clone(),
            "calibration.parameter.0.bounds",
            "not between its bounds",
        ),
        (
            changed("[0.05, 0.05, 1.85, 2.05]", "[0.05, 1.85, 2.05]"),
            good.clone(),
            "loads.drag.bezier",
            "a Bezier curve has four",
        ),
        (
            changed("frames = 12", "frames = 14"),
            good.clone(),
            "soft.frames",
            "write soft.frames = 13 or less",
        ),
        (
            changed("x = \"tip x\"", "x = \"nose x\""),
            good.clone(),
            "marker.0.columns.x",
            "its columns: tip x, tip y",
        ),
        (
            changed("at = [0.0, 0.06]", "at = [0.0, 0.6]"),
            good.clone(),
            "marker.0.at",
            "give a place on the solid at rest (m): x from 0.0000 to 0.0120, y from -0.0600 to 0.0600",
        ),
        (
            changed("[robot.set]", "[robot.set]\n\"solid.0.material.yong\" = 1.0"),
            good.clone(),
            "robot.set.solid.0.material.yong",
            "case.toml:58:27",
        ),
        (
            changed("cost_of_work = 0.01", "after = 0.4"),
            good.clone(),
            "optimisation.objective.travel.after",
            "write at most 0.32, 4 frames before the end",
        ),
        (
            changed("objective.travel]", "objective.way-per-work]")
                .replace("cost_of_work = 0.01", "standing_power = -1.0"),
            good.clone(),
            "optimisation.objective.way-per-work.standing_power",
            "write 0 or a number above it",
        ),
        (
            changed("young = 4e4", "young = nan"),
            good.clone(),
            "solid.0.material.young",
            "not a finite number",
        ),
        (
            changed("poisson = 0.3", "poisson = 0.5"),
            good.clone(),
            "solid.0.material.poisson",
            "write order = \"quadratic\"",
        ),
        (changed("frame = 0.04", "frame = 0.05"), good.clone(), "soft.frame", "time between rows"),
        (
            changed("amplitude = 0.04", "amplitude = 0.95"),
            good.clone(),
            "solid.0.fibre.0.stretch.wave.amplitude",
            "a stretch is above 0",
        ),
        (
            changed("to = [0.006, 0.06]", "to = [-0.006, 0.06]"),
            good.clone(),
            "solid.0.fibre.0.region",
            "widen the region",
        ),
        (
            changed("keys = [\"solid.0.material.young\"]", "keys = [\"solid.0.material.density\"]"),
            good.clone(),
            "calibration.parameter.0.keys.0",
            "accepted: solid.0.material.young",
        ),
        (
            changed("bounds = [0.001, 0.05]\nscale = 0.01", "bounds = [0.0, 0.05]"),
            good.clone(),
            "optimisation.parameter.0.bounds",
            "add `scale`",
        ),
        (BAR.to_owned(), row(4, "120,NaN,0.1"), "record.file", "row 5"),
        (BAR.to_owned(), row(4, "80,0.3,0.1"), "record.file", "does not rise"),
        (
            BAR.to_owned(),
            row(4, "135,0.3,0.1"),
            "record.file",
            "row 5 of the record is 5.5000e-2 s",
        ),
        (BAR.to_owned(), row(4, "120,0.3"), "record.file", "2 values where the header names 3"),
    ];
    for (case, record, key, says) in cases {
        let found = said(&case, &record);
        assert!(found.starts_with(key) && found.contains(says), "{key}, {says}: {found}");
        assert!(found.contains("case.toml:"), "{found}");
    }
    let kept = changed("length_unit = 1e-3", "length_unit = 1e-3\ngaps = \"kept\"");
    assert_eq!(said(&kept, &row(4, "120,NaN,0.1")), "");
    assert!(said(&kept, &row(1, "0,NaN,0.1")).contains("begin at another one"));
}
