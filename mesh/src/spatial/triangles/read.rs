//! Files of triangles, told apart by their content.

use std::collections::HashMap;

use super::{NamedTriangles, SurfaceFault, TriangleMesh, at_most, obj, ply, stl};
use crate::Point;
use crate::number::index_u32;

impl TriangleMesh {
    /// Reads a file: STL as text or binary, OBJ or PLY; polygons are cut into triangles, and vertices in
    /// exactly the same place are one.
    ///
    /// # Errors
    /// [`SurfaceFault::Kind`], [`SurfaceFault::File`] with the line or byte, [`SurfaceFault::Count`],
    /// [`SurfaceFault::NotFinite`].
    pub fn read(bytes: &[u8]) -> Result<Self, SurfaceFault> {
        NamedTriangles::read(bytes).map(|named| named.mesh)
    }
}

impl NamedTriangles {
    /// The same with the groups that the file names.
    ///
    /// # Errors
    /// Those of [`TriangleMesh::read`].
    pub fn read(bytes: &[u8]) -> Result<Self, SurfaceFault> {
        let named = if bytes.starts_with(b"ply") {
            ply::read(bytes)?.into()
        } else if stl::is_binary(bytes) {
            stl::read_binary(bytes)?.into()
        } else {
            let text = String::from_utf8_lossy(bytes);
            if text.trim_start().starts_with("solid") {
                stl::read_text(&text)?
            } else if text.lines().any(|line| line.trim_start().starts_with("v ")) {
                obj::read(&text)?
            } else {
                return Err(SurfaceFault::Kind);
            }
        };
        let Self { mesh, groups } = named;
        at_most(mesh.triangles.len())?;
        if mesh.triangles.len() < 4 {
            return Err(SurfaceFault::Count { n: mesh.triangles.len() });
        }
        let is_finite = |vertex: &Point<3>| vertex.iter().all(|x| x.is_finite());
        if let Some(vertex) = mesh.vertices.iter().position(|vertex| !is_finite(vertex)) {
            return Err(SurfaceFault::NotFinite { vertex });
        }
        Ok(Self { mesh: mesh.joined(), groups })
    }
}

impl TriangleMesh {
    /// The same with one vertex at each place, and none that no triangle has.
    fn joined(&self) -> Self {
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
        let mut joined = Self::default();
        for triangle in &self.triangles {
            joined.triangles.push(triangle.map(|vertex| {
                let at = self.vertices[vertex as usize];
                // Zero is zero, whatever its sign
                let key = [at.x, at.y, at.z].map(|x| (x + 0.0).to_bits());
                *numbers.entry(key).or_insert_with(|| {
                    joined.vertices.push(at);
                    index_u32(joined.vertices.len() - 1)
                })
            }));
        }
        joined
    }
}
