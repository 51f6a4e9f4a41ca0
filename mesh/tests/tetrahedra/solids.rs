//! The inside of surfaces as solids: nodes on the boundary do no harm, and surfaces may turn within a cell.

use alewife_mesh::spatial::{Purpose, Region, TriangleMesh, generate_inside};
use alewife_mesh::{Mesh, Point, Quality, Sizing, check_mesh, jacobian_coefficients};

use nalgebra::Rotation3;

use super::regions::Sides;
use super::{ANGLE_AT_CREASES, LEAST_COEFFICIENT, assert_free_velocities, assert_manifold};

/// Cells of a size with one layer at least.
fn sizing(size: f64, curved: bool) -> Sizing<3> {
    Sizing { gap_layers: 1.0, curved, ..Sizing::graded(size, 0.5, size) }
}

/// A mesh for a purpose, and what is promised of it.
fn meshed(region: &Region, sizing: &Sizing<3>, purpose: Purpose) -> Mesh<3> {
    let mesh = generate_inside(region, sizing, purpose).expect("it can be meshed");
    // A cell may have two boundary facets in a solid
    if purpose == Purpose::Flow {
        check_mesh(&mesh).expect("it keeps the invariants");
    }
    let quality = Quality::of(&mesh);
    println!("volume {:+.2e}, {quality}", mesh.measure() / region.volume() - 1.0);
    assert!(quality.min_angle >= ANGLE_AT_CREASES, "{quality}");
    for cell in mesh.cell_ids().filter(|cell| mesh.curved[*cell]) {
        let all = jacobian_coefficients(&mesh.cell_nodes(cell));
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        assert!(least >= LEAST_COEFFICIENT * mean, "{least} {mean}");
    }
    mesh
}

/// Cells with more than one facet on the boundary.
fn n_with_two_facets(mesh: &Mesh<3>) -> usize {
    let mut n = vec![0; mesh.n_cells()];
    mesh.facets.iter().for_each(|facet| n[facet.cell.index()] += 1);
    n.into_iter().filter(|n| *n > 1).count()
}

fn plate() -> Region {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [0.0, 0.8]];
    Sides::prism(&corners, 0.12, 1, [0.5, 0.4]).turned([0.3, 0.5, -0.7]).region(45.0)
}

#[test]
fn cells_of_a_solid_plate_may_have_two_facets_and_those_of_a_flow_in_it_a_free_node() {
    let region = plate();
    let [solid, flow] =
        [Purpose::Solid, Purpose::Flow].map(|purpose| meshed(&region, &sizing(0.2, true), purpose));
    for mesh in [&solid, &flow] {
        assert_manifold(mesh);
        assert!((mesh.measure() / (0.8 * 0.12) - 1.0).abs() < 1e-9, "{}", mesh.measure());
    }
    assert!(n_with_two_facets(&solid) > 0 && n_with_two_facets(&flow) == 0);
    assert_free_velocities(&flow);
    assert!(solid.n_cells() < flow.n_cells(), "{} {}", solid.n_cells(), flow.n_cells());
}

/// A bar with one edge that is bevelled by a strip of six triangles.
#[test]
fn the_angle_that_rounds_smooth_parts_of_a_few_cells_is_known() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.95], [0.95, 1.0], [0.0, 1.0]];
    let bar = |smooth: f64| Sides::prism(&corners, 1.0, 3, [0.5, 0.5]).region(smooth);
    let sharp = bar(30.0);
    assert_eq!((sharp.n_sheets(), sharp.angle_without_small_sheets(0.05)), (7, None));
    let angle = sharp.angle_without_small_sheets(0.3).expect("the strip is narrow");
    assert!((45.0..=46.0).contains(&angle), "{angle}");
    let round = bar(angle);
    assert_eq!((round.n_sheets(), round.angle_without_small_sheets(0.3)), (5, None));
}

/// A bar whose edges are rounded over its twelve triangles: no quadratic cell of its size follows them.
#[test]
fn a_surface_that_turns_within_cells_folds_none() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let bar = Sides::prism(&corners, 2.0, 1, [0.5, 0.5]).turned([0.3, 0.5, -0.7]).region(180.0);
    for curved in [false, true] {
        let mesh = meshed(&bar, &sizing(0.5, curved), Purpose::Solid);
        assert_manifold(&mesh);
        assert!((mesh.measure() / bar.volume() - 1.0).abs() < if curved { 0.02 } else { 0.06 });
    }
}

/// A ring of 24 by 12 places on a torus.
fn torus() -> Region {
    use std::f64::consts::TAU;
    let (n, m) = (24_u32, 12_u32);
    let mut mesh = TriangleMesh::default();
    for i in 0..n {
        for j in 0..m {
            let (around, across) =
                (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(m));
            let from_axis = 1.0 + 0.3 * across.cos();
            let at = [from_axis * around.cos(), from_axis * around.sin(), 0.3 * across.sin()];
            mesh.vertices.push(Point::from(at));
            let at = |i: u32, j: u32| (i % n) * m + j % m;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let n_triangles = mesh.triangles.len();
    Region::new(mesh, vec!["surface".to_owned()], vec![0; n_triangles], 45.0).expect("it is closed")
}

/// How much of a volume a mesh leaves out, and the length of its edges, up to a factor.
#[derive(Debug)]
struct Made {
    off: f64,
    length: f64,
}

/// Straight cells leave out of a round solid what is between chords and arcs, to second order in their size, and
/// curved ones hardly anything.
#[test]
fn volumes_of_a_ring_converge() {
    let region = torus();
    let made = |size: f64, curved: bool| {
        // Sizes are not those of the curvature
        let sizing = Sizing { turn: 2.0, ..sizing(size, curved) };
        let mesh = meshed(&region, &sizing, Purpose::Solid);
        let off = (mesh.measure() / region.volume() - 1.0).abs();
        // Edges of facets are as long as this, whatever was wanted
        let length = (mesh.facets.len() as f64).powf(-0.5);
        Made { off, length }
    };
    let [coarse, fine] = [0.24, 0.12].map(|size| made(size, false));
    let order = (coarse.off / fine.off).ln() / (coarse.length / fine.length).ln();
    println!("order {order:.2}");
    assert!((1.7..2.5).contains(&order), "{coarse:?} {fine:?}");
    assert!(made(0.24, true).off < 0.1 * coarse.off);
}

/// The polyhedron on some vertices of one distance from 0 whose faces are the triples of neighbours, an edge apart.
fn polyhedron(vertices: Vec<Point<3>>, edge: f64) -> TriangleMesh {
    let turn = Rotation3::from_euler_angles(0.3, 0.5, -0.7);
    let vertices: Vec<Point<3>> = vertices.into_iter().map(|at| turn * at).collect();
    let is_edge =
        |i: usize, j: usize| ((vertices[i] - vertices[j]).norm() / edge - 1.0).abs() < 1e-9;
    let mut triangles = Vec::new();
    for i in 0..vertices.len() {
        for j in 0..i {
            for k in (0..j).filter(|k| is_edge(i, j) && is_edge(j, *k) && is_edge(*k, i)) {
                let [a, b, c] = [i, j, k].map(|corner| vertices[corner]);
                let is_outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
                let [i, j, k] = [i, j, k].map(|corner| u32::try_from(corner).expect("few corners"));
                triangles.push(if is_outward { [i, j, k] } else { [i, k, j] });
            }
        }
    }
    TriangleMesh { vertices, triangles }
}

fn octahedron() -> TriangleMesh {
    let ends = [1.0, -1.0].into_iter();
    let along = |axis: usize| {
        ends.clone().map(move |end| Point::from_fn(|i, _| if i == axis { end } else { 0.0 }))
    };
    polyhedron((0..3).flat_map(along).collect(), 2.0_f64.sqrt())
}

fn icosahedron() -> TriangleMesh {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices = Vec::new();
    for axis in 0..3 {
        for (one, other) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
            let mut at = Point::<3>::zeros();
            (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (one, other);
            vertices.push(at);
        }
    }
    polyhedron(vertices, 2.0)
}

fn of_triangles(mesh: TriangleMesh, smooth: f64) -> Region {
    let n = mesh.triangles.len();
    Region::new(mesh, vec!["surface".to_owned()], vec![0; n], smooth).expect("it is closed")
}

/// Faces of one triangle each, which turn by 41.8 degrees at edges, by 70.5 on the octahedron: no splinters of round
/// parts. Where no good cells are found in them, that is said within seconds.
#[test]
fn faces_of_polyhedra_stay_flat() {
    for smooth in [5.0, 25.0, 41.0] {
        assert_eq!(of_triangles(icosahedron(), smooth).n_sheets(), 20, "{smooth}");
    }
    assert_eq!(of_triangles(icosahedron(), 45.0).n_sheets(), 1);
    for (region, n_sheets, volume) in [
        (of_triangles(icosahedron(), 30.0), 20, 5.0 / 12.0 * (3.0 + 5.0_f64.sqrt()) * 8.0),
        (of_triangles(octahedron(), 45.0), 8, 4.0 / 3.0),
    ] {
        assert_eq!((region.n_sheets(), region.angle_without_small_sheets(1.0)), (n_sheets, None));
        assert!((region.volume() / volume - 1.0).abs() < 1e-9);
        let size = 0.25 * volume.cbrt();
        match generate_inside(&region, &sizing(size, false), Purpose::Solid) {
            Ok(mesh) => assert!((mesh.measure() / volume - 1.0).abs() < 1e-9),
            Err(error) => assert!(error.to_string().contains("off its surface"), "{error}"),
        }
    }
}
