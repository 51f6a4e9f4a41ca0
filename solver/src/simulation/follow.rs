//! `Follower`: the mesh that follows its bodies until it has to be made anew.

use alewife_mesh::{BoundaryKind, Domain, Mesh, PlacedShape, Point, Surroundings};

use super::build::waving_sheet;
use super::state::pose_at;
use crate::case::{Case, MeshEquation};
use crate::contact::{Place, Surfaces};
use crate::coupling::Problem;
use crate::gait::WavingSheet;
use crate::motion::{
    Fresh, Hold, Limits, MeshMotion, MotionError, MotionKind, Reason, RigidMove, Stiffening, holds,
    needs_remesh,
};

/// Part of an edge by which a body may be elsewhere than where the flow was solved.
const MISPLACED: f64 = 1e-3;
/// Quality of a cell over its quality when new below which no flow is solved on it.
const HOPELESS: f64 = 0.02;

/// A mesh with all that moves it, from one making to the next. Places are seen from the frame.
#[derive(Debug)]
pub struct Follower {
    motion: MeshMotion,
    /// Places of the bodies in the mesh when it was made.
    made_at: Vec<Place>,
    /// Bodies as they were then.
    shapes: Vec<PlacedShape>,
    /// Whether the mesh turns with each body.
    turns: Vec<bool>,
    /// Shortest edge on each body (m).
    edges: Vec<f64>,
    /// Body of each boundary.
    bodies: Vec<Option<usize>>,
    /// Sheet of each boundary.
    sheets: Vec<Option<WavingSheet>>,
    fresh: Fresh,
    surroundings: Surroundings,
    domain: Domain,
    surfaces: Surfaces,
}

impl Follower {
    /// Takes a new mesh, made with bodies of these shapes at these places.
    ///
    /// # Errors
    /// When the equation of the mesh motion cannot be solved, in words.
    pub fn new(
        case: &Case,
        problem: &Problem,
        mesh: &Mesh<2>,
        domain: Domain,
        shapes: Vec<PlacedShape>,
        made_at: Vec<Place>,
    ) -> Result<Self, String> {
        let moving = &case.mesh.moving;
        let kind = match moving.equation {
            MeshEquation::Elastic => MotionKind::default(),
            MeshEquation::Harmonic => MotionKind::Harmonic(Stiffening::MasudHughes),
        };
        let sheet = |boundary: &alewife_mesh::Boundary| waving_sheet(case, &boundary.name);
        let sheets: Vec<Option<WavingSheet>> = mesh.boundaries.iter().map(sheet).collect();
        let mut holds = holds(mesh, true);
        for (hold, sheet) in holds.iter_mut().zip(&sheets) {
            if sheet.is_some() {
                *hold = Hold::Given;
            }
        }
        let motion = MeshMotion::new(mesh, kind, &holds).map_err(|e| e.to_string())?;
        let surroundings = Surroundings::new(&domain, &shapes).map_err(|e| e.to_string())?;
        let limits = Limits { quality: moving.quality, layers: moving.layers };
        let fresh = Fresh::new(mesh, &surroundings, limits);
        let walls: Vec<usize> =
            (0..domain.sides().len()).filter(|&side| domain.wall(side).is_some()).collect();
        let surfaces = Surfaces::new(&domain, &walls, &shapes).map_err(|e| e.to_string())?;
        let bodies: Vec<Option<usize>> = mesh
            .boundaries
            .iter()
            .map(|boundary| match boundary.kind {
                BoundaryKind::Body(body) => Some(body),
                _ => None,
            })
            .collect();
        let mut edges = vec![f64::INFINITY; problem.bodies.len()];
        for facet in &mesh.facets {
            if let Some(body) = bodies[usize::from(facet.boundary)] {
                let [from, to, _] = mesh.facet_nodes(facet).map(|node| mesh.nodes[node as usize]);
                edges[body] = edges[body].min((to - from).norm());
            }
        }
        let turns = case.body.iter().map(|body| !problem.axisymmetric && !body.is_round());
        let turns = turns.collect();
        Ok(Self {
            motion,
            made_at,
            shapes,
            turns,
            edges,
            bodies,
            sheets,
            fresh,
            surroundings,
            domain,
            surfaces,
        })
    }

    /// How each body has carried its mesh from where that was made.
    fn moves(&self, places: &[Place]) -> Vec<RigidMove> {
        self.moves_between(&self.made_at, places)
    }

    /// How bodies carry their mesh from some places to others; round bodies do not turn it.
    pub fn moves_between(&self, from: &[Place], to: &[Place]) -> Vec<RigidMove> {
        let pairs = from.iter().zip(to).zip(&self.turns);
        pairs
            .map(|((from, to), turns)| {
                let angle = if *turns { to[2] } else { from[2] };
                RigidMove::between(&pose_at(from), &pose_at(&[to[0], to[1], angle]))
            })
            .collect()
    }

    /// Places of all nodes with bodies at `places` (m) at a time (s).
    ///
    /// # Errors
    /// When memory runs out.
    pub fn nodes(&self, places: &[Place], time: f64) -> Result<Vec<Point<2>>, MotionError> {
        let moves = self.moves(places);
        let given = |boundary: usize, place: &Point<2>| {
            match (self.bodies[boundary], &self.sheets[boundary]) {
                (Some(body), _) => moves[body].displacement(place),
                // Up and down: where the nodes are along the curve makes no difference.
                (None, Some(sheet)) => Point::<2>::new(0.0, sheet.height(place[0], time)),
                (None, None) => Point::<2>::zeros(),
            }
        };
        let moved = self.motion.displacements(&given)?;
        Ok(self.motion.reference().iter().zip(&moved).map(|(x, d)| x + d).collect())
    }

    /// Whether a side waves, so that the mesh is not at rest even where bodies are.
    #[must_use]
    pub fn waves(&self) -> bool {
        self.sheets.iter().any(Option::is_some)
    }

    /// A cell of a moved mesh on which no flow can be solved: its centre (m) and quality.
    #[must_use]
    pub fn spoilt(&self, mesh: &Mesh<2>) -> Option<(Point<2>, f64)> {
        let worst = mesh.worst_cell()?;
        (worst.quality <= HOPELESS * self.fresh.lowest()).then_some((worst.center, worst.quality))
    }

    /// Whether a body is so far from where the flow was solved that it has to be solved again.
    #[must_use]
    pub fn is_misplaced(&self, solved_at: &[Place], places: &[Place]) -> bool {
        let moves = solved_at.iter().zip(places).enumerate();
        moves.into_iter().any(|(body, (one, other))| {
            let turn = if self.turns[body] { (other[2] - one[2]).abs() } else { 0.0 };
            let way = (other[0] - one[0]).hypot(other[1] - one[1]);
            way + turn * self.surfaces.reach(body) > MISPLACED * self.edges[body]
        })
    }

    /// Whether the mesh has to be made anew with bodies at `places`, and why. The mesh is seen from
    /// the frame.
    #[must_use]
    pub fn wants_remesh(&mut self, mesh: &Mesh<2>, places: &[Place]) -> Option<Reason> {
        // A sheet comes back to where it was, and its mesh with it.
        if self.waves() {
            return None;
        }
        let shapes = self.shapes_at(places);
        for (body, shape) in shapes.iter().enumerate() {
            self.surroundings.place_body(body, shape.center, shape.angle);
        }
        needs_remesh(mesh, &self.fresh, &self.surroundings)
    }

    /// The bodies at other places.
    #[must_use]
    pub fn shapes_at(&self, places: &[Place]) -> Vec<PlacedShape> {
        let moves = self.moves(places);
        moves.iter().zip(&self.shapes).map(|(to, shape)| to.carry(shape)).collect()
    }

    /// Places of the nodes when the mesh was made (m).
    #[must_use]
    pub fn reference(&self) -> &[Point<2>] {
        self.motion.reference()
    }

    /// Places of the bodies in the mesh when it was made.
    #[must_use]
    pub fn made_at(&self) -> &[Place] {
        &self.made_at
    }

    /// The region of the mesh.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Outlines and walls.
    #[must_use]
    pub fn surfaces(&self) -> &Surfaces {
        &self.surfaces
    }
}
