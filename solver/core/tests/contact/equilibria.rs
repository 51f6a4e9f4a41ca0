//! Bodies at rest, pressed together, sliding and settling.

use alewife_core::body::{Modes, Twist};
use alewife_core::contact::{ContactSolution, ContactStep, Partner, PlanarGaps};
use nalgebra::DMatrix;

use crate::common::{
    Mock, barrier, disc, ellipse, fastest, gap_of_force, heap, peanut, planar, poses, quadratic,
    tank,
};

#[test]
fn two_discs_pressed_together_come_to_the_gap_of_the_law() {
    let gaps = PlanarGaps::new(&tank(), &[], &[disc("a"), disc("b")]).unwrap();
    let (c, s) = (0.6, 0.8);
    let places = [[0.0, 5.0, 0.0], [1.2 * c, 5.0 + 1.2 * s, 0.3]];
    for law in [quadratic(1e-3), quadratic(1e-9), barrier(10.0), barrier(1e-4), barrier(1e6)] {
        for force in [0.3, 1.0, 2.4] {
            let load = [[force * c, force * s, 0.0], [-force * c, -force * s, 0.0]];
            let mut mock = Mock::planar(&gaps, law, &places, &load);
            mock.friction = Some(planar([1.0, 1.0, 1.0]));
            // Not much longer: pressed from outside, discs are about to slip past each other
            let end = mock.run(150);
            let contact = &end.loads.contacts[0];
            let wanted = gap_of_force(&law, force);
            assert!((contact.pair.gap - wanted).abs() < 1e-10, "{law:?} {force}");
            assert!((contact.force / force - 1.0).abs() < 1e-10, "{law:?} {force}");
            assert!((end.loads.minimum_gap.unwrap().gap - wanted).abs() < 1e-10);
            assert!(fastest(&end) < 1e-10, "{law:?} {force}: {}", fastest(&end));
        }
    }
}

#[test]
fn steps_are_not_bound_to_the_stiffness() {
    let laws = [quadratic(1e-12), quadratic(1e-6), barrier(1e-3), barrier(1e9)];
    // Falls by up to 10 000 diameters in one step, but for the floor
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[disc("disc")]).unwrap();
    for law in laws {
        for step in [0.1, 1.0, 100.0, 1e4] {
            let mut mock = Mock::planar(&gaps, law, &[[0.0, 3.0, 0.0]], &[[0.1, -1.0, 0.0]]);
            (mock.step, mock.friction) = (step, Some(planar([1.0; 3])));
            for _ in 0..5 {
                let end = mock.advance().unwrap_or_else(|e| panic!("{law:?} {step}: {e}"));
                assert!(end.loads.minimum_gap.unwrap().gap > 0.0);
                assert!(end.iterations < 60, "{law:?} {step}: {}", end.iterations);
            }
        }
    }
    // One disc slides off another, by up to six times the range in a step
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[disc("a"), disc("b")]).unwrap();
    let places = [[0.1, 3.0, 0.0], [0.0, 1.8, 0.0]];
    for law in laws {
        for (step, n_steps) in [(0.003, 4000), (0.03, 400), (0.3, 40)] {
            let load = [[0.0, -1.0, 0.0]; 2];
            let mut mock = Mock::planar(&gaps, law, &places, &load);
            (mock.step, mock.friction) = (step, Some(planar([1.0; 3])));
            for _ in 0..n_steps {
                let end = mock.advance().unwrap_or_else(|e| panic!("{law:?} {step}: {e}"));
                assert!(end.loads.minimum_gap.unwrap().gap > 0.0);
                assert!(end.iterations < 60, "{law:?} {step}: {}", end.iterations);
                // Neither has passed through the other, or the floor
                assert!(
                    end.poses[0].center.x > end.poses[1].center.x && end.poses[1].center.y > 0.5
                );
            }
            let rise = mock.poses[0][0].center.y - mock.poses[0][1].center.y;
            assert!(rise.abs() < 1e-3, "side by side");
        }
    }
}

/// 10 000 steps: at the end at rest, and the gap the same as long before.
fn assert_rests(mock: &mut Mock<'_>, what: &str) -> ContactSolution {
    mock.run(5000);
    let gaps = |solution: &ContactSolution| -> Vec<f64> {
        solution.loads.contacts.iter().map(|contact| contact.pair.gap).collect()
    };
    let middle = mock.advance().unwrap();
    let (mut before, pose) = (gaps(&middle), middle.poses[0]);
    for step in 5001..9999 {
        let now = mock.advance().unwrap();
        assert!(fastest(&now) < 1e-10, "{what}, step {step}: {}", fastest(&now));
        let now = gaps(&now);
        assert_eq!(now.len(), before.len(), "{what}");
        assert!(now.iter().zip(&before).all(|(a, b)| (a - b).abs() < 1e-12), "{what}");
        before = now;
    }
    let end = mock.advance().unwrap();
    assert!(gaps(&end).iter().zip(gaps(&middle)).all(|(a, b)| (a - b).abs() < 1e-12), "{what}");
    assert!(end.poses[0].displacement_from(&pose).amax() < 1e-11, "{what}: drifts");
    // Contact and weight balance
    let wrench = end.loads.wrenches[0];
    let weight = mock.load[0][0].hypot(mock.load[0][1]);
    assert!((wrench.force.x + mock.load[0][0]).abs() < 1e-8 * weight, "{what}");
    assert!((wrench.force.y + mock.load[0][1]).abs() < 1e-8 * weight, "{what}");
    assert!(wrench.torque.z.abs() < 1e-8 * weight, "{what}");
    end
}

#[test]
fn a_body_of_any_weight_rests_on_a_wall_for_ever() {
    let laws = [quadratic(1e-8), barrier(50.0)];
    for (name, shape, start) in [
        ("disc", disc("body"), [0.0, 0.56, 0.2]),
        ("ellipse", ellipse("body", 0.8, 0.3), [0.0, 0.62, 0.5]),
        ("peanut", peanut(), [0.0, 0.58, 0.02]),
    ] {
        let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[shape]).unwrap();
        for law in laws {
            for weight in [1.0, 1e3] {
                let load = [[0.0, -weight, 0.0]];
                let mut damped = Mock::planar(&gaps, law, &[start], &load);
                (damped.step, damped.friction) = (0.05, Some(planar([weight, weight, weight])));
                assert_rests(&mut damped, &format!("overdamped {name} {weight}"));
                if name == "disc" {
                    let mut inert = Mock::planar(&gaps, law, &[start], &load);
                    (inert.step, inert.mass) = (0.05, planar([weight, weight, 0.1 * weight]));
                    assert_rests(&mut inert, &format!("inertial {name} {weight}"));
                }
            }
        }
    }
}

#[test]
fn a_peanut_rests_on_two_feet_and_a_disc_in_a_corner_on_two_walls() {
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[peanut()]).unwrap();
    let mut mock = Mock::planar(&gaps, barrier(50.0), &[[0.0, 0.58, 0.02]], &[[0.0, -1.0, 0.0]]);
    (mock.step, mock.friction) = (0.05, Some(planar([1.0; 3])));
    let end = mock.run(2000);
    let [left, right] = end.loads.contacts[..] else { panic!("{:?}", end.loads.contacts) };
    assert!((left.force - 0.5).abs() < 1e-9 && (right.force - 0.5).abs() < 1e-9);
    assert!(end.poses[0].angle().abs() < 1e-9, "lies flat");

    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[disc("disc")]).unwrap();
    let weight = [-3.0, -4.0, 0.0];
    for law in [quadratic(1e-7), barrier(10.0)] {
        let mut mock = Mock::planar(&gaps, law, &[[-4.4, 0.7, 0.0]], &[weight]);
        (mock.step, mock.friction) = (0.05, Some(planar([1.0; 3])));
        let end = assert_rests(&mut mock, "disc in a corner");
        let sides: Vec<(Partner, f64)> =
            end.loads.contacts.iter().map(|c| (c.pair.partner, c.force)).collect();
        assert_eq!(sides.len(), 2);
        for (partner, force) in sides {
            let wanted = if partner == Partner::Wall(0) { 3.0 } else { 4.0 };
            assert!((force - wanted).abs() < 1e-9, "{partner:?} {force}");
        }
    }
}

#[test]
fn a_heap_settles() {
    let (gaps, poses) = heap();
    for law in [quadratic(1e-7), barrier(20.0)] {
        let load = [[0.0, -1.0, 0.0], [0.0, -0.5, 0.0], [0.0, -2.0, 0.0]];
        let mut mock = Mock::new(&gaps, law, &poses, &load.map(planar));
        (mock.step, mock.friction) = (0.05, Some(planar([1.0, 1.0, 0.2])));
        let mut most = 0;
        for _ in 0..3000 {
            let end = mock.advance().unwrap();
            assert!(end.loads.minimum_gap.unwrap().gap > 0.0);
            most = most.max(end.iterations);
        }
        assert!(most <= 40, "{most} iterations");
    }
}

#[test]
fn an_imposed_body_pushes_a_free_one() {
    let gaps = PlanarGaps::new(&tank(), &[2], &[disc("pusher"), disc("pushed")]).unwrap();
    let law = barrier(1.0);
    let mut mobility = DMatrix::zeros(6, 6);
    (3..6).for_each(|row| mobility[(row, row)] = 1.0);
    let mut poses = poses([[0.0, 3.0, 0.0], [1.04, 3.0, 0.0]]);
    for _ in 0..50 {
        let speed = [[0.5, 0.0, 0.0], [0.0; 3]].map(Twist::planar);
        let step = ContactStep {
            gaps: &gaps,
            law: &law,
            modes: Modes::PLANAR,
            bodies: &[0, 1],
            free_velocities: &speed,
            mobility: &mobility,
            predicted: &poses,
            predicted_velocities: &[Twist::default(); 2],
            coefficient: 0.2,
            start: &poses,
            elastic: None,
        };
        // In one step the pusher goes farther than the gap
        let end = step.solve().unwrap();
        assert!((end.velocities[0].linear.x - 0.5).abs() < 1e-14);
        let pushed = end.velocities[1].linear.x;
        assert!((pushed - end.loads.wrenches[1].force.x).abs() < 1e-12);
        poses = end.poses;
    }
    // Pushed along at the same speed, at the gap whose force is its friction
    let gap = poses[1].center.x - poses[0].center.x - 1.0;
    assert!((gap - gap_of_force(&law, 0.5)).abs() < 1e-10);
}
