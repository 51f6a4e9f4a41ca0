//! Which runs are compared: the cases and variants that have references.

use std::cell::Cell;

use super::super::exit::Failure;
use super::super::read::{CheckedCase, read_for_flow};
use super::super::style::complain;
use crate::case::{Case, CaseFile, Diagnostic, data_elsewhere};

/// A case or a variant that is to be validated.
pub struct Member {
    /// Its name as it was asked for.
    pub name: String,
    /// The case.
    pub file: CaseFile,
}

/// What is left out of a validation.
#[derive(Default)]
pub struct LeftOut(Cell<bool>);

impl LeftOut {
    /// Whether a case has data that does not come with it and is not there: then it is left out, which is said.
    pub fn takes(&self, name: &str) -> bool {
        let Some(Diagnostic { message, help, .. }) = data_elsewhere(name) else { return false };
        complain(&format!("{name} is left out: {message}; {help}"));
        self.0.set(true);
        true
    }

    /// Whether there was any.
    pub fn any(&self) -> bool {
        self.0.get()
    }
}

/// The members of all these cases, each of them read and checked.
///
/// # Errors
/// With all that is wrong in any of them.
pub fn all_members(
    names: &[String],
    only_quick: bool,
    left_out: &LeftOut,
    is_to_end: &dyn Fn() -> Result<(), Failure>,
) -> Result<Vec<Member>, Failure> {
    let (mut members, mut failures) = (Vec::new(), Vec::new());
    for name in names {
        is_to_end()?;
        match members_of(name, only_quick) {
            Ok(found) => {
                for name in found.into_iter().filter(|name| !left_out.takes(name)) {
                    match read_for_flow(&name, &[]) {
                        Ok(CheckedCase { file, .. }) => members.push(Member { name, file }),
                        Err(failure) => failures.push(failure.of(&name)),
                    }
                }
            }
            Err(failure) => failures.push(failure.of(name)),
        }
    }
    Failure::all(failures).map_or(Ok(members), Err)
}

/// The case and its variants that have something to be compared with.
pub fn members_of(name: &str, only_quick: bool) -> Result<Vec<String>, Failure> {
    let file = Case::read(name, &[])?;
    let mut members = Vec::new();
    if !file.case().reference.is_empty() && (file.case().quick || !only_quick) {
        members.push(name.to_owned());
    }
    for variant in &file.case().variant {
        let has_reference = !(variant.reference.is_empty() && file.case().reference.is_empty());
        if has_reference && (variant.quick || !only_quick) {
            members.push(format!("{name}/{}", variant.name));
        }
    }
    Ok(members)
}
