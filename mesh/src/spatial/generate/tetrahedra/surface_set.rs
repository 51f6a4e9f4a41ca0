//! `SurfaceSet`: the smooth surfaces a vertex or an edge lies on, up to three.

/// Stands for no surface, in ascending order behind all others.
const NONE: u16 = u16::MAX;

/// Up to three surfaces: none inside the fluid, one on a face, two on a ridge, three at a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceSet([u16; 3]);

impl SurfaceSet {
    /// The set without surfaces.
    pub const EMPTY: Self = Self([NONE; 3]);

    /// The set of one surface.
    pub fn of(surface: u16) -> Self {
        Self([surface, NONE, NONE])
    }

    /// The surfaces, ascending.
    pub fn as_slice(&self) -> &[u16] {
        &self.0[..self.len()]
    }

    /// Number of surfaces.
    pub fn len(self) -> usize {
        self.0.iter().filter(|surface| **surface != NONE).count()
    }

    /// Whether there is none.
    pub fn is_empty(self) -> bool {
        self.0[0] == NONE
    }

    /// Whether a surface is in the set.
    pub fn contains(self, surface: u16) -> bool {
        self.0.contains(&surface)
    }

    /// Whether all surfaces are in another set, too.
    pub fn is_subset_of(self, other: Self) -> bool {
        self.as_slice().iter().all(|surface| other.contains(*surface))
    }

    /// Whether two sets have a surface in common.
    pub fn meets(self, other: Self) -> bool {
        self.as_slice().iter().any(|surface| other.contains(*surface))
    }

    /// The set with one more surface; `None` where there is no room for it.
    pub fn with(self, surface: u16) -> Option<Self> {
        if self.contains(surface) {
            return Some(self);
        }
        let [a, b, c] = self.0;
        if c != NONE {
            return None;
        }
        let mut all = [a, b, surface];
        all.sort_unstable();
        Some(Self(all))
    }

    /// All surfaces of two sets, the first three of them.
    pub fn union(self, other: Self) -> Self {
        other.as_slice().iter().fold(self, |all, surface| all.with(*surface).unwrap_or(all))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_ordered_and_hold_three() {
        let set = SurfaceSet::of(7).with(2).unwrap();
        assert_eq!(set.as_slice(), [2, 7]);
        assert_eq!(set.with(2), Some(set));
        let full = set.with(4).unwrap();
        assert_eq!((full.as_slice(), full.with(9)), ([2, 4, 7].as_slice(), None));
        assert!(set.is_subset_of(full) && !full.is_subset_of(set));
        assert!(set.meets(SurfaceSet::of(7)) && !set.meets(SurfaceSet::of(3)));
        assert!(!SurfaceSet::EMPTY.meets(SurfaceSet::EMPTY));
        assert_eq!(SurfaceSet::of(4).union(set), full);
    }
}
