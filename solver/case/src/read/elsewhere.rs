//! Whether a case has files that do not come with it and are not there.

use super::UntypedCase;
use super::case_text::{Located, locate};
use super::files::data_files;
use crate::text::diagnostic::{CaseError, Diagnostic};

/// What is wrong where a case, as it would be read, has files that do not come with it and are not there. None also where
/// the case cannot be put together.
#[must_use]
pub fn data_elsewhere(argument: &str) -> Option<Diagnostic> {
    let Located { text, variant } = locate(argument).ok()?;
    let mut untyped = UntypedCase::assemble(&text, variant, &[]).ok()?;
    match data_files::resolve(&mut untyped.root) {
        Err(CaseError::Elsewhere(what)) => Some(what),
        _ => None,
    }
}
