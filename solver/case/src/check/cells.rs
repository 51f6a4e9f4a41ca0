//! Cell sizes that ask for more cells than any machine has memory for, by the key that asks for them.

use std::collections::BTreeMap;

use super::Findings;
use crate::{DomainSpec, RefinementBox};

/// Most cells of a mesh: five million have 22 million unknowns, which take some 90 GB. What fits into
/// the machine at hand is known only to the run, which makes a closer estimate.
const MOST_CELLS: f64 = 5e6;

/// Most layers of cells across a gap.
const MOST_LAYERS: f64 = 200.0;

/// Cells over area / size^2: those of equilateral triangles, 4 / sqrt(3).
const CELLS: f64 = 2.309_401_076_758_503;

/// Each size alone, as if the rest of the mesh were coarse.
pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let mesh = &case.mesh;
    let scale = mesh.scale;
    let area = area(&case.domain);
    let everywhere = |size: f64| CELLS * area / (size * size);
    refuse(findings, "mesh.size", mesh.size, everywhere(mesh.size * scale), 2.0);
    for (index, refined) in mesh.boxes.iter().enumerate() {
        let size = refined.size * scale;
        let cells = CELLS * area_within(&case.domain, refined) / (size * size);
        refuse(findings, &format!("mesh.box.{index}.size"), refined.size, cells, 2.0);
    }
    // Along a length of surface, and away from it until cells are coarse
    let growth = mesh.growth * scale;
    let along = |length: f64, size: f64| {
        let graded = if growth > 0.0 { CELLS * length / (size * growth) } else { f64::INFINITY };
        graded.min(everywhere(size))
    };
    let power = if growth > 0.0 { 1.0 } else { 2.0 };
    let mut of_key: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let (key, size) = match (body.size, mesh.surface) {
            (Some(size), _) => (format!("body.{index}.size"), size),
            (None, Some(surface)) => ("mesh.surface".to_owned(), surface),
            (None, None) => continue,
        };
        let cells = along(body.shape.perimeter(), size * scale);
        of_key.entry(key).or_insert((size, 0.0)).1 += cells;
    }
    let [min, max] = case.domain.extent();
    let longest = (max[0] - min[0]).max(max[1] - min[1]);
    for (side, size) in &mesh.sides {
        of_key.insert(format!("mesh.sides.{side}"), (*size, along(longest, size * scale)));
    }
    for (key, (size, cells)) in of_key {
        refuse(findings, &key, size, cells, power);
    }
    let layers = mesh.gap_layers / scale;
    if layers > MOST_LAYERS {
        findings.error(
            "mesh.gap_layers",
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
    if scale < 1.0 && cells * scale * scale <= MOST_CELLS {
        findings.error(
            "mesh.scale",
            format!(
                "with `mesh.scale` = {scale:e}, `{key}` = {size:e} asks for about {cells:.1e} cells, \
                 more than {MOST_CELLS:e}"
            ),
            &format!("write {:.1e} or more", scale * (cells / MOST_CELLS).sqrt()),
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

/// Area of a domain (m2), of an axisymmetric one in its half plane.
fn area(domain: &DomainSpec) -> f64 {
    use std::f64::consts::PI;
    match domain {
        DomainSpec::Disc { radius, .. } => PI * radius * radius,
        DomainSpec::HalfDisc { radius, .. } => 0.5 * PI * radius * radius,
        _ => {
            let [min, max] = domain.extent();
            (max[0] - min[0]) * (max[1] - min[1])
        }
    }
}

/// Area of a refinement box within a domain (m2).
fn area_within(domain: &DomainSpec, refined: &RefinementBox) -> f64 {
    let [min, max] = domain.extent();
    let side = |axis: usize| {
        (refined.max[axis].min(max[axis]) - refined.min[axis].max(min[axis])).max(0.0)
    };
    side(0) * side(1)
}
