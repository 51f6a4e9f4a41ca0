//! What holds the boundary of a moving mesh: bodies carry it, walls fix it or let it slide.

use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, NodeId, PeriodicPair, Point};
use thiserror::Error;

use crate::algebra::{AffineConstraints, CholeskyError, ConstraintBuilder};

/// Nodes of a straight side differ by no more than this, relative to the size of the mesh.
const STRAIGHT: f64 = 1e-12;

/// What the nodes of a boundary do when the mesh moves.
///
/// Where boundaries meet, each component of the displacement takes the first of these that says
/// something about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hold {
    /// They are carried: their displacement is given at every move.
    Given,
    /// They stay.
    Fixed,
    /// They stay on their straight line and slide along it.
    Sliding {
        /// The coordinate that stays: 0 for x, 1 for y.
        normal_axis: usize,
    },
    /// They go where the inside takes them. For periodic sides, whose pairs move equally.
    Free,
}

/// Why a mesh cannot be moved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MotionError {
    /// A side that is to slide is not a straight line x = const or y = const.
    #[error("boundary \"{boundary}\" cannot slide along itself: it is not straight")]
    NotStraight {
        /// Name of the boundary.
        boundary: String,
    },
    /// Not one hold for every boundary.
    #[error("{given} holds are given for a mesh with {wanted} boundaries")]
    HoldsMissing {
        /// Boundaries of the mesh.
        wanted: usize,
        /// Holds given.
        given: usize,
    },
    /// The matrix of the motion has no inverse, or memory ran out.
    #[error("the motion of the mesh: {0}")]
    Singular(#[from] CholeskyError),
}

/// The holds of a mesh whose bodies move: bodies are given, the axis slides, periodic sides are
/// free; other sides are fixed or, where straight and `slides` is set, slide.
#[must_use]
pub fn holds(mesh: &Mesh<2>, slides: bool) -> Vec<Hold> {
    let is_periodic = periodic_boundaries(mesh);
    let hold = |boundary: usize| match mesh.boundaries[boundary].kind {
        BoundaryKind::Body(_) => Hold::Given,
        BoundaryKind::Axis => Hold::Sliding { normal_axis: 1 },
        BoundaryKind::Side if is_periodic[boundary] => Hold::Free,
        BoundaryKind::Side => match straight_axis(mesh, boundary) {
            Some(normal_axis) if slides => Hold::Sliding { normal_axis },
            _ => Hold::Fixed,
        },
    };
    (0..mesh.boundaries.len()).map(hold).collect()
}

/// Whether an inner node of a facet of each boundary is in a periodic pair.
fn periodic_boundaries(mesh: &Mesh<2>) -> Vec<bool> {
    let mut is_paired = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        is_paired[pair.copy] = true;
        is_paired[pair.original] = true;
    }
    let mut is_periodic = vec![false; mesh.boundaries.len()];
    for facet in &mesh.facets {
        is_periodic[facet.boundary] |= mesh.facet_inner_nodes(facet).any(|node| is_paired[node]);
    }
    is_periodic
}

/// The coordinate all nodes of a boundary share, if there is one.
fn straight_axis(mesh: &Mesh<2>, boundary: usize) -> Option<usize> {
    (0..2).find(|&axis| is_straight(mesh, boundary, axis))
}

fn is_straight(mesh: &Mesh<2>, boundary: usize, axis: usize) -> bool {
    let size = mesh.nodes.iter().fold(0.0_f64, |most, node| most.max(node.amax()));
    let mut places = mesh
        .facets
        .iter()
        .filter(|facet| facet.boundary.index() == boundary)
        .flat_map(|facet| mesh.facet_nodes(facet))
        .map(|node| mesh.nodes[node][axis]);
    match places.next() {
        Some(first) => places.all(|place| (place - first).abs() <= STRAIGHT * size),
        None => false,
    }
}

/// What is said about each vertex, from the holds of the boundaries it lies on.
#[derive(Debug)]
pub(super) struct HeldVertices {
    /// Vertices that are carried, each with the boundary that carries it, sorted.
    pub given: Vec<(NodeId, BoundaryId)>,
    /// Whether x and y of each vertex are given or fixed.
    is_held: Vec<[bool; 2]>,
    /// Periodic pairs of vertices.
    periodic: Vec<PeriodicPair>,
}

impl HeldVertices {
    /// Collects the holds of all vertices.
    ///
    /// # Errors
    /// When there is not one hold a boundary, or a side that is to slide is not straight.
    pub fn new(mesh: &Mesh<2>, holds: &[Hold]) -> Result<Self, MotionError> {
        let wanted = mesh.boundaries.len();
        if holds.len() != wanted {
            return Err(MotionError::HoldsMissing { wanted, given: holds.len() });
        }
        for (boundary, hold) in holds.iter().enumerate() {
            let Hold::Sliding { normal_axis } = hold else { continue };
            let exists = mesh.facets.iter().any(|f| f.boundary.index() == boundary);
            if exists && !(*normal_axis < 2 && is_straight(mesh, boundary, *normal_axis)) {
                let boundary = mesh.boundaries[boundary].name.clone();
                return Err(MotionError::NotStraight { boundary });
            }
        }
        let mut given = Vec::new();
        let mut is_held = vec![[false; 2]; mesh.n_vertices];
        for facet in &mesh.facets {
            for vertex in mesh.facet_vertices(facet) {
                let held = &mut is_held[vertex];
                match holds[facet.boundary] {
                    Hold::Given => {
                        given.push((vertex, facet.boundary));
                        *held = [true; 2];
                    }
                    Hold::Fixed => *held = [true; 2],
                    Hold::Sliding { normal_axis } => held[normal_axis] = true,
                    Hold::Free => {}
                }
            }
        }
        given.sort_unstable();
        given.dedup_by_key(|(vertex, _)| *vertex);
        let is_vertex = |pair: &PeriodicPair| pair.copy.index() < mesh.n_vertices;
        let periodic: Vec<_> = mesh.periodic.iter().copied().filter(is_vertex).collect();
        // A corner held on one side of the domain is held on the other
        for &PeriodicPair { copy, original } in periodic.iter().chain(&periodic) {
            for axis in 0..2 {
                let held = is_held[copy][axis] || is_held[original][axis];
                is_held[copy][axis] = held;
                is_held[original][axis] = held;
            }
        }
        Ok(Self { given, is_held, periodic })
    }

    /// Whether x and y are held at the same vertices, so that one matrix serves both.
    pub fn holds_both_alike(&self) -> bool {
        self.is_held.iter().all(|held| held[0] == held[1])
    }

    /// Constraints on unknowns numbered vertex * axes.len() + position in `axes`.
    ///
    /// Held components are zero here, their values come with each move. Where nothing holds a
    /// component at all, the first vertex does, which fixes the mesh as a whole.
    pub fn constraints(&self, axes: &[usize]) -> AffineConstraints {
        let n = axes.len();
        let mut builder = ConstraintBuilder::new(self.is_held.len() * n);
        for (place, &axis) in axes.iter().enumerate() {
            let mut none_is_held = true;
            for (vertex, held) in self.is_held.iter().enumerate() {
                if held[axis] {
                    builder.constrain(vertex * n + place, vec![], 0.0);
                    none_is_held = false;
                }
            }
            for pair in &self.periodic {
                let [copy, original] =
                    [pair.copy, pair.original].map(|vertex| vertex.index() * n + place);
                if !builder.is_constrained(copy) {
                    builder.constrain(copy, vec![(original, 1.0)], 0.0);
                }
            }
            if none_is_held {
                let first = (0..self.is_held.len())
                    .map(|vertex| vertex * n + place)
                    .find(|&raw| !builder.is_constrained(raw));
                if let Some(raw) = first {
                    builder.constrain(raw, vec![], 0.0);
                }
            }
        }
        builder.build()
    }

    /// Displacements (m) of the vertices that are held: the given ones, zero elsewhere.
    pub fn displacements(
        &self,
        places: &[Point<2>],
        given: &dyn Fn(usize, &Point<2>) -> Point<2>,
    ) -> Vec<Point<2>> {
        let mut moved = vec![Point::<2>::zeros(); self.is_held.len()];
        for &(vertex, boundary) in &self.given {
            moved[vertex] = given(boundary.index(), &places[vertex]);
        }
        moved
    }
}
