//! `Tier`: which of the models of a case a search asks for its quantities and their derivatives.

use std::fmt::Debug;

use super::error::OptimiseError;
use crate::case::{CaseError, CaseFile, Diagnostic, Severity, SoughtNumber, check_reduced};
use crate::gradient::{Derivatives, FlowByNumbers, NumberedCase};
use crate::reduced::{MotionByNumbers, SlopeError};

/// What finds quantities of a case at values of its numbers, and their derivatives by them.
pub trait Quantities {
    /// The quantities.
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, OptimiseError>;
}

/// A model of a case.
pub trait Tier: Debug {
    /// What is wrong with a case for it.
    fn check(&self, file: &CaseFile) -> Result<(), OptimiseError>;

    /// What finds quantities, beginning at a case.
    fn begin(&self, file: &CaseFile) -> Result<Box<dyn Quantities>, OptimiseError>;

    /// Whether what it finds is that of a mesh which is made where it begins.
    fn has_mesh(&self) -> bool;
}

/// The model that a search of a case asks.
pub fn tier_of(file: &CaseFile) -> Box<dyn Tier> {
    if file.case().is_searched_reduced() { Box::new(Reduced) } else { Box::new(Full) }
}

/// The full solver.
#[derive(Debug)]
struct Full;

impl Tier for Full {
    fn check(&self, _file: &CaseFile) -> Result<(), OptimiseError> {
        Ok(())
    }

    fn begin(&self, file: &CaseFile) -> Result<Box<dyn Quantities>, OptimiseError> {
        Ok(Box::new(FlowByNumbers::new(file)?))
    }

    fn has_mesh(&self) -> bool {
        true
    }
}

impl Quantities for FlowByNumbers {
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, OptimiseError> {
        Ok(Self::at(self, numbered, values)?)
    }
}

/// The reduced model.
#[derive(Debug)]
struct Reduced;

/// Motions of the reduced model of a case.
struct Motions {
    file: CaseFile,
    sought: Vec<SoughtNumber>,
}

impl Tier for Reduced {
    fn check(&self, file: &CaseFile) -> Result<(), OptimiseError> {
        let mut found = check_reduced(file);
        found.retain(|one| one.severity == Severity::Error);
        if found.is_empty() { Ok(()) } else { Err(CaseError::Wrong(found).into()) }
    }

    fn begin(&self, file: &CaseFile) -> Result<Box<dyn Quantities>, OptimiseError> {
        Ok(Box::new(Motions { file: file.clone(), sought: file.sought() }))
    }

    fn has_mesh(&self) -> bool {
        false
    }
}

impl Quantities for Motions {
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, OptimiseError> {
        MotionByNumbers.at(numbered, values).map_err(|error| match error {
            SlopeError::Case(error) => error.into(),
            SlopeError::Model(error) => error.into(),
            SlopeError::Number { nth, what } => {
                let SoughtNumber { name, at, .. } = &self.sought[nth];
                let key = format!("{at}.keys.0");
                CaseError::Wrong(vec![Diagnostic {
                    severity: Severity::Error,
                    message: format!(
                        "there is no derivative by \"{name}\" in the reduced model: it changes {what}"
                    ),
                    help: "searches by the reduced model change numbers of gaits, coefficients of loads, springs and \
                           servos of joints, and steps in time together with their end"
                        .to_owned(),
                    location: self.file.location(&key),
                    key,
                }])
                .into()
            }
        })
    }
}
