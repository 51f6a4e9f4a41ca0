//! Fill-reducing orders of the graph of mesh nodes: nested dissection by METIS, or minimum degree.

mod graph;
#[cfg(feature = "metis")]
mod metis;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

pub(super) use self::graph::{Graph, Vertices};

/// How the unknowns are ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ordering {
    /// Nested dissection where the program was built with METIS, else minimum degree.
    #[default]
    Best,
    /// Approximate minimum degree (@amestoy2004), in faer.
    MinimumDegree,
}

/// Graphs with fewer vertices are ordered by minimum degree in any case.
#[cfg(feature = "metis")]
const SMALL: usize = 64;

/// The vertices in the order in which they are eliminated.
pub(super) fn order(
    graph: &Graph,
    #[cfg_attr(not(feature = "metis"), expect(unused_variables, reason = "there is one"))]
    ordering: Ordering,
) -> Vec<u32> {
    #[cfg(feature = "metis")]
    if ordering == Ordering::Best
        && graph.n() > SMALL
        && let Some(order) = self::metis::nested_dissection(graph)
    {
        return order;
    }
    minimum_degree(graph)
}

fn minimum_degree(graph: &Graph) -> Vec<u32> {
    let n = graph.n();
    let matrix = SymbolicSparseColMatRef::new_checked(n, n, &graph.starts, None, &graph.neighbours);
    let mut order = vec![0u32; n];
    let mut rank = vec![0u32; n];
    let n_entries = graph.neighbours.len();
    let mut memory = MemBuffer::new(amd::order_maybe_unsorted_scratch::<u32>(n, n_entries));
    amd::order_maybe_unsorted(
        &mut order,
        &mut rank,
        matrix,
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .expect("the graph fits its index type");
    order
}
