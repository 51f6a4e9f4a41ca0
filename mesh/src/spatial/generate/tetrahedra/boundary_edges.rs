//! `BoundaryEdges`: which boundary faces meet at each edge of the boundary.

use super::surface_set::SurfaceSet;

/// The tag of a face between two cells; that of a boundary face is its surface plus one.
pub const INNER: u16 = 0;

/// The tag of faces on a surface.
pub fn tag_of(surface: u16) -> u16 {
    surface + 1
}

/// The surface a boundary face is on.
pub fn surface_of(tag: u16) -> u16 {
    tag - 1
}

/// Faces at one edge: two, or more for a while where the fluid is pinched while it is being cut.
const MOST_FACES: usize = 8;

/// An edge on the boundary.
#[derive(Debug, Clone, Copy)]
struct BoundaryEdge {
    /// The end with the larger number.
    other: u32,
    /// Tags of the boundary faces at it.
    tags: [u16; MOST_FACES],
    /// Their surfaces.
    surfaces: SurfaceSet,
}

/// The edges of the boundary, each in the list of its end with the smaller number.
#[derive(Debug, Clone, Default)]
pub struct BoundaryEdges(Vec<Vec<BoundaryEdge>>);

impl BoundaryEdges {
    /// Makes room for the edges of one more vertex.
    pub fn add_vertex(&mut self) {
        self.0.push(Vec::new());
    }

    /// Adds a boundary face.
    pub fn add_face(&mut self, vertices: [u32; 3], tag: u16) {
        for [a, b] in edges_of(vertices) {
            self.replace(a, b, INNER, tag);
        }
    }

    /// Takes a boundary face away.
    pub fn remove_face(&mut self, vertices: [u32; 3], tag: u16) {
        for [a, b] in edges_of(vertices) {
            self.replace(a, b, tag, INNER);
        }
    }

    fn replace(&mut self, a: u32, b: u32, from: u16, to: u16) {
        let (first, other) = (a.min(b), a.max(b));
        let list = &mut self.0[first as usize];
        let at = list.iter().position(|edge| edge.other == other).unwrap_or_else(|| {
            let surfaces = SurfaceSet::EMPTY;
            list.push(BoundaryEdge { other, tags: [INNER; MOST_FACES], surfaces });
            list.len() - 1
        });
        if let Some(entry) = list[at].tags.iter_mut().find(|tag| **tag == from) {
            *entry = to;
        }
        let faces = list[at].tags.iter().filter(|tag| **tag != INNER);
        let surfaces =
            faces.fold(SurfaceSet::EMPTY, |all, tag| all.with(surface_of(*tag)).unwrap_or(all));
        if surfaces.is_empty() {
            list.swap_remove(at);
        } else {
            list[at].surfaces = surfaces;
        }
    }

    /// The surfaces whose faces meet at an edge; none for an edge inside the fluid.
    #[inline]
    pub fn surfaces(&self, a: u32, b: u32) -> SurfaceSet {
        let (first, other) = (a.min(b), a.max(b));
        let known = self.0[first as usize].iter().find(|edge| edge.other == other);
        known.map_or(SurfaceSet::EMPTY, |edge| edge.surfaces)
    }
}

fn edges_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
