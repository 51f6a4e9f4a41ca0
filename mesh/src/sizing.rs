//! `Sizing`: what is asked of the cell size h(x): fine at bodies and in gaps, coarse far away.

use crate::generate::{Border, SizeTree, place, surface_sizes};
use crate::{Domain, MeshError, PlacedShape, Point};

/// Largest growth: beyond it neighbouring cells differ too much for good angles.
const MAX_GROWTH: f64 = 1.0;

/// A rectangle in which cells are at most `size`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeBox {
    /// Lower corner (m).
    pub min: Point<2>,
    /// Upper corner (m).
    pub max: Point<2>,
    /// Largest edge length inside (m).
    pub size: f64,
}

/// What is asked of the size field.
///
/// h(x) = min(size, surface sizes + growth * distance, box sizes + growth * distance)
///
/// A surface size is the smallest of its own, of what gives `gap_layers` layers across the gap to
/// the surface that faces it, and of `turn` times its radius of curvature.
#[derive(Debug, Clone, PartialEq)]
pub struct Sizing {
    /// Largest edge length anywhere (m).
    pub size: f64,
    /// Edge length on body surfaces that declare none of their own (m).
    pub surface: f64,
    /// Edge lengths on named sides of the domain (m).
    pub sides: Vec<(String, f64)>,
    /// Growth of the edge length per unit distance from where it is prescribed (1).
    pub growth: f64,
    /// Layers of cells wanted in the gap between two surfaces.
    pub gap_layers: f64,
    /// Largest angle by which a curved boundary turns along one edge (rad); 0.5 is about 30 degrees.
    pub turn: f64,
    /// Refinement boxes.
    pub boxes: Vec<SizeBox>,
    /// Whether cells at curved boundaries take the curve (isoparametric P2) or stay straight.
    pub curved: bool,
}

impl Sizing {
    /// Sizing with one size on all surfaces that grows to another away from them (m).
    #[must_use]
    pub fn graded(surface: f64, growth: f64, size: f64) -> Self {
        Self {
            size,
            surface,
            sides: Vec::new(),
            growth,
            gap_layers: 3.0,
            turn: 0.5,
            boxes: Vec::new(),
            curved: true,
        }
    }

    /// Whether all entries are in range and the named sides exist.
    ///
    /// # Errors
    /// [`MeshError::Sizing`] or [`MeshError::UnknownSide`].
    pub fn check(&self, domain: &Domain) -> Result<(), MeshError> {
        let refuse = |what: String, value, wanted| Err(MeshError::Sizing { what, value, wanted });
        for (name, _) in &self.sides {
            if !domain.sides().contains(&name.as_str()) {
                let sides = domain.sides().to_vec();
                return Err(MeshError::UnknownSide { name: name.clone(), sides });
            }
        }
        let sizes = [("size".to_string(), self.size), ("surface".to_string(), self.surface)]
            .into_iter()
            .chain([("gap_layers".to_string(), self.gap_layers), ("turn".to_string(), self.turn)])
            .chain(self.sides.iter().map(|(name, size)| (format!("sides.{name}"), *size)))
            .chain(
                self.boxes.iter().enumerate().map(|(i, b)| (format!("boxes[{i}].size"), b.size)),
            );
        for (what, value) in sizes {
            if value.is_nan() || value <= 0.0 {
                return refuse(what, value, "positive");
            }
        }
        if !(0.0..=MAX_GROWTH).contains(&self.growth) {
            return refuse("growth".to_string(), self.growth, "between 0 and 1");
        }
        Ok(())
    }
}

/// The wanted cell size h(x) of a domain with its bodies.
///
/// h(x) = min(size, h_i + growth |x - x_i| over places x_i of the boundary, the same of boxes).
#[derive(Debug, Clone)]
pub struct SizeField {
    tree: SizeTree,
    growth: f64,
    size: f64,
    boxes: Vec<SizeBox>,
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
        sizing.check(domain)?;
        let border = Border::new(domain, bodies, place(domain, bodies)?);
        Self::from_border(domain, bodies, sizing, &border)
    }

    pub(crate) fn from_border(
        domain: &Domain,
        bodies: &[PlacedShape],
        sizing: &Sizing,
        border: &Border,
    ) -> Result<Self, MeshError> {
        let sources = surface_sizes(domain, bodies, sizing, border)?;
        Ok(Self {
            tree: SizeTree::new(sources),
            growth: sizing.growth,
            size: sizing.size,
            boxes: if border.has_sides {
                sizing.boxes.clone()
            } else {
                // A cell whose sides are curved may lie in the images of a box
                let moved = |one: &SizeBox, shift: &Point<2>| SizeBox {
                    min: one.min + shift,
                    max: one.max + shift,
                    ..*one
                };
                let images = border.images.iter();
                images.flat_map(|shift| sizing.boxes.iter().map(|b| moved(b, shift))).collect()
            },
        })
    }

    /// Wanted edge length at a point (m).
    #[must_use]
    pub fn at(&self, point: Point<2>) -> f64 {
        self.tree.envelope(point, self.growth, self.limit(point), 0.0)
    }

    /// The same within a thousandth, faster, from the size at another point (m).
    pub(crate) fn at_from(&self, point: Point<2>, other: Point<2>, size: f64) -> f64 {
        // The field grows by at most this much from one point to the other
        let bound = size + self.growth * (point - other).norm();
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
        self.tree.sources().iter().map(|s| s.1).chain(boxes).fold(self.size, f64::min)
    }
}
