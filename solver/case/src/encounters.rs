//! What bodies meet that keep the velocity they can be expected to have, and the films of fluid then.

use super::path::Path;
use super::speed::{load_vector, norm, side_speed, swimming_speed, terminal_speed};
use super::{
    Body, BoundaryCondition, ContactSpec, GaitSpec, Geometry, Model, Motion, TimeSettings,
};

/// Gap without contact, over the reach of the body: what a film is left with in most runs, because it
/// thins the slower the thinner it is (1).
const FILM: f64 = 0.02;

/// Time in which a swimmer comes to a stop that is pushed back by the flow it makes, over the time it would
/// take to what it heads for (1): `squirmer-pair/pusher` has a tenth of its speed left then.
const STOPPING: f64 = 3.0;

/// A body at a wall, or one of two bodies that meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// When (s).
    pub time: f64,
    /// Cells that the film takes on a mesh with as many layers as are wanted (1).
    pub film_cells: f64,
    /// Logarithm of the gap at the start, or of the radius if that is less, over the gap at the end (1).
    pub closing: f64,
}

/// Two surfaces that meet.
struct Meeting {
    /// When (s).
    time: f64,
    /// With which speed (m/s).
    speed: f64,
    /// Radius of a body at a wall with the same gap to the second order (m).
    radius: f64,
    /// Part of the film that counts for the body.
    share: f64,
}

impl Model {
    /// The first thing each free body meets on a straight way: a wall, or another body on its own way.
    /// Bodies across periodic sides are not looked at.
    #[must_use]
    pub fn encounters(&self) -> Vec<Encounter> {
        let paths: Vec<Path> = (0..self.bodies.len()).map(|body| self.path(body)).collect();
        let of_body = |body: usize| {
            let met = self.meeting(&paths, body)?;
            (!keeps_away(&self.bodies[body])).then(|| self.encounter(&met))
        };
        (0..paths.len()).filter_map(of_body).collect()
    }

    /// What a body meets first, going straight on.
    fn meeting(&self, paths: &[Path], body: usize) -> Option<Meeting> {
        let path = &paths[body];
        let wall = self.time_to_wall(path).map(|time| Meeting {
            time,
            speed: norm(&path.velocity),
            radius: path.reach,
            share: 1.0,
        });
        let others = paths.iter().enumerate().filter(|(other, _)| *other != body);
        let with_bodies = others.filter_map(|(_, other)| {
            let closing = [0, 1, 2].map(|axis| path.velocity[axis] - other.velocity[axis]);
            Some(Meeting {
                time: path.time_to(other)?,
                speed: norm(&closing),
                radius: path.reach * other.reach / (path.reach + other.reach),
                // The other body has the same film
                share: 0.5,
            })
        });
        with_bodies.chain(wall).min_by(|one, other| one.time.total_cmp(&other.time))
    }

    /// When all has come to rest (s), as far as nothing but weights and forces drives it, and all that
    /// they drive meets something.
    #[must_use]
    pub fn time_to_rest(&self) -> Option<f64> {
        let case = &self.case;
        let is_driven = case.flow.is_some()
            || !self.joints.is_empty()
            || case.boundary.values().any(|condition| side_speed(case, condition) > 0.0)
            || self
                .bodies
                .iter()
                .any(|body| body.gait.is_some() || matches!(body.motion, Motion::Imposed(_)));
        let moves = |body: &usize| norm(&self.path(*body).velocity) > 0.0;
        let n_moving = (0..self.bodies.len()).filter(moves).count();
        let met = self.encounters();
        let all_meet = !is_driven && n_moving > 0 && met.len() >= n_moving;
        all_meet.then(|| met.iter().map(|met| met.time).fold(0.0, f64::max))
    }

    /// How far each free body gets until some time (s), or until it meets a wall or is pushed back, over
    /// its reach; their sum (1).
    #[must_use]
    pub fn expected_paths(&self, end: f64) -> f64 {
        let paths: Vec<Path> = (0..self.bodies.len()).map(|body| self.path(body)).collect();
        let of_body = |(body, path): (usize, &Path)| {
            let is_pushed_back = keeps_away(&self.bodies[body]) && !self.bodies[body].turns();
            let way_end = if is_pushed_back {
                self.meeting(&paths, body).map(|met| met.time)
            } else {
                self.time_to_wall(path)
            };
            norm(&path.velocity) * way_end.map_or(end, |time| time.min(end)) / path.reach
        };
        paths.iter().enumerate().map(of_body).sum()
    }

    /// When nothing moves any more (s) that a mesh would have to follow: swimmers have been pushed back from
    /// what they head for, and what else is there is round and neither driven nor carried along.
    #[must_use]
    pub fn time_to_stop(&self) -> Option<f64> {
        let paths: Vec<Path> = (0..self.bodies.len()).map(|body| self.path(body)).collect();
        let is_carried = |body: &Body| {
            let height = body.center.get(1).copied().unwrap_or(0.0);
            let sides = || self.case.boundary.values();
            let is_shear = sides().any(|side| matches!(side, BoundaryCondition::Shear { .. }));
            sides().any(|side| match side {
                BoundaryCondition::Shear { rate, origin, .. } => rate * (height - origin) != 0.0,
                // Walls of the shear
                BoundaryCondition::Velocity { .. } if is_shear => false,
                other => side_speed(&self.case, other) > 0.0,
            })
        };
        let stops = |(body, path): (usize, &Path)| {
            let this = &self.bodies[body];
            match &this.motion {
                Motion::Held => return Some(0.0),
                Motion::Imposed(_) => return None,
                Motion::Free => {}
            }
            if this.deforms() || this.spring.is_some() || is_carried(this) {
                return None;
            }
            if norm(&path.velocity) == 0.0 {
                let shows_turns = this.turns() && !this.is_round();
                return (!shows_turns && this.gait.is_none()).then_some(0.0);
            }
            let met = self.meeting(&paths, body).filter(|_| keeps_away(this))?;
            (!this.turns()).then_some(STOPPING * met.time)
        };
        let is_still =
            self.joints.is_empty() && self.case.flow.is_none() && !self.bodies.is_empty();
        let times: Option<Vec<f64>> = paths.iter().enumerate().map(stops).collect();
        times.filter(|_| is_still).map(|times| times.into_iter().fold(0.0, f64::max))
    }

    /// Swimming and sinking of a body that is attached to nothing.
    fn path(&self, index: usize) -> Path {
        let body = &self.bodies[index];
        let moves = body.motion == Motion::Free && body.translates(self.case.geometry);
        let [x, y] = if moves && self.is_single(index) { self.drift(body) } else { [0.0; 2] };
        Path::of(body, [x, y, 0.0])
    }

    /// The velocity of a body by its load and its gait, far from everything (m/s).
    fn drift(&self, body: &Body) -> [f64; 2] {
        let load = load_vector(&self.case, body);
        let size = norm(&load);
        let sinking = if size > 0.0 { terminal_speed(&self.case, body) / size } else { 0.0 };
        let (swimming, heading) = match &body.gait {
            Some(GaitSpec::Squirmer(gait)) => {
                (swimming_speed(&self.case, gait), body.angle + gait.heading)
            }
            _ => (0.0, 0.0),
        };
        let (sine, cosine) = heading.sin_cos();
        [sinking * load[0] + swimming * cosine, sinking * load[1] + swimming * sine]
    }

    /// When a body gets to the corners of the domain along x or y that are no periodic sides (s).
    fn time_to_wall(&self, path: &Path) -> Option<f64> {
        let periodic = self.case.periodic_axes();
        path.time_to_sides(&self.case.extent(), |axis| axis < 2 && !periodic[axis])
    }

    /// With a film that is as thin as contact lets it get.
    ///
    /// Its cells are the integral of 4 / (sqrt(3) h^2) over a gap g + x^2 / (2 R), with h the gap over
    /// the layers, times 0.6 since cells there are not equilateral: fitted to the growth of the
    /// shipped cases `squirmer-wall`, `disc-sinking-to-wall`, `sphere-sinking-to-wall` and
    /// `disc-on-wall`.
    fn encounter(&self, met: &Meeting) -> Encounter {
        let Meeting { time, speed, radius, share } = *met;
        let range = match self.case.contact {
            Some(ContactSpec::Barrier { range, .. } | ContactSpec::Quadratic { range, .. }) => {
                Some(range)
            }
            None => None,
        };
        let gap = range.map_or(FILM * radius, |range| 0.5 * range);
        let layers = self.case.mesh.gap_layers / self.case.mesh.scale;
        let planes = match self.case.geometry {
            Geometry::Planar => 1.0,
            // A half plane
            Geometry::Axisymmetric => 0.5,
            Geometry::Spatial => 0.0,
        };
        let film_cells = share * planes * 6.2 * layers * layers * (radius / gap).sqrt();
        let last = range.map_or_else(|| self.drained(speed, radius), |range| 0.5 * range);
        // From further away it comes at a speed that hardly changes
        let first = (speed * time).min(radius);
        Encounter { time, film_cells, closing: (first / last).max(1.0).ln() }
    }

    /// The gap that lubrication leaves at the end of a run between bodies that are pushed together by the
    /// force that gives them a speed far from everything (m): the leading terms of Jeffrey and Onishi 1981
    /// for a disc, and of Brenner 1961 for a sphere, integrated in time.
    fn drained(&self, speed: f64, radius: f64) -> f64 {
        let TimeSettings::Unsteady(time) = &self.case.time else { return FILM * radius };
        let way = speed * time.end / radius;
        let part = match self.case.geometry {
            Geometry::Planar => 4.5 / (way * way),
            Geometry::Axisymmetric | Geometry::Spatial => (-way).exp(),
        };
        radius * part.clamp(1e-6, 1.0)
    }
}

/// Whether a swimmer is turned back by the flow it makes from what it heads for: one that pushes the
/// fluid away ahead of it (Lauga and Powers 2009).
pub(super) fn keeps_away(body: &Body) -> bool {
    let Some(GaitSpec::Squirmer(gait)) = &body.gait else { return false };
    gait.modes.first().zip(gait.modes.get(1)).is_some_and(|(first, second)| first * second < 0.0)
}

#[cfg(test)]
mod tests {
    use crate::{Case, Model};

    fn model(name: &str) -> Model {
        Case::read(name, &[]).unwrap().model
    }

    #[test]
    fn bodies_on_straight_ways_meet_walls_and_each_other() {
        // Two radii of fluid at a speed of one
        let wall = model("squirmer-wall/neutral").encounters();
        assert_eq!(wall.len(), 1);
        assert!((wall[0].time - 2.0).abs() < 1e-12, "{wall:?}");
        let pair = model("squirmer-pair/neutral").encounters();
        assert_eq!(pair.len(), 2);
        assert!(pair.iter().all(|met| (met.time - 1.0).abs() < 1e-12), "{pair:?}");
        assert!(pair[0].film_cells < wall[0].film_cells);
        assert!(model("dfg-2d-2").encounters().is_empty());
        assert!(model("squirmer-wall/pusher").encounters().is_empty());
    }

    #[test]
    fn what_falls_comes_to_rest_and_what_swims_does_not() {
        // Half a radius at the speed (2 weight / (2 radius))^(1/2) of inertia, with a net weight of pi
        let time = model("disc-on-wall/barrier").time_to_rest().unwrap();
        assert!((time - 0.5 / std::f64::consts::PI.sqrt()).abs() < 1e-12, "{time}");
        assert_eq!(model("squirmer-wall/neutral").time_to_rest(), None);
        assert_eq!(model("vortex-induced-vibration").time_to_rest(), None);
    }

    #[test]
    fn a_way_ends_at_a_wall() {
        let model = model("squirmer-wall/neutral");
        assert!((model.expected_paths(1.0) - 1.0).abs() < 1e-12);
        assert!((model.expected_paths(8.0) - 2.0).abs() < 1e-12);
    }
}
