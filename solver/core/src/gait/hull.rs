//! `Hull`: what closes a body about its midline: an outline in the plane, or elliptic sections in space.

use std::sync::Arc;

use alewife_mesh::spatial::{SectionHeight, Slender};
use alewife_mesh::{GaussRule, Moments, Point, Profile, SecondMoments, Shape, Spline};
use nalgebra::Matrix3;
use num_dual::{Dual64, DualNum};

use super::closed::{ClosedCurve, ClosedSurface, EnclosedVolume, on_outline};
use super::deformed_outline::MaterialCurve;
use super::error::GaitError;
use super::grid::Grid;
use super::momentum::Across;

/// Points of the Gauss rule on each piece of an outline: exact for all its moments.
const RULE_POINTS: usize = 6;

/// What closes a body, with what it encloses at rest.
#[derive(Debug)]
pub enum Hull {
    /// An outline in the plane, which keeps its area.
    Plane {
        knots: Vec<f64>,
        /// Area (m²).
        area: f64,
        rule: GaussRule,
    },
    /// A surface in space, which keeps its volume.
    Space {
        knots: Vec<f64>,
        /// Half heights at rest (m) at the stations and at the nodes of the grid.
        heights: Vec<f64>,
        heights_at_nodes: Vec<f64>,
        /// Volume (m³).
        volume: f64,
    },
}

/// A body that is closed and in its place.
pub struct Closed {
    pub curve: MaterialCurve,
    /// About the centre, which is the origin.
    pub moments: Moments,
    /// Rate of the second moment that resists turning in the plane (m⁴/s; m⁵/s in space).
    pub inertia_rate: f64,
    /// Where the centre was (m).
    pub center: [Dual64; 2],
    /// Speed along the normals that keeps area or volume (m/s), in space its mean.
    pub normal_speed: f64,
    /// Mean of |velocity along the normal| (m/s).
    pub mean_normal_speed: f64,
}

/// An outline with the area at rest, and the speed along its normals that keeps the area (m/s).
struct Kept {
    points: Vec<[Dual64; 2]>,
    normal_speed: f64,
}

impl Hull {
    /// The hull of a profile, in space with heights.
    pub fn new(
        profile: &Profile,
        grid: &Grid,
        height: Option<SectionHeight>,
    ) -> Result<Self, GaitError> {
        let rest = profile.spline().ok_or(GaitError::Shape)?;
        let knots = rest.knots().to_vec();
        let Some(height) = height else {
            let moments = Shape::Curve { spline: Arc::new(rest) }.moments();
            let area = moments.ok_or(GaitError::Shape)?.measure;
            return Ok(Self::Plane { knots, area, rule: GaussRule::new(RULE_POINTS) });
        };
        let sections = profile.sections(height).ok_or(GaitError::Shape)?;
        let at =
            |node: &super::grid::Node| height.at(node.along, node.half_width, profile.length());
        Ok(Self::Space {
            knots,
            heights: height.along(profile),
            heights_at_nodes: grid.nodes.iter().map(at).collect(),
            volume: sections.moments().volume,
        })
    }

    /// What the interior is made of.
    pub fn across(&self) -> Across<'_> {
        match self {
            Self::Plane { .. } => Across::Plane,
            Self::Space { heights_at_nodes, .. } => Across::Space(heights_at_nodes),
        }
    }

    /// The body through the points of an outline, with the factors of its heights at the stations, turned by
    /// an angle (rad) about its centre.
    pub fn close(
        &self,
        time: f64,
        points: &[[Dual64; 2]],
        narrowing: &[Dual64],
        angle: Dual64,
    ) -> Result<Closed, GaitError> {
        match self {
            Self::Plane { knots, area, rule } => {
                let plane = Plane { time, knots, area: *area, rule };
                plane.close(points, angle)
            }
            Self::Space { knots, heights, volume, .. } => {
                let heights = heights.iter().zip(narrowing);
                let heights: Vec<Dual64> = heights.map(|(height, by)| *by * *height).collect();
                let space = Space { time, knots, volume: *volume };
                space.close(points, heights, angle)
            }
        }
    }
}

/// Points turned about a centre by an angle (rad), which goes to the origin.
fn placed(points: &[[Dual64; 2]], center: &[Dual64; 2], angle: Dual64) -> Vec<[Dual64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let place = |point: &[Dual64; 2]| {
        let [x, y] = [0, 1].map(|i| point[i] - center[i]);
        [cos * x - sin * y, sin * x + cos * y]
    };
    points.iter().map(place).collect()
}

/// A hull in the plane at a time.
struct Plane<'a> {
    time: f64,
    knots: &'a [f64],
    area: f64,
    rule: &'a GaussRule,
}

impl Plane<'_> {
    fn close(&self, points: &[[Dual64; 2]], angle: Dual64) -> Result<Closed, GaitError> {
        let Self { time, knots, .. } = *self;
        let Kept { points, normal_speed } = self.keep_area(points)?;
        let through = |points: &[[Dual64; 2]]| {
            ClosedCurve::through(points, knots).ok_or(GaitError::NoOffset { time })
        };
        let enclosed = through(&points)?.enclosed(self.rule);
        let closed = through(&placed(&points, &enclosed.center, angle))?;
        let mean_normal_speed = closed.mean_normal_speed();
        Ok(Closed {
            curve: MaterialCurve::Spline { points: Arc::new(closed.points), rates: closed.rates },
            moments: Moments {
                measure: enclosed.area.re,
                centroid: Point::<2>::zeros(),
                second: SecondMoments::Planar { polar: enclosed.polar.re },
            },
            inertia_rate: enclosed.polar.eps,
            center: enclosed.center,
            normal_speed,
            mean_normal_speed,
        })
    }

    /// The points, moved along the normals of their curve by the same offset, so that it encloses
    /// the area at rest.
    fn keep_area(&self, raw: &[[Dual64; 2]]) -> Result<Kept, GaitError> {
        let Self { time, knots, area: at_rest, rule } = *self;
        let curve = ClosedCurve::through(raw, knots).ok_or(GaitError::Midline { time })?;
        let normals = curve.normals();
        let widening = ClosedCurve::through(&normals, knots).ok_or(GaitError::Midline { time })?;
        // area + first offset + second offset² = area at rest
        let [area, first, second] = curve.area_along(rule, &widening);
        let missing = -area + at_rest;
        let root = (first * first + second * missing * 4.0).sqrt();
        let offset = missing * 2.0 / (first + root);
        let points = raw
            .iter()
            .zip(&normals)
            .map(|(point, normal)| [0, 1].map(|i| point[i] + normal[i] * offset))
            .collect();
        Ok(Kept { points, normal_speed: offset.eps })
    }
}

/// A hull in space at a time.
struct Space<'a> {
    time: f64,
    knots: &'a [f64],
    volume: f64,
}

impl Space<'_> {
    /// The volume is linear in the heights: a factor of all of them keeps it.
    fn close(
        &self,
        points: &[[Dual64; 2]],
        mut heights: Vec<Dual64>,
        angle: Dual64,
    ) -> Result<Closed, GaitError> {
        let Self { time, knots, .. } = *self;
        let through = |points: &[[Dual64; 2]], heights: &[Dual64]| {
            ClosedSurface::through(points, heights, knots).ok_or(GaitError::Midline { time })
        };
        let raw = through(points, &heights)?.enclosed();
        let factor = raw.volume.recip() * self.volume;
        for height in &mut heights {
            *height *= factor;
        }
        let closed = through(&placed(points, &raw.center, angle), &heights)?;
        let EnclosedVolume { volume, second: [xx, xy, yy, zz], .. } = closed.enclosed();
        let tensor = Matrix3::new(
            yy.re + zz.re,
            -xy.re,
            0.0,
            -xy.re,
            xx.re + zz.re,
            0.0,
            0.0,
            0.0,
            xx.re + yy.re,
        );
        let mean_normal_speed = closed.mean_normal_speed();
        let normal_speed = factor.eps * mean_height(&heights);
        Ok(Closed {
            curve: MaterialCurve::Sections {
                surface: Arc::new(Slender::new(closed.places)),
                rates: closed.rates,
            },
            moments: Moments {
                measure: volume.re,
                centroid: Point::<2>::zeros(),
                second: SecondMoments::Spatial { tensor },
            },
            inertia_rate: (xx + yy).eps,
            center: raw.center,
            normal_speed,
            mean_normal_speed,
        })
    }
}

fn mean_height(heights: &[Dual64]) -> f64 {
    heights.iter().map(|height| height.re).sum::<f64>() / heights.len() as f64
}

impl MaterialCurve {
    /// The closed curve of the outline, in space that in the plane of the midline.
    pub(super) fn outline(&self) -> Option<Spline> {
        match self {
            Self::Spline { points, .. } | Self::Carried { points, .. } => {
                Some(points.as_ref().clone())
            }
            Self::Sections { surface, .. } => {
                let sections = surface.sections();
                let (knots, end) = (sections.knots(), sections.end());
                let n = knots.len() - 1;
                let back = knots[1..n].iter().rev().map(|knot| 2.0 * end - knot);
                let all: Vec<f64> = knots.iter().copied().chain(back).collect();
                let point = |parameter: &f64| {
                    let at = sections.point(on_outline(sections, *parameter));
                    [at.x, at.y]
                };
                let points: Vec<[f64; 2]> = all.iter().map(point).collect();
                let mut knots = all;
                knots.push(2.0 * end);
                Spline::with_knots(&points, &knots)
            }
            Self::CarriedSections { .. } | Self::Round { .. } => None,
        }
    }
}
