//! What crosses rooms: orders of convergence, coupling, whole runs, architecture, pages.

mod architecture;
mod convergence;
mod coupling;
mod documentation;
mod linear_solver;
mod motion;
mod moving;
mod shear;
mod spatial;
mod swimming;
