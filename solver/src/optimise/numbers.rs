//! `Numbers`: the numbers of a case that a search changes, and the case with values of them.

use alewife_reduced::search::Bounded;

use crate::case::{CaseError, CaseFile, Diagnostic, Severity, SoughtNumber, check, numbers_at};

/// The numbers of a case that a search changes.
#[derive(Debug, Clone)]
pub struct Numbers {
    file: CaseFile,
    sought: Vec<SoughtNumber>,
}

impl Numbers {
    /// Those of a case.
    pub fn new(file: &CaseFile) -> Self {
        Self { file: file.clone(), sought: file.sought() }
    }

    /// Their names, starts, bounds and scales.
    pub fn bounded(&self) -> Vec<Bounded> {
        let bounded = |number: &SoughtNumber| {
            let [lower, upper] = number.bounds;
            let SoughtNumber { start, scale, .. } = *number;
            Bounded { name: number.name.clone(), start, lower, upper, scale }
        };
        self.sought.iter().map(bounded).collect()
    }

    /// How large a change of each is one.
    pub fn sizes(&self, values: &[f64]) -> Vec<f64> {
        let size = |(number, value): (&SoughtNumber, &f64)| {
            number.scale.map_or(value.abs(), |scale| scale.max(value.abs()))
        };
        self.sought.iter().zip(values).map(size).collect()
    }

    /// The case with these values.
    pub fn case(&self, values: &[f64]) -> Result<CaseFile, CaseError> {
        let numbers = numbers_at(&self.sought, &self.file.case().define, values)?;
        self.file.with_numbers(&numbers)
    }

    /// The case with these values, without errors.
    pub fn checked(&self, values: &[f64]) -> Result<CaseFile, CaseError> {
        let file = self.case(values)?;
        let mut found = check(&file);
        found.retain(|one| one.severity == Severity::Error);
        if found.is_empty() { Ok(file) } else { Err(CaseError::Wrong(found)) }
    }

    /// Refuses bounds at which the case is wrong, with the other numbers where the search starts.
    pub fn check_bounds(&self) -> Result<(), CaseError> {
        let starts: Vec<f64> = self.sought.iter().map(|number| number.start).collect();
        self.checked(&starts)?;
        let mut wrong = Vec::new();
        for (nth, number) in self.sought.iter().enumerate() {
            for bound in number.bounds {
                let mut values = starts.clone();
                values[nth] = bound;
                if let Err(error) = self.checked(&values) {
                    wrong.push(self.at_bound(number, bound, &error));
                }
            }
        }
        if wrong.is_empty() { Ok(()) } else { Err(CaseError::Wrong(wrong)) }
    }

    /// What is wrong with a case at a bound.
    fn at_bound(&self, number: &SoughtNumber, bound: f64, error: &CaseError) -> Diagnostic {
        let why = match error {
            CaseError::Wrong(all) => all.first().map(|one| one.message.clone()),
            _ => None,
        };
        let key = format!("{}.bounds", number.at);
        let why = why.unwrap_or_else(|| error.to_string());
        Diagnostic {
            severity: Severity::Error,
            message: format!(
                "with \"{}\" at its bound {bound} the case is wrong: {why}",
                number.name
            ),
            help: "narrow the bounds: the search may go to each of them".to_owned(),
            location: self.file.location(&key),
            key,
        }
    }
}
