//! Files that a case names: what is in them takes the place of their names.

pub mod calibrated_file;
pub(crate) mod data_files;
pub mod hole_shape;
pub mod outline_file;
pub mod periodic_sides;
pub mod read_mesh;
pub mod region_file;
pub mod stroke_file;
pub mod surface_file;
