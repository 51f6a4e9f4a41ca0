//! `EarlierSolutions`: first approximations of A x = b from solutions of earlier systems (@fischer1998).

use super::super::krylov::{dot, norm, subtract};

/// Solutions that are kept.
const KEPT: usize = 6;
/// An image that is smaller than this part of what it was before those of the others were taken off
/// adds nothing.
const DEPENDENT: f64 = 1e-6;

/// The solutions found last, the oldest first.
#[derive(Debug, Default)]
pub(super) struct EarlierSolutions {
    solutions: Vec<Vec<f64>>,
}

/// The combination of earlier solutions with the least residual.
#[derive(Debug)]
pub(super) struct Guess {
    /// The approximation.
    pub x: Vec<f64>,
    /// b - A x.
    pub residual: Vec<f64>,
}

impl EarlierSolutions {
    /// The combination x of earlier solutions with the least |b - A x|.
    pub fn guess(&self, multiply: impl Fn(&[f64], &mut [f64]), b: &[f64]) -> Guess {
        let n = b.len();
        let mut guess = Guess { x: vec![0.0; n], residual: b.to_vec() };
        let mut images: Vec<Vec<f64>> = Vec::new();
        let mut sources: Vec<Vec<f64>> = Vec::new();
        // The latest first: it is the closest
        for solution in self.solutions.iter().rev() {
            let (mut source, mut image) = (solution.clone(), vec![0.0; n]);
            multiply(&source, &mut image);
            let before = norm(&image);
            for (earlier, from) in images.iter().zip(&sources) {
                let part = dot(earlier, &image);
                subtract(part, earlier, &mut image);
                subtract(part, from, &mut source);
            }
            let size = norm(&image);
            if !size.is_finite() || size <= DEPENDENT * before {
                continue;
            }
            image.iter_mut().chain(source.iter_mut()).for_each(|value| *value /= size);
            let part = dot(&image, &guess.residual);
            subtract(part, &image, &mut guess.residual);
            subtract(-part, &source, &mut guess.x);
            images.push(image);
            sources.push(source);
        }
        guess
    }

    /// Takes note of a solution.
    pub fn keep(&mut self, solution: Vec<f64>) {
        if self.solutions.len() == KEPT {
            self.solutions.remove(0);
        }
        self.solutions.push(solution);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that is not symmetric.
    fn multiply(x: &[f64], y: &mut [f64]) {
        for row in 0..x.len() {
            let next = x[(row + 1) % x.len()];
            y[row] = (3.0 + row as f64) * x[row] - next;
        }
    }

    #[test]
    fn sums_of_earlier_solutions_are_found_at_once() {
        let mut earlier = EarlierSolutions::default();
        let solution =
            |k: usize| (0..20).map(|i| ((i * (k + 2)) as f64).sin()).collect::<Vec<f64>>();
        (0..4).for_each(|k| earlier.keep(solution(k)));
        // Once more: it adds nothing
        earlier.keep(solution(3));
        let wanted: Vec<f64> =
            solution(1).iter().zip(solution(3)).map(|(a, b)| 2.0 * a - 0.5 * b).collect();
        let mut b = vec![0.0; 20];
        multiply(&wanted, &mut b);
        let Guess { x, residual } = earlier.guess(multiply, &b);
        assert!(norm(&residual) < 1e-12 * norm(&b));
        assert!(x.iter().zip(wanted).all(|(value, wanted)| (value - wanted).abs() < 1e-12));
    }

    #[test]
    fn the_residual_is_that_of_the_guess_and_the_least() {
        let mut earlier = EarlierSolutions::default();
        for k in 0..9 {
            earlier.keep((0..20).map(|i| ((i + k * k) as f64).cos()).collect());
        }
        assert_eq!(earlier.solutions.len(), KEPT);
        let b: Vec<f64> = (0..20).map(|i| (i % 3) as f64).collect();
        let Guess { x, residual } = earlier.guess(multiply, &b);
        let mut image = vec![0.0; 20];
        multiply(&x, &mut image);
        for ((image, residual), b) in image.iter().zip(&residual).zip(&b) {
            assert!((image + residual - b).abs() < 1e-12);
        }
        assert!(norm(&residual) < norm(&b));
        for solution in &earlier.solutions {
            multiply(solution, &mut image);
            assert!(dot(&image, &residual).abs() < 1e-10 * norm(&image));
        }
    }
}
