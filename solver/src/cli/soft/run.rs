//! `run --fidelity soft`: the motion of a soft case, its series and its fields.

use std::path::{Path, PathBuf};

use alewife_reduced::search::write_whole;
use alewife_reduced::tier::{
    Bodies, Compared, Model, SolidOf, TierError, Written, compare, write_case,
};

use super::directory::{make_ready, not_written, prepare};
use crate::case::soft::SoftFile;
use crate::case::soft::spec::ReferenceOf;
use crate::cli::exit::{Exit, Failure};
use crate::cli::style::{complain, say};
use crate::observer::{Motion, MotionRecord, RunLock};

/// The model, by its name on the command line.
const MODEL: &str = "soft";

/// The file that is written last.
const LAST: &str = "comparison.json";

/// Where a run goes.
#[derive(Debug)]
pub struct Place {
    /// Its directory; `runs/<case>` if absent.
    pub out: Option<PathBuf>,
    /// Whether one that is there is replaced.
    pub overwrite: bool,
    /// Whether references are compared with.
    pub compares: bool,
    /// The directory, if this process holds it already.
    pub lock: Option<RunLock>,
}

/// Runs a soft case.
pub fn run(file: &SoftFile, place: Place) -> Result<Exit, Failure> {
    match file.case.geometry.dimensions() {
        2 => moved::<2>(file, place),
        _ => moved::<3>(file, place),
    }
}

fn moved<const D: usize>(file: &SoftFile, place: Place) -> Result<Exit, Failure>
where
    Bodies: SolidOf<D> + Written<D>,
{
    let Place { out, overwrite, compares, lock } = place;
    let out = out.unwrap_or_else(|| Path::new("runs").join(file.directory_name()));
    let model = Model::<D>::new(file)?;
    let endings = [LAST, "vtu"];
    let _held = match lock {
        Some(lock) => make_ready(&out, endings, overwrite).map(|()| lock)?,
        None => prepare(&out, endings, overwrite)?,
    };
    let failed = |error: std::io::Error| not_written(&out, &error);
    write_case(&out, file, &file.case).map_err(failed)?;
    let steps = model.plan.n_steps();
    let end = model.plan.targets.len() as f64 * model.plan.frame;
    let dofs = model.body.solid.n_unknowns();
    let run = Motion { fidelity: MODEL, steps, end, dofs };
    let record = MotionRecord::begin(&out, &run).map_err(failed)?;
    let made = Bodies::simulate(&model.body, &model.plan)
        .and_then(|motion| Ok((Bodies::series(&model, &motion)?, motion)));
    let (table, motion) = match made {
        Ok(made) => made,
        Err(error) => {
            let failure = Failure::from(TierError::from(error));
            record.fail(&failure.message).map_err(failed)?;
            return Err(failure);
        }
    };
    let compared = if compares {
        compare(&file.case, ReferenceOf::Run, &|name| table.last(name))
    } else {
        Vec::new()
    };
    Bodies::write_fields(&out, &model, &motion).map_err(failed)?;
    write_whole(&out.join("series.csv"), table.to_csv()).map_err(failed)?;
    write_comparison(&out, &compared)?;
    record.finish(&run).map_err(failed)?;
    print(&compared);
    if compared.is_empty() {
        for (name, value) in table.names.iter().zip(table.rows.last().into_iter().flatten()) {
            say(&format!("{name} = {value:.6e}"));
        }
    }
    say(&format!(
        "{dofs} unknowns, {steps} steps, {} factorisations; written to {}",
        motion.n_factors,
        out.display()
    ));
    Ok(Exit::Done)
}

/// Prints comparisons.
pub fn print(compared: &[Compared]) {
    for one in compared {
        if one.is_within() { say(&one.line()) } else { complain(&one.line()) }
    }
}

/// Writes comparisons beside what is compared.
pub fn write_comparison(out: &Path, compared: &[Compared]) -> Result<(), Failure> {
    let all: Vec<_> = compared.iter().map(Compared::to_json).collect();
    let text = format!("{:#}\n", serde_json::Value::Array(all));
    write_whole(&out.join(LAST), text).map_err(|error| not_written(out, &error))
}
