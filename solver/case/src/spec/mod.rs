//! What the keys of a case are: its types, their ranges, and what each of them means by itself.

pub(crate) mod body;
pub(crate) mod case;
pub(crate) mod comparison;
pub(crate) mod contact;
pub(crate) mod domain;
pub(crate) mod environment;
pub(crate) mod extent;
pub(crate) mod field;
pub(crate) mod fluid;
pub(crate) mod formula;
pub(crate) mod given_mesh;
pub(crate) mod initial;
pub(crate) mod mesh;
#[cfg(test)]
pub mod number;
pub(crate) mod optimisation;
pub(crate) mod output;
pub(crate) mod profile;
pub(crate) mod reduced;
pub(crate) mod time;
pub(crate) mod time_function;
pub(crate) mod units;
