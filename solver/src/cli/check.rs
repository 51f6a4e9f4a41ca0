//! `check`: what a case is, what follows from it, and what it would cost; nothing is solved.

use std::fmt::Write as _;

use alewife_mesh::{Mesh, Quality};

use super::cost::{Cost, FirstMesh};
use super::engine;
use super::exit::{Exit, Failure};
use super::facts::{count, facts, one_line};
use super::read::{CheckedCase, read_and_check};
use super::style::{self, Ink, on_stdout, say};
use super::sweep::check_points;
use super::too_large;
use crate::case::{
    Cadence, CaseFile, Diagnostic, FlowModel, Model, Precision, Sweep, TimeSettings,
    known_quantities, number_table, printable, significant,
};
use crate::run::{BodyRecoil, Dimension, Solve, recoils};
use crate::timing::cpu_seconds;

/// Output above which a warning is given (bytes).
const LARGE_OUTPUT: f64 = 2e9;

/// Checks cases one after the other; the first bad one decides the exit code and is printed last.
pub fn check(cases: &[String], settings: &[String], has_mesh: bool) -> Result<Exit, Failure> {
    let mut worst: Option<Failure> = None;
    for (index, argument) in cases.iter().enumerate() {
        if index > 0 {
            say("");
        }
        if let Err(failure) = check_one(argument, settings, has_mesh) {
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

fn check_one(argument: &str, settings: &[String], has_mesh: bool) -> Result<(), Failure> {
    let CheckedCase { file, warnings } = read_and_check(argument, settings)?;
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
    say(text.trim_end());
    if has_mesh {
        match file.case().geometry.dimensions() {
            2 => tell_of_mesh::<2>(&file)?,
            _ => tell_of_mesh::<3>(&file)?,
        }
    }
    if !warnings.is_empty() {
        style::complain(&format!("\n{}", style::diagnostics(&warnings)));
    }
    check_variants(argument, &file, settings)?;
    if file.has_sweep {
        check_sweep(argument)?;
    }
    say("\nnothing was solved");
    Ok(())
}

/// Prints the mesh of a case, and what follows from it.
fn tell_of_mesh<const D: usize>(file: &CaseFile) -> Result<(), Failure>
where
    Dimension<D>: Solve<D>,
{
    let (before, model) = (cpu_seconds(), &file.model);
    let mesh = engine::build_mesh::<D>(model).map_err(|error| too_large::failure(file, error))?;
    let seconds = cpu_seconds() - before;
    say(&format!("\n{}", on_stdout(Ink::Bold, "mesh")));
    let quality = Dimension::<D>::quality(&mesh);
    for line in quality.to_string().lines() {
        say(&format!("  {line}"));
    }
    for line in cell_numbers(model, &quality) {
        say(&format!("  {line}"));
    }
    say(&format!(
        "\n{}\n{}",
        on_stdout(Ink::Bold, "cost (a rough guess)"),
        costs(model, &mesh, &quality, seconds)?
    ));
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
    if !warnings.is_empty() {
        style::complain(&style::diagnostics(&warnings));
    }
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

/// CFL number and cell Reynolds number at the expected speed.
fn cell_numbers<const D: usize>(model: &Model, quality: &Quality<D>) -> Vec<String> {
    let case = &model.case;
    let speed = model.expected_speed().filter(|_| case.fluid.model == FlowModel::NavierStokes);
    let Some(speed) = speed else { return Vec::new() };
    let at = format!("at the speed {}", significant(speed));
    let reynolds = case.fluid.density * speed * quality.longest_edge / case.fluid.viscosity;
    let mut lines =
        vec![format!("cell Reynolds    up to {}, {at} in the longest cell", significant(reynolds))];
    if let TimeSettings::Unsteady(time) = &case.time {
        let cfl = speed * time.step / quality.shortest_edge;
        lines.push(format!("CFL number       up to {}, {at} in the shortest", significant(cfl)));
    }
    lines
}

/// Unknowns, memory, time and files of a run, whose mesh took some CPU time (s).
fn costs<const D: usize>(
    model: &Model,
    mesh: &Mesh<D>,
    quality: &Quality<D>,
    seconds: f64,
) -> Result<String, Failure>
where
    Dimension<D>: Solve<D>,
{
    let on_mesh = D * mesh.n_nodes() + mesh.n_vertices;
    let free = Dimension::<D>::count_unknowns(model, mesh)?;
    let shortest_edge = quality.shortest_edge;
    let cost = Cost::of(model, &FirstMesh { free, on_mesh, shortest_edge, seconds });
    let output = output_size(model, mesh);
    let mut text = String::new();
    let unknowns = format!("{free} free ones; {on_mesh} velocities and pressures on the mesh");
    let _ = writeln!(text, "  {:<16} {unknowns}", "unknowns");
    if cost.in_films >= 1.0 {
        let more = format!("up to {} more where bodies come near", count(round(cost.in_films)));
        let _ = writeln!(text, "  {:<16} {more}", "");
    }
    let most = match (D, cost.new_meshes >= 1.0) {
        (3, _) => "most of it for the matrix and its preconditioner",
        (_, true) => "for the factorisation, and for new meshes",
        (_, false) => "most of it for the factorisation",
    };
    let _ = writeln!(text, "  {:<16} {}, {most}", "memory", bytes(cost.memory));
    let systems = if cost.systems == 1.0 {
        "one linear system".to_owned()
    } else {
        format!("about {} linear systems", count(round(cost.systems)))
    };
    let mut line = format!("{} for {systems}", duration(cost.seconds));
    if cost.new_meshes >= 1.0 {
        let _ = write!(line, " and {} new meshes", count(round(cost.new_meshes)));
    }
    if let Some(seconds) = cost.step_seconds {
        let _ = write!(line, ", {} a step", duration_of_step(seconds));
    }
    let _ = writeln!(text, "  {:<16} {line}", "CPU time");
    let _ = write!(text, "  {:<16} {}", "output", bytes(output));
    if output > LARGE_OUTPUT {
        let warning = Diagnostic {
            severity: crate::case::Severity::Warning,
            key: "output".to_owned(),
            message: format!("the run would write about {}", bytes(output)),
            help: "write fields less often with output.fields = { time = ... }, or \
                   output.precision = \"f32\""
                .to_owned(),
            location: None,
        };
        style::complain(&style::diagnostic(&warning));
    }
    Ok(text)
}

/// Files of a run (bytes).
fn output_size<const D: usize>(model: &Model, mesh: &Mesh<D>) -> f64 {
    let case = &model.case;
    let times = |cadence: Cadence| match (cadence, &case.time) {
        (Cadence::Never, _) => 0.0,
        (Cadence::End, _) | (_, TimeSettings::Steady(_)) => 1.0,
        (Cadence::Steps(n), TimeSettings::Unsteady(time)) => {
            1.0 + (time.end / time.step / n.max(1) as f64).ceil()
        }
        (Cadence::Time(interval), TimeSettings::Unsteady(time)) => {
            // Once a step at most
            1.0 + (time.end / interval).min(time.end / time.step).ceil()
        }
    };
    let number = match case.output.precision {
        Precision::F32 => 4.0,
        Precision::F64 => 8.0,
    };
    // Positions as doubles; velocity, pressure and vorticity; six or ten indices a cell. zlib halves
    // it in the plane, where one coordinate is always zero.
    let [values, indices, compressed] = if D == 3 { [7.0, 10.0, 0.65] } else { [5.0, 6.0, 0.5] };
    let frame = compressed
        * (mesh.n_nodes() as f64 * (3.0 * 8.0 + values * number)
            + mesh.n_cells() as f64 * indices * 8.0);
    // A row of text, and a message a body.
    let row = 20.0 * known_quantities(model).len() as f64 + 300.0 * model.bodies.len() as f64;
    times(case.output.fields) * frame + times(case.output.series) * row
}

/// To two digits.
fn round(number: f64) -> f64 {
    let unit = 10f64.powf(number.max(1.0).log10().floor() - 1.0);
    (number / unit).round() * unit
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
