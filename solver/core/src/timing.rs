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
    /// Finding the forces of contact, but for the flows under loads that it takes.
    Contact,
    /// Loads, power and other measurements.
    Loads,
    /// Writing files.
    Output,
}

impl Stage {
    /// All stages, in the order in which they are reported.
    pub const ALL: [Self; 8] = [
        Self::Mesh,
        Self::MeshMotion,
        Self::Assembly,
        Self::Factorisation,
        Self::Solve,
        Self::Contact,
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
            Self::Contact => "contact",
            Self::Loads => "loads",
            Self::Output => "output",
        }
    }
}

/// Seconds spent in each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Timing {
    /// CPU seconds of the whole process, by [`Stage::ALL`].
    pub cpu: [f64; Stage::ALL.len()],
    /// Wall-clock seconds, by [`Stage::ALL`].
    pub wall: [f64; Stage::ALL.len()],
}

/// When work began of which a part is booked by itself.
#[derive(Debug, Clone, Copy)]
pub struct Began {
    wall: Instant,
    cpu: f64,
    booked: Timing,
}

impl Timing {
    /// The beginning of work that books stages of its own.
    #[must_use]
    pub fn begin(&self) -> Began {
        Began { wall: Instant::now(), cpu: cpu_seconds(), booked: *self }
    }

    /// Books under `stage` the time since a beginning, but for what has been booked since.
    pub fn book_rest(&mut self, stage: Stage, began: Began) {
        let Began { wall, cpu, booked } = began;
        let since = |now: &[f64], then: &[f64]| now.iter().sum::<f64>() - then.iter().sum::<f64>();
        let rest = [
            wall.elapsed().as_secs_f64() - since(&self.wall, &booked.wall),
            cpu_seconds() - cpu - since(&self.cpu, &booked.cpu),
        ];
        let [wall, cpu] = rest.map(|seconds| seconds.max(0.0));
        self.wall[stage as usize] += wall;
        self.cpu[stage as usize] += cpu;
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    /// What has been booked within is not booked twice: all of the time is in one stage or the other.
    #[test]
    fn the_rest_of_work_is_what_it_has_not_booked_itself() {
        let spin = |seconds: f64| {
            let began = Instant::now();
            while began.elapsed().as_secs_f64() < seconds {}
        };
        let (mut timing, whole) = (Timing::default(), Instant::now());
        let began = timing.begin();
        timing.measure(Stage::Solve, || spin(0.02));
        spin(0.01);
        timing.book_rest(Stage::Contact, began);
        let whole = whole.elapsed().as_secs_f64();
        let [inner, rest] = [Stage::Solve, Stage::Contact].map(|stage| timing.wall[stage as usize]);
        assert!(inner >= 0.02 && rest >= 0.01, "{inner} {rest}");
        assert!(inner + rest <= whole, "{inner} + {rest} in {whole}");
    }
}
