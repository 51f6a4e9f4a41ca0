//! Periodic boxes closed on themselves: bodies anywhere, and sides that match node by node.

use std::f64::consts::{PI, TAU};

use alewife_mesh::{
    Domain, Mesh, PlacedShape, Point, Quality, Shape, Sizing, check_mesh, check_placement,
    check_wrapped_placement, generate_wrapped, whole,
};

use super::common::{self, lobed};

/// Smallest angle promised (degrees).
const SMALLEST_ANGLE: f64 = 25.0;

/// Numbers between 0 and 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn torus(width: f64, height: f64, periodic: [bool; 2]) -> Domain {
    let (min, max) = (Point::<2>::new(-1.0, 0.5), Point::<2>::new(width - 1.0, height + 0.5));
    Domain::Box { min, max, periodic_x: periodic[0], periodic_y: periodic[1] }
}

fn placed(name: String, shape: Shape, center: Point<2>, angle: f64) -> PlacedShape {
    PlacedShape { name, shape, center, angle, size: None }
}

/// Bodies dropped one after the other where there is room, up to a number.
fn crowd(
    domain: &Domain,
    wanted: usize,
    random: &mut Random,
    shape: &dyn Fn(&mut Random) -> Shape,
) -> Vec<PlacedShape> {
    let Domain::Box { min, max, .. } = domain else { unreachable!("a box") };
    let mut bodies: Vec<PlacedShape> = Vec::new();
    for _ in 0..40 * wanted {
        let center = Point::<2>::new(
            min.x + (max.x - min.x) * random.next(),
            min.y + (max.y - min.y) * random.next(),
        );
        let name = format!("body{}", bodies.len());
        bodies.push(placed(name, shape(random), center, TAU * random.next()));
        if check_wrapped_placement(domain, &bodies).is_err() {
            bodies.pop();
        }
        if bodies.len() == wanted {
            break;
        }
    }
    bodies
}

/// Everything that is promised of a mesh of a torus; the quality.
fn assert_closed(domain: &Domain, bodies: &[PlacedShape], sizing: &Sizing) -> Quality {
    let mesh = generate_wrapped(domain, bodies, sizing).expect("the torus is meshed");
    check_mesh(&mesh).expect("it is a mesh");
    assert_pairs(domain, &mesh);
    let quality = Quality::of(&mesh);
    let Domain::Box { min, max, .. } = domain else { unreachable!("a box") };
    let area = (max.x - min.x) * (max.y - min.y) - area_of_bodies(&mesh);
    assert!((mesh.measure() / area - 1.0).abs() < 1e-12, "area {} for {area}", mesh.measure());
    quality
}

/// What the quadratic sides of the bodies enclose, by Simpson's rule, which is exact for them.
fn area_of_bodies(mesh: &Mesh<2>) -> f64 {
    let facets = mesh.facets.iter().filter(|facet| facet.boundary.index() >= 4);
    let cross = |a: Point<2>, b: Point<2>| a.x * b.y - a.y * b.x;
    -facets
        .map(|facet| {
            let nodes: Vec<_> = mesh.facet_nodes(facet).map(|node| mesh.nodes[node]).collect();
            let (a, b, m) = (nodes[0], nodes[1], nodes[2]);
            let at_start = cross(a, m * 4.0 - a * 3.0 - b);
            let at_end = cross(b, b * 3.0 + a - m * 4.0);
            (at_start + 4.0 * cross(m, b - a) + at_end) / 12.0
        })
        .sum::<f64>()
}

/// Copies are copies, and far from their originals.
fn assert_pairs(domain: &Domain, mesh: &Mesh<2>) {
    let periods = Point::<2>::from(domain.periods().map(|period| period.unwrap_or(0.0)));
    common::assert_pairs(mesh, &periods, 1e-12, |side| domain.is_periodic(side));
    for pair in &mesh.periodic {
        assert!((mesh.nodes[pair.copy] - mesh.nodes[pair.original]).norm() > 0.1);
    }
}

#[test]
fn dense_random_placements_on_a_torus_are_meshed() {
    let mut lowest = f64::INFINITY;
    // Each shape with each choice of periodic directions
    for seed in 0..9 {
        let mut random = Random(seed + 7);
        let width = 4.0 + 6.0 * random.next();
        let height = 4.0 + 6.0 * random.next();
        let periodic = [[true, true], [true, false], [false, true]][(seed % 3) as usize];
        let domain = torus(width, height, periodic);
        let wanted = whole(width * height / (1.3 + random.next()) / PI * 1.5);
        let bodies = crowd(&domain, wanted.max(1), &mut random, &|random| match seed / 3 % 3 {
            0 => Shape::Disc { radius: 0.7 },
            1 => Shape::Ellipse { semi_axes: [0.9, 0.3 + 0.3 * random.next()] },
            _ => lobed(0.4 + 0.4 * random.next(), 3, 0.2),
        });
        let crosses = check_placement(&domain, &bodies).is_err();
        let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(0.15, 0.3, 0.6) };
        let quality = assert_closed(&domain, &bodies, &sizing);
        println!("{seed}: {} bodies, across {crosses}, {:.1}", bodies.len(), quality.min_angle);
        lowest = lowest.min(quality.min_angle);
    }
    assert!(lowest > SMALLEST_ANGLE, "{lowest}");
}

/// Rows of discs, every other one moved by half of their distance, which fill a torus.
fn packed(columns: usize, rows: usize, gap: f64) -> (Domain, Vec<PlacedShape>) {
    let (radius, pitch) = (1.0, 2.0 + gap);
    let rise = 0.75_f64.sqrt() * pitch;
    let domain = torus(pitch * columns as f64, rise * rows as f64, [true, true]);
    let disc = |k: usize| {
        let (i, j) = (k % columns, k / columns);
        let x = pitch * (i as f64 + 0.5 * (j % 2) as f64);
        let center = Point::<2>::new(x, rise * j as f64);
        placed(format!("disc{k}"), Shape::Disc { radius }, center, 0.0)
    };
    let bodies = (0..columns * rows).map(disc).collect();
    (domain, bodies)
}

#[test]
fn discs_a_hundredth_of_their_radius_apart_all_around_are_meshed() {
    for (columns, rows, gap) in [(1, 2, 0.01), (2, 2, 0.05), (3, 4, 0.01)] {
        let (domain, bodies) = packed(columns, rows, gap);
        let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(0.2, 0.3, 0.6) };
        let quality = assert_closed(&domain, &bodies, &sizing);
        println!("{columns} x {rows}, gap {gap}: {quality}");
        assert!(quality.min_angle > SMALLEST_ANGLE, "{quality}");
    }
}

/// A row and a column of discs that all but touch and meet in the corner of the box.
#[test]
fn rows_of_discs_that_all_but_touch_are_meshed() {
    let domain = torus(8.0, 8.0, [true, true]);
    let radius = 0.99;
    let at = |k: usize, x: f64, y: f64| {
        placed(format!("disc{k}"), Shape::Disc { radius }, Point::<2>::new(x, y), 0.0)
    };
    // In each one gap of 0.04 among those of 0.0133
    let step = 2.0 * radius + 0.04 / 3.0;
    let mut bodies = vec![at(0, 0.0, 1.0)];
    for k in 1..4 {
        let along = step * k as f64;
        bodies.push(at(2 * k - 1, along, 1.0));
        bodies.push(at(2 * k, 0.0, 1.0 + along));
    }
    let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(0.2, 0.3, 0.6) };
    assert!(assert_closed(&domain, &bodies, &sizing).min_angle > SMALLEST_ANGLE);
}

/// Wherever the sides of the box are, the mesh is the same to rounding.
#[test]
fn the_mesh_moves_along_with_its_bodies() {
    let domain = torus(5.0, 4.0, [true, true]);
    let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(0.15, 0.3, 0.6) };
    let bodies = crowd(&domain, 4, &mut Random(5), &|_| Shape::Ellipse { semi_axes: [0.9, 0.4] });
    let first = generate_wrapped(&domain, &bodies, &sizing).expect("a mesh");
    for [x, y] in [[2.5, 2.0], [0.7, -1.1]] {
        let mut moved = bodies.clone();
        for body in &mut moved {
            body.center.x = -1.0 + (body.center.x + 1.0 + x).rem_euclid(5.0);
            body.center.y = 0.5 + (body.center.y - 0.5 + y).rem_euclid(4.0);
        }
        let mesh = generate_wrapped(&domain, &moved, &sizing).expect("a mesh");
        let [one, other] = [&first, &mesh].map(|mesh| {
            let mut qualities: Vec<f64> =
                mesh.cell_ids().map(|cell| mesh.cell_quality(cell)).collect();
            qualities.sort_by(f64::total_cmp);
            qualities
        });
        assert_eq!(one.len(), other.len());
        let farthest = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(farthest < 1e-9, "{farthest:e}");
    }
}

#[test]
fn discs_on_the_corner_of_a_box_and_alone_in_a_row_are_meshed() {
    let sizing = Sizing::graded(0.1, 0.3, 0.6);
    for (width, periodic, radius) in
        [(4.0, [true, true], 1.0), (2.1, [true, true], 1.0), (4.0, [true, false], 0.4)]
    {
        let domain = torus(width, 4.0, periodic);
        for (x, y) in [(-1.0, 0.5), (-0.2, 0.5), (1.0, 2.5)] {
            let y = if periodic[1] { y } else { 2.4 };
            let body = placed("b".into(), Shape::Disc { radius }, Point::<2>::new(x, y), 0.0);
            let quality = assert_closed(&domain, &[body], &sizing);
            assert!(quality.min_angle > SMALLEST_ANGLE, "{quality}");
        }
    }
}

/// A mirror-symmetric problem whose bodies lie across the sides along the line of symmetry.
#[test]
fn the_mesh_of_a_symmetric_torus_is_symmetric_to_the_last_bit() {
    let (min, max) = (Point::<2>::new(0.0, -1.5), Point::<2>::new(4.0, 1.5));
    let disc = |name: &str, x: f64, y: f64| {
        placed(name.into(), Shape::Disc { radius: 0.4 }, Point::<2>::new(x, y), 0.0)
    };
    let bodies = [
        disc("a", 3.9, 0.0),
        disc("b", 2.5, 0.0),
        disc("above", 0.8, 0.9),
        disc("below", 0.8, -0.9),
    ];
    for (periodic_y, bodies) in [(false, &bodies[..1]), (false, &bodies), (true, &bodies)] {
        let domain = Domain::Box { min, max, periodic_x: true, periodic_y };
        let mesh = generate_wrapped(&domain, bodies, &Sizing::graded(0.1, 0.3, 0.4)).unwrap();
        check_mesh(&mesh).expect("it is a mesh");
        assert_pairs(&domain, &mesh);
        let key = |node: &Point<2>, sign: f64| (node.x.to_bits(), (sign * node.y + 0.0).to_bits());
        let [mut nodes, mut images] =
            [1.0, -1.0].map(|sign| mesh.nodes.iter().map(|n| key(n, sign)).collect::<Vec<_>>());
        nodes.sort_unstable();
        images.sort_unstable();
        assert_eq!(nodes, images);
        let area = 12.0 - area_of_bodies(&mesh);
        assert!((mesh.measure() / area - 1.0).abs() < 1e-12);
        assert!(Quality::of(&mesh).min_angle > SMALLEST_ANGLE);
    }
}

#[test]
fn spheres_lie_across_the_ends_of_a_periodic_cylinder() {
    let domain = Domain::Cylinder { x: [0.0, 6.0], radius: 1.5, periodic_x: true };
    let sphere = |name: &str, x: f64| {
        placed(name.into(), Shape::Sphere { radius: 1.0 }, Point::<2>::new(x, 0.0), 0.0)
    };
    let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(0.15, 0.3, 0.6) };
    let pair = [sphere("t", 2.9), sphere("s", 0.2)];
    for bodies in [&pair[1..], &pair, &[sphere("s", 5.9)]] {
        let mesh = generate_wrapped(&domain, bodies, &sizing).expect("it is meshed");
        check_mesh(&mesh).expect("it is a mesh");
        assert_pairs(&domain, &mesh);
        let quality = Quality::of(&mesh);
        assert!(quality.min_angle > SMALLEST_ANGLE, "{quality}");
        let area = 9.0 - 0.5 * PI * bodies.len() as f64;
        assert!((mesh.measure() / area - 1.0).abs() < 1e-4, "{} for {area}", mesh.measure());
    }
}

#[test]
fn bodies_that_overlap_an_image_are_refused() {
    let domain = torus(4.0, 4.0, [true, true]);
    let disc = |name: &str, x: f64, radius: f64| {
        placed(name.into(), Shape::Disc { radius }, Point::<2>::new(x, 2.0), 0.0)
    };
    let sizing = Sizing::graded(0.2, 0.3, 0.6);
    assert!(generate_wrapped(&domain, &[disc("large", 1.0, 2.01)], &sizing).is_err());
    let pair = [disc("a", -0.9, 0.5), disc("b", 2.5, 0.2)];
    assert!(check_wrapped_placement(&domain, &pair).is_err());
    assert!(check_placement(&domain, &pair).is_err());
    let apart = [disc("a", -0.9, 0.5), disc("b", 2.3, 0.2)];
    assert!(check_wrapped_placement(&domain, &apart).is_ok());
    let walled = torus(4.0, 4.0, [false, true]);
    assert!(check_wrapped_placement(&walled, &apart[..1]).is_err());
}
