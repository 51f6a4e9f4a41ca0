//! Laws, shapes, and bodies that answer loads without a fluid.

use std::f64::consts::TAU;

use alewife_core::body::{Pose, RigidVector, Twist};
use alewife_core::contact::{
    ContactError, ContactPair, ContactSolution, ContactStep, Gaps, Law, LawKind, PairVector,
    Partner, PlanarGaps,
};
use alewife_core::time::Bdf;
use alewife_mesh::{Domain, PlacedShape, Point, Shape};
use nalgebra::DMatrix;

pub const RANGE: f64 = 0.05;

pub fn quadratic(epsilon: f64) -> Law {
    Law::new(LawKind::Quadratic { epsilon }, RANGE).unwrap()
}

pub fn barrier(stiffness: f64) -> Law {
    Law::new(LawKind::Barrier { stiffness }, RANGE).unwrap()
}

pub fn tank() -> Domain {
    let (min, max) = (Point::<2>::new(-5.0, 0.0), Point::<2>::new(5.0, 10.0));
    Domain::Box { min, max, periodic_x: false, periodic_y: false }
}

pub fn body(name: &str, shape: Shape) -> PlacedShape {
    PlacedShape { name: name.into(), shape, center: Point::<2>::zeros(), angle: 0.0, size: None }
}

pub fn disc(name: &str) -> PlacedShape {
    body(name, Shape::Disc { radius: 0.5 })
}

pub fn ellipse(name: &str, a: f64, b: f64) -> PlacedShape {
    body(name, Shape::Ellipse { semi_axes: [a, b] })
}

/// Two lobes, 0.7 from the centre along x, with a waist between them.
pub fn peanut() -> PlacedShape {
    let points = (0..24)
        .map(|i| TAU * f64::from(i) / 24.0)
        .map(|t| (t, 0.5 + 0.2 * (2.0 * t).cos()))
        .map(|(t, r)| [r * t.cos(), r * t.sin()])
        .collect();
    body("peanut", Shape::Spline { points })
}

/// A pose by x, y and angle.
pub fn pose([x, y, angle]: [f64; 3]) -> Pose {
    Pose::planar(x, y, angle)
}

pub fn poses<const N: usize>(of: [[f64; 3]; N]) -> Vec<Pose> {
    of.into_iter().map(pose).collect()
}

/// A velocity or load by its parts along x, y and about z.
pub fn planar([x, y, turn]: [f64; 3]) -> RigidVector {
    Twist::planar([x, y, turn]).to_vector()
}

/// A pose displaced by one component.
pub fn moved(pose: &Pose, component: usize, by: f64) -> Pose {
    let mut displacement = RigidVector::zeros();
    displacement[component] = by;
    pose.displaced(&displacement)
}

/// A disc, an ellipse and a spline in a heap on the floor, 0.02 apart from each other.
pub fn heap() -> (PlanarGaps, Vec<Pose>) {
    let bodies = [disc("disc"), ellipse("ellipse", 0.8, 0.3), peanut()];
    let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
    let mut poses = poses([[0.0, 0.52, 0.3], [2.0, 0.37, 0.2], [0.5, 3.0, 0.9]]);
    for (body, component) in [(1, 0), (2, 1)] {
        let touches = |pairs: &[ContactPair]| {
            pairs.iter().any(|pair| pair.partner == Partner::Body(body) && pair.gap < 0.02)
        };
        while !touches(&gaps.pairs(&poses, RANGE)) {
            poses[body] = moved(&poses[body], component, -1e-3);
        }
    }
    (gaps, poses)
}

/// The gap at which a law gives a force, by bisection.
pub fn gap_of_force(law: &Law, force: f64) -> f64 {
    let (mut low, mut high) = (0.0, law.range());
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if law.force(middle) > force { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

pub fn fastest(solution: &ContactSolution) -> f64 {
    solution.velocities.iter().map(|twist| twist.to_vector().amax()).fold(0.0, f64::max)
}

/// Bodies that answer loads without fluid: overdamped, or with inertia by BDF2.
pub struct Mock<'a> {
    pub gaps: &'a dyn Gaps,
    pub law: Law,
    pub step: f64,
    /// Friction of an overdamped body by component; otherwise it has mass and moments of inertia.
    pub friction: Option<RigidVector>,
    pub mass: RigidVector,
    pub load: Vec<RigidVector>,
    /// At the end of the last step, and before it.
    pub poses: [Vec<Pose>; 2],
    velocities: [Vec<Twist>; 2],
    is_first: bool,
}

impl<'a> Mock<'a> {
    pub fn new(gaps: &'a dyn Gaps, law: Law, poses: &[Pose], load: &[RigidVector]) -> Self {
        let velocities = vec![Twist::default(); poses.len()];
        Self {
            gaps,
            law,
            step: 0.01,
            friction: None,
            mass: RigidVector::from_column_slice(&[1.0, 1.0, 1.0, 0.1, 0.1, 0.1]),
            load: load.to_vec(),
            poses: [poses.to_vec(), poses.to_vec()],
            velocities: [velocities.clone(), velocities],
            is_first: true,
        }
    }

    /// In the plane, with loads along x, y and about z.
    pub fn planar(gaps: &'a PlanarGaps, law: Law, at: &[[f64; 3]], load: &[[f64; 3]]) -> Self {
        let (poses, load): (Vec<_>, Vec<_>) =
            (at.iter().copied().map(pose).collect(), load.iter().copied().map(planar).collect());
        Self::new(gaps, law, &poses, &load)
    }

    pub fn advance(&mut self) -> Result<ContactSolution, ContactError> {
        let bdf = if self.is_first {
            Bdf::first_order(self.step)
        } else {
            Bdf::second_order(self.step, self.step)
        };
        let (n, modes) = (self.load.len(), self.gaps.modes());
        let mut mobility = DMatrix::zeros(modes.len() * n, modes.len() * n);
        let mut free = vec![RigidVector::zeros(); n];
        for i in 0..n {
            let [now, previous] = [0, 1].map(|level| self.velocities[level][i].to_vector());
            let history = bdf.history(now, previous);
            for (position, mode) in modes.iter().enumerate() {
                let answer = match self.friction {
                    Some(friction) => 1.0 / friction[mode],
                    None => 1.0 / (bdf.next * self.mass[mode]),
                };
                let row = modes.len() * i + position;
                mobility[(row, row)] = answer;
                let inertia = if self.friction.is_some() { 0.0 } else { self.mass[mode] };
                free[i][mode] = answer * (self.load[i][mode] - inertia * history[mode]);
            }
        }
        let free: Vec<Twist> = free.iter().map(Twist::from_vector).collect();
        let predicted: Vec<Pose> = (0..n)
            .map(|i| self.poses[0][i].advanced(&bdf, &self.poses[1][i], &self.velocities[0][i]))
            .collect();
        let bodies: Vec<usize> = (0..n).collect();
        let solution = ContactStep {
            gaps: self.gaps,
            law: &self.law,
            modes,
            bodies: &bodies,
            free_velocities: &free,
            mobility: &mobility,
            predicted: &predicted,
            predicted_velocities: &self.velocities[0],
            coefficient: 1.0 / bdf.next,
            start: &self.poses[0],
            elastic: None,
        }
        .solve()?;
        let now = std::mem::replace(&mut self.poses[0], solution.poses.clone());
        self.poses[1] = now;
        let now = std::mem::replace(&mut self.velocities[0], solution.velocities.clone());
        self.velocities[1] = now;
        self.is_first = false;
        Ok(solution)
    }

    pub fn run(&mut self, steps: usize) -> ContactSolution {
        (1..steps).for_each(|_| drop(self.advance().unwrap()));
        self.advance().unwrap()
    }
}

/// Gradient of the gap and its derivative against differences along random displacements.
pub fn assert_derivatives(gaps: &dyn Gaps, poses: &[Pose], partner: Partner) {
    let pair = |poses: &[Pose]| -> ContactPair {
        let found = gaps.pairs(poses, 0.4);
        *found.iter().find(|pair| pair.body == 0 && pair.partner == partner).unwrap()
    };
    let both = |pair: &ContactPair| {
        let [body, partner] = pair.gradient();
        PairVector::from_fn(|i, _| if i < 6 { body[i] } else { partner[i - 6] })
    };
    let at = pair(poses);
    let (gradient, derivative) = (both(&at), at.gradient_derivative());
    for seed in 1..8 {
        let random = |side: usize| {
            let all = RigidVector::from_fn(|i, _| {
                (f64::from(seed) * (1.3 + (6 * side + i) as f64)).sin()
            });
            gaps.modes().project(&all)
        };
        let mut ways = [random(0), random(1)];
        if matches!(partner, Partner::Wall(_)) {
            ways[1].fill(0.0);
        }
        let moved = |by: f64| {
            let mut poses = poses.to_vec();
            poses[0] = poses[0].displaced(&(ways[0] * by));
            if let Partner::Body(other) = partner {
                poses[other] = poses[other].displaced(&(ways[1] * by));
            }
            pair(&poses)
        };
        let way = PairVector::from_fn(|i, _| ways[i / 6][i % 6]);
        let h = 1e-5;
        let (more, less) = (moved(h), moved(-h));
        let rate = (more.gap - less.gap) / (2.0 * h);
        assert!((rate - gradient.dot(&way)).abs() < 1e-8, "{rate} {}", gradient.dot(&way));
        let mut change = (both(&more) - both(&less)) / (2.0 * h);
        let mut wanted = derivative * way;
        if matches!(partner, Partner::Wall(_)) {
            // A wall is fixed: the load on it is nobody's
            change.fixed_rows_mut::<6>(6).fill(0.0);
            wanted.fixed_rows_mut::<6>(6).fill(0.0);
        }
        let error = (change - wanted).amax();
        assert!(error < 1e-7 * (1.0 + wanted.amax()), "{change} {wanted}");
    }
}
