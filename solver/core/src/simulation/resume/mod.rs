//! `SavedState`: a state as it is written to a file, for a run that resumes from it.

mod error;
mod level;
mod mesh;
mod series;

use std::collections::BTreeMap;

use alewife_mesh::{Boundary, Mesh, Point};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

pub use self::error::{ResumeError, VERSION};
use self::level::{SavedContact, SavedLevel};
use self::mesh::SavedMesh;
use self::series::SavedSeries;
use super::advance::Simulation;
use super::energy::EnergyBalance;
use super::momentum::MomentumBalance;
use super::moving_mesh::MovingMesh;
use super::propulsion_history::PropulsionHistory;
use super::state::{Piece, State};
use super::{RunError, Series};
use crate::algebra::SolverMemory;
use crate::body::{Pose, Twist, on_mesh};
use crate::case::Case;
use crate::coupling::{FluidSystem, Problem};

/// Everything that evolves, as plain numbers in the case's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState<const D: usize> {
    version: u32,
    /// What is solved, by the keys of the case.
    case: BTreeMap<String, String>,
    /// Steps made.
    pub step: usize,
    /// Time (s).
    pub time: f64,
    last_step: f64,
    proposed_step: Option<f64>,
    pieces: Vec<Piece>,
    remeshes: usize,
    mesh: SavedMesh,
    origin: Vector3<f64>,
    nodes: Vec<Point<D>>,
    nodes_before: Vec<Point<D>>,
    now: SavedLevel<D>,
    previous: SavedLevel<D>,
    rates: Vec<Point<D>>,
    accelerations: Vec<Twist>,
    poses: Vec<Pose>,
    previous_poses: Vec<Pose>,
    image_shifts: Vec<Vector3<f64>>,
    top_speed: f64,
    boundary_speed: f64,
    contact: SavedContact,
    propulsion: Vec<PropulsionHistory>,
    energy: EnergyBalance,
    momentum: MomentumBalance,
    reference: Option<SavedReference<D>>,
    solver: SolverMemory,
    series: SavedSeries,
}

/// The reference mesh, and where the bodies are in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedReference<const D: usize> {
    /// Positions of its nodes (m).
    pub nodes: Vec<Point<D>>,
    /// Poses of the bodies.
    pub poses: Vec<Pose>,
    /// The time it is made for (s).
    pub time: f64,
    /// Start of the domain along its periodic directions.
    pub domain_start: Point<D>,
}

impl<const D: usize> SavedReference<D> {
    fn of(moving: &MovingMesh<D>) -> Self {
        Self {
            nodes: moving.reference().to_vec(),
            poses: moving.reference_poses().to_vec(),
            time: moving.reference_time(),
            domain_start: moving.scene().domain_start(),
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
    /// What is written of a simulation of a case whose quantities so far are `series`.
    ///
    /// # Errors
    /// When the case cannot be written.
    pub(super) fn of(
        case: &Case,
        simulation: &Simulation<D>,
        series: &Series,
    ) -> Result<Self, ResumeError> {
        let state = &simulation.state;
        Ok(Self {
            version: VERSION,
            case: case.problem_keys()?,
            step: state.step,
            time: state.time,
            last_step: state.last_step,
            proposed_step: state.proposed_step,
            pieces: state.pieces.clone(),
            remeshes: state.remeshes,
            mesh: SavedMesh::of(&state.mesh),
            origin: state.origin,
            nodes: state.nodes.clone(),
            nodes_before: state.nodes_before.clone(),
            now: SavedLevel::of(&state.now),
            previous: SavedLevel::of(&state.previous),
            rates: state.rates.clone(),
            accelerations: state.accelerations.clone(),
            poses: state.poses.clone(),
            previous_poses: state.previous_poses.clone(),
            image_shifts: state.image_shifts.clone(),
            top_speed: state.top_speed,
            boundary_speed: state.boundary_speed,
            contact: SavedContact::of(&state.contact),
            propulsion: state.propulsion.clone(),
            energy: state.energy,
            momentum: state.momentum.clone(),
            reference: simulation.moving_mesh.as_ref().map(SavedReference::of),
            solver: simulation.work.system.solver_memory(),
            series: SavedSeries::of(series),
        })
    }

    /// The quantities of all steps so far.
    #[must_use]
    pub fn series(&self) -> Series {
        self.series.series()
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
        let state = self.state(&boundaries);
        simulation.moving_mesh = match (&self.reference, &simulation.moving_mesh) {
            (Some(saved), Some(_)) => {
                let mesh = self.mesh.with_nodes(saved.nodes.clone(), &boundaries);
                Some(follow(problem, &Reference { saved, mesh })?)
            }
            (None, None) => None,
            _ => return Err(ResumeError::MeshMotion.into()),
        };
        let poses = state.in_mesh(&state.poses);
        let unknown_frame = simulation.scheme.unknown_frame;
        simulation.work.system = FluidSystem::new(problem, &state.mesh, &poses, unknown_frame);
        simulation.work.system.recall(self.solver.clone()).map_err(ResumeError::from)?;
        simulation.work.mesh = state.mesh.clone();
        (simulation.state, simulation.is_fresh) = (state, false);
        Ok(())
    }

    /// Whether it is a state of what a case describes.
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
        match self.case.keys().chain(keys.keys()).find(|key| self.case.get(*key) != keys.get(*key))
        {
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
        let (n_nodes, n_bodies) = (self.nodes.len(), problem.bodies.len());
        let levels = [&self.now, &self.previous];
        let n_vertices = self.mesh.n_vertices;
        let fits = self.mesh.is_consistent::<D>(n_nodes, n_boundaries)
            && [&self.nodes_before, &self.rates].iter().all(|values| values.len() == n_nodes)
            && levels.iter().all(|level| level.is_consistent(n_nodes, n_vertices, n_bodies))
            && [&self.poses, &self.previous_poses].iter().all(|poses| poses.len() == n_bodies)
            && self.accelerations.len() == n_bodies
            && self.image_shifts.len() == n_bodies
            && self.contact.wrenches.len() == n_bodies
            && self.series.is_consistent()
            && self.propulsion.len() == problem.groups.len()
            && self.reference.as_ref().is_none_or(|reference| {
                reference.nodes.len() == n_nodes && reference.poses.len() == n_bodies
            });
        if !fits {
            return Err(ResumeError::Inconsistent);
        }
        Ok(())
    }

    fn state(&self, boundaries: &[Boundary]) -> State<D> {
        let origin = on_mesh::<D>(&self.origin);
        let in_laboratory = self.nodes.iter().map(|node| node + origin).collect();
        State {
            step: self.step,
            time: self.time,
            last_step: self.last_step,
            proposed_step: self.proposed_step,
            pieces: self.pieces.clone(),
            remeshes: self.remeshes,
            mesh: self.mesh.with_nodes(in_laboratory, boundaries),
            origin: self.origin,
            nodes: self.nodes.clone(),
            nodes_before: self.nodes_before.clone(),
            now: self.now.solution(),
            previous: self.previous.solution(),
            poses: self.poses.clone(),
            previous_poses: self.previous_poses.clone(),
            image_shifts: self.image_shifts.clone(),
            rates: self.rates.clone(),
            accelerations: self.accelerations.clone(),
            top_speed: self.top_speed,
            boundary_speed: self.boundary_speed,
            contact: self.contact.loads(),
            propulsion: self.propulsion.clone(),
            energy: self.energy,
            momentum: self.momentum.clone(),
        }
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
