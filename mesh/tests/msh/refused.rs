//! Files that are refused, each with the place and what would be accepted.

use alewife_mesh::Place;

use super::{BOX_TEXT, SQUARE_TEXT, refusal};

/// The unit square in two triangles, as Gmsh would write it.
pub const TWO_TRIANGLES: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
1 1 \"wall\"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 1 1 0 1 1 0
1 0 0 0 1 1 0 0 1 1
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
2 6 1 6
1 1 1 4
1 1 2
2 2 3
3 3 4
4 4 1
2 1 2 2
5 1 2 3
6 1 3 4
$EndElements
";

#[track_caller]
fn check(text: &str, place: Place, words: &[&str]) {
    assert_ne!(text, TWO_TRIANGLES);
    let error = refusal::<2>(text.as_bytes());
    let message = error.to_string();
    assert_eq!(error.place, place, "{message}");
    for word in words {
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn other_files_are_refused() {
    let with = |from: &str, to: &str| TWO_TRIANGLES.replacen(from, to, 1);
    check(&with("4.1 0 8", "3.0 0 8"), Place::Line(2), &["version 3.0", "MSH 2.2, 4.0 and 4.1"]);
    check(&with("4.1 0 8", "4.1 0 4"), Place::Line(2), &["8 bytes"]);
    check("solid cube\nfacet", Place::Line(1), &["$MeshFormat"]);
    check("", Place::Line(1), &["$MeshFormat"]);
    check(
        &with("2 1 2 2\n5", "2 1 3 2\n5"),
        Place::Line(32),
        &["type 3: quadrangles", "without Recombine", "alewife-post convert"],
    );
    check(&with("2 1 2 2\n5", "2 1 2 2000\n5"), Place::Line(32), &["2000 elements", "cut off"]);
    check(&with("5 1 2 3", "5 1 2 33"), Place::Line(33), &["node 33", "$Nodes"]);
    check(&with("5 1 2 3", "5 1 x 3"), Place::Line(33), &["`x`", "a number"]);
    check(&with("1 0 0\n1 1 0\n", "1 0 0\n1 nan 0\n"), Place::Line(22), &["NaN", "finite"]);
    check(&with("$EndNodes", "$EndElements"), Place::Line(24), &["$EndNodes is expected"]);
    check(
        &with("$EndMeshFormat\n", "$EndMeshFormat\n$PartitionedEntities\n"),
        Place::Line(4),
        &["partitions"],
    );
    check(&with("$Elements", "$Other"), Place::Line(26), &["$Other"]);
    check(&with("4\n0 0 0", "3\n0 0 0"), Place::Line(23), &["second node 3"]);
}

#[test]
fn other_meshes_are_refused() {
    let with = |from: &str, to: &str| TWO_TRIANGLES.replacen(from, to, 1);
    let mesh = Place::Mesh;
    check(
        &with("1 1 0 1 1 0\n1 0", "1 1 0 0 0\n1 0"),
        mesh,
        &["4 facets", "without a name", "at (0.5"],
    );
    check(
        &with("1 1 0 1 1 0\n1 0", "1 1 0 2 1 2 0\n1 0"),
        mesh,
        &["curve 1 is in 2 physical groups"],
    );
    // An edge inside is no side, and the one that it stands for has no name then
    check(&with("4 4 1\n2 1", "4 1 3\n2 1"), mesh, &["one facet", "without a name"]);
    check(&with("1 0 0\n1 1 0\n", "1 0 0\n2 0 0\n"), mesh, &["element 5", "no area"]);
    check(
        &with("0 1 0\n$End", "0 1 0.5\n$End"),
        mesh,
        &["node 4 has z = 5e-1", "plane of equal z"],
    );
    let three = with("2 6 1 6", "2 7 1 7")
        .replacen("2 1 2 2\n", "2 1 2 3\n7 1 3 5\n", 1)
        .replacen("1 4 1 4\n2 1 0 4\n", "1 5 1 5\n2 1 0 5\n", 1)
        .replacen("4\n0 0 0\n", "4\n5\n0 0 0\n", 1)
        .replacen("0 1 0\n$End", "0 1 0\n0.6 0.2 0\n$End", 1);
    check(&three, mesh, &["more than two elements share"]);
    let error = refusal::<3>(SQUARE_TEXT).to_string();
    assert!(error.contains("no tetrahedra"), "{error}");
    let error = refusal::<2>(BOX_TEXT).to_string();
    assert!(error.contains("tetrahedra; save triangles"), "{error}");
}

#[test]
fn pieces_that_do_not_touch_are_refused() {
    let text = TWO_TRIANGLES
        .replacen("1 4 1 4\n2 1 0 4\n", "1 7 1 7\n2 1 0 7\n", 1)
        .replacen("4\n0 0 0\n", "4\n5\n6\n7\n0 0 0\n", 1)
        .replacen("0 1 0\n$End", "0 1 0\n5 5 0\n6 5 0\n6 6 0\n$End", 1)
        .replacen("2 6 1 6\n1 1 1 4\n", "2 10 1 10\n1 1 1 7\n7 5 6\n8 6 7\n9 7 5\n", 1)
        .replacen("2 1 2 2\n", "2 1 2 3\n10 5 6 7\n", 1);
    check(&text, Place::Mesh, &["2 pieces"]);
}
