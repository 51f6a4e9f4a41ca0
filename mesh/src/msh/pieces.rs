//! Pieces of a mesh that touch without sharing nodes: joined where their nodes coincide.

use std::collections::BTreeMap;

use super::error::MshError;
use super::file::MshFile;
use super::parts::Parts;
use crate::Point;

/// Nodes nearer to each other than this coincide, in lengths of the mesh.
const SAME: f64 = 1e-9;

/// Gives nodes of different pieces at the same place one tag, if cells of a dimension are in several pieces; says how many.
///
/// In one piece nothing is joined: two nodes at one place are the two faces of a cut then.
pub fn join_pieces(file: &mut MshFile, dimension: usize) -> usize {
    let pieces = pieces(file, dimension);
    let mut roots: Vec<u64> = pieces.values().copied().collect();
    roots.sort_unstable();
    roots.dedup();
    if roots.len() < 2 {
        return 0;
    }
    let largest = file.nodes.values().map(Point::<3>::amax).fold(0.0, f64::max);
    let cell = (SAME * largest).max(f64::MIN_POSITIVE);
    #[expect(clippy::cast_possible_truncation, reason = "whole numbers of 1e-9 of the mesh")]
    let place = |point: &Point<3>| -> [i64; 3] { point.map(|x| (x / cell).round() as i64).into() };
    let mut at: BTreeMap<[i64; 3], Vec<u64>> = BTreeMap::new();
    let mut same: BTreeMap<u64, u64> = BTreeMap::new();
    for (&tag, &piece) in &pieces {
        let [x, y, z] = place(&file.nodes[&tag]);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [i, j]));
        let around = around.flat_map(|[i, j]| (-1..=1).map(move |k| [i, j, k]));
        let near = around.filter_map(|[i, j, k]| at.get(&[x + i, y + j, z + k])).flatten();
        let point = &file.nodes[&tag];
        let mut found = near.filter(|other| {
            pieces.get(other) != Some(&piece) && (file.nodes[other] - point).norm() <= cell
        });
        if let Some(first) = found.next() {
            same.insert(tag, *first);
        } else {
            at.entry([x, y, z]).or_default().push(tag);
        }
    }
    for node in file.blocks.iter_mut().flat_map(|block| block.nodes.iter_mut()) {
        *node = same.get(node).copied().unwrap_or(*node);
    }
    same.len()
}

/// The piece that each node of a cell is in.
fn pieces(file: &MshFile, dimension: usize) -> BTreeMap<u64, u64> {
    fn root(of: &mut BTreeMap<u64, u64>, tag: u64) -> u64 {
        let mut at = tag;
        while let Some(&next) = of.get(&at).filter(|next| **next != at) {
            let after = of.get(&next).copied().unwrap_or(next);
            of.insert(at, after);
            at = next;
        }
        at
    }
    let mut of: BTreeMap<u64, u64> = BTreeMap::new();
    for block in file.blocks.iter().filter(|block| block.kind.dimension == dimension) {
        for (_, nodes) in block.elements() {
            for node in nodes {
                of.entry(*node).or_insert(*node);
            }
            let first = root(&mut of, nodes[0]);
            for node in &nodes[1..] {
                let other = root(&mut of, *node);
                let first = root(&mut of, first);
                of.insert(first.max(other), first.min(other));
            }
        }
    }
    let tags: Vec<u64> = of.keys().copied().collect();
    tags.into_iter().map(|tag| (tag, root(&mut of, tag))).collect()
}

/// Whether all cells are in one piece.
///
/// # Errors
/// When they are not.
pub fn check_connected<const D: usize>(parts: &Parts<D>) -> Result<(), MshError> {
    let mut pieces: Vec<usize> = (0..parts.vertices.len()).collect();
    fn root(pieces: &mut [usize], mut at: usize) -> usize {
        while pieces[at] != at {
            pieces[at] = pieces[pieces[at]];
            at = pieces[at];
        }
        at
    }
    let mut n_pieces = pieces.len();
    for cell in &parts.cells {
        for vertex in &cell[1..] {
            let (one, other) = (root(&mut pieces, cell[0]), root(&mut pieces, *vertex));
            if one != other {
                pieces[one.max(other)] = one.min(other);
                n_pieces -= 1;
            }
        }
    }
    if n_pieces > 1 {
        let found = format!("{n_pieces} pieces that do not touch");
        return Err(MshError::of_mesh(
            found,
            "the fluid is in one piece: Coherence in Gmsh joins parts that have the same faces, if \
             they are meshed anew",
        ));
    }
    Ok(())
}
