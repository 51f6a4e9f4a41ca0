//! STL: triangles by the places of their corners, as text or binary.

use super::lines::at_line;
use super::{NamedTriangles, SurfaceFault, TriangleMesh, at_most};
use crate::Point;
use crate::number::index_u32;

/// Bytes before the number of triangles, and before the first of them.
const HEADER: usize = 80;
const FIRST: usize = 84;

/// Bytes of a triangle: its normal, three corners and two more.
const TRIANGLE: usize = 50;

/// Whether the length of a file is that which its number of triangles says.
pub fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER..FIRST).and_then(|count| <[u8; 4]>::try_from(count).ok());
    count.is_some_and(|count| {
        let n = u64::from(u32::from_le_bytes(count));
        bytes.len() as u64 == FIRST as u64 + n * TRIANGLE as u64
    })
}

/// Reads a binary file, of which [`is_binary`] holds.
pub fn read_binary(bytes: &[u8]) -> Result<TriangleMesh, SurfaceFault> {
    let triangles = bytes[FIRST..].as_chunks::<TRIANGLE>().0;
    at_most(triangles.len())?;
    let float = |bytes: &[u8]| {
        let bytes = <[u8; 4]>::try_from(bytes).unwrap_or_default();
        f64::from(f32::from_le_bytes(bytes))
    };
    let mut mesh = TriangleMesh::default();
    for triangle in triangles {
        let corners = triangle[12..48].as_chunks::<12>().0;
        let corners = corners.iter().map(|corner| {
            Point::<3>::new(float(&corner[..4]), float(&corner[4..8]), float(&corner[8..]))
        });
        push(&mut mesh, corners);
    }
    Ok(mesh)
}

/// Reads a text.
pub fn read_text(text: &str) -> Result<NamedTriangles, SurfaceFault> {
    let mut named = NamedTriangles::default();
    let mut corners: Vec<Point<3>> = Vec::new();
    for (nth, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else {
                    return Err(at_line(nth, "`vertex` is not followed by x y z"));
                };
                corners.push(Point::<3>::new(x, y, z));
            }
            Some("endloop") => {
                if corners.len() != 3 {
                    let found = format!("a facet has {} corners, not 3", corners.len());
                    return Err(at_line(nth, found));
                }
                at_most(named.mesh.triangles.len())?;
                push(&mut named.mesh, corners.drain(..));
            }
            Some("solid") => named.begin(&line.trim_start()[5..]),
            Some("facet" | "outer" | "endfacet" | "endsolid") | None => {}
            Some(_) => return Err(at_line(nth, "this is no line of an STL file")),
        }
    }
    if !corners.is_empty() {
        return Err(at_line(text.lines().count(), "the file ends within a facet"));
    }
    named.close();
    Ok(named)
}

fn push(mesh: &mut TriangleMesh, corners: impl Iterator<Item = Point<3>>) {
    let first = index_u32(mesh.vertices.len());
    mesh.vertices.extend(corners);
    mesh.triangles.push([first, first + 1, first + 2]);
}

impl TriangleMesh {
    /// A binary STL file of the triangles, whose coordinates have single precision there.
    #[must_use]
    pub fn to_stl(&self) -> Vec<u8> {
        let mut bytes = vec![b' '; HEADER];
        bytes.extend(index_u32(self.triangles.len()).to_le_bytes());
        for triangle in 0..self.triangles.len() {
            let normal = self.area_vector(triangle).try_normalize(0.0).unwrap_or_default();
            for point in [normal].into_iter().chain(self.corners(triangle)) {
                for x in &point {
                    #[expect(clippy::cast_possible_truncation, reason = "the format has these")]
                    let single = *x as f32;
                    bytes.extend(single.to_le_bytes());
                }
            }
            bytes.extend([0; 2]);
        }
        bytes
    }
}
