//! `plot`: series as text.

use super::{alewife, done};

#[test]
fn series_are_drawn_as_text_and_a_wrong_name_is_told_the_nearest() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    std::fs::create_dir(&run).unwrap();
    // The last row is being written
    std::fs::write(run.join("series.csv"), "time,a.speed,a.load\n0,1,NaN\n1,2,NaN\n2,3,NaN\n3,9")
        .unwrap();
    let text = done(directory.path(), &["plot", "run", "a.speed", "a.load", "--width", "40"]);
    assert!(text.contains("a.speed\n") && text.contains("last 3, 3 values"), "{text}");
    assert!(text.ends_with("a.load\n  no value yet\n"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 40), "{text}");
    let wrong = alewife(directory.path(), &["plot", "run", "a.sped"]);
    let stderr = String::from_utf8_lossy(&wrong.stderr);
    assert!(wrong.status.code() == Some(2) && stderr.contains("nearest are `a.speed`"), "{stderr}");
    let nowhere = alewife(directory.path(), &["plot", "nowhere", "a.speed"]);
    assert_eq!(nowhere.status.code(), Some(66));
    // A row of other values than the header names is no row that is being written
    std::fs::write(run.join("series.csv"), "time,a.speed\n0,1\n1\n2,3\n").unwrap();
    let damaged = alewife(directory.path(), &["plot", "run", "a.speed"]);
    let stderr = String::from_utf8_lossy(&damaged.stderr);
    assert_eq!(damaged.status.code(), Some(74), "{stderr}");
    assert!(stderr.contains("line 3 is damaged: 1 values, where the header names 2"), "{stderr}");
}
