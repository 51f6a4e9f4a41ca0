//! Which expression of a case has no finite value where a flow is sought, by its key.

use alewife_mesh::{BoundaryKind, Mesh, Point};

use super::not_finite::NotFinite;
use crate::case::{Case, CaseExpression, ExpressionPlace};
use crate::run::RunError;
use crate::run::simulation::Simulation;
use crate::step::FlowError;

impl<const D: usize> Simulation<D> {
    /// An error by the key of its case that is to blame, where an expression has no finite value.
    pub(in crate::run) fn by_key(&self, case: &Case, error: RunError) -> RunError {
        by_key(case, &self.state.mesh, error)
    }

    /// Refuses an expression that is not finite at a time (s) and has been at one before, as no step has needed it yet.
    pub(in crate::run) fn check_later(
        &self,
        case: &Case,
        [before, after]: [f64; 2],
    ) -> Result<(), RunError> {
        let (mesh, all) = (&self.state.mesh, case.expressions());
        let in_time = all.iter().filter(|given| !given.is_initial);
        let mut finite = in_time.filter(|given| first(given, case, mesh, before).is_none());
        let found = finite.find_map(|given| first(given, case, mesh, after));
        found.map_or(Ok(()), |found| Err(RunError::NotFinite { step: 1, found: Box::new(found) }))
    }
}

/// An error of a flow on a mesh by the key of its case that is to blame, where an expression has no finite value.
pub fn by_key<const D: usize>(case: &Case, mesh: &Mesh<D>, error: RunError) -> RunError {
    let (RunError::Flow(FlowError::Singular { step, time, .. })
    | RunError::Flow(FlowError::NotFinite { step, time, .. })) = error
    else {
        return error;
    };
    let found = not_finite(case, mesh, step, time);
    found.map_or(error, |found| RunError::NotFinite { step, found: Box::new(found) })
}

/// The first expression that is not finite on a mesh at a time (s) of a step.
fn not_finite<const D: usize>(
    case: &Case,
    mesh: &Mesh<D>,
    step: usize,
    time: f64,
) -> Option<NotFinite> {
    let all = case.expressions();
    let taken = all.iter().filter(|given| !given.is_initial || step <= 1);
    taken.filter_map(|given| first(given, case, mesh, time)).next()
}

/// The first place where an expression is not finite.
fn first<const D: usize>(
    given: &CaseExpression<'_>,
    case: &Case,
    mesh: &Mesh<D>,
    time: f64,
) -> Option<NotFinite> {
    let parsed = given.formula.parsed(&case.define, D).ok()?;
    let time = if given.is_initial { 0.0 } else { time };
    let value = |place: &Point<D>| {
        let mut at = [0.0; 4];
        at[..D].copy_from_slice(place.as_slice());
        at[3] = time;
        parsed.at(&at)
    };
    let place = places(given.at, mesh).into_iter().find(|place| !value(place).is_finite())?;
    Some(NotFinite {
        key: given.key.clone(),
        written: given.formula.to_string(),
        value: value(&place),
        near: place.iter().copied().collect(),
        time,
    })
}

/// Where an expression is taken.
fn places<const D: usize>(at: ExpressionPlace<'_>, mesh: &Mesh<D>) -> Vec<Point<D>> {
    let on = |name: &str, of_body: bool| {
        let is_it = |boundary: usize| {
            let known = &mesh.boundaries[boundary];
            known.name == name && matches!(known.kind, BoundaryKind::Body(_)) == of_body
        };
        let own = mesh.facets.iter().filter(|facet| is_it(facet.boundary.index()));
        let nodes = own.flat_map(|facet| mesh.facet_nodes(facet));
        nodes.map(|node| mesh.nodes[node]).collect()
    };
    match at {
        ExpressionPlace::AtNodes => mesh.nodes.to_vec(),
        ExpressionPlace::Within => {
            let middle = |cell| {
                let corners = mesh.cell_vertices(cell).iter().map(|node| mesh.nodes[*node]);
                corners.fold(Point::<D>::zeros(), |sum, one| sum + one) / (D + 1) as f64
            };
            mesh.cell_ids().map(middle).collect()
        }
        ExpressionPlace::Side(name) => on(name, false),
        ExpressionPlace::Body(name) => on(name, true),
    }
}
