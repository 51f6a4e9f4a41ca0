//! `DiscGrid`: which discs may meet, by the cells of a grid they lie in.

use alewife_mesh::{Point, whole};

/// Most cells along an axis.
const MOST_CELLS: usize = 1024;

/// Part of a radius by which discs are taken larger, so that rounding loses none.
const ROUNDING: f64 = 1e-9;

/// A disc.
#[derive(Debug, Clone, Copy)]
pub struct Disc {
    /// Centre (m).
    pub center: Point<2>,
    /// Radius (m).
    pub radius: f64,
}

/// Numbered discs in the cells of a rectangle; what lies outside counts to the nearest cells.
pub struct DiscGrid {
    min: [f64; 2],
    /// Cells per length along x and y (1/m).
    density: [f64; 2],
    counts: [usize; 2],
    cells: Vec<Vec<usize>>,
}

impl DiscGrid {
    /// An empty grid between two corners (m), with about as many cells as discs are expected.
    pub fn new(min: [f64; 2], max: [f64; 2], expected: usize) -> Self {
        let size = [0, 1].map(|axis| max[axis] - min[axis]);
        // Roots first: the area of a domain in wrong units may be too small for a number
        let spacing = size[0].sqrt() * size[1].sqrt() / (expected.max(1) as f64).sqrt();
        let counts = size.map(|length| 1 + whole(length / spacing).min(MOST_CELLS - 1));
        let density = [0, 1].map(|axis| counts[axis] as f64 / size[axis]);
        Self { min, density, counts, cells: vec![Vec::new(); counts[0] * counts[1]] }
    }

    /// Adds a disc.
    pub fn insert(&mut self, number: usize, disc: &Disc) {
        let [columns, rows] = self.ranges(disc);
        for row in rows {
            for column in columns.clone() {
                self.cells[row * self.counts[0] + column].push(number);
            }
        }
    }

    /// All discs that may meet a disc, some of them more than once, and others near it.
    pub fn near(&self, disc: &Disc) -> impl Iterator<Item = usize> + use<'_> {
        let [columns, rows] = self.ranges(disc);
        rows.flat_map(move |row| columns.clone().map(move |column| (row, column)))
            .flat_map(|(row, column)| self.cells[row * self.counts[0] + column].iter().copied())
    }

    /// Columns and rows of the cells around a disc.
    fn ranges(&self, disc: &Disc) -> [std::ops::RangeInclusive<usize>; 2] {
        let Disc { center, radius } = *disc;
        let radius = radius * (1.0 + ROUNDING);
        [0, 1].map(|axis| {
            let cell = |x: f64| {
                whole((x - self.min[axis]) * self.density[axis]).min(self.counts[axis] - 1)
            };
            cell(center[axis] - radius)..=cell(center[axis] + radius)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1) without a pattern, by the golden ratio.
    fn scattered(nth: usize) -> f64 {
        (nth as f64 * 0.618_033_988_749).fract()
    }

    #[test]
    fn no_disc_that_meets_another_is_missed() {
        let discs: Vec<Disc> = (0..300)
            .map(|nth| {
                let (x, y) = (scattered(nth), scattered(7 * nth + 3));
                // Some outside the grid, and a few that are large
                let radius = if nth % 50 == 0 { 3.0 } else { 0.2 * scattered(3 * nth) };
                Disc { center: Point::<2>::new(12.0 * x - 1.0, 6.0 * y - 1.0), radius }
            })
            .collect();
        let mut grid = DiscGrid::new([0.0, 0.0], [10.0, 4.0], discs.len());
        for (nth, disc) in discs.iter().enumerate() {
            grid.insert(nth, disc);
        }
        let mut looked_at = 0;
        for one in &discs {
            let near: Vec<usize> = grid.near(one).collect();
            looked_at += near.len();
            for (nth, other) in discs.iter().enumerate() {
                let meet = (one.center - other.center).norm() <= one.radius + other.radius;
                assert!(!meet || near.contains(&nth), "{one:?} {other:?}");
            }
        }
        assert!(looked_at < discs.len() * discs.len() / 3, "{looked_at} of all pairs");
    }

    #[test]
    fn a_rectangle_of_no_size_has_one_cell() {
        let mut grid = DiscGrid::new([0.0, 1.0], [5.0, 1.0], 10);
        let disc = |x: f64| Disc { center: Point::<2>::new(x, 1.0), radius: 0.1 };
        grid.insert(4, &disc(2.0));
        assert!(grid.near(&disc(2.1)).any(|found| found == 4));
    }

    #[test]
    fn cells_are_about_as_many_as_discs_whatever_the_units() {
        for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let n_cells = DiscGrid::new([0.0, 0.0], [size, 2.0 * size], 10).cells.len();
            assert!((10..30).contains(&n_cells), "{size:e}: {n_cells}");
        }
    }
}
