//! `check`: what a case is, what follows from it, and what it would cost; nothing is solved.

use std::fmt::Write as _;

use alewife_mesh::Mesh;

use super::engine;
use super::exit::{Exit, Failure};
use super::read::{CheckedCase, read_and_check};
use super::style::{self, Ink, on_stdout, say};
use crate::case::{
    BoundaryCondition, Cadence, Case, CaseFile, Diagnostic, DomainSpec, FlowModel, GaitSpec, Joint,
    JointKind, Model, Motion, Precision, Scheme, ShapeSpec, Stroke, SwimmerModel, TimeSettings,
    geometry_name, known_quantities, number_table, printable, significant,
};
use crate::coupling::{FluidSystem, memory_estimate};
use crate::simulation::build_problem;

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
    say(text.trim_end());
    if has_mesh {
        let mesh = engine::build_mesh(&file.model)?;
        say(&format!("\n{}", on_stdout(Ink::Bold, "mesh")));
        for line in engine::mesh_quality(&mesh).to_string().lines() {
            say(&format!("  {line}"));
        }
        say(&format!(
            "\n{}\n{}",
            on_stdout(Ink::Bold, "cost (a rough guess)"),
            costs(&file.model, &mesh)?
        ));
    }
    if !warnings.is_empty() {
        style::complain(&format!("\n{}", style::diagnostics(&warnings)));
    }
    check_variants(argument, &file, settings)?;
    say("\nnothing was solved");
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

/// A text that is meant to be one line, as it may be shown on a terminal.
pub fn one_line(text: &str) -> String {
    printable(&text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// What a case consists of, as lines `what  value`.
pub fn facts(file: &CaseFile) -> String {
    let (case, model) = (file.case(), &file.model);
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {what:<10} {value}");
    };
    line("file", printable(&file.file));
    let units = format!("{}, units: {}", geometry_name(case.geometry), one_line(&case.units));
    line("geometry", units);
    line("fluid", fluid(case));
    line("domain", domain(&case.domain));
    let sides = case.domain.sides().iter().filter(|side| **side != "axis").map(|side| {
        let condition = case.boundary.get(*side).map_or("nothing", condition_name);
        format!("{side} {condition}")
    });
    line("boundary", sides.collect::<Vec<_>>().join(", "));
    for body in &model.bodies {
        line("body", body_line(case, body));
    }
    for joint in &model.joints {
        line("joint", joint_line(joint));
    }
    for swimmer in &model.swimmers {
        line("swimmer", swimmer_line(model, swimmer));
    }
    line("time", time(case));
    if let Some(frame) = &case.frame {
        line("frame", format!("travels with {frame}"));
    }
    let n = case.reference.len();
    let in_variants: usize = case.variant.iter().map(|variant| variant.reference.len()).sum();
    line(
        "reference",
        match (n, in_variants) {
            (0, 0) => "none: the result is not compared with anything".to_owned(),
            (1, 0) => "1 published value".to_owned(),
            (n, 0) => format!("{n} published values"),
            (n, more) => format!("{} published values, {more} of them in variants", n + more),
        },
    );
    text
}

fn fluid(case: &Case) -> String {
    let fluid = &case.fluid;
    let model = match fluid.model {
        FlowModel::Stokes => "Stokes",
        FlowModel::UnsteadyStokes => "unsteady Stokes",
        FlowModel::NavierStokes => "Navier-Stokes",
    };
    let density = if fluid.density > 0.0 {
        format!(", density {}", significant(fluid.density))
    } else {
        String::new()
    };
    format!("{model}, viscosity {}{density}", significant(fluid.viscosity))
}

fn domain(domain: &DomainSpec) -> String {
    match domain {
        DomainSpec::Box { min, max } => format!("box from {min:?} to {max:?}"),
        DomainSpec::Channel { length, height } => {
            format!("channel {} long, {} high", significant(*length), significant(*height))
        }
        DomainSpec::Disc { radius, .. } => format!("disc of radius {}", significant(*radius)),
        DomainSpec::HalfDisc { radius, .. } => format!("ball of radius {}", significant(*radius)),
        DomainSpec::Cylinder { x, radius } => {
            let [start, end, radius] = [x[0], x[1], *radius].map(significant);
            format!("cylinder from x = {start} to {end} of radius {radius}")
        }
    }
}

fn condition_name(condition: &BoundaryCondition) -> &'static str {
    match condition {
        BoundaryCondition::NoSlip => "no-slip",
        BoundaryCondition::DoNothing => "do-nothing",
        BoundaryCondition::TractionFree => "traction-free",
        BoundaryCondition::Symmetry => "symmetry",
        BoundaryCondition::Axis => "axis",
        BoundaryCondition::Velocity { .. } => "velocity",
        BoundaryCondition::Parabolic { .. } => "parabolic",
        BoundaryCondition::Shear { .. } => "shear",
        BoundaryCondition::WavingSheet { .. } => "waving-sheet",
        BoundaryCondition::Periodic(_) => "periodic",
    }
}

fn body_line(case: &Case, body: &crate::case::Body) -> String {
    let shape = match &body.shape {
        ShapeSpec::Disc { radius } | ShapeSpec::Sphere { radius } => {
            format!("{} of radius {}", body.shape.name(), significant(*radius))
        }
        ShapeSpec::Ellipse { semi_axes } | ShapeSpec::Spheroid { semi_axes } => {
            format!("{} with semi-axes {semi_axes:?}", body.shape.name())
        }
        ShapeSpec::Spline { points } => format!("spline through {} points", points.len()),
        ShapeSpec::Fish(fish) => format!("fish of length {}", significant(fish.length)),
        ShapeSpec::Flagellate(flagellate) => {
            let length = significant(flagellate.tail_length);
            format!("flagellate with a tail of length {length}")
        }
    };
    let motion = match &body.motion {
        Motion::Held => "held",
        Motion::Free => "free",
        Motion::Imposed(_) => "imposed motion",
    };
    let gait = match &body.gait {
        Some(GaitSpec::Squirmer(gait)) => {
            // The axis turns with the body, and both may be given
            format!(", squirmer heading {}", angle_in_words(body.angle + gait.heading))
        }
        Some(GaitSpec::Carangiform(_)) => ", carangiform".to_owned(),
        Some(GaitSpec::Anguilliform(_)) => ", anguilliform".to_owned(),
        Some(GaitSpec::Flagellum(_)) => ", flagellum".to_owned(),
        Some(GaitSpec::Pulsating(_)) => ", pulsating".to_owned(),
        None => String::new(),
    };
    let size = body.size.or(case.mesh.surface).unwrap_or(case.mesh.size) * case.mesh.scale;
    let edges = body.shape.perimeter() / size;
    let at: Vec<String> = body.center.iter().map(|value| significant(*value)).collect();
    let at = at.join(", ");
    let turned = match (body.angle, body.is_round()) {
        (0.0, _) | (_, true) => String::new(),
        (angle, false) => format!(", turned by {}", angle_in_words(angle)),
    };
    format!(
        "{}: {shape} at [{at}]{turned}, {motion}{gait}, about {} edges",
        body.name,
        count(edges)
    )
}

/// An angle in radians and degrees.
fn angle_in_words(angle: f64) -> String {
    format!("{} rad ({:.1} degrees)", significant(angle), angle.to_degrees())
}

fn joint_line(joint: &Joint) -> String {
    let range = |stroke: &Stroke, number: fn(f64) -> String| match stroke {
        Stroke::Constant(value) => number(*value),
        _ => stroke.range().map(number).join(" to "),
    };
    let stroke = |stroke: &Stroke| range(stroke, significant);
    let what = match &joint.kind {
        JointKind::Arm { length, direction } => {
            format!("arm of length {}, direction {}", stroke(length), angle_in_words(*direction))
        }
        JointKind::Bent { angle } => format!("bent by {}", range(angle, angle_in_words)),
        JointKind::Hinge(hinge) => {
            let motor = hinge.torque.as_ref().map(|torque| format!(", torque {}", stroke(torque)));
            format!(
                "hinge, stiffness {}, damping {}{}",
                significant(hinge.stiffness),
                significant(hinge.damping),
                motor.unwrap_or_default()
            )
        }
    };
    format!("{} is attached to {}: {what}", joint.child, joint.parent)
}

fn swimmer_line(model: &Model, swimmer: &SwimmerModel) -> String {
    let bodies = match swimmer.bodies.len() {
        1 => "1 body".to_owned(),
        n => format!("{n} bodies, reported as one"),
    };
    let period = swimmer.period.map(|period| format!(", period {}", significant(period)));
    let motion = match swimmer.bodies.iter().all(|body| model.bodies[*body].motion == Motion::Free)
    {
        true => ", swims freely",
        false => "",
    };
    format!("{}: {bodies}{}{motion}", swimmer.name, period.unwrap_or_default())
}

fn time(case: &Case) -> String {
    match &case.time {
        TimeSettings::Steady(_) => "steady".to_owned(),
        TimeSettings::Unsteady(time) if time.adaptive.is_some() => {
            format!("adaptive steps from {} to {}", significant(time.step), significant(time.end))
        }
        TimeSettings::Unsteady(time) => format!(
            "{} steps of {} to {}",
            count((time.end / time.step).ceil()),
            significant(time.step),
            significant(time.end)
        ),
    }
}

/// Linear systems a run solves: exact for steady Stokes flow, a usual number otherwise.
fn n_systems(model: &Model) -> f64 {
    let case = &model.case;
    match (&case.time, case.fluid.model) {
        (TimeSettings::Steady(_), FlowModel::NavierStokes) => 6.0,
        (TimeSettings::Steady(_), _) => 1.0,
        (TimeSettings::Unsteady(time), _) => {
            let a_step = match time.scheme {
                // One for each stage
                Scheme::Rk3 => 3.0,
                // Bodies and mesh agree after another pass
                _ if model.mesh_moves() => 2.0,
                _ => 1.0,
            };
            a_step * (time.end / time.step).ceil()
        }
    }
}

/// Unknowns, memory, time and files of a run.
fn costs(model: &Model, mesh: &Mesh<2>) -> Result<String, Failure> {
    let on_mesh = 2 * mesh.n_nodes() + mesh.n_vertices;
    let free = FluidSystem::count_unknowns(&build_problem(model, mesh)?, mesh);
    let n_dofs = free as f64;
    let memory = memory_estimate(on_mesh);
    // Measured on planar runs with 1.1 10^4 to 2 10^5 unknowns on one core, all systems factorised.
    let factorisation = 0.0095 * (n_dofs / 1e4).powf(1.4);
    // What follows the bodies: the mesh, its quality, contact, measurements, remeshing.
    let following = if model.mesh_moves() { 0.5 } else { 0.0 };
    let assembly = 6e-7 * n_dofs;
    let systems = n_systems(model);
    let output = output_size(model, mesh);
    let mut text = String::new();
    let unknowns = format!("{free} free ones; {on_mesh} velocities and pressures on the mesh");
    let _ = writeln!(text, "  {:<16} {unknowns}", "unknowns");
    let _ =
        writeln!(text, "  {:<16} {}, most of it for the factorisation", "memory", bytes(memory));
    let seconds = (factorisation + assembly) * (1.0 + following);
    let is_adaptive =
        matches!(&model.case.time, TimeSettings::Unsteady(time) if time.adaptive.is_some());
    let cost = if is_adaptive {
        format!("{} for each linear system; their number depends on the steps", duration(seconds))
    } else {
        let plural = if systems == 1.0 { "" } else { "s" };
        format!("{} for {} linear system{plural}", duration(systems * seconds), count(systems))
    };
    let _ = writeln!(text, "  {:<16} {cost}", "CPU time");
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
fn output_size(model: &Model, mesh: &Mesh<2>) -> f64 {
    let case = &model.case;
    let times = |cadence: Cadence| match (cadence, &case.time) {
        (Cadence::Never, _) => 0.0,
        (Cadence::End, _) | (_, TimeSettings::Steady(_)) => 1.0,
        (Cadence::Steps(n), TimeSettings::Unsteady(time)) => {
            1.0 + (time.end / time.step / n.max(1) as f64).ceil()
        }
        (Cadence::Time(interval), TimeSettings::Unsteady(time)) => {
            1.0 + (time.end / interval).ceil()
        }
    };
    let number = match case.output.precision {
        Precision::F32 => 4.0,
        Precision::F64 => 8.0,
    };
    // Positions as doubles; velocity, pressure and vorticity; six indices a cell. zlib halves it.
    let frame = 0.5
        * (mesh.n_nodes() as f64 * (3.0 * 8.0 + 5.0 * number) + mesh.n_cells() as f64 * 6.0 * 8.0);
    // A row of text, and a message a body.
    let row = 20.0 * known_quantities(model).len() as f64 + 300.0 * model.bodies.len() as f64;
    times(case.output.fields) * frame + times(case.output.series) * row
}

/// A number of things, in powers of ten where there are many.
fn count(number: f64) -> String {
    if number < 1e7 { format!("{number:.0}") } else { format!("{number:.1e}") }
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

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than a second".to_owned(),
        s if s < 120.0 => format!("{s:.0} s"),
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
        assert_eq!(duration(90.0), "90 s");
        assert_eq!(duration(9000.0), "2.5 h");
        assert_eq!(duration(2e6), "23 days");
        assert_eq!(duration(f64::INFINITY), "more than a century");
        assert_eq!(bytes(f64::INFINITY), "more than any disk holds");
        assert_eq!([count(64.4), count(2.5e9)], ["64", "2.5e9"]);
    }
}
