//! A thin tail that is bent by the full amplitude of its wave, in a tube.

use alewife_mesh::spatial::{Domain, generate};
use alewife_mesh::{Quality, Sizing};
use flagellate::flagellate;

use super::{SMALLEST_ANGLE, assert_mesh};

#[path = "../common/tail.rs"]
mod flagellate;

/// A mesh with the sizes of cells of the case `sperm-3d` around its swimmer with a tail of some length (m).
fn check_tail(length: f64, phase: f64) {
    let domain = Domain::Cylinder { x: [14.0, 26.0 + length], radius: 5.0 };
    let sizing = Sizing { gap_layers: 2.0, turn: 1.0, ..Sizing::graded(0.3, 0.6, 3.0) };
    let bodies = [flagellate([length, 0.2], phase)];
    let mesh = generate(&domain, &bodies, &sizing);
    let mesh = mesh.unwrap_or_else(|error| panic!("phase {phase}: {error}"));
    println!("phase {phase}: {} cells, {:.1}", mesh.n_cells(), Quality::of(&mesh).min_angle);
    assert_mesh(&mesh, &domain, &bodies, SMALLEST_ANGLE);
}

#[test]
fn a_short_thin_tail_is_meshed_in_its_beat() {
    check_tail(5.0, 0.3);
}

#[test]
#[ignore = "long: minutes; small: a_short_thin_tail_is_meshed_in_its_beat"]
fn a_long_thin_tail_is_meshed_at_all_phases_of_its_beat() {
    (0..8).for_each(|eighth| check_tail(50.0, f64::from(eighth) / 8.0));
}

#[test]
#[ignore = "long: a minute; small: a_short_thin_tail_is_meshed_in_its_beat"]
fn a_thin_tail_of_twelve_radii_is_meshed_at_phases_of_its_beat() {
    [0.0, 0.3, 0.7].into_iter().for_each(|phase| check_tail(12.0, phase));
}
