//! `Meshes`: the meshes that a motion without inertia goes through, one after the other.

use std::rc::Rc;

use nalgebra::Vector3;

use super::super::error::GradientError;
use super::super::mesh_of_bodies::{Made, MeshOfBodies};
use super::super::moment::Moment;
use super::super::point::CasePoint;
use crate::body::{MeshPoses, Pose};
use crate::case::CaseFile;
use crate::coupling::{FluidSystem, MeshedBodies, RestPlaces, SolverChoice};
use crate::motion::{Meshed, MovingMesh, RemeshError};
use crate::run::{AtHand, CaseMesh, CellBound, Dimension, RunError, moving_mesh_on};
use crate::step::Workspace;

/// A mesh, and since when it is there.
pub(super) struct MeshSince<const D: usize> {
    /// Time (s).
    pub time: f64,
    /// The mesh.
    pub mesh: Rc<MeshOfBodies<D>>,
}

/// The meshes of a motion, and the system on the present one.
pub(super) struct Meshes<'a, const D: usize> {
    now: Rc<MeshOfBodies<D>>,
    work: Option<Workspace<D>>,
    /// That on the first mesh, for another motion, once there is another mesh.
    first: Option<Workspace<D>>,
    next: Next<'a, D>,
    made: Vec<MeshSince<D>>,
}

/// What a motion leaves to another one.
pub(super) struct Left<const D: usize> {
    /// The system on the first mesh, if it is there.
    pub work: Option<Workspace<D>>,
    /// The meshes made since.
    pub made: Vec<MeshSince<D>>,
}

/// Where other meshes come from.
enum Next<'a, const D: usize> {
    /// They are made where bodies have worn one, as in runs.
    Made(Box<Maker<D>>),
    /// Those of a motion nearby are taken at the same times, so that both differ by their bodies and not by their cells.
    Known(&'a [MeshSince<D>]),
    /// Nothing moves.
    None,
}

struct Maker<const D: usize> {
    moving: MovingMesh<D>,
    bound: CellBound,
}

/// The beginning of a step.
pub(super) struct StepBegin<'a> {
    /// Its number.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    /// Poses of the bodies.
    pub poses: &'a [Pose],
}

impl<'a, const D: usize> Meshes<'a, D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Begins with a mesh that other cases share, where the bodies of this one begin, and the system on it.
    pub fn new(
        file: &CaseFile,
        first: &Rc<MeshOfBodies<D>>,
        work: Workspace<D>,
        bound: CellBound,
    ) -> Result<Self, GradientError> {
        let begin = first.point(file.clone(), &Moment::START)?.mesh;
        let next = match moving_mesh_on::<D>(&file.model, begin)? {
            Some(moving) => Next::Made(Box::new(Maker { moving, bound })),
            None => Next::None,
        };
        Ok(Self { now: Rc::clone(first), work: Some(work), first: None, next, made: Vec::new() })
    }

    /// Begins with the mesh that a motion nearby has begun with, and goes through its meshes.
    pub fn known(
        first: &Rc<MeshOfBodies<D>>,
        work: Workspace<D>,
        known: &'a [MeshSince<D>],
    ) -> Self {
        let next = Next::Known(known);
        Self { now: Rc::clone(first), work: Some(work), first: None, next, made: Vec::new() }
    }

    /// The present one.
    pub fn now(&self) -> &Rc<MeshOfBodies<D>> {
        &self.now
    }

    /// The system on the present one, which is to come back by [`Self::give_back`].
    pub fn take_work(&mut self) -> Workspace<D> {
        self.work.take().expect("a flow gives its system back")
    }

    /// Takes the system back.
    pub fn give_back(&mut self, work: Workspace<D>) {
        self.work = Some(work);
    }

    /// What is of use to another motion.
    pub fn end(self) -> Left<D> {
        Left { work: self.first.or(self.work), made: self.made }
    }

    /// Goes on to another mesh where it is time.
    pub fn renew(&mut self, file: &CaseFile, begin: &StepBegin<'_>) -> Result<(), GradientError> {
        let mesh = match &mut self.next {
            Next::None => return Ok(()),
            Next::Known(known) => match known.split_first() {
                Some((next, rest)) if next.time <= begin.time => {
                    *known = rest;
                    Rc::clone(&next.mesh)
                }
                _ => return Ok(()),
            },
            Next::Made(maker) => {
                let point = self.now.point(file.clone(), &begin.moment())?;
                let Some(reason) = maker.reason_to_replace(&point) else { return Ok(()) };
                let work = self.work.as_ref().expect("a flow has given its system back");
                let at_hand = AtHand {
                    n_cells: point.mesh.n_cells(),
                    is_iterative: work.system.is_iterative(),
                };
                let shifts = self.now.shifts();
                let made = maker.made(&point, shifts, begin, Needed { reason, at_hand })?;
                Rc::new(made)
            }
        };
        let point = mesh.point(file.clone(), &begin.moment())?;
        let system = system_on(&point);
        self.made.push(MeshSince { time: begin.time, mesh: Rc::clone(&mesh) });
        self.now = mesh;
        let before = self.work.replace(Workspace::new(system, point.mesh));
        if self.first.is_none() {
            self.first = before;
        }
        Ok(())
    }
}

impl StepBegin<'_> {
    fn moment(&self) -> Moment {
        Moment { time: self.time, rates_at: self.time, poses: Some(self.poses.to_vec()) }
    }
}

/// Why a mesh is to be made, and that in use.
struct Needed {
    reason: String,
    at_hand: AtHand,
}

impl<const D: usize> Maker<D>
where
    Dimension<D>: CaseMesh<D>,
{
    fn reason_to_replace(&mut self, point: &CasePoint<D>) -> Option<String> {
        self.moving.reason_to_replace(&point.mesh, &point.in_mesh, point.bodies().shapes)
    }

    /// A mesh for the bodies of a point, which are moved by these periods (m) in its own.
    fn made(
        &mut self,
        point: &CasePoint<D>,
        shifts: &[Vector3<f64>],
        begin: &StepBegin<'_>,
        needed: Needed,
    ) -> Result<MeshOfBodies<D>, GradientError> {
        let (step, time) = (begin.step, begin.time);
        let moved = |more: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
            shifts.iter().zip(more).map(|(known, more)| known + more).collect()
        };
        let shifted = |more: &[Vector3<f64>]| {
            MeshPoses::seen_from(&Vector3::zeros(), &point.poses, &moved(more))
        };
        let shapes = point.bodies().shapes;
        let allowed = self.bound.allowed::<D>(needed.at_hand);
        let made = self.moving.remesh(&point.in_mesh, shapes, &shifted, allowed.cells());
        let Meshed { mesh, scene, poses, shifts: more } = made.map_err(|error| match error {
            RemeshError::TooManyCells { n_cells, .. } => RunError::MeshTooLarge {
                step,
                time,
                n_cells,
                allowed,
                reason: needed.reason,
                nearest: String::new(),
                closes: true,
            },
            error => RunError::Remesh { step, time, reason: Box::new(error) },
        })?;
        self.moving = self.moving.succeeded_by(&mesh, scene, poses, time)?;
        let (shifts, poses) = (moved(&more), &point.poses);
        let made = Made { mesh: &mesh, shifts: &shifts, poses };
        MeshOfBodies::new(&point.model, &point.problem, made)
    }
}

/// The system of a case on its mesh.
fn system_on<const D: usize>(point: &CasePoint<D>) -> FluidSystem<D> {
    let bodies = MeshedBodies { at: point.bodies(), rest_places: RestPlaces::new() };
    let CasePoint { problem, mesh, .. } = point;
    let look = || Ok::<(), std::convert::Infallible>(());
    let made =
        FluidSystem::with_bodies(problem, mesh, bodies, false, SolverChoice::default(), look);
    let Ok(system) = made;
    system
}
