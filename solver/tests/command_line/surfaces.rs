//! `alewife surface`: what a file of triangles encloses, its faults, and their repair.

use std::fmt::Write;

use super::{alewife, done};

/// A cube of side 2 as text, its triangles from one on turned inside out.
fn cube(turned_from: usize) -> String {
    let bit = |i: usize, axis: usize| 2.0 * f64::from(u8::from(i >> axis & 1 == 1));
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let mut text = "solid cube\n".to_owned();
    for (nth, [a, b, c]) in triangles.enumerate() {
        text += "facet normal 0 0 0\nouter loop\n";
        for i in if nth < turned_from { [a, b, c] } else { [b, a, c] } {
            // Corners that are only nearly the same
            let off = 1e-7 * (nth % 2) as f64;
            writeln!(text, "vertex {} {} {}", bit(i, 0) + off, bit(i, 1), bit(i, 2)).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid cube\n"
}

#[test]
fn a_surface_is_measured_refused_and_repaired() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    std::fs::write(here.join("cube.stl"), cube(7)).unwrap();
    let refused = alewife(here, &["surface", "cube.stl"]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(65), "{said}");
    assert!(said.contains("edges are open") && said.contains("--repair"), "{said}");
    let arguments = ["surface", "cube.stl", "--repair", "whole.stl", "--smooth", "180"];
    let said = done(here, &arguments);
    for told in [
        "0 triangles dropped, 5 turned",
        "triangles    12, vertices 8",
        "area         24",
        "volume       8",
    ] {
        assert!(said.contains(told), "{told}: {said}");
    }
    // Sharp edges are no body by default
    let sharp = alewife(here, &["surface", "whole.stl"]);
    assert_eq!(sharp.status.code(), Some(65));
    assert!(String::from_utf8_lossy(&sharp.stderr).contains("12 edges the surface turns"));
    assert_eq!(alewife(here, &["surface", "other.stl"]).status.code(), Some(66));
    let wrong = alewife(here, &["surface", "cube.stl", "--repair", "whole.obj"]);
    assert_eq!(wrong.status.code(), Some(2));
}
