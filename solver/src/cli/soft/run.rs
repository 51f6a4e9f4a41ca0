//! `run --fidelity soft`: the motion of a soft case, its series and its fields.

use std::path::{Path, PathBuf};

use alewife_reduced::search::write_whole;
use alewife_reduced::tier::{
    Bodies, Compared, Model, SolidOf, compare, series, write_case, write_fields,
};

use super::directory::{not_written, prepare};
use crate::case::soft::SoftFile;
use crate::case::soft::spec::ReferenceOf;
use crate::cli::exit::{Exit, Failure};
use crate::cli::style::{complain, say};

/// The file that is written last.
const LAST: &str = "comparison.json";

/// Where a run goes.
#[derive(Debug, Clone)]
pub struct Place {
    /// Its directory; `runs/<case>` if absent.
    pub out: Option<PathBuf>,
    /// Whether one that is there is replaced.
    pub overwrite: bool,
    /// Whether references are compared with.
    pub compares: bool,
}

/// Runs a soft case.
pub fn run(file: &SoftFile, place: &Place) -> Result<Exit, Failure> {
    match file.case.geometry.dimensions() {
        2 => moved::<2>(file, place),
        _ => moved::<3>(file, place),
    }
}

fn moved<const D: usize>(file: &SoftFile, place: &Place) -> Result<Exit, Failure>
where
    Bodies: SolidOf<D>,
{
    let default = || Path::new("runs").join(&file.name);
    let out = place.out.clone().unwrap_or_else(default);
    let model = Model::<D>::new(file)?;
    let _held = prepare(&out, [LAST, "vtu"], place.overwrite)?;
    let motion = Bodies::simulate(&model.body, &model.plan)
        .map_err(alewife_reduced::tier::TierError::from)?;
    let table = series(&model, &motion).map_err(alewife_reduced::tier::TierError::from)?;
    let compared = if place.compares {
        compare(&file.case, ReferenceOf::Run, &|name| table.last(name))
    } else {
        Vec::new()
    };
    let failed = |error: std::io::Error| not_written(&out, &error);
    write_case(&out, file, &file.case).map_err(failed)?;
    write_fields(&out, &model, &motion).map_err(failed)?;
    write_whole(&out.join("series.csv"), table.to_csv()).map_err(failed)?;
    write_comparison(&out, &compared)?;
    print(&compared);
    if compared.is_empty() {
        for (name, value) in table.names.iter().zip(table.rows.last().into_iter().flatten()) {
            say(&format!("{name} = {value:.6e}"));
        }
    }
    say(&format!(
        "{} unknowns, {} steps, {} factorisations; written to {}",
        model.body.solid.n_unknowns(),
        model.plan.n_steps(),
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
