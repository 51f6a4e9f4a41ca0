//! What crosses rooms: orders of convergence, coupling, whole runs, architecture, pages.

mod architecture;
mod convergence;
mod coupling;
mod documentation;
mod gradient;
mod linear_solver;
mod motion;
mod moving;
mod session;
mod shear;
mod spatial;
mod swimming;
