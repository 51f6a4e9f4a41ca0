//! Fits of coefficients: linear ones within bounds, and those of motions by their exact derivatives.

use alewife_reduced::tree::{Bounds, Residuals, Scheme, Stepper, TreeError, fit, fit_linear, real};
use num_dual::Dual64;

use super::chains::Eel;

/// A table of numbers without a pattern.
fn noise(k: usize) -> f64 {
    ((k as f64 * 12.9898).sin() * 43_758.545_3).fract()
}

#[test]
fn a_linear_fit_finds_what_it_is_made_of_and_keeps_its_bounds() {
    let columns: Vec<Vec<f64>> =
        (0..3).map(|c| (0..40).map(|row| noise(40 * c + row)).collect()).collect();
    let truth = [1.5, 0.2, 3.0];
    let constant: Vec<f64> = (0..40)
        .map(|row| -columns.iter().zip(truth).map(|(column, t)| column[row] * t).sum::<f64>())
        .collect();
    let wide = [Bounds { lower: 0.0, upper: 10.0 }; 3];
    let found = fit_linear(&columns, &constant, &wide).expect("it has a solution");
    for (found, truth) in found.parameters.iter().zip(truth) {
        assert!((found - truth).abs() < 1e-9, "{found} {truth}");
    }
    // Within narrow bounds no single change makes the squares less
    let narrow = [
        Bounds { lower: 0.5, upper: 1.0 },
        Bounds { lower: 0.4, upper: 2.0 },
        Bounds { lower: 0.0, upper: 2.5 },
    ];
    let found = fit_linear(&columns, &constant, &narrow).expect("it has a solution");
    let cost = |at: &[f64]| {
        let left = |row: usize| {
            constant[row] + columns.iter().zip(at).map(|(c, a)| c[row] * a).sum::<f64>()
        };
        0.5 * (0..40).map(|row| left(row).powi(2)).sum::<f64>()
    };
    assert!((cost(&found.parameters) - found.cost).abs() < 1e-12);
    for k in 0..3 {
        for by in [-1e-3, 1e-3] {
            let mut other = found.parameters.clone();
            other[k] = (other[k] + by).clamp(narrow[k].lower, narrow[k].upper);
            assert!(cost(&other) >= found.cost - 1e-14, "{k} {by}");
        }
    }
}

#[test]
fn what_is_undetermined_is_told() {
    let column: Vec<f64> = (0..10).map(noise).collect();
    let twice = vec![column.clone(), column.iter().map(|x| 2.0 * x).collect()];
    let constant: Vec<f64> =
        column.iter().enumerate().map(|(k, x)| -3.0 * x + 0.1 * noise(k + 99)).collect();
    let found = fit_linear(&twice, &constant, &[Bounds { lower: -9.0, upper: 9.0 }; 2]);
    let found = found.expect("it has solutions");
    assert!(found.uncertainties.iter().all(|one| *one > 1e3), "{:?}", found.uncertainties);
    let sum = found.parameters[0] + 2.0 * found.parameters[1];
    let once = fit_linear(&twice[..1], &constant, &[Bounds { lower: -9.0, upper: 9.0 }]);
    let once = once.expect("it has a solution");
    assert!((sum - once.parameters[0]).abs() < 1e-6 && once.uncertainties[0] < 0.1);
}

/// The tracks of an eel with coefficients that are to be found again: synthetic data.
struct Tracks(Vec<f64>, Option<f64>);

fn track<T: alewife_reduced::tree::Number>(c: [T; 3]) -> Result<Vec<T>, TreeError> {
    let [normal, along, amplitude] = c;
    let number = |value: f64| T::from(value);
    let eel =
        Eel::of([number(1.0), number(4.0), normal, number(2.0), along, amplitude, number(1.6)], 3);
    let tree = eel.tree();
    let mut state = tree.rest();
    let mut stepper = Stepper::new(&tree, Scheme::Midpoint);
    let mut track = Vec::new();
    for k in 0..75 {
        let command = |time: f64, link: usize| eel.command(time, link);
        stepper.step(&tree, &mut state, real(0.02), &command)?;
        if k % 5 == 4 {
            track.extend([state.root.position.x, state.root.position.y, state.root.heading()]);
        }
    }
    Ok(track)
}

impl Residuals for Tracks {
    fn residuals(&self, p: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        let found = track([p[0], p[1], p[2]])?;
        Ok(found.iter().zip(&self.0).map(|(found, seen)| *found - *seen).collect())
    }

    fn differences(&self) -> Option<f64> {
        self.1
    }
}

#[test]
fn coefficients_and_gait_are_found_again_from_tracks() {
    let truth = [2.3, 0.4, 0.45];
    let seen = Tracks(track(truth).expect("it swims"), None);
    let bounds = [
        Bounds { lower: 0.0, upper: 20.0 },
        Bounds { lower: 0.0, upper: 5.0 },
        Bounds { lower: 0.2, upper: 0.9 },
    ];
    let found = fit(&seen, &[5.0, 0.1, 0.6], &bounds, 60).expect("it starts");
    for (found, truth) in found.parameters.iter().zip(truth) {
        assert!((found / truth - 1.0).abs() < 1e-6, "{found} {truth}");
    }
    let outside = fit(&seen, &[25.0, 0.1, 0.6], &bounds, 60);
    assert!(matches!(outside, Err(TreeError::Given(_))));
    assert!(found.cost.sqrt() < 1e-8 && found.steps < 60);
}

/// Residuals whose derivatives are of no use, as those of a motion that forgets how it began.
struct Forgets(Tracks);

impl Residuals for Forgets {
    fn residuals(&self, p: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        let wild = |one: Dual64| Dual64::new(one.re, f64::INFINITY);
        Ok(self.0.residuals(p)?.into_iter().map(wild).collect())
    }

    fn differences(&self) -> Option<f64> {
        self.0.1
    }
}

#[test]
fn differences_find_what_derivatives_without_end_do_not() {
    let (truth, start) = ([2.3, 0.4, 0.45], [5.0, 0.1, 0.6]);
    let bounds = [
        Bounds { lower: 0.0, upper: 20.0 },
        Bounds { lower: 0.0, upper: 5.0 },
        Bounds { lower: 0.2, upper: 0.9 },
    ];
    let found = |differences: Option<f64>| {
        let seen = Tracks(track(truth).expect("it swims"), differences);
        fit(&Forgets(seen), &start, &bounds, 60).expect("it starts")
    };
    for (found, truth) in found(Some(0.02)).parameters.iter().zip(truth) {
        assert!((found / truth - 1.0).abs() < 1e-4, "{found} {truth}");
    }
    assert_eq!(found(None).parameters, start);
    // At a bound they go inside alone
    let seen = Tracks(track(truth).expect("it swims"), Some(0.02));
    let at_bounds = fit(&seen, &[20.0, 5.0, 0.9], &bounds, 60).expect("it starts");
    assert!(at_bounds.cost < 1e-6, "{at_bounds:?}");
}
