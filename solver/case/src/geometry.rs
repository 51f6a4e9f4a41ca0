//! What a case asks of the mesh: its domain, with named sides, and its bodies' outlines.

use std::sync::Arc;

use alewife_mesh::{Domain, FishForm, FlagellateForm, PlacedShape, Point, Profile, Shape, Spline};

use super::{Body, BoundaryCondition, Case, DomainSpec, GaitSpec, Lock, Motion, ShapeSpec};

/// Directions in which the width of a spline is measured.
const DIRECTIONS: u32 = 90;

impl DomainSpec {
    /// Names of the sides.
    #[must_use]
    pub fn sides(&self) -> &'static [&'static str] {
        match self {
            Self::Box { .. } | Self::Channel { .. } => &["left", "right", "bottom", "top"],
            Self::Disc { .. } => &["wall"],
            Self::HalfDisc { .. } => &["wall", "axis"],
            Self::Cylinder { .. } => &["left", "right", "wall", "axis"],
        }
    }

    /// Whether it is the half plane of an axisymmetric problem.
    #[must_use]
    pub fn is_axisymmetric(&self) -> bool {
        matches!(self, Self::HalfDisc { .. } | Self::Cylinder { .. })
    }

    /// Lower left and upper right corner of the smallest rectangle around it (m).
    #[must_use]
    pub fn extent(&self) -> [[f64; 2]; 2] {
        match *self {
            Self::Box { min, max } => [min, max],
            Self::Channel { length, height } => [[0.0, 0.0], [length, height]],
            Self::Disc { center: [x, y], radius } => {
                [[x - radius, y - radius], [x + radius, y + radius]]
            }
            Self::HalfDisc { center, radius } => {
                [[center - radius, 0.0], [center + radius, radius]]
            }
            Self::Cylinder { x, radius } => [[x[0], 0.0], [x[1], radius]],
        }
    }
}

/// The side a periodic side can be paired with.
#[must_use]
pub fn opposite(side: &str) -> Option<&'static str> {
    match side {
        "left" => Some("right"),
        "right" => Some("left"),
        "bottom" => Some("top"),
        "top" => Some("bottom"),
        _ => None,
    }
}

impl ShapeSpec {
    /// Name in the case file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Disc { .. } => "disc",
            Self::Ellipse { .. } => "ellipse",
            Self::Spline { .. } => "spline",
            Self::Fish(_) => "fish",
            Self::Flagellate(_) => "flagellate",
            Self::Tube(_) => "tube",
            Self::Sphere { .. } => "sphere",
            Self::Spheroid { .. } => "spheroid",
        }
    }

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

    /// Points of a spline or a slender body in the body frame (m); none of other shapes.
    #[must_use]
    pub fn points(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Spline { points } => points.clone(),
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
            Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
                let spline = self.profile().and_then(|profile| profile.spline());
                // `check` refuses lengths that make no body
                let no_body = Shape::Spline { points: Vec::new() };
                spline.map_or(no_body, |spline| Shape::Curve { spline: Arc::new(spline) })
            }
            Self::Sphere { radius } => Shape::Sphere { radius },
            Self::Spheroid { semi_axes } => Shape::Spheroid { semi_axes },
        }
    }

    /// Length of the outline, or of its meridian in axisymmetric cases (m), to a few per cent.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        use std::f64::consts::PI;
        // Ramanujan's first formula for the perimeter of an ellipse.
        let ellipse =
            |[a, b]: [f64; 2]| PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt());
        match self {
            Self::Disc { radius } => 2.0 * PI * radius,
            Self::Ellipse { semi_axes } => ellipse(*semi_axes),
            Self::Spline { .. } | Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
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
        }
    }

    /// Radius of the circle about the shape's origin that holds the shape (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self {
            Self::Disc { radius } | Self::Sphere { radius } => *radius,
            Self::Ellipse { semi_axes: [a, b] } | Self::Spheroid { semi_axes: [a, b] } => a.max(*b),
            Self::Spline { .. } | Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
                self.points().iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max)
            }
        }
    }

    /// Half of the least width (m): a radius, the shorter semi-axis; of a spline to a few per cent.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        match self {
            Self::Disc { radius } | Self::Sphere { radius } => *radius,
            Self::Ellipse { semi_axes: [a, b] } | Self::Spheroid { semi_axes: [a, b] } => a.min(*b),
            Self::Spline { .. } | Self::Fish(_) | Self::Flagellate(_) | Self::Tube(_) => {
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
    /// The body as the mesh sees it; its centre must have two numbers, which `check` makes sure.
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
    pub fn translates(&self) -> bool {
        match &self.motion {
            Motion::Held => false,
            Motion::Free => {
                let is_on_axis =
                    matches!(self.shape, ShapeSpec::Sphere { .. } | ShapeSpec::Spheroid { .. });
                let is_free = |lock: Lock| !self.locked.contains(&lock);
                is_free(Lock::X) || (!is_on_axis && is_free(Lock::Y))
            }
            Motion::Imposed(imposed) => imposed.velocity.iter().any(|part| *part != 0.0),
        }
    }

    /// Whether the body may turn.
    #[must_use]
    pub fn turns(&self) -> bool {
        match &self.motion {
            Motion::Held => false,
            Motion::Free => !self.locked.contains(&Lock::Rotation),
            Motion::Imposed(imposed) => imposed.angular_velocity != 0.0,
        }
    }

    /// Whether its outline changes in time.
    #[must_use]
    pub fn deforms(&self) -> bool {
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

    /// Whether the body looks the same however it is turned in the plane.
    #[must_use]
    pub fn is_round(&self) -> bool {
        matches!(self.shape, ShapeSpec::Disc { .. } | ShapeSpec::Sphere { .. })
    }
}

impl Case {
    /// Along which coordinates the domain is periodic.
    #[must_use]
    pub fn periodic_axes(&self) -> [bool; 3] {
        let is_periodic =
            |side: &str| matches!(self.boundary.get(side), Some(BoundaryCondition::Periodic(_)));
        [is_periodic("left"), is_periodic("bottom"), false]
    }

    /// Whether a side of the domain waves.
    #[must_use]
    pub fn has_waving_sheet(&self) -> bool {
        self.boundary.values().any(|side| matches!(side, BoundaryCondition::WavingSheet { .. }))
    }

    /// Whether force and moment coefficients are defined: 2 F / (density velocity^2 area).
    #[must_use]
    pub fn has_coefficients(&self) -> bool {
        self.scales.is_some() && self.fluid.density > 0.0
    }

    /// The domain to be meshed, with its periodic pairs.
    #[must_use]
    pub fn mesh_domain(&self) -> Domain {
        let is_periodic =
            |side: &str| matches!(self.boundary.get(side), Some(BoundaryCondition::Periodic(_)));
        let (periodic_x, periodic_y) = (
            is_periodic("left") || is_periodic("right"),
            is_periodic("bottom") || is_periodic("top"),
        );
        match self.domain {
            DomainSpec::Box { .. } | DomainSpec::Channel { .. } => {
                let [min, max] = self.domain.extent();
                Domain::Box { min: min.into(), max: max.into(), periodic_x, periodic_y }
            }
            DomainSpec::Disc { center, radius } => Domain::Disc { center: center.into(), radius },
            DomainSpec::HalfDisc { center, radius } => Domain::HalfDisc { center, radius },
            DomainSpec::Cylinder { x, radius } => Domain::Cylinder { x, radius, periodic_x },
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
            assert_eq!(model.mesh_moves(), model.bodies[0].translates() && !is_carried);
            model.mesh_moves()
        };
        assert!(moves(&[]));
        assert!(moves(&["body.0.locked=['y']"]));
        assert!(!moves(&["body.0.locked=['x']"]));
        assert!(!moves(&["frame=b"]));
    }
}
