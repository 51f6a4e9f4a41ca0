//! Gradients of motions without inertia: what places of bodies, ways and work of swimmers at the end of a run change by with
//! numbers of its case.
//!
//! dq/dt = V(q, t, p) is integrated by the scheme of runs (`step/explicit`), one Stokes flow a stage. By the adjoint flows of
//! its velocities and powers, each of these has V_q and V_p, so that the bodies of the case with a number larger or smaller by
//! dp are where V + V_q dq + V_p dp takes them (tangents in time): both are integrated beside those of the case itself, with
//! their own strokes, joints and averages over cycles, and what they differ by is the derivative. It is that of the discrete
//! scheme, but for the square of dp. Meshes follow the bodies, and where one is worn another is made, as in runs; what is
//! displaced by a number or a motion stays on the mesh of the case.

mod course;
mod march;
mod meshes;
mod refusals;
mod unknowns;

use std::cell::RefCell;
use std::rc::Rc;

use self::march::{March, Sides};
use self::meshes::{Left, MeshSince, Meshes};
pub(super) use self::refusals::refuse_in_time;
use super::adjoint::{Derivatives, Ends, ends};
use super::error::GradientError;
use super::flow::{BaseFlow, PreparedFlow};
use super::mesh_of_bodies::MeshOfBodies;
use super::moment::Moment;
use crate::case::{CaseError, CaseFile, Column, Source, SwimmerQuantity, TimeSettings, Unsteady};
use crate::coupling::Problem;
use crate::run::{CaseMesh, CellBound, Dimension};
use crate::step::Workspace;

/// A number of a case: the case with it larger by so much, and a small step of it.
pub(super) struct Changed<'a> {
    /// Its key.
    pub key: &'a str,
    /// The case.
    pub case: &'a dyn Fn(f64) -> Result<CaseFile, CaseError>,
    /// The step.
    pub step: f64,
}

/// The motions of a case for one set of its numbers after the other, which begin on one mesh.
pub(super) struct Motions<const D: usize> {
    mesh: Rc<MeshOfBodies<D>>,
    work: RefCell<Option<Workspace<D>>>,
    cell_bound: CellBound,
    /// The meshes that were made last where derivatives were asked for.
    made: RefCell<Vec<MeshSince<D>>>,
}

/// Whether what is asked of a case is asked of a motion: of the end of a run.
pub(super) fn is_in_time(file: &CaseFile) -> bool {
    matches!(file.case().time, TimeSettings::Unsteady(_))
}

impl<const D: usize> Motions<D>
where
    Dimension<D>: CaseMesh<D>,
{
    /// Makes the mesh.
    pub fn new(file: &CaseFile) -> Result<Self, GradientError> {
        refuse_in_time(file)?;
        let PreparedFlow { mesh, work, cell_bound } = BaseFlow::<D>::prepared(file)?;
        Ok(Self { mesh, work: RefCell::new(Some(work)), cell_bound, made: RefCell::default() })
    }

    /// Quantities at the end of the run of a case, and their derivatives by numbers.
    pub fn derivatives(
        &self,
        file: &CaseFile,
        columns: &[Column],
        numbers: &[Changed<'_>],
    ) -> Result<Vec<Derivatives>, GradientError> {
        let sides: Vec<Sides> =
            numbers.iter().map(|number| self.sides(file, number)).collect::<Result<_, _>>()?;
        let work = self.work_for(file)?;
        let meshes = Meshes::new(file, &self.mesh, work, self.cell_bound)?;
        let mut march = March::new(meshes, file, &sides, needs_powers(columns))?;
        march.run(settings_of(file)?)?;
        let of = |column: &Column| {
            let value = march.value(column);
            Derivatives {
                of: column.name.clone(),
                value,
                size: value.abs(),
                by: march.slopes(column),
                differences: Vec::new(),
            }
        };
        let found: Vec<Derivatives> = columns.iter().map(of).collect();
        let Left { work, made } = march.end();
        self.work.replace(work);
        self.made.replace(made);
        for of in &found {
            if !of.value.is_finite() {
                return Err(without_value(file, &of.of));
            }
            let pairs = numbers.iter().zip(&of.by);
            if let Some((number, _)) = pairs.into_iter().find(|(_, by)| !by.is_finite()) {
                return Err(without_slope(file, &of.of, number.key));
            }
        }
        Ok(found)
    }

    /// Central differences of quantities between complete motions of the case at both sides of a number, through the
    /// meshes that were made last where derivatives were asked for.
    pub fn differences(
        &self,
        file: &CaseFile,
        columns: &[Column],
        number: &Changed<'_>,
    ) -> Result<Vec<f64>, GradientError> {
        let Sides { files, step } = self.sides(file, number)?;
        let mut values = Vec::new();
        let made = self.made.borrow();
        for file in &files {
            let meshes = Meshes::known(&self.mesh, self.work_for(file)?, &made);
            let mut march = March::new(meshes, file, &[], needs_powers(columns))?;
            march.run(settings_of(file)?)?;
            values.push(columns.iter().map(|column| march.value(column)).collect::<Vec<f64>>());
            self.work.replace(march.end().work);
        }
        let pairs = values[0].iter().zip(&values[1]);
        Ok(pairs.map(|(below, above)| (above - below) / (2.0 * step)).collect())
    }

    /// The system on the mesh of the start.
    fn work_for(&self, file: &CaseFile) -> Result<Workspace<D>, GradientError> {
        match self.work.take() {
            Some(work) => Ok(work),
            // A flow that failed has kept it
            None => Ok(BaseFlow::<D>::prepared(file)?.work),
        }
    }

    /// The case at both sides of a number, near enough for bodies to be moved little.
    fn sides(&self, file: &CaseFile, number: &Changed<'_>) -> Result<Sides, GradientError> {
        let here = self.mesh.point(file.clone(), &Moment::START)?;
        let at = |change: f64| self.mesh.point((number.case)(change)?, &Moment::START);
        let Ends { points, step } = ends(&self.mesh, &here, number.step, &at)?;
        let end = settings_of(file)?.end;
        if points.iter().any(|point| moves_kinks(&here.problem, &point.problem, end)) {
            return Err(moved_kink(file, number.key));
        }
        Ok(Sides { files: [(number.case)(-step)?, (number.case)(step)?], step })
    }
}

fn settings_of(file: &CaseFile) -> Result<&Unsteady, GradientError> {
    match &file.case().time {
        TimeSettings::Unsteady(settings) => Ok(settings),
        TimeSettings::Steady(_) => Err(GradientError::refused(
            file,
            "time",
            "the numbers of the case make it steady".to_owned(),
            "write [time.unsteady] for all values of its numbers",
        )),
    }
}

/// Whether the work of swimmers counts in quantities.
fn needs_powers(columns: &[Column]) -> bool {
    let is_of_work = |column: &Column| {
        matches!(
            column.source,
            Source::Swimmer(
                _,
                SwimmerQuantity::CyclePower
                    | SwimmerQuantity::CycleCostOfTransport
                    | SwimmerQuantity::CycleLighthillEfficiency
            )
        )
    };
    columns.iter().any(is_of_work)
}

/// Whether rates jump at other times in a problem than in another one, up to the end of a run (s).
fn moves_kinks<const D: usize>(here: &Problem<D>, there: &Problem<D>, end: f64) -> bool {
    let times = |problem: &Problem<D>| -> Vec<f64> {
        let jumps = problem.rate_discontinuities.as_ref();
        jumps.map_or_else(Vec::new, |jumps| jumps(0.0, end))
    };
    let (here, there) = (times(here), times(there));
    let is_elsewhere = |(one, other): (&f64, &f64)| (one - other).abs() > SAME * end;
    here.len() != there.len() || here.iter().zip(&there).any(is_elsewhere)
}

/// Part of a run by which times that are the same differ by rounding.
const SAME: f64 = 1e-12;

fn moved_kink(file: &CaseFile, key: &str) -> GradientError {
    GradientError::refused(
        file,
        key,
        format!(
            "`{key}` says when the rate of a stroke jumps, and such times have no gradient yet"
        ),
        "take values at these times, or a stroke whose rate does not jump: `sine`, or `legs` that are `smooth`",
    )
}

fn without_slope(file: &CaseFile, name: &str, key: &str) -> GradientError {
    GradientError::refused(
        file,
        "time.unsteady.end",
        format!(
            "`{name}` has no derivative by `{key}` at the end of the run: on one side of its value the cycle is not whole"
        ),
        "let the run go on for a little more than a period",
    )
}

fn without_value(file: &CaseFile, name: &str) -> GradientError {
    GradientError::refused(
        file,
        "time.unsteady.end",
        format!("`{name}` has no value at the end of the run"),
        "averages over a cycle ask for a whole one: let the run go on for a period at least",
    )
}
