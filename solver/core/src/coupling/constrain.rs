//! From boundary conditions and bodies to constraints on the raw unknowns.
//!
//! A node on a body: u = U + omega x (x - G) + slip, with U and omega raw unknowns themselves.
//! Where boundaries meet, bodies come first, then walls, then inflows, then symmetry planes.

use alewife_mesh::{BoundaryId, BoundaryKind, Facet, Mesh, NodeId, PeriodicPair};

use super::link::RigidRow;
use super::problem::{Drive, Problem};
use super::shapes::{BodyShapes, MovingSurface};
use crate::algebra::{AffineConstraints, ConstraintBuilder};
use crate::body::Pose;
use crate::space::DofLayout;

/// The boundaries each node lies on.
#[derive(Debug, Clone)]
pub struct NodeSides {
    /// Sorted, each pair once.
    pairs: Vec<(NodeId, BoundaryId)>,
}

impl NodeSides {
    /// Collects the nodes of all boundary facets.
    #[must_use]
    pub fn new(mesh: &Mesh<2>) -> Self {
        let mut pairs = Vec::with_capacity(3 * mesh.facets.len());
        for facet in &mesh.facets {
            pairs.extend(mesh.facet_nodes(facet).map(|node| (node, facet.boundary)));
        }
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs }
    }

    /// Nodes with the boundaries they lie on.
    pub fn iter(&self) -> impl Iterator<Item = (NodeId, Vec<usize>)> + '_ {
        self.pairs.chunk_by(|one, other| one.0 == other.0).map(|pairs| {
            let boundaries = pairs.iter().map(|&(_, boundary)| boundary.index()).collect();
            (pairs[0].0, boundaries)
        })
    }

    /// Nodes on one boundary.
    pub fn nodes_on(&self, boundary: usize) -> impl Iterator<Item = NodeId> + '_ {
        self.pairs
            .iter()
            .filter(move |&&(_, other)| other.index() == boundary)
            .map(|&(node, _)| node)
    }
}

/// The constraints at the time of `shapes`, for bodies at these poses.
#[must_use]
pub(super) fn constrain(
    problem: &Problem,
    mesh: &Mesh<2>,
    layout: &DofLayout<2>,
    sides: &NodeSides,
    poses: &[Pose],
    shapes: &BodyShapes,
) -> AffineConstraints {
    let time = shapes.time();
    let mut builder = ConstraintBuilder::new(layout.n_raw());
    let rows = problem.has_links().then(|| {
        let places: Vec<[f64; 3]> =
            poses.iter().map(|pose| [pose.center.x, pose.center.y, pose.heading()]).collect();
        problem.rigid_rows(&places, time)
    });
    for (body, rigid) in problem.bodies.iter().enumerate() {
        for (mode, drive) in rigid.drives.iter().enumerate() {
            match (drive, &rows) {
                (Drive::Given(value), _) => {
                    builder.constrain(layout.rigid(body, mode), vec![], value(time));
                }
                (Drive::Linked, Some(rows)) => {
                    let RigidRow { entries, value } = &rows[body][mode];
                    let entries = entries
                        .iter()
                        .map(|((body, mode), weight)| (layout.rigid(*body, *mode), *weight));
                    builder.constrain(layout.rigid(body, mode), entries.collect(), *value);
                }
                (Drive::Linked, None) | (Drive::Free, _) => {}
            }
        }
    }
    let surfaces = shapes.surfaces(&problem.bodies, poses);
    for (node, boundaries) in sides.iter() {
        let at = (node, boundaries.as_slice());
        constrain_node(problem, mesh, layout, &mut builder, (poses, &surfaces), time, at);
    }
    close_pressures_and_periods(problem, mesh, layout, &mut builder);
    // What drifts is held at one node; the equation that is left out follows from the others
    let drifts = problem.drifts();
    if let Some(node) = drifts.contains(&true).then(|| pinned_node(mesh)).flatten() {
        for axis in (0..2).filter(|&axis| drifts[axis]) {
            builder.constrain(layout.velocity(node, axis), vec![], 0.0);
        }
    }
    builder.build()
}

/// The node that holds fluid and bodies where nothing else does: a vertex on a side that is no
/// periodic copy.
pub(super) fn pinned_node(mesh: &Mesh<2>) -> Option<NodeId> {
    let mut is_copy = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        is_copy[pair.copy] = true;
    }
    let on_sides = mesh
        .facets
        .iter()
        .filter(|facet| mesh.boundaries[facet.boundary].kind == BoundaryKind::Side);
    let mut vertices = on_sides.map(|facet| mesh.facet_vertices(facet)[0]);
    vertices.find(|&vertex| !is_copy[vertex])
}

/// Equal values on periodic pairs, as far as they are free, and in an enclosed flow a level of the
/// pressure.
pub(super) fn close_pressures_and_periods(
    problem: &Problem,
    mesh: &Mesh<2>,
    layout: &DofLayout<2>,
    builder: &mut ConstraintBuilder,
) {
    for &PeriodicPair { copy, original } in &mesh.periodic {
        for axis in 0..2 {
            let raw = layout.velocity(copy, axis);
            if !builder.is_constrained(raw) {
                builder.constrain(raw, vec![(layout.velocity(original, axis), 1.0)], 0.0);
            }
        }
        if copy.index() < layout.n_vertices {
            builder.constrain(layout.pressure(copy), vec![(layout.pressure(original), 1.0)], 0.0);
        }
    }
    if problem.is_enclosed() {
        // Any vertex will do that is not itself a periodic copy, but on a side of the domain the
        // level is that far away: next to a body it may be large, and the cells far away, where
        // it is then felt, are large too.
        let is_side = |facet: &&Facet| mesh.boundaries[facet.boundary].kind == BoundaryKind::Side;
        let on_sides =
            mesh.facets.iter().filter(is_side).map(|facet| mesh.facet_vertices(facet)[0]);
        let pinned = on_sides
            .chain(layout.vertices())
            .map(|vertex| layout.pressure(vertex))
            .find(|&raw| !builder.is_constrained(raw));
        if let Some(raw) = pinned {
            builder.constrain(raw, vec![], 0.0);
        }
    }
}

fn constrain_node(
    problem: &Problem,
    mesh: &Mesh<2>,
    layout: &DofLayout<2>,
    builder: &mut ConstraintBuilder,
    (poses, surfaces): (&[Pose], &[MovingSurface<'_>]),
    time: f64,
    (node, boundaries): (NodeId, &[usize]),
) {
    let place = mesh.nodes[node];
    let body = boundaries.iter().find_map(|&boundary| match mesh.boundaries[boundary].kind {
        BoundaryKind::Body(body) => Some(body),
        _ => None,
    });
    if let Some(body) = body {
        let pose = &poses[body];
        let slip = surfaces[body].velocity(&place);
        let lever = [place[0] - pose.center.x, place[1] - pose.center.y];
        let turning = [-lever[1], lever[0]];
        for axis in 0..2 {
            let entries =
                vec![(layout.rigid(body, axis), 1.0), (layout.rigid(body, 2), turning[axis])];
            builder.constrain(layout.velocity(node, axis), entries, slip[axis]);
        }
        return;
    }
    if let Some(velocity) = problem.given_velocity(boundaries, &place, time) {
        for axis in 0..2 {
            builder.constrain(layout.velocity(node, axis), vec![], velocity[axis]);
        }
        return;
    }
    for normal_axis in problem.symmetry_axes(boundaries) {
        builder.constrain(layout.velocity(node, normal_axis), vec![], 0.0);
    }
}
