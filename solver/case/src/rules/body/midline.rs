//! Problems of `gait.midline`: expressions that are not understood or not periodic, tables that are none.

use crate::rules::Findings;
use crate::{Formula, MidlineGait, MidlineLaw, MidlineValues};

/// Positions and times at which an expression is tried.
const TRIALS: u32 = 64;

/// Part of the largest value by which one may differ a period later.
const ROUNDING: f64 = 1e-6;

/// Least slope of the midline to the straight body at which it has no length left.
const STEEPEST: f64 = 0.999;

/// Tells what is wrong with a midline.
pub fn check(findings: &mut Findings<'_>, key: &str, gait: &MidlineGait) {
    let has_table = !gait.table.is_empty() || !gait.positions.is_empty();
    let given = [
        ("curvature", gait.curvature.is_some()),
        ("lateral", gait.lateral.is_some()),
        ("file", has_table),
    ];
    let given: Vec<&str> =
        given.into_iter().filter_map(|(name, is_given)| is_given.then_some(name)).collect();
    match given.as_slice() {
        [] => findings.error(
            key,
            "nothing says how the midline bends".to_owned(),
            "write curvature = \"6*s*sin(2*pi*(t - s))\", lateral = \"0.1*s*sin(2*pi*(s - t))\", or \
             file = \"midline.csv\" with a header t, 0.0, ..., 1.0",
        ),
        [_] => check_law(findings, key, gait),
        several => findings.error(
            &format!("{key}.{}", several[0]),
            format!("the midline is given by `{}` and by `{}`", several[0], several[1]),
            "give one of them",
        ),
    }
}

fn check_law(findings: &mut Findings<'_>, key: &str, gait: &MidlineGait) {
    let written = [("curvature", &gait.curvature), ("lateral", &gait.lateral)];
    let written = written.into_iter().find_map(|(name, formula)| Some((name, formula.as_ref()?)));
    let Some((name, formula)) = written else {
        if has_table(findings, key, gait)
            && let Ok(law) = gait.law()
        {
            check_slope(findings, &format!("{key}.table"), gait, &law);
        }
        return;
    };
    let key = format!("{key}.{name}");
    match gait.law() {
        Err(error) => findings.error(
            &key,
            format!("{formula} at character {}: {}", error.column, error.found),
            &error.accepted,
        ),
        Ok(law) => {
            if check_values(findings, &key, gait, &law, formula) {
                check_slope(findings, &key, gait, &law);
            }
        }
    }
}

/// Positions and times of the trials.
fn trials(gait: &MidlineGait) -> impl Iterator<Item = [f64; 2]> {
    let part = |nth: u32| f64::from(nth) / f64::from(TRIALS);
    let period = gait.period;
    (0..=TRIALS).flat_map(move |s| (0..TRIALS).map(move |t| [part(s), period * part(t)]))
}

/// Whether an expression is finite, and the same a period later.
fn check_values(
    findings: &mut Findings<'_>,
    key: &str,
    gait: &MidlineGait,
    law: &MidlineLaw,
    formula: &Formula,
) -> bool {
    if let Some([s, t]) = trials(gait).find(|[s, t]| !law.value(*s, *t).is_finite()) {
        let value = law.value(s, t);
        findings.error(
            key,
            format!("{formula} is {value} at s = {s:.4}, t = {t:.4}"),
            "write an expression of finite values for s from 0 to 1",
        );
        return false;
    }
    let largest = trials(gait).map(|[s, t]| law.value(s, t).abs()).fold(0.0, f64::max);
    let off = |[s, t]: &[f64; 2]| (law.value(*s, t + gait.period) - law.value(*s, *t)).abs();
    if let Some([s, t]) = trials(gait).find(|at| off(at) > ROUNDING * largest) {
        let [now, later] = [t, t + gait.period].map(|t| law.value(s, t));
        findings.error(
            key,
            format!("{formula} is {now} at s = {s:.4}, t = {t:.4}, and a period later {later}"),
            "write `period` so that the expression begins again after it; what grows at the start is `ramp`",
        );
        return false;
    }
    true
}

/// A midline that keeps its length cannot be displaced by more than that.
fn check_slope(findings: &mut Findings<'_>, key: &str, gait: &MidlineGait, law: &MidlineLaw) {
    if gait.kind() != MidlineValues::Lateral {
        return;
    }
    let h = 1e-5;
    let slope = |[s, t]: [f64; 2]| {
        let ends = [(s - h).max(0.0), (s + h).min(1.0)];
        let [before, after] = ends.map(|s| law.value(s, t));
        ((after - before) / (ends[1] - ends[0])).abs()
    };
    let steepest = trials(gait).map(slope).fold(0.0, f64::max);
    if steepest > STEEPEST {
        findings.error(
            key,
            format!(
                "the midline would be displaced by {steepest:.3} per length of midline, which it cannot be \
                 without being stretched"
            ),
            "lower the displacement, or give the curvature, which may be any",
        );
    }
}

/// Whether a table goes from head to tail and through a period.
fn has_table(findings: &mut Findings<'_>, key: &str, gait: &MidlineGait) -> bool {
    let rises = |values: &[f64]| values.windows(2).all(|pair| pair[1] > pair[0]);
    let positions = gait.positions.as_slice();
    if positions.len() < 3
        || !rises(positions)
        || positions[0] != 0.0
        || positions[positions.len() - 1] != 1.0
    {
        findings.error(
            &format!("{key}.positions"),
            format!("the values are given at s/L = {positions:?}, not from head to tail"),
            "give three or more rising positions, the first 0, the last 1: in a file they are its header behind t",
        );
        return false;
    }
    let wanted = positions.len() + 1;
    if let Some(nth) = gait.table.iter().position(|row| row.len() != wanted) {
        findings.error(
            &format!("{key}.table"),
            format!("row {} has {} numbers", nth + 1, gait.table[nth].len()),
            &format!("write {wanted}: a time, and a value for each position"),
        );
        return false;
    }
    let times: Vec<f64> = gait.table.iter().map(|row| row[0]).collect();
    let length = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let (period, rounding) = (gait.period, 1e-9 * gait.period);
    if times.len() < 4 || !rises(&times) || length > period + rounding {
        findings.error(
            &format!("{key}.table"),
            format!("{} times over {length} do not make a period of {period}", times.len()),
            "give four or more rising times within one `period`; a row at its end repeats the first",
        );
        return false;
    }
    let (first, last) = (&gait.table[0], &gait.table[gait.table.len() - 1]);
    let is_closed = length >= period - rounding;
    let largest =
        gait.table.iter().flat_map(|row| &row[1..]).fold(0.0f64, |most, x| most.max(x.abs()));
    let differs = |(one, other): (&f64, &f64)| (one - other).abs() > 1e-3 * largest;
    if is_closed && first[1..].iter().zip(&last[1..]).any(differs) {
        findings.error(
            &format!("{key}.table"),
            "the row at the end of the period is not the first one".to_owned(),
            "give values that begin again, or leave the last row out",
        );
        return false;
    }
    true
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = "
title = 't'
geometry = 'planar'
fluid = { model = 'navier-stokes', viscosity = 0.1, density = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 1.0, surface = 0.01 }
time.unsteady = { step = 0.01, end = 0.2 }
define.K = 4.0
body = [{ name = 'b', shape.fish.length = 1.0, center = [0.0, 0.0], motion = 'free', gait.midline = { GAIT } }]
";

    /// What `check` says first of a gait, with this file beside the case.
    fn first(gait: &str, file: &str) -> Option<String> {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("m.csv"), file).unwrap();
        let path = directory.path().join("t.toml");
        std::fs::write(&path, CASE.replace("GAIT", gait)).unwrap();
        let file = match Case::read(&path.display().to_string(), &[]) {
            Ok(file) => file,
            Err(error) => return Some(error.to_string()),
        };
        check(&file).first().map(|found| format!("{} {} {}", found.key, found.message, found.help))
    }

    #[test]
    fn midlines_are_read_and_their_mistakes_told() {
        let wave = "period = 1, curvature = 'K*s*sin(2*pi*(t - s))'";
        assert_eq!(first(wave, ""), None);
        assert_eq!(first("period = 1, lateral = '0.05*s*sin(2*pi*(t - s))'", ""), None);
        let table = "t, 0.0, 0.5, 1.0\n0.0, 0, 1, 2\n0.25, 1, 2, 1\n0.5, 0, 0, 1\n0.75, 0, 1, 1\n";
        assert_eq!(first("period = 1, file = 'm.csv'", table), None);
        for (gait, file, words) in [
            ("period = 1", "", "nothing says how"),
            ("file = 'm.csv'", table, "period"),
            ("period = 1, file = 'n.csv'", "", "n.csv"),
            ("period = 1, curvature = '1', lateral = '0'", "", "by `curvature` and by `lateral`"),
            ("period = 1, curvature = 'K*x'", "", "at character 3: there is no `x`"),
            ("period = 1, curvature = 'K*t'", "", "a period later"),
            ("period = 1, curvature = '1/s'", "", "is inf at s = 0"),
            ("period = 1, lateral = '0.5*s*sin(2*pi*(t - s))'", "", "without being stretched"),
            ("period = 1, file = 'm.csv'", "t, 0.0, 0.5\n0, 1, 2\n", "not from head to tail"),
            ("period = 1, file = 'm.csv'", "t, 0, 0.5, 1\n0, 1, 2, a\n", "line 2 has \"a\""),
            ("period = 1, file = 'm.csv'", "t, 0, 0.5, 1\n0, 1, 2, 3\n", "do not make a period"),
            ("period = 0.4, file = 'm.csv'", table, "do not make a period of 0.4"),
            ("period = 0.75, file = 'm.csv'", table, "is not the first one"),
        ] {
            let found = first(gait, file).unwrap_or_else(|| panic!("{gait} is accepted"));
            assert!(found.contains(words), "{gait}: {found}");
        }
    }
}
