//! Speed of assembly, linear solver and mesh motion: `cargo bench -p benches`.
