//! Calibrations of other numbers than coefficients: a twin of the fish, the case that is written, bad input.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

use alewife::case::{Case, CaseFile, Severity, check, check_starts};
use alewife::reduced::{calibrate, simulate};

use super::run;

const RATES: [(&str, f64); 2] = [("slow", 0.749), ("fast", 1.313)];

/// Ways of the same fish with other springs, another tail and another lift, rounded to a tenth of a millimetre.
fn records(place: &Path) {
    for (name, beat) in RATES {
        let rate = format!("reduced.servo.0.rate={}", beat * TAU);
        let springs: Vec<String> =
            (1..6).map(|nth| format!("joint.{nth}.kind.hinge.stiffness=0.55")).collect();
        let mut settings = vec!["reduced.coefficients.kutta=3.3", &rate];
        settings.extend(["time.unsteady.step=0.002", "time.unsteady.end=1"]);
        settings.extend(springs.iter().map(String::as_str));
        let series = run("tendon-fish", &settings);
        let columns = ["head.x", "tail4.y"].map(|name| series.column(name).unwrap());
        let mut text = "t,x,y\n".to_owned();
        for row in (0..series.times.len()).step_by(20) {
            let [x, y] = [0, 1].map(|k| 1e3 * columns[k][row]);
            text += &format!("{:.3},{x:.1},{y:.1}\n", series.times[row]);
        }
        fs::write(place.join(format!("{name}.csv")), text).unwrap();
    }
}

fn text(more: &str) -> String {
    let keys: Vec<String> =
        (1..6).map(|nth| format!("'joint.{nth}.kind.hinge.stiffness'")).collect();
    let mut text = format!(
        "extends = 'tendon-fish'\ntime.unsteady.step = 0.002\ntime.unsteady.end = 1\n\
         [calibration]\nfit = ['kutta']\nbounds = {{ kutta = [1.0, 6.0] }}\n{more}\n\
         [[calibration.parameter]]\nname = 'springs'\nkeys = [{}]\nbounds = [0.0, 2.0]\n",
        keys.join(", ")
    );
    for (name, beat) in RATES {
        text += &format!(
            "[[calibration.from]]\ncsv = '{name}.csv'\ntime = 't'\n\
             columns = {{ 'head.x' = 'x', 'tail4.y' = 'y' }}\n\
             units = {{ 'head.x' = 0.001, 'tail4.y' = 0.001 }}\nset = ['reduced.servo.0.rate={}']\n",
            beat * TAU
        );
    }
    text
}

fn written(place: &Path, text: &str) -> CaseFile {
    let path = place.join("fit.toml");
    fs::write(&path, text).unwrap();
    Case::read(path.to_str().unwrap(), &[]).unwrap()
}

#[test]
fn springs_and_a_coefficient_are_found_and_the_case_runs() {
    let place = tempfile::tempdir().unwrap();
    records(place.path());
    let file = written(place.path(), &text("differences = 0.02"));
    let result = calibrate(&file).unwrap();
    assert_eq!(result.names, ["kutta", "springs"]);
    for (value, expected) in result.fit.parameters.iter().zip([3.3, 0.55]) {
        assert!((value / expected - 1.0).abs() < 0.02, "{:?}", result.fit);
    }
    fs::write(place.path().join("found.toml"), result.run().unwrap()).unwrap();
    let found = Case::read(place.path().join("found.toml").to_str().unwrap(), &[]).unwrap();
    assert_eq!(found.number("joint.3.kind.hinge.stiffness"), Some(result.fit.parameters[1]));
    let reduced = found.case().reduced_model();
    assert_eq!(reduced.coefficients["kutta"], result.fit.parameters[0]);
    assert!(simulate(&found.model).is_ok());

    // The coefficients belong to these springs
    fs::write(place.path().join("calibrated.toml"), result.to_toml()).unwrap();
    let other = "extends = 'tendon-fish'\nreduced.calibrated = { file = 'calibrated.toml' }\n";
    fs::write(place.path().join("other.toml"), other).unwrap();
    let error = Case::read(place.path().join("other.toml").to_str().unwrap(), &[]).unwrap_err();
    assert!(error.to_string().contains("other numbers than coefficients"), "{error}");
}

/// The same bits on one thread and on two, and as a search in one go and in two.
#[test]
fn a_search_for_numbers_is_taken_up_again() {
    let place = tempfile::tempdir().unwrap();
    records(place.path());
    let search = |n: usize| {
        format!("search = {{ proposer = 'cma-es', evaluations = {n}, halvings = 1, seed = 3 }}")
    };
    let calibrate_to = |n: usize, out: &str, threads: &str| {
        written(place.path(), &text(&search(n)));
        let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(["calibrate", "fit.toml", "--out", out])
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(place.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(place.path().join(out).join("case.toml")).unwrap()
    };
    let whole = calibrate_to(12, "whole", "1");
    calibrate_to(6, "parts", "2");
    fs::remove_file(place.path().join("parts/calibrated.toml")).unwrap();
    assert_eq!(calibrate_to(12, "parts", "2"), whole);
}

#[test]
fn numbers_that_cannot_be_fitted_are_refused_by_key() {
    let place = tempfile::tempdir().unwrap();
    records(place.path());
    let wrong = |text: &str| -> Vec<String> {
        let file = written(place.path(), text);
        let found = check(&file).into_iter().chain(check_starts(&file));
        let errors = found.filter(|one| one.severity == Severity::Error);
        errors.map(|one| one.key).collect()
    };
    let good = text("differences = 0.02");
    assert!(wrong(&good).is_empty(), "{:?}", wrong(&good));
    let differs = |from: &str, to: &str| wrong(&good.replace(from, to));
    assert_eq!(wrong(&text("")), ["calibration.parameter"]);
    assert_eq!(differs("[0.0, 2.0]", "[0.7, 2.0]"), ["calibration.parameter.0.bounds"]);
    assert_eq!(differs("[0.0, 2.0]", "[2.0, 0.1]"), ["calibration.parameter.0.bounds"]);
    assert_eq!(differs("'joint.3.kind", "'joint.9.kind"), ["calibration.parameter.0.keys.2"]);
    assert_eq!(differs("'joint.3.kind", "'joint.2.kind"), ["calibration.parameter.0.keys.2"]);
    assert_eq!(differs("name = 'springs'", "name = 'kutta'"), ["calibration.parameter.0.name"]);
    let coefficient = "'reduced.coefficients.slender', 'joint.3.kind";
    assert_eq!(differs("'joint.3.kind", coefficient), ["calibration.parameter.0.keys.2"]);
    assert_eq!(
        differs("'joint.3.kind", "'time.unsteady.end', 'joint.3.kind")[0],
        "calibration.parameter.0.keys.2"
    );
    let of_run = good.replacen("csv = 'slow.csv'", "run = 'slow'", 1);
    assert!(wrong(&of_run).contains(&"calibration.from.0.run".to_owned()));
}
