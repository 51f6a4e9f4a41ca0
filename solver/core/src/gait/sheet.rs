//! Taylor's waving sheet: y = b sin(k x - w t) on a side of the domain, its material inextensible or
//! not.
//!
//! Seen from the wave, inextensible material runs along the curve at the speed c L, with c = w / k
//! and L the arc length of a wavelength over the wavelength, so that no part of it is stretched
//! (@taylor1951). Extensible material moves up and down only.

use std::f64::consts::TAU;

use nalgebra::Vector2;

/// Points of the trapezoidal rule for the arc length: exact to rounding for any slope in use.
const ARC_POINTS: u32 = 256;

/// A sheet that waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WavingSheet {
    /// Amplitude b (m).
    pub amplitude: f64,
    /// Wavenumber k (1/m).
    pub wavenumber: f64,
    /// Angular frequency w (rad/s); positive ones send the wave towards +x.
    pub angular_frequency: f64,
    /// Arc length of a wavelength over the wavelength; none where the material is extensible.
    stretch: Option<f64>,
}

impl WavingSheet {
    /// A sheet of an amplitude (m), a wavelength (m) and a period (s).
    #[must_use]
    pub fn new(amplitude: f64, wavelength: f64, period: f64, is_extensible: bool) -> Self {
        let wavenumber = TAU / wavelength;
        let arc = |index: u32| {
            let phase = TAU * f64::from(index) / f64::from(ARC_POINTS);
            1.0_f64.hypot(amplitude * wavenumber * phase.cos())
        };
        let stretch = (0..ARC_POINTS).map(arc).sum::<f64>() / f64::from(ARC_POINTS);
        Self {
            amplitude,
            wavenumber,
            angular_frequency: TAU / period,
            stretch: (!is_extensible).then_some(stretch),
        }
    }

    fn phase(&self, x: f64, time: f64) -> f64 {
        self.wavenumber * x - self.angular_frequency * time
    }

    /// Height (m) of the sheet over its mean at x (m) and a time (s).
    #[must_use]
    pub fn height(&self, x: f64, time: f64) -> f64 {
        self.amplitude * self.phase(x, time).sin()
    }

    /// Velocity (m/s) of the material that is at x (m) at a time (s).
    #[must_use]
    pub fn velocity(&self, x: f64, time: f64) -> Vector2<f64> {
        let cosine = self.phase(x, time).cos();
        let Some(stretch) = self.stretch else {
            return Vector2::new(0.0, -self.amplitude * self.angular_frequency * cosine);
        };
        let slope = self.amplitude * self.wavenumber * cosine;
        let wave_speed = self.angular_frequency / self.wavenumber;
        let backwards = wave_speed * stretch / 1.0_f64.hypot(slope);
        Vector2::new(wave_speed - backwards, -backwards * slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Material stays on the curve; inextensible material comes back after a period, and the
    /// distance of two of its points along the curve does not change.
    #[test]
    fn material_stays_on_the_curve_and_keeps_its_length() {
        for is_extensible in [false, true] {
            let sheet = WavingSheet::new(0.3, 2.0, 2.0, is_extensible);
            let steps = 4000;
            let step = 2.0 / f64::from(steps);
            let mut points = [0.1_f64, 0.5].map(|x| Vector2::new(x, sheet.height(x, 0.0)));
            let start = points;
            let arc = |from: f64, to: f64, time: f64| -> f64 {
                let n = 2000;
                let at = |i: u32| {
                    let x = from + (to - from) * f64::from(i) / f64::from(n);
                    Vector2::new(x, sheet.height(x, time))
                };
                (0..n).map(|i| (at(i + 1) - at(i)).norm()).sum()
            };
            let length = arc(points[0].x, points[1].x, 0.0);
            for index in 0..steps {
                let time = f64::from(index) * step;
                for point in &mut points {
                    let half = *point + sheet.velocity(point.x, time) * (0.5 * step);
                    *point += sheet.velocity(half.x, time + 0.5 * step) * step;
                }
                let now = time + step;
                assert!((points[0].y - sheet.height(points[0].x, now)).abs() < 1e-6);
                let change = arc(points[0].x, points[1].x, now) - length;
                assert!(is_extensible || index % 500 != 0 || change.abs() < 1e-6, "{change}");
            }
            assert!((points[0] - start[0]).norm() < 1e-5, "{points:?}");
        }
    }
}
