//! `Curve`: a coefficient of a load over the angle of attack, by Bezier's four points or by a table.

use super::SoftError;

/// A coefficient c(t) over t from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// Bezier's cubic (1-t)^3 c_0 + 3 (1-t)^2 t c_1 + 3 (1-t) t^2 c_2 + t^3 c_3.
    Bezier([f64; 4]),
    /// Values at places that are evenly apart from 0 to 1, joined by straight lines.
    Table(Vec<f64>),
}

impl Curve {
    /// Bezier's cubic by its points.
    ///
    /// # Errors
    /// [`SoftError::Curve`] unless there are four, all finite.
    pub fn bezier(points: &[f64]) -> Result<Self, SoftError> {
        let wrong = || {
            let found = points.len();
            SoftError::Curve(format!("a Bezier curve has 4 finite points, not {found}: {points:?}"))
        };
        let points: [f64; 4] = points.try_into().map_err(|_| wrong())?;
        if points.iter().all(|point| point.is_finite()) {
            Ok(Self::Bezier(points))
        } else {
            Err(wrong())
        }
    }

    /// A table of values, evenly apart.
    ///
    /// # Errors
    /// [`SoftError::Curve`] unless there are at least two, all finite.
    pub fn table(values: &[f64]) -> Result<Self, SoftError> {
        if values.len() >= 2 && values.iter().all(|value| value.is_finite()) {
            Ok(Self::Table(values.to_vec()))
        } else {
            Err(SoftError::Curve(format!("a table has at least 2 finite values, not {values:?}")))
        }
    }

    /// Its points or values: what a search may change.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        match self {
            Self::Bezier(points) => points,
            Self::Table(values) => values,
        }
    }

    /// The same, to be changed.
    pub fn points_mut(&mut self) -> &mut [f64] {
        match self {
            Self::Bezier(points) => points,
            Self::Table(values) => values,
        }
    }

    /// The coefficient.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        let mut value = 0.0;
        self.weights(t, |k, weight| value += weight * self.points()[k]);
        value
    }

    /// Calls `visit` with the share of each point in the coefficient.
    pub(super) fn weights(&self, t: f64, mut visit: impl FnMut(usize, f64)) {
        let s = 1.0 - t;
        match self {
            Self::Bezier(_) => {
                let shares = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
                shares.into_iter().enumerate().for_each(|(k, share)| visit(k, share));
            }
            Self::Table(values) => {
                let piece = Piece::of(values.len(), t);
                visit(piece.first, 1.0 - piece.part);
                visit(piece.first + 1, piece.part);
            }
        }
    }

    /// Derivative of the coefficient by t.
    #[must_use]
    pub fn slope(&self, t: f64) -> f64 {
        let s = 1.0 - t;
        match self {
            Self::Bezier([a, b, c, d]) => {
                3.0 * (s * s * (b - a) + 2.0 * s * t * (c - b) + t * t * (d - c))
            }
            Self::Table(values) => {
                let piece = Piece::of(values.len(), t);
                (values[piece.first + 1] - values[piece.first]) * (values.len() - 1) as f64
            }
        }
    }
}

/// The piece of a table that a place lies in.
struct Piece {
    first: usize,
    /// How far along the piece, from 0 to 1.
    part: f64,
}

impl Piece {
    fn of(n_values: usize, t: f64) -> Self {
        let along = t.clamp(0.0, 1.0) * (n_values - 1) as f64;
        let first = (0..n_values - 2).rev().find(|k| *k as f64 <= along).unwrap_or(0);
        let first = if along >= (n_values - 2) as f64 { n_values - 2 } else { first };
        Self { first, part: along - first as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_and_shares_are_derivatives_of_the_value() {
        let curves = [
            Curve::bezier(&[0.05, -0.4, 1.85, 2.05]).expect("it has four points"),
            Curve::table(&[0.1, 0.5, -0.3, 2.0]).expect("it has values"),
        ];
        for curve in curves {
            let n = curve.points().len();
            for t in [0.1, 0.4, 0.75, 0.95] {
                let h = 1e-6;
                let slope = (curve.value(t + h) - curve.value(t - h)) / (2.0 * h);
                assert!((curve.slope(t) - slope).abs() < 1e-8);
                let mut shares = vec![0.0; n];
                curve.weights(t, |k, share| shares[k] += share);
                for k in 0..n {
                    let mut moved = curve.clone();
                    moved.points_mut()[k] += 1.0;
                    assert!((moved.value(t) - curve.value(t) - shares[k]).abs() < 1e-14);
                }
            }
            assert_eq!(curve.value(0.0), curve.points()[0]);
            assert_eq!(curve.value(1.0), curve.points()[n - 1]);
        }
    }

    #[test]
    fn wrong_curves_are_refused_with_what_is_accepted() {
        let said = Curve::bezier(&[1.0, 2.0, 3.0]).expect_err("three are too few").to_string();
        assert_eq!(said, "a Bezier curve has 4 finite points, not 3: [1.0, 2.0, 3.0]");
        assert!(Curve::bezier(&[1.0, 2.0, 3.0, f64::NAN]).is_err());
        let said = Curve::table(&[1.0]).expect_err("one is too few").to_string();
        assert_eq!(said, "a table has at least 2 finite values, not [1.0]");
    }
}
