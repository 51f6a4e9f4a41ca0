//! `OnOneMesh`: the objective of a flow on a mesh that follows the bodies, as a search asks for it.

use alewife_reduced::search::{Evaluated, Sought};

use super::constraints::{Held, Multipliers};
use super::error::OptimiseError;
use super::numbers::Numbers;
use super::objective::Objective;
use super::tier::{Quantities, Tier};
use crate::gradient::{Derivatives, NumberedCase};

/// The objective of a flow, on the mesh of the case at the start of a round.
pub struct OnOneMesh<'a> {
    numbers: &'a Numbers,
    objective: &'a Objective,
    multipliers: Multipliers,
    start: Vec<f64>,
    /// Made when it is first needed: a search that goes on may know all of a round.
    flows: Option<Box<dyn Quantities>>,
    tier: &'a dyn Tier,
    /// What has been found, with the values it was found for.
    known: Vec<Known>,
    /// Why the last evaluation failed, if it did.
    pub failure: Option<String>,
}

/// Quantities that have been found.
struct Known {
    values: Vec<f64>,
    quantities: Vec<Derivatives>,
}

impl<'a> OnOneMesh<'a> {
    /// On the mesh of the case with these values, with these multipliers of what is held.
    pub fn new(
        numbers: &'a Numbers,
        objective: &'a Objective,
        multipliers: &Multipliers,
        start: &[f64],
        tier: &'a dyn Tier,
    ) -> Self {
        Self {
            numbers,
            objective,
            multipliers: multipliers.clone(),
            start: start.to_vec(),
            flows: None,
            tier,
            known: Vec::new(),
            failure: None,
        }
    }

    /// Takes other multipliers of what is held.
    pub fn hold(&mut self, multipliers: &Multipliers) {
        self.multipliers = multipliers.clone();
    }

    /// The quantities of the objective at values.
    pub fn quantities(&mut self, values: &[f64]) -> Result<Vec<Derivatives>, OptimiseError> {
        if let Some(known) = self.known.iter().find(|known| known.values == values) {
            return Ok(known.quantities.clone());
        }
        // The case is refused where it is wrong, not only where it cannot be solved
        self.numbers.checked(values)?;
        let flows = match self.flows.take() {
            Some(flows) => flows,
            None => self.tier.begin(&self.numbers.case(&self.start)?)?,
        };
        let numbered = NumberedCase {
            case: &|values| self.numbers.case(values),
            of: &self.objective.quantities,
            sizes: &self.numbers.sizes(values),
        };
        let found = flows.at(&numbered, values);
        self.flows = Some(flows);
        let quantities = found?;
        self.known.push(Known { values: values.to_vec(), quantities: quantities.clone() });
        Ok(quantities)
    }

    /// What is held, at values.
    pub fn held(&mut self, values: &[f64]) -> Result<Vec<Held>, OptimiseError> {
        let quantities = self.quantities(values)?;
        Ok(self.multipliers.held(self.numbers, values, &quantities)?)
    }

    /// The objective at values, and its derivatives by them: without what is held.
    pub fn objective(&mut self, values: &[f64]) -> Result<Evaluated, String> {
        let quantities = self.quantities(values).map_err(|error| error.to_string())?;
        let [own, sizes]: [Vec<f64>; 2] =
            [|one: &Derivatives| one.value, |one: &Derivatives| one.size]
                .map(|of| quantities.iter().map(of).collect());
        let found = self.objective.at(&own, &sizes).map_err(|error| error.to_string())?;
        let slope = |nth: usize| {
            let parts = quantities.iter().zip(&found.by);
            -parts.map(|(quantity, by)| by * quantity.by[nth]).sum::<f64>()
        };
        let slopes: Vec<f64> = (0..values.len()).map(slope).collect();
        if !found.value.is_finite() {
            return Err(format!("{} is {}", self.objective.in_words(&own), found.value));
        }
        if let Some(nth) = slopes.iter().position(|slope| !slope.is_finite()) {
            let name = &self.numbers.bounded()[nth].name;
            let (objective, slope) = (self.objective.in_words(&own), slopes[nth]);
            return Err(format!("{objective} has no slope by \"{name}\", which is {slope}"));
        }
        // A search makes small what it is given
        Ok(Evaluated { values: values.to_vec(), objective: -found.value, slopes })
    }

    /// The objective at values with what is held.
    fn with_held(&mut self, values: &[f64]) -> Result<Evaluated, String> {
        let mut found = self.objective(values)?;
        let held = self.held(values).map_err(|error| error.to_string())?;
        self.multipliers.add(&held, &mut found);
        Ok(found)
    }
}

impl Sought for OnOneMesh<'_> {
    fn evaluate(&mut self, values: &[f64]) -> Result<Evaluated, String> {
        let found = self.with_held(values);
        self.failure = found.as_ref().err().cloned();
        found
    }
}
