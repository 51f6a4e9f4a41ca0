//! `Midline`: how the midlines of fish and flagellates bend in time.
//!
//! The head is in the origin and points along +x; the midline is followed from there, tangent to
//! tail. Waves run from head to tail, so swimmers swim towards +x.

use std::f64::consts::TAU;

use num_dual::{Dual, Dual2, DualNum, first_derivative, second_derivative};

use super::grid::Grid;
use super::number::{Number, cross};

/// Ramps of the form 1 - exp(-t / ramp) have ended after this many times `ramp`: exp(-37) < 1e-16.
const RAMP_TIMES: f64 = 37.0;

/// How a midline bends.
#[derive(Debug, Clone, PartialEq)]
pub enum Midline {
    /// A wave of curvature.
    Carangiform(Carangiform),
    /// A wave of displacements as a function of arc length.
    Anguilliform(Anguilliform),
    /// A wave in the tail of a body with a rigid head.
    Flagellum(Flagellum),
}

/// Curvature K(s) (sin(2 pi (t/T + phase - s/L)) + bending), ramped (@novati2017).
#[derive(Debug, Clone, PartialEq)]
pub struct Carangiform {
    /// Length L (m).
    pub length: f64,
    /// Places s/L, ascending, and K L there, joined by a natural cubic spline.
    pub curvature: Vec<[f64; 2]>,
    /// Constant part of the bracket, which steers.
    pub bending: f64,
    /// Period T (s).
    pub period: f64,
    /// Start in the period (periods).
    pub phase: f64,
    /// Duration of the ramp x² (3 - 2x), x = t / ramp (s).
    pub ramp: f64,
}

/// Displacement y = amplitude (s + offset L) sin(2 pi (s/L - t/T - phase)), ramped; material points
/// keep their arc length (@kern2006).
#[derive(Debug, Clone, PartialEq)]
pub struct Anguilliform {
    /// Length L (m).
    pub length: f64,
    /// Slope of the envelope.
    pub amplitude: f64,
    /// Where the envelope is zero: before the head by this part of the length.
    pub offset: f64,
    /// Period T (s).
    pub period: f64,
    /// Start in the period (periods).
    pub phase: f64,
    /// Duration of the ramp x² (3 - 2x), x = t / ramp (s).
    pub ramp: f64,
}

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
    pub length: f64,
    /// Amplitude at its end (m).
    pub amplitude: f64,
    /// Wavelength lambda (m).
    pub wavelength: f64,
    /// Period T (s).
    pub period: f64,
    /// Start in the period (periods).
    pub phase: f64,
    /// Time constant of the ramp (s); 0 for none.
    pub ramp: f64,
    /// Length over which the tail begins to bend (m).
    pub joint: f64,
    /// Whether the midline keeps its length.
    pub inextensible: bool,
}

/// A midline at one of its points.
#[derive(Debug, Clone, Copy)]
pub struct Frame<D> {
    /// Where it is (m).
    pub place: [D; 2],
    /// Unit tangent, from head to tail.
    pub tangent: [D; 2],
    /// Length over that at rest.
    pub stretch: D,
    /// Curvature, counter-clockwise from head to tail (1/m).
    pub curvature: D,
}

impl<D: Number> Frame<D> {
    /// Of a straight midline.
    fn straight(along: f64) -> Self {
        let (zero, one) = (D::from(0.0), D::from(1.0));
        Self {
            place: [D::from(-along), zero],
            tangent: [-one, zero],
            stretch: one,
            curvature: zero,
        }
    }

    /// Unit normal: upwards, with the head towards +x.
    pub fn normal(&self) -> [D; 2] {
        [self.tangent[1], -self.tangent[0]]
    }
}

/// A midline at the nodes and at the stations of a grid.
#[derive(Debug, Clone)]
pub struct Frames<D> {
    pub nodes: Vec<Frame<D>>,
    pub stations: Vec<Frame<D>>,
}

impl Midline {
    /// Duration after which the gait is periodic (s), and the period (s).
    pub fn cycle(&self) -> [f64; 2] {
        match self {
            Self::Carangiform(gait) => [gait.ramp, gait.period],
            Self::Anguilliform(gait) => [gait.ramp, gait.period],
            Self::Flagellum(gait) => [RAMP_TIMES * gait.ramp, gait.period],
        }
    }

    /// Places along the midline (m) where it is less than smooth.
    pub fn discontinuities(&self) -> Vec<f64> {
        match self {
            Self::Carangiform(gait) => {
                gait.curvature.iter().map(|[place, _]| place * gait.length).collect()
            }
            Self::Anguilliform(_) => Vec::new(),
            Self::Flagellum(gait) => vec![gait.head],
        }
    }

    /// The midline at a time (s).
    pub fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        match self {
            Self::Carangiform(gait) => gait.frames(grid, time),
            Self::Anguilliform(gait) => gait.frames(grid, time),
            Self::Flagellum(gait) if gait.inextensible => gait.inextensible_frames(grid, time),
            Self::Flagellum(gait) => {
                let frame = |along: f64| gait.displaced(along, time);
                Frames {
                    nodes: grid.nodes.iter().map(|node| frame(node.along)).collect(),
                    stations: grid.stations.iter().map(|at| frame(at.along)).collect(),
                }
            }
        }
    }
}

/// x² (3 - 2x) from zero to one, with x = t / duration: its rate is continuous.
fn smooth_ramp<D: Number>(time: D, duration: f64) -> D {
    if time < D::from(0.0) {
        return D::from(0.0);
    }
    if time >= D::from(duration) {
        return D::from(1.0);
    }
    let x = time / duration;
    x * x * (-x * 2.0 + 3.0)
}

impl Carangiform {
    fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let spline = NaturalSpline::new(&self.curvature);
        let ramp = smooth_ramp(time, self.ramp);
        let curvature = |along: f64| {
            let place = along / self.length;
            let phase = (time / self.period + (self.phase - place)) * TAU;
            ramp * (phase.sin() + self.bending) * (spline.at(place) / self.length)
        };
        let curvatures: Vec<D> = grid.nodes.iter().map(|node| curvature(node.along)).collect();
        let zero = D::from(0.0);
        let (angles, station_angles) = grid.integrate(&curvatures, zero);
        // From head to tail the straight midline runs along -x
        let tangent = |angle: &D| {
            let (sin, cos) = angle.sin_cos();
            [-cos, -sin]
        };
        let tangents: Vec<[D; 2]> = angles.iter().map(tangent).collect();
        let part = |axis: usize| -> Vec<D> { tangents.iter().map(|t| t[axis]).collect() };
        let (x, station_x) = grid.integrate(&part(0), zero);
        let (y, station_y) = grid.integrate(&part(1), zero);
        let one = D::from(1.0);
        let nodes = (0..x.len()).map(|i| Frame {
            place: [x[i], y[i]],
            tangent: tangents[i],
            stretch: one,
            curvature: curvatures[i],
        });
        let stations = (0..station_x.len()).map(|i| Frame {
            place: [station_x[i], station_y[i]],
            tangent: tangent(&station_angles[i]),
            stretch: one,
            curvature: curvature(grid.stations[i].along),
        });
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }
}

impl Anguilliform {
    fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let ramp = smooth_ramp(time, self.ramp);
        // Displacement, slope and second derivative along the midline
        let lateral = |along: f64| {
            let wave = |s: Dual2<D>| {
                let phase = s / self.length - Dual2::from_re(time / self.period + self.phase);
                let envelope = (s + self.offset * self.length) * self.amplitude;
                (phase * TAU).sin() * envelope * Dual2::from_re(ramp)
            };
            second_derivative(wave, D::from(along))
        };
        let advance = |slope: D| -(-slope * slope + 1.0).sqrt();
        let at_nodes: Vec<_> = grid.nodes.iter().map(|node| lateral(node.along)).collect();
        let rates: Vec<D> = at_nodes.iter().map(|(_, slope, _)| advance(*slope)).collect();
        let (x, station_x) = grid.integrate(&rates, D::from(0.0));
        let frame = |x: D, (y, slope, bend): (D, D, D)| {
            let advance = advance(slope);
            Frame {
                place: [x, y],
                tangent: [advance, slope],
                stretch: D::from(1.0),
                curvature: bend / advance,
            }
        };
        let nodes = x.iter().zip(at_nodes).map(|(x, lateral)| frame(*x, lateral));
        let stations = station_x.iter().zip(&grid.stations);
        let stations = stations.map(|(x, at)| frame(*x, lateral(at.along)));
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }
}

impl Flagellum {
    /// Amplitude at a distance along the tail (m).
    fn envelope<D: Number>(&self, along: D) -> D {
        let x = along / self.joint;
        // Three continuous derivatives at the head, and no other place that is less than smooth
        -(-x * x * x).exp_m1() * along * (self.amplitude / self.length)
    }

    /// 1 - exp(-t / ramp).
    fn ramp<D: Number>(&self, time: D) -> D {
        if self.ramp > 0.0 { -(-time / self.ramp).exp_m1() } else { D::from(1.0) }
    }

    /// Lateral displacement (m) at a distance from the head along the axis (m), without the ramp.
    fn wave<D: Number>(&self, x: D, time: D) -> D {
        let phase = x / self.wavelength - time / self.period - self.phase;
        self.envelope(x) * (phase * TAU).sin()
    }

    fn inextensible_frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
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
        let (_, station_x) = grid.integrate(&rates, D::from(0.0));
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
            Frame { place: [-x, y], tangent, stretch: D::from(1.0), curvature }
        };
        let nodes = x.iter().zip(&grid.nodes).map(|(x, at)| frame(at.along, *x));
        let stations = station_x.iter().zip(&grid.stations).map(|(x, at)| frame(at.along, *x));
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }

    /// Integral over time, from 0 on, of (1 - exp(-t / ramp)) cos(frequency t - lag).
    fn ramped_integral<D: Number>(&self, frequency: f64, lag: D, time: D) -> D {
        let now = time * frequency - lag;
        let free = (now.sin() + lag.sin()) / frequency;
        if self.ramp <= 0.0 {
            return free;
        }
        let decay = 1.0 / self.ramp;
        let end = (now.sin() * frequency - now.cos() * decay) * (-time * decay).exp();
        let start = -(lag.sin() * frequency + lag.cos() * decay);
        free - (end - start) / (decay * decay + frequency * frequency)
    }

    /// A point of the tail with prescribed velocities.
    fn displaced<D: Number>(&self, along: f64, time: D) -> Frame<D> {
        if along <= self.head {
            return Frame::straight(along);
        }
        let frequency = TAU / self.period;
        let time = |s: Dual2<D>| (s, Dual2::from_re(time));
        let lag = |s: Dual2<D>| (s / self.wavelength - self.phase) * TAU;
        let lateral = |s: Dual2<D>| {
            let (s, time) = time(s);
            self.envelope(s) * self.ramped_integral(frequency, lag(s), time) * frequency
        };
        let axial = |s: Dual2<D>| {
            let (s, time) = time(s);
            let envelope = self.envelope(s);
            let factor = 0.25 * TAU * TAU / (self.wavelength * self.period);
            let integral = self.ramped_integral(2.0 * frequency, lag(s) * 2.0, time);
            envelope * envelope * integral * factor
        };
        let s = D::from(along - self.head);
        let (y, y_rate, y_bend) = second_derivative(lateral, s);
        let (x, x_rate, x_bend) = second_derivative(axial, s);
        let rate = [-(x_rate + 1.0), y_rate];
        let stretch = (rate[0] * rate[0] + rate[1] * rate[1]).sqrt();
        Frame {
            place: [-(x + along), y],
            tangent: rate.map(|part| part / stretch),
            stretch,
            curvature: cross(rate, [-x_bend, y_bend]) / (stretch * stretch * stretch),
        }
    }
}

/// Natural cubic spline through points of a plane, constant slope outside.
struct NaturalSpline<'a> {
    points: &'a [[f64; 2]],
    bends: Vec<f64>,
}

impl<'a> NaturalSpline<'a> {
    fn new(points: &'a [[f64; 2]]) -> Self {
        let n = points.len();
        let mut bends = vec![0.0; n];
        let mut factors = vec![0.0; n];
        // Thomas algorithm for the second derivatives, zero at both ends
        for i in 1..n.saturating_sub(1) {
            let ([x0, y0], [x1, y1], [x2, y2]) = (points[i - 1], points[i], points[i + 1]);
            let (before, after) = (x1 - x0, x2 - x1);
            let right = 6.0 * ((y2 - y1) / after - (y1 - y0) / before);
            let pivot = 2.0 * (before + after) - before * factors[i - 1];
            factors[i] = after / pivot;
            bends[i] = (right - before * bends[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            bends[i] -= factors[i] * bends[i + 1];
        }
        Self { points, bends }
    }

    fn at(&self, x: f64) -> f64 {
        let i = self.points.partition_point(|p| p[0] <= x).clamp(1, self.points.len() - 1) - 1;
        let ([x0, y0], [x1, y1]) = (self.points[i], self.points[i + 1]);
        let h = x1 - x0;
        let (a, b) = ((x1 - x) / h, (x - x0) / h);
        let (m, n) = (self.bends[i], self.bends[i + 1]);
        y0 * a + y1 * b + (m * (a * a * a - a) + n * (b * b * b - b)) * (h * h / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_natural_spline_passes_through_its_points_without_a_bend_at_its_ends() {
        let points = [[0.0, 1.0], [0.2, 2.0], [0.5, 0.5], [1.0, 3.0]];
        let spline = NaturalSpline::new(&points);
        for [x, y] in points {
            assert!((spline.at(x) - y).abs() < 1e-14);
        }
        let h = 1e-3;
        for i in 1..3 {
            let x = points[i][0];
            let bend = |x: f64| spline.at(x + h) - 2.0 * spline.at(x) + spline.at(x - h);
            assert!((bend(x - 2.0 * h) - bend(x + 2.0 * h)).abs() < 1e-3);
            let slope = |x: f64| spline.at(x + 1e-7) - spline.at(x - 1e-7);
            assert!((slope(x - 1e-7) - slope(x + 1e-7)).abs() < 1e-11);
        }
        assert_eq!((spline.bends[0], spline.bends[3]), (0.0, 0.0));
    }

    #[test]
    fn the_integral_of_a_ramped_wave_has_the_ramped_wave_as_its_rate() {
        let tail = Flagellum {
            head: 4.0,
            length: 50.0,
            amplitude: 4.0,
            wavelength: 20.0,
            period: 0.3,
            phase: 0.0,
            ramp: 0.7,
            joint: 2.0,
            inextensible: false,
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
