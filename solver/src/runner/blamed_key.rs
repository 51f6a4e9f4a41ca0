//! The key of a case that is to blame for a failure: of a mesh that is too large, or of an expression without a value.

use super::failure::Failure;
use crate::case::{CaseFile, Diagnostic, Severity};
use crate::run::RunError;

/// Growth of cells below which it is likely what makes a mesh large: half of what it is by default.
const SLOW_GROWTH: f64 = 0.1;

/// The failure of a run or of its mesh, with the place in the case where that is to blame.
pub fn with_key(file: &CaseFile, error: RunError) -> Failure {
    match &error {
        RunError::NotFinite { found, .. } => {
            let help = "write an expression that is finite there and then, such as with max(x, 0) below a root";
            at(file, &found.key, &error, help.to_owned())
        }
        RunError::TooLarge { .. } | RunError::TooManyCells { .. } => too_large(file, &error),
        _ => error.into(),
    }
}

/// A failure by a key of a case.
fn at(file: &CaseFile, key: &str, error: &RunError, help: String) -> Failure {
    let diagnostic = Diagnostic {
        severity: Severity::Error,
        key: key.to_owned(),
        message: error.to_string(),
        help,
        location: file.location(key),
    };
    Failure::wrong(&[diagnostic])
}

fn too_large(file: &CaseFile, error: &RunError) -> Failure {
    let mesh = &file.case().mesh;
    let (key, value) = if mesh.scale < 1.0 {
        ("mesh.scale", mesh.scale)
    } else if mesh.growth < SLOW_GROWTH {
        ("mesh.growth", mesh.growth)
    } else {
        ("mesh.size", mesh.size)
    };
    at(file, key, error, format!("the first to look at is `{key}` = {value}"))
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
            with_key(&file, error).message
        };
        let growth = reported(&["mesh.growth=0.01"]);
        assert!(growth.contains("look at is `mesh.growth` = 0.01"), "{growth}");
        assert!(growth.contains("--> --set:1:") && growth.contains("37 GB"), "{growth}");
        let both = reported(&["mesh.growth=0.01", "mesh.scale=0.1"]);
        assert!(both.contains("`mesh.scale` = 0.1"), "{both}");
        assert!(reported(&[]).contains("`mesh.size` = "), "{}", reported(&[]));
    }
}
