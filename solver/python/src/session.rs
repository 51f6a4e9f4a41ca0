//! `Session`: what Python asks of a session, with numbers and bytes; arrays are made of them in `alewife.session`.

use std::path::PathBuf;
use std::sync::Arc;

use alewife::run::{Dimension, RunError, Session as Inner, Solve};
use alewife::runner::{Checked, SessionPlan, checked, write_state};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::either;
use crate::worker::{AnySession, AnyState, Worker, failed};

/// A state of a session.
#[pyclass(frozen, module = "alewife_session")]
pub struct State(Arc<AnyState>);

/// A session.
#[pyclass(frozen, module = "alewife_session")]
pub struct Session(Worker<AnySession>);

/// Values of a field in the order of nodes, and how many numbers each node has.
type Array<'py> = (Bound<'py, PyByteArray>, usize);

fn bytes_of(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_ne_bytes).collect()
}

/// Positions (m), velocities (m/s), pressures (Pa), cells, and the dimension.
fn fields<const D: usize>(session: &Inner<D>) -> [Vec<u8>; 4] {
    let fields = session.fields();
    let mesh = fields.mesh;
    let cells = mesh.cell_ids().flat_map(|cell| mesh.cell(cell).iter());
    let cells = cells.map(|node| node.index() as u64);
    [
        bytes_of(mesh.nodes.iter().flat_map(|node| node.iter().copied())),
        bytes_of(fields.velocity.iter().flat_map(|velocity| velocity.iter().copied())),
        bytes_of(fields.pressure.iter().copied()),
        cells.flat_map(u64::to_ne_bytes).collect(),
    ]
}

fn advance<const D: usize>(session: &mut Inner<D>, time: f64) -> Result<(), RunError>
where
    Dimension<D>: Solve<D>,
{
    session.advance_to(time)
}

#[pymethods]
impl Session {
    /// Opens a session of a case with settings, and gives it with the warnings there are.
    #[staticmethod]
    #[pyo3(signature = (case, settings, out, resume, overwrite, threads))]
    fn open(
        py: Python<'_>,
        case: &str,
        settings: Vec<String>,
        out: Option<PathBuf>,
        resume: Option<PathBuf>,
        overwrite: bool,
        threads: usize,
    ) -> PyResult<(Self, Vec<String>)> {
        let Checked { file, warnings } =
            checked(case, &settings).map_err(|failure| failed(&failure))?;
        let warnings = warnings.iter().map(ToString::to_string).collect();
        let plan = SessionPlan { file, out, resume, overwrite, threads };
        Ok((Self(Worker::open(py, plan)?), warnings))
    }

    /// Asks for targets of commands from now on.
    fn command(&self, py: Python<'_>, targets: Vec<(String, f64)>) -> PyResult<()> {
        self.0.with(py, move |session| {
            either!(session, one => {
                targets.iter().try_for_each(|(name, target)| one.command(name, *target))
            })
        })
    }

    /// Makes steps until a time (s).
    fn advance_to(&self, py: Python<'_>, time: f64) -> PyResult<()> {
        self.0.with(py, move |session| either!(session, one => advance(one, time)))
    }

    /// Quantities at present.
    fn observe(&self, py: Python<'_>, names: Vec<String>) -> PyResult<Vec<f64>> {
        self.0.with(py, move |session| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            either!(session, one => one.observe(&names))
        })
    }

    /// Positions, velocities, pressures and cells, as bytes with the length of a row.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<[Array<'py>; 4]> {
        let (fields, dimension, corners) = self.0.with(py, |session| {
            Ok(match session {
                AnySession::Plane(session) => (fields(session), 2, 6),
                AnySession::Space(session) => (fields(session), 3, 10),
            })
        })?;
        let rows = [dimension, dimension, 1, corners];
        let mut arrays =
            fields.iter().zip(rows).map(|(field, row)| (PyByteArray::new(py, field), row));
        Ok(std::array::from_fn(|_| arrays.next().unwrap_or((PyByteArray::new(py, &[]), 1))))
    }

    /// Value, rate and target of a command at present.
    fn commanded(&self, py: Python<'_>, name: String) -> PyResult<[f64; 3]> {
        self.0.with(py, move |session| either!(session, one => one.commanded(&name)))
    }

    /// Names of all commands, and of all quantities.
    fn names(&self, py: Python<'_>) -> PyResult<(Vec<String>, Vec<String>)> {
        self.0.with(
            py,
            |session| either!(session, one => Ok((one.commands(), one.quantities().to_vec()))),
        )
    }

    /// Time and the time of its end (s), steps made, and whether it is over.
    fn status(&self, py: Python<'_>) -> PyResult<(f64, f64, usize, bool)> {
        self.0.with(py, |session| {
            either!(session, one => Ok((one.time(), one.end(), one.step(), one.is_over())))
        })
    }

    /// All that was asked for, as `commands.csv` has it.
    fn recording(&self, py: Python<'_>) -> PyResult<String> {
        self.0.with(py, |session| either!(session, one => Ok(one.recording().to_csv())))
    }

    /// All that evolves.
    fn save(&self, py: Python<'_>) -> PyResult<State> {
        Ok(State(Arc::new(self.0.with(py, |session| AnyState::of(session))?)))
    }

    /// Goes back, or forth, to a state.
    fn restore(&self, py: Python<'_>, state: &State) -> PyResult<()> {
        let state = Arc::clone(&state.0);
        self.0.with(py, move |session| match (session, &*state) {
            (AnySession::Plane(session), AnyState::Plane(state)) => session.restore(state),
            (AnySession::Space(session), AnyState::Space(state)) => session.restore(state),
            _ => {
                Err(RunError::Session("this is a state of a case of another dimension".to_owned()))
            }
        })
    }

    /// Another session at the same state.
    fn fork(&self, py: Python<'_>) -> PyResult<Self> {
        Ok(Self(self.0.fork(py)?))
    }

    /// Ends it.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        self.0.work(py, |own| match own.take() {
            None => Ok(()),
            Some(session) => Ok(either!(session, one => one.close().map(drop))?),
        })
    }
}

#[pymethods]
impl State {
    /// Time (s).
    #[getter]
    fn time(&self) -> f64 {
        match &*self.0 {
            AnyState::Plane(state) => state.time(),
            AnyState::Space(state) => state.time(),
        }
    }

    /// Writes it to a file, from which runs and sessions continue.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let state = Arc::clone(&self.0);
        let written = py.detach(move || match &*state {
            AnyState::Plane(state) => write_state(&path, state),
            AnyState::Space(state) => write_state(&path, state),
        });
        written.map_err(|failure| failed(&failure))
    }
}
