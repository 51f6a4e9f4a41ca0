//! The cut of the tree of supernodes into subtrees that are factorised in parallel.

use super::tree::{Supernode, flops};
use crate::sparse::index::to_u32;

/// A subtree is cut off when it takes less than this part of all arithmetic.
const SUBTREE_SHARE: f64 = 1.0 / 24.0;
/// Matrices with less arithmetic are one subtree.
pub(in super::super) const MIN_PARALLEL_FLOPS: f64 = 2e7;

/// A tree of supernodes in which each subtree is contiguous and the supernodes above come last.
#[derive(Debug)]
pub(super) struct CutTree {
    pub supernodes: Vec<Supernode>,
    /// Number of supernodes of each subtree.
    pub subtree_sizes: Vec<usize>,
    /// Number of supernodes above the subtrees.
    pub n_above: usize,
}

impl CutTree {
    /// Cuts a tree, given in postorder, if it takes `least` arithmetic; the cut does not depend on the number
    /// of threads.
    pub fn new(supernodes: Vec<Supernode>, least: f64) -> Self {
        let n = supernodes.len();
        let mut total_flops = vec![0.0; n];
        let mut size = vec![1usize; n];
        for (index, node) in supernodes.iter().enumerate() {
            total_flops[index] += flops(node.k, node.r);
            if let Some(parent) = node.parent {
                let below = total_flops[index];
                total_flops[parent as usize] += below;
                size[parent as usize] += size[index];
            }
        }
        let roots = (0..n).filter(|&index| supernodes[index].parent.is_none());
        let all: f64 = roots.map(|index| total_flops[index]).sum();
        let limit = if all < least { f64::INFINITY } else { all * SUBTREE_SHARE };
        let is_in_subtree = |index: usize| total_flops[index] <= limit;
        let mut sequence = Vec::with_capacity(n);
        let mut subtree_sizes = Vec::new();
        for root in 0..n {
            let parent = supernodes[root].parent;
            if is_in_subtree(root) && !parent.is_some_and(|parent| is_in_subtree(parent as usize)) {
                // In postorder a subtree ends with its root.
                sequence.extend(root + 1 - size[root]..=root);
                subtree_sizes.push(size[root]);
            }
        }
        let n_above = n - sequence.len();
        sequence.extend((0..n).filter(|&index| !is_in_subtree(index)));
        Self { supernodes: reordered(supernodes, &sequence), subtree_sizes, n_above }
    }
}

/// Supernodes in the order of a sequence, with the parents they had.
fn reordered(supernodes: Vec<Supernode>, sequence: &[usize]) -> Vec<Supernode> {
    let mut index_of = vec![0u32; sequence.len()];
    for (index, &node) in (0..to_u32(sequence.len())).zip(sequence) {
        index_of[node] = index;
    }
    let mut supernodes: Vec<Option<Supernode>> = supernodes.into_iter().map(Some).collect();
    let take = |&node: &usize| {
        let mut node = supernodes[node].take().expect("each supernode is taken once");
        node.parent = node.parent.map(|parent| index_of[parent as usize]);
        node
    };
    sequence.iter().map(take).collect()
}
