//! Heavy bodies that rebound from walls and from each other: no energy is made, hardly any is lost, momentum is kept.

use alewife_core::body::{Modes, Pose, RigidVector, Twist};
use alewife_core::contact::{
    BodyInStep, ContactStep, Dissipation, Gaps, Law, LawKind, PlanarGaps, SpatialGaps, StepEnergy,
};
use alewife_core::time::Bdf;
use alewife_mesh::spatial::{Body, Domain as Box3, Shape as Shape3};
use alewife_mesh::{Domain, PlacedShape, Point, Shape};
use nalgebra::{DMatrix, Isometry3, Matrix6, UnitQuaternion, Vector3};

use crate::common::{RANGE, barrier, body, disc, ellipse, planar, tank};

/// Error above which a step is made again in halves, as in a run.
const REJECTED: f64 = 2.0;
/// Growth of steps, as in a run.
const GROWTH: f64 = 2.1;

/// Bodies without a fluid by BDF2, each step as long as contact allows.
pub struct Flight<'a> {
    pub gaps: &'a dyn Gaps,
    pub law: Law,
    pub masses: Vec<RigidVector>,
    pub loads: Vec<RigidVector>,
    pub poses: [Vec<Pose>; 2],
    pub twists: [Vec<Twist>; 2],
    accelerations: Vec<Twist>,
    last_step: f64,
    longest: f64,
    /// Steps made, and rejected.
    pub steps: [usize; 2],
    /// Energy made by errors so far.
    pub made: f64,
    pub time: f64,
}

impl<'a> Flight<'a> {
    /// Bodies of these masses that have flown freely for a step of this size.
    pub fn new(
        gaps: &'a dyn Gaps,
        law: Law,
        bodies: &[(Pose, Twist, RigidVector)],
        step: f64,
    ) -> Self {
        let poses: Vec<Pose> = bodies.iter().map(|body| body.0).collect();
        let twists: Vec<Twist> = bodies.iter().map(|body| body.1).collect();
        let before = poses.iter().zip(&twists).map(|(pose, twist)| {
            let back = twist.to_vector() * -step;
            pose.displaced(&back)
        });
        Self {
            gaps,
            law,
            masses: bodies.iter().map(|body| body.2).collect(),
            loads: vec![RigidVector::zeros(); bodies.len()],
            poses: [poses.clone(), before.collect()],
            accelerations: vec![Twist::default(); bodies.len()],
            twists: [twists.clone(), twists],
            last_step: step,
            longest: f64::INFINITY,
            steps: [0; 2],
            made: 0.0,
            time: 0.0,
        }
    }

    pub fn kinetic_energy(&self) -> f64 {
        let of = |(mass, twist): (&RigidVector, &Twist)| {
            let velocity = twist.to_vector();
            0.5 * velocity.dot(&mass.component_mul(&velocity))
        };
        self.masses.iter().zip(&self.twists[0]).map(of).sum()
    }

    pub fn momentum(&self) -> Vector3<f64> {
        let of = |(mass, twist): (&RigidVector, &Twist)| twist.linear * mass[0];
        self.masses.iter().zip(&self.twists[0]).map(of).sum()
    }

    pub fn is_in_contact(&self) -> bool {
        !self.gaps.pairs(&self.poses[0], self.law.range()).is_empty()
    }

    /// Makes a step of this size in as many pieces as contact asks for.
    pub fn advance(&mut self, step: f64) {
        let mut to_do = vec![step];
        while let Some(size) = to_do.pop() {
            let longest = self.longest.min(GROWTH * self.last_step);
            if size > longest || !self.try_piece(size) {
                assert!(size > 1e-9 * step, "no step is short enough");
                to_do.extend([0.5 * size; 2]);
            }
        }
        self.time += step;
    }

    /// Whether a piece of a step is short enough, and was made.
    fn try_piece(&mut self, size: f64) -> bool {
        let bdf = Bdf::second_order(size, self.last_step);
        let (n, modes) = (self.masses.len(), self.gaps.modes());
        let mut mobility = DMatrix::zeros(modes.len() * n, modes.len() * n);
        let mut free = vec![Twist::default(); n];
        for i in 0..n {
            let [now, previous] = [0, 1].map(|level| self.twists[level][i].to_vector());
            let mut velocity = RigidVector::zeros();
            for (position, mode) in modes.iter().enumerate() {
                let (row, mass) = (modes.len() * i + position, self.masses[i][mode]);
                mobility[(row, row)] = 1.0 / (bdf.next * mass);
                let rate = self.loads[i][mode] / mass - bdf.history(now, previous)[mode];
                velocity[mode] = rate / bdf.next;
            }
            free[i] = Twist::from_vector(&velocity);
        }
        let predicted: Vec<Pose> = (0..n)
            .map(|i| self.poses[0][i].advanced(&bdf, &self.poses[1][i], &self.twists[0][i]))
            .collect();
        let bodies: Vec<usize> = (0..n).collect();
        let step = ContactStep {
            gaps: self.gaps,
            law: &self.law,
            modes,
            bodies: &bodies,
            free_velocities: &free,
            mobility: &mobility,
            predicted: &predicted,
            predicted_velocities: &self.twists[0],
            coefficient: 1.0 / bdf.next,
            start: &self.poses[0],
            elastic: None,
        };
        let Ok(solution) = step.solve() else {
            self.steps[1] += 1;
            return false;
        };
        let rate = |i: usize| {
            let levels = [0, 1].map(|level| self.twists[level][i].to_vector());
            let older = bdf.history(levels[0], levels[1]);
            Twist::from_vector(&(solution.velocities[i].to_vector() * bdf.next + older))
        };
        let rates: Vec<Twist> = (0..n).map(rate).collect();
        let in_step = |i: usize| BodyInStep {
            inertia: Matrix6::from_diagonal(&modes.project(&self.masses[i])),
            twists: [self.twists[0][i], solution.velocities[i]],
            accelerations: [self.accelerations[i], rates[i]],
            displacement: solution.poses[i].displacement_from(&self.poses[0][i]),
            is_alone: true,
            elastic: None,
        };
        let in_step: Vec<BodyInStep> = (0..n).map(in_step).collect();
        let energy = StepEnergy {
            gaps: [self.gaps, self.gaps],
            law: &self.law,
            poses: [&self.poses[0], &solution.poses],
            bodies: &in_step,
            loads: &solution.loads,
            is_second_order: true,
        };
        let energy = energy.measure();
        if energy.error > REJECTED {
            self.steps[1] += 1;
            return false;
        }
        self.steps[0] += 1;
        self.made += energy.made;
        let factor = (0.85 * energy.error.powf(-1.0 / 3.0)).clamp(0.3, GROWTH);
        self.longest = if energy.error > 0.0 { size * factor } else { f64::INFINITY };
        self.poses[1] = std::mem::replace(&mut self.poses[0], solution.poses);
        self.twists[1] = std::mem::replace(&mut self.twists[0], solution.velocities);
        (self.accelerations, self.last_step) = (rates, size);
        true
    }
}

/// Bodies about to meet.
struct Meeting {
    name: &'static str,
    gaps: Box<dyn Gaps>,
    bodies: Vec<(Pose, Twist, RigidVector)>,
}

fn mass(mass: f64, moment: f64) -> RigidVector {
    RigidVector::from_column_slice(&[mass, mass, mass, moment, moment, moment])
}

/// Planar bodies at places with velocities.
fn in_plane(name: &'static str, shapes: &[PlacedShape], at: &[[[f64; 3]; 2]]) -> Meeting {
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], shapes).unwrap();
    let bodies = at.iter().enumerate().map(|(nth, [[x, y, angle], velocity])| {
        let twist = Twist::from_vector(&planar(*velocity));
        (Pose::planar(*x, *y, *angle), twist, mass(1.0 + nth as f64, 0.1))
    });
    Meeting { name, bodies: bodies.collect(), gaps: Box::new(gaps) }
}

fn on_axis() -> Meeting {
    let domain = Domain::Cylinder { x: [0.0, 10.0], radius: 2.0, periodic_x: false };
    let spheres = ["a", "b"].map(|name| body(name, Shape::Sphere { radius: 0.5 }));
    let gaps = PlanarGaps::new(&domain, &[0, 1], &spheres).unwrap();
    let at = |x: f64, speed: f64, nth: f64| {
        let twist = Twist::from_vector(&planar([speed, 0.0, 0.0]));
        (Pose::planar(x, 0.0, 0.0), twist, mass(nth, 0.1))
    };
    let bodies = vec![at(4.0, 0.7, 1.0), at(5.2, -0.3, 2.5)];
    Meeting { name: "spheres on the axis", bodies, gaps: Box::new(gaps) }
}

fn in_space(name: &'static str, at: &[[Vector3<f64>; 2]]) -> Meeting {
    let [min, max] = [-5.0, 5.0].map(Point::<3>::from_element);
    let domain = Box3::Box { min, max, periodic: [false; 3], symmetric: [false; 6] };
    let sphere = |nth: usize| {
        let shape = Shape3::Sphere { radius: 0.5 };
        Body::new(&format!("sphere {nth}"), shape, Isometry3::identity())
    };
    let bodies: Vec<Body> = (0..at.len()).map(sphere).collect();
    let gaps = SpatialGaps::new(&domain, &bodies, &vec![Point::<3>::zeros(); at.len()]).unwrap();
    let bodies = at.iter().enumerate().map(|(nth, [center, velocity])| {
        let twist = Twist { linear: *velocity, angular: Vector3::zeros() };
        let pose = Pose::spatial(*center, UnitQuaternion::identity());
        (pose, twist, mass(1.0 + nth as f64, 0.1))
    });
    Meeting { name, bodies: bodies.collect(), gaps: Box::new(gaps) }
}

fn meetings() -> Vec<Meeting> {
    let [disc_a, disc_b] = ["a", "b"].map(disc);
    let oval = || ellipse("oval", 0.8, 0.3);
    let space = |x: f64, y: f64, z: f64| Vector3::new(x, y, z);
    vec![
        in_plane("disc at a wall", &[disc("a")], &[[[0.0, 0.7, 0.0], [0.2, -1.0, 0.3]]]),
        in_plane("ellipse at a wall", &[oval()], &[[[0.0, 0.85, 0.6], [0.3, -1.0, 0.0]]]),
        in_plane(
            "two discs",
            &[disc_a, disc_b],
            &[[[-0.6, 5.0, 0.0], [1.0, 0.0, 0.0]], [[0.6, 5.3, 0.0], [-0.4, 0.1, 0.0]]],
        ),
        in_plane(
            "disc and ellipse",
            &[disc("a"), oval()],
            &[[[-0.7, 5.0, 0.0], [1.0, 0.0, 0.0]], [[0.75, 5.2, 0.4], [-0.4, 0.1, 0.2]]],
        ),
        on_axis(),
        in_space("sphere at a wall", &[[space(0.0, 0.0, -4.3), space(0.3, -0.2, -1.0)]]),
        in_space(
            "two spheres",
            &[
                [space(-0.6, 0.0, 0.0), space(1.0, 0.0, 0.0)],
                [space(0.6, 0.2, 0.3), space(-0.4, 0.1, 0.0)],
            ],
        ),
    ]
}

/// Laws that can store this energy, the softest one only just.
fn laws(energy: f64, decade: i32) -> [Law; 2] {
    let factor = 10f64.powi(decade);
    let epsilon = RANGE.powi(3) / (3.0 * 1.5 * energy * factor);
    let quadratic = Law::new(LawKind::Quadratic { epsilon }, RANGE).unwrap();
    [barrier(0.5 * energy / RANGE.powi(2) * factor), quadratic]
}

/// Lets bodies meet and part, and holds energy and momentum to what they were; steps made.
fn assert_rebounds(meeting: &Meeting, law: Law, step: f64) -> usize {
    let mut flight = Flight::new(meeting.gaps.as_ref(), law, &meeting.bodies, step);
    let (energy, momentum) = (flight.kinetic_energy(), flight.momentum());
    let (mut has_met, mut is_apart) = (false, false);
    while !is_apart {
        flight.advance(step);
        has_met |= flight.is_in_contact() || flight.steps[1] > 0;
        is_apart = has_met && !flight.is_in_contact();
        assert!(flight.time < 3.0, "{}: they do not part", meeting.name);
    }
    (0..3).for_each(|_| flight.advance(step));
    let told = format!("{} {law:?} step {step} steps {:?}", meeting.name, flight.steps);
    let restitution = (flight.kinetic_energy() / energy).sqrt();
    assert!((0.985..1.0003).contains(&restitution), "{told}: {restitution}");
    let change = flight.momentum() - momentum;
    // A wall takes what is along its normal
    let kept = if meeting.bodies.len() > 1 {
        change.norm()
    } else if flight.gaps.modes() == Modes::SPATIAL {
        change.xy().norm()
    } else {
        change.x.abs()
    };
    assert!(kept < 1e-9 * momentum.norm(), "{told}: momentum changes by {kept:e}");
    flight.steps[0]
}

#[test]
fn heavy_bodies_leave_with_the_energy_they_came_with() {
    for meeting in meetings() {
        let energy = impact_energy(&meeting);
        for (decade, step) in [(0, 0.04), (3, 0.004)] {
            for law in laws(energy, decade) {
                let steps = assert_rebounds(&meeting, law, step);
                assert!(steps < 900, "{} {steps}", meeting.name);
            }
        }
    }
}

#[test]
#[ignore = "long: minutes; small: heavy_bodies_leave_with_the_energy_they_came_with"]
fn heavy_bodies_leave_with_the_energy_they_came_with_whatever_stiffness_and_step() {
    for meeting in meetings() {
        let energy = impact_energy(&meeting);
        for decade in 0..=6 {
            for step in [0.04, 0.02, 0.01, 0.004, 0.001, 0.0004] {
                for law in laws(energy, decade) {
                    assert_rebounds(&meeting, law, step);
                }
            }
        }
    }
}

/// Kinetic energy of all bodies.
fn impact_energy(meeting: &Meeting) -> f64 {
    Flight::new(meeting.gaps.as_ref(), barrier(1.0), &meeting.bodies, 1.0).kinetic_energy()
}

#[test]
fn a_coefficient_of_restitution_is_the_part_of_the_velocity_that_is_left() {
    for (nth, meeting) in
        meetings().into_iter().enumerate().filter(|(nth, _)| [0, 4, 5].contains(nth))
    {
        for wanted in [0.2, 0.5, 0.9] {
            let dissipation = Dissipation { restitution: wanted, friction: 0.0, slip: 1e-3 };
            for law in laws(impact_energy(&meeting), 2) {
                let law = law.with_dissipation(dissipation).unwrap();
                let mut flight = Flight::new(meeting.gaps.as_ref(), law, &meeting.bodies, 0.01);
                let approach = |flight: &Flight<'_>| {
                    let twists = &flight.twists[0];
                    let axis = [1, 0, 2][[0, 4, 5].iter().position(|one| *one == nth).unwrap()];
                    twists[0].linear[axis] - twists.get(1).map_or(0.0, |other| other.linear[axis])
                };
                let before = approach(&flight);
                (0..60).for_each(|_| flight.advance(0.01));
                let found = -approach(&flight) / before;
                assert!((found - wanted).abs() < 0.01, "{} {wanted}: {found}", meeting.name);
            }
        }
    }
}

/// A disc on an incline, pressed on it by its weight: it slides with g sin a - mu g cos a and turns by the friction,
/// or rolls with (2 / 3) g sin a where friction can hold it.
#[test]
fn a_disc_on_an_incline_slides_or_rolls() {
    let gaps = PlanarGaps::new(&tank(), &[2], &[disc("a")]).unwrap();
    let (gravity, radius, end) = (1.0, 0.5, 1.0);
    let (sine, cosine) = (0.6, 0.8);
    // It rolls from mu = tan(a) / 3 on
    for (friction, is_rolling) in [(0.1, false), (0.2, false), (0.5, true)] {
        for stiffness in [10.0, 1e4] {
            let law = barrier(stiffness * gravity);
            let dissipation = Dissipation { restitution: 1.0, friction, slip: 1e-6 };
            let at = 0.5 + crate::common::gap_of_force(&law, gravity * cosine);
            let law = law.with_dissipation(dissipation).unwrap();
            let disc = mass(1.0, 0.5 * radius * radius);
            let bodies = [(Pose::planar(-2.0, at, 0.0), Twist::default(), disc)];
            let mut flight = Flight::new(&gaps, law, &bodies, 1e-3);
            flight.loads[0] = planar([gravity * sine, -gravity * cosine, 0.0]);
            while flight.time < end - 1e-9 {
                flight.advance(0.02);
            }
            let twist = flight.twists[0][0];
            // Friction acts at the point of the surface, which is where the disc touches
            let wanted = if is_rolling {
                [2.0 / 3.0 * gravity * sine, -2.0 / 3.0 * gravity * sine / radius]
            } else {
                let by_friction = friction * gravity * cosine;
                [gravity * sine - by_friction, -2.0 * by_friction / radius]
            };
            let found = [twist.linear.x, twist.angular.z];
            for (found, wanted) in found.into_iter().zip(wanted) {
                let off = (found / (wanted * end) - 1.0).abs();
                assert!(off < 2e-3, "{friction} {stiffness}: {found} {}", wanted * end);
            }
        }
    }
}
