//! Triangles as one line of text, as the case of a run holds them: nothing is lost.

use std::io::{Read, Write};

use data_encoding::BASE64;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::{SurfaceFault, TriangleMesh, at_most};
use crate::Point;
use crate::number::index_u32;

/// Bytes of a vertex and of a triangle.
const VERTEX: usize = 24;
const TRIANGLE: usize = 12;

impl TriangleMesh {
    /// Its number of vertices, coordinates and triangles, compressed (zlib), in base 64.
    #[must_use]
    pub fn to_line(&self) -> String {
        let mut bytes = index_u32(self.vertices.len()).to_le_bytes().to_vec();
        bytes.extend(self.vertices.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend(self.triangles.iter().flatten().flat_map(|vertex| vertex.to_le_bytes()));
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        // Writing into memory does not fail
        let written = encoder.write_all(&bytes).and_then(|()| encoder.finish());
        BASE64.encode(&written.unwrap_or_default())
    }

    /// The triangles of such a line.
    ///
    /// # Errors
    /// [`SurfaceFault::File`] where it is none.
    pub fn from_line(line: &str) -> Result<Self, SurfaceFault> {
        let broken = |found: &str| SurfaceFault::File {
            place: "stored surface".to_owned(),
            found: found.to_owned(),
        };
        let packed = BASE64.decode(line.as_bytes()).map_err(|_| broken("it is not in base 64"))?;
        let mut bytes = Vec::new();
        let mut decoder = ZlibDecoder::new(packed.as_slice()).take(1 << 30);
        decoder.read_to_end(&mut bytes).map_err(|_| broken("it cannot be unpacked"))?;
        let (count, rest) =
            bytes.split_first_chunk::<4>().ok_or_else(|| broken("it ends too soon"))?;
        let n = u32::from_le_bytes(*count) as usize;
        let split = n.checked_mul(VERTEX).and_then(|length| rest.split_at_checked(length));
        let (vertices, triangles) = split.ok_or_else(|| broken("it ends too soon"))?;
        let float = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        let number = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap_or_default());
        let (vertices, _) = vertices.as_chunks::<VERTEX>();
        let (triangles, _) = triangles.as_chunks::<TRIANGLE>();
        let mesh = Self {
            vertices: vertices
                .iter()
                .map(|at| Point::<3>::new(float(&at[..8]), float(&at[8..16]), float(&at[16..])))
                .collect(),
            triangles: triangles
                .iter()
                .map(|at| [number(&at[..4]), number(&at[4..8]), number(&at[8..])])
                .collect(),
        };
        at_most(mesh.triangles.len())?;
        let is_known = |vertex: &u32| (*vertex as usize) < n;
        if !mesh.triangles.iter().flatten().all(is_known) {
            return Err(broken("a triangle has no such vertex"));
        }
        Ok(mesh)
    }
}
