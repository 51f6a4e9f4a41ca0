//! Any valid placement of bodies gives a mesh: invariants, angles, area, symmetry, periodicity.

use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

use alewife_mesh::{
    Domain, Mesh, NodeId, PeriodicPair, PlacedShape, Point, Quality, Shape, SizeBox, Sizing,
    check_mesh, check_placement, generate,
};
use proptest::prelude::*;

use super::common::{lobed, placed, square};

/// Smallest angle promised (degrees) in smooth domains with right-angled corners.
const SMALLEST_ANGLE: f64 = 25.0;

fn planar_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.2..1.0).prop_map(|radius| Shape::Disc { radius }),
        (0.3..1.2, 0.1..0.8).prop_map(|(a, b)| Shape::Ellipse { semi_axes: [a, b] }),
        (0.3..0.9, 2..5, 0.0..0.3).prop_map(|(r, lobes, depth)| lobed(r, lobes, depth)),
    ]
}

fn planar_bodies() -> impl Strategy<Value = Vec<PlacedShape>> {
    let one = (planar_shape(), -2.5..2.5, -2.5..2.5, 0.0..TAU);
    prop::collection::vec(one, 1..4).prop_map(|all| {
        let body = |(i, (shape, x, y, angle))| placed(&format!("body{i}"), shape, x, y, angle);
        all.into_iter().enumerate().map(body).collect()
    })
}

fn axial_bodies() -> impl Strategy<Value = Vec<PlacedShape>> {
    let shape = prop_oneof![
        (0.2..1.0).prop_map(|radius| Shape::Sphere { radius }),
        (0.2..1.0, 0.15..1.2).prop_map(|(a, b)| Shape::Spheroid { semi_axes: [a, b] }),
    ];
    prop::collection::vec((shape, -2.8..2.8), 1..4).prop_map(|all| {
        let body = |(i, (shape, x))| placed(&format!("body{i}"), shape, x, 0.0, 0.0);
        all.into_iter().enumerate().map(body).collect()
    })
}

fn planar() -> impl Strategy<Value = (Domain, Vec<PlacedShape>)> {
    let domain = prop_oneof![
        (any::<bool>(), any::<bool>()).prop_map(|(x, y)| square(x, y)),
        Just(Domain::Disc { center: Point::<2>::new(0.1, 0.0), radius: 3.5 }),
    ];
    (domain, planar_bodies())
}

fn axial() -> impl Strategy<Value = (Domain, Vec<PlacedShape>)> {
    let domain = prop_oneof![
        Just(Domain::HalfDisc { center: 0.2, radius: 4.0 }),
        Just(Domain::HalfDisc { center: 0.0, radius: 30.0 }),
        any::<bool>().prop_map(|periodic_x| Domain::Cylinder {
            x: [-4.0, 4.1],
            radius: 1.3,
            periodic_x,
        }),
    ];
    (domain, axial_bodies())
}

fn sizing() -> impl Strategy<Value = Sizing> {
    (0.05..0.3, 0.05..0.35, 0.3..1.5, 2.0..4.0, any::<bool>()).prop_map(
        |(surface, growth, size, gap_layers, curved)| Sizing {
            gap_layers,
            curved,
            ..Sizing::graded(surface, growth, size)
        },
    )
}

/// Everything that is promised of any mesh.
fn assert_mesh(domain: &Domain, bodies: &[PlacedShape], sizing: &Sizing) {
    if check_placement(domain, bodies).is_err() {
        assert!(generate(domain, bodies, sizing).is_err());
        return;
    }
    let mesh = generate(domain, bodies, sizing).expect("a valid placement is meshed");
    check_mesh(&mesh).expect("it is a mesh");
    let quality = Quality::of(&mesh);
    assert!(quality.min_angle > SMALLEST_ANGLE, "{quality}");
    assert!(quality.mean_ratio > 0.9, "{quality}");
    assert!(quality.min_curved_jacobian > 0.1, "{quality}");
    assert_eq!(mesh.curved.iter().any(|c| *c), sizing.curved && !is_polygon(domain, bodies));
    let names: Vec<&str> = mesh.boundaries.iter().map(|b| b.name.as_str()).collect();
    let bodies = bodies.iter().map(|b| b.name.as_str());
    assert_eq!(names, domain.sides().iter().copied().chain(bodies).collect::<Vec<_>>());
    assert_periodic(domain, &mesh);
}

fn is_polygon(domain: &Domain, bodies: &[PlacedShape]) -> bool {
    bodies.is_empty() && matches!(domain, Domain::Box { .. } | Domain::Cylinder { .. })
}

/// Every node of a periodic side appears, apart from its original by a period.
fn assert_periodic(domain: &Domain, mesh: &Mesh<2>) {
    let periods = domain.images();
    let copies: HashSet<NodeId> = mesh.periodic.iter().map(|pair| pair.copy).collect();
    for PeriodicPair { copy, original } in &mesh.periodic {
        let apart = mesh.nodes[*copy] - mesh.nodes[*original];
        assert!(periods.iter().any(|p| (apart - p).norm() < 1e-12 * (1.0 + p.norm())), "{apart}");
        assert!(apart.norm() > 0.1);
    }
    for facet in &mesh.facets {
        let side = facet.boundary.index();
        // The second of each pair of sides is the copy
        if side < domain.sides().len() && side % 2 == 1 && domain.is_periodic(side) {
            assert!(mesh.facet_nodes(facet).all(|node| copies.contains(&node)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        // The same placements in every run: a failure is one of the change, not of chance.
        rng_seed: proptest::test_runner::RngSeed::Fixed(2026),
        ..ProptestConfig::with_cases(96)
    })]

    #[test]
    fn any_valid_planar_placement_gives_a_good_mesh(
        (domain, bodies) in planar(), sizing in sizing(),
    ) {
        assert_mesh(&domain, &bodies, &sizing);
    }

    #[test]
    fn any_valid_axisymmetric_placement_gives_a_good_mesh(
        (domain, bodies) in axial(), sizing in sizing(),
    ) {
        assert_mesh(&domain, &bodies, &sizing);
    }

    /// Two bodies a fraction of their radius apart, down to 0.002.
    #[test]
    fn narrow_gaps_are_meshed_well(
        exponent in 0.5..2.7_f64, radius in 0.3..1.0_f64, angle in 0.0..TAU, layers in 2.0..5.0,
    ) {
        let gap = 10.0_f64.powf(-exponent);
        let far = (0.8 + radius + gap) * Point::<2>::new(angle.cos(), angle.sin());
        let disc = |name, radius, at: Point<2>| placed(name, Shape::Disc { radius }, at.x, at.y, 0.0);
        let bodies = [disc("a", 0.8, Point::<2>::zeros()), disc("b", radius, far)];
        let sizing = Sizing { gap_layers: layers, ..Sizing::graded(0.2, 0.25, 0.6) };
        assert_mesh(&square(false, true), &bodies, &sizing);
        let mirror = [placed("s", Shape::Sphere { radius }, -3.0 + radius + gap, 0.0, 0.0)];
        let tube = Domain::Cylinder { x: [-3.0, 3.0], radius: 2.0, periodic_x: false };
        assert_mesh(&tube, &mirror, &sizing);
    }

    #[test]
    fn the_same_input_gives_the_same_bits((domain, bodies) in planar(), sizing in sizing()) {
        prop_assert_eq!(
            generate(&domain, &bodies, &sizing), generate(&domain, &bodies, &sizing)
        );
    }
}

/// Bodies that are their own image or in pairs about a line, in a domain with sizes that are too.
fn symmetric() -> impl Strategy<Value = (Domain, Vec<PlacedShape>, Sizing, usize, f64)> {
    let on_line = prop::collection::vec((planar_shape_with_axes(), -2.6..2.6), 0..3);
    let pairs = prop::collection::vec((planar_shape(), -2.5..2.5, 0.4..2.5, 0.0..TAU), 0..3);
    let domain = (any::<bool>(), any::<bool>(), any::<bool>());
    (on_line, pairs, domain, sizing(), 0..2usize).prop_map(
        |(on_line, pairs, (is_disc, periodic_x, periodic_y), sizing, axis)| {
            // A line that is no round number
            let at = 0.1 / 3.0;
            let place = |along: f64, off: f64| {
                if axis == 1 { [along, at + off] } else { [at + off, along] }
            };
            let mut bodies = Vec::new();
            for (shape, along) in on_line {
                let [x, y] = place(along, 0.0);
                let angle = if axis == 1 { 0.0 } else { 0.5 * PI };
                bodies.push(placed(&format!("on{}", bodies.len()), shape, x, y, angle));
            }
            for (shape, along, off, angle) in pairs {
                let [x, y] = place(along, off);
                // The image of a shape that is symmetric about its own x axis is turned only
                let image = if axis == 1 { -angle } else { PI - angle };
                bodies.push(placed(&format!("near{}", bodies.len()), shape.clone(), x, y, angle));
                let [x, y] = place(along, -off);
                bodies.push(placed(&format!("far{}", bodies.len()), shape, x, y, image));
            }
            let domain = if is_disc {
                Domain::Disc { center: Point::<2>::from(place(0.1, 0.0)), radius: 3.5 }
            } else {
                let half = Point::<2>::new(3.0, 3.0);
                let center = Point::<2>::from(place(0.0, 0.0));
                Domain::Box { min: center - half, max: center + half, periodic_x, periodic_y }
            };
            let boxed = Point::<2>::new(0.5, 0.7);
            let center = Point::<2>::from(place(0.3, 0.0));
            let wake = SizeBox { min: center - boxed, max: center + boxed, size: 0.2 };
            (domain, bodies, Sizing { boxes: vec![wake], ..sizing }, axis, at)
        },
    )
}

/// Shapes that are symmetric about the x axis of their frame and extreme on it.
fn planar_shape_with_axes() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.2..0.8).prop_map(|radius| Shape::Disc { radius }),
        (0.3..1.0, 0.1..0.8).prop_map(|(a, b)| Shape::Ellipse { semi_axes: [a, b] }),
        (0.3..0.8, 1..3, 0.0..0.3).prop_map(|(r, half, depth)| lobed(r, 2 * half, depth)),
    ]
}

/// Whether the image of every node and cell in a line is there, to the last bit.
fn is_mirror_symmetric(mesh: &Mesh<2>, axis: usize, at: f64) -> bool {
    let reflect = |mut x: Point<2>| {
        x[axis] = 2.0 * at - x[axis];
        x
    };
    // + 0.0 makes one zero of the two
    let bits = |x: Point<2>| [x.x, x.y].map(|x| (x + 0.0).to_bits());
    let nodes: HashSet<[u64; 2]> = mesh.nodes.iter().map(|x| bits(*x)).collect();
    let cell_bits = |nodes: &[Point<2>]| {
        let mut all: Vec<_> = nodes.iter().map(|x| bits(*x)).collect();
        all.sort_unstable();
        all
    };
    let cells: HashSet<_> = mesh.cell_ids().map(|cell| cell_bits(&mesh.cell_nodes(cell))).collect();
    let beyond = |x: &Point<2>| x[axis] >= at;
    let kept: Vec<_> = mesh
        .cell_ids()
        .map(|cell| mesh.cell_nodes(cell))
        .filter(|nodes| nodes.iter().all(beyond))
        .collect();
    mesh.nodes.iter().filter(|x| beyond(x)).all(|x| nodes.contains(&bits(reflect(*x))))
        && 2 * kept.len() == mesh.n_cells()
        && kept.into_iter().all(|nodes| {
            let image: Vec<_> = nodes.iter().map(|x| reflect(*x)).collect();
            cells.contains(&cell_bits(&image))
        })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2027),
        ..ProptestConfig::with_cases(96)
    })]

    #[test]
    fn the_mesh_of_a_symmetric_problem_is_symmetric_to_the_last_bit(
        (domain, bodies, sizing, axis, at) in symmetric(),
    ) {
        assert_mesh(&domain, &bodies, &sizing);
        if let Ok(mesh) = generate(&domain, &bodies, &sizing) {
            let middle = match &domain {
                Domain::Box { min, max, .. } => (min + max) * 0.5,
                Domain::Disc { center, .. } => *center,
                _ => unreachable!("the domain is planar"),
            };
            prop_assert!((middle[axis] - at).abs() < 1e-15);
            // A problem that is symmetric about both axes is meshed about y = const
            let symmetric = is_mirror_symmetric(&mesh, axis, middle[axis])
                || is_mirror_symmetric(&mesh, 1, middle[1]);
            prop_assert!(symmetric);
        }
    }
}

#[test]
fn a_problem_that_is_hardly_asymmetric_is_meshed_as_a_whole() {
    let domain = Domain::Disc { center: Point::<2>::zeros(), radius: 3.0 };
    for (shift, is_symmetric) in [(0.0, true), (1e-9, false)] {
        let body = placed("b", Shape::Ellipse { semi_axes: [1.0, 0.5] }, shift, shift, 0.0);
        let mesh = generate(&domain, &[body], &Sizing::graded(0.1, 0.2, 0.4)).unwrap();
        assert_eq!(is_mirror_symmetric(&mesh, 1, 0.0), is_symmetric);
        assert!(!is_mirror_symmetric(&mesh, 1, 1e-9));
    }
}
