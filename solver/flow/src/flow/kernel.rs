//! `CellKernel`: matrices and residuals of cells; the sizes of an element stay behind it.

use std::fmt::Debug;
use std::ops::Range;

use alewife_mesh::Mesh;

use super::terms::{Fields, FlowTerms};

/// Local numbering of the raw unknowns of a cell: velocities along each axis in turn, pressures, then
/// the velocities of the frame where they are unknowns of every cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LocalLayout<const D: usize> {
    /// Nodes of the velocity in a cell.
    pub n_velocity_nodes: usize,
    /// Nodes of the pressure in a cell.
    pub n_pressure_nodes: usize,
    /// Velocities of the frame, along the first axes.
    pub n_frame: usize,
}

impl<const D: usize> LocalLayout<D> {
    /// Velocity component `axis` at a node of the cell.
    #[inline(always)]
    pub const fn velocity(self, node: usize, axis: usize) -> usize {
        axis * self.n_velocity_nodes + node
    }

    /// Pressure at a pressure node of the cell.
    #[inline(always)]
    pub const fn pressure(self, node: usize) -> usize {
        D * self.n_velocity_nodes + node
    }

    /// Velocity of the frame along an axis.
    #[inline(always)]
    pub const fn frame(self, axis: usize) -> usize {
        self.n_fluid() + axis
    }

    /// Velocities and pressures.
    #[inline(always)]
    pub const fn n_fluid(self) -> usize {
        D * self.n_velocity_nodes + self.n_pressure_nodes
    }

    /// All unknowns.
    #[inline(always)]
    pub const fn n_local(self) -> usize {
        self.n_fluid() + self.n_frame
    }
}

/// What the terms of cells are made of: mesh, coefficients, fields.
#[derive(Clone, Copy)]
pub(super) struct CellInput<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub terms: &'a FlowTerms<'a, D>,
    pub fields: &'a Fields<'a, D>,
}

/// Matrices and residuals of cells in the numbering of [`LocalLayout`], without boundary terms.
///
/// Methods take many cells at once, so that the call through the trait costs nothing.
pub(super) trait CellKernel<const D: usize>: Debug + Send + Sync {
    /// Numbering of the unknowns of each cell.
    fn layout(&self) -> LocalLayout<D>;

    /// Overwrites the raw matrices of some cells, each column by column at the beginning of `stride`
    /// numbers.
    fn matrices(
        &self,
        input: CellInput<'_, D>,
        cells: Range<usize>,
        stride: usize,
        matrices: &mut [f64],
    );

    /// Overwrites the raw residuals of some cells, velocities and pressures of each.
    fn residuals(&self, input: CellInput<'_, D>, cells: Range<usize>, residuals: &mut [f64]);
}
