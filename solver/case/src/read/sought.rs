//! `SoughtNumber`: a number that a search of a steady flow changes, with the keys of the case that follow from it.

use super::{CaseFile, UntypedCase, WrittenNumber, wrong};
use crate::text::diagnostic::CaseError;
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TomlValue};
use crate::{Definitions, FlowParameter, Formula};

/// Tables with numbers of what is solved; those of all others say how.
pub const SOLVED_TABLES: [&str; 7] =
    ["boundary", "body", "field", "fluid", "joint", "scales", "swimmer"];

/// The same of a reduced model.
pub const MOVED_TABLES: [&str; 4] = ["joint", "reduced", "swimmer", "time"];

/// The same of what is fitted to recorded tracks.
pub const TRACKED_TABLES: [&str; 5] = ["body", "fluid", "joint", "reduced", "swimmer"];

/// A number that a search changes.
#[derive(Debug, Clone, PartialEq)]
pub struct SoughtNumber {
    /// Its name.
    pub name: String,
    /// Key of the parameter, such as `optimisation.parameter.0`.
    pub at: String,
    /// The keys that follow from it, and what each of them is: the number itself where there is no expression.
    pub keys: Vec<SoughtKey>,
    /// Where the search starts; not a number where nothing says so.
    pub start: f64,
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// The size of a change that matters; none where the logarithm is searched.
    pub scale: Option<f64>,
}

/// A key that follows from numbers that are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct SoughtKey {
    /// The key.
    pub key: String,
    /// What it is, in names of numbers that are sought.
    pub value: Option<Formula>,
}

impl CaseFile {
    /// The numbers that the search of the case changes; a key that leads to a list gives one an entry. Keys that lead
    /// to no number are there, without a start.
    #[must_use]
    pub fn sought(&self) -> Vec<SoughtNumber> {
        let parameters = self.case().optimisation.iter().flat_map(|own| &own.parameter);
        self.numbers_of_all("optimisation", parameters)
    }

    /// The same of a calibration.
    #[must_use]
    pub fn fitted_numbers(&self) -> Vec<SoughtNumber> {
        let parameters = self.case().calibration.iter().flat_map(|own| &own.parameter);
        self.numbers_of_all("calibration", parameters)
    }

    fn numbers_of_all<'a>(
        &self,
        table: &str,
        parameters: impl Iterator<Item = &'a FlowParameter>,
    ) -> Vec<SoughtNumber> {
        let at = |nth: usize| format!("{table}.parameter.{nth}");
        let numbers = |(nth, parameter)| self.numbers_of(&at(nth), parameter);
        parameters.enumerate().flat_map(numbers).collect()
    }

    /// The keys of the numbers a key of the case leads to: of itself, or of all entries of a list of numbers.
    #[must_use]
    pub fn numbers_at(&self, key: &str) -> Vec<String> {
        if self.number(key).is_some() {
            return vec![key.to_owned()];
        }
        let items = self.root.get(key).and_then(TomlNode::array).unwrap_or_default();
        let entries: Vec<String> = (0..items.len()).map(|entry| format!("{key}.{entry}")).collect();
        if entries.iter().all(|entry| self.number(entry).is_some()) { entries } else { Vec::new() }
    }

    fn numbers_of(&self, at: &str, parameter: &FlowParameter) -> Vec<SoughtNumber> {
        let FlowParameter { name, keys, values, start, bounds, scale } = parameter;
        let found: Vec<Vec<String>> = keys.iter().map(|key| self.numbers_at(key)).collect();
        let n = found.iter().map(Vec::len).min().unwrap_or(0).max(1);
        let number = |entry: usize| {
            let key = |(position, key): (usize, &String)| SoughtKey {
                key: found[position].get(entry).unwrap_or(key).clone(),
                value: values.get(position).map(|text| Formula::Expression(text.clone())),
            };
            let keys: Vec<SoughtKey> = keys.iter().enumerate().map(key).collect();
            let first = keys.first().filter(|key| key.value.is_none());
            let own = first.and_then(|first| self.number(&first.key));
            SoughtNumber {
                name: if n == 1 { name.clone() } else { format!("{name}.{entry}") },
                at: at.to_owned(),
                keys,
                start: start.or(own).unwrap_or(f64::NAN),
                bounds: *bounds,
                scale: *scale,
            }
        };
        (0..n).map(number).collect()
    }

    /// The case with other numbers at keys that are written in it, and without the dimensionless numbers its author
    /// expects, which are those of the case as it is written.
    ///
    /// # Errors
    /// [`CaseError`]: a key is not there, or the case is wrong with these numbers.
    pub fn with_numbers(&self, numbers: &[WrittenNumber]) -> Result<Self, CaseError> {
        let mut root = self.root.clone();
        for WrittenNumber { path: key, value } in numbers {
            let nowhere = || Origin { span: 0..0, ..root.origin.clone() };
            let [key_at, origin] = root.get(key).map_or_else(
                || [nowhere(), nowhere()],
                |node| [node.key.clone(), node.origin.clone()],
            );
            let node = TomlNode { key: key_at, origin, value: TomlValue::Float(*value) };
            root.set(key, node).map_err(wrong)?;
        }
        if let Some(entries) = root.table_mut() {
            entries.remove("numbers");
        }
        let untyped = UntypedCase {
            names: [self.name.clone(), self.file.clone()],
            variant: self.variant.clone(),
            variants: self.variants.clone(),
            root,
            sweep: None,
        };
        Ok(Self { has_sweep: self.has_sweep, ..untyped.typed()? })
    }
}

/// The numbers of all keys that follow from values of what is sought, in its order.
///
/// # Errors
/// [`CaseError`] for an expression that is not understood, or whose value is no number.
pub fn numbers_at(
    sought: &[SoughtNumber],
    define: &Definitions,
    values: &[f64],
) -> Result<Vec<WrittenNumber>, CaseError> {
    let mut known = define.clone();
    let named = sought.iter().zip(values).map(|(number, value)| (number.name.clone(), *value));
    known.extend(named);
    let mut numbers = Vec::new();
    for (number, own) in sought.iter().zip(values) {
        for (nth, SoughtKey { key, value }) in number.keys.iter().enumerate() {
            let wrong = |message: String| {
                let help = "write an expression of names of parameters that is finite between their bounds";
                CaseError::at(&format!("{}.values.{nth}", number.at), message, help)
            };
            let found = match value {
                None => *own,
                Some(formula) => {
                    // Neither places nor times: they are refused where the case is checked
                    let parsed = formula.parsed(&known, 2);
                    parsed.map_err(|error| wrong(error.to_string()))?.at(&[0.0; 4])
                }
            };
            if !found.is_finite() {
                return Err(wrong(format!("`{key}` would be {found}, no finite number")));
            }
            numbers.push(WrittenNumber { path: key.clone(), value: found });
        }
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Case;

    const SETTINGS: &str = r#"optimisation={ objective = { sum = [{ quantity = "squirmer.power" }] }, parameter = [
        { name = "modes", keys = ["body.0.gait.squirmer.modes"], bounds = [-1.0, 9.0], scale = 1.0 },
        { name = "aspect", keys = ["body.0.shape.sphere.radius", "fluid.viscosity"], values = ["aspect^(1/3)", "2*aspect"],
          start = 8.0, bounds = [1.0, 9.0] },
    ] }"#;

    #[test]
    fn lists_are_a_number_an_entry_and_keys_follow_from_expressions() {
        let settings = [SETTINGS.replace('\n', " ").replace(", ]", "]")];
        let file = Case::read("squirmer-alone", &settings).unwrap();
        let sought = file.sought();
        let names: Vec<&str> = sought.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["modes.0", "modes.1", "aspect"]);
        let starts: Vec<f64> = sought.iter().map(|one| one.start).collect();
        assert_eq!(starts, [1.5, 7.5, 8.0]);
        let define = Definitions::new();
        let numbers = numbers_at(&sought, &define, &[2.0, 3.0, 8.0]).unwrap();
        let changed = file.with_numbers(&numbers).unwrap();
        let number = |key: &str| changed.number(key).unwrap();
        assert_eq!(number("body.0.gait.squirmer.modes.0"), 2.0);
        assert_eq!(number("body.0.gait.squirmer.modes.1"), 3.0);
        assert_eq!(number("body.0.shape.sphere.radius"), 2.0);
        assert_eq!(number("fluid.viscosity"), 16.0);
    }
}
