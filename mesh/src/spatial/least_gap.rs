//! The least gap of one surface to another, by steps to and fro between them.

use super::surface::SmoothSurface;
use crate::{Point, SMALLEST_GAP};

/// Places on a surface at which the search for the smallest gap starts.
pub const STARTS: usize = 48;

/// Steps of the search from each of them.
const FIRST_STEPS: usize = 3;

/// Places from which the search continues, those with the smallest gaps.
const KEPT: usize = 4;

/// Most steps from one of them.
const MOST_STEPS: usize = 200;

/// The least gap found between two surfaces (m), and where.
#[derive(Debug, Clone, Copy)]
pub struct Least {
    /// The gap.
    pub value: f64,
    /// Where, on the first surface.
    pub at: Point<3>,
}

impl Least {
    /// Whether it is too small for a mesh beside this surface.
    pub fn is_refused(&self, surface: &SmoothSurface) -> bool {
        self.value.is_nan() || self.value <= SMALLEST_GAP * surface.scale()
    }
}

/// Least gap of a surface to another one.
///
/// From places all around the surface: to the nearest point of the other one and back, again and
/// again. The distance never grows, so each ends where it is least.
///
/// A cylinder without ends goes along a plane, or through it.
pub fn least_gap(surface: &SmoothSurface, other: &SmoothSurface) -> Least {
    if surface.endless_axis().is_some() {
        let value = other.gap(surface.origin()) - surface.scale();
        let value = if surface.goes_through(other) { f64::NEG_INFINITY } else { value };
        return Least { value, at: surface.origin() };
    }
    if let Some(radius) = surface.radius_of_sphere() {
        let foot = other.foot(surface.origin());
        let at = surface.origin() - foot.normal * radius;
        return Least { value: foot.gap - radius, at };
    }
    let mut starts: Vec<Least> = surface
        .places(STARTS)
        .into_iter()
        .map(|at| approach(surface, other, Least { value: other.gap(at), at }, FIRST_STEPS))
        .collect();
    starts.sort_by(|a, b| a.value.total_cmp(&b.value));
    starts.truncate(KEPT);
    let ends = starts.into_iter().map(|start| approach(surface, other, start, MOST_STEPS));
    ends.min_by(|a, b| a.value.total_cmp(&b.value))
        .unwrap_or(Least { value: f64::NAN, at: surface.origin() })
}

/// Some steps from a point of a surface towards another surface.
///
/// Near a place where both touch the way to and fro gets ever shorter, so steps are stretched as long as
/// that helps.
fn approach(surface: &SmoothSurface, other: &SmoothSurface, start: Least, steps: usize) -> Least {
    let Least { mut value, mut at } = start;
    let mut stretch = 1.0;
    for _ in 0..steps {
        if value <= 0.0 {
            break;
        }
        let way = surface.foot(other.foot(at).point).point - at;
        let next = surface.foot(at + way * stretch).point;
        let shorter = other.gap(next);
        if shorter >= value * (1.0 - 1e-10) {
            if stretch == 1.0 {
                break;
            }
            stretch = 1.0;
            continue;
        }
        (at, value) = (next, shorter);
        stretch *= 2.0;
    }
    Least { value, at }
}
