//! A mesh that does not fit into memory, by the key of the case that asks for it.

use super::failure::Failure;
use crate::case::{CaseFile, Diagnostic, Severity};
use crate::run::RunError;

/// Growth of cells below which it is likely what makes a mesh large: half of what it is by default.
const SLOW_GROWTH: f64 = 0.1;

/// The failure of a run or of its mesh, with the place in the case where that is to blame.
pub fn too_large(file: &CaseFile, error: RunError) -> Failure {
    if !matches!(error, RunError::TooLarge { .. } | RunError::TooManyCells { .. }) {
        return error.into();
    }
    let mesh = &file.case().mesh;
    let (key, value) = if mesh.scale < 1.0 {
        ("mesh.scale", mesh.scale)
    } else if mesh.growth < SLOW_GROWTH {
        ("mesh.growth", mesh.growth)
    } else {
        ("mesh.size", mesh.size)
    };
    let diagnostic = Diagnostic {
        severity: Severity::Error,
        key: key.to_owned(),
        message: error.to_string(),
        help: format!("the first to look at is `{key}` = {value}"),
        location: file.location(key),
    };
    Failure::wrong(&[diagnostic])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    #[test]
    fn the_key_that_makes_a_mesh_large_is_pointed_at() {
        let reported = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
            let file = Case::read("three-disc-2d", &settings).unwrap();
            let error = RunError::TooLarge { n_dofs: 10, needed: 37.0, available: 8.0 };
            too_large(&file, error).message
        };
        let growth = reported(&["mesh.growth=0.01"]);
        assert!(growth.contains("look at is `mesh.growth` = 0.01"), "{growth}");
        assert!(growth.contains("--> --set:1:") && growth.contains("37 GB"), "{growth}");
        let both = reported(&["mesh.growth=0.01", "mesh.scale=0.1"]);
        assert!(both.contains("`mesh.scale` = 0.1"), "{both}");
        assert!(reported(&[]).contains("`mesh.size` = "), "{}", reported(&[]));
    }
}
