//! What a case consists of, as lines for the terminal.

mod joints;

use std::fmt::Write as _;

use self::joints::{angle_in_words, joint_line, senses_of_angles};
use crate::case::{
    BoundaryCondition, Case, CaseFile, DomainSpec, FlowModel, GaitSpec, Geometry, MeanFlowSpec,
    Model, Motion, Orientation, ScalarSpec, ShapeSpec, SwimmerModel, TimeSettings, ViscositySpec,
    geometry_name, printable, significant,
};

/// A text that is meant to be one line, as it may be shown on a terminal.
pub fn one_line(text: &str) -> String {
    printable(&text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// What is said of the region of a case that lacks one or its mesh.
fn left_out(case: &Case) -> String {
    match &case.left_out[..] {
        [one] => format!(
            "`{one}` is left out, which the full solver needs; --fidelity reduced runs the case"
        ),
        _ => "none: it runs by its reduced model".to_owned(),
    }
}

/// What a case consists of, as lines `what  value`.
pub fn facts(file: &CaseFile) -> String {
    let (case, model) = (file.case(), &file.model);
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {what:<10} {}", printable(&value));
    };
    line("file", file.file.clone());
    let units =
        format!("{}, units: {}", geometry_name(case.geometry), one_line(&case.units.to_string()));
    line("geometry", units);
    line("fluid", fluid(case));
    if case.is_reduced_only() {
        line("domain", left_out(case));
    } else {
        line("domain", domain(case));
        let sides = case.sides().into_iter().filter(|side| *side != "axis").map(|side| {
            let condition = case.boundary.get(side).map_or("nothing", condition_name);
            format!("{side} {condition}")
        });
        line("boundary", sides.collect::<Vec<_>>().join(", "));
    }
    if let Some(flow) = &case.flow {
        line("flow", mean_flow(flow));
    }
    for scalar in &case.scalar {
        line("scalar", scalar_line(scalar));
    }
    for body in &model.bodies {
        line("body", body_line(case, body));
    }
    for joint in &model.joints {
        line("joint", joint_line(joint));
    }
    for swimmer in &model.swimmers {
        line("swimmer", swimmer_line(model, swimmer));
        if let Some(senses) = senses_of_angles(model, swimmer) {
            line("angles", senses);
        }
    }
    if !model.commands.is_empty() {
        line("commands", model.commands.names().join(", "));
    }
    if let Some(task) = &case.environment {
        let (seen, done) = (task.observations.len(), task.actions.len());
        let every = significant(task.interval);
        line("environment", format!("{seen} observations, {done} actions, every {every}"));
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

fn mean_flow(flow: &MeanFlowSpec) -> String {
    let given = [
        ("pressure gradient", &flow.pressure_gradient),
        ("mean velocity", &flow.mean_velocity),
        ("body force", &flow.body_force),
    ];
    let parts =
        given.iter().filter_map(|(name, values)| Some(format!("{name} {:?}", (*values).as_ref()?)));
    parts.collect::<Vec<_>>().join(", ")
}

fn scalar_line(scalar: &ScalarSpec) -> String {
    let carried = match (scalar.diffusivity, scalar.peclet) {
        (Some(diffusivity), _) => format!("of diffusivity {}", significant(diffusivity)),
        (None, Some(peclet)) => format!("at a Peclet number of {}", significant(peclet)),
        (None, None) => String::new(),
    };
    let named = scalar.body.keys().chain(scalar.boundary.keys());
    match named.cloned().collect::<Vec<_>>().join(", ") {
        none if none.is_empty() => format!("{} {carried}, nothing diffuses out", scalar.name),
        places => format!("{} {carried}, with conditions on {places}", scalar.name),
    }
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
    let viscosity = match &fluid.viscosity {
        ViscositySpec::Newtonian(viscosity) => significant(*viscosity),
        ViscositySpec::Law(law) => format!("by the law `{}`", law.name()),
    };
    format!("{model}, viscosity {viscosity}{density}")
}

fn domain(case: &Case) -> String {
    match &case.domain {
        DomainSpec::Box { min, max } => format!("box from {min:?} to {max:?}"),
        DomainSpec::Channel { length, height } => {
            format!("channel {} long, {} high", significant(*length), significant(*height))
        }
        DomainSpec::Mesh(file) => format!(
            "mesh of {} cells in {}, {}",
            file.n_cells(),
            file.file,
            match case.geometry.dimensions() {
                2 => format!("of area {}", significant(file.measure())),
                _ => format!("of volume {}", significant(file.measure())),
            }
        ),
        DomainSpec::Surface(region) => match region.mesh() {
            Some(mesh) => format!(
                "inside of a closed surface, of volume {}, first meshed by {} cells",
                significant(mesh.measure()),
                mesh.n_cells()
            ),
            None => "inside of a closed surface".to_owned(),
        },
        DomainSpec::Disc { radius, .. } => format!("disc of radius {}", significant(*radius)),
        DomainSpec::HalfDisc { radius, .. } | DomainSpec::Sphere { radius, .. } => {
            format!("ball of radius {}", significant(*radius))
        }
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
        BoundaryCondition::Pressure { .. } => "pressure",
        BoundaryCondition::Traction { .. } => "traction",
        BoundaryCondition::Developed { .. } => "developed",
        BoundaryCondition::Profile(_) => "profile",
        BoundaryCondition::Velocity { .. } => "velocity",
        BoundaryCondition::Parabolic { .. } => "parabolic",
        BoundaryCondition::Shear { .. } => "shear",
        BoundaryCondition::WavingSheet { .. } => "waving-sheet",
        BoundaryCondition::Periodic(_) => "periodic",
    }
}

fn body_line(case: &Case, body: &crate::case::Body) -> String {
    let shape = shape_in_words(&body.shape);
    let motion = match &body.motion {
        Motion::Held => "held".to_owned(),
        Motion::Free | Motion::ByAxis(_) => {
            let driven = body.driven.iter().map(|driven| driven.motion.name());
            match driven.collect::<Vec<_>>().join(" and ") {
                none if none.is_empty() => "free".to_owned(),
                driven => format!("{driven} imposed, else free but for what is held"),
            }
        }
        Motion::Imposed(_) => "imposed motion".to_owned(),
    };
    let gait = match &body.gait {
        Some(GaitSpec::Squirmer(gait)) if case.geometry == Geometry::Spatial => {
            format!(", squirmer along {:?} of its frame", gait.axis.unwrap_or([1.0, 0.0, 0.0]))
        }
        Some(GaitSpec::Squirmer(gait)) => {
            // The axis turns with the body, and both may be given
            format!(", squirmer heading {}", angle_in_words(body.angle + gait.heading))
        }
        Some(GaitSpec::Slip(_)) => ", slips along itself".to_owned(),
        Some(GaitSpec::Carangiform(_)) => ", carangiform".to_owned(),
        Some(GaitSpec::Anguilliform(_)) => ", anguilliform".to_owned(),
        Some(GaitSpec::Flagellum(_)) => ", flagellum".to_owned(),
        Some(GaitSpec::Midline(_)) => ", midline of its own".to_owned(),
        Some(GaitSpec::Pulsating(_)) => ", pulsating".to_owned(),
        Some(GaitSpec::Joints(gait)) => format!(", bent at {} joints", gait.joints.len()),
        None => String::new(),
    };
    let size = body.size.or(case.mesh.surface).unwrap_or(case.mesh.size) * case.mesh.scale;
    let edges = body.shape.perimeter() / size;
    let at: Vec<String> = body.center.iter().map(|value| significant(*value)).collect();
    let at = at.join(", ");
    let in_space = body.orientation.as_ref().map(|orientation| match orientation {
        Orientation::Turned { axis, angle } => {
            format!(", turned by {} about {axis:?}", angle_in_words(*angle))
        }
        Orientation::Quaternion(parts) => format!(", turned by the quaternion {parts:?}"),
        Orientation::Along(direction) => format!(", its x axis along {direction:?}"),
    });
    let turned = match (body.angle, body.is_round()) {
        (0.0, _) | (_, true) => in_space.unwrap_or_default(),
        (angle, false) => format!(", turned by {}", angle_in_words(angle)),
    };
    format!(
        "{}: {shape} at [{at}]{turned}, {motion}{gait}, about {} edges",
        body.name,
        count(edges)
    )
}

/// A shape with its lengths.
fn shape_in_words(shape: &ShapeSpec) -> String {
    match shape {
        ShapeSpec::Disc { radius } | ShapeSpec::Sphere { radius } => {
            format!("{} of radius {}", shape.name(), significant(*radius))
        }
        ShapeSpec::Ellipse { semi_axes } | ShapeSpec::Spheroid { semi_axes } => {
            format!("{} with semi-axes {semi_axes:?}", shape.name())
        }
        ShapeSpec::Ellipsoid { semi_axes } => format!("ellipsoid with semi-axes {semi_axes:?}"),
        ShapeSpec::Capsule { length, radius } => {
            format!(
                "capsule of length {} and radius {}",
                significant(*length),
                significant(*radius)
            )
        }
        ShapeSpec::Cylinder { radius, axis, .. } => {
            let along = ["x", "y", "z"][axis.index()];
            format!("cylinder of radius {} through the box along {along}", significant(*radius))
        }
        ShapeSpec::Helix(helix) => {
            let [radius, pitch, turns, tube] =
                [helix.radius, helix.pitch, helix.turns, helix.tube_radius].map(significant);
            format!(
                "helix of radius {radius}, pitch {pitch} and {turns} turns, a tube of radius {tube}"
            )
        }
        ShapeSpec::Curve(curve) => format!(
            "tube of radius {} along a curve through {} points",
            significant(curve.tube_radius),
            curve.points.len()
        ),
        ShapeSpec::Revolved { profile } => format!("turned profile of {} points", profile.len()),
        ShapeSpec::Surface(surface) => {
            format!("surface of {} triangles", surface.n_triangles())
        }
        ShapeSpec::Union(parts) => {
            let names: Vec<&str> = parts.iter().map(|part| part.shape.name()).collect();
            format!("union of {}", names.join(" and "))
        }
        ShapeSpec::Polygon(polygon) => format!("polygon of {} corners", polygon.points.len()),
        ShapeSpec::Side(hole) => format!("hole inside the side `{}` of the mesh", hole.side),
        ShapeSpec::Box { size: [width, height] } => {
            format!("box of {} by {}", significant(*width), significant(*height))
        }
        ShapeSpec::Spline { points } => format!("spline through {} points", points.len()),
        ShapeSpec::Fish(fish) => format!("fish of length {}", significant(fish.length)),
        ShapeSpec::Flagellate(flagellate) => {
            let length = significant(flagellate.tail_length);
            format!("flagellate with a tail of length {length}")
        }
        ShapeSpec::Tube(tube) => {
            format!("skin of {} links, {} long", tube.sections.len(), significant(tube.length))
        }
    }
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

/// A number of things, in powers of ten where there are many.
pub fn count(number: f64) -> String {
    if number < 1e7 { format!("{number:.0}") } else { format!("{number:.1e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_numbers_of_a_file_fit_into_a_line() {
        assert_eq!([count(64.4), count(2.5e9)], ["64", "2.5e9"]);
        assert_eq!(one_line("a\n  b\u{1b}"), "a b\\u{1b}");
        assert_eq!(angle_in_words(-std::f64::consts::FRAC_PI_2), "-1.5708 rad (-90.0 degrees)");
    }
}
