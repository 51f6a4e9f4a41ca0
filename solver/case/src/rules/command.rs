//! Problems of `command`: limits that leave nothing, and filters that no step resolves.

use crate::rules::Findings;
use crate::{Command, TimeSettings};

/// Steps over the time constant of a filter above which you are warned: velocities are those at the ends of steps, which
/// feel a jump too weakly by a 12th of the square of this.
const LONGEST_STEP: f64 = 1.0;

/// Limits, start and filter of a command.
pub(crate) fn check_command(findings: &mut Findings<'_>, key: &str, command: &Command) {
    let Command { start, limits, filter, .. } = command;
    if let Some([least, most]) = limits {
        if least >= most {
            findings.error(
                &format!("{key}.limits"),
                format!("the limits go from {least} to {most}"),
                "write limits = [lowest, highest], the lowest below the highest",
            );
        } else if start < least || start > most {
            findings.error(
                &format!("{key}.start"),
                format!("the start, {start}, is not within the limits, {least} to {most}"),
                "start within the limits, or widen them",
            );
        }
    }
    match &findings.case().time {
        TimeSettings::Steady(_) => findings.error(
            key,
            "a steady solution knows no time, in which something could be asked for".to_owned(),
            "write a number in place of the command, or use [time.unsteady]",
        ),
        TimeSettings::Unsteady(time) => {
            let step = time.step;
            if *filter > 0.0 && time.adaptive.is_none() && step > LONGEST_STEP * filter {
                findings.warning(
                    &format!("{key}.filter"),
                    format!(
                        "a step of {step} is {:.1} times the filter of {filter}: it jumps over what is asked for",
                        step / filter
                    ),
                    "take a filter of some steps, or shorter steps",
                );
            }
        }
    }
}
