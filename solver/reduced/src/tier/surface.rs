//! The mesh of a soft body in space inside of a closed surface of triangles.

use alewife_case::soft::SoftFile;
use alewife_case::soft::solid::{SoftSolid, SolidOrder};
use alewife_case::{Diagnostic, SurfaceCenter, SurfaceShape, unit_hint};
use alewife_mesh::spatial::{
    Purpose, Region, SurfaceFault, TriangleMesh, estimate_cells_inside, generate_inside,
};
use alewife_mesh::{Mesh, MeshError, Sizing};

/// Most cells of the inside.
const MOST_CELLS: f64 = 1e6;

/// Layers of cells wanted across a thin part: quadratic ones bend with one.
const LAYERS: f64 = 1.0;

const KEY: &str = "solid.0.shape.surface.data";

/// The inside of the surface of a solid, placed with its origin at 0, in cells of the solid's size.
pub(super) fn inside_of_surface(
    file: &SoftFile,
    solid: &SoftSolid,
    surface: &SurfaceShape,
) -> Result<Mesh<3>, Diagnostic> {
    let of_surface = |fault: SurfaceFault| {
        let message = format!("the surface of \"{}\": {fault}", solid.name);
        file.error(KEY, message, fault.remedy())
    };
    let data = surface.data.as_deref().unwrap_or_default();
    let mut mesh = TriangleMesh::from_line(data).map_err(of_surface)?.scaled(surface.scale);
    mesh.check().map_err(of_surface)?;
    let origin = match surface.center {
        SurfaceCenter::Centroid => mesh.moments().centroid,
        SurfaceCenter::At(at) => at.into(),
    };
    mesh.vertices.iter_mut().for_each(|vertex| *vertex -= origin);
    let (n, extent) = (mesh.triangles.len(), mesh.extent());
    let region = Region::new(mesh, vec!["surface".to_owned()], vec![0; n], surface.smooth)
        .map_err(of_surface)?;
    let size = solid.size.unwrap_or(extent);
    let curved = solid.order == SolidOrder::Quadratic;
    let sizing = Sizing { gap_layers: LAYERS, curved, ..Sizing::graded(size, 0.5, size) };
    let of_mesh = |error: MeshError| {
        // The remedy it ends in names keys of a flow
        let told = error.to_string();
        let reason = told.split("; lower ").next().unwrap_or_default();
        let message = format!("the inside of the surface cannot be meshed: {reason}");
        let help = "take a smaller solid.0.size, or round edges that are too sharp";
        let rounded = region.angle_without_small_sheets(size).map_or_else(String::new, |angle| {
            format!("; smooth = {angle:?} rounds those of its smooth parts that are not larger than a few cells")
        });
        file.error(KEY, message, &(help.to_owned() + &rounded))
    };
    if estimate_cells_inside(&region, &sizing, MOST_CELLS).map_err(of_mesh)? > MOST_CELLS {
        let message =
            format!("the inside of the surface would have more than {MOST_CELLS:e} cells");
        let help = "write a larger size".to_owned();
        let help = help + &unit_hint(&region, "the cells", size, surface.scale);
        return Err(file.error("solid.0.size", message, &help));
    }
    generate_inside(&region, &sizing, Purpose::Solid).map_err(of_mesh)
}
