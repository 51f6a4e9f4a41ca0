//! Joints and roots by exact solutions: pendulums, servos, stops, rails, springs and tendons.

use alewife_reduced::tree::{
    Command, Drive, Joint, JointKind, Link, Pose, Root, Scheme, Site, Stepper, Stops, Symmetric,
    Tendon, Tree, TreeError, Weight, vector,
};

const GRAVITY: f64 = 9.81;

fn none(_: f64, _: usize) -> Command<f64> {
    Command::none()
}

fn advance(tree: &Tree<f64>, scheme: Scheme, start: [f64; 2], n: u32, end: f64) -> [f64; 2] {
    let mut state = tree.rest();
    let at = state.coordinates.len() - 1;
    [state.coordinates[at], state.velocities[at]] = start;
    let mut stepper = Stepper::new(tree, scheme);
    for _ in 0..n {
        stepper.step(tree, &mut state, end / f64::from(n), &none).expect("it moves");
    }
    [state.coordinates[at], state.velocities[at]]
}

fn massless() -> Symmetric<f64> {
    Symmetric::zero()
}

/// A point of a mass at a place on a link.
fn point(mass: f64, place: [f64; 3]) -> Symmetric<f64> {
    Symmetric::rigid(mass, vector([0.0; 3])).seen_from(&Pose::at(vector(place)))
}

fn weight(mass: f64, place: [f64; 3]) -> Option<Weight<f64>> {
    let center = vector(place);
    Some(Weight { mass, mass_center: center, displaced: 0.0, buoyancy_center: center })
}

/// Accelerations of the double pendulum of the mechanics books: points of masses m1, m2 on rods l1, l2, angles
/// from the vertical.
fn double_pendulum([a, b]: [f64; 2], [u, w]: [f64; 2]) -> [f64; 2] {
    let (m, n, l, k, g) = (1.3, 0.7, 0.5, 0.8, GRAVITY);
    let d = a - b;
    let under = 2.0 * m + n - n * (2.0 * d).cos();
    let first = -g * (2.0 * m + n) * a.sin()
        - n * g * (a - 2.0 * b).sin()
        - 2.0 * d.sin() * n * (w * w * k + u * u * l * d.cos());
    let second =
        2.0 * d.sin() * (u * u * l * (m + n) + g * (m + n) * a.cos() + w * w * k * n * d.cos());
    [first / (l * under), second / (k * under)]
}

#[test]
fn a_double_pendulum_accelerates_as_in_the_books() {
    let hinge = || Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]);
    let (upper, lower) = ([0.0, -0.5, 0.0], [0.0, -0.8, 0.0]);
    let first = Link { weight: weight(1.3, upper), ..Link::new(0, hinge(), point(1.3, upper)) };
    let second = Link { weight: weight(0.7, lower), ..Link::new(1, hinge(), point(0.7, lower)) };
    let links = vec![Link::root(massless()), first, second.placed(upper)];
    let tree = Tree::new(Root::Held, links).expect("a tree").in_gravity([0.0, -GRAVITY, 0.0]);
    let mut state = tree.rest();
    // The second angle is that between the rods
    state.coordinates = vec![0.6, 0.5];
    state.velocities = vec![1.2, -2.0];
    let [first, second] = double_pendulum([0.6, 1.1], [1.2, -0.8]);
    let mut stepper = Stepper::new(&tree, Scheme::Euler);
    stepper.step(&tree, &mut state, 1e-9, &none).expect("it moves");
    let found = [state.accelerations[0], state.accelerations[0] + state.accelerations[1]];
    assert!((found[0] - first).abs() < 1e-6 && (found[1] - second).abs() < 1e-6, "{found:?}");
}

/// A mass of two on a rail along x, between a spring and a damper.
fn rail(drive: Drive<f64>, stops: Option<Stops<f64>>) -> Tree<f64> {
    let joint = Joint {
        stiffness: 18.0,
        rest: 0.2,
        damping: 0.8,
        drive,
        stops,
        ..Joint::new(JointKind::Slider, [1.0, 0.0, 0.0])
    };
    let body = Symmetric::rigid(2.0, vector([1.0; 3]));
    let links = vec![Link::root(massless()), Link::new(0, joint, body)];
    Tree::new(Root::Held, links).expect("a rail is a tree")
}

#[test]
fn a_sprung_rail_follows_the_damped_oscillator_at_the_order_of_the_stepper() {
    let tree = rail(Drive::Effort, None);
    let (decay, rate) = (0.2, (9.0_f64 - 0.04).sqrt());
    let exact = |t: f64| {
        let (sine, cosine) = (rate * t).sin_cos();
        0.2 + (-decay * t).exp() * (0.5 * cosine + decay * 0.5 / rate * sine)
    };
    for (scheme, order) in [(Scheme::Euler, 1.0), (Scheme::Midpoint, 2.0)] {
        let wrong =
            [200, 400].map(|n| (advance(&tree, scheme, [0.7, 0.0], n, 2.0)[0] - exact(2.0)).abs());
        let found = (wrong[0] / wrong[1]).log2();
        assert!((found - order).abs() < 0.1, "{scheme:?}: {wrong:?}");
    }
}

/// A rotor that turns a hinge by a gear adds its moment times the square of the gear to that of the link: the period of the
/// spring is 2 pi sqrt((I + A) / k), and the effort of a joint that is given (I + A) times its acceleration.
#[test]
fn what_turns_with_a_joint_alone_counts_for_its_coordinate() {
    let (inertia, armature, stiffness) = (1.5, 0.7, 18.0);
    let hinge = |drive, armature| Joint {
        stiffness,
        armature,
        drive,
        ..Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0])
    };
    let tree = |drive, armature| {
        let body = Symmetric::rigid(2.0, vector([1.0, 1.0, inertia]));
        let links = vec![Link::root(massless()), Link::new(0, hinge(drive, armature), body)];
        Tree::new(Root::Held, links).expect("a tree")
    };
    let rate = (stiffness / (inertia + armature)).sqrt();
    let wrong = [200, 400].map(|n| {
        let end = advance(&tree(Drive::Effort, armature), Scheme::Midpoint, [0.7, 0.0], n, 2.0);
        (end[0] - 0.7 * (rate * 2.0).cos()).abs()
    });
    assert!(((wrong[0] / wrong[1]).log2() - 2.0).abs() < 0.1 && wrong[1] < 1e-2, "{wrong:?}");
    // What a motor has to give more because of the rotor, for a rate that grows by 3 a second
    let effort = |armature| {
        let (tree, command) = (tree(Drive::Rate, armature), |time: f64, _: usize| Command {
            rate: 3.0 * time,
            ..Command::none()
        });
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Euler);
        stepper.step(&tree, &mut state, 1e-3, &command).expect("it moves");
        state.efforts[0]
    };
    let more = effort(armature) - effort(0.0);
    assert!((more - 3.0 * armature).abs() < 1e-9, "{more}");
}

#[test]
fn a_stop_holds_and_a_servo_reaches_its_rate_within_its_limit() {
    let stops = Stops { lower: -1.0, upper: 0.1, stiffness: 1e6, damping: 2e3 };
    let [place, rate] =
        advance(&rail(Drive::Effort, Some(stops)), Scheme::Euler, [0.0, 1.0], 4000, 4.0);
    assert!((0.1..0.1001).contains(&place) && rate.abs() < 1e-6, "{place} {rate}");
    let free = Joint {
        drive: Drive::Servo { gain: 50.0, limit: 3.0 },
        ..Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0])
    };
    let body = Symmetric::rigid(2.0, vector([1.0, 1.0, 1.5]));
    let links = vec![Link::root(massless()), Link::new(0, free, body)];
    let tree = Tree::new(Root::Held, links).expect("a tree");
    let run = |end: f64| {
        let mut state = tree.rest();
        let mut stepper = Stepper::new(&tree, Scheme::Euler);
        let command = |_: f64, _: usize| Command { rate: 4.0, ..Command::none() };
        for _ in 0..1000 {
            stepper.step(&tree, &mut state, end / 1000.0, &command).expect("it moves");
        }
        state.velocities[0]
    };
    // At its limit it accelerates by 2 a second
    assert!((run(1.0) - 2.0).abs() < 1e-9 && (run(5.0) - 4.0).abs() < 1e-6);
}

#[test]
fn a_tendon_pulls_as_its_length_says_and_never_pushes() {
    let joint = Joint::new(JointKind::Slider, [1.0, 0.0, 0.0]);
    let links =
        vec![Link::root(massless()), Link::new(0, joint, Symmetric::rigid(1.0, vector([1.0; 3])))];
    let site = |link, place| Site { link, place: vector(place) };
    let tendon = Tendon {
        sites: vec![site(0, [0.0, 0.3, 0.0]), site(1, [0.0; 3])],
        stiffness: 100.0,
        damping: 0.0,
        rest: 0.45,
        pushes: false,
    };
    let tree = Tree::new(Root::Held, links).and_then(|tree| tree.with_tendons(vec![tendon]));
    let tree = tree.expect("a tree");
    let force = |place: f64| {
        let mut state = tree.rest();
        state.coordinates[0] = place;
        let mut stepper = Stepper::new(&tree, Scheme::Euler);
        stepper.step(&tree, &mut state, 1e-6, &none).expect("it moves");
        state.accelerations[0]
    };
    // 0.3, 0.4, 0.5: stretched by 0.05, pulling by 5 at the slope 0.8
    assert!((force(0.4) + 4.0).abs() < 1e-6 && force(0.2).abs() < 1e-12);
}

#[test]
fn what_nothing_holds_and_wrong_trees_are_refused() {
    let link = |joint| Link::new(0, joint, massless());
    let hinge = Joint::new(JointKind::Hinge, [0.0, 0.0, 1.0]);
    let tree = Tree::new(Root::Held, vec![Link::root(massless()), link(hinge.clone())]);
    let tree = tree.expect("a tree");
    let mut state = tree.rest();
    let refused = Stepper::new(&tree, Scheme::Euler).step(&tree, &mut state, 0.1, &none);
    assert_eq!(refused, Err(TreeError::Singular { time: 0.0, coordinate: 0 }));
    let late = vec![Link::root(massless()), Link { parent: 1, ..link(hinge) }];
    assert!(matches!(Tree::new(Root::Held, late), Err(TreeError::Link { link: 1, .. })));
    let long = vec![Link::root(massless()), link(Joint::new(JointKind::Hinge, [0.0, 0.0, 2.0]))];
    assert!(matches!(Tree::new(Root::Held, long), Err(TreeError::Link { link: 1, .. })));
    assert!(matches!(Tree::<f64>::new(Root::Free, Vec::new()), Err(TreeError::Given(_))));
}
