//! `Flagellum`: a rigid head with a tail along which a wave travels.

use std::f64::consts::TAU;

use num_dual::{Dual, Dual2, first_derivative, second_derivative};

use super::frame::{Frame, Frames};
use crate::case::FlagellumGait;
use crate::gait::grid::Grid;
use crate::gait::number::{Number, cross};

/// A wave with an amplitude that grows along the tail like s / L.
///
/// Inextensible: y = r(t) a(x) sin(2 pi (x/lambda - t/T - phase)) with x the distance from the head
/// along the axis, and material points keep their arc length. Otherwise velocities are prescribed,
/// as by Razavi and Ahmadi (2015): lateral r a(s) (2 pi/T) cos(2 pi (t/T - s/lambda)), axial away from the head
/// r a(s)² pi²/(lambda T) cos(4 pi (t/T - s/lambda)), and displacements are their integrals from
/// the straight tail at t = 0 on; cross-sections thin where the midline is stretched.
/// r = 1 - exp(-t / ramp); a = amplitude s/L (1 - exp(-(s / joint)³)), so that curvature is
/// continuous at the head, which stays as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Flagellum {
    /// Length of the rigid head (m).
    pub head: f64,
    /// Length L of the tail (m).
    pub tail: f64,
    /// The wave.
    pub gait: FlagellumGait,
}

impl Flagellum {
    /// Amplitude at a distance along the tail (m).
    fn envelope<D: Number>(&self, along: D) -> D {
        let x = along / self.gait.joint(self.tail);
        // Three continuous derivatives at the head, smooth everywhere else
        -(-x * x * x).exp_m1() * along * (self.gait.amplitude / self.tail)
    }

    /// 1 - exp(-t / ramp).
    fn ramp<D: Number>(&self, time: D) -> D {
        let ramp = self.gait.ramp();
        if ramp > 0.0 { -(-time / ramp).exp_m1() } else { D::from(1.0) }
    }

    /// Lateral displacement (m) at a distance from the head along the axis (m), without the ramp.
    fn wave<D: Number>(&self, x: D, time: D) -> D {
        let phase = x / self.gait.wavelength - time / self.gait.period - self.gait.phase;
        self.envelope(x) * (phase * TAU).sin()
    }

    pub(super) fn inextensible_frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let ramp = self.ramp(time);
        let slope = |x: D| {
            let wave = |x: Dual<D>| self.wave(x, Dual::from_re(time));
            first_derivative(wave, x).1 * ramp
        };
        // Distance from the head along the axis: dx/ds = 1 / sqrt(1 + y'²)
        let rate = |along: f64, x: D| {
            let one = D::from(1.0);
            if along <= self.head {
                return one;
            }
            let slope = slope(x - self.head);
            (slope * slope + 1.0).sqrt().recip()
        };
        let x = grid.solve(D::from(0.0), rate);
        let rates: Vec<D> = x.iter().zip(&grid.nodes).map(|(x, at)| rate(at.along, *x)).collect();
        let integrals = grid.integrate(&rates, D::from(0.0));
        let frame = |along: f64, x: D| {
            if along <= self.head {
                return Frame::straight(along);
            }
            let wave = |x: Dual2<D>| self.wave(x, Dual2::from_re(time));
            let (y, slope, bend) = second_derivative(wave, x - self.head);
            let (y, slope, bend) = (y * ramp, slope * ramp, bend * ramp);
            let secant = (slope * slope + 1.0).sqrt();
            let tangent = [-secant.recip(), slope / secant];
            let curvature = -bend / (secant * secant * secant);
            Frame { position: [-x, y], tangent, stretch: D::from(1.0), curvature }
        };
        let nodes = x.iter().zip(&grid.nodes).map(|(x, at)| frame(at.along, *x));
        let stations =
            integrals.stations.iter().zip(&grid.stations).map(|(x, at)| frame(at.along, *x));
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }

    /// Integral over time, from 0 on, of (1 - exp(-t / ramp)) cos(frequency t - lag).
    fn ramped_integral<D: Number>(&self, frequency: f64, lag: D, time: D) -> D {
        let now = time * frequency - lag;
        let free = (now.sin() + lag.sin()) / frequency;
        let ramp = self.gait.ramp();
        if ramp <= 0.0 {
            return free;
        }
        let decay = 1.0 / ramp;
        let end = (now.sin() * frequency - now.cos() * decay) * (-time * decay).exp();
        let start = -(lag.sin() * frequency + lag.cos() * decay);
        free - (end - start) / (decay * decay + frequency * frequency)
    }

    /// A point of the tail with prescribed velocities.
    pub(super) fn displaced<D: Number>(&self, along: f64, time: D) -> Frame<D> {
        if along <= self.head {
            return Frame::straight(along);
        }
        let frequency = TAU / self.gait.period;
        let time = |s: Dual2<D>| (s, Dual2::from_re(time));
        let lag = |s: Dual2<D>| (s / self.gait.wavelength - self.gait.phase) * TAU;
        let lateral = |s: Dual2<D>| {
            let (s, time) = time(s);
            self.envelope(s) * self.ramped_integral(frequency, lag(s), time) * frequency
        };
        let axial = |s: Dual2<D>| {
            let (s, time) = time(s);
            let envelope = self.envelope(s);
            let factor = 0.25 * TAU * TAU / (self.gait.wavelength * self.gait.period);
            let integral = self.ramped_integral(2.0 * frequency, lag(s) * 2.0, time);
            envelope * envelope * integral * factor
        };
        let s = D::from(along - self.head);
        let (y, y_rate, y_bend) = second_derivative(lateral, s);
        let (x, x_rate, x_bend) = second_derivative(axial, s);
        let rate = [-(x_rate + 1.0), y_rate];
        let stretch = (rate[0] * rate[0] + rate[1] * rate[1]).sqrt();
        Frame {
            position: [-(x + along), y],
            tangent: rate.map(|part| part / stretch),
            stretch,
            curvature: cross(rate, [-x_bend, y_bend]) / (stretch * stretch * stretch),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_of_a_ramped_wave_has_the_ramped_wave_as_its_rate() {
        let tail = Flagellum {
            head: 4.0,
            tail: 50.0,
            gait: FlagellumGait {
                amplitude: 4.0,
                wavelength: 20.0,
                period: 0.3,
                phase: 0.0,
                ramp: Some(0.7),
                joint: Some(2.0),
                inextensible: false,
            },
        };
        for time in [0.0_f64, 0.2, 1.7] {
            let integral = |t: num_dual::Dual64| tail.ramped_integral(21.0, 0.4.into(), t);
            let (value, rate) = first_derivative(integral, time);
            let exact = (1.0 - (-time / 0.7).exp()) * (21.0 * time - 0.4).cos();
            assert!((rate - exact).abs() < 1e-13);
            assert!(time > 0.0 || value.abs() < 1e-16);
        }
    }
}
