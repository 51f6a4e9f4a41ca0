//! Problems of expressions that are one number: of what they are not known of, and places and times in them.

use crate::rules::Findings;
use crate::spec::formula::mistake_in_name;
use crate::{Definitions, Formula};

/// Whether an expression is understood, and has no place and no time in it.
pub fn check_constant(findings: &mut Findings<'_>, key: &str, text: &str, known: &Definitions) {
    // A name that nothing can have is reported where it is given, and is none to be offered
    let is_wrong = |name: &&String| mistake_in_name(name).is_some();
    if known.keys().any(|name| is_wrong(&name) && text.contains(name.as_str())) {
        return;
    }
    let names = known.keys().filter(|name| !is_wrong(name)).cloned();
    let names = || names.clone().collect::<Vec<_>>().join(", ");
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
