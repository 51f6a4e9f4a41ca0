//! Shapes and bodies of a case: names, lengths and outlines.

use std::sync::Arc;

use alewife_mesh::spatial::{SectionHeight, Sections};
use alewife_mesh::{FishForm, FlagellateForm, PlacedShape, Point, Profile, Shape, Spline};

use crate::spec::body::given::polygon::box_corners;
use crate::spec::body::solid_shape;
use crate::spec::body::solid_shape::Measures;
use crate::{Body, EndLoadSpec, EndLoads, FishShape, Geometry, LoadedEnd, ShapeSpec};

/// Directions in which the width of a spline is measured.
const DIRECTIONS: u32 = 90;

impl ShapeSpec {
    /// Half width along the midline of a slender body; `None` for other shapes, and for
    /// lengths that make no body.
    #[must_use]
    pub fn profile(&self) -> Option<Profile> {
        match self {
            Self::Fish(fish) => Profile::fish(&FishForm {
                length: fish.length,
                head_width: fish.head_width,
                tail_width: fish.tail_width,
                head_end: fish.head_end,
                tail_start: fish.tail_start,
                tip_radius: fish.tip_radius,
                corner_radius: fish.corner_radius,
            }),
            Self::Flagellate(body) => Profile::flagellate(&FlagellateForm {
                head: body.head,
                tail_length: body.tail_length,
                thickness: body.thickness,
                fillet: body.fillet.unwrap_or(body.thickness),
            }),
            Self::Tube(tube) => tube.profile(),
            _ => None,
        }
    }

    /// How high the sections of a slender body are in space; `None` of other shapes.
    #[must_use]
    pub fn section_height(&self) -> Option<SectionHeight> {
        match self {
            Self::Fish(FishShape { height: Some(height), length, .. }) => {
                Some(SectionHeight::Ellipse { half_height: height * length })
            }
            Self::Fish(_) | Self::Flagellate(_) => Some(SectionHeight::Round),
            _ => None,
        }
    }

    /// The sections of a slender body in space at rest; `None` of other shapes, and for lengths that make
    /// no body.
    #[must_use]
    pub fn sections(&self) -> Option<Sections> {
        self.profile()?.sections(self.section_height()?)
    }

    /// Volume in a geometry, in the plane area (m3, m2).
    #[must_use]
    pub fn volume_in(&self, geometry: Geometry) -> f64 {
        if let (Self::Revolved { .. }, Geometry::Axisymmetric) = (self, geometry) {
            // That of the curve through its points, as it is meshed
            return self.outline().moments().map_or(0.0, |moments| moments.measure);
        }
        let sections = self.sections().filter(|_| geometry == Geometry::Spatial);
        sections.map_or_else(|| self.volume(), |sections| sections.moments().volume)
    }

    /// Points of a spline, a polygon, a box or a slender body in the body frame (m); none of other shapes.
    #[must_use]
    pub fn points(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Spline { points } => points.clone(),
            Self::Polygon(polygon) => polygon.corners(),
            Self::Box { size } => box_corners(*size),
            Self::Side(hole) => hole.points().to_vec(),
            Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
                let spline = self.profile().and_then(|profile| profile.spline());
                let points = |spline: Spline| -> Vec<[f64; 2]> {
                    let knots = &spline.knots()[1..];
                    knots.iter().map(|knot| spline.evaluate(*knot)[0].into()).collect()
                };
                spline.map_or(Vec::new(), points)
            }
            _ => Vec::new(),
        }
    }

    /// The outline to be meshed; of a body that deforms, at rest.
    #[must_use]
    pub fn outline(&self) -> Shape {
        match self.clone() {
            Self::Disc { radius } => Shape::Disc { radius },
            Self::Ellipse { semi_axes } => Shape::Ellipse { semi_axes },
            Self::Spline { points } => Shape::Spline { points },
            Self::Polygon(_) | Self::Box { .. } | Self::Side(_) => {
                Shape::Polygon { points: self.points() }
            }
            Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
                let spline = self.profile().and_then(|profile| profile.spline());
                // `check` refuses lengths that make no body
                let no_body = Shape::Spline { points: Vec::new() };
                spline.map_or(no_body, |spline| Shape::Curve { spline: Arc::new(spline) })
            }
            Self::Sphere { radius } => Shape::Sphere { radius },
            Self::Spheroid { semi_axes } => Shape::Spheroid { semi_axes },
            Self::Revolved { profile } => Shape::Revolved { profile },
            // Shapes in space have none
            Self::Ellipsoid { .. }
            | Self::Capsule { .. }
            | Self::Cylinder { .. }
            | Self::Helix(_)
            | Self::Curve(_)
            | Self::Surface(_)
            | Self::Union(_) => Shape::Spline { points: Vec::new() },
        }
    }

    /// Length of the outline, or of the meridian of a shape in space (m), to a few per cent.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        use std::f64::consts::PI;
        // Ramanujan's first formula for the perimeter of an ellipse.
        let ellipse =
            |[a, b]: [f64; 2]| PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt());
        if let (Self::Side(_), Some(measures)) = (self, self.measures()) {
            return measures.length;
        }
        match self {
            Self::Disc { radius } => 2.0 * PI * radius,
            Self::Ellipse { semi_axes } => ellipse(*semi_axes),
            Self::Spline { .. }
            | Self::Polygon(_)
            | Self::Box { .. }
            | Self::Side(_)
            | Self::Fish(_)
            | Self::Flagellate(_)
            | Self::Tube(_) => {
                let points = self.points();
                (0..points.len())
                    .map(|i| {
                        let ([ax, ay], [bx, by]) = (points[i], points[(i + 1) % points.len()]);
                        (bx - ax).hypot(by - ay)
                    })
                    .sum()
            }
            Self::Sphere { radius } => PI * radius,
            Self::Spheroid { semi_axes } => 0.5 * ellipse(*semi_axes),
            Self::Ellipsoid { semi_axes } => {
                let mut sorted = *semi_axes;
                sorted.sort_by(f64::total_cmp);
                0.5 * ellipse([sorted[2], sorted[1]])
            }
            Self::Capsule { length, radius } => length + (PI - 2.0) * radius,
            Self::Cylinder { length, .. } => *length,
            Self::Helix(_)
            | Self::Curve(_)
            | Self::Revolved { .. }
            | Self::Surface(_)
            | Self::Union(_) => self.measures().map_or(0.0, |measures| measures.length),
        }
    }

    /// Measures of a solid made of a curve, a profile, triangles or parts; `None` of other shapes.
    fn measures(&self) -> Option<Measures> {
        match self {
            Self::Helix(helix) => Some(helix.measures()),
            Self::Curve(curve) => curve.measures(),
            Self::Revolved { profile } => Some(solid_shape::revolved(profile)),
            Self::Surface(surface) => surface.measures(),
            Self::Side(hole) => hole.solid().map(|solid| solid_shape::triangulated(solid)),
            Self::Union(parts) => Some(solid_shape::union(parts)),
            _ => None,
        }
    }

    /// Semi-axes along the body's x, y and z of a sphere, a spheroid or an ellipsoid (m).
    #[must_use]
    pub fn semi_axes(&self) -> Option<[f64; 3]> {
        match self {
            Self::Sphere { radius } => Some([*radius; 3]),
            Self::Spheroid { semi_axes: [along, across] } => Some([*along, *across, *across]),
            Self::Ellipsoid { semi_axes } => Some(*semi_axes),
            _ => None,
        }
    }

    /// Volume, of planar shapes area (m3, m2); 0 of a shape that is none; of a union that of all parts.
    #[must_use]
    pub fn volume(&self) -> f64 {
        use std::f64::consts::PI;
        match self {
            Self::Ellipsoid { semi_axes: [a, b, c] } => 4.0 / 3.0 * PI * a * b * c,
            Self::Capsule { length, radius } => {
                PI * radius * radius * (length - 2.0 / 3.0 * radius)
            }
            Self::Cylinder { length, radius, .. } => PI * radius * radius * length,
            Self::Side(hole) if hole.moments().is_some() => {
                hole.moments().map_or(0.0, |moments| moments.measure)
            }
            _ => self.measures().map_or_else(
                || self.outline().moments().map_or(0.0, |moments| moments.measure),
                |measures| measures.volume,
            ),
        }
    }

    /// Area of the surface of a shape in space (m2), to two per cent; of planar ones zero.
    #[must_use]
    pub fn surface_area(&self) -> f64 {
        use std::f64::consts::PI;
        match (self, self.semi_axes()) {
            // Thomsen's formula for the area of an ellipsoid
            (_, Some([a, b, c])) => {
                let power = |x: f64| x.powf(1.6075);
                let mean = (power(a * b) + power(a * c) + power(b * c)) / 3.0;
                4.0 * PI * mean.powf(1.0 / 1.6075)
            }
            (Self::Capsule { length, radius } | Self::Cylinder { length, radius, .. }, None) => {
                2.0 * PI * radius * length
            }
            (Self::Fish(_) | Self::Flagellate(_), None) => {
                self.sections().map_or(0.0, |sections| sections.area())
            }
            (_, None) => self.measures().map_or(0.0, |measures| measures.area),
        }
    }

    /// Radius of the circle or sphere about the shape's origin that holds the shape (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        if let (Self::Side(_), Some(measures)) = (self, self.measures()) {
            return measures.reach;
        }
        match self {
            Self::Ellipsoid { semi_axes } => semi_axes.iter().copied().fold(0.0, f64::max),
            Self::Capsule { length, .. } => 0.5 * length,
            Self::Cylinder { length, radius, .. } => radius.hypot(0.5 * length),
            Self::Helix(_)
            | Self::Curve(_)
            | Self::Revolved { .. }
            | Self::Surface(_)
            | Self::Union(_) => self.measures().map_or(0.0, |measures| measures.reach),
            Self::Disc { radius } | Self::Sphere { radius } => *radius,
            Self::Ellipse { semi_axes: [a, b] } | Self::Spheroid { semi_axes: [a, b] } => a.max(*b),
            Self::Spline { .. }
            | Self::Polygon(_)
            | Self::Box { .. }
            | Self::Side(_)
            | Self::Fish(_)
            | Self::Flagellate(_)
            | Self::Tube(_) => self.points().iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
        }
    }

    /// Half of the least width (m): a radius, the shorter semi-axis; of a spline to a few per cent.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        if let (Self::Side(_), Some(measures)) = (self, self.measures()) {
            return measures.half_width;
        }
        match self {
            Self::Ellipsoid { semi_axes } => {
                semi_axes.iter().copied().fold(f64::INFINITY, f64::min)
            }
            Self::Capsule { radius, .. } | Self::Cylinder { radius, .. } => *radius,
            Self::Helix(_)
            | Self::Curve(_)
            | Self::Revolved { .. }
            | Self::Surface(_)
            | Self::Union(_) => self.measures().map_or(0.0, |measures| measures.half_width),
            Self::Disc { radius } | Self::Sphere { radius } => *radius,
            Self::Ellipse { semi_axes: [a, b] } | Self::Spheroid { semi_axes: [a, b] } => a.min(*b),
            Self::Spline { .. }
            | Self::Polygon(_)
            | Self::Box { .. }
            | Self::Side(_)
            | Self::Fish(_)
            | Self::Flagellate(_)
            | Self::Tube(_) => {
                let points = self.points();
                (0..DIRECTIONS)
                    .map(|i| std::f64::consts::PI * f64::from(i) / f64::from(DIRECTIONS))
                    .map(|angle| {
                        let along = |[x, y]: &[f64; 2]| x * angle.cos() + y * angle.sin();
                        let most = points.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
                        let least = points.iter().map(along).fold(f64::INFINITY, f64::min);
                        0.5 * (most - least)
                    })
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }
}

impl Body {
    /// The ends of a rod at which loads are given.
    pub fn end_loads(&self) -> impl Iterator<Item = LoadedEnd<&EndLoadSpec>> {
        let loads = self.rod.iter().filter_map(|rod| rod.load.as_ref());
        loads.flat_map(EndLoads::ends)
    }

    /// The body as a planar mesh sees it; its centre must have two numbers, which `check` makes sure.
    #[must_use]
    pub fn placed(&self, scale: f64) -> PlacedShape {
        let coordinate = |axis: usize| self.center.get(axis).copied().unwrap_or(f64::NAN);
        PlacedShape {
            name: self.name.clone(),
            shape: self.shape.outline(),
            center: Point::<2>::new(coordinate(0), coordinate(1)),
            angle: self.angle,
            size: self.size.map(|size| scale * size),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_width_is_that_across_the_thin_side() {
        let half_width = |shape: ShapeSpec| shape.half_width();
        assert_eq!(half_width(ShapeSpec::Sphere { radius: 0.4 }), 0.4);
        assert_eq!(half_width(ShapeSpec::Ellipse { semi_axes: [0.1, 0.3] }), 0.1);
        // A slender diamond, turned by 30 degrees and away from the origin
        let (sin, cos) = (0.5, 0.75_f64.sqrt());
        let points = [[1.0, 0.0], [0.0, 0.1], [-1.0, 0.0], [0.0, -0.1]]
            .map(|[x, y]: [f64; 2]| [3.0 + x * cos - y * sin, x * sin + y * cos]);
        let width = half_width(ShapeSpec::Spline { points: points.to_vec() });
        assert!((width - 0.1).abs() < 0.005, "{width}");
    }
}
