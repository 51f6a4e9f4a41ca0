//! Problems of `[[reference]]` and `[statistics]`: quantities, statistics and tolerances.

use std::collections::HashSet;

use super::Findings;
use crate::quantity::{Condition, conditions_of, is_of_a_side, known_quantities, renamed};
use crate::text::nearest::nearest;
use crate::text::type_error::suggestion;
use crate::{
    Expected, Geometry, Reference, ReferenceKind, Statistic, StatisticKind, TimeSettings,
    Uncertainty, significant,
};

/// Part of a number that is taken for rounding.
const ROUNDING: f64 = 1e-9;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let known = known_quantities(findings.model());
    let end = match &case.time {
        TimeSettings::Steady(_) => None,
        // An end that is none is refused, and nothing is after it
        TimeSettings::Unsteady(time) => Some(time.end).filter(|end| *end > 0.0),
    };
    if let Some([start, stop]) = case.statistics.window {
        if start < 0.0 || stop <= start {
            findings.error(
                "statistics.window",
                format!("the window from {start} to {stop} is not within the run"),
                "write window = [start, end] with 0 <= start < end <= time.unsteady.end",
            );
        } else if let Some(end) = end.filter(|end| is_beyond(stop, *end)) {
            findings.warning(
                "statistics.window",
                format!("the window goes from {start} to {stop}, and the run ends at {end}"),
                "what is taken over the window is not computed; run on, or lower its end",
            );
        }
    }
    if let Some(quantity) = &case.statistics.phase_of {
        check_quantity(findings, "statistics.phase_of", quantity, &known);
    }
    for (index, reference) in case.reference.iter().enumerate() {
        let key = format!("reference.{index}");
        let Reference { statistic, expected } = reference;
        check_quantity(findings, &format!("{key}.quantity"), &statistic.quantity, &known);
        for (name, other) in [("minus", &statistic.minus), ("of", &statistic.of)] {
            if let Some(other) = other {
                check_quantity(findings, &format!("{key}.{name}"), other, &known);
            }
        }
        if statistic.minus.as_ref() == Some(&statistic.quantity) {
            findings.error(
                &format!("{key}.minus"),
                format!("`{}` less itself is 0", statistic.quantity),
                "name another quantity, or leave `minus` out",
            );
        }
        check_tolerance(findings, &key, reference);
        check_evidence(findings, &key, expected);
        check_statistic(findings, &key, statistic, end);
        if expected.source.trim().is_empty() {
            findings.error(
                &format!("{key}.source"),
                "the source of a reference is empty".to_owned(),
                "say who published the value and where, or how it follows",
            );
        }
    }
}

/// Whether a time is after the end of the run (s) by more than rounding: a run may be cut short.
fn is_beyond(time: f64, end: f64) -> bool {
    time > end * (1.0 + ROUNDING)
}

/// Whether the value says how certain it is, and a regression when it was made.
fn check_evidence(findings: &mut Findings<'_>, key: &str, expected: &Expected) {
    let is_regression = expected.kind == ReferenceKind::Regression;
    if let Some(uncertainty) = expected.uncertainty {
        check_uncertainty(findings, &format!("{key}.uncertainty"), expected, uncertainty);
    } else if is_regression {
        findings.error(
            key,
            "a regression does not say how certain its value is".to_owned(),
            "add uncertainty = \"... %\": what a finer mesh and a shorter step change",
        );
    }
    match &expected.date {
        Some(_) if !is_regression => findings.error(
            &format!("{key}.date"),
            format!(
                "`date` goes with the kind \"regression\" only, not \"{}\"",
                expected.kind.name()
            ),
            "leave it out",
        ),
        Some(date) if !is_date(date) => findings.error(
            &format!("{key}.date"),
            format!("`{date}` is no date"),
            "write date = \"year-month-day\", such as \"2026-01-31\"",
        ),
        None if is_regression => findings.error(
            key,
            "a regression does not say when its value was computed".to_owned(),
            "add date = \"year-month-day\"",
        ),
        _ => {}
    }
    for (name, reason, what) in [
        ("outside", &expected.outside, "is known to be outside"),
        ("cause", &expected.cause, "differs by more than is uncertain"),
    ] {
        if reason.as_ref().is_some_and(|reason| reason.trim().is_empty()) {
            findings.error(
                &format!("{key}.{name}"),
                format!("the reason why the value {what} is empty"),
                &format!("say why, or leave `{name}` out"),
            );
        }
    }
}

/// Whether an uncertainty can be read in one way only, and is not above the tolerance.
fn check_uncertainty(
    findings: &mut Findings<'_>,
    key: &str,
    expected: &Expected,
    uncertainty: Uncertainty,
) {
    let value = expected.value;
    match (uncertainty, expected.relative) {
        (Uncertainty::Absolute(size), Some(_)) => {
            let share = 100.0 * size / value.abs();
            findings.error(
                key,
                "a plain number beside `relative` may be meant in the unit of the value or relative \
                 to it"
                    .to_owned(),
                &format!(
                    "write per cent of the value: \"{} %\" if {size} is in its unit, \"{} %\" if \
                     it is relative",
                    significant(share),
                    significant(100.0 * size)
                ),
            );
            return;
        }
        (Uncertainty::Percent(_), _) if value == 0.0 => {
            let help = "write a number in the unit of the value";
            findings.error(key, "per cent of 0 are 0".to_owned(), help);
            return;
        }
        _ => {}
    }
    let relative = expected.relative.map(|relative| relative * value.abs());
    let tolerance = relative.or(expected.absolute).unwrap_or(f64::INFINITY);
    let size = uncertainty.of(value);
    if !(size >= 0.0 && size <= tolerance * (1.0 + ROUNDING)) {
        let of = expected.relative.map_or_else(
            || tolerance.to_string(),
            |relative| format!("{} %", significant(100.0 * relative)),
        );
        findings.error(
            key,
            format!("the uncertainty {uncertainty} is not within 0 and the tolerance {of}"),
            "write an uncertainty that is not negative, and a tolerance that is not below it",
        );
    }
}

/// Whether a text is a day written as year-month-day.
fn is_date(text: &str) -> bool {
    let numbers: Vec<Option<u32>> = text
        .split('-')
        .map(|part| part.chars().all(|c| c.is_ascii_digit()).then(|| part.parse().ok()).flatten())
        .collect();
    let has_form = text.len() == 10 && text.as_bytes()[4] == b'-' && text.as_bytes()[7] == b'-';
    has_form
        && matches!(numbers[..], [Some(_), Some(month), Some(day)]
            if (1..=12).contains(&month) && (1..=31).contains(&day))
}

/// Whether a case has a quantity.
pub fn check_quantity(findings: &mut Findings<'_>, key: &str, quantity: &str, known: &[String]) {
    if known.iter().any(|name| name == quantity) {
        return;
    }
    let conditions = conditions_of(quantity);
    let needs = |condition: Condition| conditions.iter().any(|all| *all == [condition]);
    let help = if let Some(new) = renamed(quantity) {
        format!("it is called `{new}`")
    } else if needs(Condition::Scales) && !findings.case().has_coefficients() {
        "coefficients need [scales] with length and velocity, and a fluid density".to_owned()
    } else if quantity.ends_with("lighthill_efficiency") {
        "this efficiency needs `resistance` of the [[swimmer]]".to_owned()
    } else if needs(Condition::Cycles) {
        "cycles need an unsteady run and a period: that of a stroke or gait, or `period` of the \
         [[swimmer]]"
            .to_owned()
    } else if is_of_a_side(findings.model(), quantity) {
        "periodic sides and the axis have no quantities".to_owned()
    } else {
        known_help(quantity, known)
    };
    findings.error(key, format!("there is no quantity `{quantity}`"), &help);
}

/// What is known of the owner a quantity names, or the owners there are: not all quantities of a case.
fn known_help(quantity: &str, known: &[String]) -> String {
    let (owner, name) = quantity.split_once('.').unwrap_or((quantity, ""));
    let begin = format!("{owner}.");
    let own: Vec<&str> = known.iter().filter_map(|one| one.strip_prefix(begin.as_str())).collect();
    if own.is_empty() {
        let mut seen = HashSet::new();
        let owners = known.iter().filter_map(|one| one.split('.').next());
        let owners: Vec<&str> = owners.filter(|owner| seen.insert(*owner)).collect();
        let help = suggestion(owner, &owners);
        return match nearest(quantity, known) {
            Some(near) => {
                format!("did you mean `{near}`? owners of quantities: {}", owners.join(", "))
            }
            None => help.replace("accepted:", "owners of quantities:"),
        };
    }
    // The last step of a longer name is what is remembered of it
    let end = format!(".{name}");
    let meant = own.iter().find(|one| !name.is_empty() && one.ends_with(&end));
    let near = meant.copied().or_else(|| nearest(name, &own));
    let near = near.map_or(String::new(), |near| format!("did you mean `{owner}.{near}`? "));
    format!("{near}`{owner}` has {}", own.join(", "))
}

fn check_tolerance(findings: &mut Findings<'_>, key: &str, reference: &Reference) {
    match (reference.expected.relative, reference.expected.absolute) {
        (Some(_), Some(_)) => findings.error(
            &format!("{key}.absolute"),
            "both `relative` and `absolute` are given".to_owned(),
            "keep the one that decides",
        ),
        (None, None) => findings.error(
            key,
            format!("the reference for `{}` has no tolerance", reference.statistic.quantity),
            "add relative = ... (a fraction of the value) or absolute = ...",
        ),
        (Some(_), None) if reference.expected.value == 0.0 => findings.error(
            &format!("{key}.relative"),
            "no value but 0 is near 0 in relative terms".to_owned(),
            "write absolute = ... instead",
        ),
        _ => {}
    }
}

fn check_statistic(findings: &mut Findings<'_>, key: &str, taken: &Statistic, end: Option<f64>) {
    use StatisticKind::{
        At, Crossing, HalfPeriodAfterMax, MorisonDrag, MorisonInertia, Strouhal, When,
    };
    let case = findings.case();
    let statistic = format!("{key}.statistic");
    let is_any = |list: &[StatisticKind]| list.contains(&taken.kind);
    check_arguments(findings, key, taken);
    if taken.kind == At
        && let Some(at) = taken.at
    {
        if at < 0.0 {
            findings.error(
                &format!("{key}.at"),
                format!("the time {at} is not within the run"),
                "write a time between 0 and time.unsteady.end",
            );
        } else if let Some(end) = end.filter(|end| is_beyond(at, *end)) {
            findings.warning(
                &format!("{key}.at"),
                format!("the time {at} is after the end of the run at {end}"),
                "the value is not computed; run on, or take the reference out",
            );
        }
    }
    let lacking = if is_any(&[Strouhal, HalfPeriodAfterMax]) {
        Some("period")
    } else if is_any(&[Crossing, When, MorisonDrag, MorisonInertia]) {
        Some("course in time")
    } else {
        None
    };
    if let (Some(lacking), None) = (lacking, end) {
        findings.error(
            &statistic,
            format!("a steady solution has no {lacking}"),
            "use [time.unsteady], or take the statistic \"final\"",
        );
    }
    if taken.kind == Strouhal && case.scales.is_none() {
        findings.error(
            &statistic,
            "a Strouhal number needs a length and a velocity".to_owned(),
            "add [scales] with length and velocity",
        );
    }
    if taken.kind == HalfPeriodAfterMax && case.statistics.phase_of.is_none() {
        findings.error(
            &statistic,
            "nothing says which quantity's maximum starts the period".to_owned(),
            "add phase_of = \"...\" to [statistics]",
        );
    }
    if is_any(&[MorisonDrag, MorisonInertia]) {
        check_morison(findings, key, taken);
    }
}

/// Whether the statistic has what it needs, and nothing else is given.
fn check_arguments(findings: &mut Findings<'_>, key: &str, taken: &Statistic) {
    use StatisticKind::{At, Crossing, When};
    let statistic = format!("{key}.statistic");
    let is_any = |list: &[StatisticKind]| list.contains(&taken.kind);
    for (name, is_given, what, owners, names) in [
        ("at", taken.at.is_some(), "a time", [At].as_slice(), "statistic `at`"),
        (
            "level",
            taken.level.is_some(),
            "a value",
            &[Crossing, When],
            "statistics `crossing` and `when`",
        ),
        ("of", taken.of.is_some(), "a quantity to wait for", &[When], "statistic `when`"),
    ] {
        if is_any(owners) && !is_given {
            findings.error(
                &statistic,
                format!("the statistic `{}` needs {what}", taken.kind.name()),
                &format!("add {name} = ... to the reference"),
            );
        } else if is_given && !is_any(owners) {
            findings.error(
                &format!("{key}.{name}"),
                format!("`{name}` goes with the {names} only"),
                &format!("write statistic = \"{}\", or leave `{name}` out", owners[0].name()),
            );
        }
    }
}

/// Whether Morison's equation has its force, diameter and density.
fn check_morison(findings: &mut Findings<'_>, key: &str, taken: &Statistic) {
    let case = findings.case();
    let statistic = format!("{key}.statistic");
    if taken.force_of().is_none() {
        findings.error(
            &format!("{key}.quantity"),
            format!("Morison's equation is one of forces, not of `{}`", taken.quantity),
            "write quantity = \"NAME.force.x\" or \"NAME.force.y\"",
        );
    }
    if taken.minus.is_some() {
        findings.error(
            &format!("{key}.minus"),
            "Morison's equation is that of one body".to_owned(),
            "leave `minus` out",
        );
    }
    if case.geometry != Geometry::Planar {
        findings.error(
            &statistic,
            "Morison's equation is fitted in planar cases only".to_owned(),
            "compare the force itself",
        );
    }
    if !case.has_coefficients() {
        findings.error(
            &statistic,
            "Morison's equation needs a diameter and a density of the fluid".to_owned(),
            "add [scales] with length = diameter, and density to [fluid]",
        );
    }
}
