//! `Schedule`: whether a step is one of those the case wants written.

use crate::case::Cadence;

/// A cadence and what it has seen so far.
#[derive(Debug, Clone, Copy)]
pub struct Schedule {
    cadence: Cadence,
    last_multiple: Option<i64>,
}

impl Schedule {
    /// A schedule that has seen nothing yet, or all up to the time (s) at which a run resumes.
    pub fn new(cadence: Cadence, resumed_at: Option<f64>) -> Self {
        let mut schedule = Self { cadence, last_multiple: None };
        if let Some(time) = resumed_at {
            schedule.is_due(0, time, false);
        }
        schedule
    }

    /// Whether this step is written. Ask once for each step.
    pub fn is_due(&mut self, step: usize, time: f64, is_last: bool) -> bool {
        match self.cadence {
            Cadence::Never => false,
            Cadence::End => is_last,
            Cadence::Steps(every) => is_last || step.is_multiple_of(every.max(1)),
            Cadence::Time(every) => {
                // A time one rounding error short of a multiple is that multiple.
                #[expect(clippy::cast_possible_truncation, reason = "saturates, and stays due")]
                let multiple = (time / every * (1.0 + 1e-12) + 1e-9).floor() as i64;
                let is_new = self.last_multiple.is_none_or(|last| multiple > last);
                self.last_multiple = Some(multiple);
                is_last || is_new
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_a_time_are_met_once_each_in_spite_of_rounding() {
        let mut schedule = Schedule::new(Cadence::Time(0.3), None);
        let due: Vec<usize> =
            (0..=10).filter(|&step| schedule.is_due(step, step as f64 * 0.1, false)).collect();
        assert_eq!(due, [0, 3, 6, 9]);
    }

    #[test]
    fn a_resumed_schedule_goes_on_where_it_was() {
        let mut schedule = Schedule::new(Cadence::Time(0.3), Some(0.4));
        let due: Vec<usize> =
            (5..=10).filter(|&step| schedule.is_due(step, step as f64 * 0.1, false)).collect();
        assert_eq!(due, [6, 9]);
    }

    #[test]
    fn the_last_step_is_written_unless_never() {
        assert!(Schedule::new(Cadence::Steps(7), None).is_due(3, 0.0, true));
        assert!(Schedule::new(Cadence::End, None).is_due(3, 0.0, true));
        assert!(!Schedule::new(Cadence::Never, None).is_due(3, 0.0, true));
    }
}
