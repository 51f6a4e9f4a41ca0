//! Patch tests: a strain that is the same everywhere is found exactly, on any mesh.

use alewife_mesh::Point;
use alewife_solid::material::Law;
use alewife_solid::solid::{Frame, Minimiser, Order, Potential, Solid, SolidMesh};

use crate::meshes::{all_of, cube, material, moved, solid, square, surface};

const LAWS: [Law; 4] =
    [Law::SaintVenantKirchhoff, Law::NeoHookean, Law::Corotated, Law::CorotatedVolume];

/// The largest error of a state that is sought from places a little beside `exact`, where its surface is.
fn error<const D: usize>(solid: &Solid<D>, exact: &[f64]) -> f64 {
    let beside = exact.iter().enumerate().map(|(i, x)| x + 0.02 * (i as f64).sin());
    let mut start: Vec<f64> = beside.collect();
    for component in &solid.spec().held {
        start[*component] = exact[*component];
    }
    let none = vec![0.0; start.len()];
    let potential = Potential::at_rest(solid, &[], &none);
    let minimum = Minimiser::with_tolerance(1e-12)
        .minimise(&potential, &start)
        .expect("there is an equilibrium");
    let differences = minimum.places.iter().zip(exact).map(|(x, y)| (x - y).abs());
    differences.fold(0.0, f64::max)
}

fn with_held_surface<const D: usize>(mesh: SolidMesh<D>, frame: Frame, law: Law) -> Solid<D> {
    let held = all_of::<D>(&surface(&mesh));
    solid(mesh, frame, material(law, 1e5, 0.3), held)
}

#[test]
fn a_linear_deformation_of_the_surface_is_one_of_the_inside() {
    let uneven = |s: f64, t: f64| Point::from([s + 0.08 * (7.0 * t).sin() * s * (1.0 - s), t]);
    let plane = |x: &Point<2>| Point::from([1.1 * x[0] + 0.2 * x[1], -0.1 * x[0] + 0.95 * x[1]]);
    let space = |x: &Point<3>| {
        Point::from([
            1.1 * x[0] + 0.2 * x[1],
            -0.1 * x[0] + 0.95 * x[1] + 0.1 * x[2],
            1.05 * x[2] - 0.1 * x[1],
        ])
    };
    for law in LAWS {
        for order in [Order::Linear, Order::Quadratic] {
            let mesh = square([4, 4], order, uneven);
            let exact = moved(&mesh, plane);
            let found = error(&with_held_surface(mesh, Frame::Plane, law), &exact);
            assert!(found < 1e-9, "{law:?} {order:?} {found}");
            let mesh =
                cube([3, 3, 3], order, |x| x + Point::from([0.05 * (5.0 * x[1]).sin(), 0.0, 0.0]));
            let exact = moved(&mesh, space);
            let found = error(&with_held_surface(mesh, Frame::Space, law), &exact);
            assert!(found < 1e-9, "{law:?} {order:?} {found}");
        }
    }
}

fn is_inside_of_axis(x: &Point<2>) -> bool {
    x[1] == 0.0 && x[0] > 0.0 && x[0] < 1.0
}

#[test]
fn around_the_axis_a_body_stretches_evenly() {
    // With the axis as a free side: its nodes stay on it by themselves
    for law in LAWS {
        for order in [Order::Linear, Order::Quadratic] {
            let mesh = square([4, 4], order, |s, t| Point::from([s + 0.1 * s * (1.0 - s) * t, t]));
            let exact = moved(&mesh, |x| Point::from([1.1 * x[0], 0.93 * x[1]]));
            let outside: Vec<usize> = surface(&mesh);
            let outside: Vec<usize> =
                outside.into_iter().filter(|n| !is_inside_of_axis(&mesh.nodes[*n])).collect();
            let mut held = all_of::<2>(&outside);
            held.extend(mesh.nodes_where(|x| x[1] == 0.0).iter().map(|node| 2 * node + 1));
            let body = solid(mesh, Frame::Axis, material(law, 1e5, 0.3), held);
            let found = error(&body, &exact);
            assert!(found < 1e-9, "{law:?} {order:?} {found}");
        }
    }
}

#[test]
fn energies_volumes_and_masses_are_those_of_the_body() {
    let disc = square([6, 6], Order::Quadratic, |s, t| Point::from([s, t]));
    let body = solid(disc, Frame::Axis, material(Law::NeoHookean, 1e5, 0.3), vec![0]);
    // A cylinder of length and radius one
    assert!((body.volume() - std::f64::consts::PI).abs() < 1e-12);
    let weight = body.weight(Point::from([2.0, 0.0]));
    let along: f64 = weight.iter().step_by(2).sum();
    assert!((along - 2e3 * std::f64::consts::PI).abs() < 1e-9);
    let block = cube([2, 2, 2], Order::Quadratic, |x| x);
    let turned = moved(&block, |x| {
        let (s, c) = 0.7_f64.sin_cos();
        Point::from([c * x[0] - s * x[1] + 3.0, s * x[0] + c * x[1], x[2] - 1.0])
    });
    for law in LAWS {
        let body = solid(block.clone(), Frame::Space, material(law, 1e5, 0.3), vec![0]);
        assert!((body.volume() - 1.0).abs() < 1e-13);
        let energy = body.elastic_energy(&turned, &[]).expect("it is not turned over");
        assert!(energy.abs() < 1e-10, "{law:?} {energy}");
    }
}
