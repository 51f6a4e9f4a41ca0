//! Whether a body with coordinates has bent so far that it comes near itself, which no law of contact knows.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::coupling::BodyShapes;
use crate::gait::{DeformedOutline, MaterialPoint};
use crate::run::error::{Meeting, RunError};
use crate::run::run::Run;
use crate::run::simulation::Simulation;
use crate::step::at_step;

/// Points of an outline that are compared.
const POINTS: u32 = 240;
/// Sections of a surface in space of which points are compared, and points of each.
const SECTIONS: u32 = 80;
const AROUND: u32 = 6;
/// Distance along the body over its thickness from which on two points are no neighbours.
const APART: f64 = 3.0;
/// Gap over the thickness from which on a body is told to be near itself where there is no contact.
const NEAR: f64 = 0.5;
/// Distance of two points over that along the body below which it comes back to itself: neighbours along a straight one have
/// 1, the ends of a half circle 2 / pi.
const FOLDED: f64 = 0.5;

/// A point of an outline, or of a surface.
struct OnOutline {
    /// From the head along the straight body (m).
    along: f64,
    /// From the axis of the straight body (m).
    from_axis: f64,
    /// Where it is (m).
    place: Vector3<f64>,
}

impl<const D: usize> Run<'_, D> {
    /// Ends a run with contact where a body with coordinates meets itself, and tells of it once in one without.
    ///
    /// # Errors
    /// When one does.
    pub(in crate::run) fn check_bodies_that_bend(&mut self) -> Result<(), RunError> {
        let Simulation { problem, state, law, .. } = &self.simulation;
        if problem.n_coordinates() == 0 {
            return Ok(());
        }
        let shapes = BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?;
        for (body, rigid) in problem.bodies.iter().enumerate() {
            let Some(deformed) = shapes.deformed(body) else { continue };
            let points = points(deformed);
            let thickness = thickness(&points);
            let limit = law.as_ref().map_or(NEAR * thickness, |law| law.range());
            let Some([one, other]) = nearest(&points, APART * thickness, limit) else { continue };
            let middle = (one.place + other.place) * 0.5;
            let pose = &state.poses[body];
            let place = pose.center + pose.to_world(&middle);
            let (name, gap) = (rigid.name.clone(), (one.place - other.place).norm());
            let meeting = Meeting {
                body: name,
                along: [one.along, other.along],
                place: place.as_slice()[..D].to_vec(),
                gap,
            };
            if law.is_some() {
                let (step, time) = (state.step, state.time);
                return Err(RunError::MeetsItself { step, time, meeting: Box::new(meeting) });
            }
            if !self.warned.meets_itself {
                self.warned.meets_itself = true;
                tracing::warn!("{}: {meeting}", at_step(state.step, state.time));
                return Ok(());
            }
        }
        Ok(())
    }
}

/// Points of the outline or the surface; none of one without coordinates.
fn points(deformed: &DeformedOutline) -> Vec<OnOutline> {
    if let Some(end) = deformed.end_along() {
        return on_surface(deformed, end);
    }
    let Some(period) = deformed.period().filter(|_| deformed.follows_coordinates()) else {
        return Vec::new();
    };
    let head = deformed.rest_place(0.0).map_or(0.0, |head| head.x);
    let point = |nth: u32| {
        let parameter = period * f64::from(nth) / f64::from(POINTS);
        let rest = deformed.rest_place(parameter)?;
        let (along, place) = (head - rest.x, deformed.position(parameter).push(0.0));
        Some(OnOutline { along, from_axis: rest.y.abs(), place })
    };
    (0..POINTS).filter_map(point).collect()
}

/// Points of a surface in space whose parameter ends at the tail.
fn on_surface(deformed: &DeformedOutline, end: f64) -> Vec<OnOutline> {
    let rest = |at: MaterialPoint| deformed.rest_place_in_space(at);
    let head = rest(MaterialPoint { along: 0.0, around: 0.0 }).map_or(0.0, |head| head.x);
    let point = |nth: u32| {
        let section = f64::from(nth / AROUND) + 0.5;
        let at = MaterialPoint {
            along: end * section / f64::from(SECTIONS),
            around: TAU * f64::from(nth % AROUND) / f64::from(AROUND),
        };
        let rest = rest(at)?;
        let place = deformed.place(at);
        Some(OnOutline { along: head - rest.x, from_axis: rest.y.hypot(rest.z), place })
    };
    (0..SECTIONS * AROUND).filter_map(point).collect()
}

/// Of the body where it is thickest (m).
fn thickness(points: &[OnOutline]) -> f64 {
    2.0 * points.iter().map(|point| point.from_axis).fold(0.0, f64::max)
}

/// The two points nearer to each other than a limit that are nearest, and no neighbours.
fn nearest(points: &[OnOutline], apart: f64, limit: f64) -> Option<[&OnOutline; 2]> {
    let gap = |pair: &[&OnOutline; 2]| (pair[0].place - pair[1].place).norm();
    let pairs = points.iter().enumerate().flat_map(|(nth, one)| {
        let others = points[nth + 1..].iter();
        others
            .filter(move |other| (one.along - other.along).abs() > apart)
            .map(move |other| [one, other])
    });
    let is_folded =
        |pair: &[&OnOutline; 2]| gap(pair) < FOLDED * (pair[0].along - pair[1].along).abs();
    let near = pairs.filter(|pair| gap(pair) < limit && is_folded(pair));
    near.min_by(|one, other| gap(one).total_cmp(&gap(other)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The outline of a ring with a gap, of no thickness.
    #[test]
    fn ends_of_a_ring_are_near_and_neighbours_are_not() {
        let ring = |turned: f64| -> Vec<OnOutline> {
            let point = |nth: u32| {
                let along = f64::from(nth) / 100.0;
                let angle = turned * along;
                let place = Vector3::new(angle.cos(), angle.sin(), 0.0);
                OnOutline { along, from_axis: 0.0, place }
            };
            (0..=100).map(point).collect()
        };
        let closed = ring(6.2);
        let [one, other] = nearest(&closed, 0.1, 0.2).expect("its ends meet");
        assert_eq!([one.along, other.along], [0.0, 1.0]);
        assert!(nearest(&ring(5.0), 0.1, 0.2).is_none(), "its ends are 1.2 apart");
    }
}
