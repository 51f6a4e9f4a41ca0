//! `surface`: a solid given by the triangles of its surface, from a file.

use std::fmt;
use std::sync::Arc;

use alewife_mesh::spatial::{SurfaceFault, TriangleMesh, Triangulated};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[cfg(test)]
use crate::spec::number::{Degrees, Positive};

/// `surface`: a solid by the triangles of its surface, from an STL, OBJ or PLY file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SurfaceShape {
    /// Path of the file, relative to the file in which it is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The triangles of the file, as runs write them in its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<String>,
    /// Factor that makes its lengths those of the case (1).
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(with = "Positive"))]
    pub scale: f64,
    /// Origin of the body frame: `"centroid"`, or [x, y, z] of the file times `scale` (m).
    #[serde(default)]
    pub center: SurfaceCenter,
    /// Largest angle by which the surface turns at an edge (degrees): it is smooth through the vertices;
    /// sharper edges are refused in a flow, and stay sharp in soft cases.
    #[serde(default = "smooth")]
    #[cfg_attr(test, schemars(with = "Degrees"))]
    pub smooth: f64,
    /// What the triangles are the surface of.
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    pub(crate) contents: Option<Arc<Triangulated>>,
}

fn one() -> f64 {
    1.0
}

fn smooth() -> f64 {
    45.0
}

/// Where the origin of the frame of a surface is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(with = "Written"))]
pub enum SurfaceCenter {
    /// At the centroid of the solid.
    #[default]
    Centroid,
    /// At a point (m).
    At([f64; 3]),
}

/// How it is written.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema is derived from it")]
enum Written {
    /// At the centroid of the solid.
    Named(Named),
    /// At a point (m).
    At([f64; 3]),
}

/// The only place with a name.
#[cfg(test)]
#[derive(schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[expect(dead_code, reason = "the schema is derived from it")]
enum Named {
    Centroid,
}

impl Serialize for SurfaceCenter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Centroid => serializer.serialize_str("centroid"),
            Self::At(at) => at.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for SurfaceCenter {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Place)
    }
}

struct Place;

impl<'de> Visitor<'de> for Place {
    type Value = SurfaceCenter;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"centroid\" or [x, y, z]")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<SurfaceCenter, E> {
        if name == "centroid" {
            return Ok(SurfaceCenter::Centroid);
        }
        Err(E::invalid_value(de::Unexpected::Str(name), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<SurfaceCenter, A::Error> {
        let mut at = [0.0; 3];
        for (nth, place) in at.iter_mut().enumerate() {
            *place = parts.next_element()?.ok_or_else(|| de::Error::invalid_length(nth, &self))?;
        }
        match parts.next_element::<f64>()? {
            None => Ok(SurfaceCenter::At(at)),
            Some(_) => Err(de::Error::invalid_length(4, &self)),
        }
    }
}

impl SurfaceShape {
    /// The solid; `None` where it has not been read.
    #[must_use]
    pub fn solid(&self) -> Option<&Arc<Triangulated>> {
        self.contents.as_ref()
    }

    /// Makes the solid of its triangles.
    ///
    /// # Errors
    /// Why they are the surface of none.
    pub(crate) fn make_solid(&mut self) -> Result<(), SurfaceFault> {
        let Some(data) = &self.data else { return Ok(()) };
        let mesh = TriangleMesh::from_line(data)?.scaled(self.scale);
        let origin = match self.center {
            SurfaceCenter::Centroid => None,
            SurfaceCenter::At(at) => Some(at.into()),
        };
        self.contents = Some(Arc::new(Triangulated::new(&mesh, self.smooth, origin)?));
        Ok(())
    }

    /// Number of its triangles.
    #[must_use]
    pub fn n_triangles(&self) -> usize {
        self.solid().map_or(0, |solid| solid.triangles().triangles.len())
    }
}
