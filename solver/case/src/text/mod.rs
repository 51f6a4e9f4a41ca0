//! Texts of cases: trees of TOML that know where they were written, what is wrong in them and how it is reported.

pub(crate) mod angle;
pub(crate) mod choices;
pub(crate) mod csv_line;
mod deserialize;
pub(crate) mod diagnostic;
pub(crate) mod meant;
pub(crate) mod names;
pub(crate) mod nearest;
pub(crate) mod setting;
pub(crate) mod source;
mod toml_help;
pub(crate) mod tree;
pub(crate) mod type_error;
pub(crate) mod wall_time;
