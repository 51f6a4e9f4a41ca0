//! What of a `Session` makes steps or starts again: by the methods of `Solve`, which are compiled with all optimisation.

use super::session::{Observers, Session, refused};
use crate::case::Model;
use crate::run::case_mesh::Dimension;
use crate::run::resume::SavedState;
use crate::run::{RunError, Solve};

impl<const D: usize> Session<D>
where
    Dimension<D>: Solve<D>,
{
    /// Opens a session of a case at time zero, where the flow is solved for and measured.
    ///
    /// # Errors
    /// When the case is steady, or what stops a run at its start.
    pub fn open(model: &Model, observers: Observers<D>) -> Result<Self, RunError> {
        Dimension::<D>::open(model, None, observers)
    }

    /// Opens a session of a case at a saved state, with all that was asked for up to there.
    ///
    /// # Errors
    /// As [`Self::open`], and when it is a state of another case.
    pub fn resume(
        model: &Model,
        saved: &SavedState<D>,
        observers: Observers<D>,
    ) -> Result<Self, RunError> {
        Dimension::<D>::open(model, Some(saved), observers)
    }

    /// Makes steps until a time (s) is reached, to which the last one is shortened if need be; the time of the case's
    /// end at most. Nothing where it has come to its end.
    ///
    /// # Errors
    /// What stops a run; a time that is no number or is over.
    pub fn advance_to(&mut self, time: f64) -> Result<(), RunError> {
        self.check_goes_on()?;
        let (now, end) = (self.time(), self.settings.end);
        if !time.is_finite() {
            return Err(refused(format!("a session cannot advance to {time}; give a time (s)")));
        }
        if time < now {
            return Err(refused(format!(
                "a session at time {now} cannot advance to {time}; restore a state that was saved before"
            )));
        }
        if time > end * (1.0 + 1e-9) {
            return Err(refused(format!(
                "a session cannot advance to {time}: the case ends at {end}; raise time.unsteady.end"
            )));
        }
        Dimension::<D>::advance(self, time)
    }

    /// Another session at the same state, without observers: what is asked of one does not reach the other.
    ///
    /// # Errors
    /// As [`Self::resume`].
    pub fn fork(&self) -> Result<Self, RunError> {
        Self::resume(&self.run.model, &self.save()?, Vec::new())
    }

    /// Goes back, or forth, to a state of this case that was saved, and to what was asked for up to there.
    ///
    /// # Errors
    /// As [`Self::resume`]; where observers write down what happens, which cannot be taken back.
    pub fn restore(&mut self, saved: &SavedState<D>) -> Result<(), RunError> {
        if !self.run.observers.is_empty() {
            return Err(refused(
                "a session that writes a run directory cannot go back: fork it, or open one without a \
                 directory"
                    .to_owned(),
            ));
        }
        let stop = self.run.simulation.stop.clone();
        *self = Self::resume(&self.run.model, saved, Vec::new())?;
        self.run.simulation.stop = stop;
        Ok(())
    }
}
