//! What an unknown is: the P2 and P1 bases, quadrature, metric, cell maps and the numbering of dofs.

mod basis;
mod cell;
mod layout;
mod metric;
mod quadrature;

pub use basis::{p1_gradients, p1_values, p2_gradients, p2_values, triangle_side_point};
pub use cell::{CellValues, PointValues, Tables, simplex_gradients};
pub use layout::DofLayout;
pub use metric::Metric;
pub use quadrature::{Rule, interval_rule, simplex_rule};
