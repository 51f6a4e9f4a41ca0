//! The scripts of docs/cluster are valid, and do what they say with stand-ins for the batch systems.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::root;

#[test]
fn the_scripts_are_valid() {
    let scripts = ["docs/cluster/slurm.sh", "docs/cluster/pbs.sh", "docs/cluster/static.sh"];
    for script in scripts.into_iter().chain(["tests/slurm.sh", "tests/container.sh"]) {
        let parsed = Command::new("bash").arg("-n").arg(root().join(script)).status().unwrap();
        assert!(parsed.success(), "{script}");
    }
}

/// What a job script has its commands do, a line each, and the code it ends with.
struct Job {
    code: Option<i32>,
    calls: String,
}

/// Runs a job script where all commands of the batch system write down how they are called.
fn job(script: &str, code: i32, environment: &[(&str, &str)], arguments: &[&str]) -> Job {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let name = format!("job-{}-{number}", std::process::id());
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&place).unwrap();
    let calls = place.join("calls");
    let stand_in = |name: &str, rest: &str| {
        let path = place.join(name);
        fs::write(&path, format!("#!/bin/sh\necho {name} \"$@\" >>calls\n{rest}\n")).unwrap();
        assert!(Command::new("chmod").arg("+x").arg(&path).status().unwrap().success());
    };
    stand_in("alewife", &format!("exit {code}"));
    stand_in("srun", "shift; exec \"$@\"");
    stand_in("scontrol", "");
    stand_in("qsub", "");
    let path = format!("{}:{}", place.display(), std::env::var("PATH").unwrap());
    let status = Command::new("bash")
        .arg(root().join(script))
        .args(arguments)
        .current_dir(&place)
        .env("PATH", path)
        .env("PBS_O_WORKDIR", &place)
        .envs(environment.iter().copied())
        .status()
        .unwrap();
    let calls = fs::read_to_string(calls).unwrap_or_default();
    fs::remove_dir_all(&place).unwrap();
    Job { code: status.code(), calls }
}

#[test]
fn a_job_goes_back_into_the_queue_only_where_it_can_continue() {
    let slurm = "docs/cluster/slurm.sh";
    let alone = [("SLURM_CPUS_PER_TASK", "4"), ("SLURM_JOB_ID", "7")];
    let task = [("SLURM_ARRAY_JOB_ID", "9"), ("SLURM_ARRAY_TASK_ID", "1")];
    let tasks = [alone, task].concat();
    let srun = "srun --cpus-per-task=4 alewife run";
    for code in [0, 10, 74, 76] {
        let Job { code: ended, calls } = job(slurm, code, &alone, &["a.toml"]);
        assert_eq!(ended, Some(code));
        assert_eq!(calls, format!("{srun} a.toml\nalewife run a.toml\n"));
    }
    let Job { code, calls } = job(slurm, 75, &alone, &["a.toml"]);
    assert_eq!((code, calls.lines().last()), (Some(0), Some("scontrol requeue 7")));
    // Of an array the one task alone, with its own case
    let Job { code, calls } = job(slurm, 75, &tasks, &["a.toml", "b c.toml"]);
    assert_eq!((code, calls.lines().last()), (Some(0), Some("scontrol requeue 9_1")));
    assert!(calls.starts_with(&format!("{srun} b c.toml\n")), "{calls}");
    let Job { code, calls } = job(slurm, 75, &tasks, &["a.toml"]);
    assert!(code != Some(0) && calls.is_empty(), "{calls}");

    let pbs = "docs/cluster/pbs.sh";
    let variables = [("CASE", "a.toml"), ("NCPUS", "2")];
    for code in [0, 10, 74, 76] {
        let Job { code: ended, calls } = job(pbs, code, &variables, &[]);
        assert_eq!(ended, Some(code));
        assert_eq!(calls, "alewife run a.toml --threads 2 --max-walltime 235 min\n");
    }
    let Job { code, calls } = job(pbs, 75, &variables, &[]);
    assert_eq!((code, calls.lines().last()), (Some(0), Some("qsub -v CASE=a.toml pbs.sh")));
}
