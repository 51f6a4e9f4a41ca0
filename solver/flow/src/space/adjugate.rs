//! Adjugates and determinants of small matrices: the inverse is the one over the other.

/// Adjugates and determinants of L matrices \[row\]\[column\]\[lane\] of size 2 or 3.
#[inline(always)]
pub fn adjugate<const D: usize, const L: usize>(
    matrix: &[[[f64; L]; D]; D],
    adjugate: &mut [[[f64; L]; D]; D],
    determinant: &mut [f64; L],
) {
    for lane in 0..L {
        for i in 0..D {
            for j in 0..D {
                let (i1, i2, j1, j2) = ((i + 1) % D, (i + 2) % D, (j + 1) % D, (j + 2) % D);
                adjugate[j][i][lane] = if D == 2 {
                    let sign = if i == j { 1.0 } else { -1.0 };
                    sign * matrix[i1][j1][lane]
                } else {
                    matrix[i1][j1][lane] * matrix[i2][j2][lane]
                        - matrix[i1][j2][lane] * matrix[i2][j1][lane]
                };
            }
        }
        determinant[lane] = 0.0;
        for j in 0..D {
            determinant[lane] += matrix[0][j][lane] * adjugate[j][0][lane];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_adjugate_is_its_determinant() {
        fn check<const D: usize>(matrix: [[f64; D]; D], expected: f64) {
            let lanes = matrix.map(|row| row.map(|entry| [entry, 2.0 * entry]));
            let (mut found, mut determinant) = ([[[0.0; 2]; D]; D], [0.0; 2]);
            adjugate(&lanes, &mut found, &mut determinant);
            for lane in 0..2 {
                let factor = [1.0, 2.0f64][lane];
                let expected = (0..D).fold(expected, |product, _| product * factor);
                assert!((determinant[lane] - expected).abs() < 1e-13 * expected);
                for i in 0..D {
                    for j in 0..D {
                        let sum: f64 =
                            (0..D).map(|k| matrix[i][k] * factor * found[k][j][lane]).sum();
                        let expected = if i == j { expected } else { 0.0 };
                        assert!((sum - expected).abs() < 1e-13 * determinant[lane]);
                    }
                }
            }
        }
        check([[2.0, 1.0], [-0.5, 3.0]], 6.5);
        check([[2.0, 1.0, 0.3], [-0.5, 3.0, 0.2], [0.1, -0.4, 1.5]], 9.9);
    }
}
