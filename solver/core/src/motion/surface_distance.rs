//! Distance of every cell from the surfaces that carry the mesh.

use std::collections::VecDeque;

use alewife_mesh::{Mesh, Point};

/// Distance (m) from the centre of each cell to the nearest of some vertices; infinite without any.
///
/// Each vertex learns a surface vertex from its neighbours and walks from there along the surface
/// to the nearest one, since far away cells are wider than the strips that have a surface vertex
/// in common. The time is about in proportion to the mesh.
pub(super) fn surface_distances<const D: usize>(
    mesh: &Mesh<D>,
    surface: impl Iterator<Item = u32>,
) -> Vec<f64> {
    let neighbours = Neighbours::new(mesh);
    let mut nearest: Vec<Option<u32>> = vec![None; mesh.n_vertices];
    let mut is_surface = vec![false; mesh.n_vertices];
    let mut waiting = VecDeque::new();
    for vertex in surface {
        nearest[vertex as usize] = Some(vertex);
        is_surface[vertex as usize] = true;
        waiting.push_back(vertex);
    }
    let gap = |place: &Point<D>, source: u32| (place - mesh.nodes[source as usize]).norm();
    let walk = |place: &Point<D>, mut source: u32| {
        let mut least = gap(place, source);
        loop {
            let along = neighbours.of(source).iter().filter(|next| is_surface[**next as usize]);
            let better = along.map(|&next| (gap(place, next), next)).filter(|next| next.0 < least);
            match better.min_by(|one, other| one.0.total_cmp(&other.0)) {
                Some(next) => (least, source) = next,
                None => return (least, source),
            }
        }
    };
    while let Some(vertex) = waiting.pop_front() {
        let Some(source) = nearest[vertex as usize] else { continue };
        for &next in neighbours.of(vertex) {
            let place = &mesh.nodes[next as usize];
            let known = nearest[next as usize].map_or(f64::INFINITY, |known| gap(place, known));
            let (found, source) = walk(place, source);
            if found < known {
                nearest[next as usize] = Some(source);
                waiting.push_back(next);
            }
        }
    }
    (0..mesh.n_cells())
        .map(|cell| {
            let corners = &mesh.cell(cell)[..=D];
            let sum: Point<D> = corners.iter().map(|&corner| mesh.nodes[corner as usize]).sum();
            let center = sum / (D + 1) as f64;
            let sources = corners.iter().filter_map(|&corner| nearest[corner as usize]);
            sources.map(|source| walk(&center, source).0).fold(f64::INFINITY, f64::min)
        })
        .collect()
}

/// The vertices that share a cell with each vertex; some are listed more than once.
struct Neighbours {
    offsets: Vec<usize>,
    vertices: Vec<u32>,
}

impl Neighbours {
    fn new<const D: usize>(mesh: &Mesh<D>) -> Self {
        let corners = || (0..mesh.n_cells()).map(|cell| &mesh.cell(cell)[..=D]);
        let mut offsets = vec![0; mesh.n_vertices + 1];
        for &vertex in corners().flatten() {
            offsets[vertex as usize + 1] += D;
        }
        for vertex in 0..mesh.n_vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut fill = offsets.clone();
        let mut vertices = vec![0; offsets[mesh.n_vertices]];
        for cell in corners() {
            for &vertex in cell {
                for &other in cell.iter().filter(|other| **other != vertex) {
                    vertices[fill[vertex as usize]] = other;
                    fill[vertex as usize] += 1;
                }
            }
        }
        Self { offsets, vertices }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.vertices[self.offsets[vertex]..self.offsets[vertex + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::{Domain, PlacedShape, Shape, Sizing, generate};

    #[test]
    fn distances_are_those_to_the_nearest_of_all_surface_vertices() {
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(4.0, 4.0));
        let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
        let body = |name: &str, x: f64| PlacedShape {
            name: name.into(),
            shape: Shape::Ellipse { semi_axes: [0.2, 1.0] },
            center: Point::<2>::new(x, 2.1),
            angle: 0.4,
            size: None,
        };
        let bodies = [body("a", 1.2), body("b", 2.5)];
        let mesh = generate(&domain, &bodies, &Sizing::graded(0.1, 0.2, 0.4)).unwrap();
        let surface: Vec<u32> = mesh
            .facets
            .iter()
            .filter(|facet| facet.boundary >= 4)
            .map(|facet| mesh.facet_nodes(facet)[0])
            .collect();
        let found = surface_distances(&mesh, surface.iter().copied());
        for (cell, found) in found.iter().enumerate() {
            let [a, b, c, ..] = mesh.cell_nodes(cell);
            let center = (a + b + c) / 3.0;
            let gaps = surface.iter().map(|v| (mesh.nodes[*v as usize] - center).norm());
            let nearest = gaps.fold(f64::INFINITY, f64::min);
            assert!((found - nearest).abs() < 1e-14, "cell {cell}: {found} {nearest}");
        }
        assert!(surface_distances(&mesh, std::iter::empty()).iter().all(|d| d.is_infinite()));
    }
}
