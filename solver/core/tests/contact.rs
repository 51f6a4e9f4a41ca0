//! Contact forces: laws, equilibria, balance, rest for ever, symmetry, many contacts at once.
#![expect(clippy::unwrap_used, reason = "a test that cannot set up its bodies has failed")]

use std::f64::consts::{FRAC_PI_4, TAU};

use alewife_core::contact::{
    ContactError, ContactLoads, ContactSolution, ContactStep, Feature, Law, LawKind, Partner,
    Place, Surfaces,
};
use alewife_core::time::Bdf;
use alewife_mesh::{Domain, PlacedShape, Point, Shape};
use nalgebra::{DMatrix, Vector6};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const RANGE: f64 = 0.05;

fn quadratic(epsilon: f64) -> Law {
    Law::new(LawKind::Quadratic { epsilon }, RANGE).unwrap()
}

fn barrier(stiffness: f64) -> Law {
    Law::new(LawKind::Barrier { stiffness }, RANGE).unwrap()
}

fn tank() -> Domain {
    let (min, max) = (Point::<2>::new(-5.0, 0.0), Point::<2>::new(5.0, 10.0));
    Domain::Box { min, max, periodic_x: false, periodic_y: false }
}

fn body(name: &str, shape: Shape) -> PlacedShape {
    PlacedShape { name: name.into(), shape, center: Point::<2>::zeros(), angle: 0.0, size: None }
}

fn disc(name: &str) -> PlacedShape {
    body(name, Shape::Disc { radius: 0.5 })
}

fn ellipse(name: &str, a: f64, b: f64) -> PlacedShape {
    body(name, Shape::Ellipse { semi_axes: [a, b] })
}

/// Two lobes, 0.7 from the centre along x, with a waist between them.
fn peanut() -> PlacedShape {
    let points = (0..24)
        .map(|i| TAU * f64::from(i) / 24.0)
        .map(|t| (t, 0.5 + 0.2 * (2.0 * t).cos()))
        .map(|(t, r)| [r * t.cos(), r * t.sin()])
        .collect();
    body("peanut", Shape::Spline { points })
}

/// Bodies that answer loads without fluid: overdamped, or with inertia by BDF2.
struct Mock<'a> {
    surfaces: &'a Surfaces,
    law: Law,
    step: f64,
    /// Mobility of an overdamped body; mass and moment of inertia otherwise.
    friction: Option<[f64; 3]>,
    mass: [f64; 3],
    load: Vec<[f64; 3]>,
    places: [Vec<Place>; 2],
    velocities: [Vec<[f64; 3]>; 2],
    is_first: bool,
}

impl<'a> Mock<'a> {
    fn new(surfaces: &'a Surfaces, law: Law, places: &[Place], load: &[[f64; 3]]) -> Self {
        let velocities = vec![[0.0; 3]; places.len()];
        Self {
            surfaces,
            law,
            step: 0.01,
            friction: None,
            mass: [1.0, 1.0, 0.1],
            load: load.to_vec(),
            places: [places.to_vec(), places.to_vec()],
            velocities: [velocities.clone(), velocities],
            is_first: true,
        }
    }

    fn advance(&mut self) -> Result<ContactSolution, ContactError> {
        let bdf = if self.is_first {
            Bdf::first_order(self.step)
        } else {
            Bdf::second_order(self.step, self.step)
        };
        let n = self.load.len();
        let mut mobility = DMatrix::zeros(3 * n, 3 * n);
        let mut free = vec![[0.0; 3]; n];
        let mut predicted = self.places[0].clone();
        let ahead = self.velocities[0].clone();
        for i in 0..n {
            for mode in 0..3 {
                let answer = match self.friction {
                    Some(friction) => 1.0 / friction[mode],
                    None => 1.0 / (bdf.next * self.mass[mode]),
                };
                mobility[(3 * i + mode, 3 * i + mode)] = answer;
                let history = bdf.history(self.velocities[0][i][mode], self.velocities[1][i][mode]);
                let inertia = if self.friction.is_some() { 0.0 } else { self.mass[mode] };
                free[i][mode] = answer * (self.load[i][mode] - inertia * history);
                let (now, previous) = (self.places[0][i][mode], self.places[1][i][mode]);
                predicted[i][mode] = bdf.integrate(ahead[i][mode], now, previous);
            }
        }
        let bodies: Vec<usize> = (0..n).collect();
        let solution = ContactStep {
            surfaces: self.surfaces,
            law: &self.law,
            bodies: &bodies,
            free_velocities: &free,
            mobility: &mobility,
            predicted: &predicted,
            predicted_velocities: &ahead,
            coefficient: 1.0 / bdf.next,
            apart: &self.places[0],
        }
        .solve()?;
        let now = std::mem::replace(&mut self.places[0], solution.places.clone());
        self.places[1] = now;
        let now = std::mem::replace(&mut self.velocities[0], solution.velocities.clone());
        self.velocities[1] = now;
        self.is_first = false;
        Ok(solution)
    }

    fn run(&mut self, steps: usize) -> ContactSolution {
        (1..steps).for_each(|_| drop(self.advance().unwrap()));
        self.advance().unwrap()
    }
}

/// The gap at which a law gives a force, by bisection.
fn gap_of_force(law: &Law, force: f64) -> f64 {
    let (mut low, mut high) = (0.0, law.range());
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if law.force(middle) > force { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn fastest(solution: &ContactSolution) -> f64 {
    solution.velocities.iter().flatten().fold(0.0, |most, v| v.abs().max(most))
}

#[test]
fn two_discs_pressed_together_come_to_the_gap_of_the_law() {
    let surfaces = Surfaces::new(&tank(), &[], &[disc("a"), disc("b")]).unwrap();
    let (c, s) = (0.6, 0.8);
    let places = [[0.0, 5.0, 0.0], [1.2 * c, 5.0 + 1.2 * s, 0.3]];
    for law in [quadratic(1e-3), quadratic(1e-9), barrier(10.0), barrier(1e-4), barrier(1e6)] {
        for force in [0.3, 1.0, 2.4] {
            let load = [[force * c, force * s, 0.0], [-force * c, -force * s, 0.0]];
            let mut mock = Mock::new(&surfaces, law, &places, &load);
            mock.friction = Some([1.0, 1.0, 1.0]);
            // Not much longer: pressed from outside, discs are about to slip past each other
            let end = mock.run(150);
            let contact = &end.loads.contacts[0];
            let wanted = gap_of_force(&law, force);
            assert!((contact.feature.at.gap - wanted).abs() < 1e-10, "{law:?} {force}");
            assert!((contact.force / force - 1.0).abs() < 1e-10, "{law:?} {force}");
            assert!((end.loads.least_gap.unwrap().gap - wanted).abs() < 1e-10);
            assert!(fastest(&end) < 1e-10, "{law:?} {force}: {}", fastest(&end));
        }
    }
}

#[test]
fn steps_are_not_bound_to_the_stiffness() {
    let laws = [quadratic(1e-12), quadratic(1e-6), barrier(1e-3), barrier(1e9)];
    // Falls by up to 10 000 diameters in one step, but for the floor
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[disc("disc")]).unwrap();
    for law in laws {
        for step in [0.1, 1.0, 100.0, 1e4] {
            let mut mock = Mock::new(&surfaces, law, &[[0.0, 3.0, 0.0]], &[[0.1, -1.0, 0.0]]);
            (mock.step, mock.friction) = (step, Some([1.0; 3]));
            for _ in 0..5 {
                let end = mock.advance().unwrap_or_else(|e| panic!("{law:?} {step}: {e}"));
                assert!(end.loads.least_gap.unwrap().gap > 0.0);
                assert!(end.iterations < 60, "{law:?} {step}: {}", end.iterations);
            }
        }
    }
    // One disc slides off another, by up to six times the range in a step
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[disc("a"), disc("b")]).unwrap();
    let places = [[0.1, 3.0, 0.0], [0.0, 1.8, 0.0]];
    for law in laws {
        for step in [0.003, 0.03, 0.3] {
            let load = [[0.0, -1.0, 0.0]; 2];
            let mut mock = Mock::new(&surfaces, law, &places, &load);
            (mock.step, mock.friction) = (step, Some([1.0; 3]));
            for _ in 0..(12.0 / step) as usize {
                let end = mock.advance().unwrap_or_else(|e| panic!("{law:?} {step}: {e}"));
                assert!(end.loads.least_gap.unwrap().gap > 0.0);
                assert!(end.iterations < 60, "{law:?} {step}: {}", end.iterations);
                // Neither has passed through the other, or the floor
                assert!(end.places[0][0] > end.places[1][0] && end.places[1][1] > 0.5);
            }
            assert!((mock.places[0][0][1] - mock.places[0][1][1]).abs() < 1e-3, "side by side");
        }
    }
}

/// A disc, an ellipse and a spline in a heap on the floor, 0.02 apart from each other.
fn heap() -> (Surfaces, Vec<Place>) {
    let bodies = [disc("disc"), ellipse("ellipse", 0.8, 0.3), peanut()];
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
    let mut places = vec![[0.0, 0.52, 0.3], [2.0, 0.37, 0.2], [0.5, 3.0, 0.9]];
    for (body, mode) in [(1, 0), (2, 1)] {
        let touches = |features: &[Feature]| {
            features.iter().any(|f| f.partner == Partner::Body(body) && f.at.gap < 0.02)
        };
        while !touches(&surfaces.features(&places, RANGE)) {
            places[body][mode] -= 1e-3;
        }
    }
    (surfaces, places)
}

#[test]
fn action_is_reaction_and_torques_balance_about_any_point() {
    let (surfaces, places) = heap();
    for law in [quadratic(1e-4), barrier(3.0)] {
        let loads = ContactLoads::new(&surfaces, &law, &places);
        let pairs: Vec<_> = loads
            .contacts
            .iter()
            .filter(|contact| matches!(contact.feature.partner, Partner::Body(_)))
            .collect();
        assert!(!pairs.is_empty());
        for contact in pairs {
            let Partner::Body(other) = contact.feature.partner else { panic!("is a pair") };
            let sides = [contact.feature.body, other];
            let wrenches = contact.feature.loads(contact.force);
            assert_eq!(wrenches[0].force, -wrenches[1].force);
            for about in [[0.0, 0.0], [3.0, -7.0], [100.0, 40.0]] {
                let torque: f64 = (0..2)
                    .map(|side| {
                        let place = places[sides[side]];
                        let (x, y) = (place[0] - about[0], place[1] - about[1]);
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
            .filter(|contact| matches!(contact.feature.partner, Partner::Wall(2)))
            .map(|contact| contact.force)
            .sum();
        assert!((sum - floor).abs() < 1e-13 * floor);
    }
}

#[test]
fn loads_are_derivatives_of_the_energy() {
    let (surfaces, places) = heap();
    for law in [quadratic(1e-4), barrier(3.0)] {
        let energy = |places: &[Place]| -> f64 {
            let features = surfaces.features(places, RANGE);
            features.iter().map(|feature| law.energy(feature.at.gap)).sum()
        };
        let loads = ContactLoads::new(&surfaces, &law, &places);
        let scale = loads.wrenches.iter().map(|w| w.force.norm()).fold(0.0, f64::max);
        for body in 0..3 {
            let wrench = loads.wrenches[body];
            for (mode, load) in [wrench.force.x, wrench.force.y, wrench.torque.z].iter().enumerate()
            {
                let h = 1e-6;
                let moved = |by: f64| {
                    let mut places = places.clone();
                    places[body][mode] += by;
                    energy(&places)
                };
                let difference = -(moved(h) - moved(-h)) / (2.0 * h);
                assert!((difference - load).abs() < 1e-6 * scale, "{difference} {load}");
            }
        }
    }
}

/// Gradient and second derivatives of the gap against differences along random ways.
fn assert_derivatives(surfaces: &Surfaces, places: &[Place], partner: Partner) {
    let feature = |places: &[Place]| -> Feature {
        let found = surfaces.features(places, 0.4);
        *found.iter().find(|feature| feature.body == 0 && feature.partner == partner).unwrap()
    };
    let at = feature(places);
    let (gradient, hessian) = (at.gradient(), at.hessian());
    for seed in 1..8 {
        let way = Vector6::from_fn(|i, _| (f64::from(seed) * (1.3 + i as f64)).sin());
        let moved = |by: f64| {
            let mut places = places.to_vec();
            for mode in 0..3 {
                places[0][mode] += by * way[mode];
                if let Partner::Body(other) = partner {
                    places[other][mode] += by * way[3 + mode];
                }
            }
            feature(&places)
        };
        let mut way = way;
        if matches!(partner, Partner::Wall(_)) {
            way.fixed_rows_mut::<3>(3).fill(0.0);
        }
        let h = 1e-5;
        let (more, less) = (moved(h), moved(-h));
        let rate = (more.at.gap - less.at.gap) / (2.0 * h);
        assert!((rate - gradient.dot(&way)).abs() < 1e-8, "{rate} {}", gradient.dot(&way));
        let bend = (more.gradient() - less.gradient()).dot(&way) / (2.0 * h);
        let wanted = way.dot(&(hessian * way));
        assert!((bend - wanted).abs() < 1e-7 * (1.0 + wanted.abs()), "{bend} {wanted}");
    }
}

#[test]
fn gaps_have_the_derivatives_they_claim() {
    let pair = [ellipse("a", 0.8, 0.3), peanut()];
    let surfaces = Surfaces::new(&tank(), &[2], &pair).unwrap();
    assert_derivatives(&surfaces, &[[0.0, 2.0, 0.5], [0.3, 3.2, 1.1]], Partner::Body(1));
    assert_derivatives(&surfaces, &[[0.0, 0.8, 0.5], [0.3, 2.9, 1.1]], Partner::Wall(2));
    let round = Domain::Disc { center: Point::<2>::new(0.2, 0.1), radius: 2.0 };
    let surfaces = Surfaces::new(&round, &[0], &pair).unwrap();
    assert_derivatives(&surfaces, &[[1.2, -0.7, 0.5], [-0.5, 0.5, 0.0]], Partner::Wall(0));
    // An off-centre spline turns about its centre of mass
    let points = vec![[2.0, 0.3], [1.5, 1.0], [0.6, 0.4], [0.8, -0.5], [1.6, -0.6]];
    let off = [body("off", Shape::Spline { points }), ellipse("a", 0.8, 0.3)];
    let surfaces = Surfaces::new(&tank(), &[2], &off).unwrap();
    assert_derivatives(&surfaces, &[[0.0, 0.9, 0.4], [0.0, 5.0, 0.0]], Partner::Wall(2));
    assert_derivatives(&surfaces, &[[0.0, 3.0, 0.4], [1.7, 3.1, 0.3]], Partner::Body(1));
}

/// 10 000 steps: at the end at rest, and the gap the same as long before.
fn assert_rests(mock: &mut Mock<'_>, what: &str) -> ContactSolution {
    mock.run(5000);
    let gaps = |solution: &ContactSolution| -> Vec<f64> {
        solution.loads.contacts.iter().map(|contact| contact.feature.at.gap).collect()
    };
    let middle = mock.advance().unwrap();
    let (mut before, place) = (gaps(&middle), middle.places[0]);
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
    for mode in 0..3 {
        assert!((end.places[0][mode] - place[mode]).abs() < 1e-11, "{what}: drifts");
    }
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
        let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[shape]).unwrap();
        for law in laws {
            for weight in [1.0, 1e3] {
                let load = [[0.0, -weight, 0.0]];
                let mut damped = Mock::new(&surfaces, law, &[start], &load);
                (damped.step, damped.friction) = (0.05, Some([weight, weight, weight]));
                assert_rests(&mut damped, &format!("overdamped {name} {weight}"));
                if name == "disc" {
                    let mut inert = Mock::new(&surfaces, law, &[start], &load);
                    (inert.step, inert.mass) = (0.05, [weight, weight, 0.1 * weight]);
                    assert_rests(&mut inert, &format!("inertial {name} {weight}"));
                }
            }
        }
    }
}

#[test]
fn a_peanut_rests_on_two_feet_and_a_disc_in_a_corner_on_two_walls() {
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[peanut()]).unwrap();
    let mut mock = Mock::new(&surfaces, barrier(50.0), &[[0.0, 0.58, 0.02]], &[[0.0, -1.0, 0.0]]);
    (mock.step, mock.friction) = (0.05, Some([1.0; 3]));
    let end = mock.run(2000);
    let [left, right] = end.loads.contacts[..] else { panic!("{:?}", end.loads.contacts) };
    assert!((left.force - 0.5).abs() < 1e-9 && (right.force - 0.5).abs() < 1e-9);
    assert!(end.places[0][2].abs() < 1e-9, "lies flat");

    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[disc("disc")]).unwrap();
    let weight = [-3.0, -4.0, 0.0];
    for law in [quadratic(1e-7), barrier(10.0)] {
        let mut mock = Mock::new(&surfaces, law, &[[-4.4, 0.7, 0.0]], &[weight]);
        (mock.step, mock.friction) = (0.05, Some([1.0; 3]));
        let end = assert_rests(&mut mock, "disc in a corner");
        let sides: Vec<(Partner, f64)> =
            end.loads.contacts.iter().map(|c| (c.feature.partner, c.force)).collect();
        assert_eq!(sides.len(), 2);
        for (partner, force) in sides {
            let wanted = if partner == Partner::Wall(0) { 3.0 } else { 4.0 };
            assert!((force - wanted).abs() < 1e-9, "{partner:?} {force}");
        }
    }
}

#[test]
fn a_heap_settles() {
    let (surfaces, places) = heap();
    for law in [quadratic(1e-7), barrier(20.0)] {
        let load = [[0.0, -1.0, 0.0], [0.0, -0.5, 0.0], [0.0, -2.0, 0.0]];
        let mut mock = Mock::new(&surfaces, law, &places, &load);
        (mock.step, mock.friction) = (0.05, Some([1.0, 1.0, 0.2]));
        let mut most = 0;
        for _ in 0..3000 {
            let end = mock.advance().unwrap();
            assert!(end.loads.least_gap.unwrap().gap > 0.0);
            most = most.max(end.iterations);
        }
        assert!(most <= 40, "{most} iterations");
    }
}

#[test]
fn mirrored_bodies_have_mirrored_forces() {
    let bodies = [ellipse("a", 0.8, 0.3), ellipse("b", 0.8, 0.3), peanut()];
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
    for law in [quadratic(1e-4), barrier(10.0)] {
        let mut places = [[-0.79, 0.4, 0.3], [0.79, 0.4, -0.3], [0.0, 2.0, 0.0]];
        while surfaces.least_gap(&places[..]).unwrap().body != 0
            || ContactLoads::new(&surfaces, &law, &places).contacts.len() < 5
        {
            places[2][1] -= 1e-3;
        }
        let loads = ContactLoads::new(&surfaces, &law, &places);
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
    let surfaces = Surfaces::new(&domain, &[0, 1, 2], &spheres).unwrap();
    let law = barrier(2.0);
    let places = [[0.53, 0.0, 0.0], [1.56, 0.0, 0.0]];
    let loads = ContactLoads::new(&surfaces, &law, &places);
    let force = [law.force(0.03) - law.force(0.03), law.force(0.03)];
    for (wrench, wanted) in loads.wrenches.iter().zip(force) {
        assert!((wrench.force.x - wanted).abs() < 1e-12 * law.force(0.03));
        assert_eq!((wrench.force.y, wrench.torque.z), (0.0, 0.0));
    }
    assert!((loads.least_gap.unwrap().gap - 0.03).abs() < 1e-15);
    let mut mock = Mock::new(&surfaces, law, &places, &[[-1.0, 0.0, 0.0]; 2]);
    (mock.step, mock.friction) = (0.05, Some([1.0; 3]));
    let end = mock.run(500);
    assert!((end.places[0][0] - 0.5 - gap_of_force(&law, 2.0)).abs() < 1e-10);
    assert!((end.places[1][0] - end.places[0][0] - 1.0 - gap_of_force(&law, 1.0)).abs() < 1e-10);
}

#[test]
fn bodies_meet_across_periodic_sides() {
    let (min, max) = (Point::<2>::new(0.0, 0.0), Point::<2>::new(4.0, 3.0));
    let domain = Domain::Box { min, max, periodic_x: true, periodic_y: false };
    let surfaces = Surfaces::new(&domain, &[2, 3], &[disc("a"), disc("b")]).unwrap();
    assert!(matches!(
        Surfaces::new(&domain, &[0], &[disc("a")]),
        Err(ContactError::NoWall { side: 0 })
    ));
    // The second one has travelled around the domain twice
    for turns in [0.0, 8.0, -4.0] {
        let places = [[0.3, 1.0, 0.0], [3.28 + turns, 1.0, 0.0]];
        let loads = ContactLoads::new(&surfaces, &barrier(1.0), &places);
        assert_eq!(loads.contacts.len(), 1, "{turns}");
        assert!((loads.contacts[0].feature.at.gap - 0.02).abs() < 1e-14);
        assert!(loads.wrenches[0].force.x > 0.0);
    }
}

#[test]
fn what_cannot_be_solved_is_refused_by_name() {
    let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &[disc("heavy")]).unwrap();
    // The largest force is 0.05^2 / 1e-3 = 2.5
    let mut sinking =
        Mock::new(&surfaces, quadratic(1e-3), &[[0.0, 0.56, 0.0]], &[[0.0, -3.0, 0.0]]);
    sinking.friction = Some([1.0; 3]);
    let error = (0..100).find_map(|_| sinking.advance().err()).unwrap();
    match &error {
        ContactError::TooWeak { first, second, gap, greatest } => {
            assert_eq!((first.as_str(), second.as_str()), ("heavy", "bottom"));
            assert!(*gap > 0.0 && *gap < 1e-10 && (greatest - 2.5).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
    let mut touching = Mock::new(&surfaces, barrier(1.0), &[[0.0, 0.4, 0.0]], &[[0.0; 3]]);
    match touching.advance() {
        Err(ContactError::Overlap { first, second, gap }) => {
            assert_eq!((first.as_str(), second.as_str()), ("heavy", "bottom"));
            assert!((gap + 0.1).abs() < 1e-14);
        }
        other => panic!("{other:?}"),
    }
    let mut lost = Mock::new(&surfaces, barrier(1.0), &[[0.0, 1.0, 0.0]], &[[f64::NAN; 3]]);
    assert!(matches!(lost.advance(), Err(ContactError::Input { .. })));
}

#[test]
fn an_imposed_body_pushes_a_free_one() {
    let surfaces = Surfaces::new(&tank(), &[2], &[disc("pusher"), disc("pushed")]).unwrap();
    let law = barrier(1.0);
    let mut mobility = DMatrix::zeros(6, 6);
    (3..6).for_each(|row| mobility[(row, row)] = 1.0);
    let mut places = vec![[0.0, 3.0, 0.0], [1.04, 3.0, 0.0]];
    for _ in 0..50 {
        let speed = [[0.5, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let step = ContactStep {
            surfaces: &surfaces,
            law: &law,
            bodies: &[0, 1],
            free_velocities: &speed,
            mobility: &mobility,
            predicted: &places,
            predicted_velocities: &[[0.0; 3]; 2],
            coefficient: 0.2,
            apart: &places,
        };
        // In one step the pusher goes farther than the gap
        let end = step.solve().unwrap();
        assert!((end.velocities[0][0] - 0.5).abs() < 1e-14);
        assert!((end.velocities[1][0] - end.loads.wrenches[1].force.x).abs() < 1e-12);
        places = end.places;
    }
    // Pushed along at the same speed, at the gap whose force is its friction
    let gap = places[1][0] - places[0][0] - 1.0;
    assert!((gap - gap_of_force(&law, 0.5)).abs() < 1e-10);
}

#[test]
fn only_bodies_that_may_meet_are_involved() {
    let bodies = [disc("a"), disc("b"), disc("c"), disc("d")];
    let surfaces = Surfaces::new(&tank(), &[2], &bodies).unwrap();
    let from = [[-3.0, 3.0, 0.0], [-1.9, 3.0, 0.0], [2.0, 6.0, 0.0], [2.0, 0.6, 0.0]];
    let mut to = from;
    assert_eq!(surfaces.involved(&from, &to, 2.0, RANGE), Vec::<usize>::new());
    to[1][0] -= 0.04;
    assert_eq!(surfaces.involved(&from, &to, 1.0, RANGE), vec![0, 1, 3]);
    let rolled = [from[0], from[1], from[2], [2.0, 0.54, FRAC_PI_4]];
    assert_eq!(surfaces.involved(&rolled, &rolled, 1.0, RANGE), vec![3]);
}

/// Bodies of random shape, dropped one above the other, with a mobility that couples them.
fn random_heap() -> impl Strategy<Value = (Vec<PlacedShape>, Vec<Place>, DMatrix<f64>)> {
    let shape = prop_oneof![
        (0.2f64..0.8, 0.2f64..0.8).prop_map(|(a, b)| Shape::Ellipse { semi_axes: [a, b] }),
        (0.2f64..0.6).prop_map(|radius| Shape::Disc { radius }),
        (2u8..5, 0.0f64..0.35, 16usize..30).prop_map(|(lobes, depth, n)| {
            let points = (0..n)
                .map(|i| TAU * i as f64 / n as f64)
                .map(|t| (t, 0.5 * (1.0 + depth * (f64::from(lobes) * t).cos())))
                .map(|(t, r)| [r * t.cos(), r * t.sin()])
                .collect();
            Shape::Spline { points }
        }),
    ];
    let one = (shape, -0.4f64..0.4, 0.0..TAU);
    let coupling = proptest::collection::vec(-1.0f64..1.0, 144);
    (proptest::collection::vec(one, 4), coupling).prop_map(|(all, coupling)| {
        let bodies = all.iter().enumerate();
        let bodies = bodies.map(|(i, (shape, ..))| body(&format!("{i}"), shape.clone())).collect();
        let places = all.iter().enumerate();
        let places = places.map(|(i, (_, x, angle))| [*x, 0.9 + 1.7 * i as f64, *angle]).collect();
        // Close to symmetric and positive, as with some convection in the fluid
        let root = DMatrix::from_vec(12, 12, coupling);
        let skew = &root - root.transpose();
        let mobility = DMatrix::identity(12, 12) + &root * root.transpose() * 0.03 + skew * 0.02;
        (bodies, places, mobility)
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1987),
        // Each case is a run of its own: shrinking would take minutes
        max_shrink_iters: 0,
        ..ProptestConfig::with_cases(16)
    })]

    #[test]
    fn random_heaps_settle_without_an_overlap(
        (bodies, start, mobility) in random_heap(), is_barrier in any::<bool>(),
    ) {
        let surfaces = Surfaces::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
        let law = if is_barrier { barrier(20.0) } else { quadratic(1e-6) };
        let load = nalgebra::DVector::from_fn(12, |row, _| if row % 3 == 1 { -1.0 } else { 0.0 });
        let free = &mobility * load;
        let free: Vec<[f64; 3]> =
            (0..4).map(|i| [free[3 * i], free[3 * i + 1], free[3 * i + 2]]).collect();
        let (mut places, mut velocities) = (start, vec![[0.0; 3]; 4]);
        for step in 0..400 {
            let predicted: Vec<Place> = places
                .iter()
                .zip(&velocities)
                .map(|(q, u)| [0, 1, 2].map(|mode| q[mode] + 0.03 * u[mode]))
                .collect();
            let end = ContactStep {
                surfaces: &surfaces,
                law: &law,
                bodies: &[0, 1, 2, 3],
                free_velocities: &free,
                mobility: &mobility,
                predicted: &predicted,
                predicted_velocities: &velocities,
                coefficient: 0.03,
                apart: &places,
            }
            .solve();
            prop_assert!(end.is_ok(), "step {step}: {}", end.unwrap_err());
            let end = end.unwrap();
            prop_assert!(end.loads.least_gap.unwrap().gap > 0.0, "step {step}");
            // The velocities are those of the loads
            let mut pushed = nalgebra::DVector::zeros(12);
            for (i, wrench) in end.loads.wrenches.iter().enumerate() {
                let load = [wrench.force.x, wrench.force.y, wrench.torque.z];
                (0..3).for_each(|mode| pushed[3 * i + mode] = load[mode]);
            }
            let pushed = &mobility * pushed;
            for i in 0..4 {
                for mode in 0..3 {
                    let wanted = free[i][mode] + pushed[3 * i + mode];
                    prop_assert!((end.velocities[i][mode] - wanted).abs() < 1e-9);
                }
            }
            (places, velocities) = (end.places, end.velocities);
        }
    }
}
