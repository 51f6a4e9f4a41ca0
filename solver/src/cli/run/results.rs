//! What a run has come to, as it is reported on the terminal.

use crate::case::{Model, significant};
use crate::cli::style::{Ink, on_stdout, say};
use crate::observer::warnings;
use crate::run::RunSummary;
use crate::validation::{Comparison, Verdict, comparison_table};

/// Prints what a run warned of, however little it says otherwise.
pub fn print_run_warnings() {
    let all = warnings();
    let number = match all.len() {
        0 => return,
        1 => "1 warning".to_owned(),
        n => format!("{n} warnings"),
    };
    say(&format!("{}, in status.json, too:", on_stdout(Ink::Yellow, &number)));
    all.iter().for_each(|one| say(&format!("  {}", one.line())));
}

/// Prints by how much the flow crosses cells at most, for a flow with convection.
pub fn print_cell_numbers(outcome: &RunSummary) {
    let most = |name: &str| {
        let column = outcome.series.column(name)?;
        Some(column.into_iter().fold(0.0, f64::max))
    };
    match (most("flow.cfl"), most("flow.cell_reynolds")) {
        (Some(cfl), Some(reynolds)) => {
            say(&format!("CFL number up to {cfl:.2}, cell Reynolds number up to {reynolds:.1}"));
        }
        (None, Some(reynolds)) => say(&format!("cell Reynolds number up to {reynolds:.1}")),
        _ => {}
    }
}

/// Prints what the steps of a run leave, as far as that is known.
pub fn print_step_errors(outcome: &RunSummary) {
    let Some(errors) = outcome.step_errors else { return };
    let parts = [("velocity", errors.velocity), ("ways", errors.ways), ("forces", errors.loads)];
    let known = parts.into_iter().filter_map(|(name, part)| Some((name, part?)));
    let known: Vec<String> =
        known.map(|(name, part)| format!("{name} {} %", two_digits(100.0 * part))).collect();
    if !known.is_empty() {
        say(&format!("left by the steps, by estimates: {}", known.join(", ")));
    }
}

/// A number with two digits, with an exponent where it is far from 1.
fn two_digits(value: f64) -> String {
    let rounded = format!("{value:.1e}");
    let is_near = (1e-3..1e4).contains(&value.abs());
    rounded.parse::<f64>().ok().filter(|_| is_near).map_or(rounded, |value| value.to_string())
}

/// Prints how bodies and scalars ended, for a case without references.
pub fn print_last_values(model: &Model, outcome: &RunSummary) {
    let Some(last) = outcome.series.rows.last() else { return };
    // Of the many bodies of a swimmer only what they do together.
    let is_alone = |body: usize| {
        !model.swimmers.iter().any(|one| one.bodies.len() > 1 && one.bodies.contains(&body))
    };
    let bodies = model.bodies.iter().enumerate().filter(|(index, _)| is_alone(*index));
    let shown: Vec<&str> = bodies
        .map(|(_, body)| body.name.as_str())
        .chain(model.swimmers.iter().map(|swimmer| swimmer.name.as_str()))
        // Scalars have it before their names
        .chain(["scalar"])
        .collect();
    let is_shown = |name: &str| shown.iter().any(|shown| name.starts_with(&format!("{shown}.")));
    for (name, value) in outcome.series.names.iter().zip(last) {
        // Of cycles nothing is known before the first has ended
        let is_mean =
            name.contains("flow.mean_velocity") || name.contains("flow.pressure_gradient");
        if (is_mean || is_shown(name)) && !name.contains("surface_") && !value.is_nan() {
            say(&format!("{name:32}  {}", significant(*value)));
        }
    }
}

/// Prints the table of comparisons, verdicts in colour, with reasons and notes.
pub fn print_comparisons(comparisons: &[Comparison]) {
    if comparisons.is_empty() {
        return;
    }
    let table = comparison_table(comparisons);
    let mut lines = table.iter();
    if let Some(header) = lines.next() {
        say(&on_stdout(Ink::Bold, header));
    }
    for (line, comparison) in lines.zip(comparisons) {
        let ink = match comparison.verdict {
            Verdict::Within => Ink::Green,
            Verdict::KnownOutside => Ink::Yellow,
            Verdict::Outside | Verdict::NoLongerOutside | Verdict::NotComputed => Ink::Red,
        };
        let word = comparison.verdict.name();
        let start = line.len() - word.len();
        say(&format!("{}{}", &line[..start], on_stdout(ink, word)));
        if let Err(reason) = &comparison.computed {
            say(&format!("    {reason}"));
        }
        if let Some(reason) = &comparison.reference.expected.outside {
            say(&format!("    known to be outside: {reason}"));
        }
    }
}
