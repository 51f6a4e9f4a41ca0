//! Cases by their reduced model: ways, names, balances, what is refused, and the command.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

mod calibration;
mod elongated;
mod exchange;
mod fish;
mod fitted_numbers;
mod guided;
mod mutations;
mod slopes;
pub mod tables;
mod vehicle;
mod written_models;

use std::process::Command;

use alewife::case::{Case, CaseFile, Severity, check, check_reduced, known_quantities};
use alewife::reduced::simulate;
use alewife::run::Series;

fn read(name: &str, settings: &[&str]) -> CaseFile {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Case::read(name, &settings).unwrap()
}

fn run(name: &str, settings: &[&str]) -> Series {
    let file = read(name, settings);
    assert!(check_reduced(&file).is_empty(), "{:?}", check_reduced(&file));
    simulate(&file.model).unwrap()
}

fn last(series: &Series, name: &str) -> f64 {
    *series.column(name).unwrap_or_else(|| panic!("no {name}")).last().unwrap()
}

/// Forces a length of the ratio 1.743: the way of a separate program, 0.8 % from that of the full solver.
#[test]
fn purcells_swimmer_goes_as_far_as_a_separate_program_says() {
    let series = run(
        "purcell-three-link",
        &["reduced.loads=resistive", "reduced.coefficients={ along = 1.0, across = 1.743 }"],
    );
    let [x, y] = ["x", "y"].map(|axis| last(&series, &format!("swimmer-2.{axis}")));
    assert!((x - 0.044_941).abs() < 2e-5 && (y - 0.012_087).abs() < 2e-5, "{x} {y}");
    // Nothing pulls at the whole, and what the pivots do is what the fluid takes
    for row in 0..series.times.len() {
        let at = |name: &str| series.column(name).unwrap()[row];
        let size = at("swimmer-1.force.x").hypot(at("swimmer-1.force.y")).max(1e-9);
        assert!(at("swimmer.force.x").hypot(at("swimmer.force.y")) < 1e-9 * size);
        let given = at("swimmer-1.joint.power") + at("swimmer-3.joint.power");
        assert!((given - at("swimmer.power")).abs() < 1e-9 * given.abs(), "{given}");
    }
}

#[test]
fn an_eel_has_the_names_of_a_full_run_and_obeys_newton() {
    let series = run("robot-eel", &[]);
    let known = known_quantities(&read("robot-eel", &[]).model);
    assert!(series.names.iter().all(|name| known.contains(name)), "{:?}", series.names);
    for name in ["eel-1.force.x", "eel-2.joint.torque", "eel.cycle.speed", "eel.power", "eel-3.x"] {
        assert!(series.names.iter().any(|one| one == name), "{name}");
    }
    assert!(!series.names.iter().any(|name| name.starts_with("flow.") || name.contains("thrust")));
    // It swims with its head in front, towards +x
    let speed = last(&series, "eel.cycle.speed");
    assert!(last(&series, "eel.cycle.x") > 0.05 && speed > 0.05, "{speed}");
    // The momentum of the eel changes by what the fluid does, and the work of its pivots is its own energy and
    // that on the fluid: over the last cycle both to the order of the steps
    let column = |name: &str| series.column(name).unwrap();
    let (force, velocity) = (column("eel.force.y"), column("eel.velocity.y"));
    let n = series.times.len();
    let from = n - 101;
    let impulse: f64 = (from..n - 1).map(|k| 0.005 * (force[k] + force[k + 1])).sum();
    let shift: f64 = (0..6).map(mass).sum::<f64>() * (velocity[n - 1] - velocity[from]);
    let size: f64 = (from..n - 1).map(|k| 0.01 * force[k].abs()).sum();
    assert!((impulse - shift).abs() < 0.02 * size, "{impulse} {shift} {size}");
    let given: f64 = (from + 1..n)
        .map(|k| {
            let joints = ["eel-1", "eel-2", "eel-4", "eel-5", "eel-6"];
            joints.iter().map(|one| 0.01 * column(&format!("{one}.joint.power"))[k]).sum::<f64>()
        })
        .sum();
    let taken = last(&series, "eel.cycle.power");
    assert!(given > 0.0 && (given / taken - 1.0).abs() < 0.05, "{given} {taken}");
}

/// Mass of a link of the robot eel: areas by the model.
fn mass(link: usize) -> f64 {
    let model = read("robot-eel", &[]).model;
    let body = &model.bodies[link];
    body.shape.outline().moments().unwrap().measure * body.density.unwrap_or(1.0)
}

#[test]
fn a_free_tail_follows_its_spring_and_a_scallop_comes_back() {
    let hinge = "swimmer.0.kind.chain.joints.4={ hinge = { stiffness = 5.0, damping = 0.1 } }";
    let series = run("robot-eel", &[hinge]);
    let bent = series.column("eel-6.joint.angle").unwrap();
    assert!(bent.iter().any(|angle| angle.abs() > 0.02) && bent.iter().all(|a| a.abs() < 2.0));
    let torque = series.column("eel-6.joint.torque").unwrap();
    let rate = series.column("eel-6.joint.rate").unwrap();
    for k in 0..bent.len() {
        assert!((torque[k] + 5.0 * bent[k] + 0.1 * rate[k]).abs() < 1e-12);
    }
    // Purcell's theorem in space: to and fro without inertia, it is back where it was
    let series = run("scallop-3d", &[]);
    let mut farthest = 0.0_f64;
    for axis in ["x", "y", "z"] {
        let way = series.column(&format!("scallop-1.{axis}")).unwrap();
        farthest = way.iter().fold(farthest, |most, x| most.max((x - way[0]).abs()));
    }
    for axis in ["x", "y", "z"] {
        let way = series.column(&format!("scallop-1.{axis}")).unwrap();
        assert!((way[way.len() - 1] - way[0]).abs() < 1e-4 * farthest && farthest > 0.1);
    }
}

#[test]
fn what_it_does_not_know_is_refused_by_key() {
    let wrong = |name: &str, settings: &[&str]| -> Vec<String> {
        let found = check_reduced(&read(name, settings));
        found
            .iter()
            .filter(|one| one.severity == Severity::Error)
            .map(|one| one.key.clone())
            .collect()
    };
    let eel = |setting: &str| wrong("robot-eel", &[setting]);
    assert_eq!(eel("contact.barrier={ range = 0.05, stiffness = 1.0 }"), ["contact"]);
    assert_eq!(eel("boundary.left={ velocity = { value = [0.1, 0.0] } }"), ["boundary.left"]);
    assert_eq!(eel("reduced={ loads = 'ellipsoid' }"), ["reduced.loads"]);
    assert_eq!(eel("reduced={ loads = 'resistive' }"), ["reduced.loads"]);
    let misspelt = "reduced={ loads = 'links', coefficients = { normal_linaer = 1.0 } }";
    assert_eq!(eel(misspelt), ["reduced.coefficients.normal_linaer"]);
    let negative = "reduced={ loads = 'links', coefficients = { added_mass = -1.0 } }";
    assert_eq!(eel(negative), ["reduced.coefficients.added_mass"]);
    let nobody = "reduced={ loads = 'links', body = { 'eel-9' = { added_mass = 1.0 } } }";
    assert_eq!(eel(nobody), ["reduced.body.eel-9"]);
    assert_eq!(eel("reduced={ loads = 'links', added_mass = 'full' }"), ["reduced.added_mass"]);
    assert_eq!(wrong("robot-eel/skin", &[]), ["swimmer.0.kind"]);
    assert!(wrong("tandem-fish", &[]).len() >= 2);
    assert!(wrong("squirmer-alone-2d", &[]).iter().any(|key| key.contains("gait")));
    assert!(wrong("sphere-in-tube/free-0.5", &[]).contains(&"geometry".to_owned()));
    // `check` says so where the case asks for the model, and only there
    let errors = |file: &CaseFile| check(file).iter().any(|one| one.severity == Severity::Error);
    assert!(errors(&read("robot-eel", &[misspelt])) && !errors(&read("tandem-fish", &[])));
}

#[test]
fn the_command_writes_a_series_once() {
    let place = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_alewife"));
        command.args(["run", "purcell-three-link", "--fidelity", "reduced"]).args(arguments);
        let output = command.current_dir(place.path()).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(run(&[]).0, Some(0));
    let series = place.path().join("runs/purcell-three-link-reduced/series.csv");
    let text = std::fs::read_to_string(series).unwrap();
    assert!(text.starts_with("time,swimmer-1.x,swimmer-1.y,") && text.lines().count() == 42);
    let (code, told) = run(&[]);
    assert!(code == Some(2) && told.contains("--overwrite"), "{told}");
    assert_eq!(run(&["--overwrite"]).0, Some(0));
    let (code, told) = run(&["--overwrite", "--continue"]);
    assert!(code == Some(2) && told.contains("--continue"), "{told}");
    let (code, told) = run(&["--set", "contact.barrier={ range = 0.01, stiffness = 1.0 }"]);
    assert!(code == Some(65) && told.contains("contact"), "{told}");
}

/// Targets come through limits and filter as in the full solver: the joint is where its command is.
#[test]
fn commands_are_repeated_from_a_recording() {
    let place = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let joint = "swimmer.0.kind.chain.joints.4={ bent.angle.command = { limits = [-0.5, 0.5], filter = 0.1 } }";
        let mut command = Command::new(env!("CARGO_BIN_EXE_alewife"));
        command.args(["run", "robot-eel", "--fidelity", "reduced", "--out", "eel", "--set", joint]);
        let output = command.args(arguments).current_dir(place.path()).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, told) = run(&[]);
    assert!(code == Some(65) && told.contains("--replay"), "{told}");
    let rows = "time,command,target\n0.0,eel.joint.5,0.3\n1.0,eel.joint.5,-2.0\n2.0,,\n";
    std::fs::write(place.path().join("commands.csv"), rows).unwrap();
    let (code, told) = run(&["--replay", "commands.csv"]);
    assert_eq!(code, Some(0), "{told}");
    let text = std::fs::read_to_string(place.path().join("eel/series.csv")).unwrap();
    let nth = text.lines().next().unwrap().split(',').position(|name| name == "eel-6.joint.angle");
    let number = |row: &str, nth: usize| row.split(',').nth(nth).unwrap().parse::<f64>().unwrap();
    let rows: Vec<[f64; 2]> =
        text.lines().skip(1).map(|row| [number(row, 0), number(row, nth.unwrap())]).collect();
    let at = |time: f64| 0.3 * (1.0 - (1.0 + time / 0.1) * (-time / 0.1).exp());
    for [time, angle] in rows.iter().filter(|[time, _]| *time <= 1.0) {
        assert!((angle - at(*time)).abs() < 1e-12, "{time} {angle}");
    }
    assert!(rows.last().is_some_and(|[_, angle]| (angle + 0.5).abs() < 1e-3));
    let rows = "time,command,target\n0.0,eel.joint.6,0.3\n";
    std::fs::write(place.path().join("commands.csv"), rows).unwrap();
    let (code, told) = run(&["--overwrite", "--replay", "commands.csv"]);
    assert!(code == Some(65) && told.contains("eel.joint.5"), "{told}");
}
