//! Integrals over what sections enclose: `SectionMoments` with the midline in a plane, `SolidMoments` in space.

use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

use nalgebra::Matrix3;

use super::{Section, parts_of};
use crate::Point;

/// A number that integrals are made of: a real one, or one with its derivative.
pub trait Summand:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + From<f64>
{
}

impl<T> Summand for T where
    T: Copy
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + Mul<f64, Output = T>
        + From<f64>
{
}

/// Integrals over what sections enclose whose midline is in the plane z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionMoments<T> {
    /// Volume (m³).
    pub volume: T,
    /// Integrals of x and y (m⁴).
    pub first: [T; 2],
    /// Integrals of xx, xy, yy and zz (m⁵).
    pub second: [T; 4],
}

impl<T: Summand> Default for SectionMoments<T> {
    fn default() -> Self {
        let zero = T::from(0.0);
        Self { volume: zero, first: [zero; 2], second: [zero; 4] }
    }
}

impl<T: Summand> SectionMoments<T> {
    /// Adds a section with its derivative by the parameter, weighted: midline (x, y), half width (x, y), half height.
    ///
    /// The volume between sections is H (W x C' + u W x W') du dv dp, integrated over the unit disc.
    pub fn add(&mut self, weight: f64, section: &[T; 5], rate: &[T; 5]) {
        let [cx, cy, wx, wy, h] = *section;
        let ahead = (wx * rate[1] - wy * rate[0]) * h * (PI * weight);
        let turn = (wx * rate[3] - wy * rate[2]) * h * (0.25 * PI * weight);
        let (c, w) = ([cx, cy], [wx, wy]);
        self.volume = self.volume + ahead;
        for axis in 0..2 {
            self.first[axis] = self.first[axis] + c[axis] * ahead + w[axis] * turn;
        }
        for (sum, [i, j]) in self.second.iter_mut().zip([[0, 0], [0, 1], [1, 1]]) {
            let mixed = c[i] * w[j] + c[j] * w[i];
            *sum = *sum + (c[i] * c[j] + w[i] * w[j] * 0.25) * ahead + mixed * turn;
        }
        self.second[3] = self.second[3] + h * h * ahead * 0.25;
    }
}

/// Integrals over what sections enclose, whatever way the midline bends.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SolidMoments {
    /// Volume (m³).
    pub volume: f64,
    /// Integrals of x, y and z (m⁴).
    pub first: Point<3>,
    /// Integrals of products of two of them (m⁵).
    pub second: Matrix3<f64>,
}

impl SolidMoments {
    /// Adds a section with its derivative by the parameter, weighted.
    ///
    /// The volume between sections is (H x W) . (C' + u W' + v H') du dv dp, integrated over the unit disc.
    pub fn add(&mut self, weight: f64, section: &Section, rate: &Section) {
        let [c, w, h] = parts_of(section);
        let normal = h.cross(&w) * (PI * weight);
        let [ahead, by_width, by_height] = parts_of(rate).map(|part| normal.dot(&part));
        let turn = (w * by_width + h * by_height) * 0.25;
        self.volume += ahead;
        self.first += c * ahead + turn;
        let own = (w * w.transpose() + h * h.transpose()) * 0.25;
        let mixed = c * turn.transpose();
        self.second += (c * c.transpose() + own) * ahead + mixed + mixed.transpose();
    }

    /// Tensor of inertia about the centre, of unit density (m⁵).
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        let Self { volume, first, second } = self;
        let central = second - first * first.transpose() / *volume;
        Matrix3::identity() * central.trace() - central
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_bodies::bent_fish;
    use super::super::{Sections, along_section, on_section};
    use super::*;

    /// A body with a midline in a plane, turned out of it point by point.
    fn turned(body: &Sections, turn: nalgebra::Rotation3<f64>, shift: Point<3>) -> Sections {
        let (knots, end) = (body.knots(), body.end());
        let n = knots.len() - 1;
        let all: Vec<f64> = (0..=2 * n)
            .map(|i| if i <= n { knots[i] } else { 2.0 * end - knots[2 * n - i] })
            .collect();
        let outline = |around: f64| -> Vec<Point<3>> {
            let at = |i: usize| {
                let (knot, sign) = if i <= n { (i, 1.0) } else { (2 * n - i, -1.0) };
                let [section, ..] = body.at(knots[knot]);
                let [middle, width, height] = parts_of(&section);
                let off = if around == 0.0 { width } else { height };
                turn * (middle + off * sign) + shift
            };
            (0..2 * n).map(at).collect()
        };
        let [width, height] = [outline(0.0), outline(1.0)];
        Sections::around([&width, &height], &all).expect("it is a body")
    }

    #[test]
    fn a_body_through_points_in_space_is_the_planar_one_turned() {
        let body = bent_fish();
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 1.1);
        let shift = Point::<3>::new(0.3, -0.1, 0.2);
        let (found, exact) = (turned(&body, turn, shift), body.moments());
        for along in [0.0, 0.1, 1.37, 3.0, body.end()] {
            for around in [0.0, 0.8, 3.0, 5.1] {
                let [own, whole] = [&found, &body].map(|of| on_section(&of.at(along)[0], around));
                assert!((own - turn * whole - shift).norm() < 1e-12, "{along} {around}");
            }
        }
        let moments = found.solid_moments();
        assert!((moments.volume / exact.volume - 1.0).abs() < 1e-12);
        let center = Point::<3>::new(exact.first[0], exact.first[1], 0.0) / exact.volume;
        let own = moments.first / moments.volume;
        assert!((own - turn * center - shift).norm() < 1e-12, "{own}");
        let [xx, xy, yy, zz] = exact.second;
        let whole = Matrix3::new(xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, zz);
        let central = whole - center * center.transpose() * exact.volume;
        let tensor = Matrix3::identity() * central.trace() - central;
        let turn = turn.into_inner();
        assert!(
            (moments.tensor() - turn * tensor * turn.transpose()).amax() < 1e-12 * tensor.amax()
        );
    }

    /// A tube about a helix: by Pappus's theorem its volume is that of its sections times the length of the midline, but for
    /// its ends; all moments by the divergence theorem on the surface.
    #[test]
    fn moments_of_a_body_that_bends_out_of_a_plane_are_those_of_its_surface() {
        let body = helical();
        let (n_along, n_around) = (3000, 48);
        let (mut volume, mut first, mut second) = (0.0, Point::<3>::zeros(), Matrix3::zeros());
        let [step, turn] = [body.end() / f64::from(n_along), 2.0 * PI / f64::from(n_around)];
        for i in 0..n_along {
            let [value, rate, _] = body.at(step * (f64::from(i) + 0.5));
            for k in 0..n_around {
                let angle = turn * f64::from(k);
                let at = on_section(&value, angle);
                let normal = on_section(&rate, angle).cross(&along_section(&value, angle));
                let flux = at.dot(&normal) * step * turn;
                volume += flux / 3.0;
                first += at * (flux / 4.0);
                second += at * at.transpose() * (flux / 5.0);
            }
        }
        let own = body.solid_moments();
        assert!(own.volume > 0.0 && (own.volume / volume - 1.0).abs() < 1e-6, "{own:?} {volume}");
        assert!((own.first - first).amax() < 1e-6 * volume, "{own:?} {first}");
        assert!((own.second - second).amax() < 1e-6 * volume, "{own:?} {second}");
    }

    /// A body of elliptic sections about a turn of a helix.
    fn helical() -> Sections {
        let n = 80;
        let station = |i: usize| {
            let part = PI * i as f64 / n as f64;
            let sin = if i == n { 0.0 } else { part.sin() };
            let phase = 2.0 * part;
            let middle = Point::<3>::new(-0.3 * phase, 0.4 * phase.cos(), 0.4 * phase.sin());
            let ahead = Point::<3>::new(-0.3, -0.4 * phase.sin(), 0.4 * phase.cos()).normalize();
            let width = Point::<3>::new(0.0, phase.cos(), phase.sin());
            [middle, width * (0.1 * sin), width.cross(&ahead) * (0.07 * sin)]
        };
        let outline = |side: usize| -> Vec<Point<3>> {
            let at = |i: usize| {
                let (knot, sign) = if i <= n { (i, 1.0) } else { (2 * n - i, -1.0) };
                let parts = station(knot);
                parts[0] + parts[side] * sign
            };
            (0..2 * n).map(at).collect()
        };
        let knots: Vec<f64> = (0..=2 * n).map(|i| PI * i as f64 / n as f64).collect();
        Sections::around([&outline(1), &outline(2)], &knots).expect("it is a body")
    }
}
