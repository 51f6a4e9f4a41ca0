//! What free bodies head for: sides and other bodies on a straight way, at the speed they have far from
//! everything.

use nalgebra::{UnitQuaternion, Vector3};

use super::body::{LoadFrame, SquirmerGait};
use super::encounters::keeps_away;
use super::path::{Path, ROUNDING};
use super::speed::{load_in_space, norm, swimming_speed, terminal_speed};
use super::{Body, DomainSpec, GaitSpec, Geometry, Lock, Model, Motion};

/// Times by which a body under a load is later than by the order of its speed far from everything: walls
/// slow it down, and in the plane there is no such speed.
const DELAY: f64 = 3.0;

/// A body that meets something, if it goes straight on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OnTheWay {
    /// Which body.
    pub body: usize,
    /// When (s).
    pub time: f64,
    /// Whether it is a side of the domain.
    pub is_at_side: bool,
    /// Whether it swims, or follows a load.
    pub swims: bool,
}

/// Where a body is going, and whether it swims.
struct Way {
    path: Path,
    swims: bool,
}

impl Model {
    /// What is first met by a body that swims or follows its load; nothing of swimmers that are turned
    /// back by the flow they make. Bodies across periodic sides are not looked at.
    pub(crate) fn first_meeting(&self) -> Option<OnTheWay> {
        let ways: Vec<Way> = (0..self.bodies.len()).map(|body| self.way(body)).collect();
        let of_body = |(body, way): (usize, &Way)| {
            if way.path.velocity == [0.0; 3] || keeps_away(&self.bodies[body]) {
                return None;
            }
            let at_side = self.time_to_side(&way.path);
            let others = ways.iter().enumerate().filter(|(other, _)| *other != body);
            let meetings = others.filter_map(|(_, other)| way.path.time_to(&other.path));
            let time = meetings.chain(at_side).min_by(f64::total_cmp)?;
            let delay = if way.swims { 1.0 } else { DELAY };
            let is_at_side = at_side == Some(time);
            Some(OnTheWay { body, time: delay * time, is_at_side, swims: way.swims })
        };
        let met = ways.iter().enumerate().filter_map(of_body);
        met.min_by(|one, other| one.time.total_cmp(&other.time))
    }

    /// Swimming or sinking of a body that is attached to nothing.
    fn way(&self, index: usize) -> Way {
        let body = &self.bodies[index];
        let is_free = body.motion == Motion::Free && body.spring.is_none() && self.is_single(index);
        let swimming = match &body.gait {
            Some(GaitSpec::Squirmer(gait)) if is_free => self.swimming(body, gait),
            _ => Vector3::zeros(),
        };
        let swims = swimming != Vector3::zeros();
        let mut velocity = if is_free { swimming + self.sinking(body) } else { swimming };
        for (axis, lock) in [Lock::X, Lock::Y, Lock::Z].into_iter().enumerate() {
            if body.locked.contains(&lock) || axis >= self.case.geometry.dimensions() {
                velocity[axis] = 0.0;
            }
        }
        Way { path: Path::of(body, velocity.into()), swims }
    }

    /// The velocity of a squirmer alone (m/s); none of one whose speed or direction changes in time.
    fn swimming(&self, body: &Body, gait: &SquirmerGait) -> Vector3<f64> {
        if gait.turn.is_some() || gait.factors.contains_key("1") {
            return Vector3::zeros();
        }
        let axis = gait.axis.map_or_else(Vector3::x, Vector3::from);
        let heading = turned(body) * about_z(gait.heading) * axis;
        heading.try_normalize(0.0).unwrap_or_default() * swimming_speed(&self.case, gait)
    }

    /// The velocity of a body by a constant load (m/s).
    fn sinking(&self, body: &Body) -> Vector3<f64> {
        if body.load_factor.is_some() {
            return Vector3::zeros();
        }
        let mut load = Vector3::from(load_in_space(&self.case, body));
        if body.load_frame == LoadFrame::Body {
            load = turned(body) * load;
        }
        load.try_normalize(0.0).unwrap_or_default() * terminal_speed(&self.case, body)
    }

    /// When a body gets to a side of the domain that is not periodic (s); of a domain of no simple form
    /// to that of the box around it.
    fn time_to_side(&self, path: &Path) -> Option<f64> {
        let periodic = self.case.periodic_axes();
        let is_flat = |axis: usize| match self.case.domain {
            DomainSpec::Disc { .. } | DomainSpec::HalfDisc { .. } | DomainSpec::Sphere { .. } => {
                false
            }
            DomainSpec::Cylinder { .. } => axis == 0,
            _ => axis < self.case.geometry.dimensions(),
        };
        let flat = path.time_to_sides(&self.case.extent(), |axis| is_flat(axis) && !periodic[axis]);
        flat.into_iter().chain(self.time_to_round_side(path)).min_by(f64::total_cmp)
    }

    /// The same of a wall that is round about a point or about the x axis.
    fn time_to_round_side(&self, path: &Path) -> Option<f64> {
        let (center, radius, mut parts) = match &self.case.domain {
            DomainSpec::Disc { center: [x, y], radius } => {
                (Vector3::new(*x, *y, 0.0), *radius, [1.0, 1.0, 0.0])
            }
            DomainSpec::HalfDisc { center, radius } => {
                (Vector3::new(*center, 0.0, 0.0), *radius, [1.0, 1.0, 0.0])
            }
            DomainSpec::Sphere { center, radius } => (Vector3::from(*center), *radius, [1.0; 3]),
            DomainSpec::Cylinder { radius, .. } if self.case.geometry == Geometry::Spatial => {
                (Vector3::zeros(), *radius, [0.0, 1.0, 1.0])
            }
            _ => return None,
        };
        if self.case.geometry == Geometry::Axisymmetric {
            parts[1] = 0.0;
        }
        let parts = Vector3::from(parts);
        let from = (Vector3::from(path.center) - center).component_mul(&parts);
        let velocity = Vector3::from(path.velocity).component_mul(&parts);
        if velocity.norm() <= ROUNDING * norm(&path.velocity) {
            return None;
        }
        let (speed, ahead) = (velocity.norm_squared(), from.dot(&velocity));
        let room = (radius - path.reach).powi(2) - from.norm_squared();
        let discriminant = ahead * ahead + speed * room;
        (discriminant >= 0.0).then(|| ((discriminant.sqrt() - ahead) / speed).max(0.0))
    }
}

/// How a body is turned at the start.
fn turned(body: &Body) -> UnitQuaternion<f64> {
    body.orientation.as_ref().map_or_else(|| about_z(body.angle), super::Orientation::rotation)
}

fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
}

#[cfg(test)]
mod tests {
    use crate::Case;

    /// The first meeting of a sphere in space with these keys.
    fn met(domain: &str, body: &str) -> Option<super::OnTheWay> {
        let text = format!(
            "title = 't'\ngeometry = 'spatial'\n\
             fluid = {{ model = 'stokes', viscosity = 0.5, density = 1.0, gravity = [0, 0, -1] }}\n\
             domain.{domain}\nmesh = {{ size = 1.0 }}\ntime.unsteady = {{ step = 0.1, end = 1.0 }}\n\
             [[body]]\nname = 'b'\nshape.sphere.radius = 0.5\nmotion = 'free'\n{body}\n"
        );
        Case::parse("t.toml", &text, &[]).unwrap().model.first_meeting()
    }

    const SWIMS: &str = "gait.squirmer = { modes = [1.5], axis = [0, 3, 0] }";

    #[test]
    fn spheres_in_space_meet_flat_and_round_sides() {
        let time = |domain: &str, body: &str| met(domain, body).unwrap().time;
        let in_box = "box = { min = [-2, -4, -2], max = [2, 4, 2] }";
        let at = |body: &str| format!("center = [0, 1, 0]\n{body}");
        // 2.5 at the speed of one, whichever the way the body is turned to the same side
        assert!((time(in_box, &at(SWIMS)) - 2.5).abs() < 1e-12);
        let turned = "gait.squirmer = { modes = [1.5] }\norientation.along = [0, 1, 0]";
        assert!((time(in_box, &at(turned)) - 2.5).abs() < 1e-12);
        let ball = "sphere = { radius = 3 }";
        assert!((time(ball, &at(SWIMS)) - 1.5).abs() < 1e-12);
        let tube = "cylinder = { x = [-9, 9], radius = 3 }";
        assert!((time(tube, &at(SWIMS)) - 1.5).abs() < 1e-12);
        // sqrt(2.5^2 - 1) along x
        let across = "center = [0, 1, 0]\ngait.squirmer = { modes = [1.5] }";
        assert!((time(ball, across) - 5.25_f64.sqrt()).abs() < 1e-12);
        assert!((time(tube, across) - 8.5).abs() < 1e-12);
    }

    #[test]
    fn what_sinks_or_is_pulled_meets_the_floor_late() {
        let in_box = "box = { min = [-2, -4, -2], max = [2, 4, 2] }";
        let falls = met(in_box, "center = [0, 0, 1]\ndensity = 3.0").unwrap();
        // 2 of weight over volume, by Stokes' law: 2/9 2 a^2 / mu
        let speed = 2.0 / 9.0 * 2.0 * 0.25 / 0.5;
        assert!((falls.time - super::DELAY * 2.5 / speed).abs() < 1e-12, "{falls:?}");
        assert!(falls.is_at_side && !falls.swims);
        assert_eq!(met(in_box, "center = [0, 0, 1]\ndensity = 3.0\nlocked = ['z']"), None);
        assert_eq!(met(in_box, "center = [0, 0, 1]\ndensity = 1.0"), None);
        let pulled = "center = [0, 0, 1]\nforce = [1, 0, 0]\nload_factor.sine.period = 1.0";
        assert_eq!(met(in_box, pulled), None);
    }
}
