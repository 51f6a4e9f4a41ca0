//! Boxes with periodic sides: opposite facets match node by node, and cells are as good as elsewhere.

use std::collections::BTreeMap;

use alewife_mesh::spatial::{Body, Domain, Shape, SizeField, check_placement, generate};
use alewife_mesh::{Mesh, MeshError, NodeId, Point, Quality, SizeBox, Sizing};

use super::{SMALLEST_ANGLE, assert_mesh, at, sizing, sphere};

fn periodic_box(min: Point<3>, max: Point<3>, periodic: [bool; 3]) -> Domain {
    Domain::Box { min, max, periodic, symmetric: [false; 6] }
}

fn unit_box(periodic: [bool; 3]) -> Domain {
    periodic_box(Point::<3>::repeat(-0.5), Point::<3>::repeat(0.5), periodic)
}

/// Every node on a side with the largest coordinate is the copy of that apart from it by the periods, and
/// no other node is one.
fn assert_pairs(mesh: &Mesh<3>, domain: &Domain) {
    let [_, max] = domain.corners();
    let periods = domain.periods();
    let rounding = 1e-13 * (max.amax() + periods.amax());
    let original: BTreeMap<NodeId, NodeId> =
        mesh.periodic.iter().map(|pair| (pair.copy, pair.original)).collect();
    assert_eq!(original.len(), mesh.periodic.len());
    for node in mesh.node_ids() {
        let here = mesh.nodes[node];
        let shift = Point::<3>::from_fn(|axis, _| {
            let is_on = periods[axis] > 0.0 && (here[axis] - max[axis]).abs() < rounding;
            if is_on { periods[axis] } else { 0.0 }
        });
        match original.get(&node) {
            Some(original) => {
                assert!(
                    shift.amax() > 0.0 && (here - shift - mesh.nodes[*original]).amax() < rounding
                );
            }
            None => assert_eq!(shift.amax(), 0.0, "{here} has no original"),
        }
    }
    assert!(original.values().all(|node| !original.contains_key(node)));
}

fn check(domain: &Domain, bodies: &[Body], sizing: &Sizing<3>) -> Mesh<3> {
    let mesh = generate(domain, bodies, sizing).unwrap_or_else(|error| panic!("{error}"));
    println!("{} cells, {}", mesh.n_cells(), Quality::of(&mesh));
    assert_mesh(&mesh, domain, bodies, SMALLEST_ANGLE);
    assert_pairs(&mesh, domain);
    mesh
}

#[test]
fn opposite_sides_match_around_a_sphere() {
    let volume = 1.0 - 4.0 / 3.0 * std::f64::consts::PI * 0.027;
    for periodic in [[true, false, false], [false, true, true], [true; 3]] {
        let bodies = [sphere("s", 0.3, at(0.1, -0.05, 0.15))];
        let mesh = check(&unit_box(periodic), &bodies, &sizing(0.08, 0.2));
        assert!((mesh.measure() / volume - 1.0).abs() < 3e-5, "{} {volume}", mesh.measure());
        assert_eq!(mesh, check(&unit_box(periodic), &bodies, &sizing(0.08, 0.2)));
    }
}

/// Eight corners are one point, and so are four points of edges.
#[test]
fn corners_and_edges_are_identified() {
    for (periodic, at_corner, at_edge) in [([true, true, false], 4, 4), ([true; 3], 8, 4)] {
        let domain =
            periodic_box(Point::<3>::new(0.0, -1.0, 2.0), Point::<3>::new(1.0, 0.3, 2.9), periodic);
        let mesh = check(&domain, &[], &sizing(0.2, 0.2));
        let mut images: BTreeMap<NodeId, usize> = BTreeMap::new();
        for pair in &mesh.periodic {
            *images.entry(pair.original).or_insert(1) += 1;
        }
        let [min, _] = domain.corners();
        for (original, n) in images {
            let here = mesh.nodes[original];
            let n_sides =
                (0..3).filter(|axis| periodic[*axis] && here[*axis] == min[*axis]).count();
            assert_eq!(n, 1 << n_sides);
            let on_sides = (0..3).filter(|axis| here[*axis] == min[*axis]).count();
            assert!(on_sides < 3 || n == at_corner);
            assert!(n_sides != 2 || n == at_edge);
        }
    }
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
fn bodies_stay_inside_of_periodic_sides() {
    let crossing = [sphere("s", 0.3, at(0.0, 0.0, 0.3))];
    match check_placement(&unit_box([false, false, true]), &crossing) {
        Err(MeshError::BodyMeetsPeriodicSide { body, side, gap, .. }) => {
            assert_eq!((body.as_str(), &*side), ("s", "front"));
            assert!(gap < 0.0);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn narrow_gaps_to_images_are_meshed() {
    for gap in [0.13, 0.06] {
        let bodies = [sphere("s", 0.5 * (1.0 - gap), at(0.0, 0.0, 0.0))];
        check(&unit_box([true; 3]), &bodies, &sizing(0.1, 0.2));
    }
}

#[test]
fn random_bodies_in_periodic_boxes_give_good_meshes() {
    for seed in 0_u32..16 {
        let part = |k: f64| (0.618_034 * k * f64::from(seed + 1)).fract();
        let periodic = [[true; 3], [true, true, false], [false, true, false]][seed as usize % 3];
        let max = Point::<3>::new(1.0 + part(3.0), 1.0 + 2.0 * part(5.0), 1.0);
        let domain = periodic_box(Point::<3>::zeros(), max, periodic);
        let turn = nalgebra::UnitQuaternion::from_euler_angles(part(2.0), part(4.0), part(8.0));
        let semi_axes = [0.15 + 0.25 * part(11.0), 0.2, 0.1 + 0.1 * part(13.0)];
        let center = Point::<3>::new(part(17.0), part(19.0), part(23.0));
        let reach = 0.43;
        let center = center.component_mul(&max.add_scalar(-2.0 * reach)).add_scalar(reach);
        let pose = at(center.x, center.y, center.z) * turn;
        let bodies = [Body::new("e", Shape::Ellipsoid { semi_axes }, pose)];
        println!("seed {seed}");
        check(&domain, &bodies, &sizing(0.07, 0.25));
    }
}
