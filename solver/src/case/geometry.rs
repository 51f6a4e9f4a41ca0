//! What a case asks of the mesh: its domain, with named sides, and its bodies' outlines.

use alewife_mesh::{Domain, PlacedShape, Point, Shape};

use super::{
    Body, BoundaryCondition, Case, DomainSpec, Geometry, Lock, Motion, ShapeSpec, TimeSettings,
};

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
            Self::Sphere { .. } => "sphere",
            Self::Spheroid { .. } => "spheroid",
        }
    }

    /// The outline to be meshed.
    #[must_use]
    pub fn outline(&self) -> Shape {
        match self.clone() {
            Self::Disc { radius } => Shape::Disc { radius },
            Self::Ellipse { semi_axes } => Shape::Ellipse { semi_axes },
            Self::Spline { points } => Shape::Spline { points },
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
            Self::Spline { points } => (0..points.len())
                .map(|i| {
                    let ([ax, ay], [bx, by]) = (points[i], points[(i + 1) % points.len()]);
                    (bx - ax).hypot(by - ay)
                })
                .sum(),
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
            Self::Spline { points } => points.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
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
    /// Whether the body may change its place.
    #[must_use]
    pub fn translates(&self) -> bool {
        match &self.motion {
            Motion::Held => false,
            Motion::Free => ![Lock::X, Lock::Y].iter().all(|lock| self.locked.contains(lock)),
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

    /// Whether the body looks the same however it is turned in the plane.
    #[must_use]
    pub fn is_round(&self) -> bool {
        matches!(self.shape, ShapeSpec::Disc { .. } | ShapeSpec::Sphere { .. })
    }
}

impl Case {
    /// Whether a march in time deforms the mesh: a body moves as seen from the frame, or turns
    /// and looks different then.
    #[must_use]
    pub fn mesh_moves(&self) -> bool {
        let is_frame = |body: &Body| self.frame.as_deref() == Some(body.name.as_str());
        let frame_moves = self.body.iter().any(|body| is_frame(body) && body.translates());
        let moves = |body: &Body| {
            let travels = !is_frame(body) && (body.translates() || frame_moves);
            let turns = self.geometry == Geometry::Planar && body.turns() && !body.is_round();
            travels || turns
        };
        matches!(self.time, TimeSettings::Unsteady(_)) && self.body.iter().any(moves)
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
