//! The first cycle of swimmers with steps of another size, made ahead of a run without inertia.

use tracing::subscriber::{NoSubscriber, with_default};

use crate::case::{Model, TimeSettings, Unsteady};
use crate::run::case_mesh::{CaseMesh, Dimension};
use crate::run::cycle_error::{OtherSteps, displacements, first_cycle};
use crate::run::prepare::simulation_on;
use crate::run::run::Run;

/// Steps of a trial of which one may have to be made in halves: with more of them it is no trial of
/// longer steps.
const STEPS_PER_REJECTION: usize = 10;

/// Whether so many halved steps of a trial are too many.
pub(super) fn is_pointless(rejections: usize, steps: usize) -> bool {
    rejections * STEPS_PER_REJECTION > steps
}

impl<const D: usize> Run<'_, D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Makes the first cycle with steps twice as long, or half as long where those are too long to be
    /// made, and keeps what came of it for a comparison.
    pub(in crate::run) fn try_other_steps(&mut self, model: &Model) {
        let TimeSettings::Unsteady(settings) = &model.case.time else { return };
        let Some(settings) = first_cycle(&self.simulation, settings) else { return };
        let with = |ratio: f64| Unsteady { step: ratio * settings.step, ..settings.clone() };
        tracing::info!("the first cycle is made with steps of another size, to tell its error");
        self.other_steps =
            self.trial(model, &with(2.0), 2.0).or_else(|| self.trial(model, &with(0.5), 0.5));
        if self.other_steps.is_none() && self.check_signals(false).is_ok() {
            tracing::warn!(
                "the error of the distance of a cycle could not be estimated: most steps are halved"
            );
        }
    }

    /// Makes a run on a simulation of its own, unseen by the observers; nothing where it fails, or where
    /// many of its steps are halved.
    fn trial(&mut self, model: &Model, settings: &Unsteady, ratio: f64) -> Option<OtherSteps> {
        let mut trial = simulation_on(model, self.simulation.state.mesh.clone()).ok()?;
        trial.work.timing = self.simulation.work.timing;
        trial.stop.clone_from(&self.simulation.stop);
        std::mem::swap(&mut self.simulation, &mut trial);
        (self.is_trial, self.rejections) = (true, 0);
        let result = with_default(NoSubscriber::new(), || {
            self.begin(settings).and_then(|()| self.fixed_steps(settings))
        });
        self.is_trial = false;
        std::mem::swap(&mut self.simulation, &mut trial);
        self.simulation.work.timing = trial.work.timing;
        let steps = result.inspect_err(|error| tracing::info!(%error, ratio, "trial")).ok()?;
        let displacements = displacements(&trial);
        let is_made = !is_pointless(self.rejections, steps);
        is_made.then_some(OtherSteps { ratio, end: settings.end, displacements })
    }
}
