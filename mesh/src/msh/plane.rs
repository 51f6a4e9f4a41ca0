//! `Plane`: where nodes are, scaled, those of a planar mesh without the z that all of them have.

use super::error::MshError;
use super::file::MshFile;
use super::parts::Middle;
use crate::Point;

/// Differences of z in a plane that count as none, in lengths of the mesh.
const IN_PLANE: f64 = 1e-9;

/// Where nodes are: scaled, and in the plane without the z that all of them have.
pub struct Plane {
    scale: f64,
    z: f64,
}

impl Plane {
    /// That of the first vertex of a cell.
    pub fn of<const D: usize>(file: &MshFile, scale: f64) -> Self {
        let cells = file.blocks.iter().filter(|block| block.kind.dimension == D);
        let first = cells.filter_map(|block| block.nodes.first()).next();
        let z = first.and_then(|tag| file.nodes.get(tag)).map_or(0.0, |point| point.z * scale);
        Self { scale, z: if D == 2 { z } else { 0.0 } }
    }

    /// What is said of it.
    pub fn notes(&self) -> Vec<String> {
        let note = format!("the mesh lies in the plane z = {}, which is taken for z = 0", self.z);
        if self.z == 0.0 { Vec::new() } else { vec![note] }
    }

    /// Position of a node (m).
    ///
    /// # Errors
    /// When it is beyond all bounds, or not in the plane.
    pub fn position<const D: usize>(&self, file: &MshFile, tag: u64) -> Result<Point<D>, MshError> {
        let point = file.nodes.get(&tag).copied().unwrap_or_default() * self.scale;
        if !point.iter().all(|x| x.is_finite() && x.abs() < 1e100) {
            let found = format!("node {tag} is at {:e}", point.amax());
            return Err(MshError::of_mesh(found, "coordinates below 1e100 are read"));
        }
        if D == 2 && (point.z - self.z).abs() > IN_PLANE * point.amax() {
            let found = format!("node {tag} has z = {:e}, others {:e}", point.z, self.z);
            let accepted = "the mesh of a planar case lies in a plane of equal z: turn it there";
            return Err(MshError::of_mesh(found, accepted));
        }
        Ok(Point::from_fn(|axis, _| point[axis]))
    }

    /// The middle of an edge between ends (m), by its inner nodes.
    ///
    /// # Errors
    /// As for positions.
    pub fn middle<const D: usize>(
        &self,
        file: &MshFile,
        inner: &[u64],
        [start, end]: [Point<D>; 2],
    ) -> Result<Middle<D>, MshError> {
        let (first, last) = (inner[0], inner[inner.len() - 1]);
        let [one, other] = [self.position::<D>(file, first)?, self.position::<D>(file, last)?];
        let point = if inner.len() == 1 {
            one
        } else {
            // Of the cubic through all four
            (one + other) * (9.0 / 16.0) - (start + end) * (1.0 / 16.0)
        };
        Ok(Middle { tag: first.min(last), point })
    }
}
