//! `SolidMesh`: linear or quadratic simplices of a body at rest, and the facets of its surface.

use std::collections::BTreeMap;

use alewife_mesh::{Mesh, Point, Simplex};

use super::SolidError;

/// Degree of the shape functions of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Vertices only: one strain a cell, which is too stiff in bending and near nu = 0.5.
    Linear,
    /// Vertices and middles of edges, good to nu = 0.49.
    Quadratic,
}

/// What a mesh in two or three dimensions stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Plane strain; forces, masses and energies are per length.
    Plane,
    /// The half plane y >= 0 around the axis y = 0, without swirl; nodes on the axis stay there.
    Axis,
    /// Three dimensions.
    Space,
}

/// A facet of the surface of a solid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SolidFacet {
    /// Its nodes: D vertices, from outside counter-clockwise (in the plane the solid is on the left), then the
    /// middles of its edges.
    pub nodes: Vec<usize>,
    /// The name of its part of the surface, empty where it has none.
    pub part: String,
}

/// The mesh of a solid at rest, in D dimensions; made once, never changed.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidMesh<const D: usize> {
    /// Where its nodes are (m).
    pub nodes: Vec<Point<D>>,
    /// Degree of its shape functions.
    pub order: Order,
    /// Nodes of all cells, [`SolidMesh::n_local`] for each, in the order of [`Simplex`].
    pub cells: Vec<usize>,
    /// Its surface.
    pub facets: Vec<SolidFacet>,
}

/// The six ways from a corner of a cube to the opposite one along its edges.
const WAYS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl SolidMesh<2> {
    /// Linear triangles over a grid of so many squares, each divided in two, in opposite ways in the two halves along
    /// the second axis, from the places (m) of its points by their numbers along both.
    ///
    /// # Errors
    /// [`SolidError::Cell`] for a cell without volume.
    pub fn of_grid(
        n: [usize; 2],
        place: impl Fn([usize; 2]) -> Point<2>,
    ) -> Result<Self, SolidError> {
        let node = |i: usize, j: usize| i * (n[1] + 1) + j;
        let points = (0..=n[0]).flat_map(|i| (0..=n[1]).map(move |j| [i, j]));
        let nodes = points.map(place).collect();
        let mut cells = Vec::new();
        for i in 0..n[0] {
            for j in 0..n[1] {
                let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                if 2 * j < n[1] {
                    cells.extend([vec![a, b, d], vec![b, c, d]]);
                } else {
                    cells.extend([vec![a, b, c], vec![a, c, d]]);
                }
            }
        }
        Self::of_cells(nodes, &cells)
    }
}

impl SolidMesh<3> {
    /// Linear tetrahedra over a grid of so many cubes, six each, from the places (m) of its points by their numbers
    /// along the axes.
    ///
    /// # Errors
    /// [`SolidError::Cell`] for a cell without volume.
    pub fn of_grid(
        n: [usize; 3],
        place: impl Fn([usize; 3]) -> Point<3>,
    ) -> Result<Self, SolidError> {
        let node = |at: [usize; 3]| (at[0] * (n[1] + 1) + at[1]) * (n[2] + 1) + at[2];
        let mut nodes = Vec::new();
        for i in 0..=n[0] {
            for j in 0..=n[1] {
                nodes.extend((0..=n[2]).map(|k| place([i, j, k])));
            }
        }
        let mut cells = Vec::new();
        for i in 0..n[0] {
            for j in 0..n[1] {
                for k in 0..n[2] {
                    for way in WAYS {
                        let mut at = [i, j, k];
                        let mut cell = vec![node(at)];
                        for axis in way {
                            at[axis] += 1;
                            cell.push(node(at));
                        }
                        cells.push(cell);
                    }
                }
            }
        }
        Self::of_cells(nodes, &cells)
    }
}

impl<const D: usize> SolidMesh<D> {
    /// A mesh of linear simplices from vertices (m) and D + 1 of them a cell; cells of negative volume are
    /// turned round.
    ///
    /// # Errors
    /// [`SolidError::Cell`] for a cell without volume, or of vertices that do not exist.
    pub fn of_cells(nodes: Vec<Point<D>>, cells: &[Vec<usize>]) -> Result<Self, SolidError> {
        let mut all = Vec::new();
        for (number, cell) in cells.iter().enumerate() {
            let mut cell = cell.clone();
            if cell.len() != D + 1 || cell.iter().any(|node| *node >= nodes.len()) {
                return Err(SolidError::Cell(number));
            }
            let edges: Vec<Point<D>> =
                cell[1..].iter().map(|node| nodes[*node] - nodes[cell[0]]).collect();
            let volume = nalgebra::DMatrix::from_fn(D, D, |i, j| edges[j][i]).determinant();
            if !(volume.is_finite() && volume != 0.0) {
                return Err(SolidError::Cell(number));
            }
            if volume < 0.0 {
                cell.swap(0, 1);
            }
            all.extend(cell);
        }
        let mut mesh = Self { nodes, order: Order::Linear, cells: all, facets: Vec::new() };
        mesh.facets = mesh.surface();
        Ok(mesh)
    }

    /// The cells of a mesh of the program, with or without the middles of its edges.
    #[must_use]
    pub fn of_mesh(mesh: &Mesh<D>, order: Order) -> Self {
        let (n_local, n_of_facet, n_nodes) = match order {
            Order::Linear => (D + 1, D, mesh.n_vertices),
            Order::Quadratic => (Simplex::<D>::N_NODES, usize::MAX, mesh.n_nodes()),
        };
        let indices = |nodes: &[alewife_mesh::NodeId]| -> Vec<usize> {
            nodes[..n_local].iter().map(|node| node.index()).collect()
        };
        let facets = mesh.facets.iter().map(|facet| SolidFacet {
            nodes: mesh.facet_nodes(facet).take(n_of_facet).map(|node| node.index()).collect(),
            part: mesh.boundaries[facet.boundary].name.clone(),
        });
        Self {
            nodes: mesh.nodes[..n_nodes].to_vec(),
            order,
            cells: mesh.cells().flat_map(indices).collect(),
            facets: facets.collect(),
        }
    }

    /// The same cells with quadratic shape functions: middles of edges are added, numbered behind the vertices.
    #[must_use]
    pub fn quadratic(&self) -> Self {
        if self.order == Order::Quadratic {
            return self.clone();
        }
        let mut nodes = self.nodes.clone();
        let mut middles: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut middle = |a: usize, b: usize, nodes: &mut Vec<Point<D>>| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                nodes.push((nodes[a] + nodes[b]) * 0.5);
                nodes.len() - 1
            })
        };
        let mut cells = Vec::new();
        for cell in self.cells.chunks_exact(D + 1) {
            cells.extend_from_slice(cell);
            for [from, to] in Simplex::<D>::EDGES {
                cells.push(middle(cell[*from], cell[*to], &mut nodes));
            }
        }
        let mut facets = self.facets.clone();
        for facet in &mut facets {
            let ends = facet.nodes.clone();
            let n_edges = if D == 2 { 1 } else { 3 };
            for edge in 0..n_edges {
                facet.nodes.push(middle(ends[edge], ends[(edge + 1) % D], &mut nodes));
            }
        }
        Self { nodes, order: Order::Quadratic, cells, facets }
    }

    /// Nodes of a cell.
    #[must_use]
    pub fn n_local(&self) -> usize {
        match self.order {
            Order::Linear => D + 1,
            Order::Quadratic => Simplex::<D>::N_NODES,
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.cells.len() / self.n_local()
    }

    /// Nodes that obey a condition on their places.
    #[must_use]
    pub fn nodes_where(&self, is_meant: impl Fn(&Point<D>) -> bool) -> Vec<usize> {
        (0..self.nodes.len()).filter(|node| is_meant(&self.nodes[*node])).collect()
    }

    /// Facets that one cell only has.
    fn surface(&self) -> Vec<SolidFacet> {
        let mut found: BTreeMap<Vec<usize>, Option<Vec<usize>>> = BTreeMap::new();
        for cell in self.cells.chunks_exact(D + 1) {
            for side in 0..=D {
                let nodes: Vec<usize> =
                    Simplex::<D>::facet_vertices(side).iter().map(|local| cell[*local]).collect();
                let mut key = nodes.clone();
                key.sort_unstable();
                found.entry(key).and_modify(|facet| *facet = None).or_insert(Some(nodes));
            }
        }
        let facets = found.into_values().flatten();
        facets.map(|nodes| SolidFacet { nodes, part: String::new() }).collect()
    }
}
