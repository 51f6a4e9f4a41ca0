//! The shipped soft cases against their references.

use std::path::PathBuf;

use alewife_case::soft::SoftFile;
use alewife_reduced::tier::{Job, Which};
use tempfile::TempDir;

/// A shipped case, by its folder.
fn shipped(name: &str) -> SoftFile {
    let case = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    SoftFile::read(&case.display().to_string(), &[]).expect("it is a soft case")
}

#[test]
#[ignore = "long: 15 s; small: a_calibration_finds_the_number_of_the_model_that_made_the_record"]
fn the_calibration_of_the_starfish_meets_its_references() {
    let out = TempDir::new().expect("there is room");
    let file = shipped("starfish-twin");
    let job = Job::<3>::new(&file, Which::Calibration).expect("it is a search");
    let found = job.seek(out.path(), &mut |_| ()).expect("it searches");
    println!("{}", found.text(Which::Calibration));
    assert!(found.compared.len() >= 2);
    for one in &found.compared {
        assert!(one.is_within(), "{}", one.line());
    }
}
