//! Bodies in space that are cut out of a given mesh, whose sides stay as they are.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use alewife_mesh::spatial::{Body, Domain, Imported, Part, Shape, estimate_cells, generate};
use alewife_mesh::{BoundaryKind, Mesh, MeshError, Point, Quality, Sizing, check_mesh};
use nalgebra::Isometry3;

use super::{BOX_TEXT, PIPE_BINARY, read};

fn at(x: f64, y: f64, z: f64) -> Isometry3<f64> {
    Isometry3::translation(x, y, z)
}

fn sphere(radius: f64, pose: Isometry3<f64>) -> Body {
    Body::new("ball", Shape::Sphere { radius }, pose)
}

fn sizing(surface: f64, size: f64) -> Sizing<3> {
    Sizing { gap_layers: 2.0, ..Sizing::graded(surface, 0.4, size) }
}

/// Nodes of the sides by their coordinates, rounded.
fn nodes_of_sides(mesh: &Mesh<3>) -> BTreeSet<String> {
    let sides = mesh
        .facets
        .iter()
        .filter(|facet| mesh.boundaries[facet.boundary].kind == BoundaryKind::Side);
    let nodes = sides.flat_map(|facet| mesh.facet_nodes(facet));
    let text = |axis: &f64| format!("{:.9}", axis + 10.0);
    nodes.map(|node| mesh.nodes[node].iter().map(text).collect()).collect()
}

fn cut(given: &Mesh<3>, body: &Body, sizing: &Sizing<3>) -> Mesh<3> {
    let domain = Domain::Imported(Imported::new(given.clone()));
    let mesh = generate(&domain, std::slice::from_ref(body), sizing).expect("it can be meshed");
    check_mesh(&mesh).expect("it keeps the invariants");
    let estimate = estimate_cells(&domain, std::slice::from_ref(body), sizing, 1e6)
        .expect("cells can be counted");
    let ratio = mesh.n_cells() as f64 / estimate;
    println!("{}{ratio} of the estimate", Quality::of(&mesh));
    assert!((0.3..3.0).contains(&ratio), "{ratio}");
    let names: Vec<&str> = mesh.boundaries.iter().map(|side| side.name.as_str()).collect();
    assert_eq!(names.len(), given.boundaries.len() + 1);
    assert_eq!(names.last(), Some(&body.name.as_str()));
    mesh
}

#[test]
fn a_sphere_is_cut_out_of_a_box() {
    let given = read::<3>(BOX_TEXT);
    let mesh = cut(&given, &sphere(0.3, at(0.1, -0.2, 0.05)), &sizing(0.12, 0.8));
    let volume = 8.0 - 4.0 / 3.0 * PI * 0.027;
    assert!((mesh.measure() - volume).abs() < 1e-4, "{}", mesh.measure());
    // Sides are divided at most
    assert!(nodes_of_sides(&given).is_subset(&nodes_of_sides(&mesh)));
    assert!(Quality::of(&mesh).min_angle > 12.0);
}

/// The wall is bent; where it is divided, that is on the same curved facets.
#[test]
fn bent_sides_stay_as_they_are() {
    let given = read::<3>(PIPE_BINARY);
    let mesh = cut(&given, &sphere(0.25, at(1.0, 0.1, 0.2)), &sizing(0.12, 0.8));
    let volume = given.measure() - 4.0 / 3.0 * PI * 0.25_f64.powi(3);
    assert!((mesh.measure() - volume).abs() < 1e-4, "{} {volume}", mesh.measure());
    assert!(nodes_of_sides(&given).is_subset(&nodes_of_sides(&mesh)));
    let again = cut(&given, &sphere(0.25, at(1.0, 0.1, 0.2)), &sizing(0.12, 0.8));
    assert!(again == mesh);
}

/// A body of two parts, which meet.
#[test]
fn a_union_is_cut_out_of_a_box() {
    let given = read::<3>(BOX_TEXT);
    let mut body = sphere(0.3, at(-0.2, 0.0, 0.1));
    let shape = Shape::Capsule { radius: 0.15, length: 0.6 };
    body.parts.push(Part { shape, pose: at(0.4, 0.0, 0.0) });
    cut(&given, &body, &sizing(0.08, 0.8));
}

#[test]
fn a_given_mesh_without_bodies_stays_as_it_is() {
    let given = read::<3>(PIPE_BINARY);
    let domain = Domain::Imported(Imported::new(given.clone()));
    assert!(generate(&domain, &[], &sizing(0.1, 0.1)).unwrap() == given);
}

#[test]
fn bodies_that_meet_a_side_are_refused() {
    let pipe = Domain::Imported(Imported::new(read::<3>(PIPE_BINARY)));
    let refused = |body: Body| match generate(&pipe, &[body], &sizing(0.1, 0.5)) {
        Err(MeshError::BodyMeetsSide { side, gap, .. }) => (side, gap),
        other => panic!("{:?}", other.map(|mesh| mesh.n_cells())),
    };
    assert_eq!(&*refused(sphere(0.3, at(1.0, 0.8, 0.0))).0, "wall");
    assert_eq!(&*refused(sphere(0.3, at(1.8, 0.0, 0.0))).0, "outlet");
    // Outside, and around all of it
    assert!(refused(sphere(0.3, at(1.0, 3.0, 0.0))).1 < 0.0);
    assert!(refused(sphere(9.0, at(1.0, 0.0, 0.0))).1 < 0.0);
    // A thin capsule from side to side, its ends outside
    let capsule = Shape::Capsule { radius: 0.05, length: 3.0 };
    assert!(refused(Body::new("rod", capsule, at(1.0, 0.0, 0.0))).1 < 0.0);
    let named = Body::new("wall", Shape::Sphere { radius: 0.1 }, at(1.0, 0.0, 0.0));
    let error = generate(&pipe, &[named], &sizing(0.1, 0.5)).unwrap_err();
    assert!(matches!(error, MeshError::DuplicateName { .. }), "{error}");
    // The pipe goes from 0 to 2
    let inlet = pipe.sides().iter().position(|side| *side == "inlet").unwrap();
    for x in [-0.5, 0.5, 3.0] {
        assert!((pipe.side_gap(inlet, Point::<3>::new(x, 0.1, 0.2)) - x).abs() < 1e-12);
    }
}
