//! Factorisations that are to end: they do, wherever they are, and leave memory that serves the next one.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering as Atomic};

use alewife_interrupt::{Listener, Stopped, hearing};

use super::super::dense::{LONG, Panel, PanelShape, columns_at_once};
use super::*;

/// Factorises, hearing a request that is made from some question on, and counts the questions.
fn factorised(
    factors: &mut Factors,
    analysis: &Analysis,
    matrix: &SparseMatrix,
    made_at: usize,
) -> (Result<(), NoFactors>, usize) {
    let asked = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&asked);
    let request = move || counted.fetch_add(1, Atomic::Relaxed) + 1 >= made_at;
    let heard = hearing(Arc::new(request), || factors.factorise(analysis, matrix));
    assert_eq!(heard.was_ended, heard.result.is_err());
    (heard.result, asked.load(Atomic::Relaxed))
}

#[test]
fn a_factorisation_ends_wherever_it_is_asked_to() {
    let b: Vec<f64> = (0..2000).map(|i| f64::from(i).sin()).collect();
    for is_cut in [true, false] {
        // Pivots are delayed, too
        let system = saddle_point(24, 24, 5, 1.2, 3).cut(is_cut);
        let analysis = system.analyse(Ordering::Best);
        let mut factors = Factors::new(&analysis);
        let solved = |factors: &mut Factors| {
            let mut x = b[..system.n()].to_vec();
            factors.solve(&analysis, &mut x);
            x
        };
        assert_eq!(factorised(&mut factors, &analysis, &system.matrix, usize::MAX).0, Ok(()));
        let expected = solved(&mut factors);
        let mut n_stopped = 0;
        for made_at in 1..100 {
            let (result, asked) = factorised(&mut factors, &analysis, &system.matrix, made_at);
            if asked < made_at {
                assert_eq!(result, Ok(()));
                break;
            }
            assert_eq!(result, Err(Stopped.into()), "at question {made_at}");
            factors.factorise(&analysis, &system.matrix).unwrap();
            assert_eq!(solved(&mut factors), expected, "after question {made_at}");
            n_stopped += 1;
        }
        assert!(n_stopped > 2, "{n_stopped}");
    }
}

#[test]
fn columns_of_a_panel_worked_on_by_and_by_have_the_same_bits() {
    let (rows, half, others) = (700, 160, 500);
    let mut random = Random(3);
    let mut values = |n: usize| (0..n).map(|_| random.next()).collect::<Vec<f64>>();
    let (left, right) = (values(rows * half), values(rows * others));
    let listener = Listener::default();
    let shape = PanelShape { rows, columns: half + others, stride: rows };
    let panel = Panel { arch: pulp::Arch::new(), listener: &listener, shape };
    let mut whole = right.clone();
    panel.eliminate(&left, half, &mut whole, others);
    // A front that takes so long that it is divided into three parts
    let columns = columns_at_once(others, LONG / others * 2 + 1);
    assert_eq!(columns, 168);
    for columns in [columns, 96, 250] {
        let mut parts = right.clone();
        for some in parts.chunks_mut(columns * rows) {
            let n = some.len() / rows;
            panel.eliminate(&left, half, some, n);
        }
        let differ = parts.iter().zip(&whole).filter(|(part, whole)| part != whole).count();
        assert_eq!(differ, 0, "by {columns} columns");
    }
}
