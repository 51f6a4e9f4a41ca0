//! `ClosedSurface`: sections that move, with the exact rates of what they enclose.

use std::f64::consts::TAU;

use alewife_mesh::Spline;
use alewife_mesh::spatial::{
    Section, SectionMoments, SectionPoint, Sections, along_section, in_plane, on_section,
};
use num_dual::Dual64;

/// Angles of a section at which its velocity is looked at.
const ANGLES: usize = 12;

/// Sections with those of their velocities: the surface is linear in its outline and its heights.
#[derive(Debug, Clone)]
pub struct ClosedSurface {
    pub places: Sections,
    pub rates: Sections,
}

/// Integrals over what a surface encloses.
#[derive(Debug, Clone, Copy)]
pub struct EnclosedVolume {
    /// Volume (m³).
    pub volume: Dual64,
    /// Its centre (m).
    pub center: [Dual64; 2],
    /// Second moments about the centre: xx, xy, yy, zz (m⁵).
    pub second: [Dual64; 4],
}

impl ClosedSurface {
    /// Of the points of an outline at given parameters, and half heights from nose to tail; `None` if there
    /// is no such surface.
    pub fn through(points: &[[Dual64; 2]], heights: &[Dual64], knots: &[f64]) -> Option<Self> {
        let sections = |part: fn(&Dual64) -> f64| {
            let points: Vec<[f64; 2]> = points.iter().map(|p| [part(&p[0]), part(&p[1])]).collect();
            let heights: Vec<f64> = heights.iter().map(part).collect();
            Sections::new(&Spline::with_knots(&points, knots)?, &heights)
        };
        Some(Self { places: sections(|value| value.re)?, rates: sections(|value| value.eps)? })
    }

    /// Volume and moments.
    pub fn enclosed(&self) -> EnclosedVolume {
        let mut sums = SectionMoments::<Dual64>::default();
        for place in self.places.rule() {
            let [value, along] = self.places.on(&place);
            let [rate, along_rate] = self.rates.on(&place);
            let dual = |value: &Section, rate: &Section| -> [Dual64; 5] {
                let (value, rate) = (in_plane(value), in_plane(rate));
                std::array::from_fn(|i| Dual64::new(value[i], rate[i]))
            };
            sums.add(place.weight, &dual(&value, &rate), &dual(&along, &along_rate));
        }
        let SectionMoments { volume, first, mut second } = sums;
        let center = first.map(|moment| moment / volume);
        for (moment, [i, j]) in second.iter_mut().zip([[0, 0], [0, 1], [1, 1]]) {
            *moment -= volume * center[i] * center[j];
        }
        EnclosedVolume { volume, center, second }
    }

    /// Mean of |velocity along the normal| over the surface (m/s).
    pub fn mean_normal_speed(&self) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for pair in self.places.knots().windows(2) {
            let (along, step) = (0.5 * (pair[0] + pair[1]), pair[1] - pair[0]);
            let [section, ahead, _] = self.places.at(along);
            let [rate, ..] = self.rates.at(along);
            for i in 0..ANGLES {
                let angle = TAU * i as f64 / ANGLES as f64;
                let around = along_section(&section, angle);
                let normal = on_section(&ahead, angle).cross(&around) * step;
                sum += on_section(&rate, angle).dot(&normal).abs();
                area += normal.norm();
            }
        }
        sum / area
    }
}

/// Where on sections the points of their outline are, by its parameter.
pub fn on_outline(sections: &Sections, parameter: f64) -> SectionPoint {
    let end = sections.end();
    let parameter = parameter.rem_euclid(2.0 * end);
    if parameter <= end {
        SectionPoint { along: parameter, around: 0.0 }
    } else {
        SectionPoint { along: 2.0 * end - parameter, around: 0.5 * TAU }
    }
}
