//! Meshes of strips and boxes, and bodies of them.

use alewife_mesh::Point;
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Frame, Order, Solid, SolidMesh, SolidSpec};

/// A grid of the unit square, of triangles, mapped.
pub fn square(n: [usize; 2], order: Order, map: impl Fn(f64, f64) -> Point<2>) -> SolidMesh<2> {
    let node = |i: usize, j: usize| i * (n[1] + 1) + j;
    let part = |i: usize, n: usize| i as f64 / n as f64;
    let nodes = (0..=n[0])
        .flat_map(|i| (0..=n[1]).map(move |j| [i, j]))
        .map(|[i, j]| map(part(i, n[0]), part(j, n[1])))
        .collect();
    let mut cells = Vec::new();
    for i in 0..n[0] {
        for j in 0..n[1] {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            if 2 * j < n[1] {
                cells.extend([vec![a, b, d], vec![b, c, d]]);
            } else {
                cells.extend([vec![a, b, c], vec![a, c, d]]);
            }
        }
    }
    let mesh = SolidMesh::of_cells(nodes, &cells).expect("all cells have a volume");
    if order == Order::Quadratic { mesh.quadratic() } else { mesh }
}

/// A grid of the unit cube, of tetrahedra, mapped.
pub fn cube(n: [usize; 3], order: Order, map: impl Fn(Point<3>) -> Point<3>) -> SolidMesh<3> {
    let node = |at: [usize; 3]| (at[0] * (n[1] + 1) + at[1]) * (n[2] + 1) + at[2];
    let mut nodes = Vec::new();
    for i in 0..=n[0] {
        for j in 0..=n[1] {
            for k in 0..=n[2] {
                let part = |i: usize, n: usize| i as f64 / n as f64;
                nodes.push(map(Point::from([part(i, n[0]), part(j, n[1]), part(k, n[2])])));
            }
        }
    }
    let mut cells = Vec::new();
    for i in 0..n[0] {
        for j in 0..n[1] {
            for k in 0..n[2] {
                for axes in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let mut at = [i, j, k];
                    let mut cell = vec![node(at)];
                    for axis in axes {
                        at[axis] += 1;
                        cell.push(node(at));
                    }
                    cells.push(cell);
                }
            }
        }
    }
    let mesh = SolidMesh::of_cells(nodes, &cells).expect("all cells have a volume");
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
