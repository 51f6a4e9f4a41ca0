//! Meshes turned, mirrored and shifted as a whole.

use alewife_mesh::{Mesh, Point, Simplex};
use nalgebra::Rotation2;

/// A mirror image about the x axis or none, then a turn about the origin, then a shift.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moved {
    /// Whether y becomes -y first.
    pub mirrored: bool,
    /// Angle of the turn (rad).
    pub turn: f64,
    /// Shift (m).
    pub shift: [f64; 2],
}

impl Moved {
    /// -1 where angles and angular velocities change their sign, else 1.
    #[must_use]
    pub fn sign(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    /// A vector, which a shift leaves as it is.
    #[must_use]
    pub fn vector(&self, vector: Point<2>) -> Point<2> {
        Rotation2::new(self.turn) * Point::<2>::new(vector.x, self.sign() * vector.y)
    }

    /// A place (m).
    #[must_use]
    pub fn place(&self, place: Point<2>) -> Point<2> {
        self.vector(place) + Point::<2>::from(self.shift)
    }

    /// The direction of a body (rad).
    #[must_use]
    pub fn angle(&self, angle: f64) -> f64 {
        self.turn + self.sign() * angle
    }

    /// A mesh, its cells counter-clockwise as they were.
    #[must_use]
    pub fn mesh(&self, mesh: &Mesh<2>) -> Mesh<2> {
        let mut moved = if self.mirrored { mirror_image(mesh, 1) } else { mesh.clone() };
        for node in &mut moved.nodes {
            *node = Self { mirrored: false, ..*self }.place(*node);
        }
        moved
    }
}

/// A mesh in a mirror across an axis, its cells positive as they were: their second and third vertices change places.
#[must_use]
pub fn mirror_image<const D: usize>(mesh: &Mesh<D>, axis: usize) -> Mesh<D> {
    let other = |vertex: usize| [0, 2, 1, 3][vertex];
    let is_image =
        |one: &[usize], image: &[usize]| one.iter().all(|vertex| image.contains(&other(*vertex)));
    let edges = Simplex::<D>::EDGES;
    let edge_of = |edge: &[usize; 2]| edges.iter().position(|image| is_image(edge, image));
    let vertices = (0..=D).map(|vertex| Some(other(vertex)));
    let nodes = vertices.chain(edges.iter().map(|edge| edge_of(edge).map(|edge| edge + D + 1)));
    let nodes: Vec<usize> = nodes.flatten().collect();
    let sides: Vec<[usize; D]> = (0..=D).map(Simplex::<D>::facet_vertices).collect();
    let side_of = |side: usize| sides.iter().position(|image| is_image(&sides[side], image));

    let mut moved = mesh.clone();
    for node in &mut moved.nodes {
        node[axis] = -node[axis];
    }
    let n = Simplex::<D>::N_NODES;
    let topology = moved.topology_mut();
    for (cell, image) in mesh.cells().zip(topology.cells.chunks_exact_mut(n)) {
        for (place, from) in image.iter_mut().zip(&nodes) {
            *place = cell[*from];
        }
    }
    for facet in &mut topology.facets {
        let side = side_of(usize::from(facet.side)).unwrap_or(0);
        facet.side = u8::try_from(side).unwrap_or(0);
    }
    moved
}
