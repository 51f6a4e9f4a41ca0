//! Meshes around bodies whose surfaces are triangles from files.

use std::sync::Arc;

use alewife_mesh::spatial::{Body, Domain, Shape, TriangleMesh, Triangulated, generate};
use alewife_mesh::{Mesh, Point, Sizing, check_mesh};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// An ellipsoid by circles of latitude, from pole to pole.
fn ellipsoid(n: u32, semi_axes: [f64; 3]) -> TriangleMesh {
    use std::f64::consts::PI;
    let stretch = Point::from(semi_axes);
    let mut mesh = TriangleMesh::default();
    let around = 2 * n;
    let mut push = |polar: f64, azimuth: f64| {
        let ((sin, cos), (s, c)) = (polar.sin_cos(), azimuth.sin_cos());
        mesh.vertices.push(Point::<3>::new(sin * c, sin * s, cos).component_mul(&stretch));
    };
    push(0.0, 0.0);
    for i in 1..n {
        for j in 0..around {
            push(PI * f64::from(i) / f64::from(n), PI * f64::from(j) / f64::from(n));
        }
    }
    push(PI, 0.0);
    let at = |i: u32, j: u32| 1 + (i - 1) * around + j % around;
    let last = 1 + (n - 1) * around;
    for j in 0..around {
        mesh.triangles
            .extend([[0, at(1, j), at(1, j + 1)], [last, at(n - 1, j + 1), at(n - 1, j)]]);
        for i in 1..n - 1 {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn volume(mesh: &Mesh<3>) -> f64 {
    mesh.measure()
}

#[test]
fn the_mesh_around_triangles_of_an_ellipsoid_is_that_around_the_ellipsoid() {
    let semi_axes = [0.8, 0.5, 0.4];
    let turn = UnitQuaternion::from_euler_angles(0.4, 0.7, -0.3);
    let pose = Isometry3::from_parts(Translation3::new(0.3, -0.2, 0.1), turn);
    let domain = Domain::walls(Point::<3>::repeat(-2.0), Point::<3>::repeat(2.0));
    let sizing = Sizing::graded(0.2, 0.5, 0.8);
    let triangles = Triangulated::new(&ellipsoid(24, semi_axes), 45.0, None).unwrap();
    let exact = Body::new("a", Shape::Ellipsoid { semi_axes }, pose);
    let given = Body::new("a", Shape::Triangulated(Arc::new(triangles)), pose);
    let [exact, given] = [exact, given].map(|body| generate(&domain, &[body], &sizing).unwrap());
    check_mesh(&given).unwrap();
    let cells = given.n_cells() as f64 / exact.n_cells() as f64;
    assert!((0.8..1.25).contains(&cells), "{cells}");
    let solid = [&exact, &given].map(|mesh| 64.0 - volume(mesh));
    assert!((solid[1] / solid[0] - 1.0).abs() < 2e-3, "{solid:?}");
}
