//! What is planar by nature in a run: outlines, meshes of triangles.

mod case;
mod resume;
mod scene;
mod start;
