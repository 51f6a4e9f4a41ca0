//! `Tube`: all points at a distance from a curve; its ends are half spheres.

use crate::Point;
use crate::spatial::curve::Centreline;

/// Most levels of the tree of balls.
const MOST_LEVELS: usize = 32;

/// Steps of Newton's method to the nearest point of the curve.
const MOST_STEPS: usize = 12;

/// Rounding by which balls are larger than what they hold.
const MARGIN: f64 = 1e-3;

/// A ball around a piece of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ball {
    center: Point<3>,
    radius: f64,
}

/// A tube along a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Tube {
    centreline: Centreline,
    radius: f64,
    /// A binary tree of balls: the children of ball i are 2i and 2i + 1, the last half holds one piece
    /// each.
    balls: Vec<Ball>,
    reach: f64,
}

/// A part of the tree that is still to be searched.
#[derive(Debug, Clone, Copy)]
struct Open {
    ball: usize,
    /// Distance of its centre (m).
    distance: f64,
}

impl Tube {
    /// A tube of a radius (m) along a curve.
    #[must_use]
    pub fn new(centreline: Centreline, radius: f64) -> Self {
        let n = crate::whole(centreline.pieces().clamp(8.0, 1e6)).next_power_of_two();
        let none = Ball { center: Point::zeros(), radius: 0.0 };
        let mut balls = vec![none; 2 * n];
        for i in 0..n {
            let at = |part: f64| centreline.at((i as f64 + part) / n as f64);
            let [from, center, to] = [0.0, 0.5, 1.0].map(at);
            let reach = (from - center).norm().max((to - center).norm());
            balls[n + i] = Ball { center, radius: reach * (1.0 + MARGIN) };
        }
        for i in (1..n).rev() {
            let [one, other] = [balls[2 * i], balls[2 * i + 1]];
            let center = (one.center + other.center) * 0.5;
            let reach = |ball: Ball| (ball.center - center).norm() + ball.radius;
            balls[i] = Ball { center, radius: reach(one).max(reach(other)) };
        }
        let reach = balls[n..].iter().map(|ball| ball.center.norm() + ball.radius);
        let reach = reach.fold(0.0, f64::max) + radius;
        Self { centreline, radius, balls, reach }
    }

    /// Radius (m).
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Radius of a ball about the origin that holds the tube (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The piece of the curve whose middle is nearest to a point (m).
    fn nearest_piece(&self, point: Point<3>) -> usize {
        let n = self.balls.len() / 2;
        let open = |ball: usize| Open { ball, distance: (self.balls[ball].center - point).norm() };
        let mut stack = [Open { ball: 0, distance: 0.0 }; 2 * MOST_LEVELS];
        stack[0] = open(1);
        let mut len = 1;
        let mut best = open(n);
        while len > 0 {
            len -= 1;
            let Open { ball, distance } = stack[len];
            if distance - self.balls[ball].radius >= best.distance {
                continue;
            }
            if ball >= n {
                if distance < best.distance {
                    best = stack[len];
                }
                continue;
            }
            // The nearer one is taken from the stack first
            let [one, other] = [open(2 * ball), open(2 * ball + 1)];
            let is_ordered = one.distance > other.distance;
            stack[len..len + 2].copy_from_slice(&if is_ordered {
                [one, other]
            } else {
                [other, one]
            });
            len += 2;
        }
        best.ball - n
    }

    /// The point of the curve nearest to a point (m), by Newton's method from the nearest piece.
    #[must_use]
    pub fn on_centreline(&self, point: Point<3>) -> Point<3> {
        let n = (self.balls.len() / 2) as f64;
        let mut parameter = (self.nearest_piece(point) as f64 + 0.5) / n;
        for _ in 0..MOST_STEPS {
            let on = self.centreline.evaluate(parameter);
            let off = on.at - point;
            let speed = on.rate.norm_squared();
            let slope = (speed + off.dot(&on.second)).max(0.2 * speed);
            let step = (off.dot(&on.rate) / slope).clamp(-1.0 / n, 1.0 / n);
            let next = (parameter - step).clamp(0.0, 1.0);
            let is_done = (next - parameter).abs() < 1e-14;
            parameter = next;
            if is_done {
                break;
            }
        }
        self.centreline.at(parameter)
    }
}
