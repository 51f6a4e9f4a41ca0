//! Problems of expressions that are one number: of what they are not known of, and places and times in them.

use crate::rules::Findings;
use crate::{Definitions, Formula};

/// Whether an expression is understood, and has no place and no time in it.
pub fn check_constant(findings: &mut Findings<'_>, key: &str, text: &str, known: &Definitions) {
    let names = || known.keys().cloned().collect::<Vec<_>>().join(", ");
    match Formula::Expression(text.to_owned()).parsed(known, 2) {
        Err(error) => findings.error(
            key,
            format!("\"{text}\" at character {}: {}", error.column, error.found),
            &error.accepted,
        ),
        Ok(parsed) if !parsed.is_constant() => findings.error(
            key,
            format!("\"{text}\" has a place or a time in it, and there is one number only"),
            &format!("write an expression of {}", names()),
        ),
        Ok(_) => {}
    }
}
