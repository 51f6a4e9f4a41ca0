//! `SolidSpec`: what a solid is made from.

use nalgebra::Vector3;

use super::error::SolidError;
use super::mesh::{Frame, SolidMesh};
use crate::material::Material;

/// Fibres that are told one stretch: a muscle, a tendon.
#[derive(Debug, Clone, PartialEq)]
pub struct Fibres {
    /// The cells they run through.
    pub cells: Vec<usize>,
    /// Their direction in each of these cells; its length does not matter.
    pub directions: Vec<Vector3<f64>>,
    /// Stiffness w (Pa).
    pub stiffness: f64,
}

/// Cells that move as a rigid body; they may not touch those of another one.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidPart {
    /// The cells.
    pub cells: Vec<usize>,
    /// Their density (kg/m3) at rest.
    pub density: f64,
}

/// All a solid is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidSpec<const D: usize> {
    /// Its mesh at rest.
    pub mesh: SolidMesh<D>,
    /// What the mesh stands for.
    pub frame: Frame,
    /// Its materials.
    pub materials: Vec<Material>,
    /// The material of each cell; empty where all have the first.
    pub material_of: Vec<usize>,
    /// Its active fibres; where the body is rigid they do nothing.
    pub fibres: Vec<Fibres>,
    /// Its rigid parts: [`Solid::new`](super::Solid::new) adds a material with their density for each.
    pub rigid: Vec<RigidPart>,
    /// Components of nodes, number D node + axis, that stay where the state at hand has them: all of a node
    /// for a clamp or a rigid part that is led, those across it for a rail.
    pub held: Vec<usize>,
}

impl<const D: usize> SolidSpec<D> {
    /// The material of a cell.
    pub(super) fn material_of_cell(&self, cell: usize) -> &Material {
        &self.materials[self.material_of.get(cell).copied().unwrap_or(0)]
    }

    /// Whether each component is held: those named, and of nodes on an axis the distance from it.
    ///
    /// # Errors
    /// Where one is named that is not there.
    pub(super) fn held_components(&self) -> Result<Vec<bool>, SolidError> {
        let mut held = vec![false; D * self.mesh.nodes.len()];
        for component in &self.held {
            exists("component", *component, held.len())?;
            held[*component] = true;
        }
        if self.frame == Frame::Axis {
            for (node, place) in self.mesh.nodes.iter().enumerate() {
                held[D * node + 1] |= place[1] == 0.0;
            }
        }
        Ok(held)
    }
}

pub(super) fn exists(what: &'static str, number: usize, count: usize) -> Result<(), SolidError> {
    if number < count { Ok(()) } else { Err(SolidError::Missing { what, number, count }) }
}
