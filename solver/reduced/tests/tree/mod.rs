//! The reduced tier: laws of loads, equations of motion, orders in time, derivatives.

mod chains;
mod derivatives;
mod ellipsoid;
mod elongated;
mod energy;
mod fits;
mod joints;
mod motions;
mod stokes;
mod vehicle;
