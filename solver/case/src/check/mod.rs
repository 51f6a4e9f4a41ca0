//! What a case means: all its diagnostics at once, each with its location and a remedy.
//!
//! Reading has made sure of keys and types. Here every number is compared with what it stands for,
//! and every name against what it names. Nothing is meshed or solved.

mod angles;
mod bodies;
mod boundary;
mod cells;
mod contact;
mod extremes;
mod findings;
mod fluid;
mod gait;
mod general;
mod given;
mod given_mesh;
mod joints;
mod joints_in_space;
mod mean_flow;
mod mesh;
mod near;
mod placement;
mod references;
mod skin;
mod solid;
mod space;
mod spring;
mod strokes;
mod swimmers;
mod time;

use super::diagnostic::Diagnostic;
use super::domain::Geometry;
use super::read::CaseFile;

use findings::Findings;

/// All diagnostics of a case: errors, which stop a run, and warnings.
#[must_use]
pub fn check(file: &CaseFile) -> Vec<Diagnostic> {
    let mut findings = Findings::new(file);
    extremes::check_numbers(&mut findings, file);
    if !findings.has_no_error() {
        return findings.into_diagnostics();
    }
    // What follows from degrees that are taken for radians is told after them
    angles::check(&mut findings, file);
    general::check(&mut findings);
    fluid::check(&mut findings);
    boundary::check(&mut findings);
    mean_flow::check(&mut findings);
    bodies::check(&mut findings);
    space::check(&mut findings);
    joints::check(&mut findings);
    swimmers::check(&mut findings);
    contact::check(&mut findings);
    mesh::check(&mut findings);
    time::check(&mut findings);
    references::check(&mut findings);
    extremes::check(&mut findings, file);
    if findings.has_no_error() {
        cells::check(&mut findings);
    }
    if findings.has_no_error() {
        placement::check(&mut findings);
    }
    if findings.has_no_error() {
        given::check(&mut findings);
    }
    let in_plane = file.model.case.geometry != Geometry::Spatial;
    if in_plane && findings.has_no_error() {
        strokes::check(&mut findings);
        near::check(&mut findings);
    }
    findings.into_diagnostics()
}
