//! Shapes and bodies of a case: names, lengths, outlines, and how they move.

use std::sync::Arc;

use alewife_mesh::spatial::{SectionHeight, Sections};
use alewife_mesh::{FishForm, FlagellateForm, PlacedShape, Point, Profile, Shape, Spline};

use crate::spec::body::given::polygon::box_corners;
use crate::spec::body::motion::by_axis::Settled;
use crate::spec::body::solid_shape;
use crate::spec::body::solid_shape::Measures;
use crate::{Body, Case, FishShape, GaitSpec, Geometry, Lock, Motion, ShapeSpec};

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
            Self::Polygon(_) | Self::Box { .. } => Shape::Polygon { points: self.points() },
            Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
                let spline = self.profile().and_then(|profile| profile.spline());
                // `check` refuses lengths that make no body
                let no_body = Shape::Spline { points: Vec::new() };
                spline.map_or(no_body, |spline| Shape::Curve { spline: Arc::new(spline) })
            }
            Self::Sphere { radius } => Shape::Sphere { radius },
            Self::Spheroid { semi_axes } => Shape::Spheroid { semi_axes },
            // Shapes in space have none
            Self::Ellipsoid { .. }
            | Self::Capsule { .. }
            | Self::Cylinder { .. }
            | Self::Helix(_)
            | Self::Curve(_)
            | Self::Revolved { .. }
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
        match self {
            Self::Disc { radius } => 2.0 * PI * radius,
            Self::Ellipse { semi_axes } => ellipse(*semi_axes),
            Self::Spline { .. }
            | Self::Polygon(_)
            | Self::Box { .. }
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
            | Self::Fish(_)
            | Self::Flagellate(_)
            | Self::Tube(_) => self.points().iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
        }
    }

    /// Half of the least width (m): a radius, the shorter semi-axis; of a spline to a few per cent.
    #[must_use]
    pub fn half_width(&self) -> f64 {
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

impl Body {
    /// Whether the body may translate.
    #[must_use]
    pub fn translates(&self, geometry: Geometry) -> bool {
        let is_translation = |motion: &&Lock| **motion != Lock::Rotation;
        let mut translations = geometry.motions().iter().filter(is_translation);
        match &self.motion {
            Motion::Held => false,
            Motion::Free => {
                let is_driven = self.driven.iter().any(|driven| driven.motion != Lock::Rotation);
                is_driven || translations.any(|motion| !self.locked.contains(motion))
            }
            Motion::ByAxis(_) => true,
            Motion::Imposed(imposed) => imposed.velocity.iter().any(|part| *part != 0.0),
        }
    }

    /// Whether the body may turn.
    #[must_use]
    pub fn turns(&self) -> bool {
        match &self.motion {
            Motion::Held => false,
            Motion::Free => !self.locked.contains(&Lock::Rotation) || self.drives(Lock::Rotation),
            Motion::ByAxis(_) => true,
            Motion::Imposed(imposed) => !imposed.angular_velocity.is_zero(),
        }
    }

    /// Has motions by axis be those of a free body that are locked, or locked and driven.
    pub(crate) fn settle_motion(&mut self) {
        let Motion::ByAxis(motions) = &self.motion else { return };
        let Settled { moves, locked, driven } = motions.settled();
        self.motion = if moves { Motion::Free } else { Motion::Held };
        self.locked = if moves { locked } else { Vec::new() };
        self.driven = driven;
    }

    /// Whether the rate of a motion is given while others may be free.
    #[must_use]
    pub fn drives(&self, motion: Lock) -> bool {
        self.driven.iter().any(|driven| driven.motion == motion)
    }

    /// Whether its outline changes in time.
    #[must_use]
    pub fn deforms(&self) -> bool {
        if self.rod.is_some() {
            return true;
        }
        match self.gait {
            None | Some(GaitSpec::Squirmer(_)) => false,
            Some(
                GaitSpec::Carangiform(_)
                | GaitSpec::Anguilliform(_)
                | GaitSpec::Flagellum(_)
                | GaitSpec::Pulsating(_)
                | GaitSpec::Joints(_),
            ) => true,
        }
    }

    /// Whether the body looks the same however it turns about its centre of mass.
    #[must_use]
    pub fn is_round(&self) -> bool {
        let is_centred = self.center_of_mass.iter().all(|part| *part == 0.0);
        is_centred && matches!(self.shape, ShapeSpec::Disc { .. } | ShapeSpec::Sphere { .. })
    }

    /// Its mass (kg; kg/m planar) in a case, by the volume of its shape (m3; m2 planar) where none is given.
    pub(crate) fn mass_in(&self, case: &Case) -> f64 {
        let density = self.density.unwrap_or(case.fluid.density);
        self.mass.unwrap_or_else(|| density * self.shape.volume_in(case.geometry))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Case;

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

    #[test]
    fn a_body_on_the_axis_locked_along_it_stays() {
        let text = "
title = 't'
geometry = 'axisymmetric'
fluid = { model = 'stokes', viscosity = 1.0 }
domain = { half-disc = { radius = 4.0 } }
mesh = { size = 0.2 }
time = { unsteady = { step = 0.1, end = 1.0 } }
body = [{ name = 'b', shape = { sphere = { radius = 1.0 } }, center = [0, 0], motion = 'free' }]
";
        let moves = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
            let model = Case::parse("t.toml", text, &settings).unwrap().model;
            let is_carried = model.case.frame.is_some();
            assert_eq!(
                model.mesh_moves(),
                model.bodies[0].translates(model.case.geometry) && !is_carried
            );
            model.mesh_moves()
        };
        assert!(moves(&[]));
        assert!(moves(&["body.0.locked=['y']"]));
        assert!(!moves(&["body.0.locked=['x']"]));
        assert!(!moves(&["frame=b"]));
    }
}
