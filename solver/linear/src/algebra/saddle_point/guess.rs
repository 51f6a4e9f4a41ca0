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
