//! Domains and bodies that several tests mesh.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use alewife_mesh::{Domain, Facet, Mesh, NodeId, PlacedShape, Point, Shape};

/// A shape at a place.
pub fn placed(name: &str, shape: Shape, x: f64, y: f64, angle: f64) -> PlacedShape {
    PlacedShape { name: name.into(), shape, center: Point::<2>::new(x, y), angle, size: None }
}

/// A star-shaped curve with lobes, through 20 points.
pub fn lobed(radius: f64, lobes: i32, depth: f64) -> Shape {
    let points = (0..20).map(|i| TAU * f64::from(i) / 20.0).map(|t| {
        let r = radius * (1.0 + depth * (f64::from(lobes) * t).cos());
        [r * t.cos(), r * t.sin()]
    });
    Shape::Spline { points: points.collect() }
}

/// A rectangle around the origin.
pub fn square(periodic_x: bool, periodic_y: bool) -> Domain {
    let (min, max) = (Point::<2>::new(-3.0, -3.0), Point::<2>::new(3.0, 3.2));
    Domain::Box { min, max, periodic_x, periodic_y }
}

/// Nodes are whole periods (m; 0 along other axes) from their originals, to rounding (m), and each facet on a periodic side
/// is that of its image on the opposite side.
pub fn assert_pairs<const D: usize>(
    mesh: &Mesh<D>,
    periods: &Point<D>,
    rounding: f64,
    is_periodic: impl Fn(usize) -> bool,
) {
    let original: BTreeMap<NodeId, NodeId> =
        mesh.periodic.iter().map(|pair| (pair.copy, pair.original)).collect();
    assert_eq!(original.len(), mesh.periodic.len());
    for (copy, original) in &original {
        let away = mesh.nodes[*copy] - mesh.nodes[*original];
        for axis in 0..D {
            let step = if periods[axis] > 0.0 { (away[axis] / periods[axis]).round() } else { 0.0 };
            assert!((away[axis] - step * periods[axis]).abs() < rounding, "{away}");
        }
    }
    assert!(original.values().all(|node| !original.contains_key(node)));
    let mut sides: BTreeMap<Vec<NodeId>, Vec<usize>> = BTreeMap::new();
    let on_periodic_side =
        |facet: &&Facet| facet.boundary.index() < 2 * D && is_periodic(facet.boundary.index());
    for facet in mesh.facets.iter().filter(on_periodic_side) {
        let nodes = mesh.facet_nodes(facet);
        let mut nodes: Vec<NodeId> =
            nodes.map(|node| *original.get(&node).unwrap_or(&node)).collect();
        nodes.sort_unstable();
        sides.entry(nodes).or_default().push(facet.boundary.index());
    }
    for pair in sides.values() {
        assert!(matches!(pair[..], [one, other] if one == other ^ 1), "{pair:?}");
    }
}
