//! `Pulse`: a disc or a sphere whose area or volume is a function of time.

use std::f64::consts::TAU;
use std::iter::successors;

use alewife_mesh::SecondMoments;
use num_dual::{Dual64, DualNum, first_derivative};

use super::deformed_outline::{DeformedOutline, MaterialCurve, RecoilCorrection, ShapeMotion};
use super::error::GaitError;
use super::recoil::RecoilMotion;

/// A round body that grows and shrinks.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulse {
    /// Radius at rest (m).
    pub radius: f64,
    /// Whether it is a sphere; otherwise it is a disc in the plane.
    pub is_sphere: bool,
    /// Its area or volume over that at rest.
    pub law: PulseLaw,
}

/// Area of a disc or volume of a sphere over that at rest, as a function of time.
#[derive(Debug, Clone, PartialEq)]
pub enum PulseLaw {
    /// 1 + amplitude sin(2 pi (t / period + phase)).
    Sine {
        /// Between 0 and 1.
        amplitude: f64,
        /// Period (s).
        period: f64,
        /// Start in the period (periods).
        phase: f64,
    },
    /// Straight lines between knots, constant outside.
    Table {
        /// Times (s), ascending from 0, and positive ratios.
        knots: Vec<[f64; 2]>,
        /// After this time (s), that of the last knot or later, it begins again.
        period: Option<f64>,
    },
}

impl PulseLaw {
    /// The ratio at a time (s), not a number for a table without knots.
    fn ratio(&self, time: Dual64) -> Dual64 {
        match self {
            Self::Sine { amplitude, period, phase } => {
                ((time / *period + *phase) * TAU).sin() * *amplitude + 1.0
            }
            Self::Table { knots, period } => {
                let time = match period {
                    Some(period) => time - *period * (time.re / period).floor(),
                    None => time,
                };
                let after = knots.partition_point(|knot| knot[0] <= time.re);
                if after == 0 || after == knots.len() {
                    let end = if after == 0 { knots.first() } else { knots.last() };
                    return Dual64::from(end.map_or(f64::NAN, |knot| knot[1]));
                }
                let ([t0, r0], [t1, r1]) = (knots[after - 1], knots[after]);
                (time - t0) * ((r1 - r0) / (t1 - t0)) + r0
            }
        }
    }
}

impl ShapeMotion for Pulse {
    fn at(&self, time: f64) -> Result<DeformedOutline, GaitError> {
        let dimension = if self.is_sphere { 3.0 } else { 2.0 };
        let ratio = |time| self.law.ratio(time);
        let (radius, speed) =
            first_derivative(|time: Dual64| ratio(time).powf(1.0 / dimension) * self.radius, time);
        if !(radius > 0.0 && radius.is_finite() && speed.is_finite()) {
            return Err(GaitError::Radius { time, radius });
        }
        let is_sphere = self.is_sphere;
        let curve = MaterialCurve::Round { radius, radial_speed: speed, is_sphere };
        let moments = curve.shape().and_then(|shape| shape.moments());
        let moments = moments.expect("a disc and a sphere have moments");
        // Inertia goes with the power 2 + dimension of the radius
        let inertia = match moments.second {
            SecondMoments::Planar { polar } => polar,
            SecondMoments::Revolved { across, .. } => across,
            SecondMoments::Spatial { tensor } => tensor[(2, 2)],
        };
        Ok(DeformedOutline {
            curve,
            moments,
            inertia_rate: (2.0 + dimension) * inertia * speed / radius,
            recoil: RecoilCorrection { mean_normal_speed: speed.abs(), ..RecoilCorrection::NONE },
        })
    }

    fn discontinuities(&self, from: f64, to: f64) -> Vec<f64> {
        let PulseLaw::Table { knots, period } = &self.law else { return Vec::new() };
        let [first, last] =
            period.map_or([0.0; 2], |period| [(from / period).floor(), (to / period).ceil()]);
        let mut times: Vec<f64> = successors(Some(first), |cycle| Some(cycle + 1.0))
            .take_while(|cycle| *cycle <= last)
            .flat_map(|cycle| {
                let start = period.map_or(0.0, |period| period * cycle);
                knots.iter().map(move |knot| start + knot[0])
            })
            .filter(|time| *time > from && *time < to)
            .collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// A round body that grows about its centre has no momentum.
    fn recoil(&self) -> Result<RecoilMotion, GaitError> {
        Ok(RecoilMotion::default())
    }
}
