//! Boundary conditions of the mesh motion: bodies prescribe it, walls fix the mesh or let it slide.

use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, NodeId, PeriodicPair, Point};
use thiserror::Error;

use crate::algebra::{AffineConstraints, ConstraintBuilder, EllipticError};
use crate::space::Metric;

/// Nodes of a flat boundary differ by no more than this, relative to the size of the mesh.
const FLATNESS: f64 = 1e-12;

/// What the nodes of a boundary do when the mesh moves.
///
/// Where boundaries meet, each component of the displacement takes the first of these that
/// constrains it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MeshBoundaryCondition {
    /// Their displacement is given at every move.
    Prescribed,
    /// They stay.
    Fixed,
    /// They slide in their line (plane in space), on which one coordinate is constant.
    Sliding {
        /// The coordinate that stays: 0 for x, 1 for y, 2 for z.
        normal_axis: usize,
    },
    /// They move as the equation wants. For periodic sides, whose pairs move equally.
    Free,
}

/// Displacement (m) of a node on a boundary whose displacement is prescribed: `(boundary, node,
/// reference)`, with the node's position in the reference configuration (m).
pub type PrescribedDisplacement<'a, const D: usize> =
    dyn Fn(BoundaryId, NodeId, &Point<D>) -> Point<D> + 'a;

/// Why a mesh cannot be moved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MotionError {
    /// A boundary that is to slide has no constant coordinate, or not the one it should have.
    #[error(
        "boundary \"{boundary}\" cannot slide along itself: none of its coordinates is constant"
    )]
    NotAxisAligned {
        /// Name of the boundary.
        boundary: String,
    },
    /// Not one condition for every boundary.
    #[error("{found} boundary conditions are given for a mesh with {expected} boundaries")]
    ConditionCount {
        /// Boundaries of the mesh.
        expected: usize,
        /// Conditions given.
        found: usize,
    },
    /// The equation of the motion is not solved.
    #[error("the motion of the mesh: {0}")]
    Equation(#[from] EllipticError),
}

/// The conditions of a mesh whose bodies move: that of bodies is prescribed, the axis slides,
/// periodic sides are free; other sides are fixed or, where flat and `slides` is set, slide.
#[must_use]
pub fn mesh_boundary_conditions<const D: usize>(
    mesh: &Mesh<D>,
    slides: bool,
) -> Vec<MeshBoundaryCondition> {
    let is_periodic = periodic_boundaries(mesh);
    let condition = |boundary: BoundaryId| match mesh.boundaries[boundary].kind {
        BoundaryKind::Body(_) => MeshBoundaryCondition::Prescribed,
        BoundaryKind::Axis => MeshBoundaryCondition::Sliding { normal_axis: Metric::RADIAL },
        BoundaryKind::Side if is_periodic[boundary] => MeshBoundaryCondition::Free,
        BoundaryKind::Side => match normal_axis(mesh, boundary) {
            Some(normal_axis) if slides => MeshBoundaryCondition::Sliding { normal_axis },
            _ => MeshBoundaryCondition::Fixed,
        },
    };
    (0..mesh.boundaries.len()).map(BoundaryId::new).map(condition).collect()
}

/// Whether each boundary has a facet whose inner nodes are all in periodic pairs: those of a wall
/// are so at most where it meets a periodic side.
fn periodic_boundaries<const D: usize>(mesh: &Mesh<D>) -> Vec<bool> {
    let mut is_paired = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        is_paired[pair.copy] = true;
        is_paired[pair.original] = true;
    }
    let mut is_periodic = vec![false; mesh.boundaries.len()];
    for facet in &mesh.facets {
        is_periodic[facet.boundary] |= mesh.facet_inner_nodes(facet).all(|node| is_paired[node]);
    }
    is_periodic
}

/// The coordinate all nodes of a boundary share, if there is one.
fn normal_axis<const D: usize>(mesh: &Mesh<D>, boundary: BoundaryId) -> Option<usize> {
    (0..D).find(|&axis| is_constant(mesh, boundary, axis))
}

/// Whether the nodes of a boundary, of which there are some, share a coordinate.
fn is_constant<const D: usize>(mesh: &Mesh<D>, boundary: BoundaryId, axis: usize) -> bool {
    let size = mesh.nodes.iter().fold(0.0_f64, |most, node| most.max(node.amax()));
    let mut coordinates = mesh
        .facets
        .iter()
        .filter(|facet| facet.boundary == boundary)
        .flat_map(|facet| mesh.facet_nodes(facet))
        .map(|node| mesh.nodes[node][axis]);
    match coordinates.next() {
        Some(first) => coordinates.all(|x| (x - first).abs() <= FLATNESS * size),
        None => false,
    }
}

/// Which components of the displacement of each vertex are known, from the conditions of the
/// boundaries it lies on.
#[derive(Debug)]
pub(super) struct ConstrainedVertices<const D: usize> {
    /// Vertices with a prescribed displacement and the boundary that prescribes it, sorted.
    pub prescribed: Vec<(NodeId, BoundaryId)>,
    /// Whether each component of the displacement of each vertex is prescribed or zero.
    is_constrained: Vec<[bool; D]>,
    /// Periodic pairs of vertices.
    periodic: Vec<PeriodicPair>,
    /// Those of them whose original has a prescribed displacement and the copy has none of its own.
    carried: Vec<PeriodicPair>,
}

impl<const D: usize> ConstrainedVertices<D> {
    /// Collects the conditions of all vertices.
    ///
    /// # Errors
    /// When there is not one condition for each boundary, or a boundary that is to slide cannot.
    pub fn new(mesh: &Mesh<D>, conditions: &[MeshBoundaryCondition]) -> Result<Self, MotionError> {
        check_conditions(mesh, conditions)?;
        let mut prescribed = Vec::new();
        let mut is_constrained = vec![[false; D]; mesh.n_vertices];
        for facet in &mesh.facets {
            for vertex in mesh.facet_vertices(facet) {
                let components = &mut is_constrained[vertex];
                match conditions[facet.boundary] {
                    MeshBoundaryCondition::Prescribed => {
                        prescribed.push((vertex, facet.boundary));
                        *components = [true; D];
                    }
                    MeshBoundaryCondition::Fixed => *components = [true; D],
                    MeshBoundaryCondition::Sliding { normal_axis } => {
                        components[normal_axis] = true;
                    }
                    MeshBoundaryCondition::Free => {}
                }
            }
        }
        prescribed.sort_unstable();
        prescribed.dedup_by_key(|(vertex, _)| *vertex);
        let is_vertex = |pair: &PeriodicPair| pair.copy.index() < mesh.n_vertices;
        let periodic: Vec<_> = mesh.periodic.iter().copied().filter(is_vertex).collect();
        // A corner constrained on one side of the domain is constrained on the others
        for &PeriodicPair { copy, original } in periodic.iter().chain(&periodic) {
            for axis in 0..D {
                let either = is_constrained[copy][axis] || is_constrained[original][axis];
                is_constrained[copy][axis] = either;
                is_constrained[original][axis] = either;
            }
        }
        let is_prescribed =
            |vertex: NodeId| prescribed.binary_search_by_key(&vertex, |(known, _)| *known).is_ok();
        let carried = periodic.iter().copied();
        let carried = carried
            .filter(|pair| is_prescribed(pair.original) && !is_prescribed(pair.copy))
            .collect();
        Ok(Self { prescribed, is_constrained, periodic, carried })
    }

    /// Components that are constrained at the same vertices, so that one matrix serves them all.
    pub fn equal_components(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for axis in 0..D {
            let is_equal =
                |other: usize| self.is_constrained.iter().all(|held| held[axis] == held[other]);
            match groups.iter_mut().find(|group| is_equal(group[0])) {
                Some(group) => group.push(axis),
                None => groups.push(vec![axis]),
            }
        }
        groups
    }

    /// Constraints on unknowns numbered vertex * axes.len() + position in `axes`.
    ///
    /// Known components are zero here, their values come with each move. Where a component is
    /// constrained nowhere, it is at one vertex, which fixes the mesh as a whole.
    pub fn constraints(&self, axes: &[usize]) -> AffineConstraints {
        let n = axes.len();
        let mut builder = ConstraintBuilder::new(self.is_constrained.len() * n);
        for (position, &axis) in axes.iter().enumerate() {
            let mut none_is_constrained = true;
            for (vertex, components) in self.is_constrained.iter().enumerate() {
                if components[axis] {
                    builder.fix(vertex * n + position, 0.0);
                    none_is_constrained = false;
                }
            }
            for pair in &self.periodic {
                let [copy, original] =
                    [pair.copy, pair.original].map(|vertex| vertex.index() * n + position);
                if !builder.is_constrained(copy) {
                    builder.equate(copy, original);
                }
            }
            if none_is_constrained {
                let first = (0..self.is_constrained.len())
                    .map(|vertex| vertex * n + position)
                    .find(|&raw| !builder.is_constrained(raw));
                if let Some(raw) = first {
                    builder.fix(raw, 0.0);
                }
            }
        }
        builder.build()
    }

    /// Displacements (m) of the vertices where they are known: the prescribed ones, zero elsewhere.
    pub fn displacements(
        &self,
        reference: &[Point<D>],
        prescribed: &PrescribedDisplacement<'_, D>,
    ) -> Vec<Point<D>> {
        let mut displacements = vec![Point::zeros(); self.is_constrained.len()];
        for &(vertex, boundary) in &self.prescribed {
            displacements[vertex] = prescribed(boundary, vertex, &reference[vertex]);
        }
        for PeriodicPair { copy, original } in &self.carried {
            displacements[*copy] = displacements[*original];
        }
        displacements
    }
}

/// Whether there is one condition for each boundary, and those that are to slide can.
fn check_conditions<const D: usize>(
    mesh: &Mesh<D>,
    conditions: &[MeshBoundaryCondition],
) -> Result<(), MotionError> {
    let expected = mesh.boundaries.len();
    if conditions.len() != expected {
        return Err(MotionError::ConditionCount { expected, found: conditions.len() });
    }
    for (boundary, condition) in conditions.iter().enumerate() {
        let MeshBoundaryCondition::Sliding { normal_axis } = *condition else { continue };
        let boundary = BoundaryId::new(boundary);
        let exists = mesh.facets.iter().any(|facet| facet.boundary == boundary);
        if exists && !(normal_axis < D && is_constant(mesh, boundary, normal_axis)) {
            let boundary = mesh.boundaries[boundary].name.clone();
            return Err(MotionError::NotAxisAligned { boundary });
        }
    }
    Ok(())
}
