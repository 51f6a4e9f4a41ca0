//! From boundary conditions and bodies to constraints on the raw unknowns.
//!
//! A node on a body: u = U + omega x (x - G) + slip, with U and omega raw unknowns themselves.
//! Where boundaries meet, bodies come first, then walls, then inflows, then symmetry planes.

use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, NodeId, Point};

use super::boundaries::{Boundaries, BoundaryNode};
use super::kinematics::{RigidRow, turned_component};
use super::problem::{Drive, Problem};
use super::shapes::{BodyShapes, MovingSurface};
use crate::algebra::{AffineConstraints, ConstraintBuilder, Term};
use crate::body::{Pose, Twist, in_space};
use crate::space::DofLayout;

/// Bodies at one time: where they are and how their surfaces move.
#[derive(Debug, Clone, Copy)]
pub struct BodiesAt<'a> {
    /// Poses in the mesh.
    pub poses: &'a [Pose],
    /// Shapes, and the time (s) at which boundary values and gaits are taken.
    pub shapes: &'a BodyShapes,
}

/// What constraints are made of on one mesh.
pub(super) struct Constrainer<'a, const D: usize> {
    pub problem: &'a Problem<D>,
    pub mesh: &'a Mesh<D>,
    pub layout: &'a DofLayout<D>,
}

impl<const D: usize> Constrainer<'_, D> {
    /// The constraints with bodies at these poses.
    pub fn constraints(&self, boundaries: &Boundaries, bodies: BodiesAt<'_>) -> AffineConstraints {
        let mut builder = ConstraintBuilder::new(self.layout.n_raw());
        let raw = |body: usize, position: usize| self.layout.rigid(body, position);
        let time = bodies.shapes.time();
        constrain_rigid_velocities(self.problem, bodies.poses, time, raw, &mut builder);
        let surfaces = bodies.shapes.surfaces(&self.problem.bodies, bodies.poses);
        for at in boundaries.nodes() {
            match at.body {
                Some(body) => {
                    self.attach_to_body(at.node, body, &surfaces[body], &mut builder);
                }
                None => self.constrain_side(&at, bodies.shapes.time(), &mut builder),
            }
        }
        self.close_pressures_and_periods(&mut builder);
        self.pin_free_translations(&mut builder);
        builder.build()
    }

    /// u = U + omega x (x - G) + slip.
    fn attach_to_body(
        &self,
        node: NodeId,
        body: usize,
        surface: &MovingSurface<'_>,
        builder: &mut ConstraintBuilder,
    ) {
        let modes = self.problem.modes();
        let position = in_space(&self.mesh.nodes[node]);
        let slip = surface.velocity(&position);
        let lever = position - surface.pose().center;
        for axis in 0..D {
            let entries = modes.iter().enumerate().filter_map(|(position, mode)| {
                let weight = match (mode.is_rotation(), mode.axis() == axis) {
                    (false, true) => 1.0,
                    (true, false) => turned_component(mode, &lever, axis),
                    (false, false) | (true, true) => return None,
                };
                Some(Term { unknown: self.layout.rigid(body, position), weight })
            });
            builder.constrain(self.layout.velocity(node, axis), entries.collect(), slip[axis]);
        }
    }

    fn constrain_side(&self, at: &BoundaryNode, time: f64, builder: &mut ConstraintBuilder) {
        let point = &self.mesh.nodes[at.node];
        if let Some(velocity) = self.problem.given_velocity(&at.boundaries, point, time) {
            for axis in 0..D {
                builder.fix(self.layout.velocity(at.node, axis), velocity[axis]);
            }
            return;
        }
        for normal_axis in self.problem.symmetry_axes(&at.boundaries) {
            builder.fix(self.layout.velocity(at.node, normal_axis), 0.0);
        }
    }

    /// Equal values on periodic pairs, as far as they are free, and in an enclosed flow a level of the
    /// pressure.
    pub fn close_pressures_and_periods(&self, builder: &mut ConstraintBuilder) {
        let Self { mesh, layout, .. } = self;
        for pair in &mesh.periodic {
            for axis in 0..D {
                let raw = layout.velocity(pair.copy, axis);
                if !builder.is_constrained(raw) {
                    let original = layout.velocity(pair.original, axis);
                    builder.equate(raw, original);
                }
            }
            if pair.copy.index() < layout.n_vertices {
                let original = layout.pressure(pair.original);
                builder.equate(layout.pressure(pair.copy), original);
            }
        }
        if self.problem.is_enclosed() {
            // Any vertex will do that is not itself a periodic copy, but on a side of the domain the
            // level is that far away: next to a body it may be large, and the cells far away, where
            // it is then felt, are large too.
            let pinned = vertices_on_sides(mesh)
                .chain(mesh.vertex_ids())
                .map(|vertex| layout.pressure(vertex))
                .find(|&raw| !builder.is_constrained(raw));
            if let Some(raw) = pinned {
                builder.fix(raw, 0.0);
            }
        }
    }

    /// Holds one node where nothing else holds fluid and bodies; the equation that is left out follows
    /// from the others.
    fn pin_free_translations(&self, builder: &mut ConstraintBuilder) {
        let is_free = self.problem.free_translations();
        let Some(node) = is_free.contains(&true).then(|| pinned_node(self.mesh)).flatten() else {
            return;
        };
        for axis in (0..D).filter(|&axis| is_free[axis]) {
            builder.fix(self.layout.velocity(node, axis), 0.0);
        }
    }
}

/// Constrains rigid velocities that are given at a time (s) or follow from others, with bodies at poses in the mesh;
/// `raw(body, position)` is the raw unknown of a motion.
pub(super) fn constrain_rigid_velocities<const D: usize>(
    problem: &Problem<D>,
    poses: &[Pose],
    time: f64,
    raw: impl Fn(usize, usize) -> usize,
    builder: &mut ConstraintBuilder,
) {
    let modes = problem.modes();
    let rows = problem.has_joints().then(|| problem.rigid_rows(poses, time));
    for (body, rigid) in problem.bodies.iter().enumerate() {
        for (position, mode) in modes.iter().enumerate() {
            let drive = rigid.drive(mode);
            if let Some(value) = drive.given(time) {
                builder.fix(raw(body, position), value);
            } else if let (Drive::Linked, Some(rows)) = (drive, &rows) {
                let row = &rows[body][mode];
                if row.is(body, mode) {
                    continue;
                }
                let RigidRow { entries, value } = row;
                let entries = entries.iter().filter_map(|(unknown, weight)| {
                    let position = modes.position(unknown.mode)?;
                    Some(Term { unknown: raw(unknown.body, position), weight: *weight })
                });
                builder.constrain(raw(body, position), entries.collect(), *value);
            }
        }
    }
}

/// The first vertex of each facet on a side of the domain, if it is on no body.
fn vertices_on_sides<const D: usize>(mesh: &Mesh<D>) -> impl Iterator<Item = NodeId> {
    let is_side = |boundary: BoundaryId| mesh.boundaries[boundary].kind == BoundaryKind::Side;
    let mut is_on_body = vec![false; mesh.n_vertices];
    for facet in mesh.facets.iter().filter(|facet| !is_side(facet.boundary)) {
        mesh.facet_vertices(facet).iter().for_each(|vertex| is_on_body[*vertex] = true);
    }
    let facets = mesh.facets.iter().filter(move |facet| is_side(facet.boundary));
    facets.map(|facet| mesh.facet_vertices(facet)[0]).filter(move |vertex| !is_on_body[*vertex])
}

/// The node that holds fluid and bodies where nothing else does: a vertex on a side that is no
/// periodic copy.
pub(super) fn pinned_node<const D: usize>(mesh: &Mesh<D>) -> Option<NodeId> {
    let mut is_copy = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        is_copy[pair.copy] = true;
    }
    vertices_on_sides(mesh).find(|&vertex| !is_copy[vertex])
}

/// Boundary values at the nodes of a velocity that is given everywhere else: those of bodies with these
/// rigid velocities, of sides with given velocities, and none across symmetry planes. `origin` is the
/// position of the frame in which the mesh is seen (m).
pub fn impose_boundary_values<const D: usize>(
    problem: &Problem<D>,
    mesh: &Mesh<D>,
    boundaries: &Boundaries,
    values: &BoundaryValues<'_, D>,
    velocity: &mut [Point<D>],
) {
    let BodiesAt { poses, shapes } = values.bodies;
    let surfaces = shapes.surfaces(&problem.bodies, poses);
    for at in boundaries.nodes() {
        let point = mesh.nodes[at.node];
        if let Some(body) = at.body {
            let lever = in_space(&point) - poses[body].center;
            let rigid = values.twists[body].velocity_at(&lever);
            let slip = surfaces[body].velocity(&in_space(&point));
            velocity[at.node] = Point::<D>::from_fn(|axis, _| rigid[axis] + slip[axis]);
            continue;
        }
        let in_laboratory = point + values.origin;
        let given = problem.given_velocity(&at.boundaries, &in_laboratory, shapes.time());
        if let Some(given) = given {
            velocity[at.node] = given;
        } else {
            for axis in problem.symmetry_axes(&at.boundaries) {
                velocity[at.node][axis] = 0.0;
            }
        }
    }
    for pair in boundaries.body_copies() {
        velocity[pair.copy] = velocity[pair.original];
    }
}

/// What [`impose_boundary_values`] takes the values from.
#[derive(Debug, Clone, Copy)]
pub struct BoundaryValues<'a, const D: usize> {
    /// Bodies as seen from the frame.
    pub bodies: BodiesAt<'a>,
    /// Their rigid velocities.
    pub twists: &'a [Twist],
    /// Position of the frame (m).
    pub origin: Point<D>,
}
