//! What a case means: all its diagnostics at once, each with its location and a remedy.
//!
//! Reading has made sure of keys and types. `declared` compares every number with what is declared of
//! its key; the other files have what relates keys to each other, and names to what they name. Nothing
//! is meshed or solved.

pub(crate) mod body;
mod command;
mod contact;
mod declared;
mod drive;
mod environment;
mod expressions;
mod extremes;
mod field;
mod findings;
mod flow;
mod general;
mod given;
mod near;
mod optimisation;
mod placement;
mod reduced;
mod references;
mod space;
mod time;
mod units;

pub use self::drive::at_rest;
pub use self::reduced::check_reduced;

use self::body::{bodies, joints, strokes, swimmers};
use self::findings::{Findings, OneOf};
use self::flow::{boundary, cells, fluid, mean_flow, mesh, scalars, tracers};
use crate::{CaseFile, Diagnostic, Geometry, Severity};

/// All diagnostics of a case: errors, which stop a run, and warnings.
#[must_use]
pub fn check(file: &CaseFile) -> Vec<Diagnostic> {
    let mut findings = Findings::new(file);
    extremes::check_numbers(&mut findings, file);
    if !findings.has_no_error() {
        return findings.into_diagnostics();
    }
    // What follows from degrees or milliseconds that are taken for other units is told after them
    units::check(&mut findings, file);
    declared::check(&mut findings);
    general::check(&mut findings);
    fluid::check(&mut findings);
    expressions::check(&mut findings);
    let has_flow = !file.case().is_reduced_only();
    if has_flow {
        boundary::check(&mut findings);
    }
    mean_flow::check(&mut findings);
    bodies::check(&mut findings);
    space::check(&mut findings);
    joints::check(&mut findings);
    swimmers::check(&mut findings);
    field::check(&mut findings);
    contact::check(&mut findings);
    if has_flow {
        mesh::check(&mut findings);
    }
    time::check(&mut findings);
    tracers::check(&mut findings);
    scalars::check(&mut findings);
    references::check(&mut findings);
    reduced::check(&mut findings);
    optimisation::check(&mut findings, file);
    reduced::calibration::check(&mut findings, file);
    environment::check(&mut findings, file);
    extremes::check(&mut findings, file);
    if has_flow && findings.has_no_error() {
        cells::check(&mut findings);
    }
    if has_flow && findings.has_no_error() {
        placement::check(&mut findings);
    }
    if has_flow && findings.has_no_error() {
        given::check(&mut findings);
    }
    let in_plane = file.model.case.geometry != Geometry::Spatial;
    if has_flow && in_plane && findings.has_no_error() {
        strokes::check(&mut findings);
        near::check(&mut findings);
    }
    findings.into_diagnostics()
}

/// All that keeps the searches of a case, `optimise` and `calibrate`, from starting at its numbers. Runs of it are not kept.
#[must_use]
pub fn check_starts(file: &CaseFile) -> Vec<Diagnostic> {
    let mut findings = Findings::new(file);
    optimisation::check_starts(&mut findings, &file.sought());
    optimisation::check_starts(&mut findings, &file.fitted_numbers());
    reduced::calibration::check_starts(&mut findings);
    findings.into_diagnostics()
}

/// All that keeps a case from being run by the full solver, whose tables a case with `[reduced]` may leave out.
#[must_use]
pub fn check_flow(file: &CaseFile) -> Vec<Diagnostic> {
    let missing = |name: &&'static str| Diagnostic {
        severity: Severity::Error,
        key: (*name).to_owned(),
        message: format!("`{name}` is missing, and the full solver needs it"),
        help: format!(
            "add [{name}], or have the reduced model run: alewife run CASE --fidelity reduced"
        ),
        location: file.location(""),
    };
    file.case().left_out.iter().map(missing).collect()
}
