//! `Neighbours`: the cells across the faces of each cell.

use std::collections::HashMap;

use crate::number::index_u32;
use crate::{CellId, Mesh};

/// Stands for no cell: a face on the boundary.
const NONE: u32 = u32::MAX;

/// The cells across the faces of each cell (edges in the plane).
#[derive(Debug, Clone)]
pub struct Neighbours<const D: usize> {
    /// D + 1 for each cell, opposite to its vertices.
    across: Vec<u32>,
}

impl<const D: usize> Neighbours<D> {
    /// Those of the cells of a mesh; the two sides of a periodic mesh are not neighbours.
    #[must_use]
    pub fn new(mesh: &Mesh<D>) -> Self {
        let n_faces = (D + 1) * mesh.n_cells();
        let mut across = vec![NONE; n_faces];
        let mut open: HashMap<[u32; D], usize> = HashMap::with_capacity(n_faces / 2);
        for (cell, first) in mesh.cell_ids().zip((0..).step_by(D + 1)) {
            let vertices = mesh.cell_vertices(cell);
            for opposite in 0..=D {
                let others = (0..=D).filter(|local| *local != opposite);
                let mut face = [0; D];
                for (entry, local) in face.iter_mut().zip(others) {
                    *entry = vertices[local].into();
                }
                face.sort_unstable();
                let here = first + opposite;
                match open.remove(&face) {
                    Some(there) => {
                        across[here] = index_u32(there / (D + 1));
                        across[there] = index_u32(cell.index());
                    }
                    None => {
                        open.insert(face, here);
                    }
                }
            }
        }
        Self { across }
    }

    /// The cell across the face of a cell opposite to one of its vertices; `None` on the boundary.
    #[must_use]
    pub fn across(&self, cell: CellId, opposite: usize) -> Option<CellId> {
        let other = self.across[(D + 1) * cell.index() + opposite];
        (other != NONE).then(|| CellId::new(other as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::cube_of_five;

    /// The middle one of five tetrahedra has all others around it, and they have nothing but it.
    #[test]
    fn cells_know_each_other() {
        let mesh = cube_of_five();
        let neighbours = Neighbours::new(&mesh);
        let of = |cell: CellId| {
            (0..4).filter_map(|face| neighbours.across(cell, face)).collect::<Vec<_>>()
        };
        let (middle, corners): (Vec<CellId>, Vec<CellId>) =
            mesh.cell_ids().partition(|cell| of(*cell).len() == 4);
        assert_eq!([middle.len(), corners.len()], [1, 4]);
        assert!(corners.iter().all(|corner| of(*corner) == middle));
    }
}
