//! Meshes of strips and boxes, and bodies of them.

use alewife_mesh::Point;
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Frame, Order, Solid, SolidMesh, SolidSpec};

/// A grid of the unit square, of triangles, mapped.
pub fn square(n: [usize; 2], order: Order, map: impl Fn(f64, f64) -> Point<2>) -> SolidMesh<2> {
    let part = |at: usize, n: usize| at as f64 / n as f64;
    let mesh = SolidMesh::<2>::of_grid(n, |at| map(part(at[0], n[0]), part(at[1], n[1])));
    let mesh = mesh.expect("all cells have a volume");
    if order == Order::Quadratic { mesh.quadratic() } else { mesh }
}

/// A grid of the unit cube, of tetrahedra, mapped.
pub fn cube(n: [usize; 3], order: Order, map: impl Fn(Point<3>) -> Point<3>) -> SolidMesh<3> {
    let place =
        |at: [usize; 3]| map(Point::<3>::from_fn(|axis, _| at[axis] as f64 / n[axis] as f64));
    let mesh = SolidMesh::<3>::of_grid(n, place).expect("all cells have a volume");
    if order == Order::Quadratic { mesh.quadratic() } else { mesh }
}

pub fn material(law: Law, young: f64, poisson: f64) -> Material {
    Material { law, young, poisson, density: 1e3, viscosity: 0.0 }
}

/// A solid of one material without fibres.
pub fn solid<const D: usize>(
    mesh: SolidMesh<D>,
    frame: Frame,
    material: Material,
    held: Vec<usize>,
) -> Solid<D> {
    let spec = SolidSpec {
        mesh,
        frame,
        materials: vec![material],
        material_of: Vec::new(),
        fibres: Vec::new(),
        rigid: Vec::new(),
        held,
    };
    Solid::new(spec).expect("it is a solid")
}

/// All components of nodes.
pub fn all_of<const D: usize>(nodes: &[usize]) -> Vec<usize> {
    nodes.iter().flat_map(|node| D * node..D * (node + 1)).collect()
}

/// Nodes on the surface.
pub fn surface<const D: usize>(mesh: &SolidMesh<D>) -> Vec<usize> {
    let mut nodes: Vec<usize> = mesh.facets.iter().flat_map(|facet| facet.nodes.clone()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Places of all nodes under a map, one list.
pub fn moved<const D: usize>(mesh: &SolidMesh<D>, map: impl Fn(&Point<D>) -> Point<D>) -> Vec<f64> {
    mesh.nodes.iter().flat_map(|x| map(x).iter().copied().collect::<Vec<_>>()).collect()
}
