//! The speed a case can be expected to have before anything is solved, and the force with it.

use std::f64::consts::{PI, TAU};

use alewife_mesh::spatial::{Body as SolidBody, BodySurface};
use alewife_mesh::{Outline, PlacedShape, Point};
use nalgebra::Isometry3;

use crate::{
    Body, BoundaryCondition, Case, ContactSpec, DrivenLaw, Formula, GaitSpec, Geometry, Joint,
    JointKind, Lock, MagneticSpec, Model, Motion, ParsedFormula, SlipGait, Stroke, TimeSettings,
};

/// Times of a stroke's period at which its rate is looked at.
const TIMES: u32 = 32;

impl Model {
    /// The largest speed that is given or follows from what is given (m/s): of sides, mean flow, imposed
    /// motions, gaits, strokes, and of bodies that fall or are pulled, by the order of their terminal
    /// speed; `None` where nothing moves.
    #[must_use]
    pub fn expected_speed(&self) -> Option<f64> {
        let case = &self.case;
        let sides = case.boundary.values().map(|condition| side_speed(case, condition));
        let flow = case.flow.iter().flat_map(|flow| &flow.mean_velocity).map(|v| norm(v));
        let bodies = self.bodies.iter().map(|body| body_speed(case, body));
        let joints = self.joints.iter().map(|joint| {
            let Some(stroke) = joint.kind.stroke() else { return self.slider_speed(joint) };
            let rate = top_rate(stroke);
            let child = self.body_index(&joint.child).map(|child| &self.bodies[child]);
            match joint.kind {
                JointKind::Arm { .. } => rate,
                _ => rate * child.map_or(0.0, |child| 2.0 * child.shape.reach()),
            }
        });
        let turned = self.bodies.iter().map(|body| self.magnetic_speed(body));
        let scale = case.scales.iter().map(|scales| scales.velocity);
        let all = sides.chain(flow).chain(bodies).chain(joints).chain(turned).chain(scale);
        Some(all.fold(0.0, f64::max)).filter(|speed| *speed > 0.0)
    }

    /// The largest rate at which a field turns a magnetic body in slow flow (rad/s), by the resistance of a disc or sphere
    /// that is as thin as it; 0 of a body without a moment.
    #[must_use]
    pub(crate) fn magnetic_rate(&self, field: &MagneticSpec, body: &Body) -> f64 {
        let (case, width) = (&self.case, body.shape.half_width());
        let drag = match case.geometry {
            Geometry::Planar => 4.0 * PI * case.reference_viscosity() * width.powi(2),
            Geometry::Axisymmetric | Geometry::Spatial => {
                8.0 * PI * case.reference_viscosity() * width.powi(3)
            }
        };
        if body.turns() {
            norm(&body.magnetic_moment) * largest_at(field, &body.center) / drag
        } else {
            0.0
        }
    }

    /// The order of the speed of a surface that a field turns (m/s).
    fn magnetic_speed(&self, body: &Body) -> f64 {
        let Some(field) = self.case.magnetic_field() else { return 0.0 };
        if body.motion != Motion::Free || self.case.geometry == Geometry::Axisymmetric {
            return 0.0;
        }
        let fastest = field.rotating.as_ref().map_or(f64::INFINITY, |one| TAU * one.frequency);
        self.magnetic_rate(field, body).min(fastest) * body.shape.reach()
    }

    /// The order of the rate at which forces change the length of an arm (m/s): by the resistance of its
    /// child; 0 of other joints.
    fn slider_speed(&self, joint: &Joint) -> f64 {
        let (JointKind::Slider(slider), Some(child)) = (&joint.kind, self.body_index(&joint.child))
        else {
            return 0.0;
        };
        let motor = slider.force.as_ref().map_or([0.0; 2], Stroke::range);
        let center = |body: usize, axis: usize| self.bodies[body].center.get(axis).copied();
        let way = |parent: usize| {
            let along = |axis| Some(center(child, axis)? - center(parent, axis)?);
            norm(&(0..3).filter_map(along).collect::<Vec<_>>())
        };
        // Its length by that between the bodies
        let length = self.body_index(&joint.parent).map_or(0.0, way);
        let spring = slider.stiffness * (length - slider.rest).abs();
        let force = motor.iter().fold(spring, |force, end| force.max(end.abs()));
        force / (resistance(&self.case, &self.bodies[child]) + slider.damping)
    }

    /// The order of the force that presses bodies together (N; N/m planar): the largest drag at the
    /// expected speed, weight or load of one.
    #[must_use]
    pub fn expected_force(&self) -> Option<f64> {
        let speed = self.expected_speed()?;
        let force = |body: &Body| resistance(&self.case, body) * speed + load(&self.case, body);
        Some(self.bodies.iter().map(force).fold(0.0, f64::max)).filter(|force| *force > 0.0)
    }

    /// The stiffness of a barrier, or the epsilon of the quadratic law, with which a force as large as
    /// [`Self::expected_force`] leaves half the range as gap.
    #[must_use]
    pub fn proposed_contact(&self) -> Option<f64> {
        let force = self.expected_force()?;
        Some(match self.case.contact? {
            // The forces of both laws at half the range
            ContactSpec::Barrier { range, .. } => force / (range * (0.5 + 2f64.ln())),
            ContactSpec::Quadratic { range, .. } => range * range / (4.0 * force),
        })
    }
}

/// The largest rate of a stroke (1/s); 0 of what may be asked for without limits.
fn top_rate(stroke: &Stroke) -> f64 {
    if let Some(command) = stroke.command() {
        return Some(command.largest_rate()).filter(|rate| rate.is_finite()).unwrap_or(0.0);
    }
    let period = stroke.period().unwrap_or(1.0);
    let time = |n: u32| period * (f64::from(n) + 0.5) / f64::from(TIMES);
    (0..TIMES).map(|n| stroke.at(time(n))[1].abs()).fold(0.0, f64::max)
}

/// The order of the largest rate of a motion that is given (m/s or rad/s).
fn driven_rate(law: &DrivenLaw) -> f64 {
    match law {
        DrivenLaw::Way(stroke) => top_rate(stroke),
        DrivenLaw::Rate(rate) => rate.value.abs(),
    }
}

/// The largest strength that a field may have in time at a place (T), by the sum of those of its parts.
fn largest_at(magnetic: &MagneticSpec, place: &[f64]) -> f64 {
    let most = |stroke: &Stroke| {
        let [least, most] = stroke.range();
        // What grows without bound: its value after a unit of time
        let end = |end: f64| if end.is_finite() { end.abs() } else { stroke.at(1.0)[0].abs() };
        end(least).max(end(most))
    };
    let factor = |factor: &Option<Stroke>| factor.as_ref().map_or(1.0, most);
    let distance = |from: &[f64]| -> f64 {
        let origin = from.iter().copied().chain(std::iter::repeat(0.0));
        norm(&place.iter().zip(origin).map(|(at, from)| at - from).collect::<Vec<_>>())
    };
    let components: Vec<f64> = magnetic.components.iter().map(most).collect();
    let mut sum = norm(&components) + magnetic.rotating.as_ref().map_or(0.0, |one| one.strength);
    if let Some(linear) = &magnetic.linear {
        let entries: Vec<f64> = linear.gradient.iter().flatten().copied().collect();
        sum += norm(&entries) * distance(&linear.center) * factor(&linear.factor);
    }
    for dipole in &magnetic.dipoles {
        let power = if place.len() == 2 { 2 } else { 3 };
        let field = norm(&dipole.strength) / (TAU * distance(&dipole.position).powi(power));
        sum += field * factor(&dipole.factor);
    }
    sum
}

/// Length of a vector.
pub(crate) fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The largest speed of these components (m/s), at places all over the domain at time zero where they are expressions.
fn largest_speed(case: &Case, value: &[Formula]) -> f64 {
    const PLACES: u32 = 8;
    let n = case.geometry.dimensions();
    let parsed = value.iter().filter_map(|one| one.parsed(&case.define, n).ok());
    let parsed: Vec<ParsedFormula> = parsed.collect();
    if parsed.iter().all(ParsedFormula::is_constant) {
        return norm(&parsed.iter().map(|one| one.at(&[0.0; 4])).collect::<Vec<_>>());
    }
    let (extent, mut most) = (case.extent(), 0.0_f64);
    let lengths = extent.lengths();
    for place in 0..PLACES.pow(3) {
        let part = |axis: u32| f64::from(place / PLACES.pow(axis) % PLACES) / f64::from(PLACES - 1);
        let at = |axis: usize, nth: u32| extent.min[axis] + part(nth) * lengths[axis];
        let point = [at(0, 0), at(1, 1), at(2, 2), 0.0];
        let speed = norm(&parsed.iter().map(|one| one.at(&point)).collect::<Vec<_>>());
        most = if speed.is_finite() { most.max(speed) } else { most };
    }
    most
}

/// The largest speed on a side (m/s).
fn side_speed(case: &Case, condition: &BoundaryCondition) -> f64 {
    match condition {
        BoundaryCondition::Velocity { value, .. } => largest_speed(case, value),
        BoundaryCondition::Profile(profile) => profile.largest_speed(),
        BoundaryCondition::Developed { peak: Some(peak), .. } => peak.abs(),
        BoundaryCondition::Developed { flux: Some(flux), .. } => {
            // Of a round or square side as wide as the domain is narrow
            let lengths = case.extent().lengths();
            let n = case.geometry.dimensions();
            let width = lengths[..n].iter().copied().fold(f64::INFINITY, f64::min);
            let across = if case.geometry == Geometry::Planar { width } else { width * width };
            2.0 * flux.abs() / across
        }
        BoundaryCondition::Parabolic { peak, .. } => peak.abs(),
        BoundaryCondition::Shear { rate, origin, .. } => {
            let [min, max] = case.extent().in_plane();
            (rate * (min[1] - origin)).abs().max((rate * (max[1] - origin)).abs())
        }
        BoundaryCondition::WavingSheet { amplitude, period, .. } => {
            (TAU * amplitude / period).abs()
        }
        _ => 0.0,
    }
}

fn body_speed(case: &Case, body: &Body) -> f64 {
    let reach = body.shape.reach();
    let imposed = match &body.motion {
        Motion::Imposed(motion) => norm(&motion.velocity) + motion.angular_velocity.norm() * reach,
        Motion::Held => return 0.0,
        Motion::Free => {
            let initial = norm(&body.velocity) + body.angular_velocity.norm() * reach;
            let driven = body.driven.iter().map(|driven| {
                let length = if driven.motion == Lock::Rotation { reach } else { 1.0 };
                length * driven_rate(&driven.law)
            });
            terminal_speed(case, body).max(initial).max(driven.sum())
        }
        Motion::ByAxis(_) => 0.0,
    };
    let gait = match &body.gait {
        Some(GaitSpec::Squirmer(squirmer)) => squirmer.modes.iter().map(|mode| mode.abs()).sum(),
        Some(GaitSpec::Slip(slip)) => slip_speed(case, body, slip),
        // Tails and waves move at the order of a length in a period
        Some(gait) => gait.period().map_or(0.0, |period| 2.0 * reach / period),
        None => 0.0,
    };
    imposed.max(gait)
}

/// The largest slip of a body (m/s); 0 where its expressions have no value.
fn slip_speed(case: &Case, body: &Body, slip: &SlipGait) -> f64 {
    let n = case.geometry.dimensions();
    let parsed = slip.velocity.iter().filter_map(|one| one.parsed(&case.define, n).ok());
    let parsed: Vec<ParsedFormula> = parsed.collect();
    let speed = |at: &[f64; 4]| norm(&parsed.iter().map(|one| one.at(at)).collect::<Vec<_>>());
    let speeds = slip_trials(case, body).into_iter().map(|at| speed(&at));
    speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// Places all over the surface of a body in its own frame (m), each at times (s) all over the run.
pub(crate) fn slip_trials(case: &Case, body: &Body) -> Vec<[f64; 4]> {
    let end = match &case.time {
        TimeSettings::Unsteady(time) => time.end,
        TimeSettings::Steady(_) => 0.0,
    };
    let times = (0..=TIMES).map(|nth| end * f64::from(nth) / f64::from(TIMES));
    let places = surface_places(case, body);
    times.flat_map(|time| places.iter().map(move |[x, y, z]| [*x, *y, *z, time])).collect()
}

/// Places all over the surface of a body, in its own frame (m); none of a shape that is none.
fn surface_places(case: &Case, body: &Body) -> Vec<[f64; 3]> {
    const PLACES: u32 = 64;
    if case.geometry == Geometry::Spatial {
        let surface = body.solid(1.0).and_then(|solid| {
            BodySurface::new(&SolidBody { pose: Isometry3::identity(), ..solid }).ok()
        });
        let places = surface.map(|surface| surface.places(PLACES as usize)).unwrap_or_default();
        return places.into_iter().map(Into::into).collect();
    }
    let (center, angle) = (Point::<2>::zeros(), 0.0);
    let Ok(outline) = Outline::new(&PlacedShape { center, angle, ..body.placed(1.0) }) else {
        return Vec::new();
    };
    let parameters = (0..PLACES).map(|nth| outline.period() * f64::from(nth) / f64::from(PLACES));
    let places = parameters.map(|parameter| outline.at(parameter)[0]);
    // Of a meridian half of the outline is met
    let is_met = |place: &Point<2>| case.geometry == Geometry::Planar || place.y >= 0.0;
    places.filter(is_met).map(|place| [place.x, place.y, 0.0]).collect()
}

/// Force per velocity of a body in slow flow, by its reach (N s/m; N s/m2 planar).
fn resistance(case: &Case, body: &Body) -> f64 {
    match case.geometry {
        Geometry::Planar => 4.0 * PI * case.reference_viscosity(),
        Geometry::Axisymmetric | Geometry::Spatial => {
            6.0 * PI * case.reference_viscosity() * body.shape.reach()
        }
    }
}

/// Weight less buoyancy of a body over the acceleration of gravity (kg; kg/m planar); 0 of a shape that is
/// none.
fn excess_mass(case: &Case, body: &Body) -> f64 {
    let volume = body.shape.volume_in(case.geometry);
    match body.mass {
        Some(mass) => mass - case.fluid.density * volume,
        None => (body.density.unwrap_or(case.fluid.density) - case.fluid.density) * volume,
    }
}

/// Weight less buoyancy and force on a body (N; N/m planar).
fn load(case: &Case, body: &Body) -> f64 {
    weight(case, body) + norm(&body.force)
}

/// Weight less buoyancy of a body, or the other way round (N; N/m planar).
pub(crate) fn weight(case: &Case, body: &Body) -> f64 {
    excess_mass(case, body).abs() * norm(&case.fluid.gravity)
}

/// The same with the force on it, as a vector.
pub(crate) fn load_in_space(case: &Case, body: &Body) -> [f64; 3] {
    let mass = excess_mass(case, body);
    let part = |vector: &[f64], axis: usize| vector.get(axis).copied().unwrap_or(0.0);
    [0, 1, 2].map(|axis| mass * part(&case.fluid.gravity, axis) + part(&body.force, axis))
}

/// The order of the speed of a body under its load: that of slow flow, or less by inertia (m/s).
pub(crate) fn terminal_speed(case: &Case, body: &Body) -> f64 {
    let load = load(case, body);
    let slow = load / resistance(case, body);
    let area = match case.geometry {
        Geometry::Planar => 2.0 * body.shape.reach(),
        Geometry::Axisymmetric | Geometry::Spatial => PI * body.shape.reach().powi(2),
    };
    let fast = (2.0 * load / (case.fluid.density * area)).sqrt();
    slow.min(fast)
}

#[cfg(test)]
mod tests {
    use crate::Case;

    #[test]
    fn speeds_have_the_order_of_those_of_runs() {
        // Largest speeds of a boundary in runs of the cases
        for (case, speed) in [
            ("dfg-2d-2", 1.5),
            ("lid-driven-cavity", 1.0),
            ("periodic-cylinders", 1.0),
            ("squirmer-alone", 4.9),
            ("disc-settling/slow", 5.4),
            ("three-sphere", 1.1),
            ("carangiform", 1.2),
        ] {
            let model = Case::read(case, &[]).unwrap().model;
            let expected = model.expected_speed().unwrap();
            assert!((0.3..4.0).contains(&(expected / speed)), "{case}: {expected} for {speed}");
        }
    }
}
