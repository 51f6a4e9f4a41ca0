//! Nested dissection by METIS, without its signal handlers.
#![expect(unsafe_code, reason = "METIS is a C library")]

use std::sync::Mutex;

use metis_sys as metis;

use super::graph::Graph;

/// METIS draws its random numbers from the C library's one generator.
static GENERATOR: Mutex<()> = Mutex::new(());

/// The vertices in the order of a nested dissection (@karypis1998), or `None` if METIS fails
/// or the graph is too large for it.
pub(super) fn nested_dissection(graph: &Graph) -> Option<Vec<u32>> {
    let _one_at_a_time = GENERATOR.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let to_idx = |values: &[u32]| -> Option<Vec<metis::idx_t>> {
        values.iter().map(|&value| metis::idx_t::try_from(value).ok()).collect()
    };
    let n = metis::idx_t::try_from(graph.n()).ok()?;
    let mut starts = to_idx(&graph.starts)?;
    let mut neighbours = to_idx(&graph.neighbours)?;
    let mut weights = to_idx(&graph.weights)?;
    let mut order: Vec<metis::idx_t> = vec![0; graph.n()];
    let mut rank: Vec<metis::idx_t> = vec![0; graph.n()];
    let mut sizes: [metis::idx_t; 1] = [0];
    let mut options: [metis::idx_t; metis::METIS_NOPTIONS as usize] =
        [0; metis::METIS_NOPTIONS as usize];
    // METIS_NodeND itself replaces the handlers of SIGTERM and SIGABRT while it runs. The entry
    // made for ParMETIS orders in the same way without touching them.
    //
    // SAFETY: the arrays have the lengths the manual asks for: n + 1 starts, as many neighbours
    // as the last start, n weights, vertices and ranks, 2 npes - 1 = 1 sizes.
    let status = unsafe {
        metis::METIS_SetDefaultOptions(options.as_mut_ptr());
        options[metis::moptions_et_METIS_OPTION_SEED as usize] = 1;
        options[metis::moptions_et_METIS_OPTION_COMPRESS as usize] = 0;
        metis::METIS_NodeNDP(
            n,
            starts.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            weights.as_mut_ptr(),
            1,
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            rank.as_mut_ptr(),
            sizes.as_mut_ptr(),
        )
    };
    if status != metis::rstatus_et_METIS_OK {
        return None;
    }
    order.into_iter().map(|vertex| u32::try_from(vertex).ok()).collect()
}
