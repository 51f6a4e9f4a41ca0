//! FGMRES: a linear system solved with the factors of one that is nearly the same (@saad1993).

/// What came of an attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outcome {
    /// Multiplications with the matrix and solves with the preconditioner.
    pub iterations: usize,
    /// Norm of the residual, by the recurrence.
    pub residual: f64,
}

/// Solves A x = b from x = 0, preconditioned from the right, until the Euclidean norm of the
/// residual is at most `goal`; gives up when at the rate so far it would take more than
/// `max_iterations`.
///
/// `multiply` gives A z in its second argument, `precondition` overwrites its argument with an
/// approximation of A^-1 times it. Sums run in the order of the unknowns.
pub(super) fn fgmres(
    mut multiply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&mut [f64]),
    b: &[f64],
    goal: f64,
    max_iterations: usize,
) -> (Vec<f64>, Outcome) {
    let n = b.len();
    let mut residual = norm(b);
    let mut basis = vec![b.iter().map(|value| value / residual).collect::<Vec<f64>>()];
    let mut directions: Vec<Vec<f64>> = Vec::new();
    // The Hessenberg matrix by columns, made triangular by rotations as it grows.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut rhs = vec![residual];
    let digits = (residual / goal).ln();
    let is_hopeful = |made: usize, residual: f64| {
        let gained = digits - (residual / goal).ln();
        made == 0 || made as f64 * digits <= max_iterations as f64 * gained
    };
    while residual > goal && is_hopeful(columns.len(), residual) {
        let j = columns.len();
        let mut direction = basis[j].clone();
        precondition(&mut direction);
        let mut image = vec![0.0; n];
        multiply(&direction, &mut image);
        directions.push(direction);
        let mut column = Vec::with_capacity(j + 2);
        for vector in &basis {
            let part = dot(vector, &image);
            subtract(part, vector, &mut image);
            column.push(part);
        }
        let size = norm(&image);
        for (row, &(cosine, sine)) in rotations.iter().enumerate() {
            let (upper, lower) = (column[row], column[row + 1]);
            column[row] = cosine * upper + sine * lower;
            column[row + 1] = cosine * lower - sine * upper;
        }
        let length = column[j].hypot(size);
        if length == 0.0 || !length.is_finite() {
            directions.pop();
            break;
        }
        let (cosine, sine) = (column[j] / length, size / length);
        column[j] = length;
        rotations.push((cosine, sine));
        columns.push(column);
        let last = rhs[j];
        rhs[j] = cosine * last;
        rhs.push(-sine * last);
        residual = (sine * last).abs();
        if size == 0.0 {
            break;
        }
        basis.push(image.iter().map(|value| value / size).collect());
    }
    let iterations = columns.len();
    let mut weights = rhs;
    for row in (0..iterations).rev() {
        for later in row + 1..iterations {
            weights[row] -= columns[later][row] * weights[later];
        }
        weights[row] /= columns[row][row];
    }
    let mut x = vec![0.0; n];
    for (weight, direction) in weights.iter().zip(&directions) {
        subtract(-weight, direction, &mut x);
    }
    (x, Outcome { iterations, residual })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Eight sums side by side, in a fixed order.
    let mut sums = [0.0; 8];
    let (a_chunks, b_chunks) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a_chunks.remainder().iter().zip(b_chunks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_chunks.zip(b_chunks) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Euclidean norm.
pub(super) fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

fn subtract(factor: f64, from: &[f64], target: &mut [f64]) {
    for (target, value) in target.iter_mut().zip(from) {
        *target -= factor * value;
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
        let (x, outcome) = fgmres(multiply, |_| {}, &b, 1e-14, 1000);
        let mut image = [0.0; 3];
        multiply(&x, &mut image);
        for (value, expected) in image.iter().zip(b) {
            assert!((value - expected).abs() < 1e-13);
        }
        assert_eq!(outcome.iterations, 3);
        // The preconditioner A^-1 / 2 needs one.
        let exact = |z: &mut [f64]| {
            let (half, _) = fgmres(multiply, |_| {}, z, 1e-14, 1000);
            z.copy_from_slice(&half.iter().map(|value| value / 2.0).collect::<Vec<_>>());
        };
        assert_eq!(fgmres(multiply, exact, &b, 1e-12, 10).1.iterations, 1);
    }
}
