//! `DataSpec`: files that do not come with a case.

use serde::{Deserialize, Serialize};

/// `[data]`: files that a case names and that do not come with it, such as records of others. Where one is not there, the
/// case is refused by a message that says where it is from, and left out of a validation of several.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DataSpec {
    /// Their paths, relative to the file in which they are written; of a shipped case to the folder in which the program
    /// is called. Runs and searches write what was in them, and none of these names.
    pub files: Vec<String>,
    /// Where they are from, and how they are to be had.
    pub source: String,
}
