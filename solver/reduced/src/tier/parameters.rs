//! `Sought`: the numbers of a search, one by one, with their keys.

use crate::search::Bounded;

use alewife_case::soft::ParameterKey;
use alewife_case::soft::search::Parameter;
use alewife_case::soft::spec::SoftCase;

/// The numbers a search changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sought {
    /// Their names, starts, bounds and scales.
    pub bounded: Vec<Bounded>,
    /// The numbers of the case that each of them is.
    pub keys: Vec<Vec<ParameterKey>>,
}

impl Sought {
    /// Those of a search of a case; a key that leads to a list gives one an entry.
    #[must_use]
    pub fn new(case: &SoftCase, parameters: &[Parameter]) -> Self {
        let mut all = Self { bounded: Vec::new(), keys: Vec::new() };
        for parameter in parameters {
            let found: Vec<Vec<ParameterKey>> = parameter
                .keys
                .iter()
                .map(|key| ParameterKey::find(case, key).unwrap_or_default())
                .collect();
            let n = found.iter().map(Vec::len).min().unwrap_or(0);
            for entry in 0..n {
                let keys: Vec<ParameterKey> = found.iter().map(|list| list[entry]).collect();
                let own = keys.first().and_then(|key| key.read(case)).unwrap_or(f64::NAN);
                let name = match n {
                    1 => parameter.name.clone(),
                    _ => format!("{}.{entry}", parameter.name),
                };
                let [lower, upper] = parameter.bounds;
                let start = parameter.start.unwrap_or(own);
                all.bounded.push(Bounded { name, start, lower, upper, scale: parameter.scale });
                all.keys.push(keys);
            }
        }
        all
    }

    /// Writes values into a case.
    pub fn write(&self, case: &mut SoftCase, values: &[f64]) {
        for (keys, value) in self.keys.iter().zip(values) {
            keys.iter().for_each(|key| key.write(case, *value));
        }
    }
}
