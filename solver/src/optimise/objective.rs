//! `Objective`: what a search makes large, from the quantities of a flow, and its derivatives by them.

use crate::case::{CaseError, Definitions, FlowObjective, Formula};

/// What a search makes large.
#[derive(Debug, Clone, PartialEq)]
pub struct Objective {
    spec: FlowObjective,
    define: Definitions,
    /// The quantities it is made of, each once.
    pub quantities: Vec<String>,
}

/// An objective with its derivatives by the quantities.
#[derive(Debug, Clone, PartialEq)]
pub struct Objectively {
    /// The objective.
    pub value: f64,
    /// By each quantity.
    pub by: Vec<f64>,
}

/// Part of the size of a quantity by which it is changed.
const STEP: f64 = 1e-5;

impl Objective {
    /// That of a case that defines these numbers; of further quantities it does not depend.
    pub fn new(spec: &FlowObjective, define: &Definitions, further: &[String]) -> Self {
        let mut quantities: Vec<String> = Vec::new();
        let own = spec.quantities().into_iter().map(|part| part.quantity.to_owned());
        for quantity in own.chain(further.iter().cloned()) {
            if !quantities.contains(&quantity) {
                quantities.push(quantity);
            }
        }
        Self { spec: spec.clone(), define: define.clone(), quantities }
    }

    /// Its value for quantities of these values and sizes, and its derivatives by them.
    pub fn at(&self, values: &[f64], sizes: &[f64]) -> Result<Objectively, CaseError> {
        let FlowObjective::Expression(_) = self.spec else {
            let by = self.weights();
            let value = by.iter().zip(values).map(|(weight, value)| weight * value).sum();
            return Ok(Objectively { value, by });
        };
        let slope = |nth: usize| {
            let size = sizes[nth].max(values[nth].abs());
            let step = STEP * if size > 0.0 { size } else { 1.0 };
            let with = |change: f64| {
                let mut values = values.to_vec();
                values[nth] += change;
                self.expression(&values)
            };
            Ok((with(step)? - with(-step)?) / (2.0 * step))
        };
        let by: Result<Vec<f64>, CaseError> = (0..values.len()).map(slope).collect();
        Ok(Objectively { value: self.expression(values)?, by: by? })
    }

    /// What it is made of, with the quantities it has at these values.
    pub fn in_words(&self, values: &[f64]) -> String {
        let of = |quantity: &String| {
            let own = self.quantities.iter().position(|one| one == quantity);
            own.map_or(f64::NAN, |own| values[own])
        };
        match &self.spec {
            FlowObjective::Expression(expression) => {
                let each = expression.quantities.iter();
                let each = each.map(|(name, one)| format!("{name} = {one} = {:.3e}", of(one)));
                let each: Vec<String> = each.collect();
                format!("the objective \"{}\", with {},", expression.value, each.join(", "))
            }
            _ => {
                let each = self.quantities.iter().map(|one| format!("{one} = {:.3e}", of(one)));
                format!("the objective, of {},", each.collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// What each quantity counts in a sum.
    fn weights(&self) -> Vec<f64> {
        let parts = self.spec.quantities();
        let of = |quantity: &String| {
            let own = parts.iter().filter(|part| part.quantity == quantity);
            own.map(|part| part.weight).sum()
        };
        self.quantities.iter().map(of).collect()
    }

    /// The value of an expression.
    fn expression(&self, values: &[f64]) -> Result<f64, CaseError> {
        let FlowObjective::Expression(expression) = &self.spec else { return Ok(f64::NAN) };
        let mut known = self.define.clone();
        for (name, quantity) in &expression.quantities {
            let own = self.quantities.iter().position(|one| one == quantity);
            known.insert(name.clone(), own.map_or(f64::NAN, |own| values[own]));
        }
        let formula = Formula::Expression(expression.value.clone());
        let parsed = formula.parsed(&known, 2);
        Ok(parsed.map_or(f64::NAN, |parsed| parsed.at(&[0.0; 4])))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::case::{ObjectiveExpression, WeightedQuantity};

    #[test]
    fn sums_and_expressions_have_their_derivatives() {
        let term = |quantity: &str, weight: f64| WeightedQuantity {
            quantity: quantity.to_owned(),
            weight,
        };
        let define = Definitions::from([("k".to_owned(), 3.0)]);
        let sum = FlowObjective::Sum(vec![
            term("a.power", -2.0),
            term("b.power", 1.0),
            term("a.power", 0.5),
        ]);
        let found = Objective::new(&sum, &define, &[]).at(&[4.0, 5.0], &[1.0, 1.0]).unwrap();
        assert_eq!(found, Objectively { value: -1.0, by: vec![-1.5, 1.0] });
        let quantities = [("u", "a.velocity.x"), ("p", "a.power"), ("w", "a.velocity.x")];
        let expression = FlowObjective::Expression(ObjectiveExpression {
            value: "k * u * w / p".to_owned(),
            quantities: quantities
                .map(|(a, b)| (a.to_owned(), b.to_owned()))
                .into_iter()
                .collect::<BTreeMap<_, _>>(),
        });
        let objective = Objective::new(&expression, &define, &["a.power".to_owned()]);
        assert_eq!(objective.quantities, ["a.power", "a.velocity.x"]);
        let found = objective.at(&[2.0, 4.0], &[2.0, 4.0]).unwrap();
        assert_eq!(found.value, 24.0);
        assert!(
            (found.by[0] + 12.0).abs() < 1e-8 && (found.by[1] - 12.0).abs() < 1e-8,
            "{found:?}"
        );
        assert_eq!(
            objective.in_words(&[0.0, 4.0]),
            "the objective \"k * u * w / p\", with p = a.power = 0.000e0, u = a.velocity.x = 4.000e0, \
             w = a.velocity.x = 4.000e0,"
        );
    }
}
