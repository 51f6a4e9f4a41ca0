//! Numbers that look as if they were in other units than those of the case.

mod angles;
mod clock;
mod column;
mod lengths;
#[cfg(test)]
mod tests;

use super::Findings;
use crate::CaseFile;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    angles::check(findings, file);
    clock::check(findings, file);
    lengths::check(findings, file);
}
