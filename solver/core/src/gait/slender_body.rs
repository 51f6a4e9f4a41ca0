//! `SlenderBody`: a body about a midline that bends, in the frame without momentum of its own.

use alewife_mesh::spatial::SectionHeight;
use alewife_mesh::{Point, Profile, whole};
use num_dual::Dual64;

use super::deformed_outline::{DeformedOutline, RecoilCorrection, ShapeMotion};
use super::error::GaitError;
use super::grid::Grid;
use super::hull::{Closed, Hull};
use super::midline::{Carangiform, Frame, Midline, Open};
use super::momentum::Interior;
use super::recoil::{OpenAngle, Recoil, RecoilAngle, RecoilMotion};

/// Largest speed of the correction of the area, over the mean normal speed of a cycle.
const LARGEST_CORRECTION: f64 = 1e-3;

/// Times of a period, and of a ramp, at which a gait is evaluated before a run.
const TRIALS: u32 = 24;

/// Periods of a recording that are looked at each by itself.
const MOST_PERIODS: usize = 32;

/// A fish or a flagellate.
#[derive(Debug)]
pub struct SlenderBody {
    grid: Grid,
    midline: Midline,
    hull: Hull,
    recoil_angle: RecoilAngle,
    /// In its place where later parts of the gait may not be known.
    open: Option<(Open, OpenAngle)>,
}

impl SlenderBody {
    /// A body of this profile with this gait.
    ///
    /// # Errors
    /// [`GaitError`] when there is no such body, or when at some time of a cycle its midline cannot
    /// follow, its outline crosses itself, or its area changes by more than a small correction.
    pub fn new(profile: &Profile, midline: Midline) -> Result<Self, GaitError> {
        Self::closed(profile, None, midline)
    }

    /// A body in space whose elliptic sections have these widths and heights.
    ///
    /// # Errors
    /// As [`Self::new`], with its volume in place of its area.
    pub fn in_space(
        profile: &Profile,
        height: SectionHeight,
        midline: Midline,
    ) -> Result<Self, GaitError> {
        Self::closed(profile, Some(height), midline)
    }

    fn closed(
        profile: &Profile,
        height: Option<SectionHeight>,
        midline: Midline,
    ) -> Result<Self, GaitError> {
        if let Midline::Carangiform(Carangiform { gait, .. }) = &midline
            && gait.curvature.len() < 2
        {
            return Err(GaitError::Curvature { points: gait.curvature.len() });
        }
        let [transient, period] = midline.cycle();
        let grid = Grid::new(profile, &midline.discontinuities());
        let open = midline.open();
        let body = Self {
            hull: Hull::new(profile, &grid, height)?,
            grid,
            midline,
            recoil_angle: RecoilAngle::new(transient, period),
            open: open.map(|open| {
                let angle = OpenAngle::new(open.longest);
                (open, angle)
            }),
        };
        body.validate()?;
        Ok(body)
    }

    /// Evaluates the gait at times of its start and of a period, and compares the correction of the
    /// area with the motion.
    fn validate(&self) -> Result<(), GaitError> {
        let [transient, period] = self.midline.cycle();
        let part = |i: u32| f64::from(i) / f64::from(TRIALS);
        // Of a long transient only its first period
        let start = (0..TRIALS).map(|i| part(i) * transient.min(period));
        let cycle = (0..TRIALS).map(|i| transient + part(i) * period);
        let (mut largest_speed, mut largest_at) = (0.0, 0.0);
        let mut speeds = Vec::new();
        for time in start.chain(cycle) {
            // The outline does not depend on the angle, which costs all rates before
            let deformed = self.deformed(time, 0.0)?;
            deformed.outline(time)?;
            let recoil = deformed.recoil;
            if recoil.normal_speed.abs() > largest_speed {
                (largest_speed, largest_at) = (recoil.normal_speed.abs(), time);
            }
            speeds.push(recoil.mean_normal_speed);
        }
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        if largest_speed > LARGEST_CORRECTION * mean {
            let (time, ratio) = (largest_at, largest_speed / mean);
            return Err(GaitError::Area { time, ratio, allowed: LARGEST_CORRECTION });
        }
        Ok(())
    }

    /// The outline at a time (s), turned by an angle (rad) from the frame of the head.
    fn deformed(&self, time: f64, angle: f64) -> Result<DeformedOutline, GaitError> {
        let frames = self.midline.frames(&self.grid, Dual64::new(time, 1.0));
        let across = self.hull.across();
        let interior = Interior::of(&self.grid.nodes, &frames.nodes, across);
        let turning = recoil_rate(&interior, time)?;
        let narrowing: Vec<Dual64> =
            frames.stations.iter().map(|frame| across.narrowing(frame)).collect();
        let points = self.points(&frames.stations, &narrowing);
        let closed = self.hull.close(time, &points, &narrowing, Dual64::new(angle, turning))?;
        let Closed { curve, moments, inertia_rate, center, .. } = closed;
        let drift = [0, 1].map(|i| interior.center[i].eps - center[i].eps);
        Ok(DeformedOutline {
            curve,
            moments,
            inertia_rate,
            recoil: RecoilCorrection {
                center: Point::<2>::from(center.map(|part| part.re)),
                velocity: Point::<2>::from(center.map(|part| part.eps)),
                angle: -angle,
                angular_velocity: -turning,
                normal_speed: closed.normal_speed,
                mean_normal_speed: closed.mean_normal_speed,
                interior_drift: drift[0].hypot(drift[1]),
            },
        })
    }

    /// Material points from the head counter-clockwise.
    fn points(&self, frames: &[Frame<Dual64>], narrowing: &[Dual64]) -> Vec<[Dual64; 2]> {
        let stations = self.grid.stations.iter().zip(frames).zip(narrowing);
        let side = |sign: f64| {
            move |((station, frame), narrowing): (
                (&alewife_mesh::Station, &Frame<Dual64>),
                &Dual64,
            )| {
                let normal = frame.normal();
                let width = *narrowing * (sign * station.half_width);
                [0, 1].map(|i| frame.position[i] + normal[i] * width)
            }
        };
        let last = frames.len() - 1;
        let upper = stations.clone().map(side(1.0));
        upper.chain(stations.take(last).skip(1).rev().map(side(-1.0))).collect()
    }

    /// Angle of the head-fixed frame in that without angular momentum (rad).
    ///
    /// # Errors
    /// [`GaitError::Midline`] when the midline cannot follow the gait up to this time (s).
    pub fn recoil_angle(&self, time: f64) -> Result<f64, GaitError> {
        let rate = |time| recoil_rate(&self.interior(time), time);
        match &self.open {
            None => self.recoil_angle.at(time, rate),
            Some((open, angle)) => angle.at(time, open.kinks(), rate),
        }
    }

    fn interior(&self, time: f64) -> Interior {
        let frames = self.midline.frames(&self.grid, Dual64::new(time, 1.0));
        Interior::of(&self.grid.nodes, &frames.nodes, self.hull.across())
    }

    /// What is subtracted at a time (s), from the interior alone.
    fn recoil_at(&self, time: f64) -> Result<Recoil, GaitError> {
        let interior = self.interior(time);
        Ok(Recoil {
            center: Point::<2>::from(interior.center.map(|part| part.re)),
            velocity: Point::<2>::from(interior.center.map(|part| part.eps)),
            angular_velocity: -recoil_rate(&interior, time)?,
        })
    }
}

/// Angular velocity that takes away the angular momentum (rad/s).
fn recoil_rate(interior: &Interior, time: f64) -> Result<f64, GaitError> {
    let rate = -interior.angular_momentum / interior.inertia;
    if rate.is_finite() { Ok(rate) } else { Err(GaitError::Midline { time }) }
}

impl ShapeMotion for SlenderBody {
    fn at(&self, time: f64) -> Result<DeformedOutline, GaitError> {
        self.deformed(time, self.recoil_angle(time)?)
    }

    fn discontinuities(&self, _from: f64, _to: f64) -> Vec<f64> {
        // Ramps have continuous rates
        Vec::new()
    }

    fn recoil(&self) -> Result<RecoilMotion, GaitError> {
        if self.open.is_some() {
            return Ok(RecoilMotion::default());
        }
        let ([start, duration], [_, period]) = (self.midline.span(), self.midline.cycle());
        let n_periods = whole((duration / period).ceil()).clamp(1, MOST_PERIODS);
        RecoilMotion::over(start, duration, n_periods, |time| self.recoil_at(time))
    }
}
