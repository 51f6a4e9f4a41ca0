//! What the linear solver of fluid and bodies carries from step to step, as part of the state of a run.

use super::FluidSystem;
use crate::algebra::{LinearError, SolverMemory};

impl<const D: usize> FluidSystem<D> {
    /// Marks what the linear solver keeps at present as what belongs to the state of a run.
    pub fn mark_solver(&mut self) {
        self.linear.mark();
        self.kept_memory = None;
    }

    /// What the linear solver kept from system to system when that was marked.
    #[must_use]
    pub fn solver_memory(&self) -> SolverMemory {
        self.kept_memory.clone().unwrap_or_else(|| self.linear.memory())
    }

    /// Goes on as the system, on the same mesh, whose solver kept this.
    ///
    /// # Errors
    /// When it was another system.
    pub fn recall(&mut self, memory: SolverMemory) -> Result<(), LinearError> {
        self.linear.recall(memory)
    }
}
