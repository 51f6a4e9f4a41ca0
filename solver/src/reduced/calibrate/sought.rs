//! `Sought`: the coefficients that a calibration finds.

use alewife_reduced::tree::{Bounds, Number, real};

use crate::case::{CalibrationSpec, ReducedSpec};

/// Which coefficients of a law are found, by their numbers.
pub struct Sought {
    pub numbers: Vec<usize>,
    pub bounds: Vec<Bounds>,
    pub start: Vec<f64>,
}

impl Sought {
    pub fn new(spec: &CalibrationSpec, reduced: &ReducedSpec) -> Self {
        let all = reduced.loads.coefficients();
        let number = |name: &String| all.iter().position(|one| one.name == name);
        let numbers: Vec<usize> = spec.fit.iter().filter_map(number).collect();
        let own = reduced.coefficients_of("");
        let bound = |name: &String| {
            let [lower, upper] = spec.bounds_of(name);
            Bounds { lower, upper }
        };
        let bounds = spec.fit.iter().map(bound).collect();
        let start = numbers.iter().map(|number| own[*number]).collect();
        Self { numbers, bounds, start }
    }

    /// All coefficients of a body with those that are found at other values.
    pub fn filled<T: Number>(&self, own: &[f64], found: &[T]) -> Vec<T> {
        let mut all: Vec<T> = own.iter().map(|value| real(*value)).collect();
        for (number, value) in self.numbers.iter().zip(found) {
            all[*number] = *value;
        }
        all
    }
}
