//! `SavedSeries`: the quantities of all steps so far.

use serde::{Deserialize, Serialize};

use crate::run::Series;

/// The quantities of all steps up to a state: statistics of a run that resumes are over all of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedSeries {
    names: Vec<String>,
    times: Vec<f64>,
    /// The bits of the values: some are infinite or no number, which JSON has no word for.
    rows: Vec<Vec<u64>>,
}

impl SavedSeries {
    pub(super) fn of(series: &Series) -> Self {
        let bits = |row: &Vec<f64>| row.iter().map(|value| value.to_bits()).collect();
        Self {
            names: series.names.clone(),
            times: series.times.clone(),
            rows: series.rows.iter().map(bits).collect(),
        }
    }

    pub(super) fn is_consistent(&self) -> bool {
        self.rows.len() == self.times.len()
            && self.rows.iter().all(|row| row.len() == self.names.len())
    }

    pub(super) fn series(&self) -> Series {
        let values = |row: &Vec<u64>| row.iter().copied().map(f64::from_bits).collect();
        Series {
            names: self.names.clone(),
            times: self.times.clone(),
            rows: self.rows.iter().map(values).collect(),
        }
    }
}
