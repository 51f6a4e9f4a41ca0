//! CPU and wall-clock time of each stage of a run.

use std::time::Instant;

/// A stage of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Generating a mesh, and taking the flow over to it.
    Mesh,
    /// Moving the mesh.
    MeshMotion,
    /// Assembling matrix and right-hand side.
    Assembly,
    /// Factorising the matrix (with its symbolic analysis).
    Factorisation,
    /// Forward and backward substitution, refinement.
    Solve,
    /// Loads, power and other measurements.
    Loads,
    /// Writing files.
    Output,
}

impl Stage {
    /// All stages, in the order in which they are reported.
    pub const ALL: [Self; 7] = [
        Self::Mesh,
        Self::MeshMotion,
        Self::Assembly,
        Self::Factorisation,
        Self::Solve,
        Self::Loads,
        Self::Output,
    ];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::MeshMotion => "mesh_motion",
            Self::Assembly => "assembly",
            Self::Factorisation => "factorisation",
            Self::Solve => "solve",
            Self::Loads => "loads",
            Self::Output => "output",
        }
    }
}

/// Seconds spent in each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Timing {
    /// CPU seconds of the whole process, by [`Stage::ALL`].
    pub cpu: [f64; 7],
    /// Wall-clock seconds, by [`Stage::ALL`].
    pub wall: [f64; 7],
}

impl Timing {
    /// Runs `work` and books its time under `stage`.
    pub fn measure<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let (wall, cpu) = (Instant::now(), cpu_seconds());
        let result = work();
        self.wall[stage as usize] += wall.elapsed().as_secs_f64();
        self.cpu[stage as usize] += cpu_seconds() - cpu;
        result
    }
}

/// CPU seconds (user and system) of this process so far, all threads.
#[must_use]
pub fn cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
