//! Cylinders that go through a box from side to side.

use std::f64::consts::PI;

use alewife_mesh::spatial::{Body, Domain, Shape, check_placement, generate};
use alewife_mesh::{MeshError, Point, Quality, check_mesh};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::{SMALLEST_ANGLE, assert_free_velocities, assert_surfaces, at, sizing, sphere};

/// A cylinder along an axis through a point.
fn cylinder(name: &str, radius: f64, pose: Isometry3<f64>, axis: Vector3<f64>) -> Body {
    let turn = UnitQuaternion::rotation_between(&Vector3::x(), &axis).unwrap_or_default();
    Body::new(name, Shape::Cylinder { radius }, pose * turn)
}

#[test]
fn a_cylinder_across_a_channel_is_meshed_with_its_creases() {
    let (width, radius) = (0.41, 0.05);
    let domain = Domain::walls(Point::<3>::zeros(), Point::<3>::new(1.0, width, width));
    for axis in [Vector3::z(), Vector3::y()] {
        let bodies = [cylinder("c", radius, at(0.3, 0.2, 0.205), axis)];
        let mesh = generate(&domain, &bodies, &sizing(0.03, 0.1)).unwrap();
        check_mesh(&mesh).unwrap();
        assert!(Quality::of(&mesh).min_angle > SMALLEST_ANGLE, "{}", Quality::of(&mesh));
        assert_free_velocities(&mesh);
        assert_surfaces(&mesh, &domain, &bodies);
        let volume = width * width - PI * radius * radius * width;
        assert!((mesh.measure() / volume - 1.0).abs() < 1e-5, "{} {volume}", mesh.measure());
        // The creases are closed curves of nodes on side and cylinder, curved edges included
        let mut on = vec![[false; 2]; mesh.n_nodes()];
        for facet in &mesh.facets {
            let is_body = usize::from(facet.boundary.index() == 6);
            mesh.facet_nodes(facet).for_each(|node| on[node][is_body] = true);
        }
        let on_crease = mesh.node_ids().filter(|node| on[node.index()] == [true; 2]);
        let n = on_crease.clone().count();
        assert!(n.is_multiple_of(2) && n >= 2 * 16, "{n}");
        for node in on_crease {
            let from_axis = mesh.nodes[node] - Point::<3>::new(0.3, 0.2, 0.205);
            let across = from_axis - axis * axis.dot(&from_axis);
            assert!((across.norm() - radius).abs() < 1e-12);
            assert!((axis.dot(&mesh.nodes[node]) - 0.5 * width).abs() > 0.5 * width - 1e-12);
        }
    }
}

#[test]
fn cylinders_are_along_axes_of_a_box_and_apart() {
    let domain = Domain::walls(Point::<3>::zeros(), Point::<3>::new(1.0, 0.4, 0.4));
    let check = |bodies: &[Body]| check_placement(&domain, bodies);
    let upright = |x: f64| cylinder("c", 0.05, at(x, 0.2, 0.2), Vector3::z());
    assert!(check(&[upright(0.3)]).is_ok());
    assert!(check(&[upright(0.3), sphere("s", 0.1, at(0.5, 0.2, 0.2))]).is_ok());
    let touched = check(&[upright(0.3), sphere("s", 0.1, at(0.4, 0.2, 0.25))]);
    assert!(matches!(touched, Err(MeshError::BodiesMeet { gap, .. }) if gap < 0.0));
    let across = cylinder("d", 0.1, at(0.42, 0.2, 0.2), Vector3::y());
    let crossed = check(&[upright(0.3), across]);
    let is_right = |gap: f64| (gap + 0.03).abs() < 1e-9;
    assert!(matches!(crossed, Err(MeshError::BodiesMeet { gap, .. }) if is_right(gap)));
    let found = check(&[upright(0.04)]);
    assert!(matches!(&found, Err(MeshError::BodyMeetsSide { side, .. }) if &**side == "left"));
    let oblique = cylinder("c", 0.05, at(0.3, 0.2, 0.2), Vector3::new(0.0, 0.1, 1.0));
    assert!(matches!(check(&[oblique]), Err(MeshError::Body { .. })));
    let ball = Domain::Ball { center: Point::<3>::zeros(), radius: 1.0 };
    assert!(check_placement(&ball, &[upright(0.3)]).is_err());
    let periodic = Domain::Box {
        min: Point::<3>::zeros(),
        max: Point::<3>::new(1.0, 0.4, 0.4),
        periodic: [false, false, true],
        symmetric: [false; 6],
    };
    let refused = check_placement(&periodic, &[upright(0.3)]);
    assert!(matches!(refused, Err(MeshError::BodyMeetsPeriodicSide { .. })));
}
