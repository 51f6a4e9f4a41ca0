//! `TurningBase`: the end of a body with coordinates that is clamped to another body, which turns in a step.
//!
//! Coordinates of that end are linear in the velocities of a step, while what they are fixed to goes round: a direction t
//! that turns by theta from where it is expected would be t + theta x t, which is longer by theta^2 / 2. A rod that hardly
//! stretches would not let its body turn at all. With the turn theta that fits the linear coordinates q of all directions best,
//!
//!   (sum over t of t^2 1 - t t^T) theta = sum over t of t x (q - t),
//!
//! which in the plane is about its normal, the end is R(theta) t, and its place that of q and (R(theta) - 1) r - theta x r,
//! with the lever r on the other body: the same where the turn is as expected. Forces are the derivatives of the energy of
//! the end that is turned so.

use nalgebra::{DMatrix, DVector, Matrix3, OMatrix, U3, Vector3};
use num_dual::{DualNum, HyperDual64};

use super::problem::{BodyVector, OnBody};
use crate::body::Pose;

/// Part of a matrix of turns below which its eigenvalue is zero: no direction of the plane tells turns within it.
const NO_TURN: f64 = 1e-9;

/// Square of an angle below which its functions are taken from their series.
const SERIES: f64 = 0.5;

/// A number for each coordinate and axis of a turn, n x 3.
type ByTurn = OMatrix<f64, nalgebra::Dyn, U3>;

/// An end that is clamped to a body, as the body is expected.
#[derive(Debug, Clone)]
pub struct TurningBase {
    directions: Vec<Component>,
    places: Vec<Component>,
}

/// A coordinate that is a component of a vector of the other body.
#[derive(Debug, Clone, Copy)]
struct Component {
    coordinate: usize,
    /// Along which axis.
    axis: usize,
    /// The vector as it is expected: a direction (1), or the way to a place from the centre of the other body (m).
    vector: Vector3<f64>,
    /// By a direction the change of the turn, by a turn the change of a place that is linear in it.
    by: Vector3<f64>,
}

/// What an end is turned by, from linear coordinates.
struct Turned {
    /// The turn from where it is expected (rad), about the axes coordinates are seen in.
    turn: Vector3<f64>,
    /// Derivatives of all coordinates by it.
    derivatives: ByTurn,
}

/// A component of a vector that is turned.
struct Rotated {
    value: f64,
    /// Its derivatives by the turn.
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

/// sin(x) / x and (1 - cos(x)) / x^2 by the square of x.
fn turning_factors<D: DualNum<Primitive = f64> + Copy>(square: D) -> [D; 2] {
    if square.re() > SERIES {
        let angle = square.sqrt();
        return [angle.sin() / angle, (-angle.cos() + 1.0) / square];
    }
    // Their terms are -x^2 / (k (k + 1)) times those before
    let series = |first: f64| {
        (0..8).rev().fold(D::from(1.0), |sum, term| {
            let k = first + 2.0 * f64::from(term);
            -square * sum / (k * (k + 1.0)) + 1.0
        })
    };
    [series(2.0), series(3.0) * 0.5]
}

/// A vector that is turned: v + a theta x v + b theta x (theta x v).
fn rotated<D: DualNum<Primitive = f64> + Copy>(turn: [D; 3], vector: &Vector3<f64>) -> [D; 3] {
    let cross = |v: [D; 3]| -> [D; 3] {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            turn[j] * v[k] - turn[k] * v[j]
        })
    };
    let vector: [D; 3] = std::array::from_fn(|i| D::from(vector[i]));
    let square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    let [once, twice] = turning_factors(square);
    let across = cross(vector);
    let again = cross(across);
    std::array::from_fn(|i| vector[i] + once * across[i] + twice * again[i])
}

impl Component {
    fn new(given: &OnBody, vector: Vector3<f64>) -> Self {
        let OnBody { coordinate, axis, .. } = *given;
        Self { coordinate, axis, vector, by: vector.cross(&Vector3::ith(axis, 1.0)) }
    }

    /// Its value where it is turned.
    fn rotated(&self, turn: &Vector3<f64>) -> Rotated {
        let mut found = Rotated { value: 0.0, first: Vector3::zeros(), second: Matrix3::zeros() };
        for i in 0..3 {
            for j in 0..=i {
                let along = |at: usize, of: usize| f64::from(u8::from(at == of));
                let turn = std::array::from_fn(|at| {
                    HyperDual64::new(turn[at], along(at, i), along(at, j), 0.0)
                });
                let of_axis = rotated(turn, &self.vector)[self.axis];
                found.value = of_axis.re;
                found.first[i] = of_axis.eps1;
                found.second[(i, j)] = of_axis.eps1eps2;
                found.second[(j, i)] = of_axis.eps1eps2;
            }
        }
        found
    }
}

impl TurningBase {
    /// The end that is given by these vectors of a body at a pose, as coordinates of another one see it; `None` where no
    /// direction is.
    #[must_use]
    pub fn new(given: &[OnBody], seen_from: &Pose, body: &Pose) -> Option<Self> {
        let (mut directions, mut places) = (Vec::new(), Vec::new());
        for on_body in given {
            let (found, vector) = match &on_body.vector {
                BodyVector::Place(at) => (&mut places, at),
                BodyVector::Direction(along) => (&mut directions, along),
            };
            let seen = seen_from.to_body(&body.to_world(vector));
            found.push(Component::new(on_body, seen));
        }
        // The sum over the components of a vector t is t^2 1 - t t^T, or of two in the plane what it has of turns there
        let turns: Matrix3<f64> = directions.iter().map(|at| at.by * at.by.transpose()).sum();
        let inverse = turns.pseudo_inverse(NO_TURN * turns.trace()).ok()?;
        directions.iter_mut().for_each(|at| at.by = inverse * at.by);
        (!directions.is_empty()).then_some(Self { directions, places })
    }

    fn turned(&self, linear: &DVector<f64>) -> Turned {
        let off = |at: &Component| at.by * (linear[at.coordinate] - at.vector[at.axis]);
        let turn = self.directions.iter().map(off).sum();
        let mut derivatives = ByTurn::zeros(linear.len());
        for at in &self.directions {
            derivatives.set_row(at.coordinate, &at.rotated(&turn).first.transpose());
        }
        // What is linear of a place stays in its own coordinates
        for at in &self.places {
            let beyond = at.rotated(&turn).first - at.by;
            derivatives.set_row(at.coordinate, &beyond.transpose());
        }
        Turned { turn, derivatives }
    }

    /// Their derivatives along a turn.
    fn derivatives_along(&self, turn: &Vector3<f64>, way: &Vector3<f64>, n: usize) -> ByTurn {
        let mut along = ByTurn::zeros(n);
        for at in self.directions.iter().chain(&self.places) {
            along.set_row(at.coordinate, &(at.rotated(turn).second * way).transpose());
        }
        along
    }

    /// Coordinates with the end as it is turned, from linear ones.
    #[must_use]
    pub fn coordinates(&self, linear: &DVector<f64>) -> DVector<f64> {
        let turn = self.turned(linear).turn;
        let mut found = linear.clone();
        for at in &self.directions {
            found[at.coordinate] = at.rotated(&turn).value;
        }
        for at in &self.places {
            found[at.coordinate] += at.rotated(&turn).value - at.vector[at.axis] - at.by.dot(&turn);
        }
        found
    }

    /// Their rates, from those of linear ones.
    #[must_use]
    pub fn rates(&self, linear: &DVector<f64>, rates: &DVector<f64>) -> DVector<f64> {
        let mut found = rates.clone();
        self.directions.iter().for_each(|at| found[at.coordinate] = 0.0);
        found += self.turned(linear).derivatives * self.turning(rates);
        found
    }

    /// The rate of the turn (rad/s).
    fn turning(&self, rates: &DVector<f64>) -> Vector3<f64> {
        self.directions.iter().map(|at| at.by * rates[at.coordinate]).sum()
    }

    /// The forces on linear coordinates of forces on those of the end as it is turned.
    #[must_use]
    pub fn forces(&self, linear: &DVector<f64>, forces: &DVector<f64>) -> DVector<f64> {
        let torque = self.turned(linear).derivatives.tr_mul(forces);
        let mut found = forces.clone();
        self.directions.iter().for_each(|at| found[at.coordinate] = torque.dot(&at.by));
        found
    }

    /// The derivatives of these forces by the rates, from derivatives of the others by their coordinates and rates: linear
    /// coordinates change by a coefficient (s) times their rates.
    #[must_use]
    pub fn tangent(
        &self,
        [linear, rates]: [&DVector<f64>; 2],
        forces: &DVector<f64>,
        [stiffness, damping]: [&DMatrix<f64>; 2],
        coefficient: f64,
    ) -> DMatrix<f64> {
        let Turned { turn, derivatives } = self.turned(linear);
        let along = self.derivatives_along(&turn, &self.turning(rates), linear.len());
        let by_rate = &derivatives + along * coefficient;
        let scaled = stiffness * coefficient;
        let of_turn = &scaled * &derivatives + damping * by_rate;
        let mut tangent = scaled + damping;
        for at in &self.directions {
            tangent.set_column(at.coordinate, &(&of_turn * at.by));
        }
        let torques = tangent.tr_mul(&derivatives);
        for at in &self.directions {
            tangent.set_row(at.coordinate, &(&torques * at.by).transpose());
        }
        let second = |at: &Component| at.rotated(&turn).second * forces[at.coordinate];
        let second: Matrix3<f64> = self.directions.iter().chain(&self.places).map(second).sum();
        for row in &self.directions {
            for column in &self.directions {
                tangent[(row.coordinate, column.coordinate)] +=
                    coefficient * row.by.dot(&(second * column.by));
            }
        }
        tangent
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, UnitQuaternion};

    use super::*;

    /// Six coordinates in the plane or twelve in space, of which the last are of no end.
    struct Clamped {
        base: TurningBase,
        dimension: usize,
    }

    impl Clamped {
        fn in_the_plane() -> Self {
            let poses = [Pose::planar(0.3, -0.1, 0.4), Pose::planar(0.5, 0.2, -0.7)];
            Self::new(2, &[Vector3::new(0.6, -0.2, 0.0), Vector3::new(0.8, 0.6, 0.0)], poses)
        }

        fn in_space() -> Self {
            let pose = |turn: Vector3<f64>| {
                Pose::spatial(turn * 0.3, UnitQuaternion::from_scaled_axis(turn))
            };
            let poses = [Vector3::new(0.3, -0.2, 0.9), Vector3::new(-0.4, 1.1, 0.2)].map(pose);
            let directions = Rotation3::new(Vector3::new(0.5, 0.1, -0.7));
            let vectors = [
                Vector3::new(0.6, -0.2, 0.3),
                directions * Vector3::x(),
                directions * Vector3::y(),
            ];
            Self::new(3, &vectors, poses)
        }

        fn new(dimension: usize, vectors: &[Vector3<f64>], [seen_from, body]: [Pose; 2]) -> Self {
            let given = |coordinate: usize| {
                let at = vectors[coordinate / dimension];
                let is_place = coordinate < dimension;
                let vector =
                    if is_place { BodyVector::Place(at) } else { BodyVector::Direction(at) };
                OnBody { coordinate, axis: coordinate % dimension, vector }
            };
            let given: Vec<OnBody> = (0..dimension * vectors.len()).map(given).collect();
            let base = TurningBase::new(&given, &seen_from, &body);
            Self { base: base.expect("it has a direction"), dimension }
        }

        fn n(&self) -> usize {
            self.base.directions.len() + self.dimension + 2
        }

        /// A turn of it.
        fn turn(&self, angle: f64) -> Vector3<f64> {
            let axis =
                if self.dimension == 2 { Vector3::z() } else { Vector3::new(0.36, -0.48, 0.8) };
            axis * angle
        }

        /// Linear coordinates that have led to a turn.
        fn linear(&self, angle: f64) -> DVector<f64> {
            let turn = self.turn(angle);
            let mut found = DVector::from_fn(self.n(), |i, _| 0.7 - 0.1 * i as f64);
            for at in &self.base.directions {
                found[at.coordinate] = (at.vector + turn.cross(&at.vector))[at.axis];
            }
            for at in &self.base.places {
                found[at.coordinate] = 0.1 + 0.1 * at.axis as f64 + turn.cross(&at.vector)[at.axis];
            }
            found
        }
    }

    #[test]
    fn an_end_goes_round_and_keeps_its_length() {
        for clamped in [Clamped::in_the_plane(), Clamped::in_space()] {
            for angle in [-0.8, 0.0, 1e-3, 2.0] {
                let rotation = Rotation3::new(clamped.turn(angle));
                let linear = clamped.linear(angle);
                let mut exact = linear.clone();
                for at in &clamped.base.directions {
                    exact[at.coordinate] = (rotation * at.vector)[at.axis];
                }
                for at in &clamped.base.places {
                    exact[at.coordinate] =
                        0.1 + 0.1 * at.axis as f64 + (rotation * at.vector - at.vector)[at.axis];
                }
                let off = (clamped.base.coordinates(&linear) - exact).amax();
                assert!(off < 1e-14, "{angle} in {}: {off}", clamped.dimension);
            }
        }
    }

    /// Of forces K q + C v: rates, forces by the energy, and the tangent, against differences.
    #[test]
    fn derivatives_are_those_of_the_turned_end() {
        for clamped in [Clamped::in_the_plane(), Clamped::in_space()] {
            for angle in [0.3, 1.3] {
                check_derivatives(&clamped, angle);
            }
        }
    }

    fn check_derivatives(clamped: &Clamped, angle: f64) {
        let (base, n) = (&clamped.base, clamped.n());
        let entry = |i: usize, j: usize| ((1 + i * 7 + j * 3) as f64).sin();
        let symmetric =
            |seed: f64| DMatrix::from_fn(n, n, |i, j| seed * (entry(i, j) + entry(j, i)));
        let (stiffness, damping) = (symmetric(1.0), symmetric(0.3));
        let energy = |q: &DVector<f64>| 0.5 * q.dot(&(&stiffness * q));
        let start = clamped.linear(angle);
        let rates = DVector::from_fn(n, |i, _| entry(i, 5));
        let small = 1e-6;
        let away = |by: f64| &start + &rates * by;
        let slope =
            (base.coordinates(&away(small)) - base.coordinates(&away(-small))) / (2.0 * small);
        assert!((slope - base.rates(&start, &rates)).amax() < 1e-8);
        let forces = base.forces(&start, &(&stiffness * base.coordinates(&start)));
        let power = (energy(&base.coordinates(&away(small)))
            - energy(&base.coordinates(&away(-small))))
            / (2.0 * small);
        // Differences of an energy have its rounding over the step: 1e-8 for an energy of a hundred, and in space
        // there are nine coordinates at a knot
        assert!((power - forces.dot(&rates)).abs() < 1e-7);
        const COEFFICIENT: f64 = 0.4;
        let all = |q: &DVector<f64>, v: &DVector<f64>| {
            &stiffness * base.coordinates(q) + &damping * base.rates(q, v)
        };
        let by_rates = |v: &DVector<f64>| {
            let q = &start + (v - &rates) * COEFFICIENT;
            base.forces(&q, &all(&q, v))
        };
        let tangents = [&stiffness, &damping];
        let exact = base.tangent([&start, &rates], &all(&start, &rates), tangents, COEFFICIENT);
        for i in 0..n {
            let unit = DVector::from_fn(n, |j, _| if i == j { small } else { 0.0 });
            let slope = (by_rates(&(&rates + &unit)) - by_rates(&(&rates - &unit))) / (2.0 * small);
            assert!((exact.column(i) - slope).amax() < 1e-7, "{i} in {}", clamped.dimension);
        }
    }
}
