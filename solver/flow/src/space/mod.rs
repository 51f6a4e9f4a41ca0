//! What an unknown is: bases, quadrature, metric, maps of cells and facets, the numbering of dofs.

mod adjugate;
mod basis;
mod cell;
mod element;
mod facet;
mod layout;
mod metric;
mod quadrature;
#[cfg(test)]
pub(crate) mod sample_mesh;

pub use adjugate::adjugate;
pub use basis::{p1_gradients, p1_values, p2_gradients, p2_values};
pub use cell::{CellValues, PointValues, StraightCell, Tables, straight_cell};
pub use element::{Element, n_lagrange_nodes};
pub use facet::{FacetPoint, FacetRule};
pub use layout::DofLayout;
pub use metric::Metric;
pub use quadrature::{Rule, interval_rule, simplex_rule};
