//! What the keys of a case are: its types, their ranges, and what each of them means by itself.

pub(crate) mod body;
pub(crate) mod calibration;
pub(crate) mod case;
pub(crate) mod comparison;
pub(crate) mod contact;
pub(crate) mod domain;
pub(crate) mod extent;
pub(crate) mod field;
pub(crate) mod fluid;
pub(crate) mod formula;
pub(crate) mod initial;
pub(crate) mod mesh;
pub(crate) mod mesh_file;
#[cfg(test)]
pub mod number;
pub(crate) mod optimisation;
pub(crate) mod output;
pub(crate) mod reduced;
pub(crate) mod region;
pub(crate) mod time;
mod time_function;
pub(crate) mod units;
