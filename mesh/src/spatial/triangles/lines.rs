//! What readers of files of triangles share.

use super::SurfaceFault;

/// A fault of a file at a line, counted from 0.
pub fn at_line(line: usize, found: impl Into<String>) -> SurfaceFault {
    SurfaceFault::File { place: format!("line {}", line + 1), found: found.into() }
}

/// The triangles of a polygon with these corners, as a fan.
pub fn fan(polygon: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    (2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]])
}
