//! Small soft swimmers: bars with fibres along one side, in the plane, around the axis and in space.

use alewife_mesh::Point;
use alewife_reduced::soft::{Curve, FacetLaw, SoftBody};
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Fibres, Frame, Order, Solid, SolidMesh, SolidSpec};
use nalgebra::Vector3;

pub const MATERIAL: Material =
    Material { law: Law::CorotatedVolume, young: 2e4, poisson: 0.35, density: 1e3, viscosity: 0.0 };

pub fn law() -> FacetLaw {
    FacetLaw {
        density: 1e3,
        drag: Curve::Bezier([0.05, 0.05, 1.85, 2.05]),
        thrust: Curve::Bezier([-0.8, -0.5, 0.1, 2.5]),
    }
}

/// A grid of triangles over [0, 1] x [0, 1], mapped.
pub fn triangles(n: [usize; 2], map: impl Fn(f64, f64) -> Point<2>) -> SolidMesh<2> {
    let node = |i: usize, j: usize| i * (n[1] + 1) + j;
    let mut nodes = Vec::new();
    for i in 0..=n[0] {
        for j in 0..=n[1] {
            nodes.push(map(i as f64 / n[0] as f64, j as f64 / n[1] as f64));
        }
    }
    let mut cells = Vec::new();
    for i in 0..n[0] {
        for j in 0..n[1] {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            cells.extend([vec![a, b, c], vec![a, c, d]]);
        }
    }
    SolidMesh::of_cells(nodes, &cells).expect("all cells have a volume")
}

/// A grid of tetrahedra over the unit cube, mapped.
pub fn tetrahedra(n: [usize; 3], map: impl Fn(Point<3>) -> Point<3>) -> SolidMesh<3> {
    let place =
        |at: [usize; 3]| map(Point::<3>::from_fn(|axis, _| at[axis] as f64 / n[axis] as f64));
    SolidMesh::<3>::of_grid(n, place).expect("all cells have a volume")
}

/// Mean of the vertices of each cell.
fn centres<const D: usize>(mesh: &SolidMesh<D>) -> Vec<Point<D>> {
    let cells = mesh.cells.chunks_exact(mesh.n_local());
    cells
        .map(|cell| {
            cell[..=D].iter().map(|node| mesh.nodes[*node]).sum::<Point<D>>() / (D as f64 + 1.0)
        })
        .collect()
}

/// A bar of length 0.2 along x whose fibres run along it in the half above `middle`, held on a rail along x at
/// its left end.
pub fn bar<const D: usize>(
    mesh: SolidMesh<D>,
    frame: Frame,
    material: Material,
    middle: f64,
) -> SoftBody<D> {
    let centres = centres(&mesh);
    let cells: Vec<usize> = (0..centres.len()).filter(|c| centres[*c][1] > middle).collect();
    let end = mesh.nodes_where(|x| x[0] < 1e-9);
    let spec = SolidSpec {
        frame,
        materials: vec![material],
        material_of: Vec::new(),
        fibres: vec![Fibres {
            directions: vec![Vector3::new(1.0, 0.0, 0.0); cells.len()],
            cells,
            stiffness: 3e4,
        }],
        rigid: Vec::new(),
        held: end.iter().flat_map(|node| D * node + 1..D * (node + 1)).collect(),
        mesh,
    };
    SoftBody { solid: Solid::new(spec).expect("it is a solid"), law: Some(law()) }
}

/// A plane bar, quadratic or linear.
pub fn plane_bar(order: Order, material: Material) -> SoftBody<2> {
    let mesh = triangles([8, 2], |s, t| Point::from([0.2 * s, 0.02 * (t - 0.5)]));
    let mesh = if order == Order::Quadratic { mesh.quadratic() } else { mesh };
    bar(mesh, Frame::Plane, material, 0.0)
}

/// A disc around the axis that is thin, with fibres in its upper part.
pub fn disc(material: Material) -> SoftBody<2> {
    let mesh = triangles([3, 4], |s, t| Point::from([0.03 * s, 0.08 * t]));
    bar(mesh.quadratic(), Frame::Axis, material, 0.03)
}

/// A bar in space.
pub fn bar_in_space(material: Material) -> SoftBody<3> {
    let mesh = tetrahedra([6, 2, 1], |x| {
        Point::from([0.2 * x[0], 0.03 * (x[1] - 0.5), 0.02 * (x[2] - 0.5)])
    });
    bar(mesh, Frame::Space, material, 0.0)
}

/// A short bar in space of quadratic cells.
pub fn short_bar_in_space(material: Material) -> SoftBody<3> {
    let mesh = tetrahedra([4, 1, 1], |x| {
        Point::from([0.1 * x[0], 0.03 * (x[1] - 0.5), 0.02 * (x[2] - 0.5)])
    });
    bar(mesh.quadratic(), Frame::Space, material, -1.0)
}
