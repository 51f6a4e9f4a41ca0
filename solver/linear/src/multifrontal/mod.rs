//! Sparse LU of saddle-point matrices by the multifrontal method (@duff1983, @liu1992).
//!
//! The unknowns of a mesh node are ordered together: nested dissection or minimum degree on the
//! graph of nodes, its elimination tree, and supernodes of it, merged where one larger front is
//! cheaper than two. A front is a dense matrix over the k unknowns eliminated in it and the r
//! unknowns of its border, which this couples: assembled from entries of the matrix and from the
//! contributions of its children, then
//!
//! ```text
//! | F11 F12 |   P F11 = L11 U11, U12 = L11^-1 P F12, L21 = F21 U11^-1,
//! | F21 F22 |   and the contribution F22 - L21 U12 goes to the parent.
//! ```
//!
//! Within a front velocities come before pressures, whose diagonal is zero until their velocities
//! are eliminated. A column whose pivot would be too small against the rest of it is delayed: it
//! moves to the parent together with a row without a pivot. Unknowns with dense rows or columns (rigid
//! velocities of bodies) are kept out of the graph and eliminated last.
//!
//! The tree is cut into subtrees, each factorised by one thread, and the fronts above them, whose
//! columns threads share in blocks of a fixed width. Neither cut nor blocks depend on the number
//! of threads, so the factors have the same bits on any number.

mod analysis;
mod buckets;
mod dense;
mod factorisation;
mod front;
mod ordering;
mod segments;
mod substitution;
#[cfg(test)]
mod tests;

pub use analysis::Analysis;
pub use factorisation::{Factors, NoFactors, Singular};
pub use ordering::Ordering;
