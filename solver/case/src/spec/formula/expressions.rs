//! `CaseExpression`: the expressions of a case that a flow and its scalars are sought with, each with its key.

use crate::{BoundaryCondition, Case, Formula, GaitSpec, ScalarSpec};

/// Where an expression is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExpressionPlace<'a> {
    /// On a side of the domain, by its name.
    Side(&'a str),
    /// On a body, by its name.
    Body(&'a str),
    /// On a body that slips, by its index, at places in its own frame.
    Slip(usize),
    /// In the fluid, whose integrals take no nodes.
    Within,
    /// At all nodes.
    AtNodes,
}

/// An expression of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseExpression<'a> {
    /// Its key.
    pub key: String,
    /// The expression, or a number.
    pub formula: &'a Formula,
    /// Where it is taken.
    pub at: ExpressionPlace<'a>,
    /// Whether it is taken at the start alone.
    pub is_initial: bool,
}

impl Case {
    /// All expressions of the flow: of sides, of the force in the fluid, of the start.
    #[must_use]
    pub fn flow_expressions(&self) -> Vec<CaseExpression<'_>> {
        let mut all = Vec::new();
        for (side, condition) in &self.boundary {
            let at = ExpressionPlace::Side(side);
            let key = |what: &str| format!("boundary.{side}.{what}.value");
            match condition {
                BoundaryCondition::Velocity { value, .. } => {
                    all.extend(components(&key("velocity"), value, at));
                }
                BoundaryCondition::Traction { value, .. } => {
                    all.extend(components(&key("traction"), value, at));
                }
                BoundaryCondition::Pressure { value, .. } => {
                    all.push(in_time(key("pressure"), value, at));
                }
                _ => {}
            }
        }
        all.extend(components("fluid.force", &self.fluid.force, ExpressionPlace::Within));
        if let Some(flow) = &self.initial {
            let at = ExpressionPlace::AtNodes;
            let given = components("initial.velocity", &flow.velocity, at);
            all.extend(given.map(|one| CaseExpression { is_initial: true, ..one }));
        }
        all
    }

    /// All expressions of a scalar, by its index.
    #[must_use]
    pub fn scalar_expressions(&self, index: usize) -> Vec<CaseExpression<'_>> {
        let Some(scalar) = self.scalar.get(index) else { return Vec::new() };
        let key = format!("scalar.{index}");
        let ScalarSpec { initial, source, boundary, body, .. } = scalar;
        let start = in_time(format!("{key}.initial"), initial, ExpressionPlace::AtNodes);
        let mut all = vec![CaseExpression { is_initial: true, ..start }];
        let source = source.iter();
        all.extend(
            source
                .map(|formula| in_time(format!("{key}.source"), formula, ExpressionPlace::Within)),
        );
        all.extend(boundary.iter().map(|(name, condition)| {
            let key = format!("{key}.boundary.{name}.{}", condition.key());
            in_time(key, condition.formula(), ExpressionPlace::Side(name))
        }));
        all.extend(body.iter().map(|(name, condition)| {
            let key = format!("{key}.body.{name}.{}", condition.key());
            in_time(key, condition.formula(), ExpressionPlace::Body(name))
        }));
        all
    }

    /// All expressions of slip along bodies.
    fn slip_expressions(&self) -> impl Iterator<Item = CaseExpression<'_>> {
        self.body.iter().enumerate().flat_map(|(index, body)| {
            let velocity = match &body.gait {
                Some(GaitSpec::Slip(gait)) => &gait.velocity[..],
                _ => &[],
            };
            let key = format!("body.{index}.gait.slip.velocity");
            let slip = components(&key, velocity, ExpressionPlace::Slip(index));
            slip.collect::<Vec<_>>()
        })
    }

    /// All expressions that a flow and its scalars are sought with.
    #[must_use]
    pub fn expressions(&self) -> Vec<CaseExpression<'_>> {
        let scalars = (0..self.scalar.len()).flat_map(|index| self.scalar_expressions(index));
        let flow = self.flow_expressions().into_iter();
        flow.chain(self.slip_expressions()).chain(scalars).collect()
    }
}

fn in_time<'a>(key: String, formula: &'a Formula, at: ExpressionPlace<'a>) -> CaseExpression<'a> {
    CaseExpression { key, formula, at, is_initial: false }
}

/// Those of the components of a vector.
fn components<'a>(
    key: &str,
    formulas: &'a [Formula],
    at: ExpressionPlace<'a>,
) -> impl Iterator<Item = CaseExpression<'a>> {
    let numbered = formulas.iter().enumerate();
    numbered.map(move |(axis, formula)| in_time(format!("{key}.{axis}"), formula, at))
}
