//! Swimmers without a flow: loads by laws, gradients of whole motions, calibration and optimisation.

pub mod search;
pub mod soft;
pub mod tier;
pub mod tree;
