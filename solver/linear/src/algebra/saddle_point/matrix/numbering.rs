//! `Numbering`: unknowns as blocks of three velocities, two blocks for a body, and as pressures.

use super::super::data::{Part, SaddlePoint};
use super::vector::{B, Blocks, Place};
use crate::sparse::index::to_u32;

/// Blocks of the unknowns of a system.
#[derive(Debug, Clone)]
pub(in super::super) struct Numbering {
    /// Place of each unknown.
    pub places: Vec<Place>,
    /// The unknowns of each block, where they are free.
    pub blocks: Vec<[Option<u32>; B]>,
    /// The unknown of each pressure.
    pub pressures: Vec<u32>,
    /// Blocks of nodes.
    pub n_nodes: usize,
    /// Bodies with an unknown rigid velocity, and sixes of rates: the last pairs of blocks.
    pub n_bodies: usize,
    /// Which of these pairs have rates of coordinates.
    pub has_rates: Vec<bool>,
}

/// Numbers given to keys in the order they are first seen.
#[derive(Default)]
struct Seen {
    number_of: Vec<Option<u32>>,
    count: u32,
}

impl Seen {
    fn number(&mut self, key: u32) -> u32 {
        let key = key as usize;
        if key >= self.number_of.len() {
            self.number_of.resize(key + 1, None);
        }
        *self.number_of[key].get_or_insert_with(|| {
            self.count += 1;
            self.count - 1
        })
    }
}

impl Numbering {
    /// Nodes and bodies in the order of their first unknowns.
    pub fn new(system: &SaddlePoint) -> Self {
        let (mut nodes, mut bodies) = (Seen::default(), Seen::default());
        for part in &system.parts {
            if let Part::Velocity { node, .. } = *part {
                nodes.number(node);
            }
        }
        let n_nodes = nodes.count;
        let mut pressures = Vec::new();
        let place = |(unknown, part): (usize, &Part)| match *part {
            Part::Velocity { node, component } => {
                Place::Velocity { row: nodes.number(node), component }
            }
            Part::Pressure { .. } => {
                pressures.push(to_u32(unknown));
                Place::Pressure(to_u32(pressures.len() - 1))
            }
            Part::Rigid { body, mode } | Part::Rate { body, mode } => Place::Velocity {
                row: n_nodes + 2 * bodies.number(body) + u32::from(mode / 3),
                component: mode % 3,
            },
        };
        let places: Vec<Place> = system.parts.iter().enumerate().map(place).collect();
        let n_nodes = n_nodes as usize;
        let n_bodies = bodies.count as usize;
        let mut blocks = vec![[None; B]; n_nodes + 2 * n_bodies];
        let mut has_rates = vec![false; n_bodies];
        for (unknown, (place, part)) in places.iter().zip(&system.parts).enumerate() {
            if let Place::Velocity { row, component } = *place {
                blocks[row as usize][usize::from(component)] = Some(to_u32(unknown));
                if matches!(part, Part::Rate { .. }) {
                    has_rates[(row as usize - n_nodes) / 2] = true;
                }
            }
        }
        Self { places, blocks, pressures, n_nodes, n_bodies, has_rates }
    }

    /// The other block of the body whose block is in a row.
    pub fn paired(&self, row: usize) -> Option<usize> {
        (row >= self.n_nodes).then(|| self.n_nodes + ((row - self.n_nodes) ^ 1))
    }

    /// The vector of unknowns with what `of` gives for their places and values.
    pub fn split<T: Copy + Default>(
        &self,
        values: &[f64],
        of: impl Fn(Place, f64) -> T,
    ) -> Blocks<T> {
        let mut blocks = Blocks::zeros(self.blocks.len(), self.pressures.len());
        for (&place, &value) in self.places.iter().zip(values) {
            *blocks.at_mut(place) = of(place, value);
        }
        blocks
    }

    /// The values of all unknowns in a vector.
    pub fn values(&self, blocks: &Blocks) -> Vec<f32> {
        self.places.iter().map(|&place| blocks.at(place)).collect()
    }

    /// Adds a vector times a factor to values of the unknowns.
    pub fn add(&self, factor: f64, blocks: &Blocks, values: &mut [f64]) {
        for (&place, value) in self.places.iter().zip(values) {
            *value += factor * f64::from(blocks.at(place));
        }
    }
}
