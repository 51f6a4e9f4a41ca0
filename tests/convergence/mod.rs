//! Orders of convergence on exact and manufactured solutions: velocity L2 3, H1 2, pressure 2;
//! BDF2 2 in time; slip along bodies; adaptive steps past jumps.

mod jumps;
mod profiles;
mod sides;
mod slip;
mod space;
mod spatial;
mod time;
