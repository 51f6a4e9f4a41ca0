//! Reynolds number, density ratio and their like: derived, and checked against `[numbers]`.

use std::fmt::Write as _;

use super::{Case, FlowModel, GaitSpec, Geometry, Model, ShapeSpec, TimeSettings};

/// Gaps that are told of: of many bodies those of the closest pairs.
const MOST_GAPS: usize = 3;

/// density * velocity * length / viscosity of `[scales]`; 0 in Stokes flow.
#[must_use]
pub fn reynolds(case: &Case) -> Option<f64> {
    let scales = case.scales?;
    Some(case.fluid.density * scales.velocity * scales.length / case.fluid.viscosity)
}

/// Density of the first body over that of the fluid.
#[must_use]
pub fn density_ratio(model: &Model) -> Option<f64> {
    let (case, body) = (&model.case, model.bodies.first()?);
    (case.fluid.density > 0.0).then(|| body.density.map_or(1.0, |own| own / case.fluid.density))
}

/// A number that follows from a case.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedNumber {
    /// What it is called.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// What it is made of.
    pub formula: String,
}

/// All numbers that can be derived from a case, in the order in which they are printed.
#[must_use]
pub fn derived_numbers(model: &Model) -> Vec<DerivedNumber> {
    let case = &model.case;
    let mut table = Vec::new();
    let mut add = |name: &str, value: f64, formula: &str| {
        table.push(DerivedNumber { name: name.to_owned(), value, formula: formula.to_owned() });
    };
    let density = case.fluid.density;
    let kinematic = case.fluid.viscosity / density;
    let has_inertia = case.fluid.model != FlowModel::Stokes;
    if let (true, Some(value)) = (has_inertia, reynolds(case)) {
        add("Reynolds number", value, "density * scales.velocity * scales.length / viscosity");
    }
    if let (true, Some(value)) = (has_inertia, density_ratio(model)) {
        add("density ratio", value, "density of the first body / density of the fluid");
    }
    let length = case
        .scales
        .map(|scales| scales.length)
        .or_else(|| Some(model.bodies.first()?.shape.reach()));
    if let (true, Some(length)) = (density > 0.0, length) {
        add("Stokes time", length * length / kinematic, "length^2 * density / viscosity");
        if let (true, TimeSettings::Unsteady(time)) = (has_inertia, &case.time) {
            let steps = length * length / kinematic / time.step;
            add("steps per Stokes time", steps, "Stokes time / time.unsteady.step");
        }
    }
    if let (Some(scales), TimeSettings::Unsteady(time)) = (case.scales, &case.time) {
        let turnover = scales.length / scales.velocity;
        add("turnover time", turnover, "scales.length / scales.velocity");
        add("duration in turnovers", time.end / turnover, "time.unsteady.end / turnover time");
    }
    for body in &model.bodies {
        let name = &body.name;
        if let Some(GaitSpec::Squirmer(squirmer)) = &body.gait {
            let first = squirmer.modes.first().copied().unwrap_or(0.0);
            // Mean slip over the surface: 2/3 B1 on a sphere, 1/2 B1 on a disc.
            let (factor, formula) = match body.shape {
                ShapeSpec::Sphere { .. } => (2.0 / 3.0, "2/3 B1, unbounded Stokes flow"),
                _ => (0.5, "1/2 B1, unbounded Stokes flow"),
            };
            let speed = factor * first;
            add(&format!("{name}: free swimming speed"), speed, formula);
            if let (true, Some(second)) = (first != 0.0, squirmer.modes.get(1)) {
                let kind = "B2/B1: negative pusher, positive puller";
                add(&format!("{name}: beta"), second / first, kind);
            }
            if has_inertia {
                let value = speed.abs() * body.shape.reach() / kinematic;
                let formula = "density * swimming speed * radius / viscosity";
                add(&format!("{name}: swimming Reynolds number"), value, formula);
            }
        }
    }
    for swimmer in &model.swimmers {
        let Some(period) = swimmer.period else { continue };
        let name = &swimmer.name;
        if let TimeSettings::Unsteady(time) = &case.time {
            add(
                &format!("{name}: steps per cycle"),
                period / time.step,
                "period / time.unsteady.step",
            );
        }
        if has_inertia {
            let length = extent(model, &swimmer.bodies);
            let value = length * length / (kinematic * period);
            let formula = "density * length^2 / (viscosity * period), from end to end at the start";
            add(&format!("{name}: oscillatory Reynolds number"), value, formula);
        }
    }
    for (name, gap, formula) in gaps(model) {
        add(&name, gap, &formula);
    }
    table
}

/// Largest distance of two points of bodies at the start (m): of one body its length, of several by
/// their surrounding circles.
fn extent(model: &Model, bodies: &[usize]) -> f64 {
    if let [body] = bodies {
        return match &model.bodies[*body].shape {
            ShapeSpec::Fish(fish) => fish.length,
            ShapeSpec::Flagellate(shape) => 2.0 * shape.head[0] + shape.tail_length,
            shape => 2.0 * shape.reach(),
        };
    }
    let circle = |body: usize| {
        let body = &model.bodies[body];
        let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
        (at(0), at(1), body.shape.reach())
    };
    let mut most = 0.0f64;
    for &one in bodies {
        for &other in bodies {
            let ((x1, y1, r1), (x2, y2, r2)) = (circle(one), circle(other));
            most = most.max((x2 - x1).hypot(y2 - y1) + r1 + r2);
        }
    }
    most
}

/// Gaps between bodies over the size of the smaller one, by their surrounding circles: the smallest
/// ones.
fn gaps(model: &Model) -> Vec<(String, f64, String)> {
    let mut found = Vec::new();
    for (i, first) in model.bodies.iter().enumerate() {
        for second in &model.bodies[i + 1..] {
            let (&[x1, y1], &[x2, y2]) = (first.center.as_slice(), second.center.as_slice()) else {
                continue;
            };
            let (r1, r2) = (first.shape.reach(), second.shape.reach());
            let gap = (x2 - x1).hypot(y2 - y1) - r1 - r2;
            found.push((
                format!("gap {} - {}", first.name, second.name),
                gap / r1.min(r2),
                "gap of surrounding circles / smaller radius".to_owned(),
            ));
        }
    }
    found.sort_by(|one, other| one.1.total_cmp(&other.1));
    found.truncate(MOST_GAPS);
    found
}

/// The derived numbers as lines `name  value  formula`.
#[must_use]
pub fn number_table(model: &Model) -> String {
    let numbers = derived_numbers(model);
    let width = numbers.iter().map(|number| number.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for DerivedNumber { name, value, formula } in numbers {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name:<width$}  {:<12}  = {formula}", significant(value));
    }
    text
}

/// A number with six digits, in the shorter of both notations.
#[must_use]
pub fn significant(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) {
        let digits = if value == 0.0 { 1 } else { (5 - size.log10().floor() as i32).clamp(0, 9) };
        let text = format!("{value:.*}", digits as usize);
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.5e}")
    }
}

/// Words for a geometry.
#[must_use]
pub fn geometry_name(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::Planar => "planar",
        Geometry::Axisymmetric => "axisymmetric",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_are_shown_without_trailing_zeros() {
        assert_eq!(significant(0.5), "0.5");
        assert_eq!(significant(1_234.567_89), "1234.57");
        assert_eq!(significant(2e-7), "2.00000e-7");
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(100_000.0), "100000");
    }
}
