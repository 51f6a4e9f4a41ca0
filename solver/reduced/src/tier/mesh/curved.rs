//! Quadratic cells whose edges on the surface follow the outline of a shape.

use alewife_mesh::{Outline, Point, Simplex, bulge};
use alewife_solid::solid::{Order, SolidMesh};

/// The mesh of a shape, with the middles of the edges of its surface on its outline: the volume of a smooth shape is then
/// of third order in the size of the cells or better, in place of second. Edges that the outline does not follow, as at a
/// tip sharper than they are long, and those of a cell that would turn over, stay straight; cells of first order have
/// no middles.
pub(super) fn curved(mut mesh: SolidMesh<2>, outline: &Outline) -> SolidMesh<2> {
    if mesh.order == Order::Linear {
        return mesh;
    }
    let straight = mesh.nodes.clone();
    for facet in &mesh.facets {
        let [from, to, middle] = [0, 1, 2].map(|local| facet.nodes[local]);
        if let Some(way) = bulge(outline, [from, to].map(|end| straight[end])) {
            mesh.nodes[middle] += way;
        }
    }
    let n_local = Simplex::<2>::N_NODES;
    for cell in mesh.cells.chunks_exact(n_local) {
        if !is_upright(&mesh.nodes, cell) {
            cell[3..].iter().for_each(|middle| mesh.nodes[*middle] = straight[*middle]);
        }
    }
    mesh
}

/// Whether the map of a cell turns nothing over at its vertices.
fn is_upright(nodes: &[Point<2>], cell: &[usize]) -> bool {
    let middle_of = |a: usize, b: usize| {
        let edges = Simplex::<2>::EDGES.iter().zip(&cell[3..]);
        let mut own = edges.filter(|(edge, _)| edge.contains(&a) && edge.contains(&b));
        own.next().map_or(Point::<2>::zeros(), |(_, middle)| nodes[*middle])
    };
    // Along a quadratic edge from where it begins
    let direction = |from: usize, to: usize| {
        middle_of(from, to) * 4.0 - nodes[cell[from]] * 3.0 - nodes[cell[to]]
    };
    (0..3).all(|vertex| {
        let one = direction(vertex, (vertex + 1) % 3);
        let other = direction(vertex, (vertex + 2) % 3);
        one.x * other.y - one.y * other.x > 0.0
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use alewife_mesh::{PlacedShape, Shape, points_of_outline, triangulate_inside};

    use super::*;

    /// Area of quadratic cells by their surface: of an edge with its middle m, of its parabola.
    fn area(mesh: &SolidMesh<2>) -> f64 {
        let cross = |a: Point<2>, b: Point<2>| a.x * b.y - a.y * b.x;
        let part = |facet: &alewife_solid::solid::SolidFacet| {
            let [a, b, m] = [0, 1, 2].map(|local| mesh.nodes[facet.nodes[local]]);
            (4.0 * (cross(a, m) + cross(m, b)) - cross(a, b)) / 6.0
        };
        mesh.facets.iter().map(part).sum()
    }

    /// Cells of this size inside of an outline, straight and curved, and their areas over the exact one, less 1.
    fn lacking(outline: &Outline, size: f64, exact: f64) -> [f64; 2] {
        let points = points_of_outline(outline, size);
        let triangles = triangulate_inside(&points, PI * size).expect("it can be filled");
        let cells: Vec<Vec<usize>> = triangles.cells.iter().map(|cell| cell.to_vec()).collect();
        let mesh = SolidMesh::of_cells(triangles.points, &cells).expect("it is a mesh").quadratic();
        [area(&mesh), area(&curved(mesh.clone(), outline))].map(|area| area / exact - 1.0)
    }

    #[test]
    fn a_slender_ellipse_of_coarse_curved_cells_has_its_area() {
        let placed = PlacedShape {
            name: "body".to_owned(),
            shape: Shape::Ellipse { semi_axes: [0.5, 0.1] },
            center: Point::<2>::zeros(),
            angle: 0.3,
            size: None,
        };
        let outline = Outline::new(&placed).expect("it is a shape");
        for size in [0.2, 0.1, 0.05] {
            let [straight, curved] = lacking(&outline, size, PI * 0.05);
            println!("{size}: straight {straight:.2e}, curved {curved:.2e}");
            // The rest is of vertices that the refinement of triangles has put on straight edges
            assert!(straight < 0.0 && curved.abs() < 0.1 * straight.abs(), "{straight} {curved}");
        }
    }

    #[test]
    fn a_disc_of_curved_cells_has_its_area_to_fourth_order() {
        let off = |size: f64| {
            let outline = Outline::circle(Point::<2>::new(0.3, 0.1), 1.0);
            let [straight, curved] = lacking(&outline, size, PI);
            println!("{size}: straight {straight:.2e}, curved {curved:.2e}");
            assert!(straight < -0.1 * size * size);
            curved.abs()
        };
        let (coarse, fine) = (off(0.4), off(0.2));
        assert!(coarse < 1e-3 && fine < coarse / 12.0, "{coarse} {fine}");
    }
}
