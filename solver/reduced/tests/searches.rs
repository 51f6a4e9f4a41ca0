//! Searches: as good as the method they port, exact at bounds, taken up with the same bits, and clear when wrong.

use alewife_reduced::search::{Bounded, Ended, Evaluated, Search, SearchError, minimise};

fn parameters(n: usize, lower: f64, upper: f64, start: f64) -> Vec<Bounded> {
    let name = |k: usize| format!("x{k}");
    let of = |k| Bounded { name: name(k), start, lower, upper, scale: Some(1.0) };
    (0..n).map(of).collect()
}

/// Rosenbrock's function of many numbers.
fn rosenbrock(x: &[f64]) -> Evaluated {
    let mut slopes = vec![0.0; x.len()];
    let mut objective = 0.0;
    for k in 0..x.len() - 1 {
        let (a, b) = (x[k + 1] - x[k] * x[k], 1.0 - x[k]);
        objective += 100.0 * a * a + b * b;
        slopes[k] += -400.0 * x[k] * a - 2.0 * b;
        slopes[k + 1] += 200.0 * a;
    }
    Evaluated { values: x.to_vec(), objective, slopes }
}

fn exact() -> Search {
    Search { max_evaluations: 500, decrease: 1e-13, slope: 1e-9, known: Vec::new() }
}

#[test]
fn the_search_is_as_good_as_that_of_scipy() {
    // SciPy 1.16's L-BFGS-B with the same tolerances: the optimum at the bound, and its evaluations
    for (upper, optimum, n_of_scipy) in [(0.6, 7.197_513_133_907_655, 27), (2.0, 0.0, 81)] {
        let parameters = parameters(10, -1.5, upper, -0.5);
        let found =
            minimise(&parameters, &exact(), |x| Ok::<_, String>(rosenbrock(x))).expect("it starts");
        println!("{upper}: {} evaluations, {:e}", found.all.len(), found.best.objective);
        assert_eq!(found.ended, Ended::Converged);
        assert!((found.best.objective - optimum).abs() < 1e-9 * (1.0 + optimum));
        assert!(found.all.len() <= n_of_scipy * 5 / 4, "{}", found.all.len());
        assert!(found.best.values.iter().all(|x| *x <= upper));
        assert_eq!(found.best.values[0] == upper, upper < 1.0);
    }
}

#[test]
fn a_search_that_was_stopped_goes_on_with_the_same_bits() {
    let parameters = parameters(4, -1.5, 2.0, -0.5);
    let whole =
        minimise(&parameters, &exact(), |x| Ok::<_, String>(rosenbrock(x))).expect("it starts");
    let short = Search { max_evaluations: 9, ..exact() };
    let first =
        minimise(&parameters, &short, |x| Ok::<_, String>(rosenbrock(x))).expect("it starts");
    assert_eq!(first.ended, Ended::Evaluations);
    assert_eq!(first.all.len(), 9);
    let mut n_new = 0;
    let next = Search { known: first.all.clone(), ..exact() };
    let second = minimise(&parameters, &next, |x| {
        n_new += 1;
        Ok::<_, String>(rosenbrock(x))
    })
    .expect("it starts");
    assert_eq!(second, whole);
    assert_eq!(n_new, whole.all.len() - 9);
}

#[test]
fn a_search_that_fails_has_its_best_point_and_says_why() {
    let parameters = parameters(2, -1.5, 2.0, -0.5);
    let mut n = 0;
    let found = minimise(&parameters, &exact(), |x| {
        n += 1;
        if n > 5 { Err("the body broke") } else { Ok(rosenbrock(x)) }
    })
    .expect("it starts");
    assert_eq!(found.ended, Ended::Failed("the body broke".to_owned()));
    let least = found.all.iter().map(|found| found.objective).fold(f64::MAX, f64::min);
    assert_eq!(found.best.objective, least);
    let at_once = minimise(&parameters, &exact(), |_| Err("no"));
    assert_eq!(at_once, Err(SearchError::Start("no".to_owned())));
}

#[test]
fn bounds_that_do_not_fit_are_refused() {
    let good = Bounded { name: "E".to_owned(), start: 5e4, lower: 1e4, upper: 1e6, scale: None };
    for (wrong, says) in [
        (
            Bounded { start: 5e3, ..good.clone() },
            "E: the start 5000 is not between the bounds 10000",
        ),
        (
            Bounded { lower: f64::NAN, ..good.clone() },
            "E: the bounds NaN and 1000000 and the start",
        ),
        (Bounded { lower: 0.0, ..good.clone() }, "E: without a scale the logarithm is searched"),
        (Bounded { scale: Some(0.0), ..good.clone() }, "E: the scale 0 is not positive"),
    ] {
        let said = minimise(&[wrong], &exact(), |x| Ok::<_, String>(rosenbrock(x)))
            .expect_err("it is wrong");
        assert!(said.to_string().starts_with(says), "{said}");
    }
}
