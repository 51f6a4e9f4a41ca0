//! Domains that are given: a mesh of Gmsh in a file, or a closed surface whose inside is meshed.

pub(crate) mod contents;
pub(crate) mod mesh_file;
pub(crate) mod region_mesh;
pub(crate) mod region_spec;
