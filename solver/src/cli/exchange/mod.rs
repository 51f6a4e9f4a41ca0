//! `export` and `import`: models of robots, MJCF and URDF.

mod export;
mod import;

pub use export::{ExportOptions, export};
pub use import::{ImportOptions, import};
