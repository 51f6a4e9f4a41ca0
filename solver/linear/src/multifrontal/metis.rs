//! METIS, called so that it leaves the signals of the process alone.
#![expect(unsafe_code, reason = "METIS is a C library")]

use std::sync::Mutex;

use metis_sys as metis;

use super::graph::Graph;

/// METIS draws its random numbers from the C library's one generator.
static GENERATOR: Mutex<()> = Mutex::new(());

/// The vertices in the order of a nested dissection (@karypis1998), or `None` if METIS fails.
pub(super) fn nested_dissection(graph: &Graph) -> Option<Vec<u32>> {
    let _one_at_a_time = GENERATOR.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let n = graph.n() as metis::idx_t;
    let to_idx = |values: &[u32]| values.iter().map(|&value| value as metis::idx_t).collect();
    let mut starts: Vec<metis::idx_t> = to_idx(&graph.starts);
    let mut neighbours: Vec<metis::idx_t> = to_idx(&graph.neighbours);
    let mut weights: Vec<metis::idx_t> = to_idx(&graph.weights);
    let mut order = vec![0 as metis::idx_t; graph.n()];
    let mut place = vec![0 as metis::idx_t; graph.n()];
    let mut sizes = [0 as metis::idx_t; 1];
    let mut options = [0 as metis::idx_t; metis::METIS_NOPTIONS as usize];
    // METIS_NodeND itself replaces the handlers of SIGTERM and SIGABRT while it runs. The entry
    // made for ParMETIS orders in the same way without touching them.
    //
    // SAFETY: the arrays have the lengths the manual asks for: n + 1 starts, as many neighbours
    // as the last start, n weights, orders and places, 2 npes - 1 = 1 sizes.
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
            place.as_mut_ptr(),
            sizes.as_mut_ptr(),
        )
    };
    (status == metis::rstatus_et_METIS_OK)
        .then(|| order.into_iter().map(|vertex| vertex as u32).collect())
}
