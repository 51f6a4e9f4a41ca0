//! Which sides of a domain are reported in `series.csv`.

use crate::{BoundaryCondition, Model};

/// A side with quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReportedSide<'a> {
    /// Its number among the sides of the case.
    pub number: usize,
    /// Its name.
    pub name: &'a str,
}

/// Sides with quantities, each with its number in [`Case::sides`](crate::Case::sides).
///
/// All of them where `output.sides` says so, or by itself where there are no bodies or the domain is a given mesh; of
/// other cases those that a reference names. The axis and periodic sides have none, nor has a side whose name is
/// that of a body.
pub fn reported_sides(model: &Model) -> Vec<ReportedSide<'_>> {
    let case = &model.case;
    let by_default = model.bodies.is_empty() || case.given_mesh().is_some();
    let are_all = case.output.sides.unwrap_or(by_default);
    let is_named = |side: &str| {
        let quantities = case.reference.iter().flat_map(|reference| {
            let taken = &reference.statistic;
            [Some(&taken.quantity), taken.minus.as_ref(), taken.of.as_ref()]
        });
        let mut quantities = quantities.flatten().chain(&case.statistics.phase_of);
        quantities.any(|name| name.split_once('.').is_some_and(|(owner, _)| owner == side))
    };
    let is_reported = |side: &str| {
        let has_load = !matches!(
            case.boundary.get(side),
            Some(BoundaryCondition::Periodic(_) | BoundaryCondition::Axis)
        );
        has_load
            && !is_other_end(model, side)
            && side != "axis"
            && model.body_index(side).is_none()
            && (are_all || is_named(side))
    };
    let sides = case.sides().into_iter().enumerate();
    let sides = sides.map(|(number, name)| ReportedSide { number, name });
    sides.filter(|side| is_reported(side.name)).collect()
}

/// Whether another side is periodic with this one, which may say nothing then.
fn is_other_end(model: &Model, side: &str) -> bool {
    let conditions = model.case.boundary.values();
    let mut partners = conditions.filter_map(|condition| match condition {
        BoundaryCondition::Periodic(partner) => Some(partner),
        _ => None,
    });
    partners.any(|partner| partner == side)
}
