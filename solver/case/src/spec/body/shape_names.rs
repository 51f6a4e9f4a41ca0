//! Names of shapes, and the geometries in which they can stand.

use crate::{Geometry, ShapeSpec};

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
            Self::Ellipsoid { .. } => "ellipsoid",
            Self::Capsule { .. } => "capsule",
            Self::Cylinder { .. } => "cylinder",
            Self::Helix(_) => "helix",
            Self::Curve(_) => "curve",
            Self::Revolved { .. } => "revolved",
            Self::Union(_) => "union",
        }
    }

    /// Geometries in which the shape can stand.
    #[must_use]
    pub fn geometries(&self) -> &'static [Geometry] {
        match self {
            Self::Disc { .. } | Self::Ellipse { .. } | Self::Spline { .. } | Self::Tube(_) => {
                &[Geometry::Planar]
            }
            Self::Fish(_) | Self::Flagellate(_) => &[Geometry::Planar, Geometry::Spatial],
            Self::Sphere { .. } | Self::Spheroid { .. } => {
                &[Geometry::Axisymmetric, Geometry::Spatial]
            }
            Self::Ellipsoid { .. }
            | Self::Capsule { .. }
            | Self::Cylinder { .. }
            | Self::Helix(_)
            | Self::Curve(_)
            | Self::Revolved { .. }
            | Self::Union(_) => &[Geometry::Spatial],
        }
    }

    /// Names of the shapes that can stand in a geometry.
    #[must_use]
    pub fn names_in(geometry: Geometry) -> &'static [&'static str] {
        match geometry {
            Geometry::Planar => &["disc", "ellipse", "spline", "fish", "flagellate"],
            Geometry::Axisymmetric => &["sphere", "spheroid"],
            Geometry::Spatial => &[
                "sphere",
                "spheroid",
                "ellipsoid",
                "capsule",
                "cylinder",
                "helix",
                "curve",
                "revolved",
                "union",
                "fish",
                "flagellate",
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use serde::Deserialize;

    use super::*;
    use crate::text::source::Source;
    use crate::text::tree;

    #[test]
    fn names_are_listed_for_the_geometries_in_which_shapes_stand() {
        for text in [
            "disc.radius = 1.0",
            "ellipse.semi_axes = [1.0, 2.0]",
            "spline.points = []",
            "fish.length = 1.0",
            "flagellate = { head = [1.0, 1.0], tail_length = 1.0, thickness = 0.1 }",
            "sphere.radius = 1.0",
            "spheroid.semi_axes = [1.0, 2.0]",
            "ellipsoid.semi_axes = [1.0, 2.0, 3.0]",
            "capsule = { length = 1.0, radius = 0.1 }",
            "cylinder = { radius = 1.0, axis = \"x\" }",
            "helix = { radius = 1.0, pitch = 1.0, turns = 1.0, tube_radius = 0.1 }",
            "curve = { points = [], tube_radius = 0.1 }",
            "revolved.profile = []",
            "union = []",
        ] {
            let source = Source { name: String::new(), directory: None, text: text.to_owned() };
            let shape = ShapeSpec::deserialize(&tree::parse(&Arc::new(source)).unwrap()).unwrap();
            for geometry in [Geometry::Planar, Geometry::Axisymmetric, Geometry::Spatial] {
                let is_listed = ShapeSpec::names_in(geometry).contains(&shape.name());
                assert_eq!(is_listed, shape.geometries().contains(&geometry), "{text}");
            }
        }
    }
}
