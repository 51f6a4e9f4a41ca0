//! `Rod`: elastic, active and damping forces of a rod, summed over its elements.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

use super::clamp::Element;
use super::error::RodError;
use super::kinematics::{
    Gradients, Kinematics, StrainKind, gradients, second_derivatives, strains,
};
use super::properties::{Flexure, RodProperties, positive};
use crate::structure::{InnerPower, Structure, Tangents};

/// A rod whose elements have N coordinates and S strains: [`super::PlanarRod`] or [`super::SpatialRod`].
#[derive(Debug, Clone)]
pub struct Rod<K, const N: usize, const S: usize> {
    kinematics: K,
    /// Distances along the rod (m).
    knots: Vec<f64>,
    /// By element and strain.
    laws: Vec<[Law; S]>,
    flexures: Vec<Flexure>,
    mass: DMatrix<f64>,
    /// Whether base and tip are clamped.
    pub(super) clamped: [bool; 2],
    /// Of a rod that is closed, the way from a place of it to the same one a period further (m).
    period: Option<SVector<f64, 3>>,
}

/// What a rod is made of.
pub(super) struct Parts<K> {
    pub kinematics: K,
    pub rod: RodProperties,
    pub flexures: Vec<Flexure>,
    pub mass: DMatrix<f64>,
}

/// What a strain of an element does: forces by its weight.
#[derive(Debug, Clone, Copy)]
struct Law {
    kind: StrainKind,
    /// Distance along the rod (m), and the length it stands for (m).
    along: f64,
    weight: f64,
    stiffness: f64,
    /// Stiffness times the time of relaxation.
    damping: f64,
}

/// A point of a rod.
#[derive(Debug, Clone, Copy)]
pub(super) struct Location {
    pub element: usize,
    /// Part of the element.
    pub xi: f64,
    /// Length of the element (m).
    pub length: f64,
}

/// Rest and active moment of a strain at a time.
#[derive(Default)]
struct Activity {
    rest: f64,
    rest_rate: f64,
    moment: f64,
}

/// An element at an instant.
struct Instant<const N: usize, const S: usize> {
    gradients: Gradients<N, S>,
    /// Rates of strains (1/s).
    rates: SVector<f64, S>,
    /// Derivatives of the power by rates of strains.
    stresses: SVector<f64, S>,
}

impl<K: Kinematics<N, S>, const N: usize, const S: usize> Rod<K, N, S> {
    /// A rod of its parts, whose stiffness is checked.
    pub(super) fn of_parts(parts: Parts<K>) -> Result<Self, RodError> {
        let Parts { kinematics, rod, flexures, mass } = parts;
        let n = rod.elements;
        let knots: Vec<f64> = (0..=n).map(|i| rod.length * i as f64 / n as f64).collect();
        let points = kinematics.points();
        let mut laws = Vec::with_capacity(n);
        for ends in knots.windows(2) {
            let length = ends[1] - ends[0];
            let mut of_element = [Law {
                kind: StrainKind::Stretch,
                along: 0.0,
                weight: 0.0,
                stiffness: 0.0,
                damping: 0.0,
            }; S];
            for (law, point) in of_element.iter_mut().zip(&points) {
                let along = ends[0] + point.xi * length;
                let (stiffness, damping) = match point.kind {
                    StrainKind::Flexure(number) => {
                        let stiffness = flexures[number].stiffness.at(along);
                        positive("the stiffness in bending or twist", along, stiffness)?;
                        (stiffness, stiffness * rod.damping)
                    }
                    StrainKind::Stretch => (rod.stretching, 0.0),
                    // Comparable to what else acts on a vector across: twist
                    StrainKind::Gauge => (
                        flexures.last().map_or(0.0, |twist| twist.stiffness.at(along))
                            / (length * length),
                        0.0,
                    ),
                };
                let weight = point.weight * length;
                *law = Law { kind: point.kind, along, weight, stiffness, damping };
            }
            laws.push(of_element);
        }
        let clamped = [false; 2];
        Ok(Self { kinematics, knots, laws, flexures, mass, clamped, period: None })
    }

    /// The same rod, in which what only fixes the vectors across at the knots relaxes within a time (s): without mass nothing else
    /// determines its rates where no time passes.
    #[must_use]
    pub fn with_relaxation(mut self, time: f64) -> Self {
        for law in self.laws.iter_mut().flatten() {
            if law.kind == StrainKind::Gauge {
                law.damping = law.stiffness * time;
            }
        }
        self
    }

    /// The same rod, whose last knot is its first one a period (m) further: it goes on for ever, and has no ends.
    #[must_use]
    pub(super) fn closed(mut self, period: SVector<f64, 3>) -> Self {
        let all = std::mem::take(&mut self.mass);
        self.period = Some(period);
        let n = self.n_coordinates();
        self.mass = DMatrix::zeros(n, n);
        for i in 0..all.nrows() {
            for j in 0..all.ncols() {
                self.mass[(i % n, j % n)] += all[(i, j)];
            }
        }
        self
    }

    /// Whether its last knot is its first one a period further.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.period.is_some()
    }

    /// Distances of the knots along the rod (m).
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Coordinates of a knot.
    pub(super) const STRIDE: usize = N / 2;

    /// The element of a distance along the rod (m).
    pub(super) fn locate(&self, along: f64) -> Location {
        let last = self.laws.len() - 1;
        let element = self.knots.partition_point(|knot| *knot <= along).saturating_sub(1).min(last);
        let length = self.knots[element + 1] - self.knots[element];
        Location { element, xi: (along - self.knots[element]) / length, length }
    }

    /// Where the coordinates of an element are among those of the rod.
    fn indices(&self, element: usize) -> [usize; N] {
        let n = self.n_coordinates();
        std::array::from_fn(|i| (element * Self::STRIDE + i) % n)
    }

    /// Coordinates of an element.
    pub(super) fn of_element(&self, all: &DVector<f64>, element: usize) -> SVector<f64, N> {
        let mut values = self.rates_of_element(all, element);
        if let Some(period) = self.period.filter(|_| element + 1 == self.laws.len()) {
            for axis in 0..K::DIMENSION {
                values[Self::STRIDE + axis] += period[axis];
            }
        }
        values
    }

    /// Rates of the coordinates of an element.
    pub(super) fn rates_of_element(&self, all: &DVector<f64>, element: usize) -> SVector<f64, N> {
        SVector::from(self.indices(element).map(|i| all[i]))
    }

    /// Coordinates of an element with tangents of the length that they have at clamps.
    pub(super) fn shaped(&self, all: &DVector<f64>, element: usize) -> [f64; N] {
        self.element(element).shaped(&self.of_element(all, element).into())
    }

    pub(super) fn element(&self, element: usize) -> Element {
        let last = self.laws.len() - 1;
        let [base, tip] = self.clamped;
        Element {
            length: self.knots[element + 1] - self.knots[element],
            clamped: [base && element == 0, tip && element == last],
            dimension: K::DIMENSION,
        }
    }

    fn activity(&self, law: &Law, time: f64) -> Activity {
        let StrainKind::Flexure(number) = law.kind else { return Activity::default() };
        let flexure = &self.flexures[number];
        let rest = flexure.rest.at(law.along, time);
        let moment = flexure.moment.at(law.along, time).value;
        Activity { rest: rest.value, rest_rate: rest.rate, moment }
    }

    fn instant(
        &self,
        element: usize,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Instant<N, S> {
        let at = self.of_element(coordinates, element);
        let gradients = gradients(&self.kinematics, &self.element(element), &at);
        let rates = gradients.first * self.rates_of_element(velocities, element);
        let stresses = SVector::from_fn(|i, _| {
            let law = &self.laws[element][i];
            let Activity { rest, moment, .. } = self.activity(law, time);
            let elastic = law.stiffness * (gradients.values[i] - rest);
            law.weight * (elastic + law.damping * rates[i] - moment)
        });
        Instant { gradients, rates, stresses }
    }

    /// Strains of an element.
    fn strains(&self, coordinates: &DVector<f64>, element: usize) -> [f64; S] {
        let at: [f64; N] = self.of_element(coordinates, element).into();
        strains(&self.kinematics, &self.element(element), &at)
    }

    /// Largest |stretch| at a point where it is taken.
    #[must_use]
    pub fn largest_stretch(&self, coordinates: &DVector<f64>) -> f64 {
        let mut largest: f64 = 0.0;
        for (element, laws) in self.laws.iter().enumerate() {
            for (law, strain) in laws.iter().zip(self.strains(coordinates, element)) {
                if law.kind == StrainKind::Stretch {
                    largest = largest.max(strain.abs());
                }
            }
        }
        largest
    }
}

impl<K: Kinematics<N, S>, const N: usize, const S: usize> Structure for Rod<K, N, S> {
    fn n_coordinates(&self) -> usize {
        let n_free = self.knots.len() - usize::from(self.is_closed());
        Self::STRIDE * n_free
    }

    fn mass(&self) -> DMatrix<f64> {
        self.mass.clone()
    }

    fn forces(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> DVector<f64> {
        let mut forces = DVector::zeros(self.n_coordinates());
        for element in 0..self.laws.len() {
            let Instant { gradients, stresses, .. } =
                self.instant(element, coordinates, velocities, time);
            let of_element = gradients.first.transpose() * stresses;
            for (i, force) in self.indices(element).into_iter().zip(of_element.iter()) {
                forces[i] += force;
            }
        }
        forces
    }

    fn tangents(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> Tangents {
        let n = self.n_coordinates();
        let (mut stiffness, mut damping) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for (element, laws) in self.laws.iter().enumerate() {
            let Instant { gradients, stresses, .. } =
                self.instant(element, coordinates, velocities, time);
            let at = self.of_element(coordinates, element);
            let speeds = self.rates_of_element(velocities, element);
            let second = second_derivatives(&self.kinematics, &self.element(element), &at);
            let (mut by_place, mut by_speed) =
                (SMatrix::<f64, N, N>::zeros(), SMatrix::<f64, N, N>::zeros());
            for (i, law) in laws.iter().enumerate() {
                let row = gradients.first.row(i);
                let column = row.transpose();
                by_place += second[i] * stresses[i];
                by_place += column * row * (law.weight * law.stiffness);
                if law.damping > 0.0 {
                    let factor = law.weight * law.damping;
                    by_place += column * (second[i] * speeds).transpose() * factor;
                    by_speed += column * row * factor;
                }
            }
            let indices = self.indices(element);
            for (column, j) in indices.into_iter().enumerate() {
                for (row, i) in indices.into_iter().enumerate() {
                    stiffness[(i, j)] += by_place[(row, column)];
                    damping[(i, j)] += by_speed[(row, column)];
                }
            }
        }
        Tangents { stiffness, damping }
    }

    fn elastic_energy(&self, coordinates: &DVector<f64>, time: f64) -> f64 {
        let mut energy = 0.0;
        for (element, laws) in self.laws.iter().enumerate() {
            for (law, strain) in laws.iter().zip(self.strains(coordinates, element)) {
                let from_rest = strain - self.activity(law, time).rest;
                energy += 0.5 * law.weight * law.stiffness * from_rest * from_rest;
            }
        }
        energy
    }

    fn inner_power(
        &self,
        coordinates: &DVector<f64>,
        velocities: &DVector<f64>,
        time: f64,
    ) -> InnerPower {
        let mut power = InnerPower::default();
        for (element, laws) in self.laws.iter().enumerate() {
            let Instant { gradients, rates, .. } =
                self.instant(element, coordinates, velocities, time);
            for (i, law) in laws.iter().enumerate() {
                let Activity { rest, rest_rate, moment } = self.activity(law, time);
                let of_rest = -law.stiffness * (gradients.values[i] - rest) * rest_rate;
                power.activation += law.weight * (of_rest + moment * rates[i]);
                power.dissipation += law.weight * law.damping * rates[i] * rates[i];
            }
        }
        power
    }
}
