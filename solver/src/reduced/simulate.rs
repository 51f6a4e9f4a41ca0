//! The motion of a reduced model of a case, as the series of its quantities.

use alewife_reduced::tree::State;

use super::ReducedError;
use super::build::Reduced;
use super::measure::{Moving, Value, bodies, is_load, joint};
use super::mover::Mover;
use super::swimmer::Swimming;
use crate::case::{Column, Model, Source, TimeSettings, Unsteady, columns};
use crate::run::Series;

/// Rows of all quantities that need no flow.
struct Rows {
    columns: Vec<Column>,
    /// Links below joints, in the order of the bodies that are their children.
    below: Vec<usize>,
    swimmers: Vec<Swimming>,
    before: Vec<Moving>,
    series: Series,
}

impl Rows {
    fn new(model: &Model, reduced: &Reduced) -> Self {
        let joined = (0..model.bodies.len()).filter(|body| model.joint_above(*body).is_some());
        let has_loads = reduced.connection.is_none();
        let known = |column: &Column| has_loads || !is_load(column.source);
        Self {
            below: joined.map(|body| reduced.parts[body].link).collect(),
            columns: columns(model).into_iter().filter(known).collect(),
            swimmers: model.swimmers.iter().map(Swimming::new).collect(),
            before: Vec::new(),
            series: Series::default(),
        }
    }

    fn add(&mut self, reduced: &Reduced, state: &State<f64>, step: f64) {
        let now = bodies(reduced, state, &self.before, step);
        for swimmer in &mut self.swimmers {
            swimmer.observe(reduced, &now, state.time);
        }
        let value = |column: &Column| {
            let value = match column.source {
                Source::Body(body, quantity) => now[body].value(quantity),
                Source::Joint(nth, quantity) => {
                    Some(Value::Scalar(joint(reduced, state, self.below[nth], quantity)))
                }
                Source::Swimmer(nth, quantity) => self.swimmers[nth].value(quantity),
                Source::Probe(..)
                | Source::Tracer(..)
                | Source::Scalar(..)
                | Source::ScalarSurface(..)
                | Source::ScalarProbe(..)
                | Source::Flow(_)
                | Source::Side(..) => None,
            };
            value.map(|value| value.component(column.component))
        };
        if self.series.names.is_empty() {
            self.columns.retain(|column| value(column).is_some());
            self.series.names = self.columns.iter().map(|column| column.name.clone()).collect();
        }
        self.series.times.push(state.time);
        self.series
            .rows
            .push(self.columns.iter().map(|column| value(column).unwrap_or(f64::NAN)).collect());
        self.before = now;
    }
}

/// The ends of steps (s), of which the last one may be shorter.
pub(super) fn step_ends(time: &Unsteady) -> impl Iterator<Item = f64> {
    let Unsteady { step, end, .. } = *time;
    let n_steps = time.n_steps();
    (1..=n_steps).map(move |number| if number == n_steps { end } else { step * number as f64 })
}

/// Moves a case by its reduced model, over the steps of `[time.unsteady]`, of second order, without inertia of
/// fourth. The series has the names of a full run, less those of quantities that only a flow has; without inertia
/// loads and velocities of a row are those at its time, with inertia the efforts of given joints are those of the
/// middle of the step before.
///
/// # Errors
/// When the case has what a reduced model does not know, or a step fails.
pub fn simulate(model: &Model) -> Result<Series, ReducedError> {
    let TimeSettings::Unsteady(time) = &model.case.time else {
        return Err(ReducedError::Unknown("a steady flow".to_owned()));
    };
    let reduced = Reduced::new(model)?;
    let mut state = reduced.start.clone();
    let mut mover = Mover::new(&reduced, reduced.tree.clone(), &mut state)?;
    let mut rows = Rows::new(model, &reduced);
    rows.add(&reduced, &state, time.step);
    for end in step_ends(time) {
        let step = end - state.time;
        mover.step(&reduced, &mut state, end)?;
        rows.add(&reduced, &state, step);
    }
    Ok(rows.series)
}
