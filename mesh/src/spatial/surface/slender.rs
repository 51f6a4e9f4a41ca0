//! `Slender`: the surface of elliptic sections about a midline; its nearest points by Newton's method.

use std::fmt;

use nalgebra::{Matrix2, Vector2};

use super::ring::{Ring, ring_corners};
use super::{Foot, SizedGap};
use crate::spatial::sections::{
    Section, SectionPoint, Sections, along_section, on_section, parts_of,
};
use crate::{Bounds, BoxTree, Point};

/// Part of a box by which it is enlarged, as its surface bends out between the places that are looked at.
const MARGIN: f64 = 0.1;

/// Steps of Newton's method.
const MOST_STEPS: usize = 60;

/// Halvings of a step.
const MOST_HALVINGS: usize = 30;

/// Offset along the surface from the nearest point over the lengths involved that is rounding.
const ROUNDING: f64 = 4e-16;

/// The same over the distance and the width of the section there, where gaps and radii need not be exact: it
/// makes gaps wrong by half its square.
const ROUGH: f64 = 1e-4;

/// Change of the squared distance over itself below which rounding decides whether a step helps.
const FLAT: f64 = 1e-10;

/// Least distance from the ends over the whole parameter, so that a section has a direction.
const OFF_ENDS: f64 = 1e-9;

/// Part of the slope of the width at an end down to which a place belongs to the end, where places are
/// given by plane coordinates about it.
const CAP: f64 = 0.7;

/// A body of elliptic sections.
#[derive(Clone)]
pub struct Slender {
    sections: Sections,
    /// In the middle of each piece.
    rings: Vec<Ring>,
    boxes: BoxTree<3>,
    /// Parameters up to which the ends go, from each end.
    caps: [f64; 2],
    reach: f64,
    inner_radius: f64,
}

impl fmt::Debug for Slender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Slender of {} sections", self.sections.knots().len())
    }
}

impl PartialEq for Slender {
    fn eq(&self, other: &Self) -> bool {
        self.sections == other.sections
    }
}

/// Half the squared distance near a place.
struct Quadratic {
    slope: Vector2<f64>,
    bend: Matrix2<f64>,
    /// Its second derivative on the surface itself: squares of lengths.
    metric: Matrix2<f64>,
}

/// A place of the surface with derivatives along and around.
struct Local {
    point: Point<3>,
    along: Point<3>,
    around: Point<3>,
    /// Second derivatives: along, mixed, around.
    second: [Point<3>; 3],
}

/// Coordinates near an end, where angles have no meaning: r and t are lengths along and around.
struct Chart {
    /// Distance from the end, or what makes an angle a length.
    radius: f64,
    /// 1 where it grows with the parameter, -1 where it falls, 0 away from the ends.
    sign: f64,
}

impl Slender {
    /// The surface of sections whose widths are positive between the ends.
    #[must_use]
    pub fn new(sections: Sections) -> Self {
        let knots = sections.knots();
        let (mut rings, mut boxes) = (Vec::new(), Vec::new());
        for pair in knots.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            rings.push(Ring::new(&sections, middle));
            let ends = [pair[0], middle, pair[1]].map(|along| sections.at(along)[0]);
            let points: Vec<Point<3>> = ends.iter().flat_map(ring_corners).collect();
            let bounds = Bounds::around(&points);
            let margin = Point::<3>::repeat(MARGIN * (bounds.max - bounds.min).max());
            boxes.push(Bounds { min: bounds.min - margin, max: bounds.max + margin });
        }
        let corners = boxes.iter().map(|one| one.min.abs().sup(&one.max.abs()).norm());
        let reach = corners.fold(0.0, f64::max);
        let end = sections.end();
        let slope = |along: f64| parts_of(&sections.at(along)[1])[1].norm();
        let cap = |from: f64, inner: &dyn Fn(usize) -> f64| {
            let whole = slope(from);
            let off = (1..=knots.len() / 2).map(|i| (inner(i) - from).abs());
            let ends = (1..=knots.len() / 2).map(|i| slope(inner(i)) < CAP * whole);
            off.zip(ends).find(|(_, ends)| *ends).map_or(0.25 * end, |(off, _)| off.min(0.25 * end))
        };
        let caps = [cap(0.0, &|i| knots[i]), cap(end, &|i| knots[knots.len() - 1 - i])];
        let inner_radius = [0.0, end].map(|along| {
            let [_, rate, second] = sections.at(along);
            let [bend, ..] = parts_of(&second).map(|part| part.norm());
            let [_, width, height] = parts_of(&rate).map(|part| part.norm());
            width.min(height).powi(2) / bend
        });
        let inner_radius = inner_radius[0].min(inner_radius[1]);
        let boxes = BoxTree::new(&boxes);
        Self { sections, rings, boxes, caps, reach, inner_radius }
    }

    /// The sections it is made of.
    #[must_use]
    pub fn sections(&self) -> &Sections {
        &self.sections
    }

    /// Radius of a ball about the origin that holds the surface (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Radius (m) of a ball that fits into the more pointed one of its ends.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        self.inner_radius
    }

    /// Places all over the surface (m).
    pub fn places(&self) -> impl Iterator<Item = Point<3>> + '_ {
        self.rings.iter().flat_map(|ring| ring_corners(&ring.section))
    }

    /// Places (m) about which it is farthest against a direction: on the sections that are farther than those beside them.
    #[must_use]
    pub fn farthest_against(&self, direction: Point<3>) -> Vec<Point<3>> {
        let all: Vec<_> = self.rings.iter().map(|ring| ring.lowest(&direction)).collect();
        let at = |nth: usize| all.get(nth).map_or(f64::INFINITY, |lowest| lowest.value);
        let is_least = |nth: usize| at(nth) < at(nth.wrapping_sub(1)) && at(nth) <= at(nth + 1);
        (0..all.len()).filter(|nth| is_least(*nth)).map(|nth| all[nth].place).collect()
    }

    /// The nearest point to a point (m) of its frame, the normal outward.
    #[must_use]
    pub fn foot(&self, of: Point<3>) -> Foot {
        self.foot_at(of, self.parameter_of(of))
    }

    fn foot_at(&self, of: Point<3>, at: SectionPoint) -> Foot {
        let local = self.local(at);
        let normal = local.normal();
        Foot { point: local.point, normal, gap: (of - local.point).dot(&normal) }
    }

    /// Whether a point (m) may be nearer to the surface than some distance (m), or inside: at little cost.
    #[must_use]
    pub fn may_be_within(&self, of: Point<3>, distance: f64) -> bool {
        let mut may_be = false;
        self.boxes.visit_near(of, distance.max(0.0), |_, _| {
            may_be = true;
            true
        });
        may_be
    }

    /// The gap to a point (m), right to a millionth of the width of the section there or of itself.
    #[must_use]
    pub fn rough_gap(&self, of: Point<3>) -> f64 {
        self.foot_at(of, self.rough_parameter_of(of)).gap
    }

    /// The same with the smaller one of a part of the radius of curvature and of a part of the radius inside
    /// (m) where the surface is nearest.
    #[must_use]
    pub fn rough_sized_gap(&self, of: Point<3>, parts: [f64; 2]) -> SizedGap {
        let at = self.rough_parameter_of(of);
        SizedGap { gap: self.foot_at(of, at).gap, size: self.smaller_radius_at(at, parts) }
    }

    /// Distance of a point (m) near the surface over the smallest radius of curvature there.
    #[must_use]
    pub fn relative_distance(&self, of: Point<3>) -> f64 {
        let at = self.parameter_of(of);
        self.foot_at(of, at).gap.abs() / self.radius_of_curvature_at(at)
    }

    /// Coordinates of the point nearest to a point (m).
    #[must_use]
    pub fn parameter_of(&self, of: Point<3>) -> SectionPoint {
        self.descend(&of, self.nearest_on_rings(of), 0.0)
    }

    fn rough_parameter_of(&self, of: Point<3>) -> SectionPoint {
        self.descend(&of, self.nearest_on_rings(of), ROUGH)
    }

    /// The nearest place of all rings.
    fn nearest_on_rings(&self, of: Point<3>) -> SectionPoint {
        let (mut nearest, mut least, mut bound) = (0, f64::INFINITY, f64::INFINITY);
        self.boxes.visit_near(of, f64::INFINITY, |index, reach| {
            let ring = &self.rings[index];
            let most = bound + ring.reach;
            if (of - ring.center).norm_squared() > most * most {
                return false;
            }
            let square = ring.squared_distance(&of);
            if square < least {
                (nearest, least, bound) = (index, square, square.sqrt());
                *reach = bound;
            }
            false
        });
        let ring = &self.rings[nearest];
        SectionPoint { along: ring.along, around: ring.angle_of(&of) }
    }

    /// The place nearest to a point (m) that Newton's method finds from another place, up to an offset over the
    /// distance and the width of the section.
    fn descend(&self, of: &Point<3>, start: SectionPoint, rough: f64) -> SectionPoint {
        let mut at = start;
        let mut local = self.local(at);
        for _ in 0..MOST_STEPS {
            let off = local.point - of;
            let square = off.norm_squared();
            let chart = self.chart(at.along, &local);
            let Quadratic { slope, bend, metric } = chart.quadratic(&local, &off);
            let Some(down) = metric.cholesky().map(|metric| metric.solve(&-slope)) else { break };
            let offset = (-slope.dot(&down)).max(0.0).sqrt();
            let distance = square.sqrt();
            if offset <= ROUNDING * (distance + of.norm() + self.reach)
                || offset <= rough * (distance + local.around.norm())
            {
                break;
            }
            let newton = bend.cholesky().map(|bend| bend.solve(&-slope));
            let mut step = newton.unwrap_or(down);
            let is_flat = -slope.dot(&step) < FLAT * square;
            let mut is_better = false;
            for _ in 0..MOST_HALVINGS {
                let next = self.moved(at, &chart, &step);
                let there = self.local(next);
                if is_flat || (there.point - of).norm_squared() < square {
                    (at, local, is_better) = (next, there, true);
                    break;
                }
                step *= 0.5;
            }
            if !is_better {
                break;
            }
        }
        at
    }

    /// The coordinates in which steps from a place are made.
    fn chart(&self, along: f64, local: &Local) -> Chart {
        let from_end = self.sections.end() - along;
        if along < self.caps[0] {
            Chart { radius: along, sign: 1.0 }
        } else if from_end < self.caps[1] {
            Chart { radius: from_end, sign: -1.0 }
        } else {
            Chart { radius: local.around.norm(), sign: 0.0 }
        }
    }

    /// The place a step away.
    fn moved(&self, at: SectionPoint, chart: &Chart, step: &Vector2<f64>) -> SectionPoint {
        let end = self.sections.end();
        let (mut along, mut around) = (at.along, at.around);
        if chart.sign == 0.0 {
            along += step[0].clamp(-0.1 * end, 0.1 * end);
            around += (step[1] / chart.radius).clamp(-1.0, 1.0);
        } else {
            let ahead = chart.radius + step[0];
            around += step[1].atan2(ahead);
            let radius = ahead.hypot(step[1]).min(0.5 * end);
            along = if chart.sign > 0.0 { radius } else { end - radius };
        }
        SectionPoint { along: along.clamp(OFF_ENDS * end, (1.0 - OFF_ENDS) * end), around }
    }

    fn local(&self, at: SectionPoint) -> Local {
        let end = self.sections.end();
        let along = at.along.clamp(OFF_ENDS * end, (1.0 - OFF_ENDS) * end);
        let [value, rate, second] = self.sections.at(along);
        let on = |part: &Section| on_section(part, at.around);
        let turned = |part: &Section| along_section(part, at.around);
        let [middle, ..] = parts_of(&value);
        let point = on(&value);
        let second = [on(&second), turned(&rate), middle - point];
        Local { point, along: on(&rate), around: turned(&value), second }
    }

    /// Smallest radius of curvature (m) at one of its points.
    #[must_use]
    pub fn radius_of_curvature(&self, on: Point<3>) -> f64 {
        self.radius_of_curvature_at(self.parameter_of(on))
    }

    /// The smaller one of a part of the radius of curvature and of a part of the radius inside (m).
    #[must_use]
    pub fn smaller_radius(&self, on: Point<3>, parts: [f64; 2]) -> f64 {
        self.smaller_radius_at(self.parameter_of(on), parts)
    }

    fn smaller_radius_at(&self, at: SectionPoint, [of_curvature, inside]: [f64; 2]) -> f64 {
        (of_curvature * self.radius_of_curvature_at(at)).min(inside * self.radius_inside_at(at))
    }

    fn radius_of_curvature_at(&self, at: SectionPoint) -> f64 {
        let local = self.local(at);
        let chart = self.chart(at.along, &local);
        let normal = local.normal();
        // Along the normal the second derivative of half the squared distance is the metric less it
        let Quadratic { bend, metric, .. } = chart.quadratic(&local, &normal);
        let Some(root) = metric.cholesky().and_then(|metric| metric.l().try_inverse()) else {
            return self.inner_radius;
        };
        let curvature = root * (bend - metric) * root.transpose();
        // Its eigenvalues are the principal curvatures
        let mean = 0.5 * (curvature[(0, 0)] + curvature[(1, 1)]);
        let apart = (0.5 * (curvature[(0, 0)] - curvature[(1, 1)])).hypot(curvature[(0, 1)]);
        1.0 / (mean.abs() + apart)
    }

    /// About the radius (m) of the largest ball inside that touches the surface at one of its points: as far
    /// as the normal goes to the nearer one of the planes of the section's axes.
    #[must_use]
    pub fn radius_inside(&self, on: Point<3>) -> f64 {
        self.radius_inside_at(self.parameter_of(on))
    }

    fn radius_inside_at(&self, at: SectionPoint) -> f64 {
        let local = self.local(at);
        let normal = local.normal();
        let [section, ..] = self.sections.at(at.along);
        let (sin, cos) = at.around.sin_cos();
        let [_, width, height] = parts_of(&section);
        let way = |offset: f64, part: f64| {
            if part > 0.0 && offset > 0.0 { offset / part } else { f64::INFINITY }
        };
        let along = |axis: Point<3>, part: f64| {
            let half = axis.norm();
            way(half * part.abs(), (normal.dot(&axis) / half).abs())
        };
        along(width, cos).min(along(height, sin))
    }
}

impl Local {
    fn normal(&self) -> Point<3> {
        // Next to an end the derivative around is small, but has its direction
        self.along.cross(&self.around.normalize()).normalize()
    }
}

impl Chart {
    /// Half the squared distance to a point that the place is off by this (m).
    fn quadratic(&self, local: &Local, off: &Point<3>) -> Quadratic {
        let Self { radius, sign } = *self;
        let (ahead, facing) = if sign == 0.0 { (1.0, 0.0) } else { (sign, 1.0 / radius) };
        let along = local.along * ahead;
        let around = local.around / radius;
        let slope = Vector2::new(off.dot(&along), off.dot(&around));
        let [far, mixed, back] = [0, 1, 2].map(|i| off.dot(&local.second[i]));
        let mixed = ahead * mixed / radius - slope[1] * facing;
        let back = back / (radius * radius) + slope[0] * facing;
        let metric = Matrix2::new(
            along.norm_squared(),
            along.dot(&around),
            along.dot(&around),
            around.norm_squared(),
        );
        let bend = metric + Matrix2::new(far, mixed, mixed, back);
        Quadratic { slope, bend, metric }
    }
}
