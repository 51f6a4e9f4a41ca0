//! Mesh invariants: positive Jacobians, conforming cells, tagged boundary, no orphan node.

use std::collections::{HashMap, HashSet};

use crate::mesh::Edge;
use crate::mesh::{determinant, jacobian_coefficients};
use crate::{BoundaryKind, CellId, Mesh, MeshError, NodeId, Simplex};

/// Nodes of a straight edge are this near to it, in lengths of the edge.
const STRAIGHT: f64 = 1e-12;

/// A facet of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Side {
    cell: CellId,
    side: usize,
    /// Whether its vertices in the order of the cell are an even permutation of the sorted ones.
    is_even: bool,
}

/// Whether a mesh is one: the first broken invariant is named.
///
/// - Every cell is positive everywhere; interior edges are straight.
/// - Cells that share an edge agree about its inner nodes, and see a common facet from both sides.
/// - Every facet with one cell is a boundary facet, once; no cell has two but on periodic sides.
/// - Every node is used, and periodic pairs hold a copy once, never as an original.
///
/// The boundary is closed when these hold, as the boundary of a sum of cells.
///
/// # Errors
/// [`MeshError::Invariant`].
pub fn check_mesh<const D: usize>(mesh: &Mesh<D>) -> Result<(), MeshError> {
    check_nodes(mesh)?;
    for cell in mesh.cell_ids() {
        if !is_positive(mesh, cell) {
            return broken("a cell has a Jacobian that is not positive", cell.index());
        }
    }
    let is_on_boundary = check_facets(mesh)?;
    check_edges(mesh, &is_on_boundary)?;
    check_periodic(mesh)
}

fn broken<T>(what: &'static str, index: usize) -> Result<T, MeshError> {
    Err(MeshError::Invariant { what, index })
}

fn check_nodes<const D: usize>(mesh: &Mesh<D>) -> Result<(), MeshError> {
    let mut used = vec![false; mesh.n_nodes()];
    for cell in mesh.cell_ids() {
        if mesh.cell(cell).iter().any(|node| node.index() >= mesh.n_nodes()) {
            return broken("a cell has a node that does not exist", cell.index());
        }
        if mesh.cell_vertices(cell).iter().any(|node| node.index() >= mesh.n_vertices) {
            return broken("a corner of a cell is not a vertex", cell.index());
        }
        for &node in mesh.cell(cell) {
            used[node] = true;
        }
    }
    match used.iter().position(|used| !*used) {
        Some(orphan) => broken("a node belongs to no cell", orphan),
        None => Ok(()),
    }
}

fn is_positive<const D: usize>(mesh: &Mesh<D>, cell: CellId) -> bool {
    let nodes = mesh.cell_nodes(cell);
    if mesh.curved[cell] {
        jacobian_coefficients(&nodes).iter().all(|coefficient| *coefficient > 0.0)
    } else {
        determinant(&std::array::from_fn::<_, D, _>(|k| nodes[k + 1] - nodes[0])) > 0.0
    }
}

/// Checks that facets meet in pairs but for those of the boundary, whose edges are returned.
fn check_facets<const D: usize>(mesh: &Mesh<D>) -> Result<HashSet<[NodeId; 2]>, MeshError> {
    let mut open: HashMap<[NodeId; D], Side> = HashMap::new();
    for cell in mesh.cell_ids() {
        for side in 0..Simplex::<D>::N_VERTICES {
            let Sorted { vertices, is_even } = sorted(facet_vertices(mesh, cell, side));
            match open.remove(&vertices) {
                Some(other) if other.is_even == is_even => {
                    return broken("a facet has two cells on the same side", cell.index());
                }
                Some(_) => {}
                None => {
                    open.insert(vertices, Side { cell, side, is_even });
                }
            }
        }
    }
    let mut n_facets = vec![0; mesh.n_cells()];
    let mut edges = HashSet::new();
    let mut is_paired = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        is_paired[pair.copy] = true;
        is_paired[pair.original] = true;
    }
    for facet in &mesh.facets {
        if facet.boundary.index() >= mesh.boundaries.len() {
            return broken("a facet has a boundary that does not exist", facet.cell.index());
        }
        let Sorted { vertices, .. } = sorted(mesh.facet_vertices(facet));
        let side = open.remove(&vertices);
        if side.is_none_or(|at| (at.cell, at.side) != (facet.cell, usize::from(facet.side))) {
            return broken("a facet is not on the boundary or is listed twice", facet.cell.index());
        }
        let is_side = mesh.boundaries[facet.boundary].kind == BoundaryKind::Side;
        let is_periodic = is_side && mesh.facet_inner_nodes(facet).all(|node| is_paired[node]);
        n_facets[facet.cell] += usize::from(!is_periodic);
        for (i, &a) in vertices.iter().enumerate() {
            edges.extend(vertices[i + 1..].iter().map(|&b| [a, b]));
        }
    }
    if let Some(at) = open.into_values().min_by_key(|at| at.cell) {
        return broken("a facet on the boundary is not listed", at.cell.index());
    }
    match n_facets.iter().position(|n| *n > 1) {
        Some(cell) => broken("a cell has two boundary facets", cell),
        None => Ok(edges),
    }
}

fn facet_vertices<const D: usize>(mesh: &Mesh<D>, cell: CellId, side: usize) -> [NodeId; D] {
    Simplex::<D>::facet_vertices(side).map(|local| mesh.cell(cell)[local])
}

/// Vertices in order.
struct Sorted<const N: usize> {
    vertices: [NodeId; N],
    /// Whether an even number of exchanges takes them there.
    is_even: bool,
}

fn sorted<const N: usize>(mut vertices: [NodeId; N]) -> Sorted<N> {
    let mut is_even = true;
    for i in 1..N {
        for j in (0..i).rev() {
            if vertices[j] > vertices[j + 1] {
                vertices.swap(j, j + 1);
                is_even = !is_even;
            }
        }
    }
    Sorted { vertices, is_even }
}

/// Checks that cells agree about the inner nodes of their edges, and that edges are straight but on
/// the boundary.
fn check_edges<const D: usize>(
    mesh: &Mesh<D>,
    on_boundary: &HashSet<[NodeId; 2]>,
) -> Result<(), MeshError> {
    let mut inner_nodes: HashMap<[NodeId; 2], Vec<NodeId>> = HashMap::new();
    for cell in mesh.cell_ids() {
        for edge in mesh.cell_edges(cell) {
            let Sorted { vertices: ends, is_even: is_forward } = sorted(edge.ends);
            let mut inner = edge.inner.to_vec();
            if !is_forward {
                inner.reverse();
            }
            if inner_nodes.entry(ends).or_insert_with(|| inner.clone()) != &inner {
                return broken("two cells disagree about the inner nodes of an edge", cell.index());
            }
            if !on_boundary.contains(&ends) && !is_straight(mesh, &edge) {
                return broken("an interior edge is not straight", cell.index());
            }
        }
    }
    Ok(())
}

fn is_straight<const D: usize>(mesh: &Mesh<D>, edge: &Edge<'_>) -> bool {
    let [from, to] = edge.ends.map(|vertex| mesh.nodes[vertex]);
    edge.inner.iter().zip(Simplex::<D>::EDGE_PARAMETERS).all(|(&node, &parameter)| {
        let expected = from * (1.0 - parameter) + to * parameter;
        (mesh.nodes[node] - expected).norm() <= STRAIGHT * (to - from).norm()
    })
}

fn check_periodic<const D: usize>(mesh: &Mesh<D>) -> Result<(), MeshError> {
    let mut is_copy = vec![false; mesh.n_nodes()];
    for pair in &mesh.periodic {
        if std::mem::replace(&mut is_copy[pair.copy], true) {
            return broken("a periodic copy is listed twice", pair.copy.index());
        }
    }
    match mesh.periodic.iter().find(|pair| is_copy[pair.original]) {
        Some(pair) => broken("a periodic original is a copy", pair.original.index()),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;
    use crate::test_meshes::{bulged_cube, cube_of_five, cube_of_twelve, quadratic};

    /// Two tetrahedra with a common face, their boundary in one piece.
    fn two_tetrahedra() -> Mesh<3> {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
        quadratic(&corners.map(Point::from), &[[0, 1, 2, 3], [4, 2, 1, 3]])
    }

    fn what(mesh: &Mesh<3>) -> &'static str {
        match check_mesh(mesh) {
            Err(MeshError::Invariant { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    }

    /// Every tetrahedron of so small a mesh has more than one boundary facet, which is checked last.
    const FINE: &str = "a cell has two boundary facets";

    #[test]
    fn broken_tetrahedral_meshes_are_refused() {
        let mesh = two_tetrahedra();
        assert_eq!(what(&mesh), FINE);
        let spoil = |change: &dyn Fn(&mut Mesh<3>)| {
            let mut broken = mesh.clone();
            change(&mut broken);
            what(&broken)
        };
        let inverted = spoil(&|mesh| mesh.nodes[4] = Point::<3>::repeat(-1.0));
        assert_eq!(inverted, "a cell has a Jacobian that is not positive");
        assert_eq!(
            spoil(&|mesh| mesh.topology_mut().facets.truncate(1)),
            "a facet on the boundary is not listed"
        );
        let twice = spoil(&|mesh| {
            let first = mesh.facets[0];
            mesh.topology_mut().facets.push(first);
        });
        assert_eq!(twice, "a facet is not on the boundary or is listed twice");
        assert_eq!(
            spoil(&|mesh| mesh.topology_mut().cells.copy_within(1..2, 0)),
            "a node belongs to no cell"
        );
    }

    #[test]
    fn meshes_of_a_cube_are_accepted_unless_a_cell_has_two_boundary_facets() {
        for mesh in [cube_of_twelve(), bulged_cube(0.2), bulged_cube(-0.05)] {
            assert_eq!(check_mesh(&mesh), Ok(()));
        }
        assert_eq!(what(&cube_of_five()), FINE);
        let spoil = |change: &dyn Fn(&mut Mesh<3>)| {
            let mut broken = bulged_cube(0.2);
            change(&mut broken);
            what(&broken)
        };
        // The inner node of an edge from the centre, the last vertex, is in the interior
        let interior = |mesh: &Mesh<3>| {
            let center = NodeId::new(mesh.n_vertices - 1);
            let mut edges = mesh.cell_edges(CellId::new(0));
            edges.find(|edge| edge.ends.contains(&center)).map(|edge| edge.inner[0])
        };
        let bent = spoil(&|mesh| {
            let node = interior(mesh).expect("every cell has the centre");
            mesh.nodes[node].x += 0.01;
        });
        assert_eq!(bent, "an interior edge is not straight");
        assert_eq!(
            spoil(&|mesh| mesh.topology_mut().cells.swap(4, 5)),
            "a cell has a Jacobian that is not positive"
        );
        let folded = bulged_cube(-1.2);
        assert_eq!(what(&folded), "a cell has a Jacobian that is not positive");
    }
}
