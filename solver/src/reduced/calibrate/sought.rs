//! `Sought`: the coefficients that a calibration finds, and other numbers of the case.

use alewife_reduced::tree::{Bounds, Number, real};

use crate::case::{
    CalibrationSpec, CaseError, CaseFile, FitName, ReducedSpec, SoughtNumber, WrittenNumber,
    numbers_at,
};

/// A coefficient that is found.
#[derive(Debug, Clone, Copy)]
struct Coefficient {
    /// Its number in the law.
    number: usize,
    /// The body whose own it is; that of all bodies without their own otherwise.
    body: Option<usize>,
}

/// Part of each value that differences go to either side at the end of a search for numbers of the case.
const DIFFERENCES: f64 = 0.02;

/// What is found: first coefficients of a law, then other numbers of the case.
pub struct Sought {
    coefficients: Vec<Coefficient>,
    numbers: Vec<SoughtNumber>,
    /// Names of all.
    pub names: Vec<String>,
    pub bounds: Vec<Bounds>,
    pub start: Vec<f64>,
    /// Part of each that differences go to either side, if not exact derivatives are taken.
    pub differences: Option<f64>,
}

impl Sought {
    pub fn new(spec: &CalibrationSpec, reduced: &ReducedSpec, file: &CaseFile) -> Self {
        let all = reduced.loads.coefficients();
        let (coefficients, bounds, start) = (Vec::new(), Vec::new(), Vec::new());
        let numbers = file.fitted_numbers();
        let differences = spec.differences.or((!numbers.is_empty()).then_some(DIFFERENCES));
        let names = Vec::new();
        let mut sought = Self { coefficients, numbers, names, bounds, start, differences };
        for name in &spec.fit {
            let FitName { body, coefficient } = FitName::new(name);
            let Some(number) = all.iter().position(|one| one.name == coefficient) else { continue };
            let [lower, upper] = spec.bounds_of(name);
            let own = body.and_then(|body| file.model.body_index(body));
            sought.names.push(name.clone());
            sought.coefficients.push(Coefficient { number, body: own });
            sought.bounds.push(Bounds { lower, upper });
            sought.start.push(reduced.coefficients_of(body.unwrap_or_default())[number]);
        }
        for SoughtNumber { name, start, bounds: [lower, upper], .. } in &sought.numbers {
            sought.names.push(name.clone());
            sought.bounds.push(Bounds { lower: *lower, upper: *upper });
            sought.start.push(*start);
        }
        sought
    }

    /// Whether other numbers of the case are found than coefficients.
    pub fn has_numbers(&self) -> bool {
        !self.numbers.is_empty()
    }

    /// The other numbers of a case at the values of all that is found.
    ///
    /// # Errors
    /// An expression of them that is no number.
    pub fn numbers(&self, file: &CaseFile, found: &[f64]) -> Result<Vec<WrittenNumber>, CaseError> {
        let own = found.get(self.coefficients.len()..).unwrap_or_default();
        numbers_at(&self.numbers, &file.case().define, own)
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
