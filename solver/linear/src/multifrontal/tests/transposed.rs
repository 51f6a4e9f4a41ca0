//! Transposed solutions: b . A^-1 c = c . A^-T b, with delayed pivots in subtrees or without.

use super::*;

/// The largest difference of both sides for some vectors, over the sizes of solutions and right-hand sides; `None` where
/// there are no factors or the matrix is next to singular.
fn asymmetry(system: &System, ordering: Ordering) -> Option<f64> {
    let analysis = system.analyse(ordering);
    let mut factors = Factors::new(&analysis);
    factors.factorise(&analysis, &system.matrix).ok()?;
    let mut random = Random(7);
    let mut worst = 0.0f64;
    for _ in 0..3 {
        let [b, c] =
            [(), ()].map(|()| (0..system.n()).map(|_| random.next()).collect::<Vec<f64>>());
        let [mut transposed, mut plain] = [b.clone(), c.clone()];
        factors.solve_transposed(&analysis, &mut transposed);
        factors.solve(&analysis, &mut plain);
        let size: f64 = transposed.iter().chain(&plain).fold(0.0, |most, x| most.max(x.abs()));
        if !size.is_finite() || size > 1e7 {
            return None;
        }
        let dot = |one: &[f64], other: &[f64]| -> f64 {
            one.iter().zip(other).map(|(one, other)| one * other).sum()
        };
        worst = worst.max((dot(&b, &plain) - dot(&c, &transposed)).abs() / size.max(1.0));
        let left = system.matrix.transposed_residual(&transposed, &b).relative();
        worst = worst.max(left);
    }
    Some(worst)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2),
        ..ProptestConfig::default()
    })]

    #[test]
    fn transposed_solutions_are_adjoint_to_the_others(
        width in 1usize..9,
        height in 1usize..9,
        seed in any::<u64>(),
        hard in 0.0f64..1.2,
        n_dense in 0usize..4,
        minimum_degree in any::<bool>(),
        is_cut in any::<bool>(),
    ) {
        let system = saddle_point(width, height, seed, hard, n_dense).cut(is_cut);
        let ordering = if minimum_degree { Ordering::MinimumDegree } else { Ordering::Best };
        let found = asymmetry(&system, ordering);
        prop_assert!(system.n() == 0 || found.is_none_or(|found| found < 1e-8), "{found:?}");
    }
}

/// The matrix of `columns_without_pivots_of_their_own_are_delayed_to_the_root`.
#[test]
fn columns_that_subtrees_delay_come_back_as_rows() {
    let n = 40;
    let mut dense = vec![vec![0.0; n]; n];
    for i in 0..n {
        let (far, next) = ((i + n / 2) % n, (i + 1) % n);
        dense[i][far] = 1.0 + i as f64 * 0.1;
        dense[i][next] = 1e-9;
        dense[next][i] = 2e-9;
    }
    for is_cut in [false, true] {
        let system = System::new(&dense, nodes_of_their_own(n)).cut(is_cut);
        let found = asymmetry(&system, Ordering::MinimumDegree).unwrap();
        assert!(found < 1e-12, "{found:e}");
    }
}
