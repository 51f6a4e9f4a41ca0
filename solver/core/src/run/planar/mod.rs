//! What is planar by nature in a run: outlines, the cut of periodic domains, meshes of triangles.

mod case;
mod periodic_cell;
mod resume;
mod scene;
mod start;
