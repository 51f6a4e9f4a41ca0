//! `External`: a program that proposes points: it reads JSON and writes JSON, once for each point.

use std::io::{Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use alewife_interrupt::check;
use rustix::process::{Pid, Signal, kill_process_group};
use serde_json::{Map, Value, json};

use super::proposals::{Proposal, Proposals};

/// What is accepted of a program.
const ACCEPTED: &str =
    "one JSON object, { \"values\": { NAME: number, ... } }, with a finite number for each name";

/// How often it is looked whether the program has ended, or is to.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// Characters of a bad answer that are shown.
const SHOWN: usize = 200;

/// A program that proposes points.
#[derive(Debug, Clone)]
pub struct External {
    /// The program and its arguments.
    pub command: Vec<String>,
    /// Where it is run.
    pub directory: PathBuf,
}

/// A number as JSON has it; null where it is none.
fn number(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// All that a program is told: names with bounds, the best values, what was proposed and what became of it.
fn told(proposals: &Proposals<'_>) -> Value {
    let bounded = proposals.bounded();
    let named = |values: &[f64]| {
        let pairs = bounded.iter().zip(values);
        Value::Object(pairs.map(|(one, value)| (one.name.clone(), number(*value))).collect())
    };
    let history = |one: &Proposal| {
        json!({
            "values": named(&one.values),
            "objective": number(one.objective),
            "accepted": one.accepted.map(number),
            "best": number(one.best),
        })
    };
    let bounds: Map<String, Value> =
        bounded.iter().map(|one| (one.name.clone(), json!([one.lower, one.upper]))).collect();
    json!({
        "bounds": bounds,
        "best": { "values": named(proposals.best()), "objective": number(proposals.objective()) },
        "history": proposals.all().iter().map(history).collect::<Vec<_>>(),
        "evaluations_left": proposals.n_left(),
    })
}

impl External {
    /// Asks for the next point.
    ///
    /// # Errors
    /// When the program cannot be run, fails, or answers something else than is accepted.
    pub fn ask(&self, proposals: &Proposals<'_>) -> Result<Vec<f64>, String> {
        let (Some(program), arguments) = (self.command.first(), self.command.get(1..)) else {
            return Err("no program is named".to_owned());
        };
        let failed = |error: std::io::Error| format!("`{program}`: {error}");
        let mut child = Command::new(program)
            .args(arguments.unwrap_or_default())
            .current_dir(&self.directory)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            // What it starts ends with it
            .process_group(0)
            .spawn()
            .map_err(failed)?;
        if let Some(mut input) = child.stdin.take() {
            // A program that knows enough may close it before it has read all
            let _ = input.write_all(format!("{}\n", told(proposals)).as_bytes());
        }
        let reader = child.stdout.take().map(|mut output| {
            std::thread::spawn(move || {
                let mut all = Vec::new();
                output.read_to_end(&mut all).map(|_| all)
            })
        });
        let status = loop {
            if let Some(status) = child.try_wait().map_err(failed)? {
                break status;
            }
            if check().is_err() {
                end(&mut child);
                return Err("it was asked to end".to_owned());
            }
            std::thread::sleep(LOOK_EVERY);
        };
        if !status.success() {
            return Err(format!("`{program}` ended with {status}"));
        }
        let output = reader.map(std::thread::JoinHandle::join);
        let output = output.and_then(Result::ok).transpose().map_err(failed)?.unwrap_or_default();
        let text = String::from_utf8_lossy(&output);
        answered(proposals, text.trim()).map_err(|what| {
            let shown: String = text.trim().chars().take(SHOWN).collect();
            format!("`{program}` answered `{shown}`: {what}; accepted is {ACCEPTED}")
        })
    }
}

/// Ends a program that leads a group of processes, and all that it has started.
fn end(leader: &mut Child) {
    if let Some(group) = i32::try_from(leader.id()).ok().and_then(Pid::from_raw) {
        let _ = kill_process_group(group, Signal::KILL);
    }
    let _ = leader.kill();
    let _ = leader.wait();
}

/// The values of an answer.
fn answered(proposals: &Proposals<'_>, text: &str) -> Result<Vec<f64>, String> {
    let answer: Value = serde_json::from_str(text).map_err(|error| format!("no JSON ({error})"))?;
    let values = answer.get("values").and_then(Value::as_object);
    let values = values.ok_or_else(|| "there is no object `values`".to_owned())?;
    let bounded = proposals.bounded();
    if let Some(name) = values.keys().find(|name| bounded.iter().all(|one| one.name != **name)) {
        return Err(format!("nothing is called \"{name}\""));
    }
    let value = |name: &str| {
        let value = values.get(name).ok_or_else(|| format!("\"{name}\" is missing"))?;
        let number = value.as_f64().filter(|one| one.is_finite());
        number.ok_or_else(|| format!("\"{name}\" is {value}, no finite number"))
    };
    bounded.iter().map(|one| value(&one.name)).collect()
}
