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
    geometry_name, known_quantities, number_table, significant,
};
use crate::coupling::memory_estimate;

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
    let mut text = format!("{}  {}\n", on_stdout(Ink::Bold, &file.full_name()), file.case().title);
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
            costs(&file.model, &mesh)
        ));
    }
    for warning in &warnings {
        style::complain(&format!("\n{}", style::diagnostic(warning)));
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

/// What a case consists of, as lines `what  value`.
pub fn facts(file: &CaseFile) -> String {
    let (case, model) = (file.case(), &file.model);
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {what:<10} {value}");
    };
    line("file", file.file.clone());
    let units = format!("{}, units: {}", geometry_name(case.geometry), case.units);
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
            (1, 0) => "1 reference".to_owned(),
            (n, 0) => format!("{n} references"),
            (n, more) => format!("{} references, {more} of them in variants", n + more),
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
        DomainSpec::Channel { length, height } => format!("channel {length} long, {height} high"),
        DomainSpec::Disc { radius, .. } => format!("disc of radius {radius}"),
        DomainSpec::HalfDisc { radius, .. } => format!("ball of radius {radius}"),
        DomainSpec::Cylinder { x: [start, end], radius } => {
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
            format!("{} of radius {radius}", body.shape.name())
        }
        ShapeSpec::Ellipse { semi_axes } | ShapeSpec::Spheroid { semi_axes } => {
            format!("{} with semi-axes {semi_axes:?}", body.shape.name())
        }
        ShapeSpec::Spline { points } => format!("spline through {} points", points.len()),
        ShapeSpec::Fish(fish) => format!("fish of length {}", fish.length),
        ShapeSpec::Flagellate(flagellate) => {
            format!("flagellate with a tail of length {}", flagellate.tail_length)
        }
    };
    let motion = match &body.motion {
        Motion::Held => "held",
        Motion::Free => "free",
        Motion::Imposed(_) => "imposed motion",
    };
    let gait = match &body.gait {
        Some(GaitSpec::Squirmer(_)) => ", squirmer",
        Some(GaitSpec::Carangiform(_)) => ", carangiform",
        Some(GaitSpec::Anguilliform(_)) => ", anguilliform",
        Some(GaitSpec::Flagellum(_)) => ", flagellum",
        Some(GaitSpec::Pulsating(_)) => ", pulsating",
        None => "",
    };
    let size = body.size.or(case.mesh.surface).unwrap_or(case.mesh.size) * case.mesh.scale;
    let edges = body.shape.perimeter() / size;
    let at: Vec<String> = body.center.iter().map(|value| significant(*value)).collect();
    let at = at.join(", ");
    format!("{}: {shape} at [{at}], {motion}{gait}, about {edges:.0} edges", body.name)
}

fn joint_line(joint: &Joint) -> String {
    let stroke = |stroke: &Stroke| match stroke {
        Stroke::Constant(value) => significant(*value),
        _ => {
            let [least, most] = stroke.range();
            format!("{} to {}", significant(least), significant(most))
        }
    };
    let what = match &joint.kind {
        JointKind::Arm { length, .. } => format!("arm of length {}", stroke(length)),
        JointKind::Bent { angle } => format!("bent by {}", stroke(angle)),
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
            (time.end / time.step).ceil(),
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
fn costs(model: &Model, mesh: &Mesh<2>) -> String {
    let n_dofs = (2 * mesh.n_nodes() + mesh.n_vertices) as f64;
    let memory = memory_estimate(2 * mesh.n_nodes() + mesh.n_vertices);
    // Measured on planar runs with 1.1 10^4 to 2 10^5 unknowns on one core, all systems factorised.
    let factorisation = 0.0095 * (n_dofs / 1e4).powf(1.4);
    // What follows the bodies: the mesh, its quality, contact, measurements, remeshing.
    let following = if model.mesh_moves() { 0.5 } else { 0.0 };
    let assembly = 6e-7 * n_dofs;
    let systems = n_systems(model);
    let output = output_size(model, mesh);
    let mut text = String::new();
    let _ = writeln!(text, "  {:<16} {n_dofs}", "unknowns");
    let _ =
        writeln!(text, "  {:<16} {}, most of it for the factorisation", "memory", bytes(memory));
    let seconds = (factorisation + assembly) * (1.0 + following);
    let is_adaptive =
        matches!(&model.case.time, TimeSettings::Unsteady(time) if time.adaptive.is_some());
    let cost = if is_adaptive {
        format!("{} for each linear system; their number depends on the steps", duration(seconds))
    } else {
        let plural = if systems == 1.0 { "" } else { "s" };
        format!("{} for {systems} linear system{plural}", duration(systems * seconds))
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
    text
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

fn bytes(size: f64) -> String {
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
        s => format!("{:.1} h", s / 3600.0),
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
    }
}
