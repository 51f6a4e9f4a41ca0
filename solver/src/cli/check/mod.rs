//! `check`: what a case is, what follows from it, and what it would cost, by one step that is made.

mod cost;

use std::fmt::Write as _;

use alewife_mesh::Quality;

use crate::case::soft::SoftFile;
use crate::case::{
    CaseFile, Convection, Diagnostic, FlowModel, Model, Severity, Sweep, TimeSettings,
    check_starts, number_table, printable, significant,
};
use crate::cli::exit::{Exit, Failure};
use crate::cli::facts::{facts, one_line};
use crate::cli::optimise::search_line;
use crate::cli::read::{CheckedCase, as_warnings, print_warnings, read_and_check};
use crate::cli::soft;
use crate::cli::style::{self, Ink, on_stdout, say};
use crate::cli::sweep::check_points;
use crate::observer::reset_peak_memory;
use crate::reduced::check_records;
use crate::run::{BodyRecoil, Dimension, RunError, Solve, build_mesh, recoils};
use crate::runner::{threads, with_key};
use crate::timing::cpu_seconds;

/// How far a case is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Depth {
    /// As a text.
    Text,
    /// With its mesh.
    Mesh,
    /// With a step that is made on it.
    Step,
}

/// Checks cases one after the other; the first bad one decides the exit code and is printed last.
pub fn check(cases: &[String], settings: &[String], depth: Depth) -> Result<Exit, Failure> {
    let mut worst: Option<Failure> = None;
    for (index, argument) in cases.iter().enumerate() {
        if index > 0 {
            say("");
        }
        if let Err(failure) = check_one(argument, settings, depth) {
            match worst {
                None => worst = Some(failure),
                Some(_) => style::complain(&failure.message),
            }
        }
    }
    match worst {
        Some(failure) => Err(failure),
        None => Ok(Exit::Done),
    }
}

fn check_one(argument: &str, settings: &[String], depth: Depth) -> Result<(), Failure> {
    if let Some(file) = SoftFile::read_if_soft(argument, settings)? {
        return soft::check(&file).map(|_| ());
    }
    let CheckedCase { file, mut warnings } = read_and_check(argument, settings)?;
    let mut text =
        format!("{}  {}\n", on_stdout(Ink::Bold, &file.full_name()), one_line(&file.case().title));
    text += &facts(&file);
    let numbers = number_table(&file.model);
    if !numbers.is_empty() {
        let _ = write!(text, "\n{}\n{numbers}", on_stdout(Ink::Bold, "derived numbers"));
    }
    let recoils = recoils(&file.model)?;
    if !recoils.is_empty() {
        let _ = write!(text, "\n{}\n", on_stdout(Ink::Bold, "recoil subtracted from the gaits"));
        text.extend(recoils.iter().map(|recoil| format!("  {}\n", recoil_line(recoil))));
    }
    let wrong = check_records(&file);
    if let Some(diagnostic) = wrong.and_then(|error| error.diagnostic(&file)) {
        return Err(Failure::wrong(&[diagnostic]));
    }
    if let Some(line) = search_line(&file) {
        let _ = write!(text, "\n{line}\n");
    }
    say(text.trim_end());
    if depth >= Depth::Mesh && !file.case().is_reduced_only() {
        match file.case().geometry.dimensions() {
            2 => tell_of_mesh::<2>(&file, depth)?,
            _ => tell_of_mesh::<3>(&file, depth)?,
        }
    }
    // A run can be made at numbers from which a search does not start
    warnings.extend(as_warnings(check_starts(&file)));
    if !warnings.is_empty() {
        style::complain(&format!("\n{}", style::diagnostics(&warnings)));
    }
    check_variants(argument, &file, settings)?;
    if file.has_sweep {
        check_sweep(argument)?;
    }
    say("\nnothing was run");
    Ok(())
}

/// Prints the mesh of a case, and what a step on it takes.
fn tell_of_mesh<const D: usize>(file: &CaseFile, depth: Depth) -> Result<(), Failure>
where
    Dimension<D>: Solve<D>,
{
    reset_peak_memory();
    let (before, model) = (cpu_seconds(), &file.model);
    let mesh = build_mesh::<D>(model).map_err(|error| with_key(file, error))?;
    let seconds = cpu_seconds() - before;
    say(&format!("\n{}", on_stdout(Ink::Bold, "mesh")));
    let quality = Dimension::<D>::quality(&mesh);
    for line in quality.to_string().lines() {
        say(&format!("  {line}"));
    }
    for line in cell_numbers(model, &quality) {
        say(&format!("  {line}"));
    }
    if let Some(warning) = long_steps(file, &quality) {
        print_warnings(&[warning]);
    }
    if depth >= Depth::Step {
        let title = on_stdout(Ink::Bold, "cost, by one step that was made");
        let cost = match threads::within(|| Dimension::<D>::time_step(model, mesh)) {
            Ok(timed) => cost::measured(model, &timed, seconds)?,
            // On this machine
            Err(error @ RunError::TooLarge { .. }) => format!("  none was made: {error}"),
            Err(error) => return Err(with_key(file, error)),
        };
        say(&format!("\n{title}\n{cost}"));
    }
    Ok(())
}

/// Every variant has to be right, too.
fn check_variants(argument: &str, file: &CaseFile, settings: &[String]) -> Result<(), Failure> {
    for variant in &file.case().variant {
        let name = format!("{argument}/{}", variant.name);
        read_and_check(&name, settings).map_err(|failure| Failure {
            message: format!("in variant {name}\n{}", failure.message),
            ..failure
        })?;
    }
    if !file.case().variant.is_empty() {
        say(&format!("\n{} variants are valid, too", file.case().variant.len()));
    }
    Ok(())
}

/// So has every point of the sweep, as the file has it.
fn check_sweep(argument: &str) -> Result<(), Failure> {
    let sweep = Sweep::read(argument, &[])?;
    let n = sweep.n_points();
    let warnings = check_points(&sweep, 0..n)?;
    say(&format!("\nsweep of {n} points over {}: all are valid", sweep.keys().join(", ")));
    print_warnings(&warnings);
    Ok(())
}

/// The rigid motion that is subtracted from the gait of a body, in a line.
fn recoil_line(recoil: &BodyRecoil) -> String {
    let BodyRecoil { body, motion } = recoil;
    let name = printable(body);
    if motion.largest_speed == 0.0 && motion.largest_angular_velocity == 0.0 {
        return format!("{name}: none, its gait has no momentum");
    }
    let number = |value: f64| format!("{value:.3e}");
    let turn = motion.turn.to_degrees();
    let turn = if turn.abs() < 5e-3 {
        String::new()
    } else {
        let time = significant(motion.duration);
        format!(", and it turns by {turn:.2} degrees in {time} units of time")
    };
    format!(
        "{name}: translation up to {} (speed up to {}, rms {}), rotation up to {:.2} degrees (up to \
         {:.1} degrees per unit of time, rms {:.1}){turn}",
        number(motion.translation),
        number(motion.largest_speed),
        number(motion.rms_speed),
        motion.rotation.to_degrees(),
        motion.largest_angular_velocity.to_degrees(),
        motion.rms_angular_velocity.to_degrees(),
    )
}

/// A warning of fixed steps in which fluid at the expected speed crosses several cells.
fn long_steps<const D: usize>(file: &CaseFile, quality: &Quality<D>) -> Option<Diagnostic> {
    let case = file.case();
    let TimeSettings::Unsteady(time) = &case.time else { return None };
    let speed = file.model.expected_speed()?;
    let cfl = speed * time.step / quality.shortest_edge;
    let most = Convection::LARGEST_CFL;
    let is_convected = case.fluid.model == FlowModel::NavierStokes;
    if !is_convected || time.adaptive.is_some() || cfl <= most {
        return None;
    }
    let shorter = significant(time.step * most / cfl);
    let help = match time.convection {
        Convection::Extrapolated => format!(
            "extrapolated convection was shown to hold up to {most}: write steps of {shorter} or less, larger \
             cells where the flow is fast, or time.unsteady.adaptive"
        ),
        Convection::Newton => format!(
            "what changes within a step is not resolved in time: compare with a run in steps of {shorter}, or \
             let time.unsteady.adaptive choose them"
        ),
    };
    let key = "time.unsteady.step";
    Some(Diagnostic {
        severity: Severity::Warning,
        key: key.to_owned(),
        message: format!(
            "the CFL number is up to {} at the speed {} in the shortest cell",
            significant(cfl),
            significant(speed)
        ),
        help,
        location: file.location(key),
    })
}

/// CFL number and cell Reynolds number at the expected speed.
fn cell_numbers<const D: usize>(model: &Model, quality: &Quality<D>) -> Vec<String> {
    let case = &model.case;
    let speed = model.expected_speed().filter(|_| case.fluid.model == FlowModel::NavierStokes);
    let Some(speed) = speed else { return Vec::new() };
    let at = format!("at the speed {}", significant(speed));
    let reynolds = case.fluid.density * speed * quality.longest_edge / case.reference_viscosity();
    let mut lines =
        vec![format!("cell Reynolds    up to {}, {at} in the longest cell", significant(reynolds))];
    if let TimeSettings::Unsteady(time) = &case.time {
        let cfl = speed * time.step / quality.shortest_edge;
        lines.push(format!("CFL number       up to {}, {at} in the shortest", significant(cfl)));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recoil_of_a_gait_is_told_in_degrees() {
        let lines = |name: &str| -> Vec<String> {
            let model = crate::case::Case::read(name, &[]).unwrap().model;
            recoils(&model).unwrap().iter().map(recoil_line).collect()
        };
        let [fish] = &lines("carangiform")[..] else { panic!("is one fish") };
        assert!(fish.starts_with("fish: translation up to 8"), "{fish}");
        assert!(fish.contains("rotation up to") && fish.contains("degrees"), "{fish}");
        let spheres = lines("push-me-pull-you");
        assert_eq!(spheres.len(), 2);
        assert!(spheres[0].ends_with("none, its gait has no momentum"), "{spheres:?}");
        assert!(lines("dfg-2d-1").is_empty());
    }
}
