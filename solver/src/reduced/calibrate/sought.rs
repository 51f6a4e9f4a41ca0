//! `Sought`: the coefficients that a calibration finds.

use alewife_reduced::tree::{Bounds, Number, real};

use crate::case::{CalibrationSpec, FitName, Model, ReducedSpec};

/// A coefficient that is found.
#[derive(Debug, Clone, Copy)]
struct Coefficient {
    /// Its number in the law.
    number: usize,
    /// The body whose own it is; that of all bodies without their own otherwise.
    body: Option<usize>,
}

/// Which coefficients of a law are found.
pub struct Sought {
    coefficients: Vec<Coefficient>,
    pub bounds: Vec<Bounds>,
    pub start: Vec<f64>,
    /// Part of each that differences go to either side, if not exact derivatives are taken.
    pub differences: Option<f64>,
}

impl Sought {
    pub fn new(spec: &CalibrationSpec, reduced: &ReducedSpec, model: &Model) -> Self {
        let all = reduced.loads.coefficients();
        let (coefficients, bounds, start) = (Vec::new(), Vec::new(), Vec::new());
        let differences = spec.differences;
        let mut sought = Self { coefficients, bounds, start, differences };
        for name in &spec.fit {
            let FitName { body, coefficient } = FitName::new(name);
            let Some(number) = all.iter().position(|one| one.name == coefficient) else { continue };
            let [lower, upper] = spec.bounds_of(name);
            let own = body.and_then(|body| model.body_index(body));
            sought.coefficients.push(Coefficient { number, body: own });
            sought.bounds.push(Bounds { lower, upper });
            sought.start.push(reduced.coefficients_of(body.unwrap_or_default())[number]);
        }
        sought
    }

    /// All coefficients of a body with those that are found at other values.
    pub fn filled<T: Number>(&self, body: usize, own: &[f64], found: &[T]) -> Vec<T> {
        let mut all: Vec<T> = own.iter().map(|value| real(*value)).collect();
        // What is found of one body comes after what is found of all
        for is_own in [false, true] {
            for (one, value) in self.coefficients.iter().zip(found) {
                let is_of_it = if is_own { one.body == Some(body) } else { one.body.is_none() };
                if is_of_it {
                    all[one.number] = *value;
                }
            }
        }
        all
    }
}

/// The law of a case with coefficients that were found.
pub fn with_found(reduced: &ReducedSpec, names: &[String], found: &[f64]) -> ReducedSpec {
    let mut made = reduced.clone();
    let pairs = || names.iter().map(|name| FitName::new(name)).zip(found);
    for (FitName { coefficient, .. }, value) in pairs().filter(|(name, _)| name.body.is_none()) {
        made.coefficients.insert(coefficient.to_owned(), *value);
        // What is found is that of all bodies
        for own in made.body.values_mut() {
            own.remove(coefficient);
        }
    }
    for (FitName { body, coefficient }, value) in pairs() {
        if let Some(body) = body {
            let own = made.body.entry(body.to_owned()).or_default();
            own.insert(coefficient.to_owned(), *value);
        }
    }
    made
}
