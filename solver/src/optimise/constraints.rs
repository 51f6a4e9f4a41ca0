//! `Multipliers`: what a search holds, by an augmented Lagrangian: multipliers that each round corrects.

use alewife_reduced::search::Evaluated;
use serde_json::{Value, json};

use super::numbers::Numbers;
use crate::case::{Bound, CaseError, CaseFile, FlowConstraint, Limit};
use crate::gradient::Derivatives;

/// Weight of the squares of what is off, over the size of the objective: a hundredth off costs a two-thousandth of it.
const WEIGHT: f64 = 10.0;

/// Part of what was off before that may be left after a round: where it is more, the weight grows by [`GROWTH`]
/// (@nocedal2006, chapter 17.4).
const LEFT: f64 = 0.25;

/// Factor by which the weight grows.
const GROWTH: f64 = 4.0;

/// Part of the size of a number by which it is changed, for the change of a volume.
const STEP: f64 = 1e-4;

/// What is held, at values of the numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Held {
    /// What it is called.
    pub name: String,
    /// What it is.
    pub value: f64,
    /// Where it should be.
    pub bound: Bound,
    /// The value it is held at, or within.
    pub at: f64,
    /// How far it may be off, over the size of its value.
    pub tolerance: f64,
    /// How far it is beyond the value, over its size; below 0 within.
    pub off: f64,
    /// The derivatives of that by the numbers.
    slopes: Vec<f64>,
}

impl Held {
    /// In a line.
    #[must_use]
    pub fn line(&self) -> String {
        let Self { name, value, at, tolerance, .. } = self;
        let verdict = if self.is_met() { "met" } else { "NOT met" };
        let bound = self.bound.name();
        format!("  {name} {value:.6e} {verdict}: {bound} {at:.6e}, to {tolerance:.1e} of it\n")
    }

    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "name": self.name,
            "value": self.value,
            self.bound.name(): self.at,
            "tolerance": self.tolerance,
            "met": self.is_met(),
        })
    }

    /// Whether it is where it should be, to its tolerance.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.violation() <= self.tolerance
    }

    /// How far it is off.
    fn violation(&self) -> f64 {
        if self.bound == Bound::Equals { self.off.abs() } else { self.off.max(0.0) }
    }
}

/// What a search holds, with the multiplier of each.
#[derive(Debug, Clone, PartialEq)]
pub struct Multipliers {
    constraints: Vec<FlowConstraint>,
    values: Vec<f64>,
    weight: f64,
    /// The largest violation so far.
    violation: f64,
}

impl Multipliers {
    /// Of a search that has not begun, and whose objective has this size.
    pub fn new(constraints: &[FlowConstraint], size: f64) -> Self {
        let size = if size > 0.0 { size } else { 1.0 };
        Self {
            values: vec![0.0; constraints.len()],
            constraints: constraints.to_vec(),
            weight: WEIGHT * size,
            violation: f64::INFINITY,
        }
    }

    /// Quantities of the flow that are held.
    pub fn quantities(constraints: &[FlowConstraint]) -> Vec<String> {
        constraints.iter().filter_map(|one| one.quantity.clone()).collect()
    }

    /// What is held, at values, where the quantities of the flow are these.
    pub fn held(
        &self,
        numbers: &Numbers,
        values: &[f64],
        quantities: &[Derivatives],
    ) -> Result<Vec<Held>, CaseError> {
        let one = |constraint: &FlowConstraint| {
            let own = quantities.iter().find(|own| Some(&own.of) == constraint.quantity.as_ref());
            let WithSlopes { value, by } = match (own, &constraint.volume) {
                (Some(own), _) => WithSlopes { value: own.value, by: own.by.clone() },
                (None, Some(body)) => volume(numbers, values, body)?,
                (None, None) => WithSlopes { value: f64::NAN, by: vec![f64::NAN; values.len()] },
            };
            // `check` refuses one without a value
            let none = Limit { bound: Bound::Equals, value: f64::NAN };
            let Limit { bound, value: at } = constraint.limit().unwrap_or(none);
            let size = if at == 0.0 { 1.0 } else { at.abs() };
            let beyond = if bound == Bound::AtLeast { -1.0 } else { 1.0 } / size;
            Ok(Held {
                name: constraint.name(),
                value,
                bound,
                at,
                tolerance: constraint.tolerance,
                off: beyond * (value - at),
                slopes: by.iter().map(|by| beyond * by).collect(),
            })
        };
        self.constraints.iter().map(one).collect()
    }

    /// Adds to an objective what it costs to be off, and its derivatives.
    pub fn add(&self, held: &[Held], to: &mut Evaluated) {
        for (own, multiplier) in held.iter().zip(&self.values) {
            let force = self.force(own, *multiplier);
            to.objective += (force * force - multiplier * multiplier) / (2.0 * self.weight);
            let slopes = to.slopes.iter_mut().zip(&own.slopes);
            slopes.for_each(|(sum, slope)| *sum += force * slope);
        }
    }

    /// The multiplier that what is off asks for: that of the next round.
    fn force(&self, own: &Held, multiplier: f64) -> f64 {
        let force = multiplier + self.weight * own.off;
        if own.bound == Bound::Equals { force } else { force.max(0.0) }
    }

    /// Takes over what a round has come to.
    pub fn correct(&mut self, held: &[Held]) {
        let forces = held.iter().zip(&self.values).map(|(own, value)| self.force(own, *value));
        self.values = forces.collect();
        let violation = held.iter().map(Held::violation).fold(0.0, f64::max);
        if violation > LEFT * self.violation {
            self.weight *= GROWTH;
        }
        self.violation = violation;
    }
}

/// A number with its derivatives.
struct WithSlopes {
    value: f64,
    by: Vec<f64>,
}

/// The volume of a body, and its derivatives by the numbers.
fn volume(numbers: &Numbers, values: &[f64], body: &str) -> Result<WithSlopes, CaseError> {
    let at = |values: &[f64]| numbers.case(values).map(|file| volume_in(&file, body));
    let mut by = Vec::new();
    for (nth, size) in numbers.sizes(values).into_iter().enumerate() {
        let step = STEP * size;
        let changed = |change: f64| {
            let mut values = values.to_vec();
            values[nth] += change;
            at(&values)
        };
        by.push((changed(step)? - changed(-step)?) / (2.0 * step));
    }
    Ok(WithSlopes { value: at(values)?, by })
}

fn volume_in(file: &CaseFile, name: &str) -> f64 {
    let body = file.model.bodies.iter().find(|body| body.name == name);
    body.map_or(f64::NAN, |body| body.shape.volume_in(file.case().geometry))
}
