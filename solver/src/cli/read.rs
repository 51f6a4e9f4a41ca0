//! Reading of the case a command names, with the keys set on the command line.

use clap::Args;

use super::complete;
use super::exit::{Exit, Failure};
use super::style::{self, complain};
use crate::case::soft::SoftFile;
use crate::case::{CaseFile, Diagnostic, Severity, at_rest, check, check_flow};

/// Keys set on the command line.
#[derive(Debug, Clone, Args)]
pub struct Settings {
    /// Set a key of the case, such as mesh.scale=0.5 or body.0.gait.squirmer.modes.1=3; may be
    /// repeated
    #[arg(long = "set", value_name = "KEY=VALUE", add = complete::key())]
    pub set: Vec<String>,
}

/// Reads a case and refuses it if it is wrong; warnings are reported and let through.
pub fn read_case(argument: &str, settings: &[String]) -> Result<CaseFile, Failure> {
    let CheckedCase { file, warnings } = read_for_flow(argument, settings)?;
    print_warnings(&warnings);
    Ok(file)
}

/// The same with its warnings handed back; a case that only its reduced model can be run of is refused.
pub fn read_for_flow(argument: &str, settings: &[String]) -> Result<CheckedCase, Failure> {
    let checked = read_and_check(argument, settings)?;
    let missing = check_flow(&checked.file);
    if missing.is_empty() { Ok(checked) } else { Err(Failure::wrong(&missing)) }
}

/// Refuses a case without rigid bodies and without a flow, with what is done with it.
pub fn refuse_soft(argument: &str, settings: &[String]) -> Result<(), Failure> {
    if SoftFile::read_if_soft(argument, settings)?.is_none() {
        return Ok(());
    }
    let message = format!(
        "{argument} is a soft case, an elastic body without a flow: use run --fidelity soft, sweep, check, \
         show, mesh, calibrate, optimise or loop"
    );
    Err(Failure::new(Exit::BadCase, message))
}

/// Prints what is odd in a case.
pub fn print_warnings(warnings: &[Diagnostic]) {
    if !warnings.is_empty() {
        complain(&style::diagnostics(warnings));
    }
}

/// What keeps something else than a run from being made.
pub fn as_warnings(errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let warning = |one| Diagnostic { severity: Severity::Warning, ..one };
    errors.into_iter().map(warning).collect()
}

/// A case without errors.
pub struct CheckedCase {
    /// The case.
    pub file: CaseFile,
    /// What is odd in it.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a case and refuses it if it is wrong; warnings are handed back.
pub fn read_and_check(argument: &str, settings: &[String]) -> Result<CheckedCase, Failure> {
    refuse_soft(argument, settings)?;
    let file = crate::case::Case::read(argument, settings)?;
    let mut warnings = check(&file);
    if warnings.iter().any(|one| one.severity == Severity::Error) {
        return Err(Failure::wrong(&warnings));
    }
    warnings.extend(at_rest(&file));
    Ok(CheckedCase { file, warnings })
}
