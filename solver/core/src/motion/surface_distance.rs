//! Distance of every cell from the surfaces that carry the mesh.

use std::collections::VecDeque;

use alewife_mesh::{Mesh, NodeId, Point};

/// Part of a distance that is rounding.
const ROUNDING: f64 = 1e-12;

/// Distance (m) from the centre of each cell to the nearest of some vertices; infinite without any.
///
/// Each vertex learns a surface vertex from its neighbours and walks from there along the surface
/// to the nearest one, since far away cells are wider than the strips that have a surface vertex
/// in common. The time is about in proportion to the mesh. A mesh may be cut open right beside bodies:
/// the way continues across periodic sides.
pub(super) fn surface_distances<const D: usize>(
    mesh: &Mesh<D>,
    surface: impl Iterator<Item = NodeId>,
) -> Vec<f64> {
    let neighbours = Neighbours::new(mesh);
    let images = images(mesh);
    let mut nearest: Vec<Option<Source<D>>> = vec![None; mesh.n_vertices];
    let mut is_surface = vec![false; mesh.n_vertices];
    let mut waiting = VecDeque::new();
    for vertex in surface {
        nearest[vertex] = Some(Source { vertex, away: Point::zeros() });
        is_surface[vertex] = true;
        waiting.push_back(vertex);
    }
    let gap = |point: &Point<D>, source: &Source<D>| {
        (point - mesh.nodes[source.vertex] - source.away).norm()
    };
    let walk = |point: &Point<D>, mut source: Source<D>| {
        let mut least = gap(point, &source);
        loop {
            let along = neighbours.of(source.vertex).iter().filter(|next| is_surface[**next]);
            let better = along
                .map(|&vertex| Source { vertex, ..source })
                .map(|next| (gap(point, &next), next))
                .filter(|next| next.0 < least);
            match better.min_by(|one, other| one.0.total_cmp(&other.0)) {
                Some(next) => (least, source) = next,
                None => return (least, source),
            }
        }
    };
    while let Some(vertex) = waiting.pop_front() {
        let Some(source) = nearest[vertex] else { continue };
        let at_image = images[vertex.index()].iter().map(|&image| {
            let away = source.away + mesh.nodes[image] - mesh.nodes[vertex];
            (image, Source { away, ..source })
        });
        let beside = neighbours.of(vertex).iter().map(|&next| (next, source));
        for (next, source) in beside.chain(at_image) {
            let point = &mesh.nodes[next];
            let known = nearest[next].map_or(f64::INFINITY, |known| gap(point, &known));
            let (found, source) = walk(point, source);
            // What comes back from an image differs by rounding
            if found < known * (1.0 - ROUNDING) {
                nearest[next] = Some(source);
                waiting.push_back(next);
            }
        }
    }
    mesh.cell_ids()
        .map(|cell| {
            let center = mesh.cell_center(cell);
            let sources = mesh.cell_vertices(cell).iter().filter_map(|&corner| nearest[corner]);
            sources.map(|source| walk(&center, source).0).fold(f64::INFINITY, f64::min)
        })
        .collect()
}

/// A surface vertex, or an image of one.
#[derive(Debug, Clone, Copy)]
struct Source<const D: usize> {
    vertex: NodeId,
    /// From the vertex to the image (m).
    away: Point<D>,
}

/// The periodic images of each vertex that are in the mesh.
fn images<const D: usize>(mesh: &Mesh<D>) -> Vec<Vec<NodeId>> {
    let mut images = vec![Vec::new(); mesh.n_vertices];
    for pair in mesh.periodic.iter().filter(|pair| pair.copy.index() < mesh.n_vertices) {
        images[pair.copy.index()].push(pair.original);
        images[pair.original.index()].push(pair.copy);
    }
    images
}

/// The vertices that share a cell with each vertex; some are listed more than once.
struct Neighbours {
    offsets: Vec<usize>,
    vertices: Vec<NodeId>,
}

impl Neighbours {
    fn new<const D: usize>(mesh: &Mesh<D>) -> Self {
        let corners = || mesh.cell_ids().map(|cell| mesh.cell_vertices(cell));
        let mut offsets = vec![0; mesh.n_vertices + 1];
        for &vertex in corners().flatten() {
            offsets[vertex.index() + 1] += D;
        }
        for vertex in 0..mesh.n_vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut fill = offsets.clone();
        let mut vertices = vec![NodeId::default(); offsets[mesh.n_vertices]];
        for cell in corners() {
            for &vertex in cell {
                for &other in cell.iter().filter(|other| **other != vertex) {
                    vertices[fill[vertex]] = other;
                    fill[vertex] += 1;
                }
            }
        }
        Self { offsets, vertices }
    }

    fn of(&self, vertex: NodeId) -> &[NodeId] {
        &self.vertices[self.offsets[vertex]..self.offsets[vertex.index() + 1]]
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
        let surface: Vec<NodeId> = mesh
            .facets
            .iter()
            .filter(|facet| facet.boundary.index() >= 4)
            .map(|facet| mesh.facet_vertices(facet)[0])
            .collect();
        let found = surface_distances(&mesh, surface.iter().copied());
        for (cell, found) in mesh.cell_ids().zip(&found) {
            let center = mesh.cell_center(cell);
            let gaps = surface.iter().map(|v| (mesh.nodes[*v] - center).norm());
            let nearest = gaps.fold(f64::INFINITY, f64::min);
            assert!((found - nearest).abs() < 1e-14, "cell {cell}: {found} {nearest}");
        }
        assert!(surface_distances(&mesh, std::iter::empty()).iter().all(|d| d.is_infinite()));
    }
}
