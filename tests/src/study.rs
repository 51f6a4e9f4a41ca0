//! `Study`: errors over a sequence of cell sizes or steps, and the order fitted to them.

use std::panic::Location;

use crate::record;

/// Errors at several resolutions.
#[derive(Debug, Clone)]
pub struct Study {
    /// Cell sizes or time steps, decreasing.
    pub sizes: Vec<f64>,
    /// Error at each.
    pub errors: Vec<f64>,
}

impl Study {
    /// Runs `error` at each size.
    pub fn run(sizes: &[f64], error: impl FnMut(f64) -> f64) -> Self {
        Self { sizes: sizes.to_vec(), errors: sizes.iter().copied().map(error).collect() }
    }

    /// Slope of the least-squares line through (log size, log error).
    #[must_use]
    pub fn order(&self) -> f64 {
        let n = self.sizes.len() as f64;
        let x: Vec<f64> = self.sizes.iter().map(|size| size.ln()).collect();
        let y: Vec<f64> = self.errors.iter().map(|error| error.ln()).collect();
        let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
        let over: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        over / x.iter().map(|x| (x - mean_x).powi(2)).sum::<f64>()
    }

    /// Shows the order and the last error as figures of the file that calls, by a name of the study.
    ///
    /// # Panics
    /// When there are no errors.
    #[track_caller]
    pub fn record(&self, name: &str) {
        let module = Location::caller().file().trim_end_matches(".rs").replace('/', "::");
        println!("{name}: order {:.3}, errors {:?} at {:?}", self.order(), self.errors, self.sizes);
        record(&module, &format!("{name}: order"), self.order());
        let last = *self.errors.last().expect("there are errors");
        record(&module, &format!("{name}: last error"), last);
    }

    /// Fails unless the order is within `slack` of `expected`.
    ///
    /// # Panics
    /// When it is not.
    #[track_caller]
    pub fn assert_order(&self, name: &str, expected: f64, slack: f64) {
        self.record(name);
        assert!(
            (self.order() - expected).abs() <= slack,
            "{name}: order {:.3} where {expected} +- {slack} is expected; {self:?}",
            self.order()
        );
    }
}
