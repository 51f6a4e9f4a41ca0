//! Gradients of steady flows: what quantities change by with numbers of a case, by adjoint flows; `in_time` has those of motions.
//!
//! With free unknowns y, their equations r(y, p) = P^T R = 0 and a quantity J(y, p), each number p of a case has
//! dJ/dp = d/dp (J - lambda . r) with y kept, (dr/dy)^T lambda = dJ/dy. The system is solved once, its transpose once for
//! each quantity, and a number costs two residuals: everything that follows from it, the nodes of the mesh included, is made
//! from the case at either side of its value, and J - lambda . r there is compared (the discrete adjoint, @giles2000). A mesh keeps its topology and
//! follows the surfaces of its bodies by the equation of the mesh motion.

mod adjoint;
mod by_numbers;
mod differences;
mod error;
mod flow;
mod in_time;
mod mesh_of_bodies;
mod moment;
mod objective;
mod parameter;
mod point;
mod refusals;
mod task;

pub use adjoint::Derivatives;
pub use by_numbers::{FlowByNumbers, NumberedCase};
pub use error::GradientError;
pub use task::{GradientTask, NumberAt, ReadCase, gradients, value_and_gradient};
