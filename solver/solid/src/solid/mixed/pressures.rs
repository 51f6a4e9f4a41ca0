//! `Pressures`: the pressures of cells that keep their volume, one at each vertex for each material.

use std::collections::BTreeMap;

/// Pressures (Pa) are components of a state behind the places of all nodes. Cells of one material share those of
/// their vertices; where another one begins the pressure may jump.
#[derive(Debug, Clone, Default)]
pub(in crate::solid) struct Pressures {
    /// The node of each pressure.
    pub nodes: Vec<usize>,
    /// The first component that is a pressure.
    pub first: usize,
    /// Where the pressures of each cell begin, and where those of the last end; empty where no cell has any.
    starts: Vec<usize>,
    /// Components of the pressures at the vertices of all cells that have some.
    components: Vec<usize>,
}

impl Pressures {
    /// Those of cells, by their material where they keep their volume, and their vertices.
    pub(in crate::solid) fn new<'a>(
        cells: impl Iterator<Item = (Option<usize>, &'a [usize])>,
        first: usize,
    ) -> Self {
        let mut all = Self { first, starts: vec![0], ..Self::default() };
        let mut numbers = BTreeMap::new();
        for (material, vertices) in cells {
            for vertex in vertices.iter().filter(|_| material.is_some()) {
                let number = *numbers.entry((material, *vertex)).or_insert_with(|| {
                    all.nodes.push(*vertex);
                    all.nodes.len() - 1
                });
                all.components.push(first + number);
            }
            all.starts.push(all.components.len());
        }
        all
    }

    /// Components of the pressures at the vertices of a cell; none where it can be compressed.
    pub(in crate::solid) fn of(&self, cell: usize) -> &[usize] {
        &self.components[self.starts[cell]..self.starts[cell + 1]]
    }

    /// How many there are.
    pub(in crate::solid) fn count(&self) -> usize {
        self.nodes.len()
    }

    /// The pressure where the vertices of a cell have these shares.
    pub(in crate::solid) fn at(&self, cell: usize, shares: &[f64], state: &[f64]) -> Option<f64> {
        let own = self.of(cell);
        let sum = || own.iter().zip(shares).map(|(one, share)| state[*one] * share).sum();
        (!own.is_empty()).then(sum)
    }
}
