//! `SavedState`: a state as it is written to a file, for a run that goes on from it.

use alewife_mesh::{
    Boundary, Facet, Mesh, NodeId, Outline, PeriodicPair, PlacedShape, Point, Simplex,
};
use serde::{Deserialize, Serialize};

use super::build::placed_bodies;
use super::follow::Follower;
use super::opened::{start_of, started_at};
use super::state::{Place, State, Swim, place_of, pose_at};
use crate::body::Twist;
use crate::case::Model;
use crate::contact::ContactLoads;
use crate::coupling::{BodyShapes, Problem, Solution};
use crate::motion::RigidMove;

/// Version of the file; others are refused.
const VERSION: u32 = 2;

/// Way over the size of its coordinates by which a body may be elsewhere when a run goes on.
const JUMP: f64 = 1e-9;

/// Way over the length of an edge by which the outline of a body may be elsewhere then.
const OUTLINE_JUMP: f64 = 1e-2;

type Pair = [f64; 2];

/// Everything that evolves, as plain numbers in the case's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    version: u32,
    /// Names of the bodies, which must be those of the case that goes on.
    bodies: Vec<String>,
    /// Steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    last_step: f64,
    n_vertices: usize,
    cells: Vec<u32>,
    curved: Vec<bool>,
    facets: Vec<(u32, u8, u16)>,
    periodic: Vec<(u32, u32)>,
    origin: Pair,
    nodes: Vec<Pair>,
    nodes_before: Vec<Pair>,
    levels: [Level; 2],
    rates: Vec<Pair>,
    accelerations: Vec<Place>,
    places: Vec<Place>,
    previous_places: Vec<Place>,
    wraps: Vec<Pair>,
    top_speed: f64,
    swims: Vec<Swim>,
    remeshes: usize,
    following: Option<Following>,
}

/// Fields and rigid velocities of one level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Level {
    velocity: Vec<Pair>,
    pressure: Vec<f64>,
    twists: Vec<Place>,
}

/// The mesh as it was made, and where the bodies were then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Following {
    nodes: Vec<Pair>,
    made_at: Vec<Place>,
    made_time: f64,
    /// Start of the domain along its periodic directions.
    domain_start: Pair,
}

fn pairs(points: &[Point<2>]) -> Vec<Pair> {
    points.iter().map(|point| [point.x, point.y]).collect()
}

fn points(pairs: &[Pair]) -> Vec<Point<2>> {
    pairs.iter().map(|pair| Point::<2>::new(pair[0], pair[1])).collect()
}

fn rigid(twists: &[Twist]) -> Vec<Place> {
    twists.iter().map(Twist::in_plane).collect()
}

fn twists(rigid: &[Place]) -> Vec<Twist> {
    rigid.iter().copied().map(Twist::planar).collect()
}

impl SavedState {
    /// What is written of a state.
    #[must_use]
    pub(super) fn of(
        problem: &Problem,
        state: &State,
        follower: Option<&Follower>,
        remeshes: usize,
    ) -> Self {
        let level = |solution: &Solution| Level {
            velocity: pairs(&solution.velocity),
            pressure: solution.pressure.clone(),
            twists: rigid(&solution.twists),
        };
        let mesh = &state.mesh;
        let facet = |facet: &Facet| (facet.cell.into(), facet.side, facet.boundary.into());
        Self {
            version: VERSION,
            bodies: problem.bodies.iter().map(|body| body.name.clone()).collect(),
            step: state.step,
            time: state.time,
            last_step: state.last_step,
            n_vertices: mesh.n_vertices,
            cells: mesh.cells.iter().copied().map(u32::from).collect(),
            curved: mesh.curved.clone(),
            facets: mesh.facets.iter().map(facet).collect(),
            periodic: mesh.periodic.iter().map(|p| (p.copy.into(), p.original.into())).collect(),
            origin: [state.origin.x, state.origin.y],
            nodes: pairs(&state.nodes),
            nodes_before: pairs(&state.nodes_before),
            levels: [level(&state.now), level(&state.previous)],
            rates: pairs(&state.rates),
            accelerations: rigid(&state.accelerations),
            places: state.places.clone(),
            previous_places: state.previous_places.clone(),
            wraps: pairs(&state.wraps),
            top_speed: state.top_speed,
            swims: state.swims.clone(),
            remeshes,
            following: follower.map(|follower| Following {
                nodes: pairs(follower.reference()),
                made_at: follower.made_at().to_vec(),
                made_time: follower.made_time(),
                domain_start: start_of(follower.domain()),
            }),
        }
    }

    /// Meshes made since the first.
    pub(super) fn remeshes(&self) -> usize {
        self.remeshes
    }

    /// The state and what moves its mesh, for a case with the same bodies.
    ///
    /// # Errors
    /// When the state is not one of such a case, in words.
    pub(super) fn restore(
        &self,
        model: &Model,
        problem: &Problem,
        boundaries: &[Boundary],
    ) -> Result<(State, Option<Follower>), String> {
        if self.version != VERSION {
            return Err(format!("its version is {}, and {VERSION} is wanted", self.version));
        }
        let names: Vec<&str> = problem.bodies.iter().map(|body| body.name.as_str()).collect();
        if self.bodies != names {
            return Err(format!("its bodies are {:?}, those of the case {names:?}", self.bodies));
        }
        let (n_nodes, n_bodies) = (self.nodes.len(), names.len());
        let n_boundaries = boundaries.len();
        let fits = self.n_vertices <= n_nodes
            && self.cells.len() == Simplex::<2>::N_NODES * self.curved.len()
            && self.cells.iter().all(|node| (*node as usize) < n_nodes)
            && self.facets.iter().all(|facet| {
                (facet.0 as usize) < self.curved.len() && usize::from(facet.2) < n_boundaries
            })
            && self.nodes_before.len() == n_nodes
            && self.rates.len() == n_nodes
            && self.levels.iter().all(|level| {
                level.velocity.len() == n_nodes
                    && level.pressure.len() == self.n_vertices
                    && level.twists.len() == n_bodies
            })
            && [&self.accelerations, &self.places, &self.previous_places]
                .iter()
                .all(|values| values.len() == n_bodies)
            && self.wraps.len() == n_bodies
            && self.swims.len() == problem.groups.len()
            && self.following.as_ref().is_none_or(|following| {
                following.nodes.len() == n_nodes && following.made_at.len() == n_bodies
            });
        if !fits {
            return Err("its parts do not fit together".to_owned());
        }
        let mut hung = self.places.clone();
        problem.hang(&mut hung, self.time);
        for (name, (was, put)) in names.iter().zip(self.places.iter().zip(&hung)) {
            let size = was.iter().chain(put).fold(0.0f64, |most, value| most.max(value.abs()));
            if was.iter().zip(put).any(|(was, put)| (was - put).abs() > JUMP * size) {
                return Err(format!(
                    "body `{name}` was left at ({:.6}, {:.6}) turned by {:.6}, and the joints of this case \
                     put it at ({:.6}, {:.6}) turned by {:.6}: a run goes on with the strokes it began with",
                    was[0], was[1], was[2], put[0], put[1], put[2]
                ));
            }
        }
        let origin = Point::<2>::new(self.origin[0], self.origin[1]);
        let nodes = points(&self.nodes);
        let facet = |&(cell, side, boundary): &(u32, u8, u16)| Facet {
            cell: cell.into(),
            side,
            boundary: boundary.into(),
        };
        let pair = |&(copy, original): &(u32, u32)| PeriodicPair {
            copy: copy.into(),
            original: original.into(),
        };
        let mesh = Mesh {
            nodes: nodes.iter().map(|node| node + origin).collect(),
            n_vertices: self.n_vertices,
            cells: self.cells.iter().copied().map(NodeId::from).collect(),
            curved: self.curved.clone(),
            facets: self.facets.iter().map(facet).collect(),
            boundaries: boundaries.to_vec(),
            periodic: self.periodic.iter().map(pair).collect(),
        };
        let level = |level: &Level| Solution {
            velocity: points(&level.velocity),
            pressure: level.pressure.clone(),
            twists: twists(&level.twists),
        };
        let follower = match (&self.following, model.mesh_moves()) {
            (Some(following), true) => {
                let mut made = mesh.clone();
                made.nodes = points(&following.nodes);
                let domain = started_at(&model.case.mesh_domain(), following.domain_start);
                let pairs = problem.bodies.iter().zip(&following.made_at);
                let shapes = placed_bodies(model).map_err(|error| error.to_string())?;
                let then = BodyShapes::at(&problem.bodies, following.made_time)
                    .map_err(|error| error.to_string())?;
                let pairs = pairs.enumerate();
                let shapes = shapes.into_iter().zip(pairs).map(|(shape, (nth, (body, at)))| {
                    let start = pose_at(&place_of(&body.pose));
                    let carried = RigidMove::between(&start, &pose_at(at)).carry(&shape);
                    match then.deformed(nth) {
                        None => carried,
                        Some(deformed) => PlacedShape { shape: deformed.shape(), ..carried },
                    }
                });
                let made_at = (following.made_at.clone(), following.made_time);
                let shapes: Vec<PlacedShape> = shapes.collect();
                goes_on(problem, &made, &shapes)?;
                Some(Follower::new(model, problem, &made, domain, shapes, made_at)?)
            }
            (None, false) => None,
            _ => return Err("its mesh moves and that of the case does not, or vice versa".into()),
        };
        let state = State {
            step: self.step,
            time: self.time,
            last_step: self.last_step,
            mesh,
            origin,
            nodes,
            nodes_before: points(&self.nodes_before),
            now: level(&self.levels[0]),
            previous: level(&self.levels[1]),
            places: self.places.clone(),
            previous_places: self.previous_places.clone(),
            wraps: points(&self.wraps),
            rates: points(&self.rates),
            accelerations: twists(&self.accelerations),
            top_speed: self.top_speed,
            swims: self.swims.clone(),
            contact: ContactLoads::none(n_bodies),
        };
        Ok((state, follower))
    }
}

/// Whether bodies that deform had these outlines when a mesh was made.
fn goes_on(problem: &Problem, made: &Mesh<2>, shapes: &[PlacedShape]) -> Result<(), String> {
    for (body, shape) in problem.bodies.iter().zip(shapes) {
        if body.shape.is_none() {
            continue;
        }
        let outline = Outline::new(shape).map_err(|error| error.to_string())?;
        for facet in made.facets.iter().filter(|facet| facet.boundary.index() == body.boundary) {
            let [start, end] = made.facet_vertices(facet).map(|vertex| made.nodes[vertex]);
            let off = (outline.at(outline.parameter_of(start))[0] - start).norm();
            if off > OUTLINE_JUMP * (end - start).norm() {
                return Err(format!(
                    "the surface of body `{}` is {off:.3e} from where the gait of this case puts it: \
                     a run goes on with the gait it began with",
                    body.name
                ));
            }
        }
    }
    Ok(())
}
