//! Distances of nodes to the nearest wall, through the fluid.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use alewife_mesh::{Mesh, NodeId, Point};

/// Part of a distance that is rounding.
const ROUNDING: f64 = 1e-12;

/// Distance (m) of each node to the nearest node for which `is_wall` holds; infinite where no wall is.
///
/// Vertices get theirs from neighbours (@dijkstra1959), who hand on the vector from their wall: distances
/// are those to nodes of walls and never too short, though past an edge of a wall they may be a little too
/// long; those of nodes on edges, which look at the walls of their ends alone, up to twice next to a wall.
/// Ways lead through periodic sides.
pub(super) fn wall_distances<const D: usize>(
    mesh: &Mesh<D>,
    is_wall: impl Fn(NodeId) -> bool,
) -> Vec<f64> {
    let mut from_wall = FromWall::new(mesh);
    for vertex in mesh.vertex_ids().filter(|vertex| is_wall(*vertex)) {
        from_wall.reach(vertex, Point::<D>::zeros());
    }
    from_wall.spread();
    let mut distances: Vec<f64> = mesh.node_ids().map(|node| from_wall.distance(node)).collect();
    for edge in mesh.cell_ids().flat_map(|cell| mesh.cell_edges(cell)) {
        for &node in edge.inner {
            let by = edge.ends.map(|end| from_wall.distance_by(end, node));
            let nearest = by.into_iter().fold(distances[node.index()], f64::min);
            distances[node.index()] = if is_wall(node) { 0.0 } else { nearest };
        }
    }
    distances
}

/// The vectors from walls to vertices that are known so far.
struct FromWall<'a, const D: usize> {
    mesh: &'a Mesh<D>,
    /// Of each vertex (m).
    vectors: Vec<Option<Point<D>>>,
    /// Vertices that are reached, with the bits of their distance: those of positive numbers ascend with them.
    front: BinaryHeap<Reverse<(u64, NodeId)>>,
    /// For each vertex those at the other ends of its edges.
    neighbours: Vec<Vec<NodeId>>,
    /// For each vertex those that are the same one period on.
    images: Vec<Vec<NodeId>>,
}

impl<'a, const D: usize> FromWall<'a, D> {
    fn new(mesh: &'a Mesh<D>) -> Self {
        let n = mesh.n_vertices;
        let mut neighbours = vec![Vec::new(); n];
        for [a, b] in mesh.cell_ids().flat_map(|cell| mesh.cell_edges(cell).map(|edge| edge.ends)) {
            neighbours[a.index()].push(b);
            neighbours[b.index()].push(a);
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        let mut images = vec![Vec::new(); n];
        for pair in mesh.periodic.iter().filter(|pair| pair.copy.index() < n) {
            images[pair.copy.index()].push(pair.original);
            images[pair.original.index()].push(pair.copy);
        }
        Self { mesh, vectors: vec![None; n], front: BinaryHeap::new(), neighbours, images }
    }

    /// Takes note of a way to a vertex, if it is the shortest so far.
    fn reach(&mut self, vertex: NodeId, vector: Point<D>) {
        let distance = vector.norm();
        // Ways around through periodic sides differ by rounding
        if distance < self.distance(vertex) * (1.0 - ROUNDING) {
            self.vectors[vertex.index()] = Some(vector);
            self.front.push(Reverse((distance.to_bits(), vertex)));
        }
    }

    /// Goes on from vertex to vertex, the nearest first.
    fn spread(&mut self) {
        let mesh = self.mesh;
        while let Some(Reverse((bits, vertex))) = self.front.pop() {
            let Some(vector) = self.vectors[vertex.index()] else { continue };
            if vector.norm().to_bits() < bits {
                continue;
            }
            for other in self.neighbours[vertex.index()].clone() {
                self.reach(other, vector + (mesh.nodes[other] - mesh.nodes[vertex]));
            }
            for image in self.images[vertex.index()].clone() {
                self.reach(image, vector);
            }
        }
    }

    /// Distance (m) of a node to its wall, infinite if none is known.
    fn distance(&self, node: NodeId) -> f64 {
        let vector = self.vectors.get(node.index()).copied().flatten();
        vector.map_or(f64::INFINITY, |vector| vector.norm())
    }

    /// Distance (m) of a node to the wall of a vertex.
    fn distance_by(&self, vertex: NodeId, node: NodeId) -> f64 {
        let step = self.mesh.nodes[node] - self.mesh.nodes[vertex];
        self.vectors[vertex.index()].map_or(f64::INFINITY, |vector| (vector + step).norm())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::{BoundaryKind, Domain, PlacedShape, Shape, Sizing, generate};

    #[test]
    fn distances_lead_to_the_nearest_of_all_images() {
        let body = |name: &str, center: [f64; 2]| PlacedShape {
            name: name.into(),
            shape: Shape::Ellipse { semi_axes: [0.3, 0.1] },
            center: center.into(),
            angle: 0.4,
            size: None,
        };
        let (min, max) = (Point::<2>::zeros(), Point::<2>::new(4.0, 2.0));
        let domain = Domain::Box { min, max, periodic_x: true, periodic_y: true };
        let bodies = [body("a", [0.4, 0.3]), body("b", [1.6, 1.5])];
        let mesh = generate(&domain, &bodies, &Sizing::graded(0.05, 0.2, 0.2)).unwrap();
        let mut is_wall = vec![false; mesh.n_nodes()];
        let on_bodies = mesh
            .facets
            .iter()
            .filter(|facet| matches!(mesh.boundaries[facet.boundary].kind, BoundaryKind::Body(_)));
        let nodes = on_bodies.flat_map(|facet| mesh.facet_nodes(facet));
        nodes.for_each(|node| is_wall[node.index()] = true);
        let found = wall_distances(&mesh, |node| is_wall[node.index()]);
        let walls = mesh.vertex_ids().filter(|vertex| is_wall[vertex.index()]);
        let walls: Vec<Point<2>> = walls.map(|vertex| mesh.nodes[vertex]).collect();
        let nearest_image = |step: Point<2>| {
            let periods = step.component_div(&max).map(f64::round);
            step - periods.component_mul(&max)
        };
        let (mut of_vertices, mut of_all) = (1.0f64, 1.0f64);
        for node in mesh.node_ids().filter(|node| !is_wall[node.index()]) {
            let x = mesh.nodes[node];
            let gaps = walls.iter().map(|wall| nearest_image(x - wall).norm());
            let ratio = found[node.index()] / gaps.fold(f64::INFINITY, f64::min);
            assert!(ratio > 1.0 - 1e-12, "{x}: {ratio}");
            of_all = of_all.max(ratio);
            if node.index() < mesh.n_vertices {
                of_vertices = of_vertices.max(ratio);
            }
        }
        // Nodes of edges look only at the walls of their ends
        assert!(of_vertices < 1.2 && of_all < 2.0, "{of_vertices} {of_all}");
        assert!(wall_distances(&mesh, |_| false).iter().all(|distance| distance.is_infinite()));
    }
}
