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

/// Ratio of something to its value from which on it is counted by its logarithm: what is far too small pulls as what is
/// far too large does. Below, where signs may differ, the logarithm goes on along its tangent.
const SMALLEST_RATIO: f64 = 1e-3;

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
    /// How far it is beyond the value: the logarithm of its ratio to that, so near it the part of it; below 0 within.
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
        let of_what = if *at == 0.0 { "" } else { " of it" };
        format!("  {name} {value:.6e} {verdict}: {bound} {at:.6e}, to {tolerance:.1e}{of_what}\n")
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
        self.rest(0.0) <= self.tolerance
    }

    /// How far the conditions of an optimum are from being met: what is off an equality, and of a limit the larger of what
    /// is beyond it and what a multiplier, over the weight, still pushes it within (@nocedal2006, chapter 17.4).
    fn rest(&self, pushed: f64) -> f64 {
        match self.bound {
            Bound::Equals => self.off.abs(),
            Bound::AtMost | Bound::AtLeast => self.off.max(-pushed).abs(),
        }
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
            let OfRatio { value: distance, by: slope } = distance(value, at);
            let side = if bound == Bound::AtLeast { -1.0 } else { 1.0 };
            Ok(Held {
                name: constraint.name(),
                value,
                bound,
                at,
                tolerance: constraint.tolerance,
                off: side * distance,
                slopes: by.iter().map(|by| side * slope * by).collect(),
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

    /// Whether all is where it should be, and nothing that is within its limit is still pushed.
    pub fn are_settled(&self, held: &[Held]) -> bool {
        held.iter().zip(self.rests(held)).all(|(own, rest)| rest <= own.tolerance)
    }

    /// How far each of what is held is from the conditions of an optimum.
    fn rests(&self, held: &[Held]) -> impl Iterator<Item = f64> {
        held.iter().zip(&self.values).map(|(own, multiplier)| own.rest(multiplier / self.weight))
    }

    /// Takes over what a round has come to.
    pub fn correct(&mut self, held: &[Held]) {
        let violation = self.rests(held).fold(0.0, f64::max);
        let forces = held.iter().zip(&self.values).map(|(own, value)| self.force(own, *value));
        self.values = forces.collect();
        if violation > LEFT * self.violation {
            self.weight *= GROWTH;
        }
        self.violation = violation;
    }
}

/// A function of one number, with its derivative.
struct OfRatio {
    value: f64,
    by: f64,
}

/// How far something is from the value it is held at, or within, and the derivative of that by it.
fn distance(value: f64, at: f64) -> OfRatio {
    if at == 0.0 {
        return OfRatio { value, by: 1.0 };
    }
    let ratio = value / at;
    let from = ratio.max(SMALLEST_RATIO);
    // Larger than a value below 0 is nearer to 0
    let side = at.signum();
    OfRatio { value: side * (from.ln() + (ratio - from) / from), by: side / (from * at) }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_grows_with_what_is_held_and_is_none_at_its_value() {
        for at in [3.0, 1e-3, -2.0, 0.0] {
            assert_eq!(distance(at, at).value, 0.0);
            let mut before = f64::NEG_INFINITY;
            for value in [-1e4, -5.0, -2.1, -2.0, -1e-4, 0.0, 1e-7, 1e-3, 2.9, 3.1, 4e3] {
                let OfRatio { value: found, by } = distance(value, at);
                assert!(found > before && found.is_finite() && by > 0.0, "{at} {value} {found}");
                before = found;
                let step = 1e-7 * value.abs().max(1e-7);
                let [less, more] = [-step, step].map(|step| distance(value + step, at).value);
                let slope = (more - less) / (2.0 * step);
                assert!((slope / by - 1.0).abs() < 1e-5, "{at} {value}: {slope} {by}");
            }
        }
        // Near its value the part of it, and a thousandth of it is as far as a thousand times it
        assert!((distance(3.003, 3.0).value - 1e-3).abs() < 1e-6);
        assert!((distance(0.003, 3.0).value + distance(3e3, 3.0).value).abs() < 1e-12);
    }

    #[test]
    fn what_is_within_its_limit_and_still_pushed_is_not_settled() {
        let constraint = FlowConstraint {
            quantity: Some("b.power".to_owned()),
            volume: None,
            equals: None,
            at_most: None,
            at_least: Some(2.0),
            tolerance: 1e-4,
        };
        let held = |value: f64| {
            let off = -distance(value, 2.0).value;
            let bound = Bound::AtLeast;
            let name = "b.power".to_owned();
            vec![Held { name, value, bound, at: 2.0, tolerance: 1e-4, off, slopes: vec![] }]
        };
        let mut multipliers = Multipliers::new(&[constraint], 1.0);
        assert!(multipliers.are_settled(&held(3.0)) && !multipliers.are_settled(&held(1.9)));
        multipliers.correct(&held(0.5));
        assert!(held(2.7)[0].is_met() && !multipliers.are_settled(&held(2.7)));
        assert!(multipliers.are_settled(&held(2.0)));
        // Its multiplier goes once it is far enough within
        multipliers.correct(&held(50.0));
        assert!(multipliers.are_settled(&held(2.7)));
    }
}
