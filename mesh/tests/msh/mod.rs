//! Meshes in files of Gmsh: as it writes them, written and read back, damaged, and refused.

mod bodies;
mod damaged;
mod others;
mod refused;

use alewife_mesh::spatial;
use alewife_mesh::{
    Domain, Encoding, Mesh, MshError, PlacedShape, Point, Shape, Sizing, check_mesh, generate,
    read_msh, write_msh,
};
use nalgebra::Isometry3;

/// Files that Gmsh 4.15 wrote.
const SQUARE_TEXT: &[u8] = include_bytes!("data/square-1-text.msh");
const SQUARE_BINARY: &[u8] = include_bytes!("data/square-2-binary.msh");
const DISC_TEXT: &[u8] = include_bytes!("data/disc-2-text.msh");
const DISC_BINARY: &[u8] = include_bytes!("data/disc-1-binary.msh");
const BOX_TEXT: &[u8] = include_bytes!("data/box-1-text.msh");
const BOX_BINARY: &[u8] = include_bytes!("data/box-2-binary.msh");
const PIPE_TEXT: &[u8] = include_bytes!("data/pipe-2-text.msh");
const PIPE_BINARY: &[u8] = include_bytes!("data/pipe-2-binary.msh");
const PIPE_STRAIGHT: &[u8] = include_bytes!("data/pipe-1-binary.msh");

fn read<const D: usize>(bytes: &[u8]) -> Mesh<D> {
    let mesh = read_msh(bytes, 1.0).expect("it is a mesh");
    check_mesh(&mesh).expect("it keeps the invariants");
    mesh
}

fn written<const D: usize>(mesh: &Mesh<D>, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_msh(&mut bytes, mesh, encoding).expect("memory takes everything");
    bytes
}

fn names<const D: usize>(mesh: &Mesh<D>) -> Vec<&str> {
    mesh.boundaries.iter().map(|boundary| boundary.name.as_str()).collect()
}

/// Measure of the boundary of a name, as if its facets were straight.
fn measure<const D: usize>(mesh: &Mesh<D>, name: &str) -> f64 {
    let own = mesh.facets.iter().filter(|facet| mesh.boundaries[facet.boundary].name == name);
    let of = own.map(|facet| {
        let corners = mesh.facet_vertices(facet).map(|vertex| mesh.nodes[vertex]);
        match D {
            2 => (corners[1] - corners[0]).norm(),
            _ => 0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm(),
        }
    });
    of.sum()
}

#[test]
fn planar_files_of_gmsh_are_read() {
    for bytes in [SQUARE_TEXT, SQUARE_BINARY] {
        let mesh = read::<2>(bytes);
        assert_eq!(names(&mesh), ["inlet", "outlet", "wall"]);
        assert!((mesh.measure() - 2.0).abs() < 1e-12 && mesh.curved.iter().all(|c| !c));
        for (name, length) in [("inlet", 1.0), ("outlet", 1.0), ("wall", 4.0)] {
            assert!((measure(&mesh, name) - length).abs() < 1e-12);
        }
    }
    let pi = std::f64::consts::PI;
    let curved = read::<2>(DISC_TEXT);
    assert!((curved.measure() - pi).abs() < 2e-3 && curved.curved.contains(&true));
    let straight = read::<2>(DISC_BINARY);
    assert!((straight.measure() - pi).abs() > 0.05 && !straight.curved.contains(&true));
}

#[test]
fn files_in_space_of_gmsh_are_read() {
    for bytes in [BOX_TEXT, BOX_BINARY] {
        let mesh = read::<3>(bytes);
        assert_eq!(names(&mesh), ["wall"]);
        assert!(
            (mesh.measure() - 8.0).abs() < 1e-12 && (measure(&mesh, "wall") - 24.0).abs() < 1e-12
        );
    }
    let volume = 2.0 * std::f64::consts::PI;
    let [text, binary] = [PIPE_TEXT, PIPE_BINARY].map(read::<3>);
    // In the order of the tags of the physical groups
    assert_eq!(names(&text), ["wall", "outlet", "inlet"]);
    assert!(text.cells == binary.cells);
    for mesh in [&text, &binary] {
        assert!((mesh.measure() / volume - 1.0).abs() < 3e-3, "{}", mesh.measure());
        assert!(mesh.curved.contains(&true));
    }
    let straight = read::<3>(PIPE_STRAIGHT);
    assert!((straight.measure() / volume - 1.0).abs() > 0.05);
    assert_eq!(straight.facets.len(), text.facets.len());
}

#[test]
fn lengths_are_scaled() {
    let [mesh, scaled] = [1.0, 1e-3].map(|scale| read_msh::<3>(BOX_TEXT, scale).unwrap());
    assert!((scaled.measure() / mesh.measure() - 1e-9).abs() < 1e-20);
}

/// Written as binary a mesh is the same to the bit when it is read, as text, too.
fn assert_same<const D: usize>(mesh: &Mesh<D>) {
    for encoding in [Encoding::Binary, Encoding::Text] {
        let back = read::<D>(&written(mesh, encoding));
        assert_eq!(names(&back), names(mesh));
        assert!((back.n_vertices, &back.cells) == (mesh.n_vertices, &mesh.cells));
        let bits = |mesh: &Mesh<D>| -> Vec<u64> {
            mesh.nodes
                .iter()
                .flat_map(|node| node.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
                .collect()
        };
        assert!(bits(&back) == bits(mesh));
        let mut facets = mesh.facets.clone();
        facets.sort_by_key(|facet| (facet.cell, facet.side));
        assert!(back.facets == facets);
        assert!(back.curved == mesh.curved);
    }
}

#[test]
fn meshes_of_gmsh_are_written_and_read_back() {
    for bytes in [SQUARE_TEXT, SQUARE_BINARY, DISC_TEXT, DISC_BINARY] {
        assert_same(&read::<2>(bytes));
    }
    for bytes in [BOX_TEXT, BOX_BINARY, PIPE_TEXT, PIPE_STRAIGHT] {
        assert_same(&read::<3>(bytes));
    }
}

#[test]
fn generated_meshes_are_written_and_read_back() {
    let domain = Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 };
    let shape = Shape::Ellipse { semi_axes: [0.3, 0.1] };
    let center = Point::<2>::new(0.1, 0.2);
    let body = PlacedShape { name: "fish".into(), shape, center, angle: 0.3, size: None };
    assert_same(&generate(&domain, &[body], &Sizing::graded(0.05, 0.3, 0.2)).unwrap());
    let domain = spatial::Domain::Cylinder { x: [-1.0, 1.0], radius: 1.0 };
    let shape = spatial::Shape::Sphere { radius: 0.3 };
    let body = spatial::Body::new("ball", shape, Isometry3::translation(0.1, 0.2, 0.0));
    assert_same(&spatial::generate(&domain, &[body], &Sizing::graded(0.2, 0.3, 0.4)).unwrap());
}

/// A cell that is the other way round is turned, one with two sides on the boundary divided, and a
/// node without cells left out.
#[test]
fn what_can_be_mended_is_mended() {
    let file = refused::TWO_TRIANGLES;
    let mesh = read::<2>(file.as_bytes());
    // Each of the two has two sides on the boundary
    assert_eq!((mesh.n_cells(), mesh.n_vertices), (6, 6));
    let turned = file.replace("\n5 1 2 3\n", "\n5 2 1 3\n");
    assert_ne!(turned, file);
    let mesh = read::<2>(turned.as_bytes());
    assert!((mesh.measure() - 1.0).abs() < 1e-15);
    let orphan = file.replace("1 4 1 4\n2 1 0 4\n", "1 5 1 5\n2 1 0 5\n");
    let orphan =
        orphan.replace("4\n0 0 0\n", "4\n9\n0 0 0\n").replace("0 1 0\n$End", "0 1 0\n7 7 0\n$End");
    assert_eq!(read::<2>(orphan.as_bytes()).n_vertices, 6);
}

fn refusal<const D: usize>(bytes: &[u8]) -> MshError {
    read_msh::<D>(bytes, 1.0).expect_err("it is refused")
}
