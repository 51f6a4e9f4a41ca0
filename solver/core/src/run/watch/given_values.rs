//! Which expression of a case has no finite value where a flow is sought, by its key.

use alewife_mesh::{BoundaryKind, Mesh, Point};

use super::not_finite::NotFinite;
use crate::case::{BoundaryCondition, Case, Formula, ScalarSpec};
use crate::run::RunError;
use crate::run::simulation::Simulation;
use crate::step::FlowError;

/// Where an expression is taken.
#[derive(Clone, Copy)]
enum Where<'a> {
    /// On a side or a body, by its name.
    On(BoundaryKind, &'a str),
    /// In the fluid, whose integrals take no nodes.
    Within,
    /// At the nodes.
    AtNodes,
}

/// An expression of a case with its key.
struct Given<'a> {
    key: String,
    formula: &'a Formula,
    at: Where<'a>,
    /// Whether it is taken at the start alone.
    is_initial: bool,
}

impl<const D: usize> Simulation<D> {
    /// An error by the key of its case that is to blame, where an expression has no finite value.
    pub(in crate::run) fn by_key(&self, case: &Case, error: RunError) -> RunError {
        let (RunError::Flow(FlowError::Singular { step, time, .. })
        | RunError::Flow(FlowError::NotFinite { step, time, .. })) = error
        else {
            return error;
        };
        let found = not_finite(case, &self.state.mesh, step, time);
        found.map_or(error, |found| RunError::NotFinite { step, found: Box::new(found) })
    }
}

/// The first expression that is not finite on a mesh at a time (s) of a step.
fn not_finite<const D: usize>(
    case: &Case,
    mesh: &Mesh<D>,
    step: usize,
    time: f64,
) -> Option<NotFinite> {
    let all = given(case);
    let taken = all.iter().filter(|given| !given.is_initial || step <= 1);
    taken.filter_map(|given| given.first(case, mesh, time)).next()
}

impl Given<'_> {
    /// The first place where it is not finite.
    fn first<const D: usize>(&self, case: &Case, mesh: &Mesh<D>, time: f64) -> Option<NotFinite> {
        let parsed = self.formula.parsed(&case.define, D).ok()?;
        let time = if self.is_initial { 0.0 } else { time };
        let value = |place: &Point<D>| {
            let mut at = [0.0; 4];
            at[..D].copy_from_slice(place.as_slice());
            at[3] = time;
            parsed.at(&at)
        };
        let place = self.places(mesh).into_iter().find(|place| !value(place).is_finite())?;
        Some(NotFinite {
            key: self.key.clone(),
            written: self.formula.to_string(),
            value: value(&place),
            near: place.iter().copied().collect(),
            time,
        })
    }

    /// Where it is taken.
    fn places<const D: usize>(&self, mesh: &Mesh<D>) -> Vec<Point<D>> {
        match self.at {
            Where::AtNodes => mesh.nodes.to_vec(),
            Where::Within => {
                let middle = |cell| {
                    let corners = mesh.cell_vertices(cell).iter().map(|node| mesh.nodes[*node]);
                    corners.fold(Point::<D>::zeros(), |sum, one| sum + one) / (D + 1) as f64
                };
                mesh.cell_ids().map(middle).collect()
            }
            Where::On(kind, name) => {
                let is_it = |boundary: usize| {
                    let known = &mesh.boundaries[boundary];
                    let is_body = matches!(known.kind, BoundaryKind::Body(_));
                    known.name == name && is_body == matches!(kind, BoundaryKind::Body(_))
                };
                let own = mesh.facets.iter().filter(|facet| is_it(facet.boundary.index()));
                let nodes = own.flat_map(|facet| mesh.facet_nodes(facet));
                nodes.map(|node| mesh.nodes[node]).collect()
            }
        }
    }
}

/// All expressions of a case that a flow and its scalars are sought with.
fn given(case: &Case) -> Vec<Given<'_>> {
    let mut all = Vec::new();
    for (side, condition) in &case.boundary {
        let at = Where::On(BoundaryKind::Side, side);
        let (what, values) = match condition {
            BoundaryCondition::Velocity { value, .. } => ("velocity", &value[..]),
            BoundaryCondition::Traction { value, .. } => ("traction", &value[..]),
            BoundaryCondition::Pressure { value, .. } => {
                let key = format!("boundary.{side}.pressure.value");
                all.push(Given { key, formula: value, at, is_initial: false });
                continue;
            }
            _ => continue,
        };
        all.extend(components(&format!("boundary.{side}.{what}.value"), values, at));
    }
    all.extend(components("fluid.force", &case.fluid.force, Where::Within));
    let initial = case
        .initial
        .iter()
        .flat_map(|flow| components("initial.velocity", &flow.velocity, Where::AtNodes));
    all.extend(initial.map(|given| Given { is_initial: true, ..given }));
    for (nth, scalar) in case.scalar.iter().enumerate() {
        all.extend(of_scalar(&format!("scalar.{nth}"), scalar));
    }
    all
}

fn components<'a>(
    key: &str,
    formulas: &'a [Formula],
    at: Where<'a>,
) -> impl Iterator<Item = Given<'a>> {
    let given = |(axis, formula): (usize, &'a Formula)| Given {
        key: format!("{key}.{axis}"),
        formula,
        at,
        is_initial: false,
    };
    formulas.iter().enumerate().map(given).collect::<Vec<_>>().into_iter()
}

/// Those of a scalar.
fn of_scalar<'a>(key: &str, scalar: &'a ScalarSpec) -> Vec<Given<'a>> {
    let one = |key: String, formula: &'a Formula, at: Where<'a>| Given {
        key,
        formula,
        at,
        is_initial: false,
    };
    let initial = one(format!("{key}.initial"), &scalar.initial, Where::AtNodes);
    let mut all = vec![Given { is_initial: true, ..initial }];
    let source = scalar.source.iter();
    all.extend(source.map(|formula| one(format!("{key}.source"), formula, Where::Within)));
    let places = [
        ("boundary", BoundaryKind::Side, &scalar.boundary),
        ("body", BoundaryKind::Body(0), &scalar.body),
    ];
    for (table, kind, conditions) in places {
        all.extend(conditions.iter().map(|(name, condition)| {
            let key = format!("{key}.{table}.{name}.{}", condition.key());
            one(key, condition.formula(), Where::On(kind, name))
        }));
    }
    all
}
