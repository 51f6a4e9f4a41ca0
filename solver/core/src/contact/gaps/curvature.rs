//! `Curvatures`: curvatures of two surfaces that face each other, and how their nearest points move.
//!
//! Two points x_a and x_b face each other along the unit normal n out of b, x_a - x_b = g n. The
//! bodies turn by w_a and w_b, V_a and V_b are the velocities of their material points there, l_a
//! and l_b the levers of the points, and both points slide along their surfaces by s_a and s_b.
//! The normal changes by n', as each surface turns and as the points slide along its curvature K
//! (of the normal out of the body: positive where convex):
//!
//! n' = w_a x n - K_a s_a = w_b x n + K_b s_b,   P (V_a - V_b) + s_a - s_b = g n',   P = 1 - n n^T.
//!
//! With g' = n . (V_a - V_b) the gradient of the gap is (n, l_a x n, -n, -l_b x n); from n', s_a
//! and s_b follows its change.

use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3, Vector6};

use super::pair_vector::PairMatrix;

/// Regularity over the curvatures below which surfaces are parallel.
const PARALLEL: f64 = 1e-9;
/// Components of a [`super::PairVector`] that move bodies in the plane.
const IN_PLANE: [usize; 6] = [0, 1, 5, 6, 7, 11];

/// Curvatures of a body and of its partner at the points of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curvatures {
    /// Of two curves in the x-y plane (1/m), positive where the body is convex.
    Curves([f64; 2]),
    /// Of two surfaces: symmetric tensors (1/m), the derivatives of the unit normal out of the body
    /// along its surface; the normal itself is mapped to zero.
    Surfaces([Matrix3<f64>; 2]),
}

impl Curvatures {
    /// K_a + K_b + g K_b K_a, for surfaces its smallest eigenvalue (1/m): zero where a minimum and
    /// a maximum of the distance meet.
    #[must_use]
    pub fn regularity(&self, gap: f64) -> f64 {
        match self {
            Self::Curves([first, second]) => first + second + gap * first * second,
            Self::Surfaces([first, second]) => {
                let matrix = first + second + second * first * gap;
                let half = 0.5 * matrix.trace();
                let determinant = 0.5 * (matrix.trace().powi(2) - (matrix * matrix).trace());
                half - (half * half - determinant).max(0.0).sqrt()
            }
        }
    }

    /// Mean of the curvatures of the gap (1/m): near it, the gap grows like half of it times the square of the
    /// distance, averaged over directions.
    #[must_use]
    pub fn of_gap(&self) -> f64 {
        match self {
            Self::Curves([first, second]) => first + second,
            Self::Surfaces([first, second]) => 0.5 * (first + second).trace(),
        }
    }

    /// Derivative of the gradient (n, l_a x n, -n, -l_b x n) by displacements of both bodies, zero
    /// where the surfaces are parallel.
    pub(in crate::contact) fn gradient_derivative(
        &self,
        normal: &Vector3<f64>,
        gap: f64,
        levers: &[Vector3<f64>; 2],
    ) -> PairMatrix {
        match self {
            Self::Curves(curvatures) => {
                let planar = of_curves(curvatures, normal, gap, levers);
                let mut matrix = PairMatrix::zeros();
                for (i, row) in IN_PLANE.into_iter().enumerate() {
                    for (j, column) in IN_PLANE.into_iter().enumerate() {
                        matrix[(row, column)] = planar[(i, j)];
                    }
                }
                matrix
            }
            Self::Surfaces(curvatures) => {
                of_surfaces(curvatures, normal, gap, levers).unwrap_or_else(PairMatrix::zeros)
            }
        }
    }
}

/// Second derivative of the gap of two curves by x, y, angle of both bodies.
///
/// With slides s and r along the tangent t and n' = f t, f = w_a - k_a s = w_b + k_b r, it is
/// g'' = f t . (V_a - V_b) - w_a^2 n . l_a - w_a s + w_b^2 n . l_b + w_b r.
fn of_curves(
    curvatures: &[f64; 2],
    n: &Vector3<f64>,
    gap: f64,
    levers: &[Vector3<f64>; 2],
) -> Matrix6<f64> {
    let [ka, kb] = *curvatures;
    let t = Vector3::new(-n.y, n.x, 0.0);
    let regularity = ka + kb + gap * ka * kb;
    if regularity.abs() <= PARALLEL * (ka.abs() + kb.abs()) {
        return Matrix6::zeros();
    }
    let [on_a, on_b] = levers.map(|lever| lever.cross(&t).z);
    let across = Vector6::new(t.x, t.y, on_a, -t.x, -t.y, -on_b);
    let (turn_a, turn_b) = (Vector6::ith(2, 1.0), Vector6::ith(5, 1.0));
    let swing = (across * (ka * kb) + turn_a * kb + turn_b * ka) / regularity;
    let slide_a = (turn_a * (1.0 + gap * kb) - across * kb - turn_b) / regularity;
    let slide_b = (across * ka + turn_a - turn_b * (1.0 + gap * ka)) / regularity;
    let form = swing * across.transpose()
        + turn_a * (turn_a * -n.dot(&levers[0]) - slide_a).transpose()
        + turn_b * (turn_b * n.dot(&levers[1]) + slide_b).transpose();
    0.5 * (form + form.transpose())
}

/// A vector as a linear function of the displacements of both bodies.
type Linear = SMatrix<f64, 3, 12>;

/// `None` where the surfaces are parallel in some direction.
fn of_surfaces(
    [ka, kb]: &[Matrix3<f64>; 2],
    n: &Vector3<f64>,
    gap: f64,
    levers: &[Vector3<f64>; 2],
) -> Option<PairMatrix> {
    let along_normal = n * n.transpose();
    let one = Matrix3::identity();
    let matrix = ka + kb + kb * ka * gap;
    // The part along the normal makes the matrix regular, and has no part in tangential solutions
    let regular = matrix + along_normal;
    let size = ka.norm() + kb.norm();
    if regular.determinant().abs() <= PARALLEL * size * size {
        return None;
    }
    let inverse = regular.try_inverse()?;
    let [arm_a, arm_b] = levers.map(|lever| lever.cross_matrix());
    // Columns of a displacement: linear and angular of a, linear and angular of b
    let block = |column: usize, part: Matrix3<f64>| {
        let mut linear = Linear::zeros();
        linear.fixed_view_mut::<3, 3>(0, 3 * column).copy_from(&part);
        linear
    };
    let apart = block(0, one) - block(1, arm_a) - block(2, one) + block(3, arm_b);
    let across = (one - along_normal) * apart;
    let turn_a = block(1, -n.cross_matrix());
    let turn_b = block(3, -n.cross_matrix());
    let slide_a = inverse * ((one + kb * gap) * turn_a - kb * across - turn_b);
    let slide_b = inverse.transpose() * (ka * across + turn_a - (one + ka * gap) * turn_b);
    let swing = turn_b + kb * slide_b;
    let lever_a = slide_a - block(1, arm_a);
    let lever_b = slide_b - block(3, arm_b);
    let torque_a = arm_a * swing - n.cross_matrix() * lever_a;
    let torque_b = arm_b * swing - n.cross_matrix() * lever_b;
    let mut derivative = PairMatrix::zeros();
    for (row, part) in [swing, torque_a, -swing, -torque_b].into_iter().enumerate() {
        derivative.fixed_view_mut::<3, 12>(3 * row, 0).copy_from(&part);
    }
    Some(derivative)
}
