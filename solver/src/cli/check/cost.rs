//! What a run costs: one step that is made on its mesh, times its steps, and the files it writes.

use std::fmt::Write as _;

use crate::case::{Cadence, Case, Diagnostic, FlowModel, Model, Severity, TimeSettings, Unsteady};
use crate::case::{known_quantities, significant};
use crate::cli::exit::Failure;
use crate::cli::facts::count;
use crate::cli::style;
use crate::observer::{field_file_size, peak_memory, state_size};
use crate::run::{Dimension, Effort, Solve, TimedStep};

/// Output above which a warning is given (bytes).
const LARGE_OUTPUT: f64 = 2e9;

/// Bytes of a number in `series.csv`, where it has as many digits as it takes to read it back:
/// seventeen at most, a sign, a point and a comma.
const BYTES_OF_NUMBER: f64 = 20.0;

/// Bytes of a body in `run.mcap` at one time: some forty numbers of eight bytes, compressed.
const BYTES_OF_BODY: f64 = 300.0;

/// Unknowns, steps, time, memory and files of a run, of which one step was made on a mesh that took
/// some CPU time (s).
pub fn measured<const D: usize>(
    model: &Model,
    timed: &TimedStep<D>,
    seconds: f64,
) -> Result<String, Failure>
where
    Dimension<D>: Solve<D>,
{
    let on_mesh = D * timed.mesh.n_nodes() + timed.mesh.n_vertices;
    let mut lines = vec![Line {
        name: "unknowns",
        text: format!(
            "{} free ones; {on_mesh} velocities and pressures on the mesh",
            timed.unknowns
        ),
    }];
    match &model.case.time {
        TimeSettings::Steady(_) => {
            lines.push(Line { name: "CPU time", text: steady(model, &timed.start, seconds) });
        }
        TimeSettings::Unsteady(settings) => {
            lines.push(Line { name: "steps", text: steps(settings, timed.pieces) });
            lines.extend(unsteady(model, settings, timed, seconds));
        }
    }
    if let Some(peak) = peak_memory() {
        let most = "the most this process held for the mesh and what was solved on it";
        lines.push(Line { name: "memory", text: format!("{}, {most}", bytes(peak as f64)) });
    }
    let output = Output::of(model, timed)?;
    lines.push(Line {
        name: "output",
        text: format!("{} at most{}", bytes(output.bytes), output.parts),
    });
    warn_of_output(output.bytes);
    let mut text = String::new();
    for Line { name, text: line } in lines {
        let _ = writeln!(text, "  {name:<16} {line}");
    }
    Ok(text.trim_end().to_owned())
}

/// A line of what is reported.
struct Line {
    name: &'static str,
    text: String,
}

/// What there is to say of a steady solution.
fn steady(model: &Model, start: &Effort, mesh: f64) -> String {
    let systems = if start.systems == 1 { "one linear system" } else { "its linear systems" };
    let whole = duration(start.cpu + mesh);
    let taken = duration_of_step(start.cpu);
    match model.case.fluid.model {
        FlowModel::NavierStokes => format!(
            "{taken} for the flow without convection, as it took just now; Newton's method adds as \
             many linear systems as it needs, of at least as much each"
        ),
        _ => format!("{taken} for {systems}, as it took just now; {whole} with the mesh"),
    }
}

/// How many steps there are.
fn steps(time: &Unsteady, pieces: Option<usize>) -> String {
    let Some(adaptive) = &time.adaptive else {
        let n_steps = time.n_steps();
        let more = pieces.map_or(0, |pieces| pieces.saturating_sub(n_steps));
        let steps = count(n_steps as f64);
        if more == 0 {
            return steps;
        }
        let ones = if more == 1 { "one" } else { "ones" };
        let more = count(more as f64);
        return format!("{steps}, and {more} more short {ones}, in which motions begin or jump");
    };
    let largest = adaptive.largest.unwrap_or(time.end / 10.0);
    format!(
        "chosen by their errors: {} at least, and {} if all were of the first size, {}",
        count((time.end / largest).ceil()),
        count((time.end / time.step).ceil()),
        significant(time.step)
    )
}

/// What there is to say of the time of an unsteady run.
fn unsteady<const D: usize>(
    model: &Model,
    settings: &Unsteady,
    timed: &TimedStep<D>,
    mesh: f64,
) -> Vec<Line> {
    let step = match &timed.step {
        Some(Ok(step)) => step,
        Some(Err(error)) => {
            let size = significant(settings.step);
            let reported = format!("not known: a step of {size} is not made in one ({error})");
            return vec![Line {
                name: "CPU time",
                text: format!("{reported}; a run tries shorter ones"),
            }];
        }
        None => return Vec::new(),
    };
    let systems = match step.systems {
        1 => "one linear system".to_owned(),
        n => format!("{n} linear systems"),
    };
    let mut line = format!(
        "{} a step of {systems}, as one took just now, {} on the clock",
        duration_of_step(step.cpu),
        duration_of_step(step.wall)
    );
    if let Some(pieces) = timed.pieces {
        let all = mesh + timed.start.cpu + pieces as f64 * step.cpu;
        line = format!("{}: {line}", duration(all));
    }
    let mut lines = vec![Line { name: "CPU time", text: line }];
    let missing = missing(&model.case, model.mesh_moves());
    if !missing.is_empty() {
        lines.push(Line { name: "not in it", text: missing.join(", ") });
    }
    lines
}

/// What a first step does not show.
fn missing(case: &Case, mesh_moves: bool) -> Vec<&'static str> {
    let mut missing = Vec::new();
    if mesh_moves {
        missing.push("new meshes and thin films as bodies move");
    }
    if case.contact.is_some() {
        missing.push("contact that comes later");
    }
    missing
}

/// The files of a run.
struct Output {
    /// The size of all (bytes).
    bytes: f64,
    /// What it is made of, in words.
    parts: String,
}

impl Output {
    /// By one field file and one state that are made to be measured.
    fn of<const D: usize>(model: &Model, timed: &TimedStep<D>) -> Result<Self, Failure>
    where
        Dimension<D>: Solve<D>,
    {
        let case = &model.case;
        let TimedStep { mesh, velocity, pressure, .. } = timed;
        let field = field_file_size(case.output.precision, mesh, velocity, pressure)? as f64;
        let fields = times(case.output.fields, &case.time);
        let row = BYTES_OF_NUMBER * known_quantities(model).len() as f64
            + BYTES_OF_BODY * model.bodies.len() as f64;
        let rows = times(case.output.series, &case.time);
        let mut sum = fields * field + rows * row;
        let mut parts = format!(": {} of {} for fields", count(fields), bytes(field));
        let kept = case.output.checkpoint.keep;
        if let Some(state) = timed.saved.as_ref().filter(|_| kept > 0) {
            let state = state_size(state)? as f64;
            sum += kept as f64 * state;
            let _ = write!(parts, ", up to {kept} of {} to resume from", bytes(state));
        }
        let _ = write!(parts, ", about {} for the series", bytes(rows * row));
        Ok(Self { bytes: sum, parts })
    }
}

/// How often something is written.
fn times(cadence: Cadence, time: &TimeSettings) -> f64 {
    match (cadence, time) {
        (Cadence::Never, _) => 0.0,
        (Cadence::End, _) | (_, TimeSettings::Steady(_)) => 1.0,
        (Cadence::Steps(n), TimeSettings::Unsteady(time)) => {
            1.0 + (time.end / time.step / n.max(1) as f64).ceil()
        }
        (Cadence::Time(interval), TimeSettings::Unsteady(time)) => {
            // Once a step at most
            1.0 + (time.end / interval).min(time.end / time.step).ceil()
        }
    }
}

fn warn_of_output(output: f64) {
    if output <= LARGE_OUTPUT {
        return;
    }
    let warning = Diagnostic {
        severity: Severity::Warning,
        key: "output".to_owned(),
        message: format!("the run would write about {}", bytes(output)),
        help: "write fields less often with output.fields = { time = ... }, or \
               output.precision = \"f32\""
            .to_owned(),
        location: None,
    };
    style::complain(&warning.to_string());
}

fn bytes(size: f64) -> String {
    if size.is_nan() || size >= 1e16 {
        return "more than any disk holds".to_owned();
    }
    let larger = ["kB", "MB", "GB", "TB"];
    let (mut number, mut unit) = (size, None);
    for name in larger {
        if number >= 1000.0 {
            (number, unit) = (number / 1000.0, Some(name));
        }
    }
    unit.map_or_else(|| format!("{number:.0} bytes"), |unit| format!("{number:.1} {unit}"))
}

/// Steps are short: down to milliseconds.
fn duration_of_step(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => "less than 1 ms".to_owned(),
        s if s < 0.0995 => format!("{:.0} ms", 1e3 * s),
        s if s < 1.0 => format!("{s:.2} s"),
        s => duration(s),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than a second".to_owned(),
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 597.0 => format!("{:.1} min", s / 60.0),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 1e6 => format!("{:.1} h", s / 3600.0),
        s if s < 3e9 => format!("{:.0} days", s / 86400.0),
        _ => "more than a century".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_their_unit() {
        assert_eq!(bytes(12.0), "12 bytes");
        assert_eq!(bytes(1.5e6), "1.5 MB");
        assert_eq!([4.23, 90.0, 250.0].map(duration), ["4.2 s", "90 s", "4.2 min"]);
        assert_eq!(duration(9000.0), "2.5 h");
        assert_eq!(duration(2e6), "23 days");
        assert_eq!(duration(f64::INFINITY), "more than a century");
        assert_eq!(bytes(f64::INFINITY), "more than any disk holds");
    }
}
