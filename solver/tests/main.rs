//! The program, from its command line.

mod command_line;
mod driven;
mod endings;
mod environment;
mod gradients;
mod optimise;
mod reduced;
mod refusals;
mod soft;
