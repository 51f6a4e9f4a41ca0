//! Pairs of points, their derivatives and loads; who may meet whom.

use std::f64::consts::FRAC_PI_4;

use alewife_core::body::Pose;
use alewife_core::contact::{ContactError, ContactLoads, Gaps, Partner, PlanarGaps};
use alewife_mesh::{Domain, Point, Shape};

use crate::common::{
    Mock, RANGE, assert_derivatives, barrier, body, disc, ellipse, gap_of_force, heap, moved,
    peanut, planar, poses, quadratic, tank,
};

#[test]
fn action_is_reaction_and_torques_balance_about_any_point() {
    let (gaps, poses) = heap();
    for law in [quadratic(1e-4), barrier(3.0)] {
        let loads = ContactLoads::new(&gaps, &law, &poses);
        let pairs: Vec<_> = loads
            .contacts
            .iter()
            .filter(|contact| matches!(contact.pair.partner, Partner::Body(_)))
            .collect();
        assert!(!pairs.is_empty());
        for contact in pairs {
            let Partner::Body(other) = contact.pair.partner else { panic!("is a pair") };
            let sides = [contact.pair.body, other];
            let wrenches = contact.pair.loads(contact.force);
            assert_eq!(wrenches[0].force, -wrenches[1].force);
            for about in [[0.0, 0.0], [3.0, -7.0], [100.0, 40.0]] {
                let torque: f64 = (0..2)
                    .map(|side| {
                        let center = poses[sides[side]].center;
                        let (x, y) = (center.x - about[0], center.y - about[1]);
                        let force = wrenches[side].force;
                        wrenches[side].torque.z + x * force.y - y * force.x
                    })
                    .sum();
                assert!(torque.abs() < 1e-13 * contact.force * 100.0, "{torque}");
            }
        }
        // Walls take the rest
        let sum: f64 = loads.wrenches.iter().map(|wrench| wrench.force.y).sum();
        let floor: f64 = loads
            .contacts
            .iter()
            .filter(|contact| matches!(contact.pair.partner, Partner::Wall(2)))
            .map(|contact| contact.force)
            .sum();
        assert!((sum - floor).abs() < 1e-13 * floor);
    }
}

#[test]
fn loads_are_derivatives_of_the_energy() {
    let (gaps, poses) = heap();
    for law in [quadratic(1e-4), barrier(3.0)] {
        let energy = |poses: &[Pose]| -> f64 {
            gaps.pairs(poses, RANGE).iter().map(|pair| law.energy(pair.gap)).sum()
        };
        let loads = ContactLoads::new(&gaps, &law, &poses);
        let scale = loads.wrenches.iter().map(|w| w.force.norm()).fold(0.0, f64::max);
        for body in 0..3 {
            let wrench = loads.wrenches[body];
            for mode in gaps.modes().iter() {
                let (h, load) = (1e-6, wrench.component(mode));
                let energy_at = |by: f64| {
                    let mut poses = poses.clone();
                    poses[body] = moved(&poses[body], mode.index(), by);
                    energy(&poses)
                };
                let difference = -(energy_at(h) - energy_at(-h)) / (2.0 * h);
                assert!((difference - load).abs() < 1e-6 * scale, "{difference} {load}");
            }
        }
    }
}

#[test]
fn gaps_have_the_derivatives_they_claim() {
    let pair = [ellipse("a", 0.8, 0.3), peanut()];
    let gaps = PlanarGaps::new(&tank(), &[2], &pair).unwrap();
    assert_derivatives(&gaps, &poses([[0.0, 2.0, 0.5], [0.3, 3.2, 1.1]]), Partner::Body(1));
    assert_derivatives(&gaps, &poses([[0.0, 0.8, 0.5], [0.3, 2.9, 1.1]]), Partner::Wall(2));
    let round = Domain::Disc { center: Point::<2>::new(0.2, 0.1), radius: 2.0 };
    let gaps = PlanarGaps::new(&round, &[0], &pair).unwrap();
    assert_derivatives(&gaps, &poses([[1.2, -0.7, 0.5], [-0.5, 0.5, 0.0]]), Partner::Wall(0));
    // An off-centre spline turns about its centre of mass
    let points = vec![[2.0, 0.3], [1.5, 1.0], [0.6, 0.4], [0.8, -0.5], [1.6, -0.6]];
    let off = [body("off", Shape::Spline { points }), ellipse("a", 0.8, 0.3)];
    let gaps = PlanarGaps::new(&tank(), &[2], &off).unwrap();
    assert_derivatives(&gaps, &poses([[0.0, 0.9, 0.4], [0.0, 5.0, 0.0]]), Partner::Wall(2));
    assert_derivatives(&gaps, &poses([[0.0, 3.0, 0.4], [1.7, 3.1, 0.3]]), Partner::Body(1));
}

#[test]
fn mirrored_bodies_have_mirrored_forces() {
    let bodies = [ellipse("a", 0.8, 0.3), ellipse("b", 0.8, 0.3), peanut()];
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
    for law in [quadratic(1e-4), barrier(10.0)] {
        let mut poses = poses([[-0.79, 0.4, 0.3], [0.79, 0.4, -0.3], [0.0, 2.0, 0.0]]);
        while gaps.minimum_gap(&poses).unwrap().body != 0
            || ContactLoads::new(&gaps, &law, &poses).contacts.len() < 5
        {
            poses[2] = moved(&poses[2], 1, -1e-3);
        }
        let loads = ContactLoads::new(&gaps, &law, &poses);
        assert!(loads.contacts.len() >= 3, "{:?}", loads.contacts);
        let [left, right, middle] = loads.wrenches[..] else { panic!("three bodies") };
        let scale = 1e-14 * loads.wrenches.iter().map(|w| w.force.norm()).fold(0.0, f64::max);
        assert!(left.force.norm() > 0.0 && scale > 0.0);
        assert!((left.force.x + right.force.x).abs() <= scale, "{left:?} {right:?}");
        assert!((left.force.y - right.force.y).abs() <= scale, "{left:?} {right:?}");
        assert!((left.torque.z + right.torque.z).abs() <= scale, "{left:?} {right:?}");
        assert!(middle.force.x.abs() <= scale && middle.torque.z.abs() <= scale, "{middle:?}");
    }
}

#[test]
fn spheres_on_the_axis_are_pushed_along_it_only() {
    let domain = Domain::Cylinder { x: [0.0, 10.0], radius: 0.55, periodic_x: false };
    let spheres = ["a", "b"].map(|name| body(name, Shape::Sphere { radius: 0.5 }));
    let gaps = PlanarGaps::new(&domain, &[0, 1, 2], &spheres).unwrap();
    let law = barrier(2.0);
    let poses = poses([[0.53, 0.0, 0.0], [1.56, 0.0, 0.0]]);
    let loads = ContactLoads::new(&gaps, &law, &poses);
    let force = [law.force(0.03) - law.force(0.03), law.force(0.03)];
    for (wrench, wanted) in loads.wrenches.iter().zip(force) {
        assert!((wrench.force.x - wanted).abs() < 1e-12 * law.force(0.03));
        assert_eq!((wrench.force.y, wrench.torque.z), (0.0, 0.0));
    }
    assert!((loads.minimum_gap.unwrap().gap - 0.03).abs() < 1e-15);
    let mut mock = Mock::new(&gaps, law, &poses, &[planar([-1.0, 0.0, 0.0]); 2]);
    (mock.step, mock.friction) = (0.05, Some(planar([1.0; 3])));
    let end = mock.run(500);
    assert!((end.poses[0].center.x - 0.5 - gap_of_force(&law, 2.0)).abs() < 1e-10);
    let between = end.poses[1].center.x - end.poses[0].center.x;
    assert!((between - 1.0 - gap_of_force(&law, 1.0)).abs() < 1e-10);
}

#[test]
fn bodies_meet_across_periodic_sides() {
    let (min, max) = (Point::<2>::new(0.0, 0.0), Point::<2>::new(4.0, 3.0));
    let domain = Domain::Box { min, max, periodic_x: true, periodic_y: false };
    let gaps = PlanarGaps::new(&domain, &[2, 3], &[disc("a"), disc("b")]).unwrap();
    assert!(matches!(
        PlanarGaps::new(&domain, &[0], &[disc("a")]),
        Err(ContactError::NoWall { side: 0 })
    ));
    // The second one has travelled around the domain twice
    for turns in [0.0, 8.0, -4.0] {
        let poses = poses([[0.3, 1.0, 0.0], [3.28 + turns, 1.0, 0.0]]);
        let loads = ContactLoads::new(&gaps, &barrier(1.0), &poses);
        assert_eq!(loads.contacts.len(), 1, "{turns}");
        assert!((loads.contacts[0].pair.gap - 0.02).abs() < 1e-14);
        assert!(loads.wrenches[0].force.x > 0.0);
    }
}

#[test]
fn what_cannot_be_solved_is_refused_by_name() {
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &[disc("heavy")]).unwrap();
    // The largest force is 0.05^2 / 1e-3 = 2.5
    let mut sinking =
        Mock::planar(&gaps, quadratic(1e-3), &[[0.0, 0.56, 0.0]], &[[0.0, -3.0, 0.0]]);
    sinking.friction = Some(planar([1.0; 3]));
    let error = (0..100).find_map(|_| sinking.advance().err()).unwrap();
    match &error {
        ContactError::TooWeak { first, second, gap, greatest } => {
            assert_eq!((first.as_str(), second.as_str()), ("heavy", "bottom"));
            assert!(*gap > 0.0 && *gap < 1e-10 && (greatest - 2.5).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
    let mut touching = Mock::planar(&gaps, barrier(1.0), &[[0.0, 0.4, 0.0]], &[[0.0; 3]]);
    match touching.advance() {
        Err(ContactError::Overlap { first, second, gap }) => {
            assert_eq!((first.as_str(), second.as_str()), ("heavy", "bottom"));
            assert!((gap + 0.1).abs() < 1e-14);
        }
        other => panic!("{other:?}"),
    }
    let mut lost = Mock::planar(&gaps, barrier(1.0), &[[0.0, 1.0, 0.0]], &[[f64::NAN; 3]]);
    assert!(matches!(lost.advance(), Err(ContactError::Input { .. })));
}

#[test]
fn only_bodies_that_may_meet_are_involved() {
    let bodies = [disc("a"), disc("b"), disc("c"), disc("d")];
    let gaps = PlanarGaps::new(&tank(), &[2], &bodies).unwrap();
    let from = poses([[-3.0, 3.0, 0.0], [-1.9, 3.0, 0.0], [2.0, 6.0, 0.0], [2.0, 0.6, 0.0]]);
    let mut to = from.clone();
    assert_eq!(gaps.candidate_bodies(&from, &to, 2.0, RANGE), Vec::<usize>::new());
    to[1] = moved(&to[1], 0, -0.04);
    assert_eq!(gaps.candidate_bodies(&from, &to, 1.0, RANGE), vec![0, 1, 3]);
    let rolled = [from[0], from[1], from[2], Pose::planar(2.0, 0.54, FRAC_PI_4)];
    assert_eq!(gaps.candidate_bodies(&rolled, &rolled, 1.0, RANGE), vec![3]);
}
