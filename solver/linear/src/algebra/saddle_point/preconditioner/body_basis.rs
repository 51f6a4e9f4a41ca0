//! `BodyBasis`: velocities of bodies with coordinates in a basis in which their own block of F is the identity.
//!
//! A stiff rod resists to be stretched many million times as much as the fluid resists its motion: no smoother of
//! small blocks sees the one beside the other, and single precision loses it. With x = T w and the rows times s T^T, signs s, the
//! symmetric part of that block is the identity: what is stiff hardly moves and the rest moves as a rigid body does, whatever
//! the stiffness.

use super::super::matrix::{B, Gradient, Numbering, SaddleMatrix};
use super::triangular::{Square, TriangularBasis};
use crate::multigrid::{Block, BlockMatrix, RowBuilder};
use crate::sparse::index::to_u32;
use crate::sparse::single::single;

/// A basis for the velocities of some bodies; those of all others stay.
#[derive(Debug)]
pub(in super::super) struct BodyBasis {
    n_nodes: usize,
    groups: Vec<Group>,
    /// Where each block of a body is, in a group.
    places: Vec<Option<Place>>,
}

/// A block of a group.
#[derive(Debug, Clone, Copy)]
struct Place {
    group: usize,
    block: usize,
}

/// Bodies whose velocities couple with each other.
#[derive(Debug)]
struct Group {
    /// Their rows of blocks, which ascend.
    rows: Vec<usize>,
    /// The unknown of each velocity, if it is one.
    unknowns: Vec<Option<u32>>,
    /// T and s.
    own: TriangularBasis,
    /// T^T F T.
    changed: Square,
}

impl BodyBasis {
    /// For a matrix; none where no body has coordinates.
    pub fn new(matrix: &SaddleMatrix) -> Option<Self> {
        let numbering = matrix.numbering();
        let n_nodes = numbering.n_nodes;
        let groups = groups_of_pairs(matrix).into_iter().map(|pairs| {
            let rows =
                pairs.into_iter().flat_map(|pair| [0, 1].map(|nth| n_nodes + 2 * pair + nth));
            Group::new(matrix, rows.collect())
        });
        let groups: Vec<Group> = groups.collect();
        if groups.is_empty() {
            return None;
        }
        let mut places = vec![None; 2 * numbering.n_bodies];
        for (group, of_group) in groups.iter().enumerate() {
            for (block, &row) in of_group.rows.iter().enumerate() {
                places[row - n_nodes] = Some(Place { group, block });
            }
        }
        Some(Self { n_nodes, groups, places })
    }

    /// F in the basis.
    pub fn velocity(&self, matrix: &SaddleMatrix) -> BlockMatrix<B> {
        let columns = self.in_columns(matrix.velocity());
        let changed = self.in_columns(&columns.transposed()).transposed();
        let mut rows = RowBuilder::new(changed.n_columns());
        for row in 0..changed.n_rows() {
            let place = row.checked_sub(self.n_nodes).and_then(|body| self.places[body]);
            // What couples with a body of a group is in it, or a node
            let most = if place.is_some() { self.n_nodes } else { changed.n_columns() };
            let signs = place.map_or([1.0; B], |place| self.signs(place));
            let signed = |block: &Block<B>| {
                block.map(|column| std::array::from_fn(|a| column[a] * signs[a]))
            };
            for (column, block) in changed.row(row).filter(|(column, _)| *column < most) {
                rows.push(to_u32(column), signed(block));
            }
            if let Some(Place { group, block }) = place {
                let Group { rows: own, changed, .. } = &self.groups[group];
                for (other, &column) in own.iter().enumerate() {
                    let own = changed.block(block, other).map(|column| column.map(single));
                    rows.push(to_u32(column), signed(&own));
                }
            }
            rows.end_row();
        }
        rows.build()
    }

    /// s of a block.
    fn signs(&self, Place { group, block }: Place) -> [f32; B] {
        let signs = &self.groups[group].own.signs;
        std::array::from_fn(|a| single(signs[B * block + a]))
    }

    /// The rows of nodes in a matrix, with the columns of bodies in the basis; bodies are its last columns.
    pub fn in_columns(&self, matrix: &BlockMatrix<B>) -> BlockMatrix<B> {
        let first = matrix.n_columns() - self.places.len();
        let mut rows = RowBuilder::new(matrix.n_columns());
        let mut found: Vec<(Place, &Block<B>)> = Vec::new();
        for row in 0..matrix.n_rows() {
            for (column, block) in matrix.row(row) {
                let place = column.checked_sub(first).and_then(|body| self.places[body]);
                match place.filter(|_| row < self.n_nodes) {
                    Some(place) => found.push((place, block)),
                    None => rows.push(to_u32(column), *block),
                }
            }
            found.sort_unstable_by_key(|(place, _)| (place.group, place.block));
            for of_group in found.chunk_by(|one, other| one.0.group == other.0.group) {
                let Place { group, block: from } = of_group[0].0;
                let Group { rows: all, own: TriangularBasis { basis, .. }, .. } =
                    &self.groups[group];
                for (to, &column) in all.iter().enumerate().skip(from) {
                    let mut sum = [[0.0; B]; B];
                    for (place, factor) in of_group.iter().filter(|(place, _)| place.block <= to) {
                        add_product(factor, &basis.block(place.block, to), &mut sum);
                    }
                    let column = first + column - self.n_nodes;
                    rows.push(to_u32(column), sum.map(|column| column.map(single)));
                }
            }
            found.clear();
            rows.end_row();
        }
        rows.build()
    }

    /// G in the basis, s T^T G.
    pub fn gradient(&self, divergence: &Gradient) -> Gradient {
        divergence.with_rows(|row| {
            let place = row.checked_sub(self.n_nodes).and_then(|body| self.places[body])?;
            let signs = self.signs(place);
            let entries = divergence.entries(row);
            let values = divergence.values()[entries.clone()].iter();
            let values = values.map(|value| std::array::from_fn(|a| value[a] * signs[a]));
            Some(divergence.pressures()[entries].iter().copied().zip(values).collect())
        })
    }

    /// T^T G, which is the transposed of the divergence in the basis.
    pub fn divergence(&self, matrix: &SaddleMatrix) -> Gradient {
        let gradient = matrix.gradient();
        let mut of_rows = vec![None; self.places.len()];
        for Group { rows, own: TriangularBasis { basis, .. }, .. } in &self.groups {
            let mut pressures: Vec<u32> = rows
                .iter()
                .flat_map(|&row| &gradient.pressures()[gradient.entries(row)])
                .copied()
                .collect();
            pressures.sort_unstable();
            pressures.dedup();
            let mut sums = vec![vec![[0.0f64; B]; pressures.len()]; rows.len()];
            for (from, &row) in rows.iter().enumerate() {
                for entry in gradient.entries(row) {
                    let pressure = gradient.pressures()[entry];
                    let Ok(place) = pressures.binary_search(&pressure) else { continue };
                    let value = gradient.values()[entry].map(f64::from);
                    for (to, sums) in sums.iter_mut().enumerate().skip(from) {
                        let block = basis.block(from, to);
                        for (sum, column) in sums[place].iter_mut().zip(block) {
                            *sum += (0..B).map(|a| column[a] * value[a]).sum::<f64>();
                        }
                    }
                }
            }
            for (&row, sums) in rows.iter().zip(sums) {
                let values = sums.into_iter().map(|sum| sum.map(single));
                of_rows[row - self.n_nodes] = Some(pressures.iter().copied().zip(values).collect());
            }
        }
        gradient.with_rows(|row| row.checked_sub(self.n_nodes).and_then(|own| of_rows[own].take()))
    }

    /// Overwrites loads on all unknowns by s T^T times them.
    pub fn change_loads(&self, loads: &mut [f64]) {
        self.for_each_group(loads, |group, loads| {
            let TriangularBasis { basis, signs, .. } = &group.own;
            let changed = basis.transposed_times(loads);
            changed.into_iter().zip(signs).map(|(value, sign)| value * sign).collect()
        });
    }

    /// Overwrites w, among all unknowns, by x = T w.
    pub fn restore_velocities(&self, velocities: &mut [f64]) {
        self.for_each_group(velocities, |group, own| group.own.basis.times(own));
    }

    fn for_each_group(&self, values: &mut [f64], of: impl Fn(&Group, &[f64]) -> Vec<f64>) {
        for group in &self.groups {
            let value = |unknown: &Option<u32>| unknown.map_or(0.0, |at| values[at as usize]);
            let own: Vec<f64> = group.unknowns.iter().map(value).collect();
            for (unknown, value) in group.unknowns.iter().zip(of(group, &own)) {
                if let Some(unknown) = unknown {
                    values[*unknown as usize] = value;
                }
            }
        }
    }

    /// Overwrites x, in rows of blocks, by w = T^-1 x.
    pub fn change_velocities(&self, velocity: &mut [[f32; B]]) {
        for Group { rows, own, .. } in &self.groups {
            let inverse = &own.inverse;
            let own = rows.iter().flat_map(|&row| velocity[row]).map(f64::from);
            let changed = inverse.times(&own.collect::<Vec<f64>>());
            for (&row, values) in rows.iter().zip(changed.chunks_exact(B)) {
                velocity[row] = std::array::from_fn(|a| single(values[a]));
            }
        }
    }
}

impl Group {
    fn new(matrix: &SaddleMatrix, rows: Vec<usize>) -> Self {
        let mut block_of_all = Square::zeros(B * rows.len());
        for (i, &row) in rows.iter().enumerate() {
            for (column, block) in matrix.velocity_row(row) {
                if let Ok(j) = rows.binary_search(&column) {
                    block_of_all.set_block(i, j, &block);
                }
            }
        }
        let own = TriangularBasis::of(&block_of_all);
        let changed = block_of_all.changed(&own.basis);
        let blocks = &matrix.numbering().blocks;
        let unknowns = rows.iter().flat_map(|&row| blocks[row]).collect();
        Self { rows, unknowns, own, changed }
    }
}

/// Pairs of blocks that couple with each other, one of which at least has rates of coordinates; they ascend.
fn groups_of_pairs(matrix: &SaddleMatrix) -> Vec<Vec<usize>> {
    let Numbering { n_nodes, n_bodies, has_rates, .. } = matrix.numbering();
    if !has_rates.contains(&true) {
        return Vec::new();
    }
    let mut is_seen = vec![false; *n_bodies];
    let mut groups = Vec::new();
    for first in 0..*n_bodies {
        if is_seen[first] {
            continue;
        }
        is_seen[first] = true;
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&pair) = group.get(next) {
            next += 1;
            let rows = [0, 1].map(|nth| n_nodes + 2 * pair + nth);
            let columns = rows.into_iter().flat_map(|row| matrix.velocity().columns(row));
            for other in columns.filter_map(|&column| (column as usize).checked_sub(*n_nodes)) {
                if !std::mem::replace(&mut is_seen[other / 2], true) {
                    group.push(other / 2);
                }
            }
        }
        if group.iter().any(|&pair| has_rates[pair]) {
            group.sort_unstable();
            groups.push(group);
        }
    }
    groups
}

/// Adds the product of two blocks, columns by columns.
fn add_product(left: &Block<B>, right: &[[f64; B]; B], sum: &mut [[f64; B]; B]) {
    for (sum, right) in sum.iter_mut().zip(right) {
        for (left, factor) in left.iter().zip(right) {
            for (sum, value) in sum.iter_mut().zip(left) {
                *sum += f64::from(*value) * factor;
            }
        }
    }
}
