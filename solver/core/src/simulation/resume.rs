//! `SavedState`: a state as it is written to a file, for a run that resumes from it.

use std::sync::Arc;

use alewife_mesh::{
    Boundary, BoundaryId, CellId, Facet, Mesh, NodeId, Outline, PeriodicPair, Point,
};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::RunError;
use super::advance::Simulation;
use super::energy::EnergyBalance;
use super::moving_mesh::MovingMesh;
use super::planar::{PlanarCase, PlanarScene};
use super::propulsion_history::PropulsionHistory;
use super::scene::RemeshError;
use super::start::motion_settings;
use super::state::State;
use crate::body::{Pose, Twist, Wrench, on_mesh};
use crate::case::Model;
use crate::contact::{ContactLoads, MinimumGap, Partner};
use crate::coupling::{BodyShapes, FluidSystem, Problem, ShapeError, Solution};

/// Version of the file; others are refused.
const VERSION: u32 = 3;

/// Distance over the size of its coordinates by which a body may be elsewhere when a run resumes.
const JUMP: f64 = 1e-9;

/// Distance over the length of an edge by which the outline of a body may be elsewhere then.
const OUTLINE_JUMP: f64 = 1e-2;

/// Why a run cannot resume from a state.
#[derive(Debug, Error)]
pub enum ResumeError {
    /// It was written by another version.
    #[error("its version is {found}, and {VERSION} is wanted")]
    Version {
        /// The version of the file.
        found: u32,
    },
    /// It has other bodies.
    #[error("its bodies are {state:?}, those of the case {case:?}")]
    Bodies {
        /// Names in the state.
        state: Vec<String>,
        /// Names in the case.
        case: Vec<String>,
    },
    /// Lengths or indices contradict each other.
    #[error("its parts do not fit together")]
    Inconsistent,
    /// The joints of the case put a body elsewhere.
    #[error(
        "body `{body}` was left at ({:.6}, {:.6}) turned by {:.6}, and the joints of this case \
         put it at ({:.6}, {:.6}) turned by {:.6}: a run resumes with the strokes it began with",
        .left.center.x, .left.center.y, .left.angle(), .put.center.x, .put.center.y, .put.angle()
    )]
    Joint {
        /// Name of the body.
        body: String,
        /// Where it is in the state.
        left: Box<Pose>,
        /// Where the joints of the case put it.
        put: Box<Pose>,
    },
    /// The gait of the case gives a body another outline.
    #[error(
        "the surface of body `{body}` is {distance:.3e} from where the gait of this case puts it: \
         a run resumes with the gait it began with"
    )]
    Outline {
        /// Name of the body.
        body: String,
        /// Distance of the surfaces (m).
        distance: f64,
    },
    /// The mesh moves in one and not in the other.
    #[error("its mesh moves and that of the case does not, or vice versa")]
    MeshMotion,
    /// What moves the mesh could not be set up.
    #[error(transparent)]
    Remesh(#[from] RemeshError),
    /// A gait gives its body no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// Everything that evolves, as plain numbers in the case's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    version: u32,
    /// Names of the bodies, which must be those of the case that resumes.
    bodies: Vec<String>,
    /// Steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    last_step: f64,
    proposed_step: Option<f64>,
    start_pieces: Vec<f64>,
    remeshes: usize,
    mesh: SavedMesh,
    origin: Vector3<f64>,
    nodes: Vec<Point<2>>,
    nodes_before: Vec<Point<2>>,
    now: SavedLevel,
    previous: SavedLevel,
    rates: Vec<Point<2>>,
    accelerations: Vec<Twist>,
    poses: Vec<Pose>,
    previous_poses: Vec<Pose>,
    image_shifts: Vec<Vector3<f64>>,
    top_speed: f64,
    contact: SavedContact,
    propulsion: Vec<PropulsionHistory>,
    energy: EnergyBalance,
    reference: Option<SavedReference>,
}

/// The topology of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedMesh {
    n_vertices: usize,
    cells: Vec<u32>,
    curved: Vec<bool>,
    /// Cell, side and boundary of each facet.
    facets: Vec<(u32, u8, u16)>,
    periodic: Vec<(u32, u32)>,
}

/// Fields and rigid velocities of one level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedLevel {
    velocity: Vec<Point<2>>,
    pressure: Vec<f64>,
    twists: Vec<Twist>,
}

/// Loads of contact and the smallest gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedContact {
    wrenches: Vec<Wrench>,
    minimum_gap: Option<SavedGap>,
}

/// A gap between a body and another one, or a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct SavedGap {
    body: usize,
    other: Option<usize>,
    wall: Option<usize>,
    gap: f64,
}

/// The reference mesh, and where the bodies were then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SavedReference {
    nodes: Vec<Point<2>>,
    poses: Vec<Pose>,
    time: f64,
    /// Start of the domain along its periodic directions.
    domain_start: Point<2>,
}

impl SavedMesh {
    fn of(mesh: &Mesh<2>) -> Self {
        let facet = |facet: &Facet| (facet.cell.into(), facet.side, facet.boundary.into());
        Self {
            n_vertices: mesh.n_vertices,
            cells: mesh.cells.iter().copied().map(u32::from).collect(),
            curved: mesh.curved.clone(),
            facets: mesh.facets.iter().map(facet).collect(),
            periodic: mesh.periodic.iter().map(|p| (p.copy.into(), p.original.into())).collect(),
        }
    }

    fn is_consistent(&self, n_nodes: usize, n_boundaries: usize) -> bool {
        let n_cells = self.curved.len();
        let is_node = |node: u32| (node as usize) < n_nodes;
        self.n_vertices <= n_nodes
            && self.cells.len() == 6 * n_cells
            && self.cells.iter().all(|node| is_node(*node))
            && self.periodic.iter().all(|(copy, original)| is_node(*copy) && is_node(*original))
            && self.facets.iter().all(|&(cell, side, boundary)| {
                (cell as usize) < n_cells && side < 3 && usize::from(boundary) < n_boundaries
            })
    }

    fn with_nodes(&self, nodes: Vec<Point<2>>, boundaries: &[Boundary]) -> Mesh<2> {
        let facet = |&(cell, side, boundary): &(u32, u8, u16)| Facet {
            cell: CellId::from(cell),
            side,
            boundary: BoundaryId::from(boundary),
        };
        let pair = |&(copy, original): &(u32, u32)| PeriodicPair {
            copy: NodeId::from(copy),
            original: NodeId::from(original),
        };
        Mesh {
            nodes,
            n_vertices: self.n_vertices,
            cells: self.cells.iter().copied().map(NodeId::from).collect(),
            curved: self.curved.clone(),
            facets: self.facets.iter().map(facet).collect(),
            boundaries: boundaries.to_vec(),
            periodic: self.periodic.iter().map(pair).collect(),
        }
    }
}

impl SavedLevel {
    fn of(solution: &Solution<2>) -> Self {
        let Solution { velocity, pressure, twists } = solution.clone();
        Self { velocity, pressure, twists }
    }

    fn is_consistent(&self, n_nodes: usize, n_vertices: usize, n_bodies: usize) -> bool {
        self.velocity.len() == n_nodes
            && self.pressure.len() == n_vertices
            && self.twists.len() == n_bodies
    }

    fn solution(&self) -> Solution<2> {
        let Self { velocity, pressure, twists } = self.clone();
        Solution { velocity, pressure, twists }
    }
}

impl SavedContact {
    fn of(contact: &ContactLoads) -> Self {
        let gap = |minimum: MinimumGap| {
            let (other, wall) = match minimum.partner {
                Partner::Body(body) => (Some(body), None),
                Partner::Wall(side) => (None, Some(side)),
            };
            SavedGap { body: minimum.body, other, wall, gap: minimum.gap }
        };
        Self { wrenches: contact.wrenches.clone(), minimum_gap: contact.minimum_gap.map(gap) }
    }

    fn loads(&self) -> ContactLoads {
        let gap = |saved: SavedGap| {
            let partner = saved.other.map(Partner::Body).or(saved.wall.map(Partner::Wall))?;
            Some(MinimumGap { body: saved.body, partner, gap: saved.gap })
        };
        ContactLoads {
            wrenches: self.wrenches.clone(),
            contacts: Vec::new(),
            minimum_gap: self.minimum_gap.and_then(gap),
        }
    }
}

impl SavedState {
    /// What is written of a state.
    #[must_use]
    pub(super) fn of(
        problem: &Problem<2>,
        state: &State<2>,
        moving: Option<&MovingMesh<2>>,
    ) -> Self {
        Self {
            version: VERSION,
            bodies: names(problem),
            step: state.step,
            time: state.time,
            last_step: state.last_step,
            proposed_step: state.proposed_step,
            start_pieces: state.start_pieces.clone(),
            remeshes: state.remeshes,
            mesh: SavedMesh::of(&state.mesh),
            origin: state.origin,
            nodes: state.nodes.clone(),
            nodes_before: state.nodes_before.clone(),
            now: SavedLevel::of(&state.now),
            previous: SavedLevel::of(&state.previous),
            rates: state.rates.clone(),
            accelerations: state.accelerations.clone(),
            poses: state.poses.clone(),
            previous_poses: state.previous_poses.clone(),
            image_shifts: state.image_shifts.clone(),
            top_speed: state.top_speed,
            contact: SavedContact::of(&state.contact),
            propulsion: state.propulsion.clone(),
            energy: state.energy,
            reference: moving.map(|moving| SavedReference {
                nodes: moving.reference().to_vec(),
                poses: moving.reference_poses().to_vec(),
                time: moving.reference_time(),
                domain_start: moving.scene().domain_start(),
            }),
        }
    }

    /// Puts a simulation of a case with the same bodies where this state is.
    ///
    /// # Errors
    /// When the state is not one of such a case.
    pub(super) fn restore_into(
        &self,
        model: &Model,
        simulation: &mut Simulation<2>,
    ) -> Result<(), RunError> {
        let problem = &simulation.problem;
        let boundaries = simulation.state.mesh.boundaries.clone();
        self.check(problem, boundaries.len())?;
        let state = self.state(&boundaries);
        simulation.moving_mesh = match (&self.reference, model.mesh_moves()) {
            (Some(reference), true) => {
                Some(self.moving_mesh(reference, model, problem, &boundaries)?)
            }
            (None, false) => None,
            _ => return Err(ResumeError::MeshMotion.into()),
        };
        let poses = state.in_mesh(&state.poses);
        let unknown_frame = simulation.scheme.unknown_frame;
        simulation.work.system = FluidSystem::new(problem, &state.mesh, &poses, unknown_frame);
        simulation.work.mesh = state.mesh.clone();
        (simulation.state, simulation.is_fresh) = (state, false);
        Ok(())
    }

    /// Whether the parts of the state fit together and to a problem.
    fn check(&self, problem: &Problem<2>, n_boundaries: usize) -> Result<(), ResumeError> {
        if self.version != VERSION {
            return Err(ResumeError::Version { found: self.version });
        }
        let case = names(problem);
        if self.bodies != case {
            return Err(ResumeError::Bodies { state: self.bodies.clone(), case });
        }
        let (n_nodes, n_bodies) = (self.nodes.len(), case.len());
        let levels = [&self.now, &self.previous];
        let n_vertices = self.mesh.n_vertices;
        let fits = self.mesh.is_consistent(n_nodes, n_boundaries)
            && [&self.nodes_before, &self.rates].iter().all(|values| values.len() == n_nodes)
            && levels.iter().all(|level| level.is_consistent(n_nodes, n_vertices, n_bodies))
            && [&self.poses, &self.previous_poses].iter().all(|poses| poses.len() == n_bodies)
            && self.accelerations.len() == n_bodies
            && self.image_shifts.len() == n_bodies
            && self.contact.wrenches.len() == n_bodies
            && self.propulsion.len() == problem.groups.len()
            && self.reference.as_ref().is_none_or(|reference| {
                reference.nodes.len() == n_nodes && reference.poses.len() == n_bodies
            });
        if !fits {
            return Err(ResumeError::Inconsistent);
        }
        self.check_joints(problem)
    }

    /// Whether the joints of the case leave the bodies where they are.
    fn check_joints(&self, problem: &Problem<2>) -> Result<(), ResumeError> {
        let mut put = self.poses.clone();
        problem.apply_joints(&mut put, self.time);
        for (body, (left, put)) in problem.bodies.iter().zip(self.poses.iter().zip(&put)) {
            let numbers = |pose: &Pose| [pose.center.x, pose.center.y, pose.angle()];
            let (was, is) = (numbers(left), numbers(put));
            let size = was.iter().chain(&is).fold(0.0f64, |most, value| most.max(value.abs()));
            if was.iter().zip(is).any(|(was, is)| (was - is).abs() > JUMP * size) {
                let body = body.name.clone();
                let (left, put) = (Box::new(*left), Box::new(*put));
                return Err(ResumeError::Joint { body, left, put });
            }
        }
        Ok(())
    }

    fn state(&self, boundaries: &[Boundary]) -> State<2> {
        let origin = on_mesh::<2>(&self.origin);
        let in_laboratory = self.nodes.iter().map(|node| node + origin).collect();
        State {
            step: self.step,
            time: self.time,
            last_step: self.last_step,
            proposed_step: self.proposed_step,
            start_pieces: self.start_pieces.clone(),
            remeshes: self.remeshes,
            mesh: self.mesh.with_nodes(in_laboratory, boundaries),
            origin: self.origin,
            nodes: self.nodes.clone(),
            nodes_before: self.nodes_before.clone(),
            now: self.now.solution(),
            previous: self.previous.solution(),
            poses: self.poses.clone(),
            previous_poses: self.previous_poses.clone(),
            image_shifts: self.image_shifts.clone(),
            rates: self.rates.clone(),
            accelerations: self.accelerations.clone(),
            top_speed: self.top_speed,
            contact: self.contact.loads(),
            propulsion: self.propulsion.clone(),
            energy: self.energy,
        }
    }

    fn moving_mesh(
        &self,
        reference: &SavedReference,
        model: &Model,
        problem: &Problem<2>,
        boundaries: &[Boundary],
    ) -> Result<MovingMesh<2>, RunError> {
        let mesh = self.mesh.with_nodes(reference.nodes.clone(), boundaries);
        let shapes = BodyShapes::at(&problem.bodies, reference.time)?;
        check_outlines(problem, &mesh, reference, &shapes)?;
        let planar = Arc::new(PlanarCase::new(model, problem)?);
        let settings = motion_settings(&model.case, &planar);
        let (start, poses) = (&reference.domain_start, reference.poses.clone());
        let scene = PlanarScene::restored(planar, &mesh, start, poses.clone(), &shapes)
            .map_err(ResumeError::from)?;
        Ok(MovingMesh::new(&mesh, Box::new(scene), settings, poses, reference.time)?)
    }
}

fn names(problem: &Problem<2>) -> Vec<String> {
    problem.bodies.iter().map(|body| body.name.clone()).collect()
}

/// Whether bodies that deform had these outlines when a mesh was generated.
fn check_outlines(
    problem: &Problem<2>,
    mesh: &Mesh<2>,
    reference: &SavedReference,
    shapes: &BodyShapes,
) -> Result<(), ResumeError> {
    for (body, rigid) in problem.bodies.iter().enumerate() {
        let Some(outline) = shapes.outline(body) else { continue };
        let pose = &reference.poses[body];
        let outline: Outline = outline.placed_at(on_mesh(&pose.center), pose.angle());
        for facet in mesh.facets.iter().filter(|facet| facet.boundary == rigid.boundary) {
            let [start, end] = mesh.facet_vertices(facet).map(|node| mesh.nodes[node]);
            let distance = (outline.at(outline.parameter_of(start))[0] - start).norm();
            if distance > OUTLINE_JUMP * (end - start).norm() {
                return Err(ResumeError::Outline { body: rigid.name.clone(), distance });
            }
        }
    }
    Ok(())
}
