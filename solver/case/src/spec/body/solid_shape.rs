//! Lengths, areas and volumes of shapes in space made of curves, profiles and parts.

use std::f64::consts::{PI, TAU};

use alewife_mesh::spatial::{SpaceSpline, Triangulated};

use super::given::surface::SurfaceShape;
use super::{CurveShape, HelixShape, PartSpec, ShapeSpec};

/// Lengths of a solid, its surface and its volume, estimates where parts overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measures {
    /// Length of the meridian, of a tube from end to end (m).
    pub length: f64,
    /// Area of the surface (m2).
    pub area: f64,
    /// Volume (m3).
    pub volume: f64,
    /// Radius of a ball about the origin that holds it (m).
    pub reach: f64,
    /// Half of the least width (m).
    pub half_width: f64,
}

impl HelixShape {
    /// Length of the midline (m).
    fn midline(&self) -> f64 {
        self.turns.abs() * self.pitch.hypot(TAU * self.radius)
    }

    pub(crate) fn measures(&self) -> Measures {
        tube(self.midline(), self.radius.hypot(self.turns * self.pitch), self.tube_radius)
    }
}

impl CurveShape {
    /// The curve; `None` where points make none.
    pub(crate) fn spline(&self) -> Option<SpaceSpline> {
        SpaceSpline::new(self.points.iter().copied().map(Into::into).collect())
    }

    pub(crate) fn measures(&self) -> Option<Measures> {
        let spline = self.spline()?;
        Some(tube(spline.length(), spline.reach(), self.tube_radius))
    }
}

impl SurfaceShape {
    pub(crate) fn measures(&self) -> Option<Measures> {
        self.solid().map(|solid| triangulated(solid))
    }
}

/// Measures of a solid given by the triangles of its surface.
pub(crate) fn triangulated(solid: &Triangulated) -> Measures {
    let extent = solid.triangles().extent();
    Measures {
        length: 0.5 * PI * extent,
        area: solid.area(),
        volume: solid.moments().volume,
        reach: solid.reach(),
        half_width: solid.inner_radius(),
    }
}

/// Measures of a tube along a midline of a length and reach (m), with round ends.
fn tube(midline: f64, reach: f64, radius: f64) -> Measures {
    Measures {
        length: midline + PI * radius,
        area: TAU * radius * (midline + 2.0 * radius),
        volume: PI * radius * radius * (midline + 4.0 / 3.0 * radius),
        reach: reach + radius,
        half_width: radius,
    }
}

/// Measures of a profile of points (x, distance from the axis) turned about the x axis, by straight lines
/// between them.
pub(crate) fn revolved(profile: &[[f64; 2]]) -> Measures {
    let (mut length, mut area, mut volume) = (0.0, 0.0, 0.0);
    for pair in profile.windows(2) {
        let [[x, r], [next_x, next_r]] = [pair[0], pair[1]];
        let along = (next_x - x).hypot(next_r - r);
        length += along;
        area += PI * (r + next_r) * along;
        volume += PI / 3.0 * (next_x - x) * (r * r + r * next_r + next_r * next_r);
    }
    let most =
        |part: fn(&[f64; 2]) -> f64| profile.iter().map(part).fold(f64::NEG_INFINITY, f64::max);
    let extent = most(|[x, _]| *x) + most(|[x, _]| -x);
    Measures {
        length,
        area,
        volume: volume.abs(),
        reach: most(|[x, r]| x.hypot(*r)),
        half_width: most(|[_, r]| *r).min(0.5 * extent),
    }
}

/// Measures of a union: sums of those of its parts, overlaps included.
pub(crate) fn union(parts: &[PartSpec]) -> Measures {
    let of = |measure: fn(&ShapeSpec) -> f64| parts.iter().map(move |part| measure(&part.shape));
    let reach = |part: &PartSpec| {
        let [x, y, z] = part.center;
        x.hypot(y).hypot(z) + part.shape.reach()
    };
    Measures {
        length: of(ShapeSpec::perimeter).fold(0.0, f64::max),
        area: of(ShapeSpec::surface_area).sum(),
        volume: of(ShapeSpec::volume).sum(),
        reach: parts.iter().map(reach).fold(0.0, f64::max),
        half_width: of(ShapeSpec::half_width).fold(f64::INFINITY, f64::min),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_are_those_of_known_solids() {
        // A ring almost closed: the torus of Pappus
        let torus = HelixShape { radius: 1.0, pitch: 1e-9, turns: 1.0, tube_radius: 0.1 };
        let ends = 4.0 / 3.0 * PI * 1e-3;
        assert!((torus.measures().volume - 2.0 * PI * PI * 0.01 - ends).abs() < 1e-9);
        let on = |i: u32| PI * f64::from(i) / 400.0;
        let sphere: Vec<[f64; 2]> = (0..=400).map(|i| [-on(i).cos(), on(i).sin()]).collect();
        let sphere = revolved(&sphere);
        for (own, exact) in [
            (sphere.volume, 4.0 / 3.0 * PI),
            (sphere.area, 4.0 * PI),
            (sphere.length, PI),
            (sphere.reach, 1.0),
            (sphere.half_width, 1.0),
        ] {
            assert!((own / exact - 1.0).abs() < 1e-4, "{own} {exact}");
        }
        let part = |radius, x| PartSpec {
            shape: ShapeSpec::Sphere { radius },
            center: [x, 0.0, 0.0],
            orientation: None,
        };
        let two = union(&[part(1.0, 0.0), part(0.5, 3.0)]);
        assert_eq!([two.reach, two.half_width], [3.5, 0.5]);
        assert!((two.volume - 4.5 / 3.0 * PI).abs() < 1e-12);
    }
}
