//! Masses and accelerations of trees beside those of `MuJoCo` 3.3.7 in the same states.

use std::collections::BTreeMap;

use alewife_reduced::tree::{
    Command, Drive, Link, Placement, Root, Scheme, State, Stepper, Tree, Twist,
};
use nalgebra::{DMatrix, DVector, Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::super::build::Reduced;
use super::describe::describe;
use crate::case::{Case, CaseFile};

/// Exported models of a fish, an eel and a robot in three states each; written by `postprocess/tests/test_mujoco.py`.
const STORED: &str = include_str!("../../../tests/reduced/mujoco.csv");

/// A step in which nothing that resists has an effect (s).
const NO_TIME: f64 = 1e-20;

/// Numbers of each case and state, by what they are.
fn stored() -> BTreeMap<String, BTreeMap<String, Vec<f64>>> {
    let mut found: BTreeMap<String, BTreeMap<String, Vec<f64>>> = BTreeMap::new();
    for line in STORED.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let values = words[3].split(' ').map(|word| word.parse().expect("a number")).collect();
        let key = format!("{},{}", words[0], words[1]);
        found.entry(key).or_default().insert(words[2].to_owned(), values);
    }
    found
}

fn case(name: &str) -> CaseFile {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reduced/robot.toml");
    let case = match name {
        "fish" => "tendon-fish",
        "eel" => "robot-eel",
        _ => path,
    };
    Case::read(case, &[]).expect("the case is right")
}

/// The tree of a case with loads of the fluid or without, joints that are given left to themselves.
fn tree(file: &CaseFile, is_wet: bool) -> Reduced {
    let mut reduced = Reduced::new(&file.model).expect("it has a reduced model");
    let free = |link: &Link<f64>| {
        let mut link = link.clone();
        if !is_wet {
            link.loads.clear();
        }
        if matches!(link.joint.drive, Drive::Given | Drive::Rate) {
            link.joint.drive = Drive::Effort;
        }
        link
    };
    let links = reduced.tree.links().iter().map(free).collect();
    let tendons = reduced.tree.tendons().to_vec();
    let tree = Tree::new(reduced.root, links).expect("it is a tree").in_gravity(reduced.gravity);
    reduced.tree = tree.with_tendons(tendons).expect("they are tendons");
    reduced
}

/// A state of the tree, and its velocities by those of `MuJoCo`: the root's in its own frame at its centre of mass by those
/// of the body's origin in the world (free), or by those along x, y and about z of the world (planar).
struct Met {
    state: State<f64>,
    change: DMatrix<f64>,
}

/// Velocities of the tree by those of joints in the order of `MuJoCo`, depth first.
fn order_of(file: &CaseFile, n_root: usize) -> Vec<usize> {
    let robot = describe(&file.model, "robot").expect("it has masses").robot;
    let count = |number: usize| {
        let is_planar_root = number == 0 && n_root == 3;
        if is_planar_root { 0 } else { robot.bodies[number].joints.len() }
    };
    let first = |number: usize| n_root + (0..number).map(count).sum::<usize>();
    let joints = |number: usize| first(number)..first(number) + count(number);
    robot.depth_first().into_iter().flat_map(joints).collect()
}

fn met(reduced: &Reduced, file: &CaseFile, place: &[f64], rate: &[f64]) -> Met {
    let tree = &reduced.tree;
    let (n, n_root) = (tree.n_velocities(), tree.n_root());
    let mut state = reduced.start.clone();
    let mut change = DMatrix::identity(n, n);
    let mut first = 0;
    match reduced.root {
        Root::Held => {}
        Root::Planar => {
            let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), place[2])
                * UnitQuaternion::from_quaternion(Quaternion::from_parts(
                    state.root.quaternion[0],
                    Vector3::from_iterator(state.root.quaternion[1..].iter().copied()),
                ));
            state.root = Placement {
                position: state.root.position + Vector3::new(place[0], place[1], 0.0),
                quaternion: [turned.w, turned.i, turned.j, turned.k],
            };
            let back = state.root.rotation().transpose();
            change.view_mut((0, 0), (2, 2)).copy_from(&back.fixed_view::<2, 2>(0, 0));
            first = 3;
        }
        Root::Free => {
            let q = Quaternion::new(place[3], place[4], place[5], place[6]);
            let turn = UnitQuaternion::from_quaternion(q);
            let rotation: Matrix3<f64> = *Rotation3::from(turn).matrix();
            let center = Vector3::from_column_slice(&file.case().body[0].center_of_mass);
            let origin = Vector3::new(place[0], place[1], place[2]);
            state.root = Placement {
                position: origin + rotation * center,
                quaternion: [turn.w, turn.i, turn.j, turn.k],
            };
            change.view_mut((0, 0), (3, 3)).copy_from(&rotation.transpose());
            // The centre moves with the rotation, too: w x c
            change.view_mut((0, 3), (3, 3)).copy_from(&-center.cross_matrix());
            first = 7;
        }
    }
    let mut order = change.clone();
    order.view_mut((n_root, n_root), (n - n_root, n - n_root)).fill(0.0);
    for (theirs, ours) in order_of(file, n_root).into_iter().enumerate() {
        state.coordinates[ours] = place[first + theirs];
        order[(ours, n_root + theirs)] = 1.0;
    }
    let change = order;
    let velocities = &change * DVector::from_column_slice(rate);
    state.velocities.copy_from_slice(velocities.as_slice());
    Met { state, change }
}

/// The mass matrix by kinetic energies.
fn masses(tree: &Tree<f64>, state: &State<f64>) -> DMatrix<f64> {
    let n = tree.n_velocities();
    let energy = |i: usize, j: usize| {
        let mut state = state.clone();
        state.velocities.fill(0.0);
        state.velocities[i] += 1.0;
        if i != j {
            state.velocities[j] += 1.0;
        }
        tree.kinetic_energy(&state)
    };
    let own: Vec<f64> = (0..n).map(|i| energy(i, i)).collect();
    DMatrix::from_fn(
        n,
        n,
        |i, j| {
            if i == j { 2.0 * own[i] } else { energy(i, j) - own[i] - own[j] }
        },
    )
}

/// Accelerations as `MuJoCo` counts them: of a root those of its origin in the world, where ours are those of the centre in
/// its frame, which turns.
fn accelerations(reduced: &Reduced, met: &Met) -> DVector<f64> {
    let mut state = met.state.clone();
    let told = |time: f64, link: usize| -> Command<f64> { reduced.command(time, link) };
    Stepper::new(&reduced.tree, Scheme::Euler)
        .step(&reduced.tree, &mut state, NO_TIME, &told)
        .expect("a step");
    let mut own = DVector::from_column_slice(&state.accelerations);
    let velocities = &met.state.velocities;
    let turn = match reduced.root {
        Root::Held => return own,
        Root::Planar => Vector3::new(0.0, 0.0, velocities[2]),
        Root::Free => Vector3::new(velocities[3], velocities[4], velocities[5]),
    };
    // d/dt of R v is R (v' + w x v); and the origin is -c from the centre: less w x (w x c)
    let linear = |k: usize| if k < 2 || reduced.root == Root::Free { velocities[k] } else { 0.0 };
    let mut turned = turn.cross(&Vector3::new(linear(0), linear(1), linear(2)));
    if reduced.root == Root::Free {
        let center = -met.change.fixed_view::<3, 3>(0, 3).into_owned();
        let center = Vector3::new(center[(2, 1)], center[(0, 2)], center[(1, 0)]);
        turned -= turn.cross(&turn.cross(&center));
    }
    let n_linear = if reduced.root == Root::Free { 3 } else { 2 };
    for k in 0..n_linear {
        own[k] += turned[k];
    }
    met.change.clone().lu().solve(&own).expect("velocities are those of the same motion")
}

#[test]
fn trees_have_the_masses_and_accelerations_of_mujoco() {
    let mut n = 0;
    for (key, numbers) in stored() {
        let name = key.split(',').next().expect("a name").to_owned();
        let file = case(&name);
        let reduced = tree(&file, false);
        let met = met(&reduced, &file, &numbers["place"], &numbers["rate"]);
        let own = met.change.transpose() * masses(&reduced.tree, &met.state) * &met.change;
        let expected = DMatrix::from_row_slice(own.nrows(), own.ncols(), &numbers["mass"]);
        let size = |i: usize, j: usize| (expected[(i, i)] * expected[(j, j)]).sqrt();
        for i in 0..own.nrows() {
            for j in 0..own.ncols() {
                let off = (own[(i, j)] - expected[(i, j)]).abs() / size(i, j);
                assert!(off < 1e-10, "{key}: mass {i} {j}: {off}");
            }
        }
        let own = accelerations(&reduced, &met);
        let expected = DVector::from_column_slice(&numbers["acceleration"]);
        let off = (&own - &expected).amax() / expected.amax();
        assert!(off < 1e-9, "{key}: {off}: {own} {expected}");
        // In the fluid to what the loads of ellipsoids agree to; the eel has other ones
        if name != "eel" {
            let own = accelerations(&tree(&file, true), &met);
            let expected = DVector::from_column_slice(&numbers["wet"]);
            let off = (&own - &expected).amax() / expected.amax();
            assert!(off < 1e-6, "{key}: in the fluid {off}");
        }
        n += 1;
    }
    assert_eq!(n, 9);
}

/// The twist of the root of a tree is that of the centre of mass: what the changes above rest on.
#[test]
fn the_root_of_a_tree_is_at_its_centre_of_mass() {
    let reduced = tree(&case("robot"), false);
    let Twist { linear, .. } = reduced.tree.twists(&reduced.start)[0];
    assert!((linear - Vector3::new(0.1, -0.2, 0.05)).norm() < 1e-15, "{linear}");
}
