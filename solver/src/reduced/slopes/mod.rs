//! `MotionByNumbers`: quantities at the end of a reduced motion, and their derivatives by numbers of its case.
//!
//! A motion is made over dual numbers, so that its derivatives are exact for the steps that are made. What a number of
//! the case changes in the model is found from the model at values beside it, by differences of fourth order.

mod error;
mod near;

use alewife_reduced::tree::Dual64;

pub use self::error::SlopeError;
use self::error::unsteady;
use self::near::Near;
use super::ReducedError;
use super::build::Reduced;
use super::measure::{Moving, Value, bodies_in};
use super::mover::Mover;
use super::simulate::step_ends;
use super::swimmer::Swimming;
use crate::case::{BodyQuantity, Column, Model, Source, Unsteady, differentiable_columns};
use crate::gradient::{Derivatives, NumberedCase};

/// Quantities of reduced motions.
#[derive(Debug, Clone, Copy)]
pub struct MotionByNumbers;

impl MotionByNumbers {
    /// The quantities at values of the numbers, and their derivatives by them.
    ///
    /// # Errors
    /// [`SlopeError`]: there is no such case or motion, or a number changes what has no derivative.
    pub fn at(
        self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, SlopeError> {
        let file = (numbered.case)(values)?;
        let model = &file.model;
        let all = differentiable_columns(model);
        let columns: Vec<&Column> = numbered
            .of
            .iter()
            .filter_map(|name| all.iter().find(|column| column.name == *name))
            .collect();
        let reduced = Reduced::new(model)?;
        let time = unsteady(model)?;
        let mut found: Vec<Derivatives> = Vec::new();
        for (nth, size) in numbered.sizes.iter().enumerate() {
            let near = Near::new(&reduced, model, nth, *size, &|change| {
                let mut values = values.to_vec();
                values[nth] += change;
                (numbered.case)(&values)
            })?;
            let made = moved(&near, model, time, &columns)?;
            if found.is_empty() {
                let first = columns.iter().zip(&made).map(|(column, value)| Derivatives {
                    of: column.name.clone(),
                    value: value.re,
                    size: value.re.abs(),
                    by: Vec::new(),
                    differences: Vec::new(),
                });
                found.extend(first);
            }
            found.iter_mut().zip(&made).for_each(|(one, value)| one.by.push(value.eps));
        }
        Ok(found)
    }
}

/// Quantities at the end of a motion.
fn moved(
    near: &Near<'_>,
    model: &Model,
    time: &Unsteady,
    columns: &[&Column],
) -> Result<Vec<Dual64>, ReducedError> {
    let reduced = near.at;
    let mut state = near.start();
    let asked = |time: f64, link: usize| near.command(time, link);
    let pace = near.pace();
    let tree = near.tree()?;
    let mut mover = Mover::asked(reduced, tree, &mut state, Some(&asked), pace)?;
    let swimmers = model.swimmers.iter().enumerate();
    let mut swimmers: Vec<Swimming<Dual64>> =
        swimmers.map(|(nth, one)| Swimming::with_period(one, near.period(nth))).collect();
    let mut bodies: Vec<Moving<Dual64>> = Vec::new();
    for end in std::iter::once(0.0).chain(step_ends(time)) {
        let step = end - state.time;
        if step > 0.0 {
            mover.step(reduced, &mut state, end)?;
        }
        bodies = bodies_in(reduced, mover.tree(), &state, &bodies, pace * step);
        for swimmer in &mut swimmers {
            swimmer.observe(reduced, &bodies, pace * state.time);
        }
    }
    let value = |column: &&Column| {
        let value = match column.source {
            Source::Body(body, BodyQuantity::Position) => {
                Some(Value::Vector(bodies[body].pose.position))
            }
            Source::Body(body, BodyQuantity::Angle) => Some(Value::Scalar(bodies[body].angle)),
            Source::Swimmer(nth, quantity) => swimmers[nth].at_the_end(quantity),
            _ => None,
        };
        let value = value.map(|value| value.component(column.component));
        value.filter(|value| value.re.is_finite()).ok_or_else(|| {
            ReducedError::Unknown(format!("`{}` at the end of the motion", column.name))
        })
    };
    columns.iter().map(value).collect()
}
