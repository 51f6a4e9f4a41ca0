//! `Scalars`: the scalars of a case, from `[[scalar]]` to their solution in each step of a run.

use alewife_mesh::{BoundaryKind, Mesh, Point};

use super::formulas::number;
use crate::algebra::LinearError;
use crate::body::on_mesh;
use crate::case::{Case, Model, ScalarCondition, ScalarSpec};
use crate::coupling::Problem;
use crate::run::RunError;
use crate::scalar::{Carrier, Condition, Equation, Level, Scalar, ScalarField, Step, amount};
use crate::space::{Metric, Tables};
use crate::state::{NewLevel, State};
use crate::time::Bdf;

/// What the flow carries and what diffuses in it, with what solves for it on the present mesh.
pub struct Scalars<const D: usize> {
    given: Vec<Scalar<D>>,
    /// Made when they are needed first on a mesh.
    equations: Vec<Option<Equation<D>>>,
    metric: Metric,
}

impl<const D: usize> Scalars<D> {
    /// Those of a case on its mesh; none where it has no scalars.
    ///
    /// # Errors
    /// When an expression is not understood, or there is nothing to make a diffusivity of.
    pub(in crate::run) fn of(
        model: &Model,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
    ) -> Result<Option<Self>, RunError> {
        if model.case.scalar.is_empty() {
            return Ok(None);
        }
        let given: Result<Vec<Scalar<D>>, RunError> =
            model.case.scalar.iter().map(|spec| scalar(model, mesh, spec)).collect();
        let given = given?;
        let equations = given.iter().map(|_| None).collect();
        Ok(Some(Self { given, equations, metric: problem.metric }))
    }

    /// What is given of each.
    pub(in crate::run) fn given(&self) -> &[Scalar<D>] {
        &self.given
    }

    /// The metric of their integrals.
    pub(in crate::run) fn metric(&self) -> Metric {
        self.metric
    }

    /// Forgets what belongs to a mesh that was replaced.
    pub(in crate::run) fn forget_mesh(&mut self) {
        self.equations.iter_mut().for_each(|equation| *equation = None);
    }

    /// What there is of each at the start.
    pub(in crate::run) fn at_start(&self, state: &State<D>) -> Vec<ScalarField> {
        let tables = Tables::new(self.metric);
        let field = |scalar: &Scalar<D>| {
            let mesh = &state.mesh;
            let values: Vec<f64> =
                mesh.nodes.iter().map(|place| (scalar.initial)(place, state.time)).collect();
            let total = amount(mesh, &tables, &values).total;
            ScalarField::at_start(values, total, mesh.boundaries.len())
        };
        self.given.iter().map(field).collect()
    }

    /// What a step from a state to a level leads to, linear in the values: one solution each.
    ///
    /// # Errors
    /// When a system has no solution.
    pub(in crate::run) fn advance(
        &mut self,
        problem: &Problem<D>,
        state: &State<D>,
        level: &NewLevel<D>,
        bdf: &Bdf,
    ) -> Result<Vec<Level>, LinearError> {
        let origin = on_mesh::<D>(&state.origin_at(problem, &level.poses));
        let nodes: Vec<Point<D>> = level.nodes.iter().map(|node| node + origin).collect();
        let origin = on_mesh::<D>(&state.origin_at(problem, &state.previous_poses));
        let older = state.mesh.nodes.iter().zip(&state.nodes_before);
        let velocities = nodes.iter().zip(older).zip(&level.solution.velocity);
        let carrying: Vec<Point<D>> = velocities
            .map(|((next, (now, before)), velocity)| {
                velocity - bdf.rate(*next, *now, before + origin)
            })
            .collect();
        let mesh = state.mesh.with_nodes(nodes);
        let carrier = Carrier { mesh: &mesh, velocity: &carrying, time: level.time };
        self.solve(carrier, |nth| {
            let field = &state.scalars[nth];
            let older = field.now.iter().zip(&field.previous);
            let history = older.map(|(now, previous)| bdf.history(*now, *previous)).collect();
            History { rate: bdf.next, values: history }
        })
    }

    /// What each comes to in the flow of a state that does not change, seen from the frame.
    ///
    /// # Errors
    /// When a system has no solution.
    pub(in crate::run) fn steady(
        &mut self,
        problem: &Problem<D>,
        state: &State<D>,
    ) -> Result<Vec<Level>, LinearError> {
        let frame = problem.frame_velocity(&state.now.twists);
        let carrying: Vec<Point<D>> =
            state.now.velocity.iter().map(|velocity| velocity - frame).collect();
        let carrier = Carrier { mesh: &state.mesh, velocity: &carrying, time: state.time };
        self.solve(carrier, |_| History { rate: 0.0, values: Vec::new() })
    }

    fn solve(
        &mut self,
        carrier: Carrier<'_, D>,
        history: impl Fn(usize) -> History,
    ) -> Result<Vec<Level>, LinearError> {
        let metric = self.metric;
        let pairs = self.given.iter().zip(&mut self.equations).enumerate();
        pairs
            .map(|(nth, (scalar, equation))| {
                let equation =
                    equation.get_or_insert_with(|| Equation::new(scalar, carrier.mesh, metric));
                let History { rate, values } = history(nth);
                equation.solve(scalar, carrier, Step { rate, history: &values })
            })
            .collect()
    }
}

/// The part of a rate that older levels give.
struct History {
    rate: f64,
    values: Vec<f64>,
}

fn scalar<const D: usize>(
    model: &Model,
    mesh: &Mesh<D>,
    spec: &ScalarSpec,
) -> Result<Scalar<D>, RunError> {
    let case = &model.case;
    let by_peclet = || {
        let scales = case.scales?;
        Some(scales.velocity * scales.length / spec.peclet?)
    };
    let diffusivity = spec.diffusivity.or_else(by_peclet).ok_or_else(|| {
        RunError::Unsupported(format!("nothing says how much the scalar `{}` diffuses", spec.name))
    })?;
    let conditions = mesh.boundaries.iter().map(|boundary| {
        let given = match boundary.kind {
            BoundaryKind::Body(body) => spec.body.get(&model.bodies[body].name),
            BoundaryKind::Side => spec.boundary.get(&boundary.name),
            BoundaryKind::Axis => None,
        };
        given.map(|given| condition(case, given)).transpose()
    });
    let difference = spec.difference.zip(case.scales);
    Ok(Scalar {
        name: spec.name.clone(),
        diffusivity,
        conditions: conditions.collect::<Result<_, RunError>>()?,
        source: spec.source.as_ref().map(|source| number(case, source)).transpose()?,
        initial: number(case, &spec.initial)?,
        scale: difference.map(|(difference, scales)| [difference, scales.length]),
    })
}

fn condition<const D: usize>(
    case: &Case,
    given: &ScalarCondition,
) -> Result<Condition<D>, RunError> {
    Ok(match given {
        ScalarCondition::Value(value) => Condition::Value(number(case, value)?),
        ScalarCondition::Flux(flux) => Condition::Flux(number(case, flux)?),
        ScalarCondition::Uptake { rate, outside } => {
            Condition::Uptake { rate: *rate, outside: number(case, outside)? }
        }
    })
}
