//! What a soft case means: all mistakes at once, each with its key, its line and a remedy.

mod body;
mod mistakes;
mod motion;
mod searches;

use self::mistakes::Mistakes;
use super::read::SoftFile;
use crate::text::diagnostic::Diagnostic;

/// All that keeps the searches of a soft case from starting at its numbers. Runs of it are not kept.
#[must_use]
pub fn check_starts(file: &SoftFile) -> Vec<Diagnostic> {
    let mut mistakes = Mistakes { file, found: Vec::new() };
    searches::check_starts(&mut mistakes);
    mistakes.found
}

/// All that is wrong in a soft case.
#[must_use]
pub fn check(file: &SoftFile) -> Vec<Diagnostic> {
    let mut mistakes = Mistakes { file, found: Vec::new() };
    if let Some(key) = file.not_a_number() {
        let message = format!("`{key}` is not a finite number");
        mistakes.add(&key, message, "write a finite number; regions may end at inf and -inf");
        return mistakes.found;
    }
    body::check(&mut mistakes);
    motion::check(&mut mistakes);
    if mistakes.found.is_empty() {
        searches::check(&mut mistakes);
    }
    mistakes.found
}
