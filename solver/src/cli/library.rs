//! `list` and `show`: the shipped cases, and what one is about.

use std::fmt::Write as _;

use super::exit::{Exit, Failure};
use super::facts::{facts, one_line};
use super::optimise::search_line;
use super::soft;
use super::style::{Ink, on_stdout, say};
use crate::case::soft::SoftFile;
use crate::case::{
    Case, CaseFile, Reference, check, library, number_table, printable, significant,
};

/// Lists the shipped cases.
pub fn list(is_long: bool) -> Result<Exit, Failure> {
    let shipped = library::list();
    let width =
        shipped.iter().chain(library::soft()).map(|case| case.name.len()).max().unwrap_or(0);
    for entry in shipped {
        let file = Case::read(entry.name, &[])?;
        let case = file.case();
        let name = on_stdout(Ink::Bold, &format!("{:<width$}", entry.name));
        let variants = match case.variant.len() {
            0 => String::new(),
            1 => " (1 variant)".to_owned(),
            n => format!(" ({n} variants)"),
        };
        say(&format!("{name}  {}{variants}", one_line(&case.title)));
        if is_long {
            for reference in &case.reference {
                say(&format!("{:width$}    {}", "", reference_line(reference)));
            }
            for variant in &case.variant {
                say(&format!("{:width$}    {}/{}", "", entry.name, variant.name));
                for reference in &variant.reference {
                    say(&format!("{:width$}      {}", "", reference_line(reference)));
                }
            }
        }
    }
    for entry in library::soft() {
        let Some(file) = SoftFile::declared(entry.name)? else { continue };
        let name = on_stdout(Ink::Bold, &format!("{:<width$}", entry.name));
        say(&format!("{name}  {} (soft)", one_line(&file.case.title)));
    }
    Ok(Exit::Done)
}

/// Shows what a case is about, or prints its text.
pub fn show(argument: &str, is_source: bool) -> Result<Exit, Failure> {
    let soft = SoftFile::declared(argument)?;
    let file = match &soft {
        Some(_) => None,
        None => Some(Case::read(argument, &[])?),
    };
    if is_source {
        say(Case::text(argument)?.trim_end());
        return Ok(Exit::Done);
    }
    let (None, Some(file)) = (&soft, file) else {
        return soft.map_or(Ok(Exit::Done), |file| soft::show(&file));
    };
    say(&summary(&file));
    Ok(Exit::Done)
}

/// Everything known of a case without solving or meshing it.
fn summary(file: &CaseFile) -> String {
    let case = file.case();
    let mut text = format!("{}\n", on_stdout(Ink::Bold, &file.full_name()));
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{}\n", one_line(&case.title));
    if !case.description.trim().is_empty() {
        let _ = writeln!(text, "{}\n", printable(case.description.trim()));
    }
    text += &facts(file);
    let numbers = number_table(&file.model);
    if !numbers.is_empty() {
        let _ = write!(text, "\n{}\n{numbers}", on_stdout(Ink::Bold, "derived numbers"));
    }
    if let Some(line) = search_line(file) {
        let _ = writeln!(text, "\n{line}");
    }
    if !case.reference.is_empty() {
        let _ = writeln!(text, "\n{}", on_stdout(Ink::Bold, "references"));
        for reference in &case.reference {
            text += &reference_lines(reference, "  ");
        }
    }
    if !case.variant.is_empty() {
        let _ = writeln!(text, "\n{}", on_stdout(Ink::Bold, "variants"));
        for variant in &case.variant {
            let set: Vec<String> =
                variant.set.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            let set = printable(&set.join(", "));
            let _ = writeln!(text, "  {}/{}  {set}", file.name, variant.name);
            for reference in &variant.reference {
                text += &reference_lines(reference, "    ");
            }
        }
    }
    let n_problems = check(file).len();
    if n_problems > 0 {
        let remarks = if n_problems == 1 { "remark" } else { "remarks" };
        let _ =
            writeln!(text, "\n{n_problems} {remarks}: see `alewife check {}`", file.full_name());
    }
    text.trim_end().to_owned()
}

/// A reference with its source and note, each line after an indent.
fn reference_lines(reference: &Reference, indent: &str) -> String {
    let mut text = format!(
        "{indent}{}\n{indent}  {}: {}\n",
        reference_line(reference),
        reference.expected.kind.name(),
        reference.expected.source
    );
    if let Some(note) = &reference.expected.note {
        let _ = writeln!(text, "{indent}  note: {note}");
    }
    printable(&text)
}

/// A reference in one line.
fn reference_line(reference: &Reference) -> String {
    let tolerance = match (reference.expected.relative, reference.expected.absolute) {
        (Some(relative), _) => format!("within {} %", significant(100.0 * relative)),
        (None, Some(absolute)) => format!("within {}", significant(absolute)),
        (None, None) => "no tolerance".to_owned(),
    };
    let label = reference.statistic.label();
    let what = match (reference.expected.per == 1.0, &reference.statistic.minus) {
        (true, _) => label,
        (false, None) => format!("{label} / {}", significant(reference.expected.per)),
        (false, Some(_)) => format!("({label}) / {}", significant(reference.expected.per)),
    };
    format!("{what} = {}, {tolerance}", reference.expected.value)
}
