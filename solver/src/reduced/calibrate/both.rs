//! Loads and tracks of runs at once: the one says what forces are, the other what they lead to.

use alewife_reduced::tree::{Dual64, Fit, Residuals, TreeError, fit};

use super::error::CalibrateError;
use super::loads::Loads;
use super::record::Record;
use super::sought::Sought;
use super::tracks::motion;

/// Fits both, each by its mean square over its size, by the method of Gauss and Newton.
pub fn fitted(records: &[&Record], sought: &Sought, most: usize) -> Result<Fit, CalibrateError> {
    let both = Both { loads: Loads::new(records, sought)?, records, sought };
    Ok(fit(&both, &sought.start, &sought.bounds, most)?)
}

struct Both<'a> {
    loads: Loads<'a>,
    records: &'a [&'a Record],
    sought: &'a Sought,
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
