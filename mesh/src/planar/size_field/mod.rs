//! `SizeField`: the wanted cell size h(x) of a domain with its bodies.

mod count;
mod sources;
mod tree;

pub use count::estimate_cells;

use sources::surface_sizes;
use tree::SizeTree;

use crate::planar::boundary::BoundaryLoops;
use crate::planar::placement::place;
use crate::planar::torus::Torus;
use crate::{Domain, MeshError, PlacedShape, Point, SizeBox, Sizing};

/// The wanted cell size h(x) of a domain with its bodies.
///
/// h(x) = min(size, h_i + growth |x - x_i| over places x_i of the boundary, the same of boxes).
#[derive(Debug, Clone)]
pub struct SizeField {
    tree: SizeTree,
    growth: f64,
    size: f64,
    boxes: Vec<SizeBox>,
    /// Where it is periodic.
    torus: Torus,
}

impl SizeField {
    /// Size field of a domain with its bodies.
    ///
    /// # Errors
    /// Those of [`crate::check_placement`] and of [`Sizing::check`], and
    /// [`MeshError::TooManyCells`].
    pub fn new(
        domain: &Domain,
        bodies: &[PlacedShape],
        sizing: &Sizing,
    ) -> Result<Self, MeshError> {
        sizing.check(domain.sides())?;
        let border = BoundaryLoops::new(domain, bodies, place(domain, bodies)?);
        Self::from_border(domain, bodies, sizing, &border)
    }

    pub(crate) fn from_border(
        domain: &Domain,
        bodies: &[PlacedShape],
        sizing: &Sizing,
        border: &BoundaryLoops,
    ) -> Result<Self, MeshError> {
        let sources = surface_sizes(domain, bodies, sizing, border)?;
        Ok(Self {
            tree: SizeTree::new(sources),
            growth: sizing.growth,
            size: sizing.size.min(border.torus.largest_size()),
            torus: border.torus,
            boxes: if border.torus.is_closed() {
                let moved = |one: &SizeBox, shift: &Point<2>| SizeBox {
                    min: one.min + shift,
                    max: one.max + shift,
                    ..*one
                };
                let images = border.images.iter();
                images.flat_map(|shift| sizing.boxes.iter().map(|b| moved(b, shift))).collect()
            } else {
                sizing.boxes.clone()
            },
        })
    }

    /// Wanted edge length at a point (m).
    #[must_use]
    pub fn at(&self, point: Point<2>) -> f64 {
        let point = self.torus.inside(point);
        self.tree.envelope(point, self.growth, self.limit(point), 0.0)
    }

    /// The same within a thousandth, faster, from the size at another point (m).
    pub(crate) fn at_from(&self, point: Point<2>, other: Point<2>, size: f64) -> f64 {
        // The field grows by at most this much from one point to the other
        let bound = size + self.growth * (point - other).norm();
        let point = self.torus.inside(point);
        self.tree.envelope(point, self.growth, self.limit(point).min(bound), 1e-3)
    }

    /// Growth per unit distance (1).
    pub(crate) fn growth(&self) -> f64 {
        self.growth
    }

    /// Size asked for by the boxes and everywhere (m).
    fn limit(&self, point: Point<2>) -> f64 {
        let mut limit = self.size;
        for b in &self.boxes {
            let x = (b.min.x - point.x).max(point.x - b.max.x).max(0.0);
            let y = (b.min.y - point.y).max(point.y - b.max.y).max(0.0);
            limit = limit.min(b.size + self.growth * x.hypot(y));
        }
        limit
    }

    /// Smallest size prescribed anywhere (m).
    #[must_use]
    pub fn smallest(&self) -> f64 {
        let boxes = self.boxes.iter().map(|b| b.size);
        self.tree.sources().iter().map(|source| source.size).chain(boxes).fold(self.size, f64::min)
    }
}
