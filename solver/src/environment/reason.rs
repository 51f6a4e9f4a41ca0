//! `Reason`: why an episode is over.

/// Why an episode is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// It is not.
    Goes,
    /// The case has come to its end.
    End,
    /// The motion blows up, or a step fails.
    Failure,
    /// An observation or the reward is no finite number.
    NotFinite,
    /// A condition of `terminate`, by its number.
    Terminated(usize),
    /// A condition of `truncate`, by its number.
    Truncated(usize),
}

impl Reason {
    /// A number for it: 0 while the episode goes on, 1 at the end of the case, 2 and 3 for failures, then all
    /// conditions of `terminate` and those of `truncate`.
    #[must_use]
    pub fn code(self, n_terminate: usize) -> usize {
        match self {
            Self::Goes => 0,
            Self::End => 1,
            Self::Failure => 2,
            Self::NotFinite => 3,
            Self::Terminated(nth) => 4 + nth,
            Self::Truncated(nth) => 4 + n_terminate + nth,
        }
    }

    /// Whether the episode is over by what the task is.
    #[must_use]
    pub fn terminates(self) -> bool {
        matches!(self, Self::Terminated(_))
    }

    /// Whether it is broken off.
    #[must_use]
    pub fn truncates(self) -> bool {
        !matches!(self, Self::Goes | Self::Terminated(_))
    }
}
