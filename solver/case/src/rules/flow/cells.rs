//! Cell sizes that ask for more cells than any machine has memory for, by the key that asks for them.

use std::collections::BTreeMap;

use crate::rules::Findings;
use crate::{Case, DomainSpec, Extent, Geometry, MeshFile, RefinementBox};

/// Most cells of a mesh: five million have 22 million unknowns, which take some 90 GB. What fits into
/// the machine at hand is known only to the run, which makes a closer estimate.
const MOST_CELLS: f64 = 5e6;

/// Most layers of cells across a gap.
const MOST_LAYERS: f64 = 200.0;

/// Triangles over area / size^2: those of equilateral ones, 4 / sqrt(3).
const TRIANGLES: f64 = 2.309_401_076_758_503;

/// Tetrahedra over volume / size^3: those of regular ones, 6 sqrt(2).
const TETRAHEDRA: f64 = 8.485_281_374_238_57;

/// Each size alone, as if the rest of the mesh were coarse.
pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let stays = findings.model().bodies.is_empty() || case.bodies_are_holes();
    if case.given_mesh().is_some() && stays {
        // It stays as it is
        return;
    }
    let mesh = &case.mesh;
    let scale = mesh.scale;
    let in_space = case.geometry == Geometry::Spatial;
    let (density, dimensions) = if in_space { (TETRAHEDRA, 3) } else { (TRIANGLES, 2) };
    let power = f64::from(dimensions);
    let measure = measure(case);
    let everywhere = |size: f64| density * measure / size.powi(dimensions);
    refuse(findings, "mesh.size", mesh.size, everywhere(mesh.size * scale), power);
    for (index, refined) in mesh.boxes.iter().enumerate() {
        let size = refined.size * scale;
        let cells = density * measure_within(case, refined) / size.powi(dimensions);
        refuse(findings, &format!("mesh.box.{index}.size"), refined.size, cells, power);
    }
    // Along a surface, and away from it until cells are coarse
    let growth = mesh.growth * scale;
    let along = |surface: f64, size: f64| {
        let graded = if growth > 0.0 {
            density * surface / ((power - 1.0) * growth * size.powi(dimensions - 1))
        } else {
            f64::INFINITY
        };
        graded.min(everywhere(size))
    };
    let power = if growth > 0.0 { power - 1.0 } else { power };
    let mut of_key: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let (key, size) = match (body.size, mesh.surface) {
            (Some(size), _) => (format!("body.{index}.size"), size),
            (None, Some(surface)) => ("mesh.surface".to_owned(), surface),
            (None, None) => continue,
        };
        let surface = if in_space { body.shape.surface_area() } else { body.shape.perimeter() };
        of_key.entry(key).or_insert((size, 0.0)).1 += along(surface, size * scale);
    }
    let mut lengths = case.extent().lengths();
    lengths.sort_by(f64::total_cmp);
    let largest = if in_space { lengths[2] * lengths[1] } else { lengths[2] };
    for (side, size) in &mesh.sides {
        of_key.insert(format!("mesh.sides.{side}"), (*size, along(largest, size * scale)));
    }
    for (key, (size, cells)) in of_key {
        refuse(findings, &key, size, cells, power);
    }
    let layers = mesh.gap_layers / scale;
    if layers > MOST_LAYERS {
        let is_of_scale = mesh.gap_layers <= MOST_LAYERS;
        findings.error(
            if is_of_scale { "mesh.scale" } else { "mesh.gap_layers" },
            format!("gaps would get {layers} layers of cells, and {MOST_LAYERS} are the most"),
            "4 are usual; with mesh.scale their number is gap_layers / scale",
        );
    }
}

/// Refuses a size that asks for too many cells, whose number falls with a power of it; where the scale
/// of the mesh is to blame, that.
fn refuse(findings: &mut Findings<'_>, key: &str, size: f64, cells: f64, power: f64) {
    if cells <= MOST_CELLS {
        return;
    }
    let scale = findings.case().mesh.scale;
    let dimensions = findings.case().geometry.dimensions() as f64;
    if scale < 1.0 && cells * scale.powf(dimensions) <= MOST_CELLS {
        findings.error(
            "mesh.scale",
            format!(
                "with `mesh.scale` = {scale:e}, `{key}` = {size:e} asks for about {cells:.1e} cells, \
                 more than {MOST_CELLS:e}"
            ),
            &format!("write {:.1e} or more", scale * (cells / MOST_CELLS).powf(1.0 / dimensions)),
        );
        return;
    }
    let fitting = size * (cells / MOST_CELLS).powf(1.0 / power);
    findings.error(
        key,
        format!(
            "`{key}` is {size:e} and asks for about {cells:.1e} cells, more than {MOST_CELLS:e}"
        ),
        &format!("write {fitting:.1e} or more, or make the domain smaller"),
    );
}

/// Area of a domain (m2), of an axisymmetric one in its half plane; in space its volume (m3).
fn measure(case: &Case) -> f64 {
    use std::f64::consts::PI;
    match (&case.domain, case.geometry) {
        (DomainSpec::Mesh(_) | DomainSpec::Surface(_), _) => {
            case.given_mesh().map_or(0.0, MeshFile::measure)
        }
        (DomainSpec::Disc { radius, .. }, _) => PI * radius * radius,
        (DomainSpec::HalfDisc { radius, .. }, _) => 0.5 * PI * radius * radius,
        (DomainSpec::Sphere { radius, .. }, _) => 4.0 / 3.0 * PI * radius.powi(3),
        (DomainSpec::Cylinder { x, radius }, Geometry::Spatial) => {
            PI * radius * radius * (x[1] - x[0])
        }
        (_, geometry) => case.extent().lengths()[..geometry.dimensions()].iter().product(),
    }
}

/// Area, or volume in space, of a refinement box within a domain (m2, m3).
fn measure_within(case: &Case, refined: &RefinementBox) -> f64 {
    let extent = case.extent();
    let within = Extent::between(&refined.min, &refined.max);
    let side = |axis: usize| {
        (within.max[axis].min(extent.max[axis]) - within.min[axis].max(extent.min[axis])).max(0.0)
    };
    (0..case.geometry.dimensions()).map(side).product()
}
