//! The soft tier: gradients against differences, searches, and a twin of a recorded swimmer; the reduced tier.

mod gradients;
mod searches;
mod swimmers;
mod tree;
mod twin;
