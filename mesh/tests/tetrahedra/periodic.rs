//! Boxes with periodic sides: bodies anywhere, facets that match node by node, and cells as good as elsewhere.

use alewife_mesh::spatial::{Body, Domain, Shape, SizeField, check_placement, generate};
use alewife_mesh::{Mesh, MeshError, NodeId, Point, Quality, SizeBox, Sizing};

use super::random::random_crowd;
use super::{SMALLEST_ANGLE, assert_mesh, at, sizing, sphere};
use crate::common;

fn periodic_box(min: Point<3>, max: Point<3>, periodic: [bool; 3]) -> Domain {
    Domain::Box { min, max, periodic, symmetric: [false; 6] }
}

fn unit_box(periodic: [bool; 3]) -> Domain {
    periodic_box(Point::<3>::repeat(-0.5), Point::<3>::repeat(0.5), periodic)
}

fn assert_pairs(mesh: &Mesh<3>, domain: &Domain) {
    let [_, max] = domain.corners();
    let periods = domain.periods();
    let rounding = 1e-13 * (max.amax() + periods.amax());
    common::assert_pairs(mesh, &periods, rounding, |side| domain.is_periodic(side));
}

fn check(domain: &Domain, bodies: &[Body], sizing: &Sizing<3>) -> Mesh<3> {
    let mesh = generate(domain, bodies, sizing).unwrap_or_else(|error| panic!("{error}"));
    println!("{} cells, {}", mesh.n_cells(), Quality::of(&mesh));
    assert_mesh(&mesh, domain, bodies, SMALLEST_ANGLE);
    assert_pairs(&mesh, domain);
    mesh
}

const BALL: f64 = 4.0 / 3.0 * std::f64::consts::PI;

#[test]
fn a_sphere_may_be_anywhere_in_a_periodic_box() {
    let volume = 1.0 - BALL * 0.027;
    for periodic in [[true, false, false], [false, true, true], [true; 3]] {
        for [x, y, z] in [[0.1, -0.05, 0.15], [0.45, 0.5, -0.4], [0.5; 3], [0.2, -0.5, 0.1]] {
            let along = |axis: usize, x: f64| if periodic[axis] { x } else { 0.3 * x };
            let bodies = [sphere("s", 0.3, at(along(0, x), along(1, y), along(2, z)))];
            let mesh = check(&unit_box(periodic), &bodies, &sizing(0.08, 0.2));
            assert!((mesh.measure() / volume - 1.0).abs() < 3e-5, "{} {volume}", mesh.measure());
            if periodic == [true; 3] && x == 0.5 {
                // Across a corner, the same again
                assert_eq!(mesh, check(&unit_box(periodic), &bodies, &sizing(0.08, 0.2)));
            }
        }
    }
}

#[test]
fn a_box_without_bodies_closes() {
    for periodic in [[true, true, false], [true; 3]] {
        let domain =
            periodic_box(Point::<3>::new(0.0, -1.0, 2.0), Point::<3>::new(1.0, 0.3, 2.9), periodic);
        let mesh = check(&domain, &[], &sizing(0.2, 0.2));
        assert!((mesh.measure() / (1.3 * 0.9) - 1.0).abs() < 1e-13);
        // Vertices - edges + faces - cells of a product of circles is 0, that of a slab of it, too
        let n_vertices = mesh.n_vertices - count(&mesh, |node| node.index() < mesh.n_vertices);
        let n_edges =
            mesh.n_nodes() - mesh.n_vertices - count(&mesh, |node| node.index() >= mesh.n_vertices);
        let n_walls = super::walls(&mesh).count();
        let n_faces = (4 * mesh.n_cells() + n_walls) / 2;
        assert_eq!(n_vertices + n_faces, n_edges + mesh.n_cells());
    }
}

fn count(mesh: &Mesh<3>, is_one: impl Fn(NodeId) -> bool) -> usize {
    mesh.periodic.iter().filter(|pair| is_one(pair.copy)).count()
}

/// Bodies and boxes of sizes are felt through the sides.
#[test]
fn sizes_are_periodic() {
    let domain = periodic_box(Point::<3>::zeros(), Point::<3>::new(2.0, 1.0, 1.5), [true; 3]);
    let bodies = [sphere("s", 0.2, at(0.3, 0.5, 1.2)), sphere("t", 0.1, at(1.5, 0.2, 0.2))];
    let wake = SizeBox { min: Point::<3>::repeat(0.8), max: Point::<3>::repeat(1.0), size: 0.03 };
    let asked =
        Sizing { boxes: vec![wake], sides: vec![("top".to_owned(), 0.05)], ..sizing(0.05, 0.3) };
    let sizes = SizeField::new(&domain, &bodies, &asked).unwrap();
    let part = |i: u32, k: f64| (0.618_034 * k * f64::from(i + 1)).fract();
    for i in 0..400 {
        let on = Point::<3>::new(2.0 * part(i, 1.0), part(i, 7.0), 1.5 * part(i, 31.0));
        for axis in 0..3 {
            let [mut one, mut other] = [on; 2];
            one[axis] = 0.0;
            other[axis] = domain.periods()[axis];
            assert!((sizes.at(one) - sizes.at(other)).abs() < 1e-14, "{one}");
        }
    }
    check(&domain, &bodies, &asked);
}

#[test]
fn a_body_that_meets_its_image_is_refused() {
    let long = |half: f64, turn: f64| {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, turn);
        let shape = Shape::Ellipsoid { semi_axes: [half, 0.1, 0.1] };
        Body::new("s", shape, at(0.2, 0.0, 0.3) * turn)
    };
    let check = |body| check_placement(&unit_box([true; 3]), &[body]);
    match check(long(0.51, 0.0)) {
        Err(MeshError::BodyMeetsImage { body, gap, .. }) => {
            assert!(body == "s" && gap < 0.0);
        }
        other => panic!("{other:?}"),
    }
    assert!(check(long(0.49, 0.0)).is_ok());
    // Past its images
    assert!(check(long(0.6, 0.46)).is_ok());
    let pair = [sphere("s", 0.2, at(0.4, 0.0, 0.0)), sphere("t", 0.2, at(-0.3, 0.1, 0.0))];
    let met = check_placement(&unit_box([true; 3]), &pair);
    assert!(matches!(met, Err(MeshError::BodiesMeet { .. })));
}

#[test]
fn a_body_longer_than_half_a_period_passes_its_images() {
    for (half, turn) in [(0.45, 0.0), (0.6, 0.46)] {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, turn);
        let shape = Shape::Ellipsoid { semi_axes: [half, 0.1, 0.1] };
        let bodies = [Body::new("s", shape, at(0.2, 0.0, 0.3) * turn)];
        let mesh = check(&unit_box([true; 3]), &bodies, &sizing(0.05, 0.15));
        let volume = 1.0 - BALL * half * 0.01;
        assert!((mesh.measure() / volume - 1.0).abs() < 3e-5, "{} {volume}", mesh.measure());
    }
}

#[test]
fn narrow_gaps_to_images_are_meshed() {
    for gap in [0.13, 0.06, 0.02] {
        let bodies = [sphere("s", 0.5 * (1.0 - gap), at(0.1, 0.3, 0.5))];
        check(&unit_box([true; 3]), &bodies, &sizing(0.1, 0.2));
    }
}

fn check_random_bodies(seeds: std::ops::Range<u32>) {
    for seed in seeds {
        let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract();
        let periodic = [[true; 3], [true, true, false], [false, true, false]][seed as usize % 3];
        let max = Point::<3>::new(1.0 + part(3.0), 1.0 + 2.0 * part(5.0), 1.0);
        let domain = periodic_box(Point::<3>::zeros(), max, periodic);
        let turn = nalgebra::UnitQuaternion::from_euler_angles(part(2.0), part(4.0), part(8.0));
        let semi_axes = [0.15 + 0.25 * part(11.0), 0.2, 0.1 + 0.1 * part(13.0)];
        let along = Point::<3>::new(part(17.0), part(19.0), part(23.0));
        let center = Point::<3>::from_fn(|axis, _| {
            let reach = if periodic[axis] { 0.0 } else { 0.43 };
            reach + along[axis] * (max[axis] - 2.0 * reach)
        });
        let pose = at(center.x, center.y, center.z) * turn;
        let bodies = [Body::new("e", Shape::Ellipsoid { semi_axes }, pose)];
        println!("seed {seed}");
        check(&domain, &bodies, &sizing(0.07, 0.25));
    }
}

#[test]
fn random_bodies_in_periodic_boxes_give_good_meshes() {
    check_random_bodies(0..3);
}

#[test]
#[ignore = "long: two minutes; small: random_bodies_in_periodic_boxes_give_good_meshes"]
fn many_random_bodies_in_periodic_boxes_give_good_meshes() {
    check_random_bodies(3..64);
}

fn check_crowds(seeds: std::ops::Range<u64>) {
    let mut failed = Vec::new();
    for seed in seeds {
        let (domain, bodies) = random_crowd(seed);
        println!("seed {seed}: {} bodies", bodies.len());
        let is_good = std::panic::catch_unwind(|| check(&domain, &bodies, &sizing(0.22, 0.5)));
        if is_good.is_err() {
            failed.push(seed);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn crowds_anywhere_in_periodic_boxes_give_good_meshes() {
    check_crowds(0..1);
}

#[test]
#[ignore = "long: half an hour; small: crowds_anywhere_in_periodic_boxes_give_good_meshes"]
fn many_crowds_in_periodic_boxes_give_good_meshes() {
    check_crowds(1..4);
    check_crowds(1000..1500);
}
