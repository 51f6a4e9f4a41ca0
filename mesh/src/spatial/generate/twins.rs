//! `Twins`: vertices on periodic sides that stand for the same point of the fluid.
//!
//! Opposite sides have equal faces from the lattice on, because an edge on one of them is split together with
//! its images; after that nothing on periodic sides changes any more.

use crate::Point;

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
