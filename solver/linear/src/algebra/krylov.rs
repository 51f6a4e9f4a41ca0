//! FGMRES: flexible GMRES, preconditioned from the right (@saad1993).

use alewife_interrupt::check;

use super::vectors::{add, dot, norm};

/// When FGMRES ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stopping {
    /// Euclidean norm of the residual to be reached.
    pub tolerance: f64,
    /// Ends as soon as more iterations than that are needed at the rate of convergence so far.
    pub max_iterations: usize,
}

/// What FGMRES has found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KrylovSolution {
    /// The approximate solution.
    pub x: Vec<f64>,
    /// Products with the matrix, and applications of the preconditioner.
    pub iterations: usize,
    /// Euclidean norm of the residual, by the recurrence.
    pub residual: f64,
}

/// Solves A x = b from x = 0.
///
/// Where the work of this thread is to end, it ends where it is. `multiply` overwrites its second argument with A times the first, `precondition` with an
/// approximation of A^-1 times the first.
pub(super) fn fgmres(
    mut multiply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&[f64], &mut [f64]),
    b: &[f64],
    stopping: Stopping,
) -> KrylovSolution {
    let n = b.len();
    let initial = norm(b);
    let mut basis = vec![b.iter().map(|value| value / initial).collect::<Vec<f64>>()];
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let mut hessenberg = Hessenberg::new(initial);
    while stopping.continues(initial, hessenberg.n_columns(), hessenberg.residual)
        && check().is_ok()
    {
        let mut direction = vec![0.0; n];
        precondition(&basis[hessenberg.n_columns()], &mut direction);
        let mut image = vec![0.0; n];
        multiply(&direction, &mut image);
        // Modified Gram-Schmidt
        let mut column = Vec::with_capacity(basis.len());
        for vector in &basis {
            let component = dot(vector, &image);
            add(-component, vector, &mut image);
            column.push(component);
        }
        let size = norm(&image);
        if !hessenberg.push(column, size) {
            break;
        }
        directions.push(direction);
        // The Krylov space is invariant: it holds the solution
        if size == 0.0 {
            break;
        }
        basis.push(image.iter().map(|value| value / size).collect());
    }
    let mut x = vec![0.0; n];
    for (weight, direction) in hessenberg.weights().iter().zip(&directions) {
        add(*weight, direction, &mut x);
    }
    KrylovSolution { x, iterations: hessenberg.n_columns(), residual: hessenberg.residual }
}

impl Stopping {
    /// Whether another iteration is worth it, for a norm of the right-hand side.
    fn continues(self, initial: f64, iterations: usize, residual: f64) -> bool {
        let digits = (initial / self.tolerance).ln();
        let gained = digits - (residual / self.tolerance).ln();
        let is_fast_enough =
            iterations == 0 || iterations as f64 * digits <= self.max_iterations as f64 * gained;
        residual > self.tolerance && is_fast_enough
    }
}

/// The least-squares problem min |r e1 - H y| for a Hessenberg matrix H that grows by columns, made
/// triangular by rotations as it grows.
#[derive(Debug)]
struct Hessenberg {
    /// Columns of the triangular factor.
    columns: Vec<Vec<f64>>,
    rotations: Vec<Rotation>,
    /// r e1, rotated.
    rhs: Vec<f64>,
    /// The least value of |r e1 - H y|.
    residual: f64,
}

#[derive(Debug, Clone, Copy)]
struct Rotation {
    cosine: f64,
    sine: f64,
}

impl Hessenberg {
    fn new(residual: f64) -> Self {
        Self { columns: Vec::new(), rotations: Vec::new(), rhs: vec![residual], residual }
    }

    fn n_columns(&self) -> usize {
        self.columns.len()
    }

    /// Takes the next column, down to the diagonal, and the entry below that. Returns false, and
    /// takes nothing, when the column adds nothing or is not finite.
    fn push(&mut self, mut column: Vec<f64>, below: f64) -> bool {
        let last = column.len() - 1;
        for (row, rotation) in self.rotations.iter().enumerate() {
            let (upper, lower) = (column[row], column[row + 1]);
            column[row] = rotation.cosine * upper + rotation.sine * lower;
            column[row + 1] = rotation.cosine * lower - rotation.sine * upper;
        }
        let length = column[last].hypot(below);
        if length == 0.0 || !length.is_finite() {
            return false;
        }
        let rotation = Rotation { cosine: column[last] / length, sine: below / length };
        column[last] = length;
        let upper = self.rhs[last];
        self.rhs[last] = rotation.cosine * upper;
        self.rhs.push(-rotation.sine * upper);
        self.residual = (rotation.sine * upper).abs();
        self.rotations.push(rotation);
        self.columns.push(column);
        true
    }

    /// The y of the least residual.
    fn weights(&self) -> Vec<f64> {
        let mut weights = self.rhs[..self.n_columns()].to_vec();
        for row in (0..self.n_columns()).rev() {
            for later in row + 1..self.n_columns() {
                weights[row] -= self.columns[later][row] * weights[later];
            }
            weights[row] /= self.columns[row][row];
        }
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved_in_as_many_iterations_as_it_has_unknowns() {
        let matrix = [[4.0, 1.0, 0.0], [-1.0, 3.0, 2.0], [0.5, 0.0, 2.0]];
        let multiply = |x: &[f64], y: &mut [f64]| {
            for (row, y) in matrix.iter().zip(y) {
                *y = dot(row, x);
            }
        };
        let b = [1.0, 2.0, 3.0];
        let copy = |r: &[f64], z: &mut [f64]| z.copy_from_slice(r);
        let until = |tolerance| Stopping { tolerance, max_iterations: 100 };
        let solution = fgmres(multiply, copy, &b, until(1e-14));
        let mut image = [0.0; 3];
        multiply(&solution.x, &mut image);
        for (value, expected) in image.iter().zip(b) {
            assert!((value - expected).abs() < 1e-13);
        }
        assert_eq!(solution.iterations, 3);
        // The preconditioner A^-1 / 2 needs one.
        let exact = |r: &[f64], z: &mut [f64]| {
            let twice = fgmres(multiply, copy, r, until(1e-14)).x;
            z.copy_from_slice(&twice.iter().map(|value| value / 2.0).collect::<Vec<_>>());
        };
        assert_eq!(fgmres(multiply, exact, &b, until(1e-12)).iterations, 1);
    }

    #[test]
    fn too_slow_a_convergence_ends_the_iterations() {
        // A cyclic shift: the residual does not fall before the last iteration.
        let multiply = |x: &[f64], y: &mut [f64]| {
            for (row, y) in y.iter_mut().enumerate() {
                *y = x[(row + 1) % x.len()];
            }
        };
        let b = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let stopping = Stopping { tolerance: 1e-12, max_iterations: 100 };
        let copy = |r: &[f64], z: &mut [f64]| z.copy_from_slice(r);
        let solution = fgmres(multiply, copy, &b, stopping);
        assert_eq!(solution.iterations, 1);
        assert_eq!(solution.residual, 1.0);
    }
}
