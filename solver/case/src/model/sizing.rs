//! The cell sizes a case asks for.

use alewife_mesh::{Point, SizeBox, Sizing};

use crate::Case;

/// Angle by which an outline turns along one edge at most (rad), however large its size.
const LARGEST_TURN: f64 = 0.5;

impl Case {
    /// The wanted cell sizes.
    #[must_use]
    pub fn sizing<const D: usize>(&self) -> Sizing<D> {
        let mesh = &self.mesh;
        // `check` makes sure that there is a number for each dimension
        let corner = |given: &[f64]| {
            Point::<D>::from_fn(|axis, _| given.get(axis).copied().unwrap_or(f64::NAN))
        };
        let boxes = mesh.boxes.iter().map(|refined| SizeBox {
            min: corner(&refined.min),
            max: corner(&refined.max),
            size: refined.size * mesh.scale,
        });
        Sizing {
            size: mesh.size * mesh.scale,
            surface: mesh.surface.unwrap_or(mesh.size) * mesh.scale,
            sides: mesh
                .sides
                .iter()
                .map(|(name, size)| (name.clone(), size * mesh.scale))
                .collect(),
            // A finer mesh has the same shape: more layers in gaps, slower growth
            growth: mesh.growth * mesh.scale,
            gap_layers: mesh.layers_when_new(),
            turn: LARGEST_TURN * mesh.scale,
            boxes: boxes.collect(),
            curved: mesh.curved,
        }
    }
}
