//! `TurningBase`: the end of a body with coordinates that is clamped to another body, which turns in a step.
//!
//! Coordinates of that end are linear in the velocities of a step, while what they are fixed to goes round: a direction t
//! that turns by delta from where it is expected would be t + delta J t, which is longer by delta^2 / 2. A rod that hardly
//! stretches would not let its body turn at all. With delta = J t . (q - t) / t^2 from the linear coordinates q the end is
//!
//!   R(delta) t,   and its place that of q and (R(delta) - 1 - delta J) r,
//!
//! with the lever r on the other body: the same where the turn is as expected. Forces are the derivatives of the energy of
//! the end that is turned so.

use nalgebra::{DMatrix, DVector, Rotation2, Vector2};

use super::problem::{BodyVector, OnBody};
use crate::body::Pose;

/// An end that is clamped to a body, as the body is expected.
#[derive(Debug, Clone)]
pub struct TurningBase {
    /// The coordinates of the direction, and its value (1).
    direction: Entry,
    /// Those of the place, and the way to it from the centre of the other body (m).
    place: Entry,
}

/// Two coordinates that are a vector of the other body.
#[derive(Debug, Clone, Default)]
struct Entry {
    coordinates: Vec<usize>,
    vector: Vector2<f64>,
}

/// An end that is turned.
struct Turned {
    /// The angle from where it is expected (rad).
    angle: f64,
    /// The derivative of all coordinates by it, and the second one.
    derivatives: [DVector<f64>; 2],
}

/// A quarter of a turn on.
fn across(vector: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-vector.y, vector.x)
}

impl TurningBase {
    /// The end that is given by these vectors of a body in the plane at a pose, as coordinates of another one see it; `None`
    /// where no direction is.
    #[must_use]
    pub fn new(given: &[OnBody], seen_from: &Pose, body: &Pose) -> Option<Self> {
        let (mut direction, mut place) = (Entry::default(), Entry::default());
        for on_body in given {
            let (entry, vector) = match &on_body.vector {
                BodyVector::Place(at) => (&mut place, at),
                BodyVector::Direction(along) => (&mut direction, along),
            };
            entry.coordinates.push(on_body.coordinate);
            entry.vector = seen_from.to_body(&body.to_world(vector)).xy();
        }
        (direction.coordinates.len() == 2).then_some(Self { direction, place })
    }

    /// The change of the turn by the coordinates of the direction.
    fn by_direction(&self) -> Vector2<f64> {
        let along = &self.direction.vector;
        across(along) / along.norm_squared()
    }

    fn entries(&self) -> [&Entry; 2] {
        [&self.direction, &self.place]
    }

    fn turned(&self, linear: &DVector<f64>) -> Turned {
        let at = |i: usize| linear[self.direction.coordinates[i]];
        let off = Vector2::new(at(0), at(1)) - self.direction.vector;
        let angle = self.by_direction().dot(&off);
        let rotation = Rotation2::new(angle);
        let mut derivatives = [DVector::zeros(linear.len()), DVector::zeros(linear.len())];
        for (n, Entry { coordinates, vector }) in self.entries().into_iter().enumerate() {
            let turned = rotation * vector;
            // What is linear of a place stays in its own coordinates
            let kept = if n == 0 { Vector2::zeros() } else { across(vector) };
            for (axis, coordinate) in coordinates.iter().enumerate() {
                derivatives[0][*coordinate] = across(&turned)[axis] - kept[axis];
                derivatives[1][*coordinate] = -turned[axis];
            }
        }
        Turned { angle, derivatives }
    }

    /// Coordinates with the end as it is turned, from linear ones.
    #[must_use]
    pub fn coordinates(&self, linear: &DVector<f64>) -> DVector<f64> {
        let angle = self.turned(linear).angle;
        let rotation = Rotation2::new(angle);
        let mut found = linear.clone();
        for (axis, coordinate) in self.direction.coordinates.iter().enumerate() {
            found[*coordinate] = (rotation * self.direction.vector)[axis];
        }
        let lever = &self.place.vector;
        let beyond = rotation * lever - lever - across(lever) * angle;
        for (axis, coordinate) in self.place.coordinates.iter().enumerate() {
            found[*coordinate] += beyond[axis];
        }
        found
    }

    /// Their rates, from those of linear ones.
    #[must_use]
    pub fn rates(&self, linear: &DVector<f64>, rates: &DVector<f64>) -> DVector<f64> {
        let [by_angle, _] = self.turned(linear).derivatives;
        let mut found = rates.clone();
        let turning = self.turning(rates);
        self.direction.coordinates.iter().for_each(|at| found[*at] = 0.0);
        found.axpy(turning, &by_angle, 1.0);
        found
    }

    /// The rate of the turn (rad/s).
    fn turning(&self, rates: &DVector<f64>) -> f64 {
        let at = |i: usize| rates[self.direction.coordinates[i]];
        self.by_direction().dot(&Vector2::new(at(0), at(1)))
    }

    /// The forces on linear coordinates of forces on those of the end as it is turned.
    #[must_use]
    pub fn forces(&self, linear: &DVector<f64>, forces: &DVector<f64>) -> DVector<f64> {
        let [by_angle, _] = self.turned(linear).derivatives;
        let mut found = forces.clone();
        let torque = by_angle.dot(forces);
        for (axis, coordinate) in self.direction.coordinates.iter().enumerate() {
            found[*coordinate] = torque * self.by_direction()[axis];
        }
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
        let [by_angle, curvature] = self.turned(linear).derivatives;
        let by_rate = &by_angle + &curvature * (coefficient * self.turning(rates));
        let scaled = stiffness * coefficient;
        let mut tangent = &scaled + damping;
        let of_turn = &scaled * &by_angle + damping * &by_rate;
        let along = self.by_direction();
        let directions = &self.direction.coordinates;
        for (axis, coordinate) in directions.iter().enumerate() {
            tangent.set_column(*coordinate, &(&of_turn * along[axis]));
        }
        let torques = tangent.tr_mul(&by_angle);
        for (axis, coordinate) in directions.iter().enumerate() {
            tangent.set_row(*coordinate, &(torques.transpose() * along[axis]));
        }
        let second = coefficient * forces.dot(&curvature);
        for (i, row) in directions.iter().enumerate() {
            for (j, column) in directions.iter().enumerate() {
                tangent[(*row, *column)] += second * along[i] * along[j];
            }
        }
        tangent
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    fn base() -> TurningBase {
        let (seen_from, body) = (Pose::planar(0.3, -0.1, 0.4), Pose::planar(0.5, 0.2, -0.7));
        let place = BodyVector::Place(Vector3::new(0.6, -0.2, 0.0));
        let along = BodyVector::Direction(Vector3::new(0.8, 0.6, 0.0));
        let given = [(0, 0, place), (1, 1, place), (2, 0, along), (3, 1, along)];
        let given = given.map(|(coordinate, axis, vector)| OnBody { coordinate, axis, vector });
        TurningBase::new(&given, &seen_from, &body).expect("it has a direction")
    }

    /// Linear coordinates whose direction is expected, and then turned by a linear angle.
    fn linear(base: &TurningBase, angle: f64) -> DVector<f64> {
        let along = base.direction.vector + across(&base.direction.vector) * angle;
        let place = Vector2::new(0.1, 0.2) + across(&base.place.vector) * angle;
        DVector::from_vec(vec![place.x, place.y, along.x, along.y, 0.7, -0.3])
    }

    #[test]
    fn an_end_goes_round_and_keeps_its_length() {
        let base = base();
        for angle in [-0.8, 0.0, 1e-3, 2.0] {
            let rotation = Rotation2::new(angle);
            let found = base.coordinates(&linear(&base, angle));
            let along = rotation * base.direction.vector;
            let lever = &base.place.vector;
            let place = Vector2::new(0.1, 0.2) + rotation * lever - lever;
            let exact = [place.x, place.y, along.x, along.y, 0.7, -0.3];
            let off = found.iter().zip(exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(off < 1e-14, "{angle}: {off}");
        }
    }

    /// Of forces K q + C v and a cubic one: rates, forces by the energy, and the tangent, against differences.
    #[test]
    fn derivatives_are_those_of_the_turned_end() {
        let base = base();
        let entry = |i: usize, j: usize| ((1 + i * 7 + j * 3) as f64).sin();
        let symmetric =
            |seed: f64| DMatrix::from_fn(6, 6, |i, j| seed * (entry(i, j) + entry(j, i)));
        let (stiffness, damping) = (symmetric(1.0), symmetric(0.3));
        let energy = |q: &DVector<f64>| 0.5 * q.dot(&(&stiffness * q));
        let start = linear(&base, 0.3);
        let rates = DVector::from_fn(6, |i, _| entry(i, 5));
        let small = 1e-6;
        let away = |by: f64| &start + &rates * by;
        let slope =
            (base.coordinates(&away(small)) - base.coordinates(&away(-small))) / (2.0 * small);
        assert!((slope - base.rates(&start, &rates)).amax() < 1e-8);
        let forces = base.forces(&start, &(&stiffness * base.coordinates(&start)));
        let power = (energy(&base.coordinates(&away(small)))
            - energy(&base.coordinates(&away(-small))))
            / (2.0 * small);
        assert!((power - forces.dot(&rates)).abs() < 1e-8);
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
        for i in 0..6 {
            let unit = DVector::from_fn(6, |j, _| if i == j { small } else { 0.0 });
            let slope = (by_rates(&(&rates + &unit)) - by_rates(&(&rates - &unit))) / (2.0 * small);
            assert!((exact.column(i) - slope).amax() < 1e-7, "{i}");
        }
    }
}
