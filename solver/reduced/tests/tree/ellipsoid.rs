//! The model of an ellipsoid against loads that `MuJoCo` 3.3.7 and 4.0.0 computed, and its added mass.

use alewife_reduced::tree::loads::{AddedMass, Ellipsoid, EllipsoidCoefficients, Lift, Load};
use alewife_reduced::tree::{
    Command, Inputs, Link, Root, Scheme, Stepper, Symmetric, Tree, Twist, Wrench, vector,
};
use nalgebra::{Matrix3, Vector3};

/// `mj_forward` -> `qfrc_fluid` of one free body, its frame that of the world: eight shapes.
const VECTORS: &str = include_str!("mujoco.csv");

fn three(row: &[f64], from: usize) -> Vector3<f64> {
    Vector3::new(row[from], row[from + 1], row[from + 2])
}

/// The same of `MuJoCo` 3.3.7: the ellipsoids of a fish with tendons, most of them some centimetres large, its coefficients.
const SMALL: &str = include_str!("mujoco3.csv");

/// How far loads are from those of a table, by the size of these, row by row.
fn deviations(table: &str, lift: Lift) -> Vec<f64> {
    let of = |line: &str| {
        let row: Vec<f64> =
            line.split(',').skip(2).map(|text| text.parse().expect("a number")).collect();
        let coefficients =
            EllipsoidCoefficients::from_array([row[3], row[4], row[5], row[6], row[7]]);
        let axes = [row[0], row[1], row[2]];
        let law = Ellipsoid::new(axes, row[9], row[8], coefficients, AddedMass::Mujoco);
        let twist = Twist { linear: three(&row, 10), angular: three(&row, 13) };
        let found = Load::Ellipsoid(Box::new(law.lifted(lift))).resist(&twist).wrench;
        let mut worst = 0.0_f64;
        for (found, expected) in [(found.force, three(&row, 16)), (found.torque, three(&row, 19))] {
            // A torque of nothing is compared with that of the force over the largest semi-axis
            let lever = axes.iter().fold(0.0_f64, |a, b| a.max(*b));
            let size = expected.norm().max(three(&row, 16).norm() * lever * 1e-3);
            worst = worst.max((found - expected).norm() / size);
        }
        worst
    };
    table.lines().skip(1).map(of).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a: f64, b| a.max(*b))
}

#[test]
fn loads_are_those_of_mujoco() {
    let found = deviations(VECTORS, Lift::Full);
    assert!(found.len() == 40 && largest(&found) < 1e-6, "{:e}", largest(&found));
}

/// `MuJoCo` 3 has a least denominator of 1e-15 in its lift, whatever the units: it takes nearly all from small parts, and
/// nothing from large ones.
#[test]
fn small_parts_have_the_lift_of_mujoco_3() {
    let found = deviations(SMALL, Lift::Mujoco3);
    assert!(found.len() == 44 && largest(&found) < 1e-6, "{:e}", largest(&found));
    let full = deviations(SMALL, Lift::Full);
    assert!(full.iter().filter(|one| **one > 0.1).count() > 30, "{full:?}");
    // The plate and the fin at common speeds
    assert!(full[0] < 1e-6 && full[full.len() - 2] < 1e-6, "{full:?}");
}

/// A force along x on the only link.
struct Push(f64);

impl Inputs<f64> for Push {
    fn command(&self, _: f64, _: usize) -> Command<f64> {
        Command::none()
    }

    fn wrench(&self, _: f64, _: usize, _: &Matrix3<f64>) -> Option<Wrench<f64>> {
        Some(Wrench { force: vector([self.0, 0.0, 0.0]), torque: vector([0.0; 3]) })
    }
}

#[test]
fn a_sphere_as_dense_as_the_fluid_is_half_as_heavy_again() {
    let (radius, density, force) = (0.03, 1000.0, 0.7);
    let none = EllipsoidCoefficients::from_array([0.0; 5]);
    for (inertia, factor) in [(AddedMass::Full, 1.5), (AddedMass::Mujoco, 1.0)] {
        let law = Ellipsoid::new([radius; 3], density, 0.0, none, inertia);
        let mass = density * law.volume();
        let moment = 0.4 * mass * radius * radius;
        let body = Symmetric::rigid(mass, Vector3::from_element(moment));
        let link = Link::root(body).loaded(Load::Ellipsoid(Box::new(law)));
        let tree = Tree::new(Root::Free, vec![link]).expect("a sphere is a tree");
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
        stepper.step(&tree, &mut state, 0.01, &Push(force)).expect("it moves");
        let expected = force / (factor * mass);
        let wrong = (state.accelerations[0] / expected - 1.0).abs();
        assert!(wrong < 1e-12, "{inertia:?}: {wrong:e}");
    }
}

/// Masses of a long spheroid across itself tend to those of a cylinder, and about three different axes the
/// exact integrals are those of the 15 points to the error of these.
#[test]
fn added_masses_are_those_of_the_potential_flow() {
    let none = EllipsoidCoefficients::from_array([0.0; 5]);
    let masses = |axes: [f64; 3]| {
        Load::Ellipsoid(Box::new(Ellipsoid::new(axes, 1.0, 0.0, none, AddedMass::Full)))
            .added_mass()
    };
    let long = masses([100.0, 1.0, 1.0]);
    let displaced = 4.0 / 3.0 * std::f64::consts::PI * 100.0;
    assert!((long.linear[(1, 1)] / displaced - 1.0).abs() < 2e-3);
    assert!(long.linear[(0, 0)] / displaced < 1e-3 && long.angular[(0, 0)].abs() < 1e-12);
    // Lamb's table of oblate spheroids ends in the disc: 8/3 a^3 across itself
    let disc = masses([1.0, 1.0, 1e-5]);
    assert!((disc.linear[(2, 2)] / (8.0 / 3.0) - 1.0).abs() < 1e-4);
    assert!((disc.angular[(0, 0)] / (16.0 / 45.0) - 1.0).abs() < 1e-4);
}
