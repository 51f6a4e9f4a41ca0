//! `Sizing`: what is asked of the cell size h(x): fine at bodies and in gaps, coarse far away.

use crate::Point;

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
/// h(x) = min(size, surface sizes + growth * distance, gap / gap_layers, box sizes + growth * distance)
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
    /// Refinement boxes.
    pub boxes: Vec<SizeBox>,
    /// Whether cells at curved boundaries take the curve (isoparametric P2) or stay straight.
    pub curved: bool,
}
