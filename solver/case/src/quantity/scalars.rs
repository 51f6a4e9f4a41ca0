//! The columns of scalars: of each, on bodies and sides, at probes.

use super::table::{ScalarProbeQuantity, ScalarQuantity, ScalarSurfaceQuantity};
use super::{Column, Condition, Source, add};
use crate::{BoundaryCondition, Model};

/// A surface through which a scalar comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScalarSurface {
    /// Of a body, by its number in [`Model::bodies`].
    Body(usize),
    /// A side, by its number in [`Case::sides`](crate::Case::sides).
    Side(usize),
}

/// Adds the columns of all scalars.
pub fn add_scalars(columns: &mut Vec<Column>, model: &Model, of_case: &[Condition]) {
    let case = &model.case;
    for (nth, scalar) in case.scalar.iter().enumerate() {
        let owner = format!("scalar.{}", scalar.name);
        let source = |quantity| Source::Scalar(nth, quantity);
        add(columns, &owner, ScalarQuantity::TABLE, of_case, source);
        let difference = Condition::Difference.holding_if(scalar.difference.is_some());
        let on_bodies: Vec<Condition> = of_case.iter().copied().chain(difference).collect();
        for (body, known) in model.bodies.iter().enumerate() {
            let source = |quantity| Source::ScalarSurface(nth, ScalarSurface::Body(body), quantity);
            let owner = format!("{owner}.{}", known.name);
            add(columns, &owner, ScalarSurfaceQuantity::TABLE, &on_bodies, source);
        }
        let sides = case.sides().into_iter().enumerate();
        for (side, name) in sides.filter(|(_, name)| is_crossed(model, name)) {
            let source = |quantity| Source::ScalarSurface(nth, ScalarSurface::Side(side), quantity);
            let owner = format!("{owner}.{name}");
            add(columns, &owner, ScalarSurfaceQuantity::TABLE, of_case, source);
        }
        for (probe, known) in case.probe.iter().enumerate() {
            let source = |quantity| Source::ScalarProbe(nth, probe, quantity);
            let owner = format!("{owner}.{}", known.name);
            add(columns, &owner, ScalarProbeQuantity::TABLE, of_case, source);
        }
    }
}

/// Whether something may come through a side, which is neither the axis, nor periodic, nor of a body.
fn is_crossed(model: &Model, side: &str) -> bool {
    let conditions = &model.case.boundary;
    let is_joined = conditions.iter().any(|(name, condition)| match condition {
        BoundaryCondition::Periodic(partner) => name == side || partner == side,
        BoundaryCondition::Axis => name == side,
        _ => false,
    });
    !is_joined && side != "axis" && model.body_index(side).is_none()
}
