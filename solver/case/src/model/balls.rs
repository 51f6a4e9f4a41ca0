//! `BallGrid`: which balls, of the plane discs, may meet, by the cells of a grid they lie in.

use alewife_mesh::{Point, whole};

/// Most cells along an axis.
const MOST_CELLS: usize = 1024;

/// Part of a radius by which balls are taken larger, so that rounding loses none.
const ROUNDING: f64 = 1e-9;

/// A disc of the plane, or a ball.
#[derive(Debug, Clone, Copy)]
pub struct Ball<const D: usize> {
    /// Centre (m).
    pub center: Point<D>,
    /// Radius (m).
    pub radius: f64,
}

/// Numbered balls in the cells of a box; what lies outside counts to the nearest cells.
pub struct BallGrid<const D: usize> {
    min: Point<D>,
    /// Cells per length along each axis (1/m).
    density: Point<D>,
    counts: [usize; D],
    cells: Vec<Vec<usize>>,
}

impl<const D: usize> BallGrid<D> {
    /// An empty grid between two corners (m), with about as many cells as balls are expected.
    pub fn new(min: Point<D>, max: Point<D>, expected: usize) -> Self {
        let size = max - min;
        let root = |value: f64| value.powf(1.0 / D as f64);
        // Roots first: the volume of a domain in wrong units may be too small for a number
        let spacing = size.map(root).product() / root(expected.max(1) as f64);
        let counts: [usize; D] =
            std::array::from_fn(|axis| 1 + whole(size[axis] / spacing).min(MOST_CELLS - 1));
        let density = Point::<D>::from_fn(|axis, _| counts[axis] as f64 / size[axis]);
        Self { min, density, counts, cells: vec![Vec::new(); counts.iter().product()] }
    }

    /// Adds a ball.
    pub fn insert(&mut self, number: usize, ball: &Ball<D>) {
        for cell in self.cells_around(ball) {
            self.cells[cell].push(number);
        }
    }

    /// All balls that may meet a ball, some of them more than once, and others near it.
    pub fn near(&self, ball: &Ball<D>) -> impl Iterator<Item = usize> + use<'_, D> {
        self.cells_around(ball).into_iter().flat_map(|cell| self.cells[cell].iter().copied())
    }

    /// The cells around a ball.
    fn cells_around(&self, ball: &Ball<D>) -> Vec<usize> {
        let Ball { center, radius } = *ball;
        let radius = radius * (1.0 + ROUNDING);
        let mut cells = vec![0];
        for axis in (0..D).rev() {
            let last = self.counts[axis] - 1;
            let cell = |x: f64| whole((x - self.min[axis]) * self.density[axis]).min(last);
            let range = cell(center[axis] - radius)..=cell(center[axis] + radius);
            let count = self.counts[axis];
            let along = |start: usize| range.clone().map(move |cell| start * count + cell);
            cells = cells.into_iter().flat_map(along).collect();
        }
        cells
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
        let discs: Vec<Ball<2>> = (0..300)
            .map(|nth| {
                let (x, y) = (scattered(nth), scattered(7 * nth + 3));
                // Some outside the grid, and a few that are large
                let radius = if nth % 50 == 0 { 3.0 } else { 0.2 * scattered(3 * nth) };
                Ball { center: Point::<2>::new(12.0 * x - 1.0, 6.0 * y - 1.0), radius }
            })
            .collect();
        let mut grid = BallGrid::<2>::new([0.0, 0.0].into(), [10.0, 4.0].into(), discs.len());
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
    fn no_ball_of_space_that_meets_another_is_missed() {
        let ball = |nth: usize| {
            let at = |factor: usize| 4.0 * scattered(factor * nth + factor);
            Ball { center: Point::<3>::new(at(1), at(7), at(13)), radius: 0.5 * scattered(3 * nth) }
        };
        let balls: Vec<Ball<3>> = (0..200).map(ball).collect();
        let mut grid = BallGrid::new(Point::<3>::zeros(), Point::<3>::repeat(4.0), balls.len());
        for (nth, ball) in balls.iter().enumerate() {
            grid.insert(nth, ball);
        }
        for one in &balls {
            let near: Vec<usize> = grid.near(one).collect();
            for (nth, other) in balls.iter().enumerate() {
                let meet = (one.center - other.center).norm() <= one.radius + other.radius;
                assert!(!meet || near.contains(&nth), "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn a_rectangle_of_no_size_has_one_cell() {
        let mut grid = BallGrid::<2>::new([0.0, 1.0].into(), [5.0, 1.0].into(), 10);
        let disc = |x: f64| Ball { center: Point::<2>::new(x, 1.0), radius: 0.1 };
        grid.insert(4, &disc(2.0));
        assert!(grid.near(&disc(2.1)).any(|found| found == 4));
    }

    #[test]
    fn cells_are_about_as_many_as_discs_whatever_the_units() {
        for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let n_cells =
                BallGrid::<2>::new([0.0, 0.0].into(), [size, 2.0 * size].into(), 10).cells.len();
            assert!((10..30).contains(&n_cells), "{size:e}: {n_cells}");
        }
    }
}
