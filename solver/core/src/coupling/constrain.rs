//! From boundary conditions and bodies to constraints on the raw unknowns.
//!
//! A node on a body: u = U + omega x (x - G) + slip, with U and omega raw unknowns themselves, or a sum of rates of
//! coordinates of the body, whose mean is U.
//! Where boundaries meet, bodies come first, then walls, then inflows, then symmetry planes.

use alewife_mesh::{BoundaryId, BoundaryKind, Mesh, NodeId, Point};

use super::boundaries::{Boundaries, BoundaryNode};
use super::kinematics::RigidRow;
use super::problem::{Drive, Problem, RigidBody};
use super::shapes::BodyShapes;
use super::surface::{BodyVelocity, MovingSurface, RestPlaces};
use crate::algebra::{AffineConstraints, ConstraintBuilder, Term};
use crate::body::{MeshPoses, Mode, Pose, Twist, in_space, on_mesh};
use crate::space::DofLayout;
use crate::structure::{Held, Weight};

/// Bodies at one time: where they are and how their surfaces move.
#[derive(Debug, Clone, Copy)]
pub struct BodiesAt<'a> {
    /// Poses in the mesh.
    pub poses: &'a MeshPoses,
    /// Shapes, and the time (s) at which boundary values and gaits are taken.
    pub shapes: &'a BodyShapes,
}

/// What constraints are made of on one mesh.
pub(super) struct Constrainer<'a, const D: usize> {
    pub problem: &'a Problem<D>,
    pub mesh: &'a Mesh<D>,
    pub layout: &'a DofLayout<D>,
    /// Where nodes on bodies with coordinates are at rest.
    pub rest_places: &'a RestPlaces,
}

impl<const D: usize> Constrainer<'_, D> {
    /// The constraints with bodies at these poses.
    pub fn constraints(&self, boundaries: &Boundaries, bodies: BodiesAt<'_>) -> AffineConstraints {
        let mut builder = ConstraintBuilder::new(self.layout.n_raw());
        let time = bodies.shapes.time();
        constrain_rigid_velocities(self.problem, bodies.poses, time, self.layout, &mut builder);
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

    /// The velocity of a node on a body, by those of the body.
    fn attach_to_body(
        &self,
        node: NodeId,
        body: usize,
        surface: &MovingSurface<'_>,
        builder: &mut ConstraintBuilder,
    ) {
        let (layout, modes) = (self.layout, self.problem.modes());
        let point = in_space(&self.mesh.nodes[node]);
        let rows = surface.rows::<D>(&point, self.rest_places.get(&node), modes);
        for (axis, row) in rows.into_iter().enumerate() {
            let terms = row.weights.into_iter().filter_map(|(velocity, weight)| {
                let unknown = match velocity {
                    BodyVelocity::Rigid(mode) => layout.rigid(body, modes.position(mode)?),
                    BodyVelocity::Rate(coordinate) => layout.rate(coordinate),
                };
                Some(Term { unknown, weight })
            });
            builder.constrain(layout.velocity(node, axis), terms.collect(), row.remainder);
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

/// Constrains velocities of bodies that are given at a time (s) or follow from others, with bodies at poses in the mesh.
pub(super) fn constrain_rigid_velocities<const D: usize>(
    problem: &Problem<D>,
    poses: &[Pose],
    time: f64,
    layout: &DofLayout<D>,
    builder: &mut ConstraintBuilder,
) {
    let modes = problem.modes();
    let rows = problem.has_joints().then(|| problem.rigid_rows(poses, time));
    let raw = |body: usize, position: usize| layout.rigid(body, position);
    for ((body, rigid), own) in problem.bodies.iter().enumerate().zip(problem.coordinates()) {
        for (position, mode) in modes.iter().enumerate() {
            let drive = rigid.drive(mode);
            if let Some(mean) = mean_velocity(rigid, layout, own.start, mode) {
                builder.constrain(raw(body, position), mean, 0.0);
            } else if let Some(value) = drive.given(time) {
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
    for at in problem.attached_coordinates() {
        let [linear, angular] = at.given.row(&problem.bodies[at.own].pose, &poses[at.to]);
        let term = |(position, mode): (usize, Mode)| {
            let of = if mode.is_rotation() { &angular } else { &linear };
            Term { unknown: raw(at.to, position), weight: of[mode.axis()] }
        };
        let terms = modes.iter().enumerate().map(term).collect();
        builder.constrain(layout.rate(at.coordinate), terms, 0.0);
    }
    for Held { coordinate, rate, .. } in problem.held_coordinates(time) {
        builder.fix(layout.rate(coordinate), rate);
    }
}

/// A velocity of a body with coordinates, of which `first` is the first one, by their rates: that of its centre along
/// the axis of a translation, and none in a rotation. `None` of another body.
fn mean_velocity<const D: usize>(
    rigid: &RigidBody,
    layout: &DofLayout<D>,
    first: usize,
    mode: Mode,
) -> Option<Vec<Term<usize>>> {
    let flexible = rigid.flexible()?;
    if mode.is_rotation() {
        return Some(Vec::new());
    }
    let rotation = rigid.pose.rotation();
    let term = |at: &Weight| Term {
        unknown: layout.rate(first + at.coordinate),
        weight: (rotation * at.weight)[mode.axis()],
    };
    Some(flexible.center_weights().iter().map(term).collect())
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
            let (twist, rest) = (&values.twists[body], values.rest_places.get(&at.node));
            let carried = surfaces[body].carried(twist, values.rates, &in_space(&point), rest);
            velocity[at.node] = on_mesh(&carried);
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
    /// Rates of the coordinates of all bodies.
    pub rates: &'a [f64],
    /// Where nodes on bodies with coordinates are at rest (m).
    pub rest_places: &'a RestPlaces,
    /// Position of the frame (m).
    pub origin: Point<D>,
}
