//! Reynolds number, density ratio and their like: derived, and checked against `[numbers]`.

use std::fmt::Write as _;

use alewife_mesh::{Point, whole};

use super::balls::{Ball, BallGrid};
use super::derived_number::DerivedNumber;
use super::impact::numbers_of_impact;
use crate::text::diagnostic::printable;
use crate::{
    Body, Case, ContactSpec, FlowModel, GaitSpec, Geometry, Model, ShapeSpec, SquirmerGait,
    SwimmerModel, TimeSettings,
};

/// Gaps that are listed: of many bodies those of the closest pairs.
const MOST_GAPS: usize = 3;

/// Widest column of names in a table (characters).
const WIDEST_COLUMN: usize = 200;

/// density * velocity * length / viscosity of `[scales]`; 0 in Stokes flow.
#[must_use]
pub fn reynolds(case: &Case) -> Option<f64> {
    let scales = case.scales?;
    Some(case.fluid.density * scales.velocity * scales.length / case.reference_viscosity())
}

/// Density of the first body over that of the fluid.
#[must_use]
pub fn density_ratio(model: &Model) -> Option<f64> {
    let (case, body) = (&model.case, model.bodies.first()?);
    let own = match body.mass {
        Some(mass) => Some(mass / body.shape.volume_in(case.geometry)),
        None => body.density,
    };
    (case.fluid.density > 0.0).then(|| own.map_or(1.0, |own| own / case.fluid.density))
}

/// All numbers that can be derived from a case, in the order in which they are printed.
#[must_use]
pub fn derived_numbers(model: &Model) -> Vec<DerivedNumber> {
    let mut table = Table::default();
    numbers_of_flow(&mut table, model);
    for body in &model.bodies {
        if let Some(GaitSpec::Squirmer(squirmer)) = &body.gait {
            numbers_of_squirmer(&mut table, &model.case, body, squirmer);
        }
    }
    for swimmer in &model.swimmers {
        numbers_of_swimmer(&mut table, model, swimmer);
    }
    table.0.extend(match model.case.geometry {
        Geometry::Spatial => gaps::<3>(model),
        Geometry::Planar | Geometry::Axisymmetric => gaps::<2>(model),
    });
    if let (Some(contact), Some(value)) = (&model.case.contact, model.proposed_contact()) {
        let name = match contact {
            ContactSpec::Barrier { .. } => "contact: stiffness for half the range",
            ContactSpec::Quadratic { .. } => "contact: epsilon for half the range",
        };
        let formula = "with which the weight less buoyancy of a body, or its drag at the expected speed, \
                       leaves half of `range` as gap";
        table.add(name, value, formula);
    }
    table.0.extend(numbers_of_impact(model));
    table.0
}

#[derive(Default)]
struct Table(Vec<DerivedNumber>);

impl Table {
    fn add(&mut self, name: &str, value: f64, formula: &str) {
        let (name, formula) = (name.to_owned(), formula.to_owned());
        self.0.push(DerivedNumber { name, value, formula });
    }
}

fn has_inertia(case: &Case) -> bool {
    case.fluid.model != FlowModel::Stokes
}

fn kinematic_viscosity(case: &Case) -> f64 {
    case.reference_viscosity() / case.fluid.density
}

fn numbers_of_flow(table: &mut Table, model: &Model) {
    let case = &model.case;
    let has_inertia = has_inertia(case);
    if let (true, Some(value)) = (has_inertia, reynolds(case)) {
        let formula = "density * scales.velocity * scales.length / viscosity";
        table.add("Reynolds number", value, formula);
    }
    if let (true, Some(value)) = (has_inertia, density_ratio(model)) {
        table.add("density ratio", value, "density of the first body / density of the fluid");
    }
    let length = case
        .scales
        .map(|scales| scales.length)
        .or_else(|| Some(model.bodies.first()?.shape.reach()));
    if let (true, Some(length)) = (case.fluid.density > 0.0, length) {
        let stokes_time = length * length / kinematic_viscosity(case);
        table.add("Stokes time", stokes_time, "length^2 * density / viscosity");
        if let (true, TimeSettings::Unsteady(time)) = (has_inertia, &case.time) {
            let steps = stokes_time / time.step;
            table.add("steps per Stokes time", steps, "Stokes time / time.unsteady.step");
        }
    }
    if let (Some(scales), TimeSettings::Unsteady(time)) = (case.scales, &case.time) {
        let turnover = scales.length / scales.velocity;
        table.add("turnover time", turnover, "scales.length / scales.velocity");
        let turnovers = time.end / turnover;
        table.add("duration in turnovers", turnovers, "time.unsteady.end / turnover time");
    }
}

fn numbers_of_squirmer(table: &mut Table, case: &Case, body: &Body, squirmer: &SquirmerGait) {
    let name = &body.name;
    let first = squirmer.modes.first().copied().unwrap_or(0.0);
    // Mean slip over the surface: 2/3 B1 on a sphere, 1/2 B1 on a disc.
    let (factor, formula) = match body.shape {
        ShapeSpec::Sphere { .. } => (2.0 / 3.0, "2/3 B1, unbounded Stokes flow"),
        _ => (0.5, "1/2 B1, unbounded Stokes flow"),
    };
    let speed = factor * first;
    table.add(&format!("{name}: free swimming speed"), speed, formula);
    if let (true, Some(second)) = (first != 0.0, squirmer.modes.get(1)) {
        let kind = "B2/B1: negative pusher, positive puller";
        table.add(&format!("{name}: beta"), second / first, kind);
    }
    if has_inertia(case) {
        let value = speed.abs() * body.shape.reach() / kinematic_viscosity(case);
        let formula = "density * swimming speed * radius / viscosity";
        table.add(&format!("{name}: swimming Reynolds number"), value, formula);
    }
}

fn numbers_of_swimmer(table: &mut Table, model: &Model, swimmer: &SwimmerModel) {
    let Some(period) = swimmer.period else { return };
    let name = &swimmer.name;
    if let TimeSettings::Unsteady(time) = &model.case.time {
        let formula = "period / time.unsteady.step";
        table.add(&format!("{name}: steps per cycle"), period / time.step, formula);
    }
    if has_inertia(&model.case) {
        let length = extent(model, &swimmer.bodies);
        let value = length * length / (kinematic_viscosity(&model.case) * period);
        let formula = "density * length^2 / (viscosity * period), from end to end at the start";
        table.add(&format!("{name}: oscillatory Reynolds number"), value, formula);
    }
}

/// Largest distance of two points of bodies at the start (m): of one body its length, of several by
/// their surrounding spheres.
fn extent(model: &Model, bodies: &[usize]) -> f64 {
    if let [body] = bodies {
        return match &model.bodies[*body].shape {
            ShapeSpec::Fish(fish) => fish.length,
            ShapeSpec::Flagellate(shape) => 2.0 * shape.head[0] + shape.tail_length,
            ShapeSpec::Tube(tube) => tube.length,
            shape => 2.0 * shape.reach(),
        };
    }
    let ball = |body: &usize| {
        let body = &model.bodies[*body];
        let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
        Ball { center: Point::<3>::from_fn(|axis, _| at(axis)), radius: body.shape.reach() }
    };
    let balls: Vec<Ball<3>> = bodies.iter().map(ball).collect();
    let mut most = 0.0f64;
    for one in &balls {
        for other in &balls {
            let distance = (other.center - one.center).norm();
            most = most.max(distance + one.radius + other.radius);
        }
    }
    most
}

/// A gap between two bodies.
struct Gap {
    bodies: [usize; 2],
    /// Gap of the surrounding circles over the smaller radius.
    ratio: f64,
}

/// The smallest gaps between bodies, ascending.
fn gaps<const D: usize>(model: &Model) -> Vec<DerivedNumber> {
    let mut found = near_pairs::<D>(model).found;
    found.sort_by(|one, other| one.ratio.total_cmp(&other.ratio));
    found.truncate(MOST_GAPS);
    let round = if D == 3 { "spheres" } else { "circles" };
    let number = |gap: Gap| {
        let [first, second] = gap.bodies.map(|body| &model.bodies[body].name);
        let overlap = if gap.ratio < 0.0 { ", which overlap: the bodies need not" } else { "" };
        let formula = format!("gap of surrounding {round} / smaller radius{overlap}");
        DerivedNumber { name: format!("gap {first} - {second}"), value: gap.ratio, formula }
    };
    found.into_iter().map(number).collect()
}

/// The circle around a body.
struct Circle<const D: usize> {
    body: usize,
    ball: Ball<D>,
}

fn circles<const D: usize>(model: &Model) -> Vec<Circle<D>> {
    let placed = model.bodies.iter().enumerate().filter(|(_, body)| body.center.len() == D);
    let ball = |body: &Body| Ball {
        center: Point::<D>::from_fn(|axis, _| body.center[axis]),
        radius: body.shape.reach(),
    };
    placed.map(|(index, body)| Circle { body: index, ball: ball(body) }).collect()
}

/// What a search for near pairs has found, and how many pairs it looked at.
#[derive(Default)]
struct NearPairs {
    found: Vec<Gap>,
    looked_at: usize,
}

/// All pairs whose gap is up to some ratio, as many as are printed where there are so many.
fn near_pairs<const D: usize>(model: &Model) -> NearPairs {
    let circles = circles::<D>(model);
    let extent = model.case.extent();
    let [min, max] =
        [extent.min, extent.max].map(|corner| Point::<D>::from_fn(|axis, _| corner[axis]));
    let mut grid = BallGrid::<D>::new(min, max, circles.len());
    for (nth, circle) in circles.iter().enumerate() {
        grid.insert(nth, &circle.ball);
    }
    let mut pairs = NearPairs::default();
    // Larger circles find all gaps up to a ratio; the last ones reach across any domain
    let ratios = (0..34).map(|nth| f64::powi(2.0, nth)).chain([f64::INFINITY]);
    for ratio in ratios {
        pairs.found.clear();
        for (nth, Circle { body, ball }) in circles.iter().enumerate() {
            let larger = Ball { radius: (1.0 + ratio) * ball.radius, ..*ball };
            let mut near: Vec<usize> = grid.near(&larger).filter(|other| *other > nth).collect();
            near.sort_unstable();
            near.dedup();
            pairs.looked_at += near.len();
            for other in near.into_iter().map(|other| &circles[other]) {
                let way = (other.ball.center - ball.center).norm();
                let gap = way - ball.radius - other.ball.radius;
                let own = gap / ball.radius.min(other.ball.radius);
                if own <= ratio || ratio.is_infinite() {
                    pairs.found.push(Gap { bodies: [*body, other.body], ratio: own });
                }
            }
        }
        if pairs.found.len() >= MOST_GAPS {
            break;
        }
    }
    pairs
}

/// The derived numbers as lines `name  value  formula`, printable whatever the names of bodies are.
#[must_use]
pub fn number_table(model: &Model) -> String {
    let numbers = derived_numbers(model);
    let width = numbers.iter().map(|number| number.name.chars().count()).max().unwrap_or(0);
    let width = width.min(WIDEST_COLUMN);
    let mut text = String::new();
    for DerivedNumber { name, value, formula } in numbers {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {name:<width$}  {:<12}  = {formula}", significant(value));
    }
    printable(&text)
}

/// A number with six digits, in the shorter of both notations.
#[must_use]
pub fn significant(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) {
        let digits = if value == 0.0 { 1 } else { whole(5.0 - size.log10().floor()).min(9) };
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.5e}")
    }
}

/// A number without the rounding of its last digits: 0.6 of 0.6000000000000001.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// Words for a geometry.
#[must_use]
pub fn geometry_name(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::Planar => "planar",
        Geometry::Axisymmetric => "axisymmetric",
        Geometry::Spatial => "three-dimensional",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gaps of a case of discs at `x` on a line, with these radii.
    fn model_of(discs: &[[f64; 2]]) -> Model {
        let mut text = "title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [0.0, -9.0], max = [1000.0, 9.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.5 }
time = { steady = {} }
"
        .to_owned();
        for (nth, [x, radius]) in discs.iter().enumerate() {
            let _ = write!(
                text,
                "[[body]]\nname = '{nth}'\nshape.disc.radius = {radius}\ncenter = [{x}, 0.0]\nmotion = 'held'\n"
            );
        }
        crate::Case::parse("t.toml", &text, &[]).unwrap().model
    }

    fn gaps_of(discs: &[[f64; 2]]) -> Vec<(String, f64)> {
        gaps::<2>(&model_of(discs)).into_iter().map(|gap| (gap.name, gap.value)).collect()
    }

    #[test]
    fn gaps_are_those_in_space_too() {
        let text = "
title = 't'
geometry = 'spatial'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-5.0, -5.0, -5.0], max = [5.0, 5.0, 5.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip', back = 'no-slip', front = 'no-slip' }
mesh = { size = 1.0 }
time = { steady = {} }
body = [
    { name = 'a', shape.sphere.radius = 1.0, center = [0.0, 0.0, -1.5], motion = 'held' },
    { name = 'b', shape.sphere.radius = 0.5, center = [0.0, 0.0, 1.5], motion = 'held' },
]
";
        let model = Case::parse("a.toml", text, &[]).unwrap().model;
        let table = number_table(&model);
        assert!(table.contains("gap a - b  3") && table.contains("surrounding spheres"), "{table}");
    }

    #[test]
    fn the_smallest_gaps_are_found_however_far_apart_bodies_are() {
        let found = gaps_of(&[[10.0, 1.0], [900.0, 1.0], [400.0, 2.0], [402.0, 1.0]]);
        let wanted = [("gap 2 - 3", -1.0), ("gap 0 - 2", 387.0), ("gap 0 - 3", 390.0)];
        assert_eq!(found, wanted.map(|(name, gap)| (name.to_owned(), gap)));
        assert_eq!(gaps_of(&[[10.0, 1.0], [900.0, 1.0]]), [("gap 0 - 1".to_owned(), 888.0)]);
        assert_eq!(gaps_of(&[[10.0, 1.0]]), []);
    }

    #[test]
    fn of_many_bodies_far_apart_not_all_pairs_are_looked_at() {
        let discs: Vec<[f64; 2]> = (0..9000).map(|n| [0.1 * f64::from(n), 1e-4]).collect();
        let pairs = near_pairs::<2>(&model_of(&discs));
        assert!(pairs.found.len() >= MOST_GAPS);
        // All pairs are 4500 a body
        assert!(pairs.looked_at < 100 * discs.len(), "{}", pairs.looked_at);
    }

    #[test]
    fn the_smallest_gaps_are_those_of_all_pairs() {
        let scattered = |nth: usize| (nth as f64 * 0.618_033_988_749).fract();
        let discs: Vec<[f64; 2]> =
            (0..60).map(|n| [1000.0 * scattered(n), 0.1 + scattered(7 * n)]).collect();
        let mut pairs = Vec::new();
        for (i, [x, r]) in discs.iter().enumerate() {
            for (j, [other_x, other_r]) in discs.iter().enumerate().skip(i + 1) {
                let gap = (other_x - x).abs() - r - other_r;
                pairs.push((format!("gap {i} - {j}"), gap / r.min(*other_r)));
            }
        }
        pairs.sort_by(|one, other| one.1.total_cmp(&other.1));
        pairs.truncate(MOST_GAPS);
        assert_eq!(gaps_of(&discs), pairs);
    }

    #[test]
    fn six_digits_are_shown_without_trailing_zeros() {
        assert_eq!(significant(0.5), "0.5");
        assert_eq!(significant(1_234.567_89), "1234.57");
        assert_eq!(significant(2e-7), "2.00000e-7");
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(100_000.0), "100000");
    }
}
