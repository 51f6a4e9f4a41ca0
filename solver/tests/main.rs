//! The program, from its command line.

mod command_line;
mod reduced;
mod refusals;
mod soft;
