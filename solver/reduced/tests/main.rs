//! The soft tier: gradients against differences, searches, and a twin of a recorded swimmer.

mod gradients;
mod searches;
mod swimmers;
mod twin;
