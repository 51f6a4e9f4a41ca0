//! Replacement of the cells in a cavity by others.

use crate::spatial::generate::tetrahedra::Tetrahedra;
use crate::spatial::generate::tetrahedra::boundary_edges::INNER;
use crate::spatial::generate::tetrahedra::measure::FACES;

/// A boundary face that a change makes.
#[derive(Debug, Clone, Copy)]
pub struct NewFace {
    /// Its vertices.
    pub vertices: [u32; 3],
    /// Its tag.
    pub tag: u16,
}

fn sorted(mut vertices: [u32; 3]) -> [u32; 3] {
    vertices.sort_unstable();
    vertices
}

impl Tetrahedra {
    /// Replaces cells by others that fill the same cavity: faces keep their tags, and some new ones
    /// are of the boundary.
    pub fn replace(&mut self, old: &[u32], new: &[[u32; 4]], on_boundary: &[NewFace]) {
        let mut tagged: Vec<NewFace> = on_boundary
            .iter()
            .map(|face| NewFace { vertices: sorted(face.vertices), ..*face })
            .collect();
        for &cell in old {
            let vertices = self.cell(cell);
            for (face, tag) in FACES.into_iter().zip(self.tags(cell)) {
                if tag != INNER {
                    let vertices = sorted(face.map(|local| vertices[local]));
                    tagged.push(NewFace { vertices, tag });
                }
            }
        }
        for &cell in old {
            self.delete_cell(cell);
        }
        for &vertices in new {
            let tags = if tagged.is_empty() {
                [INNER; 4]
            } else {
                FACES.map(|face| {
                    let own = sorted(face.map(|local| vertices[local]));
                    tagged.iter().find(|face| face.vertices == own).map_or(INNER, |face| face.tag)
                })
            };
            self.add_cell(vertices, tags);
        }
    }
}
