//! `MovingMesh`: the mesh that follows its bodies until it is replaced (the ALE map).

use std::ops::Deref;

use alewife_mesh::{BoundaryId, BoundaryKind, CellQuality, Mesh, NodeId, Point};
use nalgebra::{DVector, Vector3};

use super::boundary_condition::{MeshBoundaryCondition, MotionError, mesh_boundary_conditions};
use super::elliptic::MeshMotion;
use super::rigid::RigidMove;
use super::rolling::Rolling;
use super::scene::{Meshed, MostCells, PosesByShift, RemeshError, RestPlace, Scene};
use super::stiffness::MotionKind;
use crate::body::{MeshPoses, Pose, RigidVector, in_space, on_mesh};
use crate::contact::Gaps;
use crate::coupling::{BodyShapes, RestPlaces, RigidBody, coordinate_ranges};
use crate::state::State;

/// Quality of a cell over the lowest one of the reference mesh below which no flow is solved on it.
pub const DEGENERATE: f64 = 0.02;

/// A mesh with all that moves it, from one remeshing to the next. Positions are seen from the frame.
#[derive(Debug)]
pub struct MovingMesh<const D: usize> {
    motion: MeshMotion<D>,
    /// Poses of the bodies in the reference mesh.
    reference_poses: MeshPoses,
    /// Coordinates of the bodies in it that have some.
    reference_coordinates: Vec<f64>,
    /// Time of the reference mesh (s).
    reference_time: f64,
    settings: MotionSettings,
    rolling: Rolling,
    /// Shortest edge on each body (m).
    edges: Vec<f64>,
    /// Body of each boundary.
    bodies: Vec<Option<usize>>,
    scene: Box<dyn Scene<D>>,
}

/// How meshes move.
#[derive(Debug, Clone)]
pub struct MotionSettings {
    /// The equation of mesh motion.
    pub kind: MotionKind,
    /// Whether the mesh turns with each body.
    pub turns: Vec<bool>,
}

/// The gaps between bodies and walls at one time.
pub enum GapsAt<'a> {
    /// Those of the reference mesh.
    Reference(&'a dyn Gaps),
    /// Those of bodies that have deformed since.
    Deformed(Box<dyn Gaps>),
}

impl<'a> Deref for GapsAt<'a> {
    type Target = dyn Gaps + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Reference(gaps) => *gaps,
            Self::Deformed(gaps) => gaps.as_ref(),
        }
    }
}

/// How a body carries the nodes on it.
enum SurfaceMap {
    Rigid(RigidMove),
    /// With its own shape, to a pose.
    Deformed(Pose),
}

impl<const D: usize> MovingMesh<D> {
    /// Takes a mesh made for bodies at poses at a time (s) as the reference.
    ///
    /// # Errors
    /// When the equation of the mesh motion cannot be solved.
    pub fn new(
        mesh: &Mesh<D>,
        scene: Box<dyn Scene<D>>,
        settings: MotionSettings,
        reference_poses: MeshPoses,
        reference_time: f64,
    ) -> Result<Self, MotionError> {
        let mut conditions = mesh_boundary_conditions(mesh, true);
        for (boundary, condition) in conditions.iter_mut().enumerate() {
            let origin = Point::<D>::zeros();
            let boundary = BoundaryId::new(boundary);
            if scene.side_displacement(boundary, &origin, reference_time).is_some() {
                *condition = MeshBoundaryCondition::Prescribed;
            }
        }
        let bodies: Vec<Option<usize>> = mesh
            .boundaries
            .iter()
            .map(|boundary| match boundary.kind {
                BoundaryKind::Body(body) => Some(body),
                BoundaryKind::Side | BoundaryKind::Axis => None,
            })
            .collect();
        let mut edges = vec![f64::INFINITY; reference_poses.len()];
        for facet in &mesh.facets {
            if let Some(body) = bodies[facet.boundary] {
                let vertices = mesh.facet_vertices(facet);
                for (end, to) in vertices.iter().enumerate() {
                    for from in &vertices[..end] {
                        let length = (mesh.nodes[*to] - mesh.nodes[*from]).norm();
                        edges[body] = edges[body].min(length);
                    }
                }
            }
        }
        let motion = MeshMotion::new(mesh, settings.kind, &conditions)?;
        let rolls: Vec<bool> = settings.turns.iter().map(|turns| !turns).collect();
        let rolling = Rolling::new(scene.gaps(), &reference_poses, &rolls);
        Ok(Self {
            motion,
            reference_poses,
            reference_coordinates: Vec::new(),
            reference_time,
            settings,
            rolling,
            edges,
            bodies,
            scene,
        })
    }

    /// The same with coordinates of bodies in the reference mesh.
    #[must_use]
    pub fn with_coordinates(self, coordinates: Vec<f64>) -> Self {
        Self { reference_coordinates: coordinates, ..self }
    }

    /// How each body has carried its nodes from the reference mesh to these poses.
    fn surface_maps(&self, poses: &MeshPoses, shapes: &BodyShapes) -> Vec<SurfaceMap> {
        let moved = poses.iter().zip(self.reference_poses.iter());
        let displacements: Vec<RigidVector> =
            moved.map(|(pose, reference)| pose.displacement_from(reference)).collect();
        let turns = self.rolling.turns(&displacements);
        let map = |(body, pose): (usize, &Pose)| {
            let reference = &self.reference_poses[body];
            let orientation = match &turns[body] {
                Some(turn) => reference.displaced(turn).orientation,
                None if self.settings.turns[body] => pose.orientation,
                None => reference.orientation,
            };
            let to = Pose { orientation, ..*pose };
            match shapes.deformed(body) {
                Some(_) => SurfaceMap::Deformed(to),
                None => SurfaceMap::Rigid(RigidMove::between(reference, &to)),
            }
        };
        poses.iter().enumerate().map(map).collect()
    }

    /// Positions of all nodes (m) with bodies of these shapes at poses, at the time of the shapes.
    ///
    /// # Errors
    /// When memory runs out, or a node on a body has no material point.
    pub fn nodes(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Result<Vec<Point<D>>, MotionError> {
        let maps = self.surface_maps(poses, shapes);
        let given = |boundary: BoundaryId, node: NodeId, reference: &Point<D>| {
            let Some(body) = self.bodies[boundary] else {
                let moved = self.scene.side_displacement(boundary, reference, shapes.time());
                return moved.unwrap_or_else(Point::<D>::zeros);
            };
            match &maps[body] {
                SurfaceMap::Rigid(moved) => moved.displacement(reference),
                SurfaceMap::Deformed(pose) => {
                    let at = self.scene.material_position(node, body, shapes);
                    let at = at.expect("every node of a facet on a body has a material point");
                    on_mesh(&(pose.rotation() * at + pose.center - in_space(reference)))
                }
            }
        };
        let moved = self.motion.displacements(&given)?;
        Ok(self.motion.reference().iter().zip(&moved).map(|(x, d)| x + d).collect())
    }

    /// A cell of a moved mesh on which no flow can be solved.
    #[must_use]
    pub fn degenerate_cell(&self, mesh: &Mesh<D>) -> Option<CellQuality<D>> {
        let lowest = DEGENERATE * self.scene.lowest_quality();
        mesh.worst_cell().filter(|worst| worst.quality <= lowest)
    }

    /// How far a body is at most from where the flow was solved, over the shortest edge on it.
    #[must_use]
    pub fn misplacement(&self, solved_at: &[Pose], poses: &[Pose]) -> f64 {
        let pairs = solved_at.iter().zip(poses).enumerate();
        let of_body = |(body, (solved, pose)): (usize, (&Pose, &Pose))| {
            let off = pose.displacement_from(solved);
            let [way, turn] = [0, 3].map(|first| off.fixed_rows::<3>(first).norm());
            let turn = if self.settings.turns[body] { turn } else { 0.0 };
            (way + turn * self.gaps().reach(body)) / self.edges[body]
        };
        pairs.map(of_body).fold(0.0, f64::max)
    }

    /// The same of where nodes are on bodies with coordinates, between two shapes of these.
    #[must_use]
    pub fn misshape(&self, shapes: [&BodyShapes; 2]) -> f64 {
        let of_node = |RestPlace { node, body, .. }: &RestPlace| {
            let places = shapes.map(|shapes| self.scene.material_position(*node, *body, shapes));
            let [Some(one), Some(other)] = places else { return 0.0 };
            (one - other).norm() / self.edges[*body]
        };
        self.scene.rest_places(shapes[0]).iter().map(of_node).fold(0.0, f64::max)
    }

    /// How far nodes on bodies with coordinates get at most between two sets of these of all bodies (m), by body; `shapes` are
    /// any of them.
    #[must_use]
    pub fn ways_of_surfaces(
        &self,
        bodies: &[RigidBody],
        shapes: &BodyShapes,
        coordinates: [&[f64]; 2],
    ) -> Vec<f64> {
        let ranges = coordinate_ranges(bodies);
        let mut ways = vec![0.0f64; bodies.len()];
        for RestPlace { body, place, .. } in self.scene.rest_places(shapes) {
            let Some(flexible) = bodies[body].flexible() else { continue };
            let [from, to] = coordinates.map(|all| {
                let own = DVector::from_column_slice(&all[ranges[body].clone()]);
                flexible.place(&own, &place)
            });
            ways[body] = ways[body].max((to - from).norm());
        }
        ways
    }

    /// The largest speed (m/s) of a node on a body by rates of the coordinates of all bodies, which have these.
    #[must_use]
    pub fn fastest(&self, bodies: &[RigidBody], coordinates: &[f64], rates: &[f64]) -> f64 {
        let Ok(shapes) = BodyShapes::with(bodies, self.reference_time, coordinates) else {
            return 0.0;
        };
        let own = coordinate_ranges(bodies);
        let speed = |RestPlace { body, place, .. }: &RestPlace| {
            let weights = shapes.deformed(*body).map(|deformed| deformed.weights(place));
            let first = own[*body].start;
            let velocity: Vector3<f64> = weights
                .unwrap_or_default()
                .iter()
                .map(|at| at.weight * rates[first + at.coordinate])
                .sum();
            velocity.norm()
        };
        self.scene.rest_places(&shapes).iter().map(speed).fold(0.0, f64::max)
    }

    /// Where nodes on bodies with coordinates are at rest (m).
    #[must_use]
    pub fn rest_places(&self, shapes: &BodyShapes) -> RestPlaces {
        let places = self.scene.rest_places(shapes).into_iter();
        places.map(|RestPlace { node, place, .. }| (node, place)).collect()
    }

    /// Whether the mesh of a state has to be replaced, and why.
    #[must_use]
    pub fn remesh_reason(&mut self, state: &State<D>, shapes: &BodyShapes) -> Option<String> {
        // A moving wall comes back to where it was, and its mesh with it
        if self.scene.has_moving_wall() {
            return None;
        }
        let poses = state.in_frame(&state.origin, &state.poses);
        self.reason_to_replace(&state.mesh_in_frame(), &poses, shapes)
    }

    /// Whether this mesh has to be replaced where it has moved to with bodies of these shapes at poses, all seen from
    /// the frame, and why.
    #[must_use]
    pub fn reason_to_replace(
        &mut self,
        mesh: &Mesh<D>,
        poses: &MeshPoses,
        shapes: &BodyShapes,
    ) -> Option<String> {
        self.scene.remesh_reason(mesh, poses, shapes)
    }

    /// Generates a mesh with bodies of these shapes at poses seen from the frame.
    ///
    /// # Errors
    /// When it cannot be generated, or would have more cells than it may have.
    pub fn remesh(
        &self,
        poses: &MeshPoses,
        shapes: &BodyShapes,
        shifted: PosesByShift<'_>,
        most: MostCells,
    ) -> Result<Meshed<D>, RemeshError> {
        if self.scene.has_moving_wall() {
            return Err(RemeshError::MovingWall);
        }
        self.scene.remesh(poses, shapes, shifted, most)
    }

    /// The same kind of motion for another mesh, made for bodies at poses at a time (s).
    ///
    /// # Errors
    /// When the equation of the mesh motion cannot be solved.
    pub fn succeeded_by(
        &self,
        mesh: &Mesh<D>,
        scene: Box<dyn Scene<D>>,
        poses: MeshPoses,
        time: f64,
    ) -> Result<Self, MotionError> {
        Self::new(mesh, scene, self.settings.clone(), poses, time)
    }

    /// Gaps between bodies of these shapes, and walls.
    #[must_use]
    pub fn gaps_at(&self, shapes: &BodyShapes) -> GapsAt<'_> {
        match self.scene.deformed_gaps(shapes) {
            Some(gaps) => GapsAt::Deformed(gaps),
            None => GapsAt::Reference(self.scene.gaps()),
        }
    }

    /// Gaps between bodies in the shapes of the reference mesh, and walls.
    #[must_use]
    pub fn gaps(&self) -> &dyn Gaps {
        self.scene.gaps()
    }

    /// Domain and bodies of the reference mesh.
    #[must_use]
    pub fn scene(&self) -> &dyn Scene<D> {
        self.scene.as_ref()
    }

    /// Time of the reference mesh (s).
    #[must_use]
    pub fn reference_time(&self) -> f64 {
        self.reference_time
    }

    /// Positions of the nodes of the reference mesh (m).
    #[must_use]
    pub fn reference(&self) -> &[Point<D>] {
        self.motion.reference()
    }

    /// Coordinates of the bodies in the reference mesh that have some.
    #[must_use]
    pub fn reference_coordinates(&self) -> &[f64] {
        &self.reference_coordinates
    }

    /// Poses of the bodies in the reference mesh.
    #[must_use]
    pub fn reference_poses(&self) -> &MeshPoses {
        &self.reference_poses
    }
}
