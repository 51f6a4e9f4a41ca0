//! `EarlierSolutions`: first approximations of A x = b from solutions of earlier systems (@fischer1998).

use std::collections::VecDeque;
use std::sync::Arc;

use super::matrix::Blocks;

/// Solutions that are kept.
const KEPT: usize = 6;
/// An image that is smaller than this part of what it was before those of the others were taken off
/// is rounding.
const DEPENDENT: f64 = 1e-4;

/// The solutions found last, the oldest first.
#[derive(Debug, Clone, Default)]
pub(super) struct EarlierSolutions {
    solutions: VecDeque<Arc<Blocks>>,
}

impl EarlierSolutions {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.solutions.is_empty()
    }

    /// The combination x of earlier solutions with the least |b - A x|.
    ///
    /// `multiply` overwrites its second argument with A times the first, after it has given the first the
    /// scales of A.
    pub fn guess(&self, mut multiply: impl FnMut(&mut Blocks, &mut Blocks), b: &Blocks) -> Blocks {
        let mut residual = b.clone();
        let mut guess = b.zeros_alike();
        let mut images: Vec<Blocks> = Vec::new();
        let mut sources: Vec<Blocks> = Vec::new();
        // The latest first: it is the closest
        for solution in self.solutions.iter().rev() {
            let mut source = Blocks::clone(solution);
            let size = source.norm();
            if size == 0.0 || !size.is_finite() {
                continue;
            }
            source.scale(1.0 / size);
            let mut image = b.zeros_alike();
            multiply(&mut source, &mut image);
            let before = image.norm();
            for (earlier, from) in images.iter().zip(&sources) {
                let part = earlier.dot(&image);
                image.add(-part, earlier);
                source.add(-part, from);
            }
            let size = image.norm();
            if !size.is_finite() || size <= DEPENDENT * before {
                continue;
            }
            image.scale(1.0 / size);
            source.scale(1.0 / size);
            let part = image.dot(&residual);
            residual.add(-part, &image);
            guess.add(part, &source);
            images.push(image);
            sources.push(source);
        }
        guess
    }

    /// All of them, the oldest first.
    pub fn iter(&self) -> impl Iterator<Item = &Blocks> {
        self.solutions.iter().map(Arc::as_ref)
    }

    /// Takes note of a solution.
    pub fn keep(&mut self, solution: Blocks) {
        if self.solutions.len() == KEPT {
            self.solutions.pop_front();
        }
        self.solutions.push_back(Arc::new(solution));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 20;

    fn vector(value: impl Fn(usize) -> f32) -> Blocks {
        let mut vector = Blocks::zeros(0, N);
        vector.pressure = (0..N).map(value).collect();
        vector
    }

    /// A matrix that is not symmetric.
    fn multiply(x: &mut Blocks, y: &mut Blocks) {
        for row in 0..N {
            let next = x.pressure[(row + 1) % N];
            y.pressure[row] = (3.0 + row as f32) * x.pressure[row] - next;
        }
    }

    fn left_by(x: &Blocks, b: &Blocks) -> Blocks {
        let mut image = b.zeros_alike();
        multiply(&mut x.clone(), &mut image);
        let mut residual = b.clone();
        residual.add(-1.0, &image);
        residual
    }

    #[test]
    fn sums_of_earlier_solutions_are_found_at_once() {
        let mut earlier = EarlierSolutions::default();
        let solution = |k: usize| vector(|i| ((i * (k + 2)) as f32).sin());
        (0..4).for_each(|k| earlier.keep(solution(k)));
        // Once more: it adds nothing
        earlier.keep(solution(3));
        let mut wanted = solution(1);
        wanted.scale(2.0);
        wanted.add(-0.5, &solution(3));
        let mut b = wanted.zeros_alike();
        multiply(&mut wanted, &mut b);
        let mut x = earlier.guess(multiply, &b);
        assert!(left_by(&x, &b).norm() < 1e-5 * b.norm());
        x.add(-1.0, &wanted);
        assert!(x.norm() < 1e-5 * wanted.norm());
    }

    #[test]
    fn what_the_guess_leaves_is_the_least() {
        let mut earlier = EarlierSolutions::default();
        for k in 0..9 {
            earlier.keep(vector(|i| ((i + k * k) as f32).cos()));
        }
        assert_eq!(earlier.solutions.len(), KEPT);
        let b = vector(|i| (i % 3) as f32);
        let x = earlier.guess(multiply, &b);
        let residual = left_by(&x, &b);
        assert!(residual.norm() < b.norm());
        for solution in &earlier.solutions {
            let mut image = b.zeros_alike();
            multiply(&mut Blocks::clone(solution), &mut image);
            assert!(image.dot(&residual).abs() < 1e-3 * image.norm() * b.norm());
        }
    }

    #[test]
    fn solutions_may_have_other_scales_than_the_matrix() {
        let mut earlier = EarlierSolutions::default();
        let solution = vector(|i| (i as f32).sin());
        earlier.keep(solution.clone());
        let mut doubled = solution;
        doubled.scale(2.0);
        let mut b = doubled.zeros_alike();
        multiply(&mut doubled, &mut b);
        let scaled = |x: &mut Blocks, y: &mut Blocks| {
            x.scale(2.0);
            multiply(x, y);
        };
        let x = earlier.guess(scaled, &b);
        assert!(left_by(&x, &b).norm() < 1e-5 * b.norm());
    }
}
