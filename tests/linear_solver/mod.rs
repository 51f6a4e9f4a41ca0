//! Matrices of the shipped cases, at the start and in the middle of runs.

mod all;
mod middle;
mod start;
