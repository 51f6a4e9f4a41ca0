//! `Plan` and `Trajectory`: what is given of a motion, and how the body moves.

use alewife_interrupt::check;
use alewife_solid::solid::{Level, Minimiser, Motion, Scheme, StepInput};

use super::SoftError;
use super::body::SoftBody;

/// Residual of a step, of its forces: so small that differences of two motions can be compared with gradients.
const TOLERANCE: f64 = 1e-10;

/// What a body is told in time. Stretches are held over the substeps of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// How it steps.
    pub scheme: Scheme,
    /// Time of a frame (s).
    pub frame: f64,
    /// Steps of a frame.
    pub substeps: usize,
    /// The stretch each set of fibres is told, frame by frame.
    pub targets: Vec<Vec<f64>>,
    /// Residual of a step, of its forces.
    pub tolerance: f64,
}

/// Places and velocities of a motion at all steps, the start included.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// One level a step.
    pub levels: Vec<Level>,
    /// Factorisations in all.
    pub n_factors: usize,
    /// Newton's iterations in all.
    pub n_iterations: usize,
}

impl Plan {
    /// A plan with the usual tolerance, by implicit Euler.
    #[must_use]
    pub fn new(frame: f64, substeps: usize, targets: Vec<Vec<f64>>) -> Self {
        Self { scheme: Scheme::ImplicitEuler, frame, substeps, targets, tolerance: TOLERANCE }
    }

    /// Size of a step (s).
    #[must_use]
    pub fn step(&self) -> f64 {
        self.frame / self.substeps as f64
    }

    /// Number of steps.
    #[must_use]
    pub fn n_steps(&self) -> usize {
        self.substeps * self.targets.len()
    }

    /// The frame that the step from a level belongs to.
    #[must_use]
    pub fn frame_of(&self, step: usize) -> usize {
        step / self.substeps
    }

    /// Whether it is a plan for a body with so many sets of fibres.
    fn check(&self, n_sets: usize) -> Result<(), SoftError> {
        let wrong = |what: String| Err(SoftError::Plan(what));
        if !(self.frame > 0.0 && self.frame.is_finite()) {
            return wrong(format!("a frame takes {} s: it has to be positive", self.frame));
        }
        if self.substeps == 0 || self.targets.is_empty() {
            return wrong("a plan has at least one frame of one step".to_owned());
        }
        if self.scheme == Scheme::Conservative {
            return wrong("the soft tier steps by implicit Euler or BDF2".to_owned());
        }
        for (frame, targets) in self.targets.iter().enumerate() {
            if targets.len() != n_sets {
                let found = targets.len();
                return wrong(format!(
                    "frame {frame} has {found} stretches for {n_sets} sets of fibres"
                ));
            }
            if let Some(wrong_one) =
                targets.iter().find(|target| target.is_nan() || **target <= 0.0)
            {
                return wrong(format!(
                    "frame {frame} has the stretch {wrong_one}: one is positive, 1 at rest"
                ));
            }
        }
        Ok(())
    }
}

impl Trajectory {
    /// The motion at a level, with the level before.
    pub(super) fn motion(levels: &[Level], at: usize) -> Motion {
        let Level { places, velocities } = levels[at].clone();
        let before = at.checked_sub(1).map(|before| Box::new(levels[before].clone()));
        Motion { places, velocities, before }
    }
}

impl<const D: usize> SoftBody<D> {
    /// Moves the body from rest as planned.
    ///
    /// # Errors
    /// [`SoftError::Plan`], [`SoftError::Step`] for a step that fails, and [`SoftError::Stopped`].
    pub fn simulate(&self, plan: &Plan) -> Result<Trajectory, SoftError> {
        plan.check(self.solid.spec().fibres.len())?;
        let start = Motion::at_rest(&self.solid);
        let mut levels = vec![Level { places: start.places, velocities: start.velocities }];
        let mut minimiser = Minimiser::with_tolerance(plan.tolerance);
        for step in 0..plan.n_steps() {
            check()?;
            let loads = self.loads(&levels[step].places, &levels[step].velocities);
            let given = StepInput {
                scheme: plan.scheme,
                step: plan.step(),
                targets: &plan.targets[plan.frame_of(step)],
                loads: &loads,
                held: None,
            };
            let motion = Trajectory::motion(&levels, step);
            let n_steps = plan.n_steps();
            let failed = |error| SoftError::Step { step: step + 1, n_steps, error };
            let next = self.solid.advance(&mut minimiser, &motion, &given).map_err(failed)?;
            levels.push(Level { places: next.places, velocities: next.velocities });
        }
        let Minimiser { n_factors, n_iterations, .. } = minimiser;
        Ok(Trajectory { levels, n_factors, n_iterations })
    }
}
