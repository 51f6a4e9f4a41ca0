//! What is in a file that a case names.

use std::fs;

use super::CaseFile;
use super::library::{self, Beside};
use crate::text::setting;

impl CaseFile {
    /// What is in a file that is named at a key: beside the file in which it is written, or, of a shipped case, among
    /// those shipped with it, else in the folder in which the program is called.
    ///
    /// # Errors
    /// Why it cannot be read, with its path.
    pub fn bytes_beside(&self, key: &str, file: &str) -> Result<Vec<u8>, String> {
        let of_key = self.root.get(key).map(|node| &node.origin.source);
        // What the command line sets is as if the case had it
        let source =
            of_key.filter(|one| one.name != setting::NAME).unwrap_or(&self.root.origin.source);
        match library::beside(source, file) {
            Some(Beside::Shipped(bytes)) => Ok(bytes.to_vec()),
            Some(Beside::OnDisk(path)) => {
                fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
            }
            None => Err(format!("{file}: it is not in this folder")),
        }
    }
}
