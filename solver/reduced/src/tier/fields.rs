//! The deforming body as VTU files, for ParaView and for pictures.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use alewife_mesh::{Array, Mesh, NodeId, Point, Topology, write_vtu};
use alewife_solid::solid::SolidMesh;

use super::mesh::{Bodies, SolidOf};
use super::model::Model;
use crate::search::write_whole;
use crate::soft::Trajectory;

/// Files of a motion at most.
const MOST: usize = 60;

/// Writes `fields/frame-NNNN.vtu` and `fields.pvd` below a directory: places and velocities of the body at up to
/// sixty frames, on quadratic cells, and the mean pressures of cells where some keep their volume.
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
        let velocities: Vec<f64> = quadratic(own, &level.velocities[..n_places])
            .iter()
            .flat_map(|v| v.iter().copied().collect::<Vec<_>>())
            .collect();
        let mesh = Mesh::new(quadratic(own, &level.places[..n_places]), topology.clone());
        let name = format!("fields/frame-{frame:04}.vtu");
        let velocity = Array::new("velocity", D, &velocities);
        let pressures = solid.pressures(&level.places);
        let pressure = [Array::new("pressure", 1, &pressures)];
        let pressure = if solid.pressure_nodes().is_empty() { &[] } else { &pressure[..] };
        let mut bytes = Vec::new();
        write_vtu(&mut bytes, &mesh, Some(time), &[velocity], pressure)?;
        write_whole(&directory.join(&name), bytes)?;
        let _ = writeln!(list, "<DataSet timestep=\"{time}\" file=\"{name}\"/>");
    }
    list += "</Collection>\n</VTKFile>\n";
    write_whole(&directory.join("fields.pvd"), list)
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
