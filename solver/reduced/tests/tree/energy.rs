//! What is kept without drag, at the order of the stepper, and the balance of power with motors.

use alewife_reduced::tree::{Command, Pose, Scheme, State, Stepper, vector};

use super::chains::{Eel, ellipsoids, moving};

fn none(_: f64, _: usize) -> Command<f64> {
    Command::none()
}

/// Largest changes of energy, and of both momenta, of a chain without drag over a second, as parts.
fn drift(scheme: Scheme, n_steps: u32) -> [f64; 3] {
    let tree = ellipsoids([0.0; 5], 0.0, 0.0);
    let mut state = moving(&tree);
    let (energy, momentum) = (tree.kinetic_energy(&state), tree.momentum(&state));
    let mut stepper = Stepper::new(&tree, scheme);
    let mut worst = [0.0_f64; 3];
    for _ in 0..n_steps {
        stepper.step(&tree, &mut state, 1.0 / f64::from(n_steps), &none).expect("it moves");
        let now = tree.momentum(&state);
        let changes = [
            (tree.kinetic_energy(&state) / energy - 1.0).abs(),
            (now.force - momentum.force).norm() / momentum.force.norm(),
            (now.torque - momentum.torque).norm() / momentum.torque.norm(),
        ];
        worst = [0, 1, 2].map(|k| worst[k].max(changes[k]));
    }
    worst
}

#[test]
fn energy_and_momenta_drift_at_the_order_of_the_stepper() {
    for (scheme, order) in [(Scheme::Euler, 1.0), (Scheme::Midpoint, 2.0)] {
        let [coarse, fine] = [2000, 4000].map(|n| drift(scheme, n));
        for k in 0..3 {
            let found = (coarse[k] / fine[k]).log2();
            assert!(coarse[k] < 0.1 && found > order - 0.2, "{scheme:?} {k}: {coarse:?} {fine:?}");
        }
    }
}

/// What the motors do goes into kinetic energy and the fluid.
#[test]
fn motors_give_what_links_and_fluid_take() {
    let eel = Eel::of([1.0, 4.0, 2.0, 2.0, 0.1, 0.5, 1.6], 3);
    let tree = eel.tree();
    let command = |time: f64, link: usize| eel.command(time, link);
    let defect = |n_steps: u32| {
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
        let (mut given, mut taken) = (0.0, 0.0);
        let step = 1.5 / f64::from(n_steps);
        for _ in 0..n_steps {
            let before = state.velocities.clone();
            let lost = |state: &State<f64>| -> f64 {
                let (twists, poses) = (tree.twists(state), tree.poses(state));
                let links = tree.links().iter().zip(twists.iter().zip(&poses));
                links
                    .map(|(link, (twist, pose))| {
                        let turned = Pose { position: vector([0.0; 3]), ..*pose };
                        let placed = &link.loads[0];
                        let frame = placed.pose.unwrap_or_else(Pose::identity);
                        let met = frame.twist_inside(&turned.twist_inside(twist));
                        -met.dot(&placed.load.resist(&met).wrench)
                    })
                    .sum()
            };
            let first = lost(&state);
            stepper.step(&tree, &mut state, step, &command).expect("it moves");
            for velocity in 3..5 {
                let mean = 0.5 * (before[velocity] + state.velocities[velocity]);
                given += state.efforts[velocity] * mean * step;
            }
            taken += 0.5 * (first + lost(&state)) * step;
        }
        (given - taken - tree.kinetic_energy(&state)).abs() / given
    };
    let [coarse, fine] = [300, 600].map(defect);
    assert!(fine < 1e-4 && (coarse / fine).log2() > 1.8, "{coarse:e} {fine:e}");
}
