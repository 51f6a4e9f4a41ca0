//! A domain that is a mesh in a file: where it is found, what is known of it, what is refused.
#![expect(clippy::unwrap_used, reason = "a test that cannot write its files has failed")]

use std::fs;
use std::path::Path;

use alewife_case::{Case, Severity, check};

const MESHES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../mesh/tests/msh/data");

const CASE: &str = r#"
title = "a channel"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.mesh.file = "../meshes/a.msh"
boundary = { inlet = { parabolic = { peak = 1.0 } }, outlet = "do-nothing", wall = "no-slip" }
mesh = { size = 0.5 }
time = { steady = {} }
"#;

/// A directory with the case in one folder and a mesh in another.
fn directory(mesh: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    for folder in ["cases", "meshes"] {
        fs::create_dir(directory.path().join(folder)).unwrap();
    }
    fs::copy(format!("{MESHES}/{mesh}.msh"), directory.path().join("meshes/a.msh")).unwrap();
    fs::write(directory.path().join("cases/channel.toml"), CASE).unwrap();
    directory
}

fn read(directory: &Path, settings: &[&str]) -> Result<Case, String> {
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    let path = directory.join("cases/channel.toml");
    match Case::read(path.to_str().unwrap(), &settings) {
        Err(error) => Err(error.to_string()),
        Ok(file) => {
            let found = check(&file);
            let mut errors = found.iter().filter(|found| found.severity == Severity::Error);
            match errors.next() {
                Some(error) => Err(format!("{}: {} {}", error.key, error.message, error.help)),
                None => Ok(file.model.case),
            }
        }
    }
}

#[test]
fn physical_names_are_sides() {
    let directory = directory("square-1-text");
    let case = read(directory.path(), &[]).unwrap();
    assert_eq!(case.sides(), ["inlet", "outlet", "wall"]);
    assert_eq!(case.extent().lengths(), [2.0, 1.0, 0.0]);
    let scaled = read(directory.path(), &["domain.mesh.scale=0.1"]).unwrap();
    assert!((scaled.given_mesh().unwrap().measure() - 0.02).abs() < 1e-15);
    assert!(scaled != case);
}

/// Wherever the file is: the problem is the same as long as its content is.
#[test]
fn a_file_is_known_by_its_content() {
    let directory = directory("square-1-text");
    let case = read(directory.path(), &[]).unwrap();
    let mesh = directory.path().join("meshes/a.msh");
    let moved = directory.path().join("b.msh");
    fs::copy(&mesh, &moved).unwrap();
    let file = format!("domain.mesh.file={}", moved.display());
    let other = read(directory.path(), &[&file]).unwrap();
    assert_eq!(other.problem_keys().unwrap(), case.problem_keys().unwrap());
    assert!(other == case);
    // What a run writes is read again, but for another content
    let checksum = case.given_mesh().unwrap().checksum.clone().unwrap();
    let checksum = format!("domain.mesh.checksum='{checksum}'");
    assert!(read(directory.path(), &[&checksum]).is_ok());
    fs::copy(format!("{MESHES}/square-2-binary.msh"), &mesh).unwrap();
    let changed = read(directory.path(), &[]).unwrap();
    assert!(changed.problem_keys().unwrap() != case.problem_keys().unwrap() && changed != case);
    let error = read(directory.path(), &[&checksum]).unwrap_err();
    assert!(error.contains("has the checksum crc32:"), "{error}");
}

#[test]
fn what_cannot_be_is_refused() {
    let directory = directory("square-1-text");
    let refused = |setting: &str, words: &[&str]| {
        let error = read(directory.path(), &[setting]).unwrap_err();
        for word in words {
            assert!(error.contains(word), "{error}");
        }
    };
    refused("domain.mesh.file=no.msh", &["no.msh", "relative to the file"]);
    refused("domain.mesh.file=/dev/null", &["is no file"]);
    refused("domain.mesh.scale=0", &["`domain.mesh.scale` is 0", "above 0"]);
    refused("geometry=spatial", &["no tetrahedra"]);
    refused("geometry=axisymmetric", &["a mesh cannot stand", "half-disc, cylinder"]);
    refused("boundary.wall='symmetry'", &["boundary.wall", "`symmetry` holds on flat sides"]);
    refused(
        "boundary.wall={ parabolic = { peak = 1.0 } }",
        &["`wall` is not straight", "expressions"],
    );
    refused(
        "boundary.wall={ periodic = 'inlet' }",
        &["`wall` is periodic with `inlet`, which has another condition", "wall"],
    );
    refused("boundary.wall={ periodic = 'exit' }", &["no such side", "inlet, outlet, wall"]);
    refused("boundary.outlet='no-slip'", &["net inflow 0.666667 m2/s"]);
    refused("boundary.exit='no-slip'", &["no side `exit`", "inlet, outlet, wall"]);
    let body =
        "body=[{ name = 'b', shape.disc.radius = 0.1, center = [1.0, 0.5], motion = 'held' }]";
    refused(body, &["body.0.shape: \"b\" cannot be put into a mesh", "shape.side"]);
    let hole = |keys: &str| format!("body=[{{ name = 'b', motion = 'held', {keys} }}]");
    refused(
        &hole("shape.side = 'wall'"),
        &["`wall` does not run around one hole", "physical name of its own"],
    );
    refused(&hole("shape.side = 'outlt'"), &["no side `outlt`", "`outlet`"]);
    refused(&hole("shape.disc.radius = 0.1"), &["center"]);
    assert!(read(directory.path(), &["boundary.inlet='symmetry'"]).is_ok());
    let text = fs::read_to_string(directory.path().join("meshes/a.msh")).unwrap();
    fs::write(directory.path().join("meshes/a.msh"), text.replace("4.1 0 8", "3.0 0 8")).unwrap();
    let error = read(directory.path(), &[]).unwrap_err();
    assert!(error.contains("a.msh, line 2: version 3.0"), "{error}");
    fs::copy(directory.path().join("meshes/a.msh"), directory.path().join("meshes/a.med")).unwrap();
    fs::write(directory.path().join("meshes/a.med"), "\u{89}HDF").unwrap();
    let path = directory.path().join("meshes/a.med");
    let setting = format!("domain.mesh.file={}", path.display());
    let other = read(directory.path(), &[&setting]).unwrap_err();
    assert!(
        other.contains("a file of Salome") && other.contains("alewife-post convert"),
        "{other}"
    );
    assert!(other.contains("meshes/a.med ") && other.contains("meshes/a.msh`"), "{other}");
    assert!(
        error.contains("channel.toml:5:20") && error.contains("MSH 2.2, 4.0 and 4.1 are read"),
        "{error}"
    );
}
