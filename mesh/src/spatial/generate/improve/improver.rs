//! `Improver`: a mesh with the surfaces and sizes it is to follow, and the quality of its cells.

use std::collections::BTreeSet;

use super::given_nodes::GivenNodes;
use super::projections::Projections;
use crate::Point;
use crate::spatial::generate::purpose::Asked;
use crate::spatial::generate::tetrahedra::Tetrahedra;
use crate::spatial::generate::tetrahedra::measure::{
    EDGES, least_coefficient, least_sine, middle, volume_length,
};
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;
use crate::spatial::geometry::Geometry;
use crate::spatial::size_field::SizeField;

/// Weight of the least coefficient of det J against the measure of the straight cell.
const CURVED_WEIGHT: f64 = 1.6;

/// Below this the least coefficient counts by an exponential, which stays positive: a change that
/// trades a folded cell for an inverted one must never look like an improvement.
const SMALL_COEFFICIENT: f64 = 0.2;

/// What is left of the quality of a cell whose nodes are all on walls: it has no free velocity.
const ALL_ON_WALLS: f64 = 0.02;

/// What is left of the quality of a cell with five edges on walls, as those with two boundary faces
/// have, once there are none: it has one free velocity.
const TWO_FACES: f64 = 0.1;

/// A point inside the fluid is this part of an edge away from all surfaces at least.
pub const LEAST_CLEARANCE: f64 = 0.05;

/// What is measured of a straight cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Straight {
    /// Volume over edge lengths: smooth, for the passes that shape the whole mesh.
    VolumeLength,
    /// The smallest sine of the dihedral angles: for the passes that cure the worst cells.
    Sine,
}

/// What is measured of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measure {
    /// Of the cell with straight edges.
    pub straight: Straight,
    /// Whether the curvature of its edges on surfaces counts.
    pub is_curved: bool,
    /// Whether five edges on walls count as a defect.
    pub avoids_two_faces: bool,
}

impl Measure {
    /// Of the straight cell alone.
    pub fn straight(straight: Straight) -> Self {
        Self { straight, is_curved: false, avoids_two_faces: false }
    }

    /// Of the curved cell.
    pub fn curved(straight: Straight) -> Self {
        Self { is_curved: true, ..Self::straight(straight) }
    }
}

/// What a change that is being tried will do to edges on the boundary.
#[derive(Debug, Clone, Copy)]
pub enum Pending {
    /// Nothing.
    Nothing,
    /// Edges at `vertex` become what those at `other` are, too: the two are merged.
    Merge { vertex: u32, other: u32 },
    /// An edge becomes one of the boundary.
    NewEdge { ends: [u32; 2], surfaces: SurfaceSet },
}

impl Pending {
    /// What a vertex is called after the change.
    fn name_after(&self, of: u32) -> u32 {
        match *self {
            Self::Merge { vertex, other } if vertex == of => other,
            _ => of,
        }
    }
}

/// A mesh that is being improved.
#[derive(Debug)]
pub struct Improver<'a> {
    /// The mesh.
    pub mesh: Tetrahedra,
    /// The edge lengths wanted.
    pub sizes: &'a SizeField,
    /// The surfaces.
    pub geometry: &'a Geometry,
    /// What is asked of the cells at them.
    pub asked: Asked,
    /// Nodes in bent edges of a given mesh.
    pub given: GivenNodes,
    /// Edges longer than this many wanted lengths are bisected.
    pub longest: f64,
    /// Edges that stay straight though their surfaces are curved, by their ends in ascending order.
    pub straight: BTreeSet<[u32; 2]>,
    projections: Projections<'a>,
    measure: Measure,
    is_curved: Vec<bool>,
    /// The interval of the last pass of swaps.
    pub last_swaps: u32,
    /// The interval of the last pass of smoothing.
    pub last_smoothing: u32,
}

impl<'a> Improver<'a> {
    /// A mesh without cells.
    pub fn new(sizes: &'a SizeField, asked: Asked) -> Self {
        let geometry = sizes.geometry();
        Self {
            mesh: Tetrahedra::new(geometry.periods),
            given: GivenNodes::default(),
            sizes,
            geometry,
            asked,
            longest: f64::INFINITY,
            straight: BTreeSet::new(),
            projections: Projections::new(geometry),
            measure: Measure::straight(Straight::VolumeLength),
            is_curved: geometry.surfaces.iter().map(|surface| !surface.is_flat()).collect(),
            last_swaps: 0,
            last_smoothing: 0,
        }
    }

    /// From now on cells are measured like this.
    pub fn set_measure(&mut self, measure: Measure) {
        if measure != self.measure {
            self.measure = measure;
            self.mesh.forget_qualities();
            self.last_swaps = 0;
            self.last_smoothing = 0;
        }
    }

    /// Whether the curvature of edges counts.
    pub fn is_curved(&self) -> bool {
        self.measure.is_curved
    }

    /// Adds a vertex with the size wanted there.
    pub fn add_vertex(&mut self, point: Point<3>, surfaces: SurfaceSet) -> u32 {
        self.mesh.add_vertex(point, self.sizes.at(point), surfaces)
    }

    /// Whether one of some surfaces is curved.
    pub fn has_curved(&self, surfaces: SurfaceSet) -> bool {
        surfaces.as_slice().iter().any(|surface| self.is_curved[usize::from(*surface)])
    }

    /// The point on some surfaces near a point (m).
    pub fn project(&self, surfaces: SurfaceSet, point: Point<3>) -> Point<3> {
        self.projections.of(surfaces, point).point
    }

    /// The unit normal of a surface, into the fluid, where it is nearest to a point (m).
    pub fn normal_at(&self, surface: u16, point: Point<3>) -> Point<3> {
        self.projections.of(SurfaceSet::of(surface), point).normal
    }

    /// Whether what is on these surfaces stays as it is, being on a given side.
    pub fn is_fixed(&self, surfaces: SurfaceSet) -> bool {
        let sides = &self.geometry.surfaces;
        surfaces.as_slice().iter().any(|surface| sides[usize::from(*surface)].is_given())
    }

    /// From the middle of an edge to the node in it (m), which is on the surfaces the edge is on.
    pub fn offset_of_node(&self, a: u32, b: u32) -> Point<3> {
        let straight = self.mesh.middle([a, b]);
        if self.straight.contains(&[a.min(b), a.max(b)]) {
            return Point::zeros();
        }
        self.node_on(self.mesh.edge_surfaces(a, b), [a, b], straight) - straight
    }

    /// The node in an edge on some surfaces, from its middle (m).
    fn node_on(&self, surfaces: SurfaceSet, ends: [u32; 2], straight: Point<3>) -> Point<3> {
        if !self.has_curved(surfaces) {
            straight
        } else if self.is_fixed(surfaces) {
            self.given.of(ends).unwrap_or(straight)
        } else {
            self.project(surfaces, straight)
        }
    }

    fn straight_quality(&self, corners: &[Point<3>; 4]) -> f64 {
        match self.measure.straight {
            Straight::VolumeLength => volume_length(corners),
            Straight::Sine => least_sine(corners),
        }
    }

    /// Quality of a cell with its corners at given places (m); not positive where it is inverted.
    pub fn quality_of(
        &self,
        vertices: [u32; 4],
        corners: &[Point<3>; 4],
        pending: &Pending,
    ) -> f64 {
        let straight = self.straight_quality(corners);
        if straight <= 0.0 || !self.measure.is_curved {
            return straight;
        }
        let on_boundary = vertices.iter().filter(|v| !self.mesh.surfaces(**v).is_empty()).count();
        if on_boundary < 2 {
            return straight;
        }
        let mut offsets = [Point::<3>::zeros(); 6];
        let (mut n_edges, mut has_curved) = (0, false);
        for (edge, [i, j]) in EDGES.into_iter().enumerate() {
            let surfaces = self.surfaces_after(vertices[i], vertices[j], pending);
            n_edges += usize::from(!surfaces.is_empty());
            if self.has_curved(surfaces) {
                let straight = middle(corners[i], corners[j]);
                let ends = [vertices[i], vertices[j]].map(|vertex| pending.name_after(vertex));
                offsets[edge] = self.node_on(surfaces, ends, straight) - straight;
                has_curved = true;
            }
        }
        let quality = match n_edges {
            6 if self.asked.free_nodes => return ALL_ON_WALLS * straight.min(1.0),
            5 if self.measure.avoids_two_faces => TWO_FACES * straight.min(1.0),
            _ => straight,
        };
        if !has_curved {
            return quality;
        }
        let least = least_coefficient(corners, &offsets);
        let counted = if least > SMALL_COEFFICIENT {
            least
        } else {
            let below = (least - SMALL_COEFFICIENT) / SMALL_COEFFICIENT;
            SMALL_COEFFICIENT * below.max(-600.0).exp()
        };
        quality.min(CURVED_WEIGHT * counted)
    }

    /// The surfaces of an edge after a change.
    fn surfaces_after(&self, a: u32, b: u32, pending: &Pending) -> SurfaceSet {
        let now = self.mesh.edge_surfaces(a, b);
        match *pending {
            Pending::Nothing => now,
            Pending::Merge { vertex, other } if a == vertex => {
                now.union(self.mesh.edge_surfaces(other, b))
            }
            Pending::Merge { vertex, other } if b == vertex => {
                now.union(self.mesh.edge_surfaces(other, a))
            }
            Pending::NewEdge { ends: [u, v], surfaces } if [a, b] == [u, v] || [a, b] == [v, u] => {
                now.union(surfaces)
            }
            Pending::Merge { .. } | Pending::NewEdge { .. } => now,
        }
    }

    /// Quality of a cell that would have these vertices.
    pub fn quality_with(&self, vertices: [u32; 4]) -> f64 {
        self.quality_of(vertices, &self.mesh.corners(vertices), &Pending::Nothing)
    }

    /// Quality of a cell.
    pub fn quality(&mut self, cell: u32) -> f64 {
        let kept = self.mesh.kept_quality(cell);
        if !kept.is_nan() {
            return kept;
        }
        let quality = self.quality_with(self.mesh.cell(cell));
        self.mesh.keep_quality(cell, quality);
        quality
    }

    /// The least quality of some cells.
    pub fn least_quality(&mut self, cells: &[u32]) -> f64 {
        cells.iter().fold(f64::INFINITY, |least, &cell| least.min(self.quality(cell)))
    }

    /// Places of vertices with one of them at a point (m), next to that.
    #[inline]
    pub fn corners_with<const N: usize>(
        &self,
        vertices: [u32; N],
        vertex: u32,
        point: Point<3>,
    ) -> [Point<3>; N] {
        let mut corners = self.mesh.corners_beside(vertices, point);
        for (corner, other) in corners.iter_mut().zip(vertices) {
            if other == vertex {
                *corner = point;
            }
        }
        corners
    }

    /// The least quality of the cells around a vertex if it were at a point (m); some quality up to a floor
    /// as soon as one cell has one.
    pub fn least_quality_at(&self, vertex: u32, point: Point<3>, floor: f64) -> f64 {
        let mut least = f64::INFINITY;
        for &cell in self.mesh.around(vertex) {
            let vertices = self.mesh.cell(cell);
            let corners = self.corners_with(vertices, vertex, point);
            least = least.min(self.quality_of(vertices, &corners, &Pending::Nothing));
            if least <= floor {
                break;
            }
        }
        least
    }

    /// Whether a point is in the fluid by the exact surfaces, at some distance (m) from them: the
    /// straight faces of cells at a body run inside of it.
    pub fn is_in_fluid(&self, point: Point<3>, distance: f64) -> bool {
        self.geometry.clearance(point, distance) > distance
    }
}
