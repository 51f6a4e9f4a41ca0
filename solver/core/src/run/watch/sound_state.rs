//! `SoundState`: what a run that blows up resumes from.

use crate::run::{SavedState, Series};

/// Steps between the states that are kept.
const EVERY: usize = 10;

/// The last state that was kept while the flow was sound.
pub(in crate::run) struct SoundState<const D: usize> {
    /// Without the quantities of its steps, which the run has.
    state: SavedState<D>,
}

impl<const D: usize> SoundState<D> {
    /// A state without the quantities of its steps.
    pub fn new(state: SavedState<D>) -> Self {
        Self { state }
    }

    /// The step after which the next one is to be kept.
    pub fn next(&self) -> usize {
        self.state.step() + EVERY
    }

    /// Its time (s).
    pub fn time(&self) -> f64 {
        self.state.time()
    }

    /// The state, with the quantities of the steps of its run up to there.
    pub fn saved(self, series: &Series) -> SavedState<D> {
        self.state.with_series(series)
    }
}
