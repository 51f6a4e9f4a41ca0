//! Whether the directory of a point holds the run of another case.

use std::path::Path;

use super::case_hash::hash_of;
use super::failure::PointFailure;
use super::plan::Plan;

/// Code of a point whose directory holds the run of another case: that of a wrong case.
const BAD_CASE: u8 = 65;

/// What is wrong where the directory of a point holds the run of another case; nothing where it does not, or no
/// run, or the plan was written before checksums were.
#[must_use]
pub fn misplaced(plan: &Plan, run: &Path, index: usize) -> Option<PointFailure> {
    let wanted = plan.cases.get(index).filter(|hash| !hash.is_empty())?;
    let text = std::fs::read_to_string(run.join("case.toml")).ok()?;
    let found = hash_of(&text);
    if found.as_ref() == Some(wanted) {
        return None;
    }
    let whose = match plan.cases.iter().position(|hash| Some(hash) == found.as_ref()) {
        Some(other) => format!("that of point {}", other + 1),
        None => "of no point of this sweep".to_owned(),
    };
    let reason = format!(
        "{} holds the run of another case, {whose}: put it back, or move it away and run the \
         sweep again",
        run.display()
    );
    Some(PointFailure { is_of_another_case: true, ..PointFailure::new(Some(BAD_CASE), reason) })
}
