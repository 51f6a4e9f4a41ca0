//! The program: its command line, what it writes, and how it compares with references.
//!
//! The method itself is in `alewife-core`, the case files in `alewife-case`; both are called through this
//! crate. A case is read, with keys set as on the command line, checked, and run:
//!
//! ```
//! use alewife::case::{Case, check};
//! use alewife::run::simulate;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let power = |viscosity: f64| -> Result<f64, Box<dyn std::error::Error>> {
//!     let settings = [format!("fluid.viscosity={viscosity}"), "mesh.scale=2".to_owned()];
//!     let file = Case::read("squirmer-alone", &settings)?; // or the path of a case file
//!     assert!(check(&file).is_empty()); // what is wrong or odd, with file, line and remedy
//!     // 2: planar and axisymmetric cases; 3: those in space. Nothing is written without observers
//!     let run = simulate::<2>(&file.model, &mut [])?;
//!     let column = run.series.column("squirmer.power").ok_or("no such quantity")?;
//!     Ok(column[column.len() - 1])
//! };
//! // Without inertia the power is proportional to the viscosity
//! let [one, two] = [power(1.0)?, power(2.0)?];
//! assert!((two - 2.0 * one).abs() < 1e-9 * one, "{one} {two}");
//! # Ok(())
//! # }
//! ```
//!
//! [`observer::observers`] makes the files of a run directory, [`validation::compare`] compares with the references of
//! a case.

pub mod cli;
pub mod environment;
pub mod observer;
pub mod optimise;
pub mod reduced;
pub mod runner;
pub mod sweep;
pub mod validation;

pub use alewife_core::{
    body, case, coupling, flow, gradient, run, scalar, state, step, timing, tracer,
};

/// The program of a page, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../docs/how-to.md")]
struct HowTo;
