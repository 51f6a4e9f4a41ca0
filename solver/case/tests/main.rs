//! Case files through the door of the crate: files they name, and files with mistakes.

mod mesh_files;
mod mutations;
mod reference_tables;
mod stroke_files;
