//! `Sizing`: what is asked of the cell size h(x): fine at bodies and in gaps, coarse far away.

use crate::{MeshError, Point};

/// Largest growth: beyond it neighbouring cells differ too much for good angles.
const MAX_GROWTH: f64 = 1.0;

/// A rectangle, or a box in space, in which cells are at most `size`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeBox<const D: usize = 2> {
    /// Lower corner (m).
    pub min: Point<D>,
    /// Upper corner (m).
    pub max: Point<D>,
    /// Largest edge length inside (m).
    pub size: f64,
}

/// What is asked of the size field.
///
/// h(x) = min(size, surface sizes + growth * distance, box sizes + growth * distance)
///
/// A surface size is the smallest of its own, of what gives `gap_layers` layers across the gap to
/// the surface that faces it, and of `turn` times its radius of curvature; on ellipsoids in space also
/// of about the thickness.
#[derive(Debug, Clone, PartialEq)]
pub struct Sizing<const D: usize = 2> {
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
    pub boxes: Vec<SizeBox<D>>,
    /// Whether cells at curved boundaries take the curve (isoparametric P2) or stay straight.
    pub curved: bool,
}

impl<const D: usize> Sizing<D> {
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

    /// Whether all entries are in range and the named sides are among those of the domain.
    ///
    /// # Errors
    /// [`MeshError::Sizing`] or [`MeshError::UnknownSide`].
    pub fn check(&self, sides: &[&str]) -> Result<(), MeshError> {
        let refuse = |what: String, value, wanted| Err(MeshError::Sizing { what, value, wanted });
        for (name, _) in &self.sides {
            if !sides.contains(&name.as_str()) {
                let sides = sides.iter().map(|side| (*side).to_owned()).collect();
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
