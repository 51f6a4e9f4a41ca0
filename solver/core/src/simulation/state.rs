//! `State`: what evolves: mesh, fields, bodies, at the present level and the one before.

use alewife_mesh::{Mesh, Point};
use serde::{Deserialize, Serialize};

use super::cycles::{Cycles, Record};
use crate::body::{Pose, Twist};
use crate::contact::ContactLoads;
use crate::coupling::{BodyLoads, Effort, Problem, Solution, effort};
use crate::space::DofLayout;

/// Everything that evolves.
#[derive(Debug, Clone)]
pub struct State {
    /// Number of steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// The last step (s), zero before the first.
    pub last_step: f64,
    /// The mesh now, in the laboratory.
    pub mesh: Mesh<2>,
    /// Where the frame of reference is now (m).
    pub origin: Point<2>,
    /// Places of the nodes now, seen from the frame (m).
    pub nodes: Vec<Point<2>>,
    /// Places of the same nodes one step before, seen from the frame (m).
    pub nodes_before: Vec<Point<2>>,
    /// Fields and twists now.
    pub now: Solution,
    /// Fields and twists one step before.
    pub previous: Solution,
    /// Places of the bodies now, in the laboratory; angles are counted through turns.
    pub places: Vec<Place>,
    /// Places of the bodies one step before.
    pub previous_places: Vec<Place>,
    /// What is added to the place of a body for where it is in the mesh (m): whole periods.
    pub wraps: Vec<Point<2>>,
    /// Rates of change of the velocities at the nodes (m/s2).
    pub rates: Vec<Point<2>>,
    /// Rates of change of the twists (m/s2, rad/s2).
    pub accelerations: Vec<Twist>,
    /// The largest velocity so far (m/s).
    pub top_speed: f64,
    /// Loads of contact.
    pub contact: ContactLoads,
    /// What each group of bodies does and did.
    pub swims: Vec<Swim>,
}

/// What a group of bodies does and did.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Swim {
    /// Numbers of its present effort.
    effort: [f64; 6],
    /// Their time integrals since the start.
    work: [f64; 6],
    /// Time integral of the power where it is positive (J).
    positive_work: f64,
    /// The last two cycles.
    pub cycles: Cycles,
}

impl Swim {
    /// What it does now.
    #[must_use]
    pub fn effort(&self) -> Effort {
        Effort::of(self.effort)
    }

    /// Takes note of an effort without a step.
    pub fn start(&mut self, effort: &Effort) {
        self.effort = effort.numbers();
    }

    /// Takes note of a step (s) with the efforts at some times in it, each with its share, and the
    /// effort at its end.
    pub fn go_on(&mut self, step: f64, shares: &[(Effort, f64)], end: &Effort) {
        for (effort, share) in shares {
            let numbers = effort.numbers();
            self.work.iter_mut().zip(numbers).for_each(|(sum, value)| *sum += step * share * value);
            self.positive_work += step * share * effort.power.max(0.0);
        }
        self.effort = end.numbers();
    }

    /// The record of a time and place.
    #[must_use]
    pub fn record(&self, time: f64, place: [f64; 3]) -> Record {
        Record { time, place, work: self.work, positive_work: self.positive_work }
    }
}

impl State {
    /// Everything at rest at time zero.
    #[must_use]
    pub fn at_rest(problem: &Problem, mesh: Mesh<2>) -> Self {
        let layout = DofLayout::new(&mesh, problem.bodies.len());
        let at_rest = Solution::at_rest(&layout);
        let places: Vec<Place> = problem.bodies.iter().map(|body| place_of(&body.pose)).collect();
        Self {
            step: 0,
            time: 0.0,
            last_step: 0.0,
            origin: Point::<2>::zeros(),
            nodes: mesh.nodes.clone(),
            nodes_before: mesh.nodes.clone(),
            now: at_rest.clone(),
            previous: at_rest,
            previous_places: places.clone(),
            wraps: vec![Point::<2>::zeros(); places.len()],
            rates: vec![Point::<2>::zeros(); mesh.n_nodes()],
            accelerations: vec![Twist::default(); places.len()],
            top_speed: 0.0,
            contact: ContactLoads::none(places.len()),
            swims: vec![Swim::default(); problem.groups.len()],
            places,
            mesh,
        }
    }

    /// Time of the level before (s).
    #[must_use]
    pub fn time_before(&self) -> f64 {
        self.time - self.last_step
    }

    /// Poses of the bodies now, in the laboratory.
    #[must_use]
    pub fn poses(&self) -> Vec<Pose> {
        self.places.iter().map(pose_at).collect()
    }

    /// Poses of the bodies where they are in the mesh.
    #[must_use]
    pub fn poses_in_mesh(&self) -> Vec<Pose> {
        self.wrapped(&self.places).iter().map(pose_at).collect()
    }

    /// Places of bodies where they would be in the mesh.
    #[must_use]
    pub fn wrapped(&self, places: &[Place]) -> Vec<Place> {
        seen_from(&Point::<2>::zeros(), places, &self.wraps)
    }

    /// Places of bodies where they would be in the mesh, seen from a frame at `origin` (m).
    #[must_use]
    pub fn in_frame(&self, origin: &Point<2>, places: &[Place]) -> Vec<Place> {
        seen_from(origin, places, &self.wraps)
    }

    /// The mesh now, seen from the frame.
    #[must_use]
    pub fn mesh_in_frame(&self) -> Mesh<2> {
        Mesh { nodes: self.nodes.clone(), ..self.mesh.clone() }
    }

    /// What the groups do in a flow on the mesh as it lies, with bodies at these places.
    #[must_use]
    pub fn efforts(
        &self,
        problem: &Problem,
        places: &[Place],
        solution: &Solution,
        loads: &[BodyLoads],
    ) -> Vec<Effort> {
        let poses: Vec<Pose> = places.iter().map(pose_at).collect();
        let of = |group| effort(problem, &self.mesh, group, (&poses, &self.wraps), solution, loads);
        problem.groups.iter().map(of).collect()
    }

    /// Where the frame is with bodies at these places (m).
    #[must_use]
    pub fn origin_at(&self, problem: &Problem, places: &[Place]) -> Point<2> {
        problem.frame.map_or(Point::<2>::zeros(), |body| {
            let start = &problem.bodies[body].pose.center;
            Point::<2>::new(places[body][0] - start.x, places[body][1] - start.y)
        })
    }
}

/// Places of bodies, `wraps` added to them, seen from a frame at `origin` (m).
pub(super) fn seen_from(origin: &Point<2>, places: &[Place], wraps: &[Point<2>]) -> Vec<Place> {
    let pairs = places.iter().zip(wraps);
    pairs
        .map(|([x, y, angle], wrap)| [x + wrap.x - origin.x, y + wrap.y - origin.y, *angle])
        .collect()
}

/// Where a body is: x, y of its centre of mass (m), and its angle (rad), not reduced to one turn.
pub type Place = [f64; 3];

/// The poses with these centres and angles.
#[must_use]
pub(super) fn poses_at(places: &[Place]) -> Vec<Pose> {
    places.iter().map(pose_at).collect()
}

/// Centre and angle of a pose (m, rad).
#[must_use]
pub fn place_of(pose: &Pose) -> Place {
    [pose.center.x, pose.center.y, pose.heading()]
}

/// The pose with a centre and angle (m, rad).
#[must_use]
pub fn pose_at(place: &Place) -> Pose {
    Pose::planar(place[0], place[1], place[2])
}
