//! Times of recorded strokes in another unit than the case has.

use super::column::has_word;
use crate::model::numbers::significant;
use crate::read::files::stroke_file::RecordedStroke;
use crate::rules::Findings;
use crate::spec::units::Units;
use crate::{CaseFile, TimeSettings, Unsteady};

/// What times of a file are multiplied by to be in seconds, by a word in the name of their column.
const UNITS: [(&[&str], f64); 4] = [
    (&["s", "sec", "secs", "second", "seconds"], 1.0),
    (&["ms", "msec", "millis", "milliseconds"], 1e-3),
    (&["us", "µs", "usec", "micros", "microseconds"], 1e-6),
    (&["min", "minute", "minutes"], 60.0),
];

/// Length of a recording over that of the run from which on its unit of time is asked for: units are a thousand
/// apart, and a recording is hardly ten times as long or as short as what is made of it.
const MUCH_LONGER: f64 = 100.0;

/// Steps from row to row from which on the rows are as far apart as only another unit explains: recordings and
/// steps resolve the same motion.
const MANY_STEPS: f64 = 30.0;

/// Rows within the run of which the same is thought where the steps are not known.
const FEW_ROWS: f64 = 10.0;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    let TimeSettings::Unsteady(time) = &file.case().time else { return };
    for stroke in file.recorded.iter().filter(|stroke| !stroke.has_time_scale) {
        let column = &stroke.columns[0];
        let scale = by_name(column, &file.case().units);
        if let Some(scale) = scale.filter(|scale| *scale != 1.0) {
            let message = format!(
                "the times of column `{column}` are by its name in another unit than the case"
            );
            findings.warning(&stroke.key, message, &remedy(scale));
        } else if scale.is_none()
            && let Some(scale) = by_length(stroke, time)
        {
            let length = stroke.span[1] - stroke.span[0];
            let message = format!(
                "the {} rows of column `{column}` take {}, {} from one to the next, and the run ends at {}",
                stroke.n_rows,
                significant(length),
                significant(spacing(stroke)),
                significant(time.end)
            );
            findings.warning(&stroke.key, message, &remedy(scale));
        }
    }
}

fn remedy(scale: f64) -> String {
    format!(
        "write time_scale = {scale:?} in `file` if its times are in another unit than the case, and \
         time_scale = 1 if they are right as they are"
    )
}

/// What the times of a column are multiplied by, as far as its name has a unit.
fn by_name(column: &str, units: &Units) -> Option<f64> {
    let seconds = |word: &str| {
        let known = UNITS.iter().find(|(words, _)| has_word(word, words));
        known.map(|(_, seconds)| *seconds)
    };
    let of_case = match units {
        Units::Words(_) => 1.0,
        Units::Labels(labels) => labels.time.as_deref().map_or(Some(1.0), seconds)?,
    };
    let scale = seconds(column)? / of_case;
    // Powers of ten have a name that is short, too
    Some(if (scale.log10().round() - scale.log10()).abs() < 1e-9 {
        10_f64.powi(whole_power(scale))
    } else {
        scale
    })
}

fn whole_power(scale: f64) -> i32 {
    let powers = -9..=9;
    let near = |power: &i32| (scale / 10_f64.powi(*power) - 1.0).abs() < 1e-6;
    powers.into_iter().find(near).unwrap_or_default()
}

/// Time from one row to the next, on average (s).
fn spacing(stroke: &RecordedStroke) -> f64 {
    let intervals = stroke.n_rows.saturating_sub(1).max(1);
    (stroke.span[1] - stroke.span[0]) / intervals as f64
}

/// What the times of a recording would have to be multiplied by to be as long as the run and as fine as its steps,
/// where they are neither.
fn by_length(stroke: &RecordedStroke, time: &Unsteady) -> Option<f64> {
    let end = time.end;
    let length = stroke.span[1] - stroke.span[0].min(0.0);
    let (spacing, is_adaptive) = (spacing(stroke), time.adaptive.is_some());
    let is_coarse =
        if is_adaptive { spacing * FEW_ROWS >= end } else { spacing >= MANY_STEPS * time.step };
    if end <= 0.0 || length < MUCH_LONGER * end || !is_coarse {
        return None;
    }
    Some(if length * 1e-6 >= end { 1e-6 } else { 1e-3 })
}

#[cfg(test)]
mod tests {
    use super::by_name;
    use crate::spec::units::{UnitLabels, Units};

    #[test]
    fn columns_are_in_the_unit_of_their_name() {
        let plain = Units::default();
        let in_ms = Units::Labels(UnitLabels { time: Some("ms".to_owned()), ..Default::default() });
        let odd = Units::Labels(UnitLabels { time: Some("T".to_owned()), ..Default::default() });
        for (column, units, scale) in [
            ("t", &plain, None),
            ("time_ms", &plain, Some(1e-3)),
            ("time [s]", &plain, Some(1.0)),
            ("t_min", &plain, Some(60.0)),
            ("time_ms", &in_ms, Some(1.0)),
            ("t_s", &in_ms, Some(1e3)),
            ("t_ms", &odd, None),
        ] {
            assert_eq!(by_name(column, units), scale, "{column}");
        }
    }
}
