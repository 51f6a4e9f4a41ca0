//! `Swimmer`: a slender body about a midline that bends, in the frame without momentum of its own.

use std::sync::Arc;

use alewife_mesh::{
    MeshError, Moments, Outline, PlacedShape, Point, Profile, SecondMoments, Shape, Spline,
};
use num_dual::{Dual64, DualNum};

use super::closed_curve::ClosedCurve;
use super::deformed::{Deformed, Rates, Removed, ShapeMotion};
use super::error::GaitError;
use super::grid::Grid;
use super::midline::{Frame, Midline};
use super::momentum::Interior;
use super::rule::Rule;
use super::turning::Turning;

/// Largest speed of the correction of the area, over the mean normal speed of a cycle.
const LARGEST_CORRECTION: f64 = 1e-3;

/// Times of a period, and of a ramp, at which a gait is tried out.
const TRIALS: u32 = 24;

/// Points of the Gauss rule on each piece of the outline: exact for all its moments.
const RULE_POINTS: usize = 6;

/// A fish or a flagellate.
#[derive(Debug)]
pub struct Swimmer {
    grid: Grid,
    midline: Midline,
    rest: Arc<Spline>,
    rest_area: f64,
    rule: Rule,
    turning: Turning,
}

impl Swimmer {
    /// A body of this profile with this gait.
    ///
    /// # Errors
    /// [`GaitError`] when there is no such body, or when at some time of a cycle its midline cannot
    /// follow, its outline crosses itself, or its area changes by more than a small correction.
    pub fn new(profile: &Profile, midline: Midline) -> Result<Self, GaitError> {
        let rest = Arc::new(profile.spline().ok_or(GaitError::Shape)?);
        let rest_area = Shape::Curve { spline: Arc::clone(&rest) }
            .moments()
            .map(|moments| moments.measure)
            .ok_or(GaitError::Shape)?;
        let [transient, period] = midline.cycle();
        let swimmer = Self {
            grid: Grid::new(profile, &midline.breaks()),
            midline,
            rest,
            rest_area,
            rule: Rule::new(RULE_POINTS),
            turning: Turning::new(transient, period),
        };
        swimmer.try_out()?;
        Ok(swimmer)
    }

    /// Whether the gait can be made, over its start and over a period.
    fn try_out(&self) -> Result<(), GaitError> {
        let [transient, period] = self.midline.cycle();
        let part = |i: u32| f64::from(i) / f64::from(TRIALS);
        // A long transient is tried out in its first period
        let start = (0..TRIALS).map(|i| part(i) * transient.min(period));
        let cycle = (0..TRIALS).map(|i| transient + part(i) * period);
        let (mut worst, mut speeds) = ((0.0, 0.0), Vec::new());
        for time in start.chain(cycle) {
            // The angle is of no importance here, and costs all rates before
            let deformed = self.deformed(time, Some(0.0)).ok_or(GaitError::Midline { time })?;
            let placed = PlacedShape {
                name: "the swimmer".to_owned(),
                shape: deformed.shape,
                center: Point::<2>::zeros(),
                angle: 0.0,
                size: None,
            };
            Outline::new(&placed).map_err(|error| {
                let what = match error {
                    MeshError::SelfIntersection { x, y, .. } => {
                        format!(" near ({x:.4}, {y:.4}) of the body")
                    }
                    _ => String::new(),
                };
                GaitError::Crossing { time, what }
            })?;
            let speed = deformed.removed.normal_speed.abs();
            if speed > worst.0 {
                worst = (speed, time);
            }
            speeds.push(deformed.removed.mean_normal_speed);
        }
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        if worst.0 > LARGEST_CORRECTION * mean {
            let (ratio, time) = (worst.0 / mean, worst.1);
            return Err(GaitError::Area { time, ratio, allowed: LARGEST_CORRECTION });
        }
        Ok(())
    }

    /// The outline at a time (s), turned by a given angle (rad) or by that of the gauge; `None` if
    /// the midline cannot follow its gait.
    fn deformed(&self, time: f64, angle: Option<f64>) -> Option<Deformed> {
        let frames = self.midline.frames(&self.grid, Dual64::new(time, 1.0));
        let interior = Interior::of(&self.grid.nodes, &frames.nodes);
        let turning = -interior.angular_momentum / interior.inertia;
        let angle = angle.unwrap_or_else(|| self.turning_at(time));
        let raw = self.outline(&frames.stations);
        let knots = self.rest.knots();
        let curve = ClosedCurve::through(&raw, knots)?;
        // Offset along the normals that gives the area at rest
        let normals = curve.normals();
        let widening = ClosedCurve::through(&normals, knots)?;
        let [area, first, second] = curve.area_along(&self.rule, &widening);
        let missing = -area + self.rest_area;
        let root = (first * first + second * missing * 4.0).sqrt();
        let offset = missing * 2.0 / (first + root);
        let kept: Vec<[Dual64; 2]> = raw
            .iter()
            .zip(&normals)
            .map(|(point, normal)| [0, 1].map(|i| point[i] + normal[i] * offset))
            .collect();
        let enclosed = ClosedCurve::through(&kept, knots)?.enclosed(&self.rule);
        let (sin, cos) = Dual64::new(angle, turning).sin_cos();
        let placed: Vec<[Dual64; 2]> = kept
            .iter()
            .map(|point| {
                let [x, y] = [0, 1].map(|i| point[i] - enclosed.center[i]);
                [cos * x - sin * y, sin * x + cos * y]
            })
            .collect();
        let curve = ClosedCurve::through(&placed, knots)?;
        let mean_normal_speed = curve.mean_normal_speed();
        let defect = [0, 1].map(|i| interior.center[i].eps - enclosed.center[i].eps);
        Some(Deformed {
            moments: Moments {
                measure: enclosed.area.re,
                centroid: Point::<2>::zeros(),
                second: SecondMoments::Planar { polar: enclosed.polar.re },
            },
            inertia_rate: enclosed.polar.eps,
            removed: Removed {
                velocity: Point::<2>::new(enclosed.center[0].eps, enclosed.center[1].eps),
                angular_velocity: -turning,
                normal_speed: offset.eps,
                mean_normal_speed,
                momentum_defect: defect[0].hypot(defect[1]),
            },
            shape: Shape::Curve { spline: Arc::new(curve.places) },
            rates: Rates::Spline(curve.rates),
        })
    }

    /// Material points from the head counter-clockwise.
    fn outline(&self, frames: &[Frame<Dual64>]) -> Vec<[Dual64; 2]> {
        let stations = self.grid.stations.iter().zip(frames);
        let side = |sign: f64| {
            move |(station, frame): (&alewife_mesh::Station, &Frame<Dual64>)| {
                let normal = frame.normal();
                let width = frame.stretch.recip() * (sign * station.half_width);
                [0, 1].map(|i| frame.place[i] + normal[i] * width)
            }
        };
        let last = frames.len() - 1;
        let upper = stations.clone().map(side(1.0));
        upper.chain(stations.take(last).skip(1).rev().map(side(-1.0))).collect()
    }

    /// Angle of the head-fixed frame in that without angular momentum (rad).
    #[must_use]
    pub fn turning_at(&self, time: f64) -> f64 {
        self.turning.at(time, |time| self.turning_rate(time))
    }

    /// Angular velocity that takes away the angular momentum (rad/s).
    fn turning_rate(&self, time: f64) -> f64 {
        let frames = self.midline.frames(&self.grid, Dual64::new(time, 1.0));
        let interior = Interior::of(&self.grid.nodes, &frames.nodes);
        -interior.angular_momentum / interior.inertia
    }
}

impl ShapeMotion for Swimmer {
    fn at(&self, time: f64) -> Deformed {
        // A gait that was tried out fails at times that are no numbers only
        self.deformed(time, None).unwrap_or_else(|| {
            let shape = Shape::Curve { spline: Arc::clone(&self.rest) };
            let nothing = vec![[0.0; 2]; self.rest.knots().len() - 1];
            let rates = Spline::with_knots(&nothing, self.rest.knots());
            Deformed {
                moments: shape.moments().unwrap_or(Moments {
                    measure: self.rest_area,
                    centroid: Point::<2>::zeros(),
                    second: SecondMoments::Planar { polar: 0.0 },
                }),
                shape,
                rates: rates.map_or(Rates::Radial(0.0), Rates::Spline),
                inertia_rate: 0.0,
                removed: Removed::NOTHING,
            }
        })
    }

    fn breaks(&self, _from: f64, _to: f64) -> Vec<f64> {
        // Ramps have continuous rates
        Vec::new()
    }
}
