//! Matrices of the shipped cases, at the start and in the middle of runs, and of rods in space.

mod all;
mod middle;
mod rods;
mod start;
