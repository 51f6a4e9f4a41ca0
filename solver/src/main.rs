//! The program `alewife`.
fn main() {}
