//! `Open`: what of a midline is given by strokes of any kind, of which later parts may not be known yet.

use crate::case::Stroke;
use crate::gait::number::Number;

/// Intervals over which rates are integrated, in a period and in the time constant of a filter.
const OF_PERIOD: f64 = 16.0;
const OF_FILTER: f64 = 0.5;

/// Strokes in a midline.
#[derive(Debug, Clone)]
pub struct Open {
    strokes: Vec<Stroke>,
    /// Longest time (s) over which they are smooth enough for one Gauss rule.
    pub longest: f64,
}

impl Open {
    /// Of strokes of which one at least has no period in common with a gait of this one (s).
    pub fn new(strokes: Vec<Stroke>, period: f64) -> Self {
        let filters = strokes.iter().filter_map(Stroke::command).map(|one| one.filter / OF_FILTER);
        let periods = strokes.iter().filter_map(Stroke::period).map(|period| period / OF_PERIOD);
        let longest = filters.chain(periods).fold(period / OF_PERIOD, f64::min);
        Self { strokes, longest }
    }

    /// Times at which derivatives jump (s), ascending, as far as they are known.
    pub fn kinks(&self) -> Vec<f64> {
        let commands = self.strokes.iter().filter_map(Stroke::command);
        let mut kinks: Vec<f64> = commands.flat_map(|command| command.kinks()).collect();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        kinks
    }
}

/// A stroke at a time (s), with its rate.
pub fn stroke_at<D: Number>(stroke: &Stroke, time: D) -> D {
    let [value, rate] = stroke.at(time.re());
    (time - time.re()) * rate + value
}
