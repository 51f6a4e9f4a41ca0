//! Purcell's swimmer without inertia: as a connection and by forces a length.

use std::f64::consts::TAU;

use alewife_reduced::tree::loads::{Load, Resistive};
use alewife_reduced::tree::{
    Command, Connection, Drift, Drive, Joint, JointKind, Link, PlacedLoad, Placement, Pose, Root,
    Symmetric, Tree, TreeError, magnus, nodes, vector,
};
use nalgebra::Vector2;

/// Velocities of the middle link by the rate of the first angle: 18 steady Stokes flows about the shipped
/// swimmer, each at Chebyshev's nodes i and j of its two angles, 6 each from -0.62 to 0.62.
const NODES: &str = include_str!("purcell.csv");

const RANGE: f64 = 0.62;

/// Its angles and their rates.
type Gait = fn(f64) -> [[f64; 2]; 2];

/// Round a square of the half width `a`, one side a quarter.
fn square(a: f64, time: f64) -> [[f64; 2]; 2] {
    let side = |time: f64| match (time.rem_euclid(1.0) * 4.0).floor() {
        0.0 => (a, 0.0),
        1.0 => (a - 8.0 * a * (time.rem_euclid(1.0) - 0.25), -8.0 * a),
        2.0 => (-a, 0.0),
        _ => (-a + 8.0 * a * (time.rem_euclid(1.0) - 0.75), 8.0 * a),
    };
    let (first, second) = (side(time), side(time + 0.25));
    [[first.0, second.0], [first.1, second.1]]
}

fn sines(time: f64) -> [[f64; 2]; 2] {
    let (first, second) = (TAU * time, TAU * time - 1.2);
    [[0.55 * first.sin(), 0.3 * second.sin()], [0.55 * TAU * first.cos(), 0.3 * TAU * second.cos()]]
}

/// Gaits with the ways of the middle link in a cycle: full runs (40 steps of the third order a cycle), and of a
/// separate program with forces a length whose ratio is 1.743.
const GAITS: [(Gait, [f64; 2], [f64; 2]); 3] = [
    (|t| square(0.5, t), [0.044_584, 0.013_345], [0.044_941, 0.012_087]),
    (|t| square(0.35, t), [0.023_055, 0.004_719], [0.023_188, 0.004_271]),
    (sines, [-0.022_703, 0.001_833], [-0.022_549, 0.001_639]),
];

fn way(n: u32, mut step: impl FnMut(Placement<f64>, f64, f64) -> Placement<f64>) -> Vector2<f64> {
    let h = 1.0 / f64::from(n);
    let end = (0..n).fold(Placement::identity(), |at, k| step(at, f64::from(k) * h, h));
    end.position.xy()
}

/// All values from half of the nodes of the first angle, by the mirror and by turning the swimmer end to end.
fn purcell() -> Connection {
    let mut first = [[[0.0; 3]; 6]; 6];
    for line in NODES.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|text| text.parse().expect("a number")).collect();
        let node = |k: usize| (0..6_usize).find(|n| (row[k] - *n as f64).abs() < 0.5);
        let at = [0, 1].map(|k| node(k).expect("a node"));
        first[at[0]][at[1]] = [row[2], row[3], row[4]];
        first[5 - at[0]][5 - at[1]] = [-row[2], row[3], row[4]];
    }
    let mut values = Vec::new();
    for i in 0..6 {
        for j in 0..6 {
            let [x, y, turn] = first[j][i];
            values.extend(first[i][j].iter().chain(&[-x, -y, turn]));
        }
    }
    Connection::new(Root::Planar, vec![RANGE; 2], vec![6; 2], values).expect("all nodes")
}

fn connected(connection: &Connection, gait: Gait, n: u32) -> Vector2<f64> {
    way(n, |at, time, h| {
        let twist = |time: f64| {
            let [angles, rates] = gait(time);
            connection.twist(&angles, &rates)
        };
        magnus(&at, time, h, twist).expect("its angles are in range")
    })
}

#[test]
fn a_connection_has_the_ways_of_full_runs() {
    let connection = purcell();
    for (gait, full, _) in GAITS {
        let found = connected(&connection, gait, 80);
        let full = Vector2::from(full);
        assert!((found.norm() / full.norm() - 1.0).abs() < 1e-3, "{found} {full}");
        let turned = (found.y / found.x).atan() - (full.y / full.x).atan();
        assert!(turned.to_degrees().abs() < 0.1, "{turned}");
    }
}

/// Three links of length 1, pivots 0.05 off their ends, the middle one first.
fn links(ratio: f64) -> Tree<f64> {
    let law =
        Resistive { length: 1.0, half_width: 0.025, viscosity: 1.0, along: 1.0, across: ratio };
    let arm = |side: f64| {
        let joint = Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]).driven(Drive::Given);
        let mut link = Link::new(0, joint, Symmetric::zero()).placed([0.55 * side, 0.0, 0.0]);
        let pose = Some(Pose::at(vector([0.55 * side, 0.0, 0.0])));
        link.loads.push(PlacedLoad { pose, load: Load::Resistive(law) });
        link
    };
    let middle = Link::root(Symmetric::zero()).loaded(Load::Resistive(law));
    Tree::new(Root::Planar, vec![middle, arm(1.0), arm(-1.0)]).expect("a swimmer is a tree")
}

fn drifted(ratio: f64, gait: Gait, n: u32) -> Vector2<f64> {
    let mut drift = Drift::new(links(ratio)).expect("all joints are given");
    let mut state = drift.tree().rest();
    let command = |time: f64, link: usize| {
        let [angles, rates] = gait(time);
        Command { place: angles[link - 1], rate: rates[link - 1], effort: 0.0 }
    };
    way(n, |_, _, h| {
        drift.step(&mut state, h, &command).expect("links resist");
        state.root
    })
}

#[test]
fn forces_a_length_of_one_ratio_are_within_three_percent() {
    for (gait, full, separate) in GAITS {
        let found = drifted(1.743, gait, 80);
        assert!((found - Vector2::from(separate)).norm() < 2e-5, "{found}");
        assert!((found.norm() / Vector2::from(full).norm() - 1.0).abs() < 0.03, "{found}");
    }
}

#[test]
fn ways_converge_at_fourth_order_and_links_without_a_ratio_stay() {
    let ways = [10, 20, 40].map(|n| drifted(1.7, sines, n));
    let (coarse, fine): (f64, f64) = ((ways[1] - ways[0]).norm(), (ways[2] - ways[1]).norm());
    assert!((coarse / fine).log2() > 3.7, "{coarse:e} {fine:e}");
    // Where along is as hard as across the centre of all links stays, and so does the middle one after a cycle
    assert!(drifted(1.0, sines, 40).norm() < 1e-6);
}

/// The same law sampled at the nodes, and what its polynomial makes of it.
#[test]
fn a_sampled_law_is_the_law() {
    let mut drift = Drift::new(links(1.743)).expect("all joints are given");
    let mut state = drift.tree().rest();
    let mut values = Vec::new();
    let places = nodes(RANGE, 8);
    for first in &places {
        for second in &places {
            for moved in 1..3 {
                let command = |_: f64, link: usize| Command {
                    place: if link == 1 { *first } else { *second },
                    rate: if link == moved { 1.0 } else { 0.0 },
                    effort: 0.0,
                };
                let twist = drift.twist(&mut state, 0.0, &command).expect("links resist");
                values.extend([twist.linear.x, twist.linear.y, twist.angular.z]);
            }
        }
    }
    let connection = Connection::new(Root::Planar, vec![RANGE; 2], vec![8; 2], values);
    let connection = connection.expect("all nodes");
    let found = connected(&connection, sines, 80);
    assert!((found - drifted(1.743, sines, 80)).norm() < 1e-7, "{found}");
    assert!(matches!(connection.twist(&[0.63, 0.0], &[1.0, 0.0]), Err(TreeError::Given(_))));
    assert!(Connection::new(Root::Planar, vec![1.0], vec![2], vec![0.0; 5]).is_err());
    assert!(Connection::new(Root::Planar, vec![1.0; 4], vec![1; 4], vec![0.0; 12]).is_err());
}
