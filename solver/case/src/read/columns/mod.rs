//! Keys that stand for many points: files of seeds and midlines, lines of probes.

pub mod midline_file;
pub mod point_file;
pub mod probe_line;
pub mod profile_file;
pub mod seed_file;
