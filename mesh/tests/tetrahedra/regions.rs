//! The inside of closed surfaces of triangles: sharp edges stay, round walls are round, sides have their names.

use std::f64::consts::PI;

use alewife_mesh::spatial::{NamedTriangles, Purpose, Region, TriangleMesh, generate_inside};
use alewife_mesh::{BoundaryId, Mesh, Point, Quality, Sizing, check_mesh};
use nalgebra::{Rotation3, Vector3};

use super::assert_manifold;

/// Triangles with the side of each.
#[derive(Default)]
pub(super) struct Sides {
    mesh: TriangleMesh,
    sides: Vec<usize>,
}

impl Sides {
    fn vertex(&mut self, at: Point<3>) -> u32 {
        self.mesh.vertices.push(at);
        u32::try_from(self.mesh.vertices.len()).expect("few vertices") - 1
    }

    fn add(&mut self, side: usize, vertices: [u32; 3]) {
        self.mesh.triangles.push(vertices);
        self.sides.push(side);
    }

    /// A prism on a polygon (counter-clockwise), its height cut into parts: bottom, top and wall.
    pub(super) fn prism(polygon: &[[f64; 2]], height: f64, parts: u32, fan: [f64; 2]) -> Self {
        let mut all = Self::default();
        let n = u32::try_from(polygon.len()).expect("few corners");
        for level in 0..=parts {
            for [x, y] in polygon {
                all.vertex(Point::<3>::new(*x, *y, height * f64::from(level) / f64::from(parts)));
            }
        }
        for level in 0..parts {
            for i in 0..n {
                let [a, b] = [level * n + i, level * n + (i + 1) % n];
                all.add(2, [a, b, b + n]);
                all.add(2, [a, b + n, a + n]);
            }
        }
        let [bottom, top] = [0.0, height].map(|z| all.vertex(Point::<3>::new(fan[0], fan[1], z)));
        for i in 0..n {
            let next = (i + 1) % n;
            all.add(0, [bottom, next, i]);
            all.add(1, [top, parts * n + i, parts * n + next]);
        }
        all
    }

    pub(super) fn turned(mut self, angles: [f64; 3]) -> Self {
        let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        self.mesh.vertices.iter_mut().for_each(|at| *at = turn * *at);
        self
    }

    pub(super) fn region(self, smooth: f64) -> Region {
        let names = ["bottom", "top", "wall"].map(str::to_owned).to_vec();
        Region::new(self.mesh, names, self.sides, smooth).expect("it is closed")
    }
}

pub(super) fn circle(n: u32) -> Vec<[f64; 2]> {
    (0..n).map(|i| 2.0 * PI * f64::from(i) / f64::from(n)).map(|t| [t.cos(), t.sin()]).collect()
}

fn meshed(region: &Region, size: f64) -> Mesh<3> {
    let sizing = Sizing { gap_layers: 2.0, ..Sizing::graded(size, 0.4, size) };
    let mesh = generate_inside(region, &sizing, Purpose::Flow).expect("it can be meshed");
    check_mesh(&mesh).expect("it keeps the invariants");
    println!("{} sheets, {}", region.n_sheets(), Quality::of(&mesh));
    assert_manifold(&mesh);
    mesh
}

fn area(mesh: &Mesh<3>, side: usize) -> Vector3<f64> {
    mesh.side_shape(BoundaryId::new(side)).area
}

#[test]
fn a_box_keeps_its_edges_and_corners_however_it_lies() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    for angles in [[0.0; 3], [0.3, 0.5, -0.7], [1.1, -0.2, 0.4]] {
        let sides = Sides::prism(&corners, 1.5, 1, [1.0, 0.5]).turned(angles);
        let mesh = meshed(&sides.region(30.0), 0.35);
        assert!((mesh.measure() - 3.0).abs() < 1e-9, "{}", mesh.measure());
        for side in 0..2 {
            assert!((area(&mesh, side).norm() - 2.0).abs() < 1e-9);
            assert!(mesh.side_shape(BoundaryId::new(side)).is_flat);
        }
    }
}

/// The angle by default is half of a right one; faces of two triangles are those of shapes here.
#[test]
fn faces_of_two_triangles_stay_apart_at_right_angles_and_those_of_hexagons() {
    for angles in [[0.0; 3], [0.3, 0.5, -0.7], [1.1, -0.2, 0.4], [0.7, 0.1, 2.0]] {
        let cube = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let cube = Sides::prism(&cube, 1.0, 1, [0.5, 0.5]).turned(angles).region(45.0);
        assert_eq!(cube.n_sheets(), 6);
        assert!((cube.volume() - 1.0).abs() < 1e-12, "{}", cube.volume());
        let hexagon = Sides::prism(&circle(6), 1.0, 1, [0.0, 0.0]).turned(angles).region(45.0);
        assert_eq!(hexagon.n_sheets(), 8);
        assert!((hexagon.volume() / (1.5 * 3.0_f64.sqrt()) - 1.0).abs() < 1e-12);
    }
}

/// Edges at which the region turns outwards.
#[test]
fn corners_that_stand_into_the_region_stay() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.9], [0.8, 0.9], [0.8, 2.0], [0.0, 2.0]];
    for angles in [[0.0; 3], [0.4, -0.6, 0.9]] {
        let sides = Sides::prism(&corners, 0.7, 1, [0.4, 0.4]).turned(angles);
        let mesh = meshed(&sides.region(30.0), 0.25);
        let wanted = 0.7 * (2.0 * 0.9 + 0.8 * 1.1);
        assert!((mesh.measure() - wanted).abs() < 1e-9, "{} {wanted}", mesh.measure());
    }
}

/// Round walls are those of the circle the vertices are on, to fourth order in the angle between them.
#[test]
fn a_tube_is_round_between_the_vertices_it_is_given_by() {
    for (n, error) in [(12, 4e-3), (24, 3e-4), (48, 8e-5)] {
        let sides = Sides::prism(&circle(n), 3.0, n / 3, [0.0, 0.0]).turned([0.2, 0.3, 0.5]);
        let mesh = meshed(&sides.region(45.0), 0.4);
        let off = mesh.measure() / (3.0 * PI) - 1.0;
        println!("{n}: {off:.3e}");
        assert!(off.abs() < error, "{n}: {off}");
        for side in 0..2 {
            let shape = mesh.side_shape(BoundaryId::new(side));
            assert!(shape.is_flat && (shape.area.norm() / PI - 1.0).abs() < error, "{shape:?}");
        }
    }
}

/// Four sheets meet at the tip of a pyramid, and edges are sharper than 60 degrees.
#[test]
fn a_wedge_is_meshed_up_to_its_edge() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.2]];
    let mesh = meshed(&Sides::prism(&corners, 1.0, 1, [0.5, 0.3]).region(20.0), 0.25);
    assert!((mesh.measure() - 1.2).abs() < 1e-9);
}

/// Edges of 30 and 46 degrees between tubes and a ball, and one between two tubes that fades out.
#[test]
fn a_vessel_that_branches_keeps_the_edges_of_its_junction() {
    let bytes = std::fs::read("../cases/vessel-surface/vessel.obj").expect("it is shipped");
    let NamedTriangles { mesh, groups } = NamedTriangles::read(&bytes).expect("it is one");
    let names: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
    assert_eq!(names, ["inlet", "upper", "lower", "wall"]);
    let sides = groups.iter().enumerate().flat_map(|(nth, group)| vec![nth; group.n]).collect();
    let region = Region::new(mesh, names, sides, 20.0).expect("it is closed");
    let mesh = meshed(&region, 0.55);
    assert!((mesh.measure() / region.volume() - 1.0).abs() < 2e-3);
    for (side, radius) in [(0, 1.0_f64), (1, 0.8), (2, 0.8)] {
        let off = area(&mesh, side).norm() / (PI * radius * radius) - 1.0;
        assert!(off.abs() < 2e-3, "{side}: {off}");
    }
}
