//! `Link`: one link of a chain: the semi-axes of an ellipse, or a shape with a density of its own.

use std::fmt;

use alewife_mesh::{MeshError, Outline, PlacedShape, Point};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::ShapeSpec;
#[cfg(test)]
use crate::spec::number::{NonNegative, Positive};

/// A link of a chain, its body frame with x along the chain and the front towards +x.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Link {
    /// Semi-axes of an ellipse (m): along the chain, across.
    Ellipse(#[cfg_attr(test, schemars(with = "[Positive; 2]"))] [f64; 2]),
    /// Any planar shape.
    Shaped(ShapedLink),
}

/// A link that is no ellipse, not as dense as the others, or a magnet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ShapedLink {
    /// Outline, its x along the chain.
    pub shape: ShapeSpec,
    /// Density (kg/m3); that of the swimmer if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "Option<NonNegative>"))]
    pub density: Option<f64>,
    /// Magnetic moment in the frame of the link (A m2; A m planar), one number per dimension.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub magnetic_moment: Vec<f64>,
}

/// Smallest and largest x of an outline in its body frame, and half of its extent across (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkExtent {
    pub back: f64,
    pub front: f64,
    pub half_width: f64,
}

impl Link {
    /// Its outline.
    pub fn shape(&self) -> ShapeSpec {
        match self {
            Self::Ellipse(semi_axes) => ShapeSpec::Ellipse { semi_axes: *semi_axes },
            Self::Shaped(link) => link.shape.clone(),
        }
    }

    /// Its own density (kg/m3), if it has one.
    pub fn density(&self) -> Option<f64> {
        match self {
            Self::Ellipse(_) => None,
            Self::Shaped(link) => link.density,
        }
    }

    /// Its magnetic moment (A m2; A m planar); empty if it has none.
    pub fn magnetic_moment(&self) -> &[f64] {
        match self {
            Self::Ellipse(_) => &[],
            Self::Shaped(link) => &link.magnetic_moment,
        }
    }

    /// Where it ends along the chain, and how wide it is.
    ///
    /// # Errors
    /// When its points or lengths make no outline.
    pub fn extent(&self) -> Result<LinkExtent, MeshError> {
        let shape = self.shape();
        match &shape {
            ShapeSpec::Disc { radius } | ShapeSpec::Sphere { radius } => {
                Ok(LinkExtent { back: -radius, front: *radius, half_width: *radius })
            }
            ShapeSpec::Ellipse { semi_axes: [half, half_width] }
            | ShapeSpec::Spheroid { semi_axes: [half, half_width] } => {
                Ok(LinkExtent { back: -half, front: *half, half_width: *half_width })
            }
            ShapeSpec::Ellipsoid { semi_axes: [half, across, up] } => {
                Ok(LinkExtent { back: -half, front: *half, half_width: across.max(*up) })
            }
            ShapeSpec::Capsule { .. }
            | ShapeSpec::Cylinder { .. }
            | ShapeSpec::Helix(_)
            | ShapeSpec::Curve(_)
            | ShapeSpec::Revolved { .. }
            | ShapeSpec::Surface(_)
            | ShapeSpec::Union(_) => {
                let half = shape.reach();
                Ok(LinkExtent { back: -half, front: half, half_width: shape.half_width() })
            }
            ShapeSpec::Polygon(_) | ShapeSpec::Box { .. } | ShapeSpec::Side(_) => {
                let points = shape.points();
                let most = |part: fn(&[f64; 2]) -> f64| {
                    points.iter().map(part).fold(f64::NEG_INFINITY, f64::max)
                };
                let half_width = 0.5 * (most(|[_, y]| *y) + most(|[_, y]| -y));
                Ok(LinkExtent { back: -most(|[x, _]| -x), front: most(|[x, _]| *x), half_width })
            }
            ShapeSpec::Spline { .. }
            | ShapeSpec::Fish(_)
            | ShapeSpec::Flagellate(_)
            | ShapeSpec::Tube(_) => {
                let outline = Outline::new(&PlacedShape {
                    name: "link".to_owned(),
                    shape: shape.outline(),
                    center: Point::<2>::zeros(),
                    angle: 0.0,
                    size: None,
                })?;
                // Quarters begin at the extreme points along +x, +y, -x and -y
                let [right, top, left, bottom] =
                    [0, 1, 2, 3].map(|quarter| outline.evaluate(quarter, 0.0)[0]);
                let half_width = 0.5 * (top.y - bottom.y);
                Ok(LinkExtent { back: left.x, front: right.x, half_width })
            }
        }
    }
}

impl<'de> Deserialize<'de> for Link {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LinkVisitor)
    }
}

/// Tells the two forms by their type, so that an error is that of the form that was meant.
struct LinkVisitor;

impl<'de> Visitor<'de> for LinkVisitor {
    type Value = Link;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[semi-axis along, semi-axis across] or { shape = ..., density = ... }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> Result<Link, A::Error> {
        <[f64; 2]>::deserialize(SeqAccessDeserializer::new(items)).map(Link::Ellipse)
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Link, A::Error> {
        ShapedLink::deserialize(MapAccessDeserializer::new(entries)).map(Link::Shaped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_those_of_the_outline_along_the_chain() {
        let shaped =
            |shape| Link::Shaped(ShapedLink { shape, density: None, magnetic_moment: Vec::new() });
        let ends = |link: &Link| link.extent().map(|extent| [extent.back, extent.front]).unwrap();
        assert_eq!(ends(&Link::Ellipse([0.4, 0.1])), [-0.4, 0.4]);
        assert_eq!(ends(&shaped(ShapeSpec::Disc { radius: 0.3 })), [-0.3, 0.3]);
        // A kite whose corners are rounded beyond its points nowhere along x
        let points = vec![[0.5, 0.0], [0.0, 0.2], [-0.2, 0.0], [0.0, -0.2]];
        let [back, front] = ends(&shaped(ShapeSpec::Spline { points }));
        assert!((front - 0.5).abs() < 1e-9 && (-0.25..=-0.2).contains(&back), "{back} {front}");
        let crossed = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(shaped(ShapeSpec::Spline { points: crossed }).extent().is_err());
    }
}
