//! `CycleError`: the error of a swimmer's displacement over a cycle, from the defects of its steps.
//!
//! Without inertia poses obey q' = V(q, t). A step leaves the defect r_k = q_(k+1) - q_k - int V
//! dt, V along the poses it has found, by a polynomial through the velocities at the ends of steps
//! and, of an explicit scheme, at its stages: of higher order than the schemes. It is what the step
//! has done wrong (defect correction, @stetter1978). A swimmer alone in an unbounded fluid continues
//! from a wrong pose as it would have from the right one, shifted and turned: with r_k the
//! shift and theta_k the turn of a step that ends with the centre of mass at c_k, the displacement
//! up to c is wrong by sum r_k + theta_k x (c - c_k). That walls are nearer or farther at wrong
//! poses, and that springs undo what is wrong, is left out.

use alewife_mesh::GaussRule;
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::body::{Pose, RigidVector, Twist, rate_of_displacement};

/// Velocities through which the polynomial is laid: with those at the ends of steps alone its
/// integral is three orders above the best scheme.
const NODES: usize = 6;

/// Velocities from which on there is an estimate: a parabola, whose integral is as good as the best
/// scheme.
const LEAST_NODES: usize = 3;

/// A swimmer at one time: its centre of mass with the orientation of its first body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Waypoint {
    /// Where it is.
    pub pose: Pose,
    /// Velocity of the centre of mass, angular velocity of the first body.
    pub velocity: Twist,
}

/// A step of a swimmer.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Where it begins, if that is where rates jump; of a velocity there only what holds after
    /// that.
    pub start: Option<(Pose, Option<Twist>)>,
    /// At the stages within it.
    pub stages: Vec<StagePoint>,
    /// Where it ends.
    pub end: Waypoint,
}

/// A swimmer at a stage of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StagePoint {
    /// When it is, as a part of the step.
    pub part: f64,
    /// Where it is put then.
    pub at: Waypoint,
}

/// The end of a step, or a stage within.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Node {
    /// Whether a step ends or begins there.
    is_end: bool,
    /// Time since the start (s).
    time: f64,
    pose: Pose,
    /// None where it is not known.
    velocity: Option<Twist>,
}

/// A node whose velocity is known.
struct Known {
    time: f64,
    pose: Pose,
    velocity: Twist,
}

impl Known {
    fn of(node: &Node) -> Option<Self> {
        Some(Self { time: node.time, pose: node.pose, velocity: node.velocity? })
    }
}

/// The sum of what steps have done wrong.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Defects {
    /// Of the centre of mass (m).
    shift: Vector3<f64>,
    /// Of the orientation (rad).
    turn: Vector3<f64>,
    /// Sum of the turns across the places where they happened (m).
    moment: Vector3<f64>,
    /// Whether a piece between jumps of the rates had too few steps for an estimate.
    is_coarse: bool,
}

/// Errors of the steps of a swimmer since the start.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CycleError {
    /// By the velocities at the ends of steps, which long steps have too few of.
    by_ends: StepErrors,
    /// By those at the stages as well, which beside walls are not those of the path.
    by_stages: StepErrors,
    /// Whether it has been reported.
    is_reported: bool,
}

impl CycleError {
    /// Adds a step of a size (s).
    pub fn add_step(&mut self, size: f64, leg: &Leg) {
        if !self.is_reported {
            self.by_ends.add_step(size, leg, &[]);
            self.by_stages.add_step(size, leg, &leg.stages);
        }
    }

    /// Time since the start (s).
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.by_ends.nodes.last().map_or(0.0, |node| node.time)
    }

    /// Whether it is over, and its steps no longer looked at.
    #[must_use]
    pub fn is_reported(&self) -> bool {
        self.is_reported
    }

    /// Ends with it.
    pub fn end(&mut self) {
        *self = Self { is_reported: true, ..Self::default() };
    }

    /// Error of the displacement since the start (m); none where steps are too few for an estimate. Of both
    /// estimates the lower one: what they have of their own comes on top.
    #[must_use]
    pub fn of_displacement(&self) -> Option<f64> {
        let both = [&self.by_ends, &self.by_stages];
        both.into_iter().filter_map(StepErrors::of_displacement).min_by(f64::total_cmp)
    }
}

/// The errors by some of the velocities.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct StepErrors {
    /// The last ends and stages of steps since rates jumped, ascending in time.
    nodes: Vec<Node>,
    /// Steps that are still to be added: the last ones.
    pending: usize,
    sum: Defects,
}

impl StepErrors {
    fn add_step(&mut self, size: f64, leg: &Leg, stages: &[StagePoint]) {
        let time = self.nodes.last().map_or(0.0, |node| node.time);
        if let Some((pose, velocity)) = leg.start {
            self.sum = self.total();
            (self.pending, self.nodes) = (0, vec![Node { is_end: true, time, pose, velocity }]);
        }
        if let Some(&from) = self.nodes.last() {
            let stages = stages.iter();
            self.nodes.extend(stages.filter_map(|at| stage(&from, leg, size, at)));
        }
        let Waypoint { pose, velocity } = leg.end;
        self.nodes.push(Node { is_end: true, time: time + size, pose, velocity: Some(velocity) });
        self.pending += 1;
        if self.nodes.iter().filter(|node| node.velocity.is_some()).count() >= NODES {
            self.sum = self.total();
            self.pending = 0;
            self.nodes.drain(..self.nodes.len() - NODES);
        }
    }

    fn of_displacement(&self) -> Option<f64> {
        let end = self.nodes.last()?.pose.center;
        let Defects { shift, turn, moment, is_coarse } = self.total();
        (!is_coarse).then(|| (shift + turn.cross(&end) - moment).norm())
    }

    /// The sum with all steps that are still to be added.
    fn total(&self) -> Defects {
        let mut sum = self.sum;
        let known: Vec<Known> = self.nodes.iter().filter_map(Known::of).collect();
        let known = &known[known.len().saturating_sub(NODES)..];
        sum.is_coarse |= self.pending > 0 && known.len() < LEAST_NODES;
        let ends: Vec<&Node> = self.nodes.iter().filter(|node| node.is_end).collect();
        for pair in ends[ends.len().saturating_sub(self.pending + 1)..].windows(2) {
            let defect = defect(pair[0], pair[1], known);
            let turn = Vector3::from(defect.fixed_rows::<3>(3));
            sum.shift += Vector3::from(defect.fixed_rows::<3>(0));
            sum.turn += turn;
            sum.moment += turn.cross(&pair[1].pose.center);
        }
        sum
    }
}

/// A stage of a step of a size (s) from a node, moved on to the path between both ends, which is
/// better known than the pose of the stage: by the cubic with the velocities at both, the velocity
/// turned with it.
fn stage(from: &Node, leg: &Leg, size: f64, stage: &StagePoint) -> Option<Node> {
    let StagePoint { part, at } = *stage;
    let start = from.velocity?.to_vector() * size;
    let way = leg.end.pose.displacement_from(&from.pose);
    let end = rate_of_displacement(&way, &leg.end.velocity) * size;
    let rest = 1.0 - part;
    let displacement = start * (part * rest * rest) - end * (part * part * rest)
        + way * (part * part * (3.0 - 2.0 * part));
    let pose = from.pose.displaced(&displacement);
    let off = pose.displacement_from(&at.pose);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(off.fixed_rows::<3>(3)));
    let Twist { linear, angular } = at.velocity;
    let velocity = Some(Twist { linear: turn * linear, angular: turn * angular });
    Some(Node { is_end: false, time: from.time + part * size, pose, velocity })
}

/// The displacement of a step less the integral of the velocity, by the polynomial through those
/// that are known (m, rad).
fn defect(from: &Node, to: &Node, known: &[Known]) -> RigidVector {
    let rule = GaussRule::new(NODES.div_ceil(2));
    let size = to.time - from.time;
    let weight = |nth: usize| -> f64 {
        let others = || (0..known.len()).filter(move |other| *other != nth);
        let at = |time: f64| -> f64 {
            let factors =
                others().map(|m| (time - known[m].time) / (known[nth].time - known[m].time));
            factors.product()
        };
        let parts = rule.points.iter().zip(&rule.weights);
        parts.map(|(part, weight)| weight * at(from.time + part * size)).sum()
    };
    let mut defect = to.pose.displacement_from(&from.pose);
    for (nth, Known { pose, velocity, .. }) in known.iter().enumerate() {
        let rate = rate_of_displacement(&pose.displacement_from(&from.pose), velocity);
        defect -= rate * (size * weight(nth));
    }
    defect
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(angle: f64, center: [f64; 2]) -> Pose {
        Pose::planar(center[0], center[1], angle)
    }

    /// Where one gets to at a speed of one along a direction that is an angle of the time.
    fn way(end: f64, turning: impl Fn(f64) -> f64) -> [f64; 2] {
        let n = 4000;
        let step = end / f64::from(n);
        (0..n).fold([0.0; 2], |[x, y], nth| {
            let (sin, cos) = turning(step * (f64::from(nth) + 0.5)).sin_cos();
            [x + step * cos, y + step * sin]
        })
    }

    #[test]
    fn the_error_of_a_midpoint_rule_on_a_bent_path_is_found() {
        let angle = |time: f64| 1.5 * time * time;
        let rate = |time: f64| 3.0 * time;
        for n in [10, 20, 40] {
            let step = 1.0 / f64::from(n);
            let mut error = CycleError::default();
            // Turns by the rate at the beginning of a step, and goes ahead by the angle in its
            // middle
            let (mut turned, mut center) = (0.0, [0.0; 2]);
            for nth in 0..n {
                let time = f64::from(nth) * step;
                let start = (nth == 0).then(|| (pose(0.0, [0.0; 2]), None));
                let next = turned + step * (rate(time) + 1e-2 * step);
                let (sin, cos) = (0.5 * (turned + next)).sin_cos();
                center = [center[0] + step * cos, center[1] + step * sin];
                turned = next;
                let (sin, cos) = turned.sin_cos();
                let velocity = Twist {
                    linear: Vector3::new(cos, sin, 0.0),
                    angular: Vector3::z() * rate(time + step),
                };
                let end = Waypoint { pose: pose(turned, center), velocity };
                error.add_step(step, &Leg { start, stages: Vec::new(), end });
            }
            let exact = way(1.0, angle);
            let off = (center[0] - exact[0]).hypot(center[1] - exact[1]);
            let found = error.of_displacement().unwrap();
            assert!((found / off - 1.0).abs() < 0.1, "{n}: {found:e} for {off:e}");
        }
    }

    #[test]
    fn a_cubic_path_has_no_error_in_pieces_of_any_steps_and_two_steps_give_none() {
        let speed = |time: f64| 1.0 - 2.0 * time + 3.0 * time * time;
        let place = |time: f64| time - time * time + time.powi(3);
        let node = |time: f64| Waypoint {
            pose: pose(0.0, [place(time), 0.0]),
            velocity: Twist { linear: Vector3::x() * speed(time), angular: Vector3::zeros() },
        };
        let mut error = CycleError::default();
        let mut time = 0.0;
        for (nth, step) in [0.01, 0.02, 0.1, 0.2, 0.1, 0.05, 0.1, 0.03].into_iter().enumerate() {
            let start = nth.is_multiple_of(4).then(|| (node(time).pose, None));
            time += step;
            error.add_step(step, &Leg { start, stages: Vec::new(), end: node(time) });
        }
        assert!(error.of_displacement().unwrap() < 1e-14, "{error:?}");
        let start = Some((node(time).pose, None));
        error.add_step(0.1, &Leg { start, stages: Vec::new(), end: node(time + 0.1) });
        assert_eq!(error.of_displacement(), None);
        error.end();
        assert!(error.is_reported() && error.elapsed() == 0.0);
    }
}
