//! `Twins`: vertices on periodic sides that stand for the same point of the fluid.
//!
//! Opposite sides have equal faces from the lattice on, because an edge on one of them is split together with
//! its images; after that nothing on periodic sides changes any more.

use super::improver::Improver;
use super::surface_set::SurfaceSet;
use crate::Point;

/// Difference of two edges that are images, over their length.
const ROUNDING: f64 = 1e-6;

/// Rings of vertices that are images of each other.
#[derive(Debug, Clone, Default)]
pub struct Twins {
    /// The next vertex of the ring of each, itself where it has no image; none after the last.
    next: Vec<u32>,
}

impl Twins {
    /// From now on these vertices are images of each other.
    pub fn link(&mut self, ring: &[u32]) {
        let end = ring.iter().max().map_or(0, |last| last + 1);
        for vertex in crate::number::index_u32(self.next.len())..end {
            self.next.push(vertex);
        }
        for (at, vertex) in ring.iter().enumerate() {
            self.next[*vertex as usize] = ring[(at + 1) % ring.len()];
        }
    }

    /// A vertex and its images.
    pub fn of(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |at: &u32| self.next.get(*at as usize).copied().filter(|v| *v != vertex);
        std::iter::successors(Some(vertex), next)
    }
}

impl Improver<'_> {
    /// Whether what is on these surfaces stays as it is, being on a periodic side.
    pub fn is_fixed(&self, surfaces: SurfaceSet) -> bool {
        let sides = &self.geometry.surfaces;
        surfaces.as_slice().iter().any(|surface| sides[usize::from(*surface)].is_periodic)
    }

    /// An edge, and its images where it is on a periodic side.
    pub fn images(&self, ends: [u32; 2]) -> Vec<[u32; 2]> {
        let [a, b] = ends;
        let mut images = vec![ends];
        if self.is_fixed(self.mesh.edge_surfaces(a, b)) {
            let along = self.mesh.point(b) - self.mesh.point(a);
            let is_image = |[c, d]: [u32; 2]| {
                let other = self.mesh.point(d) - self.mesh.point(c);
                (other - along).norm() < ROUNDING * along.norm()
                    && self.is_fixed(self.mesh.edge_surfaces(c, d))
            };
            for c in self.twins.of(a).skip(1) {
                images.extend(self.twins.of(b).map(|d| [c, d]).filter(|edge| is_image(*edge)));
            }
        }
        images
    }

    /// Cells around an edge and its images.
    pub fn shell_of_images(&self, ends: [u32; 2], cells: &mut Vec<u32>) {
        self.mesh.shell(ends[0], ends[1], cells);
        let mut of_image = Vec::new();
        for [a, b] in self.images(ends).into_iter().skip(1) {
            self.mesh.shell(a, b, &mut of_image);
            cells.append(&mut of_image);
        }
    }

    /// The image of a vertex with the smallest coordinates along the axes of periodic sides that some
    /// surfaces include as those with the largest; itself where there is none.
    pub fn original(&self, vertex: u32, surfaces: SurfaceSet) -> u32 {
        let mut place = self.mesh.point(vertex);
        for side in surfaces.as_slice().iter().map(|surface| usize::from(*surface)) {
            if self.geometry.surfaces[side].is_periodic && !side.is_multiple_of(2) {
                place[side / 2] -= self.geometry.periods[side / 2];
            }
        }
        let distance = |v: &u32| (self.mesh.point(*v) - place).norm();
        let nearest = self.twins.of(vertex).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or(vertex)
    }
}

/// The shifts by whole periods from a box to itself and those around it, itself first.
pub fn shifts(periods: &Point<3>) -> Vec<Point<3>> {
    let mut all = vec![Point::<3>::zeros()];
    for axis in (0..3).filter(|axis| periods[*axis] > 0.0) {
        for at in 0..all.len() {
            for sign in [-1.0, 1.0] {
                let mut shift = all[at];
                shift[axis] += sign * periods[axis];
                all.push(shift);
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_closed() {
        let mut twins = Twins::default();
        twins.link(&[4, 1, 7]);
        assert_eq!(twins.of(1).collect::<Vec<_>>(), [1, 7, 4]);
        assert_eq!(twins.of(3).collect::<Vec<_>>(), [3]);
        assert_eq!(twins.of(30).collect::<Vec<_>>(), [30]);
    }

    #[test]
    fn a_box_has_neighbours_along_its_periods() {
        assert_eq!(shifts(&Point::<3>::zeros()).len(), 1);
        let all = shifts(&Point::<3>::new(2.0, 0.0, 3.0));
        assert_eq!((all.len(), all[0]), (9, Point::<3>::zeros()));
        assert!(all.contains(&Point::<3>::new(-2.0, 0.0, 3.0)));
    }
}
