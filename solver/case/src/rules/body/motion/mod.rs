//! Problems of how bodies move as a whole.

pub(in crate::rules) mod by_axis;
pub(in crate::rules) mod initial;
pub(in crate::rules) mod locked;
pub(in crate::rules) mod mass;
