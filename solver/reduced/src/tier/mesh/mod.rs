//! The mesh of a soft body, from a grid, an outline, a shape of the program or a file.

mod curved;

use std::f64::consts::FRAC_PI_2;

use alewife_mesh::{
    Outline, PlacedShape, Point, Triangles, points_of_outline, read_undivided_msh,
    triangulate_inside,
};
use alewife_solid::solid::{Order, SolidError, SolidMesh};

use self::curved::curved;
use super::surface::inside_of_surface;
use crate::soft::{Gradient, Plan, Seeds, SoftBody, SoftError, Trajectory};
use alewife_case::soft::SoftFile;
use alewife_case::soft::solid::{GridSpec, OutlineSpec, SoftSolid, SolidOrder};
use alewife_case::{Diagnostic, ShapeSpec};

/// Meshes and motions of bodies of this many dimensions.
///
/// What takes time is here and not in functions of any dimension: those are compiled where they are called, as in the
/// program, which is optimised for a short build.
pub trait SolidOf<const D: usize> {
    /// The mesh of the body of a case.
    ///
    /// # Errors
    /// What is wrong with what it is made from.
    fn mesh(file: &SoftFile, solid: &SoftSolid) -> Result<SolidMesh<D>, Diagnostic>;

    /// The motion of a body, as [`SoftBody::simulate`] has it.
    ///
    /// # Errors
    /// Those of a motion.
    fn simulate(body: &SoftBody<D>, plan: &Plan) -> Result<Trajectory, SoftError>;

    /// Derivatives of an objective of a motion, as [`SoftBody::gradient`] has them, but for those by the shape.
    ///
    /// # Errors
    /// Those of the way back.
    fn gradient(
        body: &SoftBody<D>,
        plan: &Plan,
        motion: &Trajectory,
        seeds: Seeds,
    ) -> Result<Gradient, SoftError>;

    /// Work (J) put into the fibres in a motion, as [`SoftBody::work`] has it.
    fn work(body: &SoftBody<D>, plan: &Plan, motion: &Trajectory, shares: &[f64]) -> f64;

    /// The same; a multiple of its derivatives is added to those there are.
    fn add_work_seeds(
        body: &SoftBody<D>,
        plan: &Plan,
        motion: &Trajectory,
        shares: &[f64],
        factor: f64,
        seeds: &mut Seeds,
    ) -> f64;
}

/// Two and three dimensions.
#[derive(Debug, Clone, Copy)]
pub struct Bodies;

impl SolidOf<2> for Bodies {
    fn mesh(file: &SoftFile, solid: &SoftSolid) -> Result<SolidMesh<2>, Diagnostic> {
        if solid.mesh.is_some() {
            return given::<2>(file, solid);
        }
        if let Some(grid) = &solid.grid {
            let mesh =
                SolidMesh::<2>::of_grid([grid.cells[0], grid.cells[1]], |at| place(grid, at));
            return meshed(file, "solid.0.grid", mesh, solid.order);
        }
        let meshed = |key: &str, triangles: Triangles| {
            let all = triangles.cells.iter().map(|cell| cell.to_vec()).collect();
            cells(file, key, (triangles.points, all), solid.order)
        };
        if let Some(outline) = &solid.outline {
            return meshed("solid.0.outline.points", inside(file, solid, outline)?);
        }
        let outline = outline_of_shape(file, solid)?;
        let mesh = meshed("solid.0.shape", inside_of_shape(file, solid, &outline)?)?;
        Ok(curved(mesh, &outline))
    }

    fn simulate(body: &SoftBody<2>, plan: &Plan) -> Result<Trajectory, SoftError> {
        body.simulate(plan)
    }

    fn gradient(
        body: &SoftBody<2>,
        plan: &Plan,
        motion: &Trajectory,
        seeds: Seeds,
    ) -> Result<Gradient, SoftError> {
        body.gradient(plan, motion, seeds, false)
    }

    fn work(body: &SoftBody<2>, plan: &Plan, motion: &Trajectory, shares: &[f64]) -> f64 {
        body.work(plan, motion, shares)
    }

    fn add_work_seeds(
        body: &SoftBody<2>,
        plan: &Plan,
        motion: &Trajectory,
        shares: &[f64],
        factor: f64,
        seeds: &mut Seeds,
    ) -> f64 {
        body.add_work_seeds(plan, motion, shares, factor, seeds)
    }
}

impl SolidOf<3> for Bodies {
    fn mesh(file: &SoftFile, solid: &SoftSolid) -> Result<SolidMesh<3>, Diagnostic> {
        if solid.mesh.is_some() {
            return given::<3>(file, solid);
        }
        if let Some(grid) = &solid.grid {
            let n = [grid.cells[0], grid.cells[1], grid.cells[2]];
            let mesh = SolidMesh::<3>::of_grid(n, |at| place(grid, at));
            return meshed(file, "solid.0.grid", mesh, solid.order);
        }
        if let Some(ShapeSpec::Surface(surface)) = &solid.shape {
            let mesh = inside_of_surface(file, solid, surface)?;
            return Ok(SolidMesh::of_mesh(&mesh, order(solid)));
        }
        let Some(outline) = &solid.outline else {
            let message = "a shape of the plane has no inside in space".to_owned();
            let help = "write shape.surface, outline, grid or mesh";
            return Err(file.error("solid.0.shape", message, help));
        };
        let plate = plate(&inside(file, solid, outline)?, outline);
        cells(file, "solid.0.outline.points", plate, solid.order)
    }

    fn simulate(body: &SoftBody<3>, plan: &Plan) -> Result<Trajectory, SoftError> {
        body.simulate(plan)
    }

    fn gradient(
        body: &SoftBody<3>,
        plan: &Plan,
        motion: &Trajectory,
        seeds: Seeds,
    ) -> Result<Gradient, SoftError> {
        body.gradient(plan, motion, seeds, false)
    }

    fn work(body: &SoftBody<3>, plan: &Plan, motion: &Trajectory, shares: &[f64]) -> f64 {
        body.work(plan, motion, shares)
    }

    fn add_work_seeds(
        body: &SoftBody<3>,
        plan: &Plan,
        motion: &Trajectory,
        shares: &[f64],
        factor: f64,
        seeds: &mut Seeds,
    ) -> f64 {
        body.add_work_seeds(plan, motion, shares, factor, seeds)
    }
}

/// Nodes of a mesh, and the vertices of its cells.
type Cells<const D: usize> = (Vec<Point<D>>, Vec<Vec<usize>>);

fn cells<const D: usize>(
    file: &SoftFile,
    key: &str,
    (nodes, cells): Cells<D>,
    order: SolidOrder,
) -> Result<SolidMesh<D>, Diagnostic> {
    meshed(file, key, SolidMesh::of_cells(nodes, &cells), order)
}

fn meshed<const D: usize>(
    file: &SoftFile,
    key: &str,
    mesh: Result<SolidMesh<D>, SolidError>,
    order: SolidOrder,
) -> Result<SolidMesh<D>, Diagnostic> {
    let mesh = mesh
        .map_err(|error| file.error(key, format!("it cannot be meshed: {error}"), "change it"))?;
    Ok(if order == SolidOrder::Quadratic { mesh.quadratic() } else { mesh })
}

fn given<const D: usize>(file: &SoftFile, solid: &SoftSolid) -> Result<SolidMesh<D>, Diagnostic> {
    let scale = solid.mesh.as_ref().map_or(1.0, |mesh| mesh.scale);
    let bytes = file.mesh.as_ref().map_or(&[][..], |mesh| &mesh.bytes);
    let mesh = read_undivided_msh::<D>(bytes, scale).map_err(|error| {
        let name = file.mesh.as_ref().map_or("", |mesh| &mesh.name);
        file.error("solid.0.mesh.file", format!("{name}: {}", error.found), &error.accepted)
    })?;
    Ok(SolidMesh::of_mesh(&mesh, order(solid)))
}

/// Degree of the shape functions of a solid.
fn order(solid: &SoftSolid) -> Order {
    match solid.order {
        SolidOrder::Linear => Order::Linear,
        SolidOrder::Quadratic => Order::Quadratic,
    }
}

/// Triangles inside of a polygon.
fn inside(
    file: &SoftFile,
    solid: &SoftSolid,
    outline: &OutlineSpec,
) -> Result<Triangles, Diagnostic> {
    let corners: Vec<Point<2>> = outline.points.iter().map(|x| Point::<2>::from(*x)).collect();
    triangulate_inside(&corners, solid.size.unwrap_or(f64::INFINITY)).map_err(|error| {
        let help = "write the corners in order, without crossing sides";
        file.error("solid.0.outline.points", error.to_string(), help)
    })
}

/// The outline of a shape of the plane.
fn outline_of_shape(file: &SoftFile, solid: &SoftSolid) -> Result<Outline, Diagnostic> {
    let refused = |said: String| file.error("solid.0.shape", said, "change the shape");
    let Some(shape) = &solid.shape else { return Err(refused("there is no shape".to_owned())) };
    let placed = PlacedShape {
        name: solid.name.clone(),
        shape: shape.outline(),
        center: Point::<2>::zeros(),
        angle: 0.0,
        size: solid.size,
    };
    Outline::new(&placed).map_err(|error| refused(error.to_string()))
}

/// Triangles inside of it.
fn inside_of_shape(
    file: &SoftFile,
    solid: &SoftSolid,
    outline: &Outline,
) -> Result<Triangles, Diagnostic> {
    let size = solid.size.unwrap_or(f64::INFINITY);
    let corners = points_of_outline(outline, size);
    triangulate_inside(&corners, 2.0 * FRAC_PI_2 * size)
        .map_err(|error| file.error("solid.0.shape", error.to_string(), "change the shape"))
}

/// The place (m) of a point of a grid by its numbers along the axes.
fn place<const D: usize>(grid: &GridSpec, at: [usize; D]) -> Point<D> {
    Point::<D>::from_fn(|axis, _| {
        let [from, to] = [grid.from[axis], grid.to[axis]];
        from + (to - from) * at[axis] as f64 / grid.cells[axis] as f64
    })
}

/// A plate over triangles: prisms, each divided by the order of its vertices, so that neighbours agree.
fn plate(base: &Triangles, outline: &OutlineSpec) -> Cells<3> {
    let [from, to] = outline.z.unwrap_or_default();
    let (n, layers) = (base.points.len(), outline.layers);
    let mut nodes = Vec::new();
    for layer in 0..=layers {
        let z = from + (to - from) * layer as f64 / layers as f64;
        nodes.extend(base.points.iter().map(|x| Point::<3>::new(x[0], x[1], z)));
    }
    let mut cells = Vec::new();
    for layer in 0..layers {
        for cell in &base.cells {
            let mut below = cell.map(|vertex| vertex + layer * n);
            below.sort_unstable();
            let [a, b, c] = below;
            let [above_a, above_b, above_c] = below.map(|vertex| vertex + n);
            cells.push(vec![a, b, c, above_c]);
            cells.push(vec![a, b, above_b, above_c]);
            cells.push(vec![a, above_a, above_b, above_c]);
        }
    }
    (nodes, cells)
}
