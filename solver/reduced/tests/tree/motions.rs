//! Motions of the root on its Lie group, and invariance of whole motions.

use alewife_reduced::tree::{
    Command, Link, Placement, Root, Scheme, Stepper, Symmetric, Tree, Twist, vector,
};
use nalgebra::{Rotation3, Vector3};

use super::chains::{Eel, ellipsoids, moving};

fn none(_: f64, _: usize) -> Command<f64> {
    Command::none()
}

#[test]
fn a_constant_twist_is_a_screw() {
    let twist = Twist { linear: vector([0.3, -0.2, 0.5]), angular: vector([1.0, 2.0, -0.5]) };
    let start = Placement::turned(vector([0.1, 0.2, 0.3]), &vector([0.6, 0.0, 0.8]), 0.7);
    let once = start.moved(&twist, 1.5);
    // Many small steps end where one does, by other branches of the exponential
    let many = (0..3000).fold(start, |placed, _| placed.moved(&twist, 5e-4));
    assert!((once.position - many.position).norm() < 1e-12);
    let turned = Rotation3::new(Vector3::new(1.0, 2.0, -0.5) * 1.5);
    let expected = start.rotation() * turned.matrix();
    assert!((once.rotation() - expected).norm() < 1e-13);
    assert!((once.rotation() - many.rotation()).norm() < 1e-12);
}

/// Euler's top: a body that spins about its axis of symmetry and is tilted precesses at I w / I_1.
#[test]
fn a_symmetric_top_precesses() {
    let (across, along) = (2.0, 3.0);
    let body = Symmetric::rigid(1.0, vector([across, across, along]));
    let tree = Tree::new(Root::Free, vec![Link::root(body)]).expect("a tree");
    let wrong = |n: u32| {
        let mut state = tree.rest();
        state.velocities[3] = 0.4;
        state.velocities[5] = 1.0;
        let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
        for _ in 0..n {
            stepper.step(&tree, &mut state, 3.0 / f64::from(n), &none).expect("it moves");
        }
        let rate: f64 = (along - across) / across;
        let exact = [0.4 * (rate * 3.0).cos(), 0.4 * (rate * 3.0).sin()];
        let quaternion: f64 = state.root.quaternion.iter().map(|q| q * q).sum();
        assert!((quaternion - 1.0).abs() < 1e-14);
        (state.velocities[3] - exact[0]).hypot(state.velocities[4] - exact[1])
    };
    let (coarse, fine) = (wrong(300), wrong(600));
    assert!(fine < 1e-5 && (coarse / fine).log2() > 1.9, "{coarse:e} {fine:e}");
}

/// A motion begun elsewhere and turned is the same motion, elsewhere and turned.
#[test]
fn motions_do_not_depend_on_the_frame() {
    let tree = ellipsoids([0.4, 7.8, 2.8, 3.8, 0.3], 0.5, 0.05);
    let placed = Placement::turned(vector([50.0, -20.0, 7.0]), &vector([0.36, 0.48, 0.8]), 2.0);
    let run = |start: Placement<f64>| {
        let mut state = moving(&tree);
        state.root = start;
        let mut stepper = Stepper::new(&tree, Scheme::Euler);
        for _ in 0..100 {
            stepper.step(&tree, &mut state, 0.01, &none).expect("it moves");
        }
        state
    };
    let (here, there) = (run(Placement::identity()), run(placed));
    let way = placed.rotation().transpose() * (there.root.position - placed.position);
    assert!((way - here.root.position).norm() < 1e-12);
    for (a, b) in here.velocities.iter().zip(&there.velocities) {
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
}

#[test]
fn an_eel_converges_at_second_order_and_swims_away_from_its_wave() {
    let eel = Eel::of([1.0, 4.0, 2.0, 2.0, 0.1, 0.5, 1.6], 6);
    let tree = eel.tree();
    let run = |n: u32| {
        let command = |time: f64, link: usize| eel.command(time, link);
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
        for _ in 0..n {
            stepper.step(&tree, &mut state, 3.0 / f64::from(n), &command).expect("it moves");
        }
        state.root.position
    };
    let ways = [150, 300, 600].map(run);
    let [coarse, fine]: [f64; 2] = [0, 1].map(|k| (ways[k + 1] - ways[k]).norm());
    assert!((coarse / fine).log2() > 1.7, "{coarse:e} {fine:e}");
    // The wave runs to the back, -x
    assert!(ways[2].x > 0.3, "{}", ways[2]);
}
