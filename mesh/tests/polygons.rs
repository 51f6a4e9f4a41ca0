//! Meshes around polygons: area, corners, sizes, symmetry.

use alewife_mesh::{
    BoundaryKind, Domain, Mesh, PlacedShape, Point, Quality, Shape, Sizing, check_mesh, generate,
};

const BOX: Domain = Domain::Box {
    min: Point::<2>::new(-3.0, -3.0),
    max: Point::<2>::new(3.0, 3.0),
    periodic_x: false,
    periodic_y: false,
};

fn body(points: &[[f64; 2]], x: f64, angle: f64) -> PlacedShape {
    let shape = Shape::Polygon { points: points.to_vec() };
    PlacedShape { name: "b".into(), shape, center: Point::<2>::new(x, 0.0), angle, size: None }
}

fn area(mesh: &Mesh<2>) -> f64 {
    let corners = mesh.cells().map(|cell| [0, 1, 2].map(|corner| mesh.nodes[cell[corner]]));
    corners.map(|[a, b, c]| 0.5 * (b - a).perp(&(c - a))).sum()
}

const SQUARE: [[f64; 2]; 8] = [
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
    [-0.5, 0.5],
    [-0.5, 0.0],
    [-0.5, -0.5],
    [0.0, -0.5],
    [0.5, -0.5],
];
const STAR: [[f64; 2]; 6] =
    [[1.0, 0.0], [0.2, 0.3], [-0.6, 0.9], [-0.3, 0.0], [-0.6, -0.9], [0.2, -0.3]];

#[test]
fn meshes_keep_the_area_and_the_corners_of_polygons_however_they_are_turned() {
    for (points, own) in [(&SQUARE[..], 1.0), (&STAR[..], 0.0)] {
        let own =
            if own > 0.0 { own } else { body(points, 0.0, 0.0).shape.moments().unwrap().measure };
        for angle in [0.0, 0.3, 1.1] {
            let body = body(points, 0.2, angle);
            let mesh = generate(&BOX, &[body], &Sizing::graded(0.1, 0.3, 0.6)).unwrap();
            check_mesh(&mesh).unwrap();
            assert!((area(&mesh) - (36.0 - own)).abs() < 1e-11, "{angle}: {}", area(&mesh));
            let quality = Quality::of(&mesh);
            assert!(quality.min_angle > 18.0, "{angle}: {}", quality.min_angle);
            let (sin, cos) = angle.sin_cos();
            for [x, y] in points {
                let corner = Point::<2>::new(0.2 + cos * x - sin * y, sin * x + cos * y);
                assert!(
                    mesh.nodes[..mesh.n_vertices].iter().any(|at| (at - corner).norm() < 1e-12)
                );
            }
            assert!(mesh.cell_ids().all(|cell| !mesh.curved[cell]));
        }
    }
}

/// At corners of the body cells are smaller than along its sides, and they are no smaller in a notch.
#[test]
fn cells_are_small_at_corners() {
    let mesh = generate(&BOX, &[body(&STAR, 0.0, 0.0)], &Sizing::graded(0.1, 0.3, 0.6)).unwrap();
    let shortest_at = |[x, y]: [f64; 2]| {
        let corner = Point::<2>::new(x, y);
        let facets = mesh
            .facets
            .iter()
            .filter(|facet| mesh.boundaries[facet.boundary].kind == BoundaryKind::Body(0));
        let ends = facets.map(|facet| mesh.facet_vertices(facet).map(|node| mesh.nodes[node]));
        let touching = ends.filter(|ends| ends.iter().any(|end| (end - corner).norm() < 1e-12));
        touching.map(|[a, b]| (a - b).norm()).fold(f64::INFINITY, f64::min)
    };
    let (tip, notch) = (shortest_at(STAR[0]), shortest_at(STAR[3]));
    assert!(tip < 0.25 * 0.1 && notch > 0.6 * 0.1, "{tip} {notch}");
}

#[test]
fn the_mesh_around_a_square_is_its_own_mirror_image() {
    let mesh = generate(&BOX, &[body(&SQUARE, 0.3, 0.0)], &Sizing::graded(0.1, 0.3, 0.6)).unwrap();
    for at in &mesh.nodes[..mesh.n_vertices] {
        let image = Point::<2>::new(at.x, -at.y);
        assert!(mesh.nodes[..mesh.n_vertices].contains(&image), "{at}");
    }
}
