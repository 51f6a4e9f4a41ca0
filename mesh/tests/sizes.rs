//! Sizes of cells are those asked for, and nodes lie on the exact curves.

use std::f64::consts::PI;

use alewife_mesh::{
    CellId, Domain, Locator, Mesh, PlacedShape, Point, Shape, SizeBox, SizeField, Sizing, generate,
};

use super::common::{lobed, placed, square};

/// Area of the meshes for halved surface sizes: error against the number of edges on the body.
fn area_order(body: PlacedShape, exact: f64, curved: bool) -> f64 {
    let study = |surface: f64| {
        let sizing = Sizing { curved, ..Sizing::graded(surface, 0.3, 0.5) };
        let mesh = generate(&square(false, false), std::slice::from_ref(&body), &sizing)
            .expect("is meshed");
        let n = mesh.facets.iter().filter(|f| f.boundary.index() == 4).count() as f64;
        (n, (mesh.measure() - (6.0 * 6.2 - exact)).abs())
    };
    let [(n0, e0), (n1, e1)] = [0.1, 0.025].map(study);
    (e0 / e1).ln() / (n1 / n0).ln()
}

#[test]
fn the_area_is_of_fourth_order_with_curved_sides_and_of_second_with_straight_ones() {
    let shapes =
        [Shape::Disc { radius: 0.8 }, Shape::Ellipse { semi_axes: [1.5, 0.5] }, lobed(1.0, 3, 0.2)];
    for shape in shapes {
        let exact = shape.moments().unwrap().measure;
        for (curved, expected) in [(true, 4.0), (false, 2.0)] {
            let order = area_order(placed("b", shape.clone(), 0.2, 0.1, 0.3), exact, curved);
            // Between coarse and fine a spline may still converge a little faster
            assert!(
                (-0.2..0.4).contains(&(order - expected)),
                "{shape:?}: order {order}, not {expected}"
            );
        }
    }
}

/// Nodes on the boundary with this name.
fn boundary_nodes(mesh: &Mesh<2>, name: &str) -> Vec<Point<2>> {
    let index = mesh.boundaries.iter().position(|b| b.name == name).expect("exists");
    let facets = mesh.facets.iter().filter(|f| f.boundary.index() == index);
    facets.flat_map(|f| mesh.facet_nodes(f).map(|node| mesh.nodes[node])).collect()
}

#[test]
fn surface_nodes_are_mirror_symmetric_and_contain_the_extreme_points() {
    let tube = Domain::Cylinder { x: [-4.0, 4.0], radius: 2.0, periodic_x: false };
    let body = placed("s", Shape::Spheroid { semi_axes: [1.1, 0.7] }, 0.0, 0.0, 0.0);
    let mesh = generate(&tube, &[body], &Sizing::graded(0.1, 0.2, 0.4)).unwrap();
    let has = |nodes: &[Point<2>], x: Point<2>| nodes.iter().any(|n| (n - x).norm() < 1e-12);
    let nodes = boundary_nodes(&mesh, "s");
    for [x, y] in [[1.1, 0.0], [0.0, 0.7], [-1.1, 0.0]] {
        assert!(nodes.contains(&Point::<2>::new(x, y)), "({x}, {y}) is a vertex exactly");
    }
    assert!(nodes.iter().all(|n| has(&nodes, Point::<2>::new(-n.x, n.y))));

    let ellipse = placed("e", Shape::Ellipse { semi_axes: [1.3, 0.4] }, 0.0, 0.1, 0.0);
    let mesh = generate(&square(false, false), &[ellipse], &Sizing::graded(0.1, 0.2, 0.4)).unwrap();
    let nodes = boundary_nodes(&mesh, "e");
    for (sx, sy) in [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        assert!(
            nodes.iter().all(|n| has(&nodes, Point::<2>::new(sx * n.x, 0.1 + sy * (n.y - 0.1))))
        );
    }
}

#[test]
fn mid_nodes_halve_the_arc_of_the_exact_curve() {
    let body = placed("b", Shape::Disc { radius: 0.7 }, 0.3, 0.1, 0.0);
    let mesh = generate(&square(false, false), &[body], &Sizing::graded(0.2, 0.3, 0.5)).unwrap();
    let center = Point::<2>::new(0.3, 0.1);
    for facet in mesh.facets.iter().filter(|f| f.boundary.index() == 4) {
        let nodes: Vec<_> = mesh.facet_nodes(facet).map(|node| mesh.nodes[node] - center).collect();
        assert!(nodes.iter().all(|x| (x.norm() - 0.7).abs() < 1e-14));
        assert!(((nodes[2] - nodes[0]).norm() - (nodes[1] - nodes[2]).norm()).abs() < 1e-14);
    }
}

#[test]
fn edges_follow_the_size_field_in_boxes_gaps_and_on_named_sides() {
    let domain = square(false, false);
    let body = placed("b", Shape::Disc { radius: 0.5 }, 0.0, 0.0, 0.0);
    let wake =
        SizeBox { min: Point::<2>::new(0.5, -0.3), max: Point::<2>::new(2.0, 0.3), size: 0.05 };
    let sizing = Sizing {
        boxes: vec![wake],
        sides: vec![("top".into(), 0.1)],
        ..Sizing::graded(0.1, 0.2, 0.5)
    };
    let sizes = SizeField::new(&domain, std::slice::from_ref(&body), &sizing).unwrap();
    let mesh = generate(&domain, &[body], &sizing).unwrap();
    let mut outside = 0;
    for cell in mesh.cell_ids() {
        for edge in mesh.cell_edges(cell) {
            let [a, b] = edge.ends.map(|vertex| mesh.nodes[vertex]);
            let relative = (b - a).norm() / sizes.at((a + b) * 0.5);
            assert!((0.4..2.0).contains(&relative), "{relative}");
            outside += usize::from(!(0.6..1.5).contains(&relative));
        }
    }
    assert!(outside * 100 < 3 * mesh.n_cells(), "{outside} edges of {} cells", mesh.n_cells());
}

/// On the shortest way across a gap lie about as many cells as layers asked for.
#[test]
fn gaps_hold_the_layers_asked_for() {
    let tube = Domain::Cylinder { x: [-3.0, 3.0], radius: 2.0, periodic_x: false };
    for gap in [0.2, 0.05, 0.005] {
        for layers in [2.0, 3.0, 4.0, 6.0] {
            let body = placed("s", Shape::Sphere { radius: 1.0 }, -2.0 + gap, 0.0, 0.0);
            let sizing = Sizing { gap_layers: layers, ..Sizing::graded(0.2, 0.2, 0.6) };
            let mesh = generate(&tube, &[body], &sizing).expect("is meshed");
            let locator = Locator::new(&mesh);
            // A little off the axis, so that the line does not follow its edges
            let height = 0.4 * gap / layers;
            let across = |i: i32| Point::<2>::new(-3.0 + gap * f64::from(i) / 400.0, height);
            let cells: std::collections::BTreeSet<CellId> = (0..400)
                .filter_map(|i| locator.locate(across(i)).map(|found| found.cell))
                .collect();
            assert!(cells.len() as f64 >= layers, "gap {gap}: {} of {layers}", cells.len());
            let axis = mesh.facets.iter().filter(|f| {
                let middle = mesh.facet_inner_nodes(f).next().expect("one inner node");
                f.boundary.index() == 3 && mesh.nodes[middle].x < -3.0 + gap
            });
            let n = axis.count() as f64;
            assert!((layers - 0.5..layers + 1.5).contains(&n), "{n} edges of {layers}");
        }
    }
}

/// A sphere in a ball ten thousand times larger costs a few thousand cells, since h grows with
/// distance: about 2π / (√3/4 growth²) cells per factor e of distance in the half plane over two.
#[test]
fn a_very_large_domain_is_cheap() {
    let half = Domain::HalfDisc { center: 0.0, radius: 1e4 };
    let sphere = placed("s", Shape::Sphere { radius: 1.0 }, 0.0, 0.0, 0.0);
    let mesh = generate(&half, &[sphere], &Sizing::graded(0.05, 0.2, 1e4)).unwrap();
    assert!(mesh.n_cells() < 4000, "{}", mesh.n_cells());
    let exact = 0.5 * PI * (1e8 - 1.0);
    assert!((mesh.measure() / exact - 1.0).abs() < 1e-4);
}
