//! `Connection`: the velocity of a swimmer without inertia by the rates of its shape, and its way from that.

use std::f64::consts::PI;

use super::error::TreeError;
use super::placement::Placement;
use super::spatial::{Number, Twist, real};
use super::step::root_twist;
use super::topology::Root;

/// Largest number of coordinates of a shape.
const COORDINATES: usize = 3;

/// A swimmer in Stokes flow moves with the velocity A(q) q', in its own frame, by its coordinates q and their
/// rates (Shapere and Wilczek 1989, J. Fluid Mech. 198, 557). Of each of up to three coordinates A is known at
/// Chebyshev's nodes c cos(pi (k + 1/2)/n), k = 0 .. n - 1, and between them it is the polynomial through these.
#[derive(Debug, Clone, PartialEq)]
pub struct Connection {
    /// Half width c of the range of each coordinate, about zero (rad, m).
    ranges: Vec<f64>,
    /// Nodes n of each coordinate.
    counts: Vec<usize>,
    /// Velocities a rate: of each node, the last coordinate fastest, of each coordinate, three or six numbers.
    values: Vec<f64>,
    root: Root,
}

/// Chebyshev's nodes of a range, from its upper end down.
#[must_use]
pub fn nodes(range: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| range * (PI * (k as f64 + 0.5) / count as f64).cos()).collect()
}

/// Values at x of the polynomials that are one at one of the nodes and zero at all others, by Chebyshev's sums.
fn cardinals<T: Number>(x: T, range: f64, count: usize) -> Vec<T> {
    let n = count as f64;
    let y = x / range;
    let mut chebyshev: Vec<T> = vec![real(1.0), y];
    while chebyshev.len() < count {
        let m = chebyshev.len();
        chebyshev.push(y * chebyshev[m - 1] * 2.0 - chebyshev[m - 2]);
    }
    (0..count)
        .map(|k| {
            let angle = PI * (k as f64 + 0.5) / n;
            let first: T = real(1.0 / n);
            (1..count)
                .fold(first, |sum, m| sum + chebyshev[m] * (2.0 / n * (m as f64 * angle).cos()))
        })
        .collect()
}

impl Connection {
    /// A connection from its values at the nodes: of each node, the last coordinate fastest, of each
    /// coordinate the velocities of the root by its rate: along x, along y and about z, or six.
    ///
    /// # Errors
    /// `TreeError::Given` when there are more than three coordinates, a range is not positive, or the number of
    /// values is another.
    pub fn new(
        root: Root,
        ranges: Vec<f64>,
        counts: Vec<usize>,
        values: Vec<f64>,
    ) -> Result<Self, TreeError> {
        let wrong = |what: String| Err(TreeError::Given(what));
        let n = ranges.len();
        if n == 0 || n > COORDINATES || counts.len() != n {
            let what = "a connection has 1 to 3 coordinates, each with a range and a count";
            return wrong(what.to_owned());
        }
        if !ranges.iter().all(|range| *range > 0.0) || counts.contains(&0) {
            return wrong("ranges and numbers of nodes have to be positive".to_owned());
        }
        let expected = counts.iter().product::<usize>() * n * root.count();
        if values.len() != expected || expected == 0 {
            let found = values.len();
            return wrong(format!("{expected} values are needed at these nodes, not {found}"));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return wrong(format!("a velocity is {value}"));
        }
        Ok(Self { ranges, counts, values, root })
    }

    /// The twist of the root in its frame.
    ///
    /// # Errors
    /// `TreeError::Given` when a coordinate is outside its range.
    pub fn twist<T: Number>(&self, coordinates: &[T], rates: &[T]) -> Result<Twist<T>, TreeError> {
        let n = self.ranges.len();
        let mut weights: Vec<T> = vec![real(1.0)];
        for k in 0..n {
            let (x, range) = (coordinates[k], self.ranges[k]);
            if x.re().is_nan() || x.re().abs() > range {
                let x = x.re();
                let what =
                    format!("coordinate {k} is {x}, outside its range of -{range} to {range}");
                return Err(TreeError::Given(what));
            }
            let cardinals = cardinals(x, range, self.counts[k]);
            weights = weights
                .iter()
                .flat_map(|weight| cardinals.iter().map(|cardinal| *weight * *cardinal))
                .collect();
        }
        let m = self.root.count();
        let mut velocities: Vec<T> = vec![real(0.0); m];
        for (weight, values) in weights.iter().zip(self.values.chunks_exact(n * m)) {
            for (rate, values) in rates.iter().zip(values.chunks_exact(m)) {
                for (velocity, value) in velocities.iter_mut().zip(values) {
                    *velocity += *weight * *rate * *value;
                }
            }
        }
        Ok(root_twist(self.root, &velocities))
    }
}

/// The way over a step (s) of a root whose twist in its own frame depends on time alone: of fourth order, by the
/// twists at Gauss's two points and their commutator (Magnus 1954, Comm. Pure Appl. Math. 7, 649).
///
/// # Errors
/// Those of `twist`.
pub fn magnus<T: Number, E>(
    start: &Placement<T>,
    time: f64,
    step: T,
    mut twist: impl FnMut(f64) -> Result<Twist<T>, E>,
) -> Result<Placement<T>, E> {
    let apart = 3.0_f64.sqrt() / 6.0;
    let first = twist(time + step.re() * (0.5 - apart))?;
    let second = twist(time + step.re() * (0.5 + apart))?;
    let half: T = real(0.5);
    let mean = Twist::zero().plus(&first, half).plus(&second, half);
    let commutator = first.cross(&second);
    let whole = mean.plus(&commutator, step * 3.0_f64.sqrt() / 12.0);
    Ok(start.moved(&whole, step))
}
