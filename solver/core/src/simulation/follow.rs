//! `Follower`: the mesh that follows its bodies until it has to be made anew.

use std::borrow::Cow;
use std::collections::HashMap;

use alewife_mesh::{
    BoundaryId, BoundaryKind, Domain, Mesh, NodeId, Outline, PlacedShape, Point, Shape,
    Surroundings,
};
use nalgebra::Vector3;

use super::build::waving_sheet;
use super::state::{Place, pose_at};
use crate::body::Pose;
use crate::case::{MeshEquation, Model};
use crate::contact::{Gaps, PlanarGaps};
use crate::coupling::{BodyShapes, Problem, RigidBody};
use crate::gait::{DeformedOutline, WavingSheet};
use crate::motion::{
    Fresh, Limits, MeshBoundaryCondition, MeshMotion, MotionError, MotionKind, Reason, RigidMove,
    Stiffening, mesh_boundary_conditions, needs_remesh,
};

/// Part of an edge by which a body may be elsewhere than where the flow was solved.
const MISPLACED: f64 = 1e-3;
/// Quality of a cell over its quality when new below which no flow is solved on it.
const HOPELESS: f64 = 0.02;

/// A mesh with all that moves it, from one making to the next. Places are seen from the frame.
#[derive(Debug)]
pub struct Follower {
    motion: MeshMotion<2>,
    /// Places of the bodies in the mesh when it was made.
    made_at: Vec<Place>,
    /// When it was made (s).
    made_time: f64,
    /// Bodies as they were then.
    shapes: Vec<PlacedShape>,
    /// Material points of the nodes on bodies that deform.
    materials: HashMap<NodeId, f64>,
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
    surfaces: PlanarGaps,
}

/// A body of this shape at a place.
fn placed(shape: &PlacedShape, deformed: Shape, place: &Place) -> PlacedShape {
    PlacedShape {
        shape: deformed,
        center: Point::<2>::new(place[0], place[1]),
        angle: place[2],
        ..shape.clone()
    }
}

impl Follower {
    /// Takes a new mesh, made with bodies of these shapes, as they are deformed then, at these places
    /// at a time (s).
    ///
    /// # Errors
    /// When the equation of the mesh motion cannot be solved, in words.
    pub fn new(
        model: &Model,
        problem: &Problem,
        mesh: &Mesh<2>,
        domain: Domain,
        shapes: Vec<PlacedShape>,
        (made_at, made_time): (Vec<Place>, f64),
    ) -> Result<Self, String> {
        let moving = &model.case.mesh.moving;
        let kind = match moving.equation {
            MeshEquation::Elastic => MotionKind::default(),
            MeshEquation::Harmonic => MotionKind::Harmonic(Stiffening::MasudHughes),
        };
        let sheet = |boundary: &alewife_mesh::Boundary| waving_sheet(&model.case, &boundary.name);
        let sheets: Vec<Option<WavingSheet>> = mesh.boundaries.iter().map(sheet).collect();
        let mut conditions = mesh_boundary_conditions(mesh, true);
        for (condition, sheet) in conditions.iter_mut().zip(&sheets) {
            if sheet.is_some() {
                *condition = MeshBoundaryCondition::Prescribed;
            }
        }
        let motion = MeshMotion::new(mesh, kind, &conditions).map_err(|e| e.to_string())?;
        let surroundings = Surroundings::new(&domain, &shapes).map_err(|e| e.to_string())?;
        let limits = Limits { quality: moving.quality, layers: moving.layers };
        let fresh = Fresh::new(mesh, &surroundings, limits);
        let walls: Vec<usize> =
            (0..domain.sides().len()).filter(|&side| domain.wall(side).is_some()).collect();
        let pivots = problem.bodies.iter().enumerate().filter_map(|(child, body)| {
            body.link.as_ref().filter(|link| link.arm.is_none()).map(|link| [link.parent, child])
        });
        let surfaces = PlanarGaps::new(&domain, &walls, &shapes)
            .map_err(|e| e.to_string())?
            .with_joined(pivots);
        let bodies: Vec<Option<usize>> = mesh
            .boundaries
            .iter()
            .map(|boundary| match boundary.kind {
                BoundaryKind::Body(body) => Some(body),
                _ => None,
            })
            .collect();
        let outline = |(body, rigid): (usize, &RigidBody)| {
            let deforms = rigid.shape.is_some();
            let then = placed(&shapes[body], shapes[body].shape.clone(), &made_at[body]);
            deforms.then(|| Outline::new(&then)).transpose()
        };
        let outlines: Result<Vec<_>, _> = problem.bodies.iter().enumerate().map(outline).collect();
        let outlines = outlines.map_err(|error| error.to_string())?;
        let mut edges = vec![f64::INFINITY; problem.bodies.len()];
        let mut materials = HashMap::new();
        for facet in &mesh.facets {
            if let Some(body) = bodies[facet.boundary] {
                let [start, end] = mesh.facet_vertices(facet).map(|vertex| mesh.nodes[vertex]);
                edges[body] = edges[body].min((end - start).norm());
                if let Some(outline) = &outlines[body] {
                    for node in mesh.facet_nodes(facet) {
                        let parameter = || outline.parameter_of(mesh.nodes[node]);
                        materials.entry(node).or_insert_with(parameter);
                    }
                }
            }
        }
        let turns =
            model.bodies.iter().map(|body| problem.metric.has_rotation() && !body.is_round());
        let turns = turns.collect();
        Ok(Self {
            motion,
            made_at,
            made_time,
            shapes,
            materials,
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

    /// How each body has carried its mesh from where that was made to places, with these shapes.
    fn carriers<'a>(&self, places: &[Place], shapes: &'a BodyShapes) -> Vec<Carrier<'a>> {
        (0..places.len())
            .map(|body| {
                let [x, y, angle] = places[body];
                let angle = if self.turns[body] { angle } else { self.made_at[body][2] };
                let to = pose_at(&[x, y, angle]);
                match shapes.deformed(body) {
                    Some(deformed) => Carrier::Deformed(deformed, to),
                    None => Carrier::Rigid(RigidMove::between(&pose_at(&self.made_at[body]), &to)),
                }
            })
            .collect()
    }

    /// Displacement of a node on a body from its place when the mesh was made (m).
    fn displacement(&self, carrier: &Carrier<'_>, node: NodeId, place: &Point<2>) -> Point<2> {
        match carrier {
            Carrier::Rigid(moved) => moved.displacement(place),
            Carrier::Deformed(deformed, pose) => {
                let parameter = self.materials.get(&node);
                let parameter = parameter.expect("every node of a facet on the body has one");
                let at = deformed.position(*parameter);
                let world = pose.rotation() * Vector3::new(at.x, at.y, 0.0) + pose.center;
                world.xy() - place
            }
        }
    }

    /// Places of all nodes with bodies of these shapes at `places` (m), at the time of the shapes.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn nodes(
        &self,
        places: &[Place],
        shapes: &BodyShapes,
    ) -> Result<Vec<Point<2>>, MotionError> {
        let carriers = self.carriers(places, shapes);
        let prescribed = |boundary: BoundaryId, node: NodeId, place: &Point<2>| {
            match (self.bodies[boundary], &self.sheets[boundary]) {
                (Some(body), _) => self.displacement(&carriers[body], node, place),
                // Up and down: where the nodes are along the curve makes no difference.
                (None, Some(sheet)) => Point::<2>::new(0.0, sheet.height(place[0], shapes.time())),
                (None, None) => Point::<2>::zeros(),
            }
        };
        let moved = self.motion.displacements(&prescribed)?;
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

    /// Whether the mesh has to be made anew with bodies of these shapes at `places`, and why. The mesh
    /// is seen from the frame.
    #[must_use]
    pub fn wants_remesh(
        &mut self,
        mesh: &Mesh<2>,
        places: &[Place],
        shapes: &BodyShapes,
    ) -> Option<Reason> {
        // A sheet comes back to where it was, and its mesh with it.
        if self.waves() {
            return None;
        }
        let placed = self.shapes_at(places, shapes);
        for (body, PlacedShape { center, angle, .. }) in placed.into_iter().enumerate() {
            match shapes.outline(body) {
                None => self.surroundings.place_body(body, center, angle),
                Some(outline) => {
                    self.surroundings.set_body(body, outline.placed_at(center, angle));
                }
            }
        }
        needs_remesh(mesh, &self.fresh, &self.surroundings)
    }

    /// The bodies at other places, with these shapes.
    #[must_use]
    pub fn shapes_at(&self, places: &[Place], shapes: &BodyShapes) -> Vec<PlacedShape> {
        let carriers = self.carriers(places, shapes);
        let carried = carriers.into_iter().zip(&self.shapes).zip(places);
        carried
            .map(|((carrier, shape), place)| match carrier {
                Carrier::Rigid(moved) => moved.carry(shape),
                Carrier::Deformed(deformed, _) => placed(shape, deformed.shape(), place),
            })
            .collect()
    }

    /// Outlines, as bodies of these shapes have them, and walls.
    #[must_use]
    pub fn surfaces_at(&self, shapes: &BodyShapes) -> Cow<'_, PlanarGaps> {
        let mut surfaces = Cow::Borrowed(&self.surfaces);
        for body in 0..self.shapes.len() {
            if let Some(outline) = shapes.outline(body) {
                surfaces.to_mut().deform(body, outline.clone());
            }
        }
        surfaces
    }

    /// When the mesh was made (s).
    #[must_use]
    pub fn made_time(&self) -> f64 {
        self.made_time
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

    /// Outlines and walls when the mesh was made.
    #[must_use]
    pub fn surfaces(&self) -> &PlanarGaps {
        &self.surfaces
    }
}

/// How a body carries the nodes on it.
enum Carrier<'a> {
    Rigid(RigidMove),
    /// Its outline then, and its pose.
    Deformed(&'a DeformedOutline, Pose),
}
