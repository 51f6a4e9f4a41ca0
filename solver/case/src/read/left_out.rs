//! Tables that only the full solver needs, which a case with `[reduced]` may leave out.

use std::sync::Arc;

use crate::Case;
use crate::text::source::Source;
use crate::text::tree::{self, TomlNode, TreeError};

/// What stands for a domain and a mesh; nothing is made of them.
const PLANAR: &str = "domain.box = { min = [-1e6, -1e6], max = [1e6, 1e6] }\nmesh.size = 1e5\n";

/// The same in space.
const SPATIAL: &str =
    "domain.box = { min = [-1e6, -1e6, -1e6], max = [1e6, 1e6, 1e6] }\nmesh.size = 1e5\n";

/// Tables that may be left out.
const TABLES: [&str; 2] = ["domain", "mesh"];

/// The tree with what it leaves out, and the names of that.
///
/// # Errors
/// None that a user can make.
pub fn completed(root: &TomlNode) -> Result<(TomlNode, Vec<&'static str>), TreeError> {
    let mut root = root.clone();
    let mut left_out = Vec::new();
    if root.get("reduced").is_none_or(|reduced| reduced.table().is_none()) {
        return Ok((root, left_out));
    }
    let is_spatial = root.get("geometry").and_then(TomlNode::text) == Some("spatial");
    let text = if is_spatial { SPATIAL } else { PLANAR };
    let source =
        Source { name: "what is left out".to_owned(), directory: None, text: text.to_owned() };
    let stand_in = tree::parse(&Arc::new(source))?;
    for name in TABLES {
        if root.get(name).is_some() {
            continue;
        }
        if let (Some(node), Some(entries)) = (stand_in.get(name), root.table_mut()) {
            entries.insert(name.to_owned(), node.clone());
            left_out.push(name);
        }
    }
    Ok((root, left_out))
}

impl Case {
    /// Whether it has no region or no mesh, so that only its reduced model can be run.
    #[must_use]
    pub fn is_reduced_only(&self) -> bool {
        !self.left_out.is_empty()
    }
}
