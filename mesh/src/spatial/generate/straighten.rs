//! Edges that stay straight where cells with bent ones would be folded.

use super::improve::{Improver, LEAST_COEFFICIENT};
use super::tetrahedra::measure::{EDGES, least_coefficient};
use crate::Point;

impl Improver<'_> {
    /// Straightens the edges of all cells that are nearly folded, and of those that are so by it.
    ///
    /// Where a surface turns within an edge, as at a narrow bevel, no quadratic cell follows it.
    pub fn straighten_folded_cells(&mut self) {
        let mut cells: Vec<u32> = self.mesh.cells().collect();
        while !cells.is_empty() {
            let mut bent: Vec<[u32; 2]> = Vec::new();
            for &cell in &cells {
                let own = self.bent_edges(cell);
                if !own.is_empty() && self.least_coefficient_of(cell) < LEAST_COEFFICIENT {
                    bent.extend(own);
                }
            }
            self.straight.extend(&bent);
            cells.clear();
            let mut shell = Vec::new();
            for [a, b] in bent {
                self.mesh.shell(a, b, &mut shell);
                cells.extend(&shell);
            }
            cells.sort_unstable();
            cells.dedup();
        }
    }

    /// Edges of a cell whose nodes are off their middles, by their ends in ascending order.
    fn bent_edges(&self, cell: u32) -> Vec<[u32; 2]> {
        let vertices = self.mesh.cell(cell);
        let ends = EDGES.iter().map(|edge| edge.map(|local| vertices[local]));
        let ends = ends.map(|[a, b]| [a.min(b), a.max(b)]);
        ends.filter(|edge| {
            self.has_curved(self.mesh.edge_surfaces(edge[0], edge[1]))
                && !self.straight.contains(edge)
        })
        .collect()
    }

    /// Least Bezier coefficient of det J of a cell over their mean.
    fn least_coefficient_of(&self, cell: u32) -> f64 {
        let vertices = self.mesh.cell(cell);
        let offsets: [Point<3>; 6] = EDGES.map(|[i, j]| {
            let [a, b] = [vertices[i], vertices[j]];
            if self.has_curved(self.mesh.edge_surfaces(a, b)) {
                self.offset_of_node(a, b)
            } else {
                Point::zeros()
            }
        });
        least_coefficient(&self.mesh.corners(vertices), &offsets)
    }
}
