//! `RunError`: what stopped a run, at which step, for which body or cell.

use alewife_interrupt::Stopped;
use alewife_mesh::MeshError;
use thiserror::Error;

use super::excess::Excess;
use super::resume::ResumeError;
use super::watch::{Allowed, NotFinite};
use crate::case::{CommandError, rounded};
use crate::contact::ContactError;
use crate::coupling::{ShapeError, coordinates};
use crate::motion::{MotionError, RemeshError};
use crate::step::{FlowError, at_step};

/// Every way a run can stop before its end.
#[derive(Debug, Error)]
pub enum RunError {
    /// No flow was found.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// The fluid is far faster than what drives it.
    #[error(
        "{}: the flow has blown up: {excess}, most near {}; CFL number {cfl:.3e}, cell Reynolds number \
         {cell_reynolds:.3e}; look at failure/flow.vtu, and start again with a finer mesh there, a \
         shorter time.unsteady.step, or time.unsteady.convection = \"newton\"{}",
        at_step(*step, *time),
        coordinates(.near),
        sound.map_or_else(String::new, |time| {
            format!("; failure/last.state is of t = {}, before that", rounded(time))
        })
    )]
    BlownUp {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// What is larger than what drives it can have made it.
        excess: Excess,
        /// Time (s) of the last state before, where one is left.
        sound: Option<f64>,
        /// CFL number of the step.
        cfl: f64,
        /// Largest cell Reynolds number.
        cell_reynolds: f64,
        /// Where the fluid is fastest (m).
        near: Vec<f64>,
    },
    /// An expression of the case has no finite value.
    #[error(
        "step {step}: `{}` = {} is {} at {}{} and t = {}",
        found.key,
        found.written,
        found.value,
        coordinates(&found.near),
        if found.is_of_body { " of the body" } else { "" },
        rounded(found.time)
    )]
    NotFinite {
        /// Step.
        step: usize,
        /// Which, where and when.
        found: Box<NotFinite>,
    },
    /// The system would not fit into memory.
    #[error(
        "{n_dofs} unknowns need about {needed:.0} GB of memory and {available:.0} GB are free; \
         raise mesh.size, mesh.surface or mesh.growth, or lower mesh.gap_layers"
    )]
    TooLarge {
        /// Velocities and pressures.
        n_dofs: usize,
        /// Estimate (GB).
        needed: f64,
        /// Free memory (GB).
        available: f64,
    },
    /// The mesh would not fit into memory; it has not been made.
    #[error(
        "the cell sizes ask for {n_cells:.1e} cells or more, which need {needed:.0} GB of memory, and \
         {available:.0} GB are free; raise mesh.size, mesh.surface or mesh.growth, or lower \
         mesh.gap_layers: cells {coarser:.1} times as large would fit"
    )]
    TooManyCells {
        /// Estimate, or where it ended.
        n_cells: f64,
        /// Memory of a system on them (GB).
        needed: f64,
        /// Free memory (GB).
        available: f64,
        /// Factor on all sizes with which it would fit.
        coarser: f64,
    },
    /// The first mesh has more cells than the case allows, or would.
    #[error(
        "the cell sizes ask for {} cells or more, and mesh.max_cells allows {most}; raise mesh.size, mesh.surface \
         or mesh.growth, lower mesh.gap_layers, or raise mesh.max_cells",
        whole(*n_cells)
    )]
    BeyondMaxCells {
        /// How many, perhaps by an estimate.
        n_cells: f64,
        /// How many are allowed.
        most: usize,
    },
    /// A new mesh would have more cells than it may have.
    #[error(
        "{}: a new mesh would have about {} cells, and {} is the most ({}). It is needed where the one at hand is \
         worn: {reason}{nearest}{}",
        at_step(*step, *time),
        whole(*n_cells),
        whole(allowed.most),
        allowed.by,
        advice(*closes)
    )]
    MeshTooLarge {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Cells, perhaps by an estimate.
        n_cells: f64,
        /// What is allowed.
        allowed: Allowed,
        /// Why a new mesh was needed, and where.
        reason: String,
        /// The smallest gap in words, if there is one.
        nearest: String,
        /// Whether nothing keeps gaps open.
        closes: bool,
    },
    /// A request the solver cannot meet (a case that `check` should have refused).
    #[error("{0}")]
    Unsupported(String),
    /// No shorter step helps.
    #[error(
        "{}: {reason}, with steps down to {smallest:.3e}{advice}",
        at_step(*step, *time)
    )]
    StepSizeUnderflow {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// The smallest step tried (s).
        smallest: f64,
        /// What went wrong in it.
        reason: String,
        /// What else is known, and what may help, behind semicolons.
        advice: String,
    },
    /// Remeshing failed.
    #[error("{}: remeshing failed: {reason}", at_step(*step, *time))]
    Remesh {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which body, and why.
        #[source]
        reason: Box<RemeshError>,
    },
    /// Contact cannot be solved for.
    #[error("{}: {reason}", at_step(*step, *time))]
    Contact {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which bodies, and why.
        reason: Box<ContactError>,
    },
    /// A body with coordinates meets itself.
    #[error("{}: {meeting}", at_step(*step, *time))]
    MeetsItself {
        /// Step.
        step: usize,
        /// Time (s).
        time: f64,
        /// Which, and where.
        meeting: Box<Meeting>,
    },
    /// The mesh could not be generated.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshError),
    /// A run cannot resume from a state.
    #[error("cannot resume from this state: {0}")]
    Resume(#[from] ResumeError),
    /// Something cannot be asked for.
    #[error(transparent)]
    Command(#[from] CommandError),
    /// Nobody asks for what it waits for.
    #[error(
        "the case waits for commands ({}), and nobody gives them: repeat a session with --replay commands.csv, \
         open one from Python with alewife.session(case), or write numbers, sines or a table in place of \
         `command`",
        .commands.join(", ")
    )]
    Waits {
        /// Names of the commands.
        commands: Vec<String>,
    },
    /// A session cannot do what it is asked to.
    #[error("{0}")]
    Session(String),
    /// An observer could not write.
    #[error("output: {0}")]
    Output(#[from] std::io::Error),
}

/// A body with coordinates that comes near itself.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "`{body}` is {gap:.2e} from itself at ({}), where it is {:.3} and {:.3} from its head: contact of a rod with \
     itself is not computed; make the rod stiffer or shorter, load it less, or end the run before, by time.unsteady.end",
    as_told(place), along[0], along[1]
)]
pub struct Meeting {
    /// Name of the body.
    pub body: String,
    /// Distances of both points from its head (m).
    pub along: [f64; 2],
    /// Where it is (m).
    pub place: Vec<f64>,
    /// How near (m).
    pub gap: f64,
}

/// Coordinates of a place as they are told.
fn as_told(place: &[f64]) -> String {
    place.iter().map(|part| format!("{part:.4}")).collect::<Vec<_>>().join(", ")
}

impl RunError {
    /// A mesh that could not be set up at the start.
    pub(super) fn from_remesh(error: RemeshError) -> Self {
        match error {
            RemeshError::Mesh(error) => Self::Mesh(error),
            RemeshError::Motion(error) => FlowError::from(error).into(),
            RemeshError::Shape(error) => FlowError::from(error).into(),
            error => Self::Unsupported(error.to_string()),
        }
    }
}

/// A number of cells.
fn whole(n_cells: f64) -> String {
    if n_cells < 1e5 { format!("{n_cells:.0}") } else { format!("{n_cells:.2e}") }
}

/// What helps where a mesh grows too large.
fn advice(closes: bool) -> &'static str {
    if closes {
        ". Where a gap closes without contact, cells become ever smaller: keep it open by [contact], such as \
         contact.barrier, or end the run before, by time.unsteady.end; lower mesh.gap_layers, or raise mesh.max_cells \
         and continue from failure/last.state with --resume"
    } else {
        ". Lower mesh.gap_layers, raise mesh.size, mesh.surface or mesh.growth, or raise mesh.max_cells, and \
         continue from failure/last.state with --resume"
    }
}

impl From<Stopped> for RunError {
    /// Before a run has begun.
    fn from(_: Stopped) -> Self {
        FlowError::Stopped { step: 0, time: 0.0 }.into()
    }
}

impl From<ShapeError> for RunError {
    fn from(error: ShapeError) -> Self {
        FlowError::from(error).into()
    }
}

impl From<MotionError> for RunError {
    fn from(error: MotionError) -> Self {
        FlowError::from(error).into()
    }
}
