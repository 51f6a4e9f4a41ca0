//! The deforming body as VTU files, for ParaView and for pictures.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use alewife_mesh::{
    Array, Boundary, BoundaryId, BoundaryKind, CellId, Facet, Mesh, NodeId, Point, Simplex,
    Topology, write_vtu,
};
use alewife_solid::solid::SolidMesh;

use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use crate::search::write_whole;
use crate::soft::Trajectory;

/// Files of a motion at most.
const MOST: usize = 60;

/// Writes `fields/frame-NNNN.vtu` and `fields.pvd` below a directory: the body at up to sixty frames, on quadratic
/// cells where they are, with displacements from rest (m) and velocities (m/s) at nodes. Cells have their mean
/// equivalent strain, their mean volume ratio, and where some keep their volume, their mean pressure (Pa).
///
/// # Errors
/// What the file system reports.
pub fn write_fields<const D: usize>(
    directory: &Path,
    model: &Model<D>,
    motion: &Trajectory,
) -> io::Result<()>
where
    Bodies: SolidOf<D>,
{
    let folder = directory.join("fields");
    fs::create_dir_all(&folder)?;
    let own = &model.body.solid.spec().mesh;
    let topology = topology(own);
    let rest = quadratic(own, &model.body.solid.at_rest()[..model.body.solid.n_places()]);
    let plan = &model.plan;
    let n_frames = plan.targets.len();
    let every = n_frames.div_ceil(MOST).max(1);
    let mut list = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n",
    );
    for frame in (0..=n_frames).filter(|frame| frame % every == 0 || *frame == n_frames) {
        let level = &motion.levels[frame * plan.substeps];
        let time = frame as f64 * plan.frame;
        let solid = &model.body.solid;
        let n_places = solid.n_places();
        let velocities = flat(&quadratic(own, &level.velocities[..n_places]));
        let places = quadratic(own, &level.places[..n_places]);
        let moved: Vec<Point<D>> = places.iter().zip(&rest).map(|(x, rest)| x - rest).collect();
        let displacements = flat(&moved);
        let mesh = Mesh::new(places, topology.clone());
        let name = format!("fields/frame-{frame:04}.vtu");
        let at_nodes =
            [Array::new("displacement", D, &displacements), Array::new("velocity", D, &velocities)];
        let strains = solid.equivalent_strains(&level.places);
        let volumes = solid.volume_ratios(&level.places);
        let pressures = solid.pressures(&level.places);
        let in_cells = [
            Array::new("strain", 1, &strains),
            Array::new("volume-ratio", 1, &volumes),
            Array::new("pressure", 1, &pressures),
        ];
        let n = if solid.pressure_nodes().is_empty() { 2 } else { 3 };
        let mut bytes = Vec::new();
        write_vtu(&mut bytes, &mesh, Some(time), &at_nodes, &in_cells[..n])?;
        write_whole(&directory.join(&name), bytes)?;
        let _ = writeln!(list, "<DataSet timestep=\"{time}\" file=\"{name}\"/>");
    }
    list += "</Collection>\n</VTKFile>\n";
    write_whole(&directory.join("fields.pvd"), list)
}

/// The mesh of a body at rest, on quadratic cells, whose boundary is `surface`.
#[must_use]
pub fn rest_mesh<const D: usize>(model: &Model<D>) -> Mesh<D> {
    let own = &model.body.solid.spec().mesh;
    let mut topology = topology(own);
    let boundary = Boundary { name: "surface".to_owned(), kind: BoundaryKind::Side };
    topology.boundaries.push(boundary);
    topology.facets = facets(own);
    Mesh::new(own.quadratic().nodes, topology)
}

/// The facets of the surface as sides of cells.
fn facets<const D: usize>(mesh: &SolidMesh<D>) -> Vec<Facet> {
    let sorted = |nodes: &mut dyn Iterator<Item = usize>| -> Vec<usize> {
        let mut nodes: Vec<usize> = nodes.collect();
        nodes.sort_unstable();
        nodes
    };
    let outer: BTreeSet<Vec<usize>> =
        mesh.facets.iter().map(|facet| sorted(&mut facet.nodes[..D].iter().copied())).collect();
    let mut found = Vec::new();
    for (cell, nodes) in mesh.cells.chunks_exact(mesh.n_local()).enumerate() {
        for (side, number) in (0_u8..).zip(0..Simplex::<D>::FACETS.len()) {
            let vertices = Simplex::<D>::facet_vertices(number);
            if outer.contains(&sorted(&mut vertices.iter().map(|local| nodes[*local]))) {
                let boundary = BoundaryId::new(0);
                found.push(Facet { cell: CellId::new(cell), side, boundary });
            }
        }
    }
    found
}

/// Components of all points in one list.
fn flat<const D: usize>(points: &[Point<D>]) -> Vec<f64> {
    points.iter().flat_map(|point| point.iter().copied().collect::<Vec<_>>()).collect()
}

/// Values at all nodes of the quadratic mesh: of a linear one, means at the middles of its edges.
fn quadratic<const D: usize>(mesh: &SolidMesh<D>, values: &[f64]) -> Vec<Point<D>> {
    let nodes = values.chunks_exact(D).map(Point::<D>::from_column_slice).collect();
    SolidMesh { nodes, ..mesh.clone() }.quadratic().nodes
}

fn topology<const D: usize>(mesh: &SolidMesh<D>) -> Topology<D> {
    let whole = mesh.quadratic();
    let corners = whole.cells.chunks_exact(whole.n_local()).flat_map(|cell| &cell[..=D]);
    Topology {
        n_vertices: corners.max().map_or(0, |last| last + 1),
        curved: vec![false; whole.n_cells()],
        cells: whole.cells.iter().map(|node| NodeId::new(*node)).collect(),
        facets: Vec::new(),
        boundaries: Vec::new(),
        periodic: Vec::new(),
    }
}
