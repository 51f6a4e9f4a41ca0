//! `Environment` and `Batch`: tasks to be learnt, with numbers and bytes; arrays are made of them in `alewife.environment`.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use alewife::environment::{
    Autoreset, Batch as Inner, Drawn, Environment as _, EnvironmentError, Full, Head, Info, Swim,
    Task,
};
use alewife::runner::{Checked, Failure, checked};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::worker::{Stopped, Worker, failed};

/// Names and bounds of observations, commands with their ranges, names of targets, of terms of the reward and of
/// reasons; numbers of conditions that end an episode for good
/// and of decisions in it, and the time of one (s).
type Layout = (Vec<(String, f64, f64)>, Vec<(String, f64, f64)>, [Vec<String>; 3], [usize; 2], f64);

/// Time, sample, targets, terms, reason and what the solver says.
type Told = (f64, usize, Vec<f64>, Vec<f64>, String, String);

/// An environment of the full solver, in the plane or in space.
pub enum AnyFull {
    /// Planar or axisymmetric.
    Plane(Box<Full<2>>),
    /// In three dimensions.
    Space(Box<Full<3>>),
}

macro_rules! each {
    ($any:expr, $one:ident => $work:expr) => {
        match $any {
            AnyFull::Plane($one) => $work,
            AnyFull::Space($one) => $work,
        }
    };
}

enum Solver {
    Reduced(Box<Mutex<Swim>>),
    Full(Worker<AnyFull>),
}

/// What a step of many gives: six arrays, and observations at the ends of episodes if there are any.
type Stepped<T> = ([T; 6], Option<T>);

/// One environment.
#[pyclass(frozen, module = "alewife_session")]
pub struct Environment {
    solver: Solver,
    layout: Layout,
    reasons: Vec<String>,
    codes: Task,
}

/// Many environments of the reduced model.
#[pyclass(frozen, module = "alewife_session")]
pub struct Batch(Mutex<Inner>);

fn owned(names: Vec<&str>) -> Vec<String> {
    names.into_iter().map(str::to_owned).collect()
}

fn layout_of(task: &Task) -> Layout {
    let names = owned(task.observations()).into_iter();
    let observations = names.zip(task.bounds()).map(|(name, [low, high])| (name, low, high));
    let actions = task.actions().iter();
    let actions = actions.map(|one| (one.command.clone(), one.range[0], one.range[1]));
    let others = [owned(task.targets()), owned(task.terms()), owned(task.reasons())];
    let counts = [task.n_terminate(), task.n_decisions()];
    (observations.collect(), actions.collect(), others, counts, task.time(1))
}

fn refused(error: EnvironmentError) -> PyErr {
    match error {
        EnvironmentError::Action { .. }
        | EnvironmentError::Shape { .. }
        | EnvironmentError::Number(_) => PyValueError::new_err(error.to_string()),
        error => failed(&Failure::from(error)),
    }
}

fn bytes_of<const N: usize>(values: impl ExactSizeIterator<Item = [u8; N]>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(N * values.len());
    values.for_each(|value| bytes.extend_from_slice(&value));
    bytes
}

/// Numbers of single precision, as learners take them.
#[expect(clippy::cast_possible_truncation, reason = "digits beyond those of the array are lost")]
fn singles(values: &[f64]) -> Vec<u8> {
    bytes_of(values.iter().map(|value| (*value as f32).to_ne_bytes()))
}

fn doubles(values: impl ExactSizeIterator<Item = f64>) -> Vec<u8> {
    bytes_of(values.map(f64::to_ne_bytes))
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    let (whole, _) = bytes.as_chunks::<8>();
    whole.iter().map(|one| f64::from_ne_bytes(*one)).collect()
}

fn read(case: &str, settings: &[String]) -> PyResult<Checked> {
    checked(case, settings).map_err(|failure| failed(&failure))
}

fn warned(checked: &Checked) -> Vec<String> {
    checked.warnings.iter().map(ToString::to_string).collect()
}

impl Environment {
    fn told(&self, info: Info) -> Told {
        let reason = self.reasons.get(self.codes.code(info.reason)).cloned().unwrap_or_default();
        (info.time, info.sample, info.targets, info.terms, reason, info.message)
    }
}

#[pymethods]
impl Environment {
    /// Opens one by the reduced model or by the full solver, and gives it with the warnings there are.
    #[staticmethod]
    fn open(
        py: Python<'_>,
        case: &str,
        settings: Vec<String>,
        is_full: bool,
        threads: usize,
    ) -> PyResult<(Self, Vec<String>)> {
        let checked = read(case, &settings)?;
        let warnings = warned(&checked);
        let task = Task::new(&checked.file).map_err(refused)?;
        let file = checked.file;
        let solver = if is_full {
            let worker = Worker::start(threads)?;
            let stop = Arc::clone(worker.stop());
            worker.work(py, move |own| {
                let mut full = match file.case().geometry.dimensions() {
                    2 => AnyFull::Plane(Box::new(Full::open(&file)?)),
                    _ => AnyFull::Space(Box::new(Full::open(&file)?)),
                };
                each!(&mut full, one => one.stop_when(Stopped::by(&stop)));
                *own = Some(full);
                Ok(())
            })?;
            Solver::Full(worker)
        } else {
            let swim = py.detach(move || Swim::open(&file)).map_err(refused)?;
            Solver::Reduced(Box::new(Mutex::new(swim)))
        };
        let (layout, reasons) = (layout_of(&task), owned(task.reasons()));
        Ok((Self { solver, layout, reasons, codes: task }, warnings))
    }

    /// What it is like.
    fn layout(&self) -> Layout {
        self.layout.clone()
    }

    /// Starts an episode.
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seed: Option<u64>,
    ) -> PyResult<(Bound<'py, PyByteArray>, Told)> {
        let observed = match &self.solver {
            Solver::Reduced(swim) => py
                .detach(|| swim.lock().unwrap_or_else(PoisonError::into_inner).reset(seed))
                .map_err(refused)?,
            Solver::Full(worker) => worker.with_it(py, move |full| {
                each!(full, one => one.reset(seed)).map_err(Failure::from)
            })?,
        };
        let observation = PyByteArray::new(py, &singles(&observed.observation));
        Ok((observation, self.told(observed.info)))
    }

    /// Takes an action: observation, reward, whether it is over and whether it is broken off.
    fn step<'py>(
        &self,
        py: Python<'py>,
        action: Vec<f64>,
    ) -> PyResult<(Bound<'py, PyByteArray>, f64, bool, bool, Told)> {
        self.codes.accept(0, &action).map_err(refused)?;
        let outcome = match &self.solver {
            Solver::Reduced(swim) => py
                .detach(|| swim.lock().unwrap_or_else(PoisonError::into_inner).step(&action))
                .map_err(refused)?,
            Solver::Full(worker) => worker.with_it(py, move |full| {
                each!(full, one => one.step(&action)).map_err(Failure::from)
            })?,
        };
        let observation = PyByteArray::new(py, &singles(&outcome.observation));
        let told = self.told(outcome.info);
        Ok((observation, outcome.reward, outcome.terminated, outcome.truncated, told))
    }
}

#[pymethods]
impl Batch {
    /// Opens many, and gives them with the warnings there are.
    #[staticmethod]
    fn open(
        py: Python<'_>,
        case: &str,
        settings: Vec<String>,
        n: usize,
        threads: usize,
    ) -> PyResult<(Self, Vec<String>)> {
        let checked = read(case, &settings)?;
        let warnings = warned(&checked);
        let batch = py.detach(move || Inner::open(&checked.file, n, threads)).map_err(refused)?;
        Ok((Self(Mutex::new(batch)), warnings))
    }

    /// What they are like.
    fn layout(&self, py: Python<'_>) -> Layout {
        py.detach(|| layout_of(self.held().task()))
    }

    /// Starts episodes in all or in those of a mask, by seeds or as the next ones.
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seeds: Option<Vec<u64>>,
        mask: Option<Vec<bool>>,
    ) -> PyResult<Bound<'py, PyByteArray>> {
        let reset = || {
            let mut batch = self.held();
            batch.reset(seeds.as_deref(), mask.as_deref())?;
            Ok(singles(batch.observations()))
        };
        Ok(PyByteArray::new(py, &py.detach(reset).map_err(refused)?))
    }

    /// Takes an action in each, numbers of double precision: observations, rewards, codes of reasons, whether each
    /// was reset, times, terms of the rewards, and observations at the ends of episodes if there are any.
    fn step<'py>(
        &self,
        py: Python<'py>,
        actions: &[u8],
        autoreset: &str,
    ) -> PyResult<Stepped<Bound<'py, PyByteArray>>> {
        let mode = match autoreset {
            "NextStep" => Autoreset::NextStep,
            "SameStep" => Autoreset::SameStep,
            "Disabled" => Autoreset::Disabled,
            other => {
                let message = format!("autoreset {other}: NextStep, SameStep, Disabled");
                return Err(PyValueError::new_err(message));
            }
        };
        let actions = numbers(actions);
        let (arrays, finals) = py.detach(|| self.stepped(&actions, mode)).map_err(refused)?;
        let array = |bytes: Vec<u8>| PyByteArray::new(py, &bytes);
        Ok((arrays.map(array), finals.map(array)))
    }

    /// The number of the sample of each, as 64 bits, and the targets of each.
    fn drawn<'py>(&self, py: Python<'py>) -> [Bound<'py, PyByteArray>; 2] {
        let Drawn { samples, targets } = py.detach(|| self.held().drawn());
        let samples = bytes_of(samples.iter().map(|sample| (*sample as u64).to_ne_bytes()));
        [samples, doubles(targets.iter().copied())].map(|bytes| PyByteArray::new(py, &bytes))
    }
}

impl Batch {
    /// It, without the lock of the interpreter: who has it may wait for that.
    fn held(&self) -> MutexGuard<'_, Inner> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn stepped(
        &self,
        actions: &[f64],
        mode: Autoreset,
    ) -> Result<Stepped<Vec<u8>>, EnvironmentError> {
        let mut batch = self.held();
        batch.step(actions, mode)?;
        let (heads, task) = (batch.heads(), batch.task());
        #[expect(clippy::cast_possible_truncation, reason = "there are few reasons")]
        let reasons = heads.iter().map(|head| [task.code(head.reason) as u8]);
        let has_ended = |head: &Head| head.was_reset && task.code(head.reason) > 0;
        let has_finals = mode == Autoreset::SameStep && heads.iter().any(has_ended);
        let arrays = [
            singles(batch.observations()),
            doubles(heads.iter().map(|head| head.reward)),
            bytes_of(reasons),
            bytes_of(heads.iter().map(|head| [u8::from(head.was_reset)])),
            doubles(heads.iter().map(|head| head.time)),
            doubles(batch.terms().iter().copied()),
        ];
        Ok((arrays, has_finals.then(|| singles(batch.finals()))))
    }
}
