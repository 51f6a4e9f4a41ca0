//! Cook's membrane, a tapered panel in plane strain that is clamped on the left and sheared on the right: a
//! compressible body at small strains and one that keeps its volume at large ones, against other programs.

use alewife_mesh::Point;
use alewife_solid::material::Law;
use alewife_solid::solid::{Frame, Minimiser, Order, Potential, Solid};

use crate::meshes::{all_of, material, solid, square};

/// Lengths in mm, stresses in MPa.
const RIGHT: f64 = 48.0;

fn membrane(n: usize, law: Law, young: f64, poisson: f64) -> Solid<2> {
    let mesh = square([n, n], Order::Quadratic, |s, t| {
        Point::from([RIGHT * s, 44.0 * s + t * (44.0 - 28.0 * s)])
    });
    let held = all_of::<2>(&mesh.nodes_where(|x| x[0] < 1e-9));
    solid(mesh, Frame::Plane, material(law, young, poisson), held)
}

/// Forces of an upward shear stress on the right side.
fn shear(body: &Solid<2>, stress: f64) -> Vec<f64> {
    let mesh = &body.spec().mesh;
    let mut loads = vec![0.0; body.n_components()];
    let is_right = |node: &usize| mesh.nodes[*node][0] > RIGHT - 1e-9;
    for facet in mesh.facets.iter().filter(|facet| facet.nodes.iter().all(is_right)) {
        let length = (mesh.nodes[facet.nodes[0]] - mesh.nodes[facet.nodes[1]]).norm();
        for (node, part) in facet.nodes.iter().zip([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) {
            loads[2 * node + 1] += part * length * stress;
        }
    }
    loads
}

/// How far the upper corner on the right rises, with the load in some parts.
fn rise(body: &Solid<2>, stress: f64, n_parts: usize) -> f64 {
    let corner = body.spec().mesh.nodes_where(|x| (x - Point::from([RIGHT, 60.0])).norm() < 1e-9);
    let whole = shear(body, stress);
    let start = body.at_rest();
    let mut state = start.clone();
    let mut minimiser = Minimiser::default();
    for part in 1..=n_parts {
        let share = part as f64 / n_parts as f64;
        let loads: Vec<f64> = whole.iter().map(|load| share * load).collect();
        let potential = Potential::at_rest(body, &[], &loads);
        state = minimiser.minimise(&potential, &state).expect("it bends").places;
    }
    state[2 * corner[0] + 1] - start[2 * corner[0] + 1]
}

/// The limit of three values whose differences shrink by one factor (Aitken's).
fn limit([a, b, c]: [f64; 3]) -> f64 {
    c + (c - b) * (c - b) / ((b - a) - (c - b))
}

/// The mean of Calculix (32.27), Code_Aster (32.20) and Elmer (32.28) on their finest meshes of quadratic cells, which
/// differ by 0.25 %: benchmark 002 of the `CoFEA` initiative.
const SMALL: f64 = 32.25;

#[test]
fn at_small_strains_it_bends_as_in_three_other_programs() {
    let part = 1e-6;
    let all = [8, 16, 32].map(|n| {
        let body = membrane(n, Law::SaintVenantKirchhoff, 70.0, 1.0 / 3.0);
        rise(&body, 6.25 * part, 1) / part
    });
    println!("{all:?}");
    assert!((all[2] / SMALL - 1.0).abs() < 2.5e-3, "{all:?}");
    assert!((limit(all) / SMALL - 1.0).abs() < 2.5e-3, "{all:?} {}", limit(all));
}

/// `OpenGeoSys`, benchmark "Cook's membrane, large deformation, F-bar", on 30 x 30 cells, where the last two meshes
/// differ by 0.3 %: mu = 80.1938 MPa, nearly incompressible.
const LARGE: f64 = 6.891;

#[test]
fn at_large_strains_with_its_volume_kept_it_bends_as_in_another_program() {
    let young = 3.0 * 80.1938;
    let all = [6, 12, 24].map(|n| rise(&membrane(n, Law::NeoHookean, young, 0.5), 6.25, 2));
    println!("{all:?}");
    assert!((all[2] / LARGE - 1.0).abs() < 1e-2, "{all:?}");
    // The clamped corner keeps the order near 1.3
    assert!(all[2] - all[1] < 0.5 * (all[1] - all[0]), "{all:?}");
    // Places alone come to the same as the ratio comes near
    let near = rise(&membrane(24, Law::NeoHookean, young, 0.499), 6.25, 2);
    println!("{near}");
    assert!((near / all[2] - 1.0).abs() < 1e-2, "{near} {all:?}");
}
