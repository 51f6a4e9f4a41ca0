//! Speeds that are still to come: what a run that is at rest is measured by, and up to where it may step.

use alewife_mesh::{BoundaryId, NodeId, Point};

use crate::body::{Mode, in_space};
use crate::case::Unsteady;
use crate::coupling::Side;
use crate::run::simulation::Simulation;
use crate::step::NEARLY_AT_REST;

/// Times at which what is given is looked at, a first step apart: all of a run where that is chosen by its end.
const LOOKS: usize = 1000;

/// Nodes of a boundary at which it is: what is found is a lower bound.
const PLACES: usize = 16;

impl<const D: usize> Simulation<D> {
    /// Notes the largest speed that will be given, to the next power of two: runs with different ends find the same.
    pub(super) fn look_ahead(&mut self, settings: &Unsteady) {
        let places = self.given_places();
        let times = (1..=LOOKS).map(|look| look as f64 * settings.step);
        let times = times.take_while(|time| *time <= settings.end);
        let largest = times.map(|time| self.speed_given_at(&places, time)).fold(0.0, f64::max);
        if largest > 0.0 && largest.is_finite() {
            self.state.expect_speed(largest.log2().round().exp2());
        }
    }

    /// The first time (s) looked at in a step of a size (s) at which what is given is no longer next to nothing, where fluid
    /// and bodies are nearly at rest.
    pub(super) fn end_of_rest(&self, settings: &Unsteady, size: f64) -> Option<f64> {
        let moving = NEARLY_AT_REST * self.state.top_speed;
        if self.state.now.top_speed() >= moving {
            return None;
        }
        let (time, step) = (self.state.time, settings.step);
        let times = (1..=LOOKS).map(|look| look as f64 * step);
        // One that is as good as over does not count
        let to_come = times.skip_while(|at| at - time <= 1e-6 * step);
        let mut within = to_come.take_while(|at| at - time < size);
        let places = self.given_places();
        within.find(|at| self.speed_given_at(&places, *at) > moving)
    }

    /// Some nodes of each boundary.
    fn given_places(&self) -> Vec<Vec<NodeId>> {
        let mesh = &self.state.mesh;
        let on = |boundary: usize| {
            let own = mesh.facets.iter().filter(|one| one.boundary == BoundaryId::new(boundary));
            let nodes: Vec<NodeId> = own.flat_map(|facet| mesh.facet_nodes(facet)).collect();
            nodes.iter().step_by(nodes.len().div_ceil(PLACES).max(1)).copied().collect()
        };
        (0..self.problem.sides.len()).map(on).collect()
    }

    /// The largest speed (m/s) that is given at a time (s): of sides, of bodies that are moved, of surfaces that slip.
    fn speed_given_at(&self, places: &[Vec<NodeId>], time: f64) -> f64 {
        let Self { problem, state, .. } = self;
        let at = |boundary: usize| places[boundary].iter().map(|node| &state.mesh.nodes[*node]);
        let sides = problem.sides.iter().enumerate().filter_map(|(side, given)| match given {
            Some(Side::Velocity { profile, .. }) => Some((side, profile)),
            _ => None,
        });
        let of_sides = sides.flat_map(|(side, profile)| {
            at(side).map(move |place: &Point<D>| profile(place, time).norm())
        });
        let poses = state.in_mesh(&state.poses);
        let of_bodies = problem.bodies.iter().zip(poses.iter()).flat_map(|(body, pose)| {
            let given = |mode: Mode| body.drive(mode).given(time).unwrap_or(0.0).abs();
            let moved = Mode::ALL.into_iter().filter(|mode| !mode.is_rotation()).map(given);
            let slip = body.gait.iter().flat_map(move |gait| {
                let own = |place: &Point<D>| pose.to_body(&(in_space(place) - pose.center));
                at(body.boundary.index()).map(move |place| gait.velocity(&own(place), time).norm())
            });
            moved.chain(slip)
        });
        of_sides.chain(of_bodies).fold(0.0, f64::max)
    }
}
