//! `Known`: what is known of a run from its texts, which its other files have to agree with.

use crate::case::Case;
use crate::observer::{Provenance, RunState, Status};
use crate::run::Series;

/// What is known of a run from its texts.
pub struct Known {
    /// Its case.
    pub case: Option<Case>,
    /// Where it stands.
    pub status: Option<Status>,
    /// Its legs.
    pub provenance: Option<Provenance>,
    /// Its series, where it writes one.
    pub series: Option<Series>,
    /// Whether a process writes to it: what it adds meanwhile is not wrong.
    pub is_under_way: bool,
}

impl Known {
    /// Whether it came to its end, and nothing is added.
    pub fn is_finished(&self) -> bool {
        let state = self.status.as_ref().map(|status| status.state);
        !self.is_under_way && state == Some(RunState::Finished)
    }

    /// Whether a checksum is that of the case of one of its legs.
    pub fn is_of_a_leg(&self, hash: &str) -> bool {
        let provenance = self.provenance.as_ref();
        provenance.is_none_or(|found| found.legs.iter().any(|leg| leg.origin.case_hash == hash))
    }
}
