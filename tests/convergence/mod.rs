//! Orders of convergence on exact and manufactured solutions: velocity L2 3, H1 2, pressure 2;
//! BDF2 2 in time.

mod profiles;
mod sides;
mod space;
mod spatial;
mod time;
