//! `Opened`: which image of each triangle the mesh of a torus shows, cut open along sides of triangles.
//!
//! Triangles at bodies are where their body is, so that bodies stay whole; all others where their middle
//! is in the box. Each vertex has as many copies as places in which the triangles around it show it.

use std::collections::HashMap;

use super::copies::{Copy, steps_between};
use super::triangulation::{Corner, Triangulation, WALL};
use crate::number::index_u32;
use crate::planar::boundary::BoundaryLoops;
use crate::{BoundaryId, BoundaryKind, NodeId, PeriodicPair, Point};

/// Where triangles and vertices are shown.
#[derive(Debug)]
pub struct Opened {
    /// Copies at the corners of each triangle.
    pub corners: Vec<[u32; 3]>,
    /// Places of all copies (m).
    pub points: Vec<Point<2>>,
    /// The original of each copy.
    originals: Vec<u32>,
    /// Whole periods from where the corners of each triangle are to where it shows them; of none where
    /// nothing is periodic.
    steps: Vec<[[i32; 2]; 3]>,
}

impl Opened {
    /// That of a triangulation, which is as it is where nothing is periodic.
    pub fn new(mesh: &Triangulation, border: &BoundaryLoops) -> Self {
        if !mesh.torus.is_closed() {
            let (corners, points) = (mesh.triangles.clone(), mesh.points.clone());
            let originals = (0..index_u32(points.len())).collect();
            return Self { corners, points, originals, steps: Vec::new() };
        }
        let is_on_body = vertices_on_bodies(mesh, border);
        let steps: Vec<[[i32; 2]; 3]> =
            (0..mesh.triangles.len()).map(|t| steps_of(mesh, t, &is_on_body)).collect();
        let copies = copies(mesh, &steps);
        let number: HashMap<Copy, u32> =
            copies.iter().enumerate().map(|(number, copy)| (*copy, index_u32(number))).collect();
        let mut originals: Vec<u32> = Vec::with_capacity(copies.len());
        for (i, copy) in copies.iter().enumerate() {
            let is_first = i == 0 || copies[i - 1].vertex != copy.vertex;
            originals.push(if is_first { index_u32(i) } else { originals[i - 1] });
        }
        let corners = mesh.triangles.iter().zip(&steps).map(|(corners, steps)| {
            [0, 1, 2].map(|i| number[&Copy { vertex: corners[i], steps: steps[i] }])
        });
        let points = copies
            .iter()
            .map(|copy| mesh.points[copy.vertex as usize] + mesh.torus.periods().shift(copy.steps));
        Self { corners: corners.collect(), points: points.collect(), originals, steps }
    }

    /// The copies of vertices that are no originals.
    pub fn pairs(&self) -> Vec<PeriodicPair> {
        let pairs = self.originals.iter().enumerate().map(|(copy, original)| PeriodicPair {
            copy: NodeId::new(copy),
            original: NodeId::from(*original),
        });
        pairs.filter(|pair| pair.copy != pair.original).collect()
    }

    /// The side of the box that stands for a side of a triangle along which the mesh is cut open from the
    /// triangle behind it; `None` where it is not.
    pub fn side(&self, (t, s): Corner, (behind, r): Corner) -> Option<BoundaryId> {
        let other = self.steps.get(behind)?[(r + 1) % 3];
        let step = steps_between(other, self.steps[t][s]);
        let axis = step.iter().position(|step| *step != 0)?;
        Some(BoundaryId::new(2 * axis + usize::from(step[axis] > 0)))
    }
}

/// All copies of all vertices, the original of each first.
fn copies(mesh: &Triangulation, steps: &[[[i32; 2]; 3]]) -> Vec<Copy> {
    let mut is_inner: HashMap<Copy, bool> = HashMap::new();
    for (t, steps) in steps.iter().enumerate() {
        let is_wall = mesh.across[t].map(|across| across & WALL != 0);
        for local in 0..3 {
            let copy = Copy { vertex: mesh.triangles[t][local], steps: steps[local] };
            *is_inner.entry(copy).or_insert(true) &= !is_wall[local] && !is_wall[(local + 2) % 3];
        }
    }
    let mut copies: Vec<Copy> = is_inner.keys().copied().collect();
    // The originals are on the boundary, whose values are given, and near
    copies.sort_by_key(|copy| {
        let [x, y] = copy.steps.map(i32::abs);
        (copy.vertex, is_inner[copy], x + y, copy.steps)
    });
    copies
}

/// Whole periods from where the corners of a triangle are to where it is shown.
fn steps_of(mesh: &Triangulation, t: usize, is_on_body: &[bool]) -> [[i32; 2]; 3] {
    let vertices = mesh.triangles[t];
    let points = vertices.map(|v| mesh.points[v as usize]);
    // To where the triangle is whole beside its first corner, and from there
    let together = points.map(|point| mesh.torus.periods().steps(point, points[0]));
    let is_at_body = |local: &usize| is_on_body[vertices[*local] as usize];
    // The body of its boundary edge rather than one that it meets with a corner
    let wall = (0..3).find(|s| mesh.across[t][*s] & WALL != 0);
    let on = match wall.filter(is_at_body).or_else(|| (0..3).find(is_at_body)) {
        // Vertices on bodies are where their body is
        Some(local) => steps_between(together[local], [0; 2]),
        None => {
            let [a, b, c] = mesh.corners(t);
            mesh.torus.steps_inside((a + b + c) / 3.0)
        }
    };
    together.map(|[x, y]| [x + on[0], y + on[1]])
}

/// Whether each vertex is on a body.
fn vertices_on_bodies(mesh: &Triangulation, border: &BoundaryLoops) -> Vec<bool> {
    let mut is_on_body = vec![false; mesh.points.len()];
    for edge in &mesh.edges {
        let boundary = border.pieces[edge.piece as usize].boundary;
        if matches!(border.boundaries[boundary].kind, BoundaryKind::Body(_)) {
            edge.vertices.iter().for_each(|v| is_on_body[*v as usize] = true);
        }
    }
    is_on_body
}
