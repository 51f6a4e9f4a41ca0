//! Names of shapes, and the gaits by which they move.

use crate::{GaitSpec, ShapeSpec};

impl ShapeSpec {
    /// Name in the case file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Disc { .. } => "disc",
            Self::Ellipse { .. } => "ellipse",
            Self::Spline { .. } => "spline",
            Self::Polygon(_) => "polygon",
            Self::Box { .. } => "box",
            Self::Side(_) => "side",
            Self::Fish(_) => "fish",
            Self::Flagellate(_) => "flagellate",
            Self::Tube(_) => "tube",
            Self::Sphere { .. } => "sphere",
            Self::Spheroid { .. } => "spheroid",
            Self::Ellipsoid { .. } => "ellipsoid",
            Self::Capsule { .. } => "capsule",
            Self::Cylinder { .. } => "cylinder",
            Self::Helix(_) => "helix",
            Self::Curve(_) => "curve",
            Self::Revolved { .. } => "revolved",
            Self::Surface(_) => "surface",
            Self::Union(_) => "union",
        }
    }
}

impl GaitSpec {
    /// Names of the shapes that can move so.
    #[must_use]
    pub fn shapes(&self) -> &'static [&'static str] {
        match self {
            Self::Squirmer(_) | Self::Pulsating(_) => &["disc", "sphere"],
            // Smooth ones: at an edge no direction but one is along the surface
            Self::Slip(_) => &[
                "disc",
                "ellipse",
                "spline",
                "fish",
                "flagellate",
                "sphere",
                "spheroid",
                "ellipsoid",
                "capsule",
                "cylinder",
                "helix",
                "curve",
                "revolved",
                "surface",
            ],
            Self::Carangiform(_) | Self::Anguilliform(_) => &["fish"],
            Self::Flagellum(_) => &["flagellate"],
            Self::Midline(_) => &["fish", "flagellate"],
            Self::Joints(_) => &["tube"],
        }
    }
}
