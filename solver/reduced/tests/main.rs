//! The soft tier: gradients against differences, cases, searches, and a twin of a recorded swimmer; the reduced tier.

mod angles;
mod bar;
mod cases;
mod given;
mod gradients;
mod kept_volumes;
mod proposals;
mod rigid_parts;
mod searches;
mod shipped;
mod surfaces;
mod swimmers;
mod tree;
mod twin;
