//! Loads and tracks of runs at once: the one says what forces are, the other what they lead to.

use alewife_reduced::tree::{Dual64, Residuals, TreeError};

use super::loads::Loads;
use super::record::Record;
use super::sought::Sought;
use super::tracks::motion;

/// Both of some runs, each by its mean square over its size.
pub struct Both<'a> {
    pub loads: Loads<'a>,
    pub records: &'a [&'a Record],
    pub sought: &'a Sought,
}

impl Residuals for Both<'_> {
    fn residuals(&self, parameters: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        let mut left = self.loads.left(parameters);
        let weight = 1.0 / (left.len().max(1) as f64).sqrt();
        left.iter_mut().for_each(|one| *one *= weight);
        let n_tracks: usize = self.records.iter().map(|record| record.tracks.len()).sum();
        for record in self.records {
            let made = motion(record, |body, own| self.sought.filled(body, own, parameters))?;
            for (track, made) in record.tracks.iter().zip(made) {
                let first = track.values[0];
                let size = track
                    .values
                    .iter()
                    .fold(f64::MIN_POSITIVE, |most, value| most.max((value - first).abs()));
                let n = (made.len() * n_tracks).max(1) as f64;
                let weight = 1.0 / (size * n.sqrt());
                left.extend(made.iter().zip(&track.values).map(|(a, b)| (*a - *b) * weight));
            }
        }
        Ok(left)
    }
}
