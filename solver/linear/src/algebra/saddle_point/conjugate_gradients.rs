//! Conjugate gradients for the pressures, with a V-cycle as preconditioner (@saad2003, algorithm 9.1).

use super::matrix::dot;
use crate::multigrid::Multigrid;
use crate::sparse::single::single;

/// Most iterations: a V-cycle reduces errors by five or more.
const MOST: usize = 30;

/// Overwrites x with an approximation of A^-1 b that leaves the part `reduction` of b in the Euclidean norm.
pub(super) fn conjugate_gradients(
    matrix: &mut Multigrid<1>,
    b: &[[f32; 1]],
    x: &mut [[f32; 1]],
    reduction: f64,
) {
    let flat_dot = |a: &[[f32; 1]], b: &[[f32; 1]]| dot(a.as_flattened(), b.as_flattened());
    let mut residual = b.to_vec();
    x.fill([0.0]);
    let wanted = reduction * flat_dot(b, b).sqrt();
    let (mut direction, mut image) = (vec![[0.0]; b.len()], vec![[0.0]; b.len()]);
    let mut preconditioned = vec![[0.0]; b.len()];
    let mut before = 0.0;
    for iteration in 0..MOST {
        if flat_dot(&residual, &residual).sqrt() <= wanted {
            return;
        }
        matrix.cycle(&residual, &mut preconditioned);
        let product = flat_dot(&residual, &preconditioned);
        let part = single(if iteration == 0 { 0.0 } else { product / before });
        for (direction, next) in direction.iter_mut().zip(&preconditioned) {
            direction[0] = next[0] + part * direction[0];
        }
        matrix.multiply(&direction, &mut image);
        let curvature = flat_dot(&direction, &image);
        // Rounding, or a right-hand side with a part that has no solution
        if !(product > 0.0 && curvature > 0.0) {
            return;
        }
        let length = single(product / curvature);
        for ((x, residual), (direction, image)) in
            x.iter_mut().zip(&mut residual).zip(direction.iter().zip(&image))
        {
            x[0] += length * direction[0];
            residual[0] -= length * image[0];
        }
        before = product;
    }
}
