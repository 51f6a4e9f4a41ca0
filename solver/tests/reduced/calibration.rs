//! Calibrations of reduced models: a synthetic twin, loads of a run, the file that is written, bad input.

use std::path::Path;
use std::process::Command;

use alewife::case::{Case, CaseFile, Severity, check, check_starts};
use alewife::reduced::{Calibrated, Deviation, calibrate, check_records};

use super::read;

fn found(result: &Calibrated, name: &str) -> f64 {
    let nth = result.names.iter().position(|one| one == name).unwrap();
    result.fit.parameters[nth]
}

fn deviation<'a>(result: &'a Calibrated, record: &str, quantity: &str) -> &'a Deviation {
    let is_it = |one: &&Deviation| one.record == record && one.quantity == quantity;
    result.deviations.iter().find(is_it).unwrap_or_else(|| panic!("{record} {quantity}"))
}

/// The records were made with 0.7, 4.5 and 0.5, and are rounded to a tenth of a millimetre and a hundredth of a degree.
#[test]
fn a_twin_gets_its_coefficients_back_from_one_swim() {
    let exact = calibrate(&read("eel-calibration", &[])).unwrap();
    let expected = [("added_mass", 0.7), ("normal_quadratic", 4.5), ("tangential_quadratic", 0.5)];
    let result = calibrate(&read("eel-calibration", &["calibration.differences=0.02"])).unwrap();
    for (name, _) in expected {
        assert!((found(&result, name) / found(&exact, name) - 1.0).abs() < 1e-3, "{name}");
    }
    let result = exact;
    for (nth, (name, expected)) in expected.into_iter().enumerate() {
        let (value, error) = (found(&result, name), result.fit.uncertainties[nth]);
        assert!((value / expected - 1.0).abs() < 0.02, "{name}: {value} +- {error}");
        assert!(error > 0.0 && error < 0.02 * value, "{name}: {value} +- {error}");
    }
    for (record, held_out) in [("record-slow.csv", false), ("record-fast.csv", true)] {
        let way = deviation(&result, record, "eel-1.x in all");
        assert!(way.is_held_out == held_out && way.relative.abs() < 0.01, "{way:?}");
        assert!(deviation(&result, record, "eel-1.x apart, rms").model < 1e-3);
    }
}

/// A run by the model itself in a directory: loads are linear in coefficients, and found but for differences in time.
#[test]
fn loads_of_a_run_give_the_coefficients_it_was_made_with() {
    let place = tempfile::tempdir().unwrap();
    let made = "reduced={ loads = 'links', coefficients = { added_mass = 0.8, normal_linear = 15.0, \
                normal_quadratic = 6.0, tangential_linear = 12.0, tangential_quadratic = 0.7 } }";
    let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["run", "robot-eel", "--fidelity", "reduced", "--out", "sweep/first", "--set", made])
        .args(["--set", "time.unsteady.step=0.0025"])
        .current_dir(place.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = "extends = 'robot-eel'
[calibration]
fit = ['added_mass', 'normal_linear', 'normal_quadratic', 'tangential_linear', 'tangential_quadratic']
from = [{ run = 'sweep' }]
";
    let file = written(place.path(), "case.toml", text);
    let result = calibrate(&file).unwrap();
    let expected = [0.8, 15.0, 6.0, 12.0, 0.7];
    for ((name, value), expected) in result.names.iter().zip(&result.fit.parameters).zip(expected) {
        assert!((value / expected - 1.0).abs() < 0.05, "{name}: {value} {expected}");
    }
    let loads = deviation(&result, "sweep/first", "loads of bodies apart, rms");
    assert!(loads.relative < 0.05, "{loads:?}");
    for quantity in ["eel.cycle.speed", "eel.cycle.power", "eel.cycle.cost_of_transport", "eel way"]
    {
        let one = deviation(&result, "sweep/first", quantity);
        assert!(one.relative.abs() < 0.05, "{one:?}");
    }
}

fn written(place: &Path, name: &str, text: &str) -> CaseFile {
    let path = place.join(name);
    std::fs::write(&path, text).unwrap();
    Case::read(path.to_str().unwrap(), &[]).unwrap()
}

#[test]
fn the_file_is_taken_by_its_case_and_by_no_other() {
    let place = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["calibrate", "eel-calibration", "--out", "."])
        .current_dir(place.path())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(told.contains("held out") && told.contains("added_mass"), "{told}");
    let text = std::fs::read_to_string(place.path().join("calibrated.toml")).unwrap();
    let table: toml::Table = text.parse().unwrap();
    let facts = table["calibrated"].as_table().unwrap();
    assert_eq!(facts["from"].as_array().unwrap().len(), 2, "{text}");
    assert!(facts["coefficient"][0]["uncertainty"].as_float().unwrap() > 0.0);
    let own = "extends = 'eel-calibration'\nreduced.calibrated.file = 'calibrated.toml'\n";
    let file = written(place.path(), "own.toml", own);
    // The later over the earlier: the file over what the case that is extended has, and what is set over the file
    let taken = |file: &CaseFile| file.case().reduced_model().coefficients_of("");
    assert!((taken(&file)[0] / 0.7 - 1.0).abs() < 0.02, "{:?}", taken(&file));
    let path = place.path().join("own.toml").display().to_string();
    let changed = Case::read(&path, &["reduced.coefficients.added_mass=0.9".to_owned()]).unwrap();
    assert_eq!(taken(&changed)[0], 0.9);
    assert_eq!(taken(&changed)[2], taken(&file)[2]);
    let set =
        format!("reduced.calibrated.file='{}'", place.path().join("calibrated.toml").display());
    assert_eq!(
        taken(&Case::read("eel-calibration", std::slice::from_ref(&set)).unwrap()),
        taken(&file)
    );
    // Also over what a body has of its own, and over an older file in a case as it was run
    let body = "extends = 'body.toml'\nreduced.calibrated.file = 'calibrated.toml'\n";
    let older = file.case().to_toml().unwrap();
    std::fs::write(place.path().join("body.toml"), older).unwrap();
    let newer = text.replace("added_mass = 0.", "added_mass = 1.");
    std::fs::write(place.path().join("newer.toml"), newer).unwrap();
    let newer = body.replace("calibrated.toml", "newer.toml");
    let newer = written(place.path(), "over.toml", &newer);
    assert!(taken(&newer)[0] > 1.5, "{:?}", taken(&newer));
    let own_body = "extends = 'eel-calibration'\nreduced.body.eel-2.added_mass = 3.0\n";
    std::fs::write(place.path().join("own-body.toml"), own_body).unwrap();
    let path = place.path().join("own-body.toml").display().to_string();
    let changed = Case::read(&path, std::slice::from_ref(&set)).unwrap();
    assert_eq!(changed.case().reduced_model().coefficients_of("eel-2"), taken(&file));
    // What is written beside its name is refused
    for (beside, key) in [
        ("coefficients.added_mass = 0.9", "reduced.coefficients.added_mass is written here"),
        ("body.eel-1.added_mass = 0.9", "reduced.body.eel-1.added_mass is written here"),
    ] {
        let both = format!("{own}reduced.{beside}\n");
        std::fs::write(place.path().join("both.toml"), both).unwrap();
        let error = Case::read(place.path().join("both.toml").to_str().unwrap(), &[]).unwrap_err();
        let error = error.to_string();
        assert!(error.contains(key) && error.contains("calibrated.toml has 0.7"), "{error}");
        assert!(error.contains("both.toml:3:"), "{error}");
    }
    let bare = "title = 't'\ngeometry = 'planar'
fluid = { model = 'navier-stokes', density = 1000.0, viscosity = 1e-3 }
time.unsteady = { step = 0.01, end = 1.0 }
reduced = { loads = 'links', calibrated = { file = 'calibrated.toml' } }
[[swimmer]]
name = 'eel'
kind.chain = { links = [[0.06, 0.015], [0.06, 0.015], [0.06, 0.015]], gap = 0.01, joints = [
    { bent.angle.sine = { amplitude = 0.5, period = 2.0 } },
    { bent.angle.sine = { amplitude = 0.5, period = 2.0 } },
] }
";
    let file = written(place.path(), "bare.toml", bare);
    let taken = file.case().reduced_model().coefficients_of("");
    assert!((taken[0] / 0.7 - 1.0).abs() < 0.02, "{taken:?}");
    assert!(check(&file).is_empty(), "{:?}", check(&file));
    let again = file.case().to_toml().unwrap();
    let again = Case::parse("again.toml", &again, &[]).unwrap();
    assert_eq!(again.case(), file.case());
    // Another gait is warned about, another swimmer and another law are refused
    let other = bare.replace("amplitude = 0.5, period = 2.0", "amplitude = 0.5, period = 1.0");
    let found = check(&written(place.path(), "gait.toml", &other));
    assert!(found.len() == 1 && found[0].severity == Severity::Warning, "{found:?}");
    assert!(found[0].message.contains("period"), "{found:?}");
    let found = check(&written(place.path(), "name.toml", &bare.replace("'eel'", "'snake'")));
    let keys: Vec<&str> = found.iter().map(|one| one.key.as_str()).collect();
    assert_eq!(keys, ["reduced.calibrated.file"]);
    std::fs::write(place.path().join("law.toml"), bare.replace("'links'", "'fossen'")).unwrap();
    let error = Case::read(place.path().join("law.toml").to_str().unwrap(), &[]).unwrap_err();
    assert!(error.to_string().contains("law \"links\""), "{error}");
}

#[test]
fn bad_calibrations_are_refused_by_key_and_line() {
    let wrong = |settings: &[&str]| -> Vec<String> {
        let file = read("eel-calibration", settings);
        let found = check(&file).into_iter().chain(check_starts(&file));
        let errors = found.filter(|one| one.severity == Severity::Error);
        errors.map(|one| one.key).collect()
    };
    assert!(wrong(&[]).is_empty(), "{:?}", wrong(&[]));
    let bounds = "calibration.bounds.added_mass=[1.5, 3.0]";
    assert_eq!(wrong(&[bounds]), ["calibration.bounds.added_mass"]);
    assert_eq!(wrong(&["calibration.fit.0=aded_mass"])[0], "calibration.fit.0");
    assert_eq!(
        wrong(&["calibration.bounds.normal_linear=[0.0, 1.0]"]),
        ["calibration.bounds.normal_linear"]
    );
    assert_eq!(wrong(&["calibration.from.0.rate=30.0"]), ["calibration.from.0"]);
    assert_eq!(wrong(&["calibration.from.0.holdout=true"]), ["calibration.from"]);
    assert_eq!(wrong(&["calibration.by=loads"]), ["calibration.from.0.csv"]);
    assert_eq!(wrong(&["calibration.tracks=['eel-9.x']"]), ["calibration.tracks.0"]);
    assert_eq!(wrong(&["calibration.differences=2.0"]), ["calibration.differences"]);
    let loads = wrong(&["calibration.by=loads", "calibration.differences=0.02"]);
    assert!(loads.contains(&"calibration.differences".to_owned()), "{loads:?}");
    let refused =
        |settings: &[&str]| calibrate(&read("eel-calibration", settings)).unwrap_err().to_string();
    let missing = refused(&["calibration.from.0.time=when"]);
    assert!(missing.contains("calibration.from.0") && missing.contains("`when`"), "{missing}");
    for (setting, key, message, help) in [
        ("calibration.from.1.csv=nowhere.csv", "1.csv", "is not in this folder", "a CSV file"),
        ("calibration.from.0.time=t", "0.time", "columns: t (s), head x (cm)", "name a column"),
        (
            "calibration.from.0.columns={ 'eel-1.x' = 'yaw' }",
            "0.columns.eel-1.x",
            "there is no column `yaw`",
            "name a column",
        ),
        ("calibration.from.1.set=['body.9.force=1']", "1.set", "with these settings: ", ""),
    ] {
        let file = read("eel-calibration", &[setting]);
        let found = check_records(&file).and_then(|error| error.diagnostic(&file));
        let found = found.unwrap_or_else(|| panic!("{setting} is refused"));
        assert_eq!(found.key, format!("calibration.from.{key}"), "{setting}");
        assert!(found.message.contains(message) && found.help.contains(help), "{found:?}");
        assert!(found.location.is_some(), "{setting}");
    }
    assert!(check_records(&read("eel-calibration", &[])).is_none());
    let place = tempfile::tempdir().unwrap();
    let rows = "t,x\n0.0,1.0\n0.1,1.1\n0.1,1.2\n0.2,1.3\n";
    std::fs::write(place.path().join("rows.csv"), rows).unwrap();
    let text = "extends = 'eel-calibration'
[calibration]
fit = ['added_mass']
from = [{ csv = 'rows.csv', time = 't', columns = { 'eel-1.x' = 'x' } }]
";
    let file = written(place.path(), "falls.toml", text);
    let error = calibrate(&file).unwrap_err().to_string();
    assert!(error.contains("line 4") || error.contains("rise"), "{error}");
    let nothing = calibrate(&read("robot-eel", &[])).unwrap_err().to_string();
    assert!(nothing.contains("[calibration]"), "{nothing}");
}

#[test]
fn a_calibration_that_fits_nothing_says_so() {
    // A drag of a body that is fitted to a record of nothing it moves
    let place = tempfile::tempdir().unwrap();
    let rows = "t,x\n0.0,1.0\n0.1,1.1\n0.2,1.2\n";
    std::fs::write(place.path().join("rows.csv"), rows).unwrap();
    let text = "title = 't'\ngeometry = 'planar'
fluid = { model = 'navier-stokes', density = 1000.0, viscosity = 1e-3 }
time.unsteady = { step = 0.01, end = 1.0 }
reduced = { loads = 'links' }
[[body]]
name = 'log'
shape.ellipse.semi_axes = [0.1, 0.02]
center = [0.0, 0.0]
motion = 'free'
velocity = [0.1, 0.0]
[calibration]
fit = ['FIT']
from = [{ csv = 'rows.csv', time = 't', columns = { 'log.x' = 'x' } }]
";
    let file = written(place.path(), "idle.toml", &text.replace("FIT", "normal_quadratic"));
    let error = calibrate(&file).unwrap_err();
    let told = error.diagnostic(&file).unwrap();
    assert_eq!(told.key, "calibration.fit");
    assert!(told.message.contains("depends on normal_quadratic"), "{}", told.message);
    assert_eq!(told.location.unwrap().line, 13);
    let file = written(place.path(), "moves.toml", &text.replace("FIT", "tangential_linear"));
    let result = calibrate(&file).unwrap();
    // Paths are relative to the file they are written in
    let inner = place.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let extended = written(&inner, "extended.toml", "extends = '../moves.toml'\ntitle = 'u'\n");
    assert_eq!(calibrate(&extended).unwrap().fit.parameters, result.fit.parameters);
    assert!(result.remark.is_none() && result.fit.cost < result.fit.start_cost);
    // One of two
    let both = text.replace("FIT", "tangential_linear', 'normal_quadratic");
    let result = calibrate(&written(place.path(), "one.toml", &both)).unwrap();
    assert_eq!(result.has_effect, [true, false]);
    assert!(result.text().contains("without effect"), "{}", result.text());
    assert!(result.fit.uncertainties[0].is_finite(), "{:?}", result.fit);
    // From where it ends nothing moves any more
    let value =
        format!("reduced.coefficients.tangential_linear={:?}", found(&result, "tangential_linear"));
    let path = place.path().join("moves.toml").display().to_string();
    let again = calibrate(&Case::read(&path, &[value]).unwrap()).unwrap();
    let left = again.fit.cost / result.fit.cost - 1.0;
    assert!(left.abs() < 1e-6 && again.fit.promised < 1e-6, "{:?}", again.fit);
}

/// Each proposer finds what the twin was made with, says what was accepted, and goes on with the same bits.
#[test]
fn proposals_find_the_coefficients_of_a_twin() {
    let bounds = "calibration.bounds={ added_mass = [0.2, 2.0], normal_quadratic = [0.5, 10.0], \
                  tangential_quadratic = [0.05, 2.0] }";
    for (proposer, evaluations, within) in
        [("random", 150, None), ("nelder-mead", 250, Some(0.02)), ("cma-es", 500, Some(0.02))]
    {
        let search = format!(
            "calibration.search={{ proposer = '{proposer}', evaluations = {evaluations} }}"
        );
        let result = calibrate(&read("eel-calibration", &[bounds, &search])).unwrap();
        let tally = result.tally.as_ref().unwrap();
        let [with, without] = tally.shares();
        assert!(tally.n_evaluations <= evaluations && with > without, "{tally:?}");
        assert!(result.fit.cost < 0.1 * result.fit.start_cost, "{proposer}: {:?}", result.fit);
        for (name, expected) in
            [("added_mass", 0.7), ("normal_quadratic", 4.5), ("tangential_quadratic", 0.5)]
        {
            let off = (found(&result, name) / expected - 1.0).abs();
            assert!(within.is_none_or(|most| off < most), "{proposer} {name}: {off} {tally:?}");
        }
        assert!(
            result.text().contains("accepted") && result.to_toml().contains("[calibrated.search]")
        );
    }
}

#[test]
fn a_program_proposes_and_a_search_is_taken_up_again() {
    let place = tempfile::tempdir().unwrap();
    // Nearer to what the record was made with at each call
    let script = "n=$(grep -o '\"accepted\"' | wc -l)
echo \"{ \\\"values\\\": { \\\"added_mass\\\": 0.7, \\\"normal_quadratic\\\": 4.$n, \\\"tangential_quadratic\\\": 0.5 } }\"
";
    std::fs::write(place.path().join("propose.sh"), script).unwrap();
    for (name, text) in [
        ("record-slow.csv", include_str!("../../../cases/eel-calibration/record-slow.csv")),
        ("record-fast.csv", include_str!("../../../cases/eel-calibration/record-fast.csv")),
    ] {
        std::fs::write(place.path().join(name), text).unwrap();
    }
    let case = |evaluations: usize, command: &str| {
        let text = format!(
            "extends = 'eel-calibration'
[calibration]
fit = ['added_mass', 'normal_quadratic', 'tangential_quadratic']
[calibration.search]
proposer = 'external'
evaluations = {evaluations}
command = {command}
"
        );
        std::fs::write(place.path().join("case.toml"), text).unwrap();
    };
    let run = |out: &str, more: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_alewife"))
            .args(["calibrate", "case.toml", "--out", out])
            .args(more)
            .current_dir(place.path())
            .output()
            .unwrap()
    };
    let told = |output: &std::process::Output| String::from_utf8_lossy(&output.stderr).into_owned();
    let text = |out: &str| std::fs::read_to_string(place.path().join(out).join("calibrated.toml"));
    case(12, "['sh', 'propose.sh']");
    let output = run("whole", &["--quiet"]);
    assert!(output.status.success(), "{}", told(&output));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("external: 12 motions"), "{said}");
    // Stopped after five, and gone on with: the same file, and other lines in the journal are left alone
    case(5, "['sh', 'propose.sh']");
    assert!(run("parts", &["--quiet"]).status.success());
    std::fs::remove_file(place.path().join("parts/calibrated.toml")).unwrap();
    case(12, "['sh', 'propose.sh']");
    let output = run("parts", &[]);
    assert!(output.status.success(), "{}", told(&output));
    assert!(told(&output).contains("[6/12]") && !told(&output).contains("[5/12]"));
    assert_eq!(text("parts").unwrap(), text("whole").unwrap());
    case(12, "['sh', '-c', 'echo nonsense']");
    let output = run("bad", &["--quiet"]);
    let error = told(&output);
    assert_eq!(output.status.code(), Some(65), "{error}");
    assert!(error.contains("command = [") && error.contains("case.toml:7"), "{error}");
    assert!(error.contains("answered `nonsense`") && error.contains("accepted is"), "{error}");
    // Its journal is of another search than that of a case with another program
    case(12, "['sh', 'propose.sh']");
    let output = run("bad", &["--quiet"]);
    assert_eq!(output.status.code(), Some(2), "{}", told(&output));
    assert!(run("bad", &["--quiet", "--overwrite"]).status.success());
}

#[test]
fn searches_that_cannot_be_are_refused_by_key() {
    let wrong = |settings: &[&str]| -> Vec<String> {
        let found = check(&read("eel-calibration", settings));
        let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
        errors.map(|one| format!("{} {}", one.key, one.message)).collect()
    };
    for (setting, words) in [
        ("{ proposer = 'external' }", "search.proposer the proposer \"external\" is a program"),
        ("{ proposer = 'external', command = [''] }", "search.command the name"),
        ("{ proposer = 'cma-es', command = ['sh'] }", "search.command the proposer"),
        ("{ proposer = 'nelder-mead', seed = 3 }", "search.seed the proposer"),
        ("{ proposer = 'random', evaluations = 0 }", "search.evaluations 0 motions"),
        ("{ proposer = 'random', halvings = 21 }", "search.halvings 21 halvings"),
    ] {
        let found = wrong(&[&format!("calibration.search={setting}")]);
        let key = words.split_whitespace().next().unwrap();
        let is_of_it = found.iter().all(|one| one.contains(key));
        assert!(is_of_it && found.iter().any(|one| one.contains(words)), "{setting}: {found:?}");
    }
    let search = "calibration.search={ proposer = 'random' }";
    assert!(wrong(&[search]).is_empty());
    let found = wrong(&[search, "calibration.bounds={ added_mass = [0.1, 3.0] }"]);
    assert!(found.len() == 2 && found[0].contains("\"normal_quadratic\" has none"), "{found:?}");
    let typing = ["calibration.search={ proposer = 'bayes' }".to_owned()];
    let error = Case::read("eel-calibration", &typing).unwrap_err().to_string();
    assert!(error.contains("nelder-mead"), "{error}");
}
