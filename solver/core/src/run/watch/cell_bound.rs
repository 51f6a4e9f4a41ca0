//! `CellBound`: the cells that a new mesh of a run may have, by its case, its first mesh and the memory that was taken.

use std::fmt;

use crate::case::Case;
use crate::motion::{MostCells, MovingMesh};
use crate::run::free_memory::{free_memory, taken_memory};
use crate::state::State;

/// Cells of a new mesh over those of the first one beyond which a gap closes without end, unless the case says how
/// many there may be. In 47 shipped cases and variants with moving bodies, run to their ends, it is 2.4 at most, where a
/// disc sinks to a wall, 2.1 where a sphere does so on the axis, and 1.02 in space; 17 of them take new meshes. Of coarse
/// meshes, about which heavy bodies bounce, it is up to 7.1 in the plane, where the gap falls to 0.3 % of a
/// diameter, 5.1 on the axis and 5.7 in space. Where nothing keeps a gap open any number is passed.
const GROWTH: f64 = 10.0;
/// Cells up to which a mesh is small, whatever the first one had, in the plane and in space. The largest in 600 runs of all
/// sorts with moving bodies, of those that grew to more than four times the first, had 2.6e4 and 6.9e4 cells.
const SMALL: [f64; 2] = [5e4, 2e5];

/// What a new mesh is measured by.
#[derive(Debug, Clone, Copy)]
pub struct CellBound {
    /// Cells that the case allows, if it says so.
    given: Option<usize>,
    /// Cells of the first mesh.
    first: usize,
    /// Memory of the process before the first system (bytes), where the system tells.
    before: Option<f64>,
}

/// The mesh at hand and how its system is solved.
#[derive(Debug, Clone, Copy)]
pub struct AtHand {
    /// Its cells.
    pub n_cells: usize,
    /// Whether iterations solve its system, and not factors.
    pub is_iterative: bool,
}

/// The cells that a new mesh may have, and by what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowed {
    /// How many.
    pub most: f64,
    /// By what.
    pub by: AllowedBy,
}

/// What allows no more cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AllowedBy {
    /// The case, by `mesh.max_cells`.
    Case,
    /// A first mesh of so many cells.
    First(usize),
    /// Memory.
    Memory {
        /// What the run takes with the mesh at hand (GB).
        taken: f64,
        /// Cells of that mesh.
        by: usize,
        /// What is free besides (GB).
        free: f64,
    },
}

impl fmt::Display for AllowedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Case => write!(f, "mesh.max_cells"),
            Self::First(cells) => {
                write!(f, "default, as the first one has {cells}: see mesh.max_cells")
            }
            Self::Memory { taken, by, free } => write!(
                f,
                "memory: the one of {by} cells takes {taken:.1} GB, and {free:.1} GB are free besides"
            ),
        }
    }
}

impl CellBound {
    /// None: of a mesh that is not that of a case.
    #[must_use]
    pub fn none() -> Self {
        Self { given: Some(usize::MAX), first: 0, before: None }
    }

    /// That of a run which begins with so many cells, before its first system is made.
    pub(in crate::run) fn new(case: &Case, first: usize) -> Self {
        Self { given: case.mesh.max_cells, first, before: taken_memory() }
    }

    /// What a mesh may have that takes the place of one.
    #[must_use]
    pub fn allowed<const D: usize>(&self, at_hand: AtHand) -> Allowed {
        let first = self.first as f64;
        let by_case = match self.given {
            Some(given) => Allowed { most: given as f64, by: AllowedBy::Case },
            None => {
                let most = (GROWTH * first).max(SMALL[usize::from(D == 3)]);
                Allowed { most, by: AllowedBy::First(self.first) }
            }
        };
        match self.by_memory::<D>(at_hand) {
            Some(by_memory) if by_memory.most < by_case.most => by_memory,
            _ => by_case,
        }
    }

    /// What fits into the memory that is free, by what the mesh at hand takes.
    fn by_memory<const D: usize>(&self, at_hand: AtHand) -> Option<Allowed> {
        let taken = (taken_memory()? - self.before?).max(0.0);
        let free = free_memory()?;
        let ratio = if taken > 0.0 { (taken + free) / taken } else { f64::INFINITY };
        let AtHand { n_cells, is_iterative } = at_hand;
        let most = n_cells as f64 * ratio.powf(1.0 / exponent::<D>(n_cells, is_iterative));
        let gigabytes = |bytes: f64| bytes / 1e9;
        let by = AllowedBy::Memory { taken: gigabytes(taken), by: n_cells, free: gigabytes(free) };
        Some(Allowed { most, by })
    }
}

/// The power of the number of cells by which memory grows: factors in nested dissection have n log n entries in the
/// plane and n^(4/3) in space (@george1973).
fn exponent<const D: usize>(n_cells: usize, is_iterative: bool) -> f64 {
    match (is_iterative, D) {
        (true, _) => 1.0,
        (false, 3) => 4.0 / 3.0,
        (false, _) => 1.0 + 1.0 / (n_cells.max(3) as f64).ln(),
    }
}

/// The smallest gap of a state in words, to be added to a sentence; nothing where there is none.
pub(in crate::run) fn nearest_gap<const D: usize>(
    state: &State<D>,
    moving: &MovingMesh<D>,
) -> String {
    let Some(minimum) = state.contact.minimum_gap else { return String::new() };
    let gaps = moving.gaps();
    let (body, partner) = (gaps.body_name(minimum.body), gaps.partner_name(minimum.partner));
    format!("; the smallest gap, {:.2e}, is between `{body}` and `{partner}`", minimum.gap)
}

impl Allowed {
    /// As meshes are measured by it.
    #[must_use]
    pub fn cells(&self) -> MostCells {
        MostCells(self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bound(given: Option<usize>, first: usize, before: Option<f64>) -> CellBound {
        CellBound { given, first, before }
    }

    const AT_HAND: AtHand = AtHand { n_cells: 1000, is_iterative: false };

    #[test]
    fn the_case_comes_before_the_growth_of_the_first_mesh() {
        let most = |given, first, space: bool| {
            let bound = bound(given, first, None);
            if space { bound.allowed::<3>(AT_HAND) } else { bound.allowed::<2>(AT_HAND) }
        };
        assert_eq!(most(None, 100, false).most, SMALL[0]);
        assert_eq!(most(None, 100, true).most, SMALL[1]);
        assert_eq!(most(None, 40_000, true).most, 4e5);
        assert_eq!(most(None, 40_000, true).by, AllowedBy::First(40_000));
        let given = most(Some(70), 40_000, true);
        assert_eq!(given, Allowed { most: 70.0, by: AllowedBy::Case });
    }

    #[test]
    fn what_was_taken_says_what_fits() {
        let (Some(taken), Some(free)) = (taken_memory(), free_memory()) else { return };
        // As if nearly all that is free were taken by the mesh at hand
        let before = taken - 100.0 * free;
        let allowed = bound(None, 1000, Some(before)).allowed::<2>(AT_HAND);
        assert!((1000.0..1020.0).contains(&allowed.most), "{allowed:?}");
        let text = allowed.by.to_string();
        assert!(text.contains("of 1000 cells takes") && text.contains("GB are free"), "{text}");
        // And as if it had taken next to nothing
        let allowed = bound(None, 1000, Some(taken)).allowed::<2>(AT_HAND);
        assert_eq!(allowed.by, AllowedBy::First(1000));
    }
}
