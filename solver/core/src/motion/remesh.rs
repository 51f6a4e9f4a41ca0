//! When a mesh is replaced: poor cells, or too few layers of them between two surfaces.

use std::fmt;

use alewife_mesh::{CellId, Facet, FacingSurfaces, Mesh, Point};

/// Layers left at a surface, over those of the new mesh, below which a new mesh is worth its price:
/// gaps that were meshed with few layers on purpose do not ask for a mesh at every step.
const LOST: f64 = 0.5;

/// When a mesh is replaced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Lowest quality of a cell over its quality in the new mesh.
    pub quality: f64,
    /// Fewest layers of cells across a gap: gap over edge length at its surfaces.
    pub layers: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { quality: 0.4, layers: 2.0 }
    }
}

/// What a mesh was like when it was new.
#[derive(Debug, Clone, PartialEq)]
pub struct Fresh {
    /// Quality of each cell.
    quality: Vec<f64>,
    /// Layers across the gap at each facet, infinite where nothing is near.
    layers: Vec<f64>,
    limits: Limits,
}

/// Why a new mesh is needed.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason<const D: usize> {
    /// A cell is inverted or folded, or about to be.
    Quality {
        /// The cell.
        cell: CellId,
        /// Its centre (m).
        at: Point<D>,
        /// Its quality, see [`Mesh::cell_quality`]; 0 or less when inverted or folded.
        quality: f64,
        /// Its quality in the new mesh.
        when_new: f64,
    },
    /// Too few layers of cells between two surfaces.
    Gap {
        /// Names of the boundaries: the one whose cells are too large, and the one facing it.
        between: [String; 2],
        /// Where, on the first one (m).
        at: Point<D>,
        /// Gap (m), negative where surfaces overlap.
        gap: f64,
        /// Layers of cells across the gap.
        layers: f64,
    },
}

impl<const D: usize> fmt::Display for Reason<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quality { cell, at, quality, when_new } => write!(
                f,
                "cell {cell} at {} has quality {quality:.3}, {when_new:.3} when new",
                coordinates(at)
            ),
            Self::Gap { between: [near, far], at, gap, layers } => write!(
                f,
                "{layers:.2} layers of cells between \"{near}\" and \"{far}\" at {}, \
                 gap {gap:.3e}",
                coordinates(at)
            ),
        }
    }
}

/// Coordinates in brackets.
fn coordinates<const D: usize>(point: &Point<D>) -> String {
    let all: Vec<String> = point.iter().map(|x| format!("{x:.6e}")).collect();
    format!("({})", all.join(", "))
}

impl Fresh {
    /// Measures a new mesh among the surfaces it was made for.
    #[must_use]
    pub fn new<const D: usize>(
        mesh: &Mesh<D>,
        surroundings: &impl FacingSurfaces<D>,
        limits: Limits,
    ) -> Self {
        let quality = mesh.cell_qualities();
        let layers = mesh
            .facets
            .iter()
            .map(|facet| {
                let crowding = crowding(mesh, surroundings, facet, limits.layers / LOST);
                crowding.map_or(f64::INFINITY, |found| found.layers)
            })
            .collect();
        Self { quality, layers, limits }
    }

    /// Lowest quality of a cell.
    #[must_use]
    pub fn lowest(&self) -> f64 {
        self.quality.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Whether a mesh that has moved since it was `fresh` must be replaced, and the worst reason:
/// cells that are inverted or folded come first, then gaps, then poor cells.
///
/// # Panics
/// Never for a mesh with the cells of the fresh one.
#[must_use]
pub fn needs_remesh<const D: usize>(
    mesh: &Mesh<D>,
    fresh: &Fresh,
    surroundings: &impl FacingSurfaces<D>,
) -> Option<Reason<D>> {
    let poorest = worst_quality(mesh, fresh);
    if matches!(poorest, Some(Reason::Quality { quality, .. }) if quality <= 0.0) {
        return poorest;
    }
    narrowest_gap(mesh, fresh, surroundings).or(poorest)
}

fn worst_quality<const D: usize>(mesh: &Mesh<D>, fresh: &Fresh) -> Option<Reason<D>> {
    let qualities = mesh.cell_ids().zip(mesh.cell_qualities());
    let all = qualities.zip(&fresh.quality).map(|((cell, quality), new)| (cell, quality, *new));
    let (cell, quality, when_new) =
        all.min_by(|one, other| (one.1 / one.2).total_cmp(&(other.1 / other.2)))?;
    (quality < fresh.limits.quality * when_new).then(|| Reason::Quality {
        cell,
        at: mesh.cell_center(cell),
        quality,
        when_new,
    })
}

fn narrowest_gap<const D: usize>(
    mesh: &Mesh<D>,
    fresh: &Fresh,
    surroundings: &impl FacingSurfaces<D>,
) -> Option<Reason<D>> {
    let narrow = mesh.facets.iter().zip(&fresh.layers).filter_map(|(facet, when_new)| {
        let limit = fresh.limits.layers.min(LOST * when_new);
        crowding(mesh, surroundings, facet, limit).map(|found| (facet, found))
    });
    let (facet, found) = narrow.min_by(|a, b| a.1.layers.total_cmp(&b.1.layers))?;
    let near = facet.boundary.index();
    Some(Reason::Gap {
        between: [near, found.facing].map(|boundary| mesh.boundaries[boundary].name.clone()),
        at: found.at,
        gap: found.gap,
        layers: found.layers,
    })
}

/// The narrowest place at a facet.
struct Crowding<const D: usize> {
    facing: usize,
    at: Point<D>,
    gap: f64,
    layers: f64,
}

/// The narrowest of the places of a facet with fewer than `limit` layers across the gap.
fn crowding<const D: usize>(
    mesh: &Mesh<D>,
    surroundings: &impl FacingSurfaces<D>,
    facet: &Facet,
    limit: f64,
) -> Option<Crowding<D>> {
    let vertices = mesh.facet_vertices(facet).map(|vertex| mesh.nodes[vertex]);
    let length = longest_edge(&vertices);
    let boundary = facet.boundary.index();
    let kind = mesh.boundaries[facet.boundary].kind;
    let found = mesh.facet_nodes(facet).filter_map(|node| {
        let at = mesh.nodes[node];
        let found = surroundings.facing(boundary, kind, at, limit * length)?;
        let layers = found.gap / length;
        Some(Crowding { facing: found.boundary, at, gap: found.gap, layers })
    });
    found.min_by(|a, b| a.layers.total_cmp(&b.layers))
}

/// Length (m) of the longest edge of a facet.
fn longest_edge<const D: usize>(vertices: &[Point<D>; D]) -> f64 {
    let pairs = (1..D).flat_map(|to| (0..to).map(move |from| [from, to]));
    pairs.map(|[from, to]| (vertices[to] - vertices[from]).norm()).fold(0.0, f64::max)
}
