//! `SavedState`: a state as it is written to a file, for a run that resumes from it.

mod error;
mod longer;
mod series;

use std::collections::BTreeMap;

use alewife_interrupt::check;
use alewife_mesh::{Mesh, Point};
use serde::{Deserialize, Serialize};

pub use self::error::{ResumeError, VERSION};
use self::longer::agrees_with_past;
use self::series::SavedSeries;
use super::simulation::{Simulation, fluid_system};
use super::step_control::StepControl;
use super::{RunError, Series};
use crate::algebra::SolverMemory;
use crate::body::MeshPoses;
use crate::case::{Case, Recording};
use crate::coupling::Problem;
use crate::motion::MovingMesh;
use crate::state::{State, is_consistent};

/// Everything that evolves, as plain numbers in the case's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState<const D: usize> {
    version: u32,
    /// What is solved, by the keys of the case.
    case: BTreeMap<String, String>,
    /// Mesh, flow, bodies and balances.
    state: State<D>,
    control: StepControl,
    reference: Option<SavedReference<D>>,
    solver: SolverMemory,
    series: SavedSeries,
    recording: Recording,
}

/// The reference mesh, and where the bodies are in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedReference<const D: usize> {
    /// Positions of its nodes (m).
    pub nodes: Vec<Point<D>>,
    /// Poses of the bodies.
    pub poses: MeshPoses,
    /// Coordinates of the bodies that have some.
    pub coordinates: Vec<f64>,
    /// The time it is made for (s).
    pub time: f64,
}

impl<const D: usize> SavedReference<D> {
    fn of(moving: &MovingMesh<D>) -> Self {
        Self {
            nodes: moving.reference().to_vec(),
            poses: moving.reference_poses().clone(),
            coordinates: moving.reference_coordinates().to_vec(),
            time: moving.reference_time(),
        }
    }
}

/// The reference mesh of a saved state.
pub struct Reference<'a, const D: usize> {
    /// What was saved of it.
    pub saved: &'a SavedReference<D>,
    /// The mesh.
    pub mesh: Mesh<D>,
}

impl<const D: usize> SavedState<D> {
    /// What is written of a simulation of a case whose quantities so far are `series`, for which what is recorded
    /// was asked.
    ///
    /// # Errors
    /// When the case cannot be written.
    pub(super) fn of(
        case: &Case,
        simulation: &Simulation<D>,
        series: &Series,
        recording: &Recording,
    ) -> Result<Self, ResumeError> {
        Ok(Self {
            version: VERSION,
            case: case.problem_keys()?,
            state: simulation.state.without_derived(),
            control: simulation.control.clone(),
            reference: simulation.moving_mesh.as_ref().map(SavedReference::of),
            solver: simulation.work.system.solver_memory(),
            series: SavedSeries::of(series),
            recording: recording.clone(),
        })
    }

    /// The same with the quantities of all steps up to its time, of those of a run.
    #[must_use]
    pub(super) fn with_series(self, series: &Series) -> Self {
        let count = series.times.iter().take_while(|time| **time <= self.state.time).count();
        let series = Series {
            names: series.names.clone(),
            times: series.times[..count].to_vec(),
            rows: series.rows[..count].to_vec(),
        };
        Self { series: SavedSeries::of(&series), ..self }
    }

    /// Steps made.
    #[must_use]
    pub fn step(&self) -> usize {
        self.state.step
    }

    /// Time (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// The quantities of all steps so far.
    #[must_use]
    pub fn series(&self) -> Series {
        self.series.series()
    }

    /// What was asked for so far, and where the run paused.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Puts a simulation of the same problem where this state is; `follow` makes what moves
    /// the mesh from the reference mesh, where it moves.
    ///
    /// # Errors
    /// When the state is not one of such a case.
    pub(super) fn restore_into(
        &self,
        case: &Case,
        simulation: &mut Simulation<D>,
        follow: impl FnOnce(&Problem<D>, &Reference<'_, D>) -> Result<MovingMesh<D>, RunError>,
    ) -> Result<(), RunError> {
        let problem = &simulation.problem;
        let boundaries = simulation.state.mesh.boundaries.clone();
        self.check_case(case)?;
        self.check_consistent(problem, boundaries.len())?;
        let n_nodes = self.state.nodes.len();
        let are_whole =
            self.state.scalars.iter().all(|scalar| scalar.is_whole(n_nodes, boundaries.len()));
        let counts = [self.state.tracers.len(), self.state.scalars.len()];
        if counts != [case.tracer.len(), case.scalar.len()] || !are_whole {
            return Err(ResumeError::Inconsistent.into());
        }
        let mut state = self.state.clone();
        state.complete_mesh(&boundaries);
        simulation.moving_mesh = match (&self.reference, &simulation.moving_mesh) {
            (Some(saved), Some(_)) => {
                let mesh = state.mesh.with_nodes(saved.nodes.clone());
                Some(follow(problem, &Reference { saved, mesh })?)
            }
            (None, None) => None,
            _ => return Err(ResumeError::MeshMotion.into()),
        };
        let moving = simulation.moving_mesh.as_ref();
        let unknown_frame = simulation.scheme.unknown_frame;
        simulation.work.system = fluid_system(problem, &state, moving, unknown_frame, check)?;
        simulation.work.system.recall(self.solver.clone()).map_err(ResumeError::from)?;
        simulation.work.mesh = state.mesh.clone();
        simulation.control = self.control.clone();
        (simulation.state, simulation.is_fresh) = (state, false);
        Ok(())
    }

    /// Whether it is a state of what a case describes; tables and files of strokes may go on for longer.
    ///
    /// # Errors
    /// When it is of another version, or another value stands in the case.
    pub fn check_case(&self, case: &Case) -> Result<(), ResumeError> {
        if self.version != VERSION {
            return Err(ResumeError::Version { found: self.version });
        }
        let keys = case.problem_keys()?;
        let value = |keys: &BTreeMap<String, String>, key: &str| {
            keys.get(key).map_or_else(|| "absent".to_owned(), String::clone)
        };
        let differs = |key: &&String| {
            let (state, case) = (value(&self.case, key), value(&keys, key));
            state != case && !agrees_with_past(key, &state, &case, self.state.time)
        };
        match self.case.keys().chain(keys.keys()).find(differs) {
            None => Ok(()),
            Some(key) => {
                let (state, case) = (value(&self.case, key), value(&keys, key));
                let pairs = state.bytes().zip(case.bytes());
                let same = pairs.take_while(|(one, other)| one == other).count();
                let [state, case] = [state, case].map(|value| excerpt(&value, same));
                Err(ResumeError::OtherCase { key: key.clone(), state, case })
            }
        }
    }

    /// Whether the parts of the state fit together and to a problem.
    fn check_consistent(
        &self,
        problem: &Problem<D>,
        n_boundaries: usize,
    ) -> Result<(), ResumeError> {
        let state = &self.state;
        let (n_nodes, n_bodies) = (state.nodes.len(), problem.bodies.len());
        let n_vertices = state.mesh.n_vertices;
        let n_coordinates = problem.n_coordinates();
        let fits = is_consistent(&state.mesh, n_nodes, n_boundaries)
            && [&state.nodes_before, &state.rates].iter().all(|values| values.len() == n_nodes)
            && [&state.now, &state.previous].iter().all(|level| {
                level.velocity.len() == n_nodes
                    && level.pressure.len() == n_vertices
                    && level.twists.len() == n_bodies
                    && level.rates.len() == n_coordinates
            })
            && [&state.poses, &state.previous_poses].iter().all(|poses| poses.len() == n_bodies)
            && state.shapes.is_of(n_coordinates)
            && state.accelerations.len() == n_bodies
            && state.twist_rates.len() == n_bodies
            && state.image_shifts.len() == n_bodies
            && state.contact.wrenches.len() == n_bodies
            && self.series.is_consistent()
            && state.propulsion.len() == problem.groups.len()
            && self.reference.as_ref().is_none_or(|reference| {
                reference.nodes.len() == n_nodes
                    && reference.poses.len() == n_bodies
                    && reference.coordinates.len() == n_coordinates
            });
        if !fits {
            return Err(ResumeError::Inconsistent);
        }
        Ok(())
    }
}

/// Characters of a value that a message shows at most, and before the first that differs.
const SHOWN: usize = 80;
const SHOWN_BEFORE: usize = 20;

/// What a message shows of a value, such as a table of thousands of knots, of which the first bytes
/// are as they should be.
fn excerpt(value: &str, same: usize) -> String {
    if value.chars().count() <= SHOWN {
        return value.to_owned();
    }
    let before = value.char_indices().take_while(|(byte, _)| *byte < same).count();
    let start = before.saturating_sub(SHOWN_BEFORE);
    let shown: String = value.chars().skip(start).take(SHOWN).collect();
    let dots = |is_cut: bool| if is_cut { "..." } else { "" };
    let is_cut = start + SHOWN < value.chars().count();
    format!("{}{shown}{}", dots(start > 0), dots(is_cut))
}

#[cfg(test)]
mod tests {
    use super::excerpt;

    #[test]
    fn of_a_long_value_what_differs_is_shown() {
        assert_eq!(excerpt("[1.0,2.0]", 3), "[1.0,2.0]");
        let long = format!("{}HERE{}", "a".repeat(500), "b".repeat(500));
        let shown = excerpt(&long, 500);
        assert!(
            shown.contains("aHEREb") && shown.starts_with("...") && shown.len() == 86,
            "{shown}"
        );
        assert!(excerpt(&long, 0).starts_with("aaa") && excerpt(&long, 0).ends_with("..."));
    }
}
