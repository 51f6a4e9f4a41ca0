//! Sweeps: their points, what a repeated call makes, what fails, and the table and the script of them.

mod kills;
mod races;

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use super::{alewife, done};

/// A swept key of `squirmer-alone`: B2.
const MODE: &str = "body.0.gait.squirmer.modes.1";

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// `sweep run` of coarse squirmers into `s`.
fn run(directory: &Path, more: &[&str]) -> Output {
    let arguments = ["sweep", "run", "squirmer-alone", "--out", "s", "--set", "mesh.scale=2"];
    alewife(directory, &[&arguments[..], more].concat())
}

fn states(directory: &Path) -> Vec<String> {
    let all: Value =
        serde_json::from_str(&done(directory, &["sweep", "status", "s", "--json"])).unwrap();
    let points = all["points"].as_array().unwrap();
    points.iter().map(|point| point["state"].as_str().unwrap().to_owned()).collect()
}

/// A cavity that has no steady flow at the smallest of three viscosities.
const CAVITY: &str = "
title = 't'
geometry = 'planar'
fluid = { model = 'navier-stokes', density = 1.0, viscosity = 0.1 }
domain.box = { min = [-1.0, -1.0], max = [1.0, 1.0] }
mesh.size = 0.5
time.steady.max_iterations = 8
sweep.grid.fluid.viscosity = [0.1, 1e-7, 0.2]
[boundary]
left = 'no-slip'
right = 'no-slip'
bottom = 'no-slip'
top.velocity.value = [1.0, 0.0]
";

/// The rows of a table by the names of its columns.
fn table(path: &Path) -> Vec<serde_json::Map<String, Value>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names = reader.headers().unwrap().clone();
    let row = |row: csv::StringRecord| {
        names.iter().zip(&row).map(|(name, cell)| (name.to_owned(), cell.into())).collect()
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

#[test]
fn the_points_of_a_shipped_sweep_are_printed_and_checked() {
    let place = tempfile::tempdir().unwrap();
    let said = done(place.path(), &["sweep", "expand", "squirmer-alone"]);
    let lines: Vec<Vec<&str>> = said.lines().map(|l| l.split_whitespace().collect()).collect();
    assert_eq!(lines.len(), 12, "{said}");
    assert_eq!(
        (&lines[0], &lines[1], &lines[11]),
        (&vec!["point", MODE], &vec!["1", "-7.5"], &vec!["11", "7.5"])
    );
    let json = done(place.path(), &["sweep", "expand", "squirmer-alone", "--json"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["points"][5]["settings"][MODE], 0.0);
    let said = done(place.path(), &["check", "--no-mesh", "squirmer-alone"]);
    assert!(said.contains(&format!("sweep of 11 points over {MODE}: all are valid")), "{said}");
}

#[test]
fn all_points_that_are_wrong_are_named_and_none_is_run() {
    let place = tempfile::tempdir().unwrap();
    let fixed = format!("{MODE}=1.0");
    let output = run(place.path(), &["--set", &fixed, "--set", "fluid.viscosity=1,-2,3,-4"]);
    let told = told(&output);
    assert_eq!(output.status.code(), Some(65), "{told}");
    for part in ["point 2 (", "fluid.viscosity = -2):", "point 4 (", "2 of 4 points are wrong"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(!place.path().join("s").exists());
    let output = run(place.path(), &["--set", &fixed, "--set", "fluid.viscsity=1,2,3"]);
    let told = self::told(&output);
    assert!(told.contains("points 1-3:") && told.contains("did you mean `viscosity`"), "{told}");

    // A file with such a sweep is not valid, either
    let text =
        "extends = 'squirmer-alone'\ntitle = 't'\nsweep.grid.fluid.viscosity = [1.0, -2.0]\n";
    std::fs::write(place.path().join("mine.toml"), text).unwrap();
    let output = alewife(place.path(), &["check", "--no-mesh", "mine.toml"]);
    let told = self::told(&output);
    assert_eq!(output.status.code(), Some(65), "{told}");
    assert!(told.contains("point 2 (") && told.contains("mine.toml:3:"), "{told}");
}

#[test]
fn a_repeated_call_makes_what_is_missing_and_another_sweep_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let modes = format!("{MODE}=-3:3:4");
    let only = run(place.path(), &["--set", &modes, "--index", "3"]);
    assert_eq!(only.status.code(), Some(0), "{}", told(&only));
    assert_eq!(states(place.path()), ["missing", "missing", "finished", "missing"]);
    let third = place.path().join("s/points/0003/provenance.json");
    let before = std::fs::read(&third).unwrap();

    let all = run(place.path(), &["--set", &modes]);
    assert_eq!(all.status.code(), Some(0), "{}", told(&all));
    assert!(told(&all).contains("points to make in s: 3; finished already: 1"), "{}", told(&all));
    assert_eq!(states(place.path()), ["finished"; 4]);
    assert_eq!(std::fs::read(&third).unwrap(), before);
    let again = run(place.path(), &["--set", &modes]);
    assert!(told(&again).contains("points to make in s: 0"), "{}", told(&again));
    let only = run(place.path(), &["--set", &modes, "--index", "3"]);
    assert!(String::from_utf8_lossy(&only.stdout).contains("has come to its end before"));

    let other =
        run(place.path(), &["--set", &format!("{MODE}=-3,-1,1,4"), "--set", "mesh.growth=0.2"]);
    let told = told(&other);
    assert_eq!(other.status.code(), Some(65), "{told}");
    let point = format!("point 4: {MODE} = 3 there, {MODE} = 4 here");
    assert!(told.contains(&point) && told.contains("mesh.growth: 0.12 there, 0.2 here"), "{told}");
    // Quantities to collect and texts are no other sweep
    let same =
        run(place.path(), &["--set", &modes, "--set", "sweep.quantities=[\"squirmer.power\"]"]);
    assert_eq!(same.status.code(), Some(0), "{}", self::told(&same));
}

#[test]
fn a_point_that_fails_is_listed_and_the_others_go_on() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("cavity.toml"), CAVITY).unwrap();
    let run = |more: &[&str]| {
        let arguments = ["sweep", "run", "cavity.toml", "--out", "s"];
        alewife(place.path(), &[&arguments[..], more].concat())
    };
    let output = run(&[]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(10), "{said}{}", told(&output));
    assert!(said.contains("2 of 3 points finished, 1 failed"), "{said}");
    let line = "point 2 (fluid.viscosity = 1e-7) failed with exit code 10: steady flow: ";
    assert!(said.contains(line), "{said}");
    assert_eq!(states(place.path()), ["finished", "failed", "finished"]);
    let rows = table(&place.path().join("s/sweep.csv"));
    assert_eq!((&rows[1]["state"], &rows[1]["flow.dissipation"]), (&"failed".into(), &"".into()));
    assert!(rows[1]["reason"].as_str().unwrap().contains("Newton"), "{rows:?}");
    // Without references and quantities, all there is
    assert_ne!(rows[0]["flow.dissipation"], rows[2]["flow.dissipation"]);

    // It would fail again
    let output = run(&[]);
    assert!(told(&output).contains(
        "make in s: 0; finished already: 2; failed, and not run again without --retry: 1"
    ));
    assert_eq!(output.status.code(), Some(10));
    let output = run(&["--retry"]);
    assert!(told(&output).contains("points to make in s: 1"), "{}", told(&output));
    assert_eq!(output.status.code(), Some(10));
}

#[test]
fn the_table_has_the_values_of_single_runs() {
    let place = tempfile::tempdir().unwrap();
    let output = run(place.path(), &["--set", &format!("{MODE}=-7.5:7.5:3"), "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", told(&output));
    let rows = table(&place.path().join("s/sweep.csv"));
    assert_eq!(rows.len(), 3);
    let number = |cell: &Value| cell.as_str().unwrap().parse::<f64>().unwrap();
    let mut powers = Vec::new();
    for row in &rows {
        let set = format!("{MODE}={}", row[MODE].as_str().unwrap());
        let alone =
            ["run", "squirmer-alone", "--out", "one", "--overwrite", "--threads", "1", "--quiet"];
        let settings = ["--set", "mesh.scale=2", "--set", &set];
        done(place.path(), &[&alone[..], &settings].concat());
        let one = table(&place.path().join("one/series.csv"));
        let comparison = std::fs::read(place.path().join("one/comparison.json")).unwrap();
        let comparison: Value = serde_json::from_slice(&comparison).unwrap();
        // Bits, not digits
        assert_eq!(row["squirmer.power"], one[0]["squirmer.power"]);
        assert_eq!(row["squirmer.velocity.x"], one[0]["squirmer.velocity.x"]);
        let speed = &comparison["comparisons"][1];
        assert_eq!(number(&row["squirmer.velocity.x"]), speed["computed"].as_f64().unwrap());
        assert_eq!(row["squirmer.velocity.x verdict"], speed["verdict"]);
        assert_eq!(row["state"], "finished");
        powers.push(number(&row["squirmer.power"]));
    }
    // The power is a parabola in B2; by reflection it is an even one
    let share = powers[0] / powers[2] - 1.0;
    assert!(share.abs() < 1e-3 && powers[1] < 0.1 * powers[2], "{powers:?}");

    let said = done(
        place.path(),
        &["sweep", "collect", "s", "--out", "t.csv", "--quantity", "max squirmer.drag"],
    );
    assert!(said.contains("written to t.csv"), "{said}");
    assert!(table(&place.path().join("t.csv"))[0].contains_key("squirmer.drag (max)"));
    let wrong =
        alewife(place.path(), &["sweep", "collect", "s", "--quantity", "men squirmer.drag"]);
    assert!(told(&wrong).contains("did you mean `mean`"), "{}", told(&wrong));
    assert_eq!(alewife(place.path(), &["sweep", "collect", "one"]).status.code(), Some(66));
}

#[test]
fn a_sweep_that_is_run_has_the_quantities_it_is_asked_for() {
    let place = tempfile::tempdir().unwrap();
    let axis = format!("{MODE}=0,1");
    let call = |quantity: &str| {
        let more = ["--set", &axis, "--jobs", "1", "--quantity", quantity];
        run(place.path(), &more)
    };
    // Before anything is run
    for (quantity, code, said) in [
        ("squirmer.speed", 65, "has no quantity `squirmer.speed`"),
        ("men squirmer.drag", 2, "did you mean `mean`"),
    ] {
        let output = call(quantity);
        assert_eq!(output.status.code(), Some(code), "{}", told(&output));
        assert!(told(&output).contains(said), "{}", told(&output));
        assert!(!place.path().join("s").exists());
    }
    let columns = |quantity: &str| {
        let output = call(quantity);
        assert_eq!(output.status.code(), Some(0), "{}", told(&output));
        let row = table(&place.path().join("s/sweep.csv")).swap_remove(0);
        ["squirmer.drag (max)", "squirmer.power (mean)"].map(|name| row.contains_key(name))
    };
    assert_eq!(columns("max squirmer.drag"), [true, false]);
    // Others of points that are done already
    assert_eq!(columns("mean squirmer.power"), [false, true]);
}

#[test]
fn what_cannot_be_run_is_refused_with_what_is_accepted() {
    let place = tempfile::tempdir().unwrap();
    let modes = format!("{MODE}=-3:3:4");
    let granted = std::thread::available_parallelism().unwrap().get();
    for (more, message) in [
        (
            vec!["--jobs", "1000"],
            format!("1000 jobs of 1 threads each want 1000 cores, and {granted} are"),
        ),
        (vec!["--threads", "1000"], format!("give --threads up to {granted}")),
        (vec!["--jobs", "0"], "are 1 at least".to_owned()),
        (vec!["--index", "0"], "there is no point 0; accepted: 1 to 4".to_owned()),
        (vec!["--index", "5"], "there is no point 5; accepted: 1 to 4".to_owned()),
        (vec!["--index", "2-9"], "there is no point 9; accepted: 1 to 4".to_owned()),
        (vec!["--index", "x"], "write the number of a point".to_owned()),
        (vec!["--max-walltime", "soon"], "is no time on a clock".to_owned()),
    ] {
        let output = run(place.path(), &[&["--set", &modes][..], &more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", told(&output));
        assert!(told(&output).contains(&message), "{more:?}: {}", told(&output));
    }
    // A batch system may grant less than the machine has
    let output = Command::new(env!("CARGO_BIN_EXE_alewife"))
        .args(["sweep", "run", "squirmer-alone", "--jobs", "2"])
        .env("SLURM_CPUS_PER_TASK", "1")
        .current_dir(place.path())
        .output()
        .unwrap();
    assert!(told(&output).contains("and 1 are granted; give --jobs up to 1"), "{}", told(&output));
    // Files of others stay
    std::fs::create_dir(place.path().join("s")).unwrap();
    std::fs::write(place.path().join("s/mine"), "").unwrap();
    let output = run(place.path(), &["--set", &modes]);
    assert_eq!(output.status.code(), Some(2));
    assert!(told(&output).contains("s is not empty and holds no sweep"), "{}", told(&output));
}

/// Runs a script as a task of an array, with stand-ins for the programs of Slurm; what these were told.
#[cfg(unix)]
fn run_task(directory: &Path, task: usize, srun: &str) -> Output {
    use std::os::unix::fs::PermissionsExt;
    let programs = directory.join("bin");
    std::fs::create_dir_all(&programs).unwrap();
    for (name, text) in [("srun", srun), ("scontrol", "echo \"scontrol $*\"")] {
        let path = programs.join(name);
        std::fs::write(&path, format!("#!/bin/bash\n{text}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    Command::new("bash")
        .args(["-u", "script.sh"])
        .env("PATH", path)
        .env("SLURM_ARRAY_TASK_ID", task.to_string())
        .env("SLURM_ARRAY_JOB_ID", "17")
        .current_dir(directory)
        .output()
        .unwrap()
}

#[cfg(unix)]
#[test]
fn the_tasks_of_a_job_script_make_all_points_and_go_back_into_the_queue() {
    let place = tempfile::tempdir().unwrap();
    let modes = format!("{MODE}=-3:3:5");
    let case = ["squirmer-alone", "--out", "s", "--set", "mesh.scale=2", "--set", &modes];
    let more = ["--per-task", "2", "--time", "00:10:00"];
    let script = done(place.path(), &[&["sweep", "script"], &case[..], &more].concat());
    for line in ["#SBATCH --array=0-2", "#SBATCH --requeue", "#SBATCH --time=00:10:00"] {
        assert!(script.lines().any(|one| one == line), "{script}");
    }
    std::fs::write(place.path().join("script.sh"), &script).unwrap();
    for task in 0..3 {
        // Tasks get the cores they ask for
        let output = run_task(place.path(), task, "shift\nexec \"$@\"");
        assert_eq!(output.status.code(), Some(0), "{}", told(&output));
        let n_done = (2 * task + 2).min(5);
        let states = states(place.path());
        assert_eq!(states.iter().filter(|state| *state == "finished").count(), n_done);
    }
    let output = run_task(place.path(), 1, "exit 75");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "scontrol requeue 17_1\n");
    let output = run_task(place.path(), 1, "exit 10");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(10), 0));

    // The array is as long as Slurm allows
    let many = format!("{MODE}=-3:3:1100");
    let script =
        done(place.path(), &["sweep", "script", "squirmer-alone", "--set", &many, "--jobs", "3"]);
    assert!(script.contains("#SBATCH --array=0-366\n") && script.contains("* 3 + 1"), "{script}");
    let few = ["sweep", "script", "squirmer-alone", "--set", &many, "--per-task", "1"];
    let refused = alewife(place.path(), &few);
    assert!(
        told(&refused).contains("1100 tasks, and an array has 1001 at most"),
        "{}",
        told(&refused)
    );
}
