//! `Passes`: Anderson's acceleration of the fixed-point iteration for coordinates of bodies (@anderson1965).
//!
//! Moving the surface of a soft body changes its load. Where that is more than the body resists, coordinates that are
//! taken over as they are reached lead away from the solution. Those of the last passes are then combined so that the
//! same combination of their changes is least.

use nalgebra::{DMatrix, DVector};

/// Passes that are combined at most.
const DEPTH: usize = 5;
/// Change of the coordinates over that of the pass before up to which they are taken as they are reached.
const CONTRACTS: f64 = 0.5;
/// Change over that of the first pass from which on a step is too long.
const GROWTH: f64 = 2.0;
/// Change over the size of the coordinates that is none.
const NOTABLE: f64 = 1e-8;
/// Singular values over the largest one that say nothing.
const RANK: f64 = 1e-10;

/// What the passes of a step have given so far.
#[derive(Debug, Default)]
pub struct Passes {
    /// Coordinates a pass was solved for and how they changed, the last one last.
    all: Vec<Pass>,
    /// Change in the first pass.
    first: f64,
}

#[derive(Debug)]
struct Pass {
    at: DVector<f64>,
    change: DVector<f64>,
}

impl Passes {
    /// The coordinates that the next pass is solved for, after one for `at` has reached others; `None` where passes grow.
    pub fn next(&mut self, at: &[f64], reached: &[f64]) -> Option<Vec<f64>> {
        let at = DVector::from_column_slice(at);
        let change = DVector::from_column_slice(reached) - &at;
        let (size, last) = (change.norm(), self.all.last().map(|pass| pass.change.norm()));
        let contracts = last.is_none_or(|last| size <= CONTRACTS * last);
        self.all.push(Pass { at, change });
        if self.all.len() == 1 {
            self.first = size;
        }
        if self.all.len() > DEPTH {
            self.all.remove(0);
        }
        if size > GROWTH * self.first && size > NOTABLE * self.all[0].at.norm() {
            return None;
        }
        if contracts { Some(reached.to_vec()) } else { Some(self.combined()) }
    }

    /// The combination of the passes.
    fn combined(&self) -> Vec<f64> {
        let (Some((last, before)), Some(n)) =
            (self.all.split_last(), self.all.first().map(|pass| pass.at.len()))
        else {
            return Vec::new();
        };
        let column = |of: fn(&Pass) -> &DVector<f64>| {
            let columns: Vec<DVector<f64>> =
                before.iter().map(|pass| of(last) - of(pass)).collect();
            DMatrix::from_fn(n, columns.len(), |i, j| columns[j][i])
        };
        let (ways, changes) = (column(|pass| &pass.at), column(|pass| &pass.change));
        let fit = changes.clone().svd(true, true);
        let smallest = RANK * fit.singular_values.max();
        let weights = fit.solve(&last.change, smallest).unwrap_or(DVector::zeros(before.len()));
        let next = &last.at + &last.change - (ways + changes) * weights;
        next.as_slice().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x -> A x + b with an eigenvalue of -1.6, by which plain iterations grow.
    fn map(x: &[f64]) -> Vec<f64> {
        vec![-1.6 * x[0] + 0.2 * x[1] + 1.0, 0.1 * x[0] + 0.3 * x[1] - 2.0, 0.5 * x[2]]
    }

    #[test]
    fn an_iteration_that_grows_by_itself_converges() {
        let mut passes = Passes::default();
        let mut x = vec![0.1, 0.0, 0.4];
        let mut sizes = Vec::new();
        for _ in 0..7 {
            let reached = map(&x);
            sizes.push(x.iter().zip(&reached).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max));
            x = passes.next(&x, &reached).expect("it does not grow");
        }
        assert!(sizes[6] < 1e-9 * sizes[0], "{sizes:?}");
    }

    #[test]
    fn what_contracts_is_taken_as_it_is_and_what_grows_is_given_up() {
        let mut passes = Passes::default();
        assert_eq!(passes.next(&[1.0], &[0.5]), Some(vec![0.5]));
        assert_eq!(passes.next(&[0.5], &[0.6]), Some(vec![0.6]));
        assert_eq!(passes.next(&[0.6], &[2.6]), None);
    }
}
