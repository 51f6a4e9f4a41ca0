//! Files of older versions, and files whose meaning is plain though they are not as asked: groups inside, several groups
//! of a side, no names, other planes, parts that are not joined, third order.

use alewife_mesh::{MshOptions, ReadMsh, check_mesh, read_msh_with};

use super::{measure, names, read, refusal};

const VERSIONS: [&[u8]; 3] = [
    include_bytes!("data/inclusion-22-text.msh"),
    include_bytes!("data/inclusion-22-binary.msh"),
    include_bytes!("data/inclusion-40-text.msh"),
];
const NEWEST: &[u8] = include_bytes!("data/inclusion-41-text.msh");
const TWO_GROUPS: &[u8] = include_bytes!("data/two-groups-at-z-1.msh");
const TWO_GROUPS_22: &[u8] = include_bytes!("data/two-groups-22.msh");
const UNMERGED: &[u8] = include_bytes!("data/unmerged.msh");
const DISC: &[u8] = include_bytes!("data/disc-3-unnamed.msh");
const BALL: &[u8] = include_bytes!("data/ball-3-22-binary.msh");

fn read_with<const D: usize>(bytes: &[u8], sides: &[&str]) -> ReadMsh<D> {
    let sides = sides.iter().map(|side| (*side).to_owned()).collect();
    let read = read_msh_with(bytes, &MshOptions { scale: 1.0, sides }).expect("it is a mesh");
    check_mesh(&read.mesh).expect("it keeps the invariants");
    read
}

#[test]
fn older_versions_hold_the_same_mesh_and_what_is_named_inside_is_no_side() {
    let newest = read_with::<2>(NEWEST, &[]);
    assert_eq!(names(&newest.mesh), ["left", "right", "wall"]);
    assert!((newest.mesh.measure() - 8.0).abs() < 1e-12, "{}", newest.mesh.measure());
    assert!(newest.notes.len() == 1 && newest.notes[0].contains("\"interface\""));
    for bytes in VERSIONS {
        let older = read_with::<2>(bytes, &[]);
        assert_eq!(names(&older.mesh), names(&newest.mesh));
        assert_eq!(older.mesh.n_cells(), newest.mesh.n_cells());
        assert!((older.mesh.measure() - 8.0).abs() < 1e-12);
        for side in ["left", "right", "wall"] {
            assert!((measure(&older.mesh, side) - measure(&newest.mesh, side)).abs() < 1e-12);
        }
        assert_eq!(older.notes, newest.notes);
    }
}

#[test]
fn sides_are_chosen_among_several_groups_and_planes_of_equal_z_are_read() {
    for bytes in [TWO_GROUPS, TWO_GROUPS_22] {
        let message = refusal::<2>(bytes).to_string();
        for word in ["2 physical groups", "\"all\"", "domain.mesh.sides"] {
            assert!(message.contains(word), "{message}");
        }
        let chosen = read_with::<2>(bytes, &["left", "right", "wall"]);
        assert_eq!(names(&chosen.mesh), ["left", "right", "wall"]);
        assert!(chosen.notes.iter().any(|note| note.contains("z = 1")), "{:?}", chosen.notes);
        assert_eq!(names(&read_with::<2>(bytes, &["all"]).mesh), ["all"]);
        let options = MshOptions { scale: 1.0, sides: vec!["top".to_owned()] };
        let error = read_msh_with::<2>(bytes, &options).expect_err("there is none").to_string();
        assert!(error.contains("\"top\"") && error.contains("left, right, wall"), "{error}");
        let options = MshOptions { scale: 1.0, sides: vec!["wall".to_owned()] };
        assert!(read_msh_with::<2>(bytes, &options).is_err(), "left and right have no name");
    }
}

#[test]
fn parts_with_nodes_at_the_same_places_are_joined() {
    let read = read_with::<2>(UNMERGED, &[]);
    assert!((read.mesh.measure() - 10.0).abs() < 1e-12);
    // The end, and two edges of length 1 beside it; another one of length 2 is inside
    assert!((measure(&read.mesh, "right") - 4.0).abs() < 1e-12);
    assert!(read.notes.iter().any(|note| note.contains("are joined")), "{:?}", read.notes);
}

#[test]
fn groups_without_names_are_known_by_their_numbers_and_third_order_is_bent() {
    let disc = read::<2>(DISC);
    assert_eq!(names(&disc), ["5"]);
    let pi = std::f64::consts::PI;
    assert!(disc.curved.contains(&true) && (disc.measure() / pi - 1.0).abs() < 5e-3);
    let ball = read::<3>(BALL);
    assert_eq!(names(&ball), ["3"]);
    assert!(ball.curved.contains(&true), "{}", ball.measure());
    assert!((ball.measure() / (4.0 / 3.0 * pi) - 1.0).abs() < 0.03, "{}", ball.measure());
}

/// What a mesh that is cut off or damaged is does not matter: it is never the end of the program.
#[test]
fn older_files_that_are_damaged_are_refused_or_read() {
    for bytes in VERSIONS.into_iter().chain([BALL]) {
        for end in (0..bytes.len() - 40).step_by(97) {
            assert!(read_msh_with::<2>(&bytes[..end], &MshOptions::scaled(1.0)).is_err(), "{end}");
        }
        for at in (0..bytes.len()).step_by(61) {
            let mut damaged = bytes.to_vec();
            damaged[at] ^= 0x2a;
            let _ = read_msh_with::<2>(&damaged, &MshOptions::scaled(1.0));
            let _ = read_msh_with::<3>(&damaged, &MshOptions::scaled(1.0));
        }
    }
}
