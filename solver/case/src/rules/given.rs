//! Bodies whose motion is given for the whole run: where it leads them out of the domain, or into each other.

use alewife_mesh::{MeshError, Point, check_wrapped_placement, spatial};

use super::Findings;
use super::placement::{coordinates, message};
use crate::model::numbers::significant;
use crate::model::speed::norm;
use crate::spec::body::motion::Lock;
use crate::spec::body::motion::by_axis::{Driven, DrivenLaw, GivenRate};
use crate::{
    Body, DomainSpec, Geometry, Model, Motion, ShapeSpec, TimeFunction, TimeSettings, Unsteady,
};

/// Times of a run, and of a period, at which bodies are looked at.
const TIMES: [f64; 2] = [400.0, 64.0];

/// Most times of a run.
const MOST_TIMES: u32 = 4000;

/// Most bodies that are followed.
const MOST_BODIES: usize = 100;

/// Angle of a turn in one step above which the step is too long for it (rad).
const MOST_TURNED: f64 = 1.0;

/// Halvings of the time in which something happens.
const HALVINGS: usize = 30;

/// Reports the first thing that each of these bodies meets.
pub fn check(findings: &mut Findings<'_>) {
    let model = findings.model();
    let TimeSettings::Unsteady(time) = &model.case.time else { return };
    // With a frame sides travel, and other bodies may end the run before
    if model.case.frame.is_some() || time.until.is_some() {
        return;
    }
    let bodies: Vec<&Body> = model.bodies.iter().filter(|body| is_known(model, body)).collect();
    if bodies.len() > MOST_BODIES {
        return;
    }
    for (index, body) in model.bodies.iter().enumerate() {
        if !is_driven(model, body) || !is_led(model, body) {
            continue;
        }
        let others =
            bodies.iter().copied().filter(|other| may_meet(model, [body, other], time.end));
        let is_known = is_known(model, body);
        let others = others.filter(|_| is_known).collect();
        let course = Course { model, time, body, others };
        let Some(Trouble { time: when, error }) = course.first_trouble() else { continue };
        findings.error(
            &format!("body.{index}.motion"),
            format!(
                "by its motion \"{}\" comes to {} at t = {}, before the end at {}",
                body.name,
                met(&error),
                significant(when),
                time.end,
            ),
            "end before, lead it back, by motion.imposed.factor or another motion, or enlarge the domain: no \
             contact holds a body whose motion is given",
        );
    }
    if let (None, true) = (&time.adaptive, findings.has_no_error()) {
        check_turns(findings, time.step);
    }
}

/// Warns of a body that turns by more than a step resolves, as one does whose rate is in degrees.
fn check_turns(findings: &mut Findings<'_>, step: f64) {
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let Motion::Imposed(motion) = &body.motion else { continue };
        let rate = motion.angular_velocity.norm();
        if rate * step > MOST_TURNED {
            findings.warning(
                &format!("body.{index}.motion"),
                format!(
                    "\"{}\" turns by {} rad in a step: angular velocities are in radians per time",
                    body.name,
                    significant(rate * step)
                ),
                &format!(
                    "for {} degrees per time write {}, else lower time.unsteady.step",
                    significant(rate),
                    significant(rate.to_radians())
                ),
            );
        }
    }
}

/// What a body comes to.
fn met(error: &MeshError) -> String {
    match error {
        MeshError::Outside { x, y, .. } => format!("the boundary at {}", coordinates(&[*x, *y])),
        MeshError::BodyMeetsSide { side, at, .. } => {
            format!("the side `{side}` at {}", coordinates(at))
        }
        MeshError::Overlap { first, x, y, .. } => {
            format!("\"{first}\" at {}", coordinates(&[*x, *y]))
        }
        MeshError::BodiesMeet { first, at, .. } => format!("\"{first}\" at {}", coordinates(at)),
        other => format!("where it cannot be: {}", message(other)),
    }
}

/// Whether a motion of a body is given, and it does not hang on another one.
fn is_driven(model: &Model, body: &Body) -> bool {
    let hangs = || model.joints.iter().any(|joint| joint.child == body.name);
    let is_imposed = match &body.motion {
        Motion::Imposed(_) => body.translates(model.case.geometry) || body.turns(),
        Motion::Free => !body.driven.is_empty(),
        Motion::Held | Motion::ByAxis(_) => false,
    };
    is_imposed && !hangs()
}

/// Whether it is known where the motions that are given lead a body: all of them, or those across a box, whose sides
/// are as far away wherever it is along the others.
fn is_led(model: &Model, body: &Body) -> bool {
    if is_known(model, body) {
        return true;
    }
    let is_box = matches!(model.case.domain, DomainSpec::Box { .. });
    let turns = !body.locked.contains(&Lock::Rotation) && !body.is_round();
    is_box && !turns && are_places_known(model, body)
}

/// Whether all places of a body are known beforehand.
fn is_known(model: &Model, body: &Body) -> bool {
    let is_free = |motion: &&Lock| !body.locked.contains(motion);
    let is_free_to_go = match body.motion {
        Motion::Free => model
            .case
            .geometry
            .motions()
            .iter()
            .any(|motion| is_free(&motion) && !(*motion == Lock::Rotation && body.is_round())),
        _ => false,
    };
    !is_free_to_go && are_places_known(model, body)
}

/// Whether the places of a body follow from where its centre is and how it is turned.
fn are_places_known(model: &Model, body: &Body) -> bool {
    // Of other shapes the centre of mass, about which they turn, is not where the centre is
    let is_ellipse = matches!(body.shape, ShapeSpec::Ellipse { .. } | ShapeSpec::Box { .. });
    let is_centred = body.center_of_mass.iter().all(|part| *part == 0.0);
    let turns_about_center = is_ellipse && is_centred && model.case.geometry == Geometry::Planar;
    match &body.motion {
        Motion::ByAxis(_) => false,
        Motion::Held => !body.deforms(),
        Motion::Free if body.driven.is_empty() => false,
        Motion::Free | Motion::Imposed(_) => {
            !body.deforms() && (body.is_round() || turns_about_center || !body.turns())
        }
    }
}

/// Whether two bodies may come near each other by the end of a run (s).
fn may_meet(model: &Model, [body, other]: [&Body; 2], end: f64) -> bool {
    let excursion = |body: &Body| {
        let Motion::Imposed(motion) = &body.motion else {
            return body.driven.iter().map(|driven| largest_way(driven, end)).sum();
        };
        let way = motion.factor.as_ref().map_or(end, |factor| factor.largest_integral(end));
        norm(&motion.velocity) * way
    };
    let is_periodic = model.case.periodic_axes().contains(&true);
    body.name != other.name
        && (is_periodic || are_near(body, other, excursion(body) + excursion(other)))
}

/// Whether the balls around two bodies, where they are, are nearer to each other than this (m).
fn are_near(body: &Body, other: &Body, apart: f64) -> bool {
    let parts = body.center.iter().zip(&other.center);
    let distance = parts.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    distance < body.shape.reach() + other.shape.reach() + apart
}

/// How far a motion that is given leads from where it starts, until a time (s): m or rad.
fn way(driven: &Driven, time: f64) -> f64 {
    match &driven.law {
        DrivenLaw::Way(stroke) => stroke.at(time)[0] - stroke.at(0.0)[0],
        DrivenLaw::Rate(GivenRate { value, factor }) => {
            value * factor.as_ref().map_or(time, |factor| factor.integral(time))
        }
    }
}

/// What the ways along an axis until an end (s) do not exceed (m).
fn largest_way(driven: &Driven, end: f64) -> f64 {
    match &driven.law {
        _ if driven.motion == Lock::Rotation => 0.0,
        DrivenLaw::Way(stroke) => {
            // A steady one has no range, and goes one way
            let [least, most] = stroke.range();
            let range = if (most - least).is_finite() { most - least } else { 0.0 };
            range.max(way(driven, end).abs())
        }
        DrivenLaw::Rate(GivenRate { value, factor }) => {
            value.abs() * factor.as_ref().map_or(end, |factor| factor.largest_integral(end))
        }
    }
}

/// The time after which a function begins again (s), if it does.
fn period_of(function: &TimeFunction) -> Option<f64> {
    match function {
        TimeFunction::Sine { period, .. } => Some(*period),
        TimeFunction::Cycle(cycle) => Some(cycle.period),
        _ => None,
    }
}

fn period_of_law(driven: &Driven) -> Option<f64> {
    match &driven.law {
        DrivenLaw::Way(stroke) => stroke.period(),
        DrivenLaw::Rate(rate) => rate.factor.as_ref().and_then(period_of),
    }
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min)
}

/// A place where a body cannot be.
struct Trouble {
    /// When it gets there (s).
    time: f64,
    error: MeshError,
}

/// A body on its way through a run.
struct Course<'a> {
    model: &'a Model,
    time: &'a Unsteady,
    body: &'a Body,
    /// Other ones that are where their motions say, as far as it may come near them.
    others: Vec<&'a Body>,
}

impl Course<'_> {
    /// Where it first cannot be.
    fn first_trouble(&self) -> Option<Trouble> {
        let end = self.time.end;
        let period = match &self.body.motion {
            Motion::Imposed(motion) => {
                let factors = [&motion.factor, &motion.angular_factor].into_iter().flatten();
                least(factors.filter_map(period_of).chain([end]))
            }
            _ => least(self.body.driven.iter().filter_map(period_of_law).chain([end])),
        };
        let n_times = TIMES[0].max(TIMES[1] * end / period).min(f64::from(MOST_TIMES)).floor();
        let at = |nth: f64| end * nth / n_times;
        let mut nths = (1..=MOST_TIMES).map(f64::from).take_while(|nth| *nth <= n_times);
        let nth = nths.find(|nth| self.trouble(at(*nth)).is_some())?;
        let mut bounds = [at(nth - 1.0), at(nth)];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (bounds[0] + bounds[1]);
            bounds[usize::from(self.trouble(middle).is_some())] = middle;
        }
        let time = bounds[1];
        self.trouble(time).map(|error| Trouble { time, error })
    }

    /// Why it cannot be where it is at a time (s).
    fn trouble(&self, time: f64) -> Option<MeshError> {
        let moved = self.at(self.body, time);
        let outside = if self.is_well_inside(&moved) { None } else { self.refused(&[&moved]) };
        outside.or_else(|| {
            let others = self.others.iter().map(|other| self.at(other, time));
            let mut near = others.filter(|other| are_near(&moved, other, 0.0));
            near.find_map(|other| self.refused(&[&other, &moved]))
        })
    }

    /// A body where its motion leads it until a time (s); across periodic sides back into the domain.
    fn at(&self, body: &Body, time: f64) -> Body {
        let mut moved = body.clone();
        let Motion::Imposed(motion) = &body.motion else {
            self.drive(&mut moved, time);
            return moved;
        };
        let way = motion.factor.as_ref().map_or(time, |factor| factor.integral(time));
        for (own, part) in moved.center.iter_mut().zip(&motion.velocity) {
            *own += way * part;
        }
        self.wrap(&mut moved);
        let turn = motion.factor_of_turn().map_or(time, |factor| factor.integral(time));
        moved.angle += turn * motion.angular_velocity.z();
        moved
    }

    /// Moves a body by its axes as far as that is given; where it is along the others no side is near.
    fn drive(&self, moved: &mut Body, time: f64) {
        let extent = self.model.case.extent();
        if !moved.driven.is_empty() {
            for (axis, lock) in [Lock::X, Lock::Y, Lock::Z].into_iter().enumerate() {
                if let (Some(own), false) =
                    (moved.center.get_mut(axis), moved.locked.contains(&lock))
                {
                    *own = extent.min[axis] + 0.5 * extent.lengths()[axis];
                }
            }
        }
        for driven in std::mem::take(&mut moved.driven) {
            let way = way(&driven, time);
            let axis = match driven.motion {
                Lock::X => 0,
                Lock::Y => 1,
                Lock::Z => 2,
                Lock::Rotation => {
                    moved.angle += way;
                    continue;
                }
            };
            if let Some(own) = moved.center.get_mut(axis) {
                *own += way;
            }
        }
        self.wrap(moved);
    }

    /// Puts a body back into the domain across periodic sides.
    fn wrap(&self, moved: &mut Body) {
        let extent = self.model.case.extent();
        for axis in (0..moved.center.len()).filter(|axis| self.model.case.periodic_axes()[*axis]) {
            let (min, period) = (extent.min[axis], extent.lengths()[axis]);
            moved.center[axis] = min + (moved.center[axis] - min).rem_euclid(period);
        }
    }

    /// Whether the ball around a body is inside the domain.
    fn is_well_inside(&self, body: &Body) -> bool {
        let reach = body.shape.reach() * (1.0 + 1e-6);
        let at = |axis: usize| body.center.get(axis).copied().unwrap_or(0.0);
        if self.model.case.geometry == Geometry::Spatial {
            let Some(domain) = self.model.case.domain_in_space() else { return true };
            let center = Point::<3>::new(at(0), at(1), at(2));
            let walls = (0..domain.sides().len()).filter(|side| !domain.is_periodic(*side));
            return walls.map(|side| domain.side_gap(side, center)).all(|gap| gap > reach);
        }
        let domain = self.model.case.mesh_domain();
        domain.clearance(Point::<2>::new(at(0), at(1))) > reach
    }

    /// Why bodies cannot be where they are.
    fn refused(&self, bodies: &[&Body]) -> Option<MeshError> {
        let scale = self.model.case.mesh.scale;
        if self.model.case.geometry == Geometry::Spatial {
            // What is around the holes of a given mesh is known by its cells only
            if self.model.case.bodies_are_holes() {
                return None;
            }
            let domain = self.model.case.domain_in_space()?;
            let solids: Option<Vec<spatial::Body>> =
                bodies.iter().map(|body| body.solid(scale)).collect();
            return spatial::check_placement(&domain, &solids?).err();
        }
        let placed: Vec<_> = bodies.iter().map(|body| body.placed(scale)).collect();
        check_wrapped_placement(&self.model.case.mesh_domain(), &placed).err()
    }
}
