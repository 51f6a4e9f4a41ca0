//! Which expression of a case has no finite value where a flow is sought, by its key.

use alewife_mesh::{BoundaryKind, Mesh, Point};
use nalgebra::Vector3;

use super::not_finite::NotFinite;
use crate::body::{MeshPoses, in_space};
use crate::case::{Case, CaseExpression, ExpressionPlace};
use crate::coupling::RigidBody;
use crate::run::RunError;
use crate::run::simulation::Simulation;
use crate::step::FlowError;

impl<const D: usize> Simulation<D> {
    /// An error by the key of its case that is to blame, where an expression has no finite value.
    pub(in crate::run) fn by_key(&self, case: &Case, error: RunError) -> RunError {
        by_key(case, &self.places(), error)
    }

    /// Refuses an expression that is not finite at a time (s) and has been at one before, as no step has needed it yet.
    pub(in crate::run) fn check_later(
        &self,
        case: &Case,
        [before, after]: [f64; 2],
    ) -> Result<(), RunError> {
        let (places, all) = (self.places(), case.expressions());
        let in_time = all.iter().filter(|given| !given.is_initial);
        let mut finite = in_time.filter(|given| first(given, case, &places, before).is_none());
        let found = finite.find_map(|given| first(given, case, &places, after));
        found.map_or(Ok(()), |found| Err(RunError::NotFinite { step: 1, found: Box::new(found) }))
    }

    /// Where expressions are taken at present.
    fn places(&self) -> Places<'_, D> {
        let poses = self.state.in_mesh(&self.state.poses);
        Places { mesh: &self.state.mesh, bodies: &self.problem.bodies, poses }
    }
}

/// Where expressions are taken: a mesh, with the bodies in it.
pub struct Places<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// The bodies, those of the case first.
    pub bodies: &'a [RigidBody],
    /// Their poses in the mesh.
    pub poses: MeshPoses,
}

/// An error of a flow on a mesh by the key of its case that is to blame, where an expression has no finite value.
pub fn by_key<const D: usize>(case: &Case, places: &Places<'_, D>, error: RunError) -> RunError {
    let (RunError::Flow(FlowError::Singular { step, time, .. })
    | RunError::Flow(FlowError::NotFinite { step, time, .. })) = error
    else {
        return error;
    };
    let found = not_finite(case, places, step, time);
    found.map_or(error, |found| RunError::NotFinite { step, found: Box::new(found) })
}

/// The first expression that is not finite on a mesh at a time (s) of a step.
fn not_finite<const D: usize>(
    case: &Case,
    places: &Places<'_, D>,
    step: usize,
    time: f64,
) -> Option<NotFinite> {
    let all = case.expressions();
    let taken = all.iter().filter(|given| !given.is_initial || step <= 1);
    taken.filter_map(|given| first(given, case, places, time)).next()
}

/// The first place where an expression is not finite.
fn first<const D: usize>(
    given: &CaseExpression<'_>,
    case: &Case,
    places: &Places<'_, D>,
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
    let place = places.of(given.at, case).into_iter().find(|place| !value(place).is_finite())?;
    Some(NotFinite {
        key: given.key.clone(),
        written: given.formula.to_string(),
        value: value(&place),
        near: place.iter().copied().collect(),
        is_of_body: matches!(given.at, ExpressionPlace::Slip(_)),
        time,
    })
}

impl<const D: usize> Places<'_, D> {
    /// Where an expression is taken (m).
    fn of(&self, at: ExpressionPlace<'_>, case: &Case) -> Vec<Point<D>> {
        let mesh = self.mesh;
        match at {
            ExpressionPlace::AtNodes => mesh.nodes.to_vec(),
            ExpressionPlace::Within => {
                let middle = |cell| {
                    let corners = mesh.cell_vertices(cell).iter().map(|node| mesh.nodes[*node]);
                    corners.fold(Point::<D>::zeros(), |sum, one| sum + one) / (D + 1) as f64
                };
                mesh.cell_ids().map(middle).collect()
            }
            ExpressionPlace::Side(name) => self.on(name, false),
            ExpressionPlace::Body(name) => self.on(name, true),
            ExpressionPlace::Slip(index) => self.along(index, case),
        }
    }

    /// The nodes on a side or a body.
    fn on(&self, name: &str, of_body: bool) -> Vec<Point<D>> {
        let mesh = self.mesh;
        let is_it = |boundary: usize| {
            let known = &mesh.boundaries[boundary];
            known.name == name && matches!(known.kind, BoundaryKind::Body(_)) == of_body
        };
        let own = mesh.facets.iter().filter(|facet| is_it(facet.boundary.index()));
        let nodes = own.flat_map(|facet| mesh.facet_nodes(facet));
        nodes.map(|node| mesh.nodes[node]).collect()
    }

    /// The nodes on a body of the case, from the origin of its shape and in its frame.
    fn along(&self, index: usize, case: &Case) -> Vec<Point<D>> {
        let (Some(body), Some(rigid), Some(pose)) =
            (case.body.get(index), self.bodies.get(index), self.poses.get(index))
        else {
            return Vec::new();
        };
        let mut origin = Vector3::zeros();
        for (own, given) in origin.iter_mut().zip(&body.center) {
            *own = *given;
        }
        let origin = rigid.pose.to_body(&(origin - rigid.pose.center));
        let own = |place: Point<D>| {
            let seen = pose.to_body(&(in_space(&place) - pose.center)) - origin;
            Point::<D>::from_fn(|axis, _| seen[axis])
        };
        self.on(&body.name, true).into_iter().map(own).collect()
    }
}
