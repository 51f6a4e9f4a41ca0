//! The cases of all points, checked before the first of them is run.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::case::{Diagnostic, Severity, Sweep, at_rest, check_flow};
use crate::cli::exit::Failure;
use crate::runner::threads;

/// Different mistakes that are shown at most.
const MOST_SHOWN: usize = 10;
/// Numbers of points that are listed at most.
const MOST_LISTED: usize = 20;

/// Checks the cases of points, by their indices from 0; warnings are handed back, each one once.
///
/// # Errors
/// All points whose case is wrong, and why.
pub fn check_points(sweep: &Sweep, points: Range<usize>) -> Result<Vec<Diagnostic>, Failure> {
    let n_threads = threads::granted().min(points.len()).max(1);
    let per_thread = points.len().div_ceil(n_threads).max(1);
    let checked: Vec<PointCheck> = std::thread::scope(|scope| {
        let workers: Vec<_> = points
            .clone()
            .step_by(per_thread)
            .map(|first| {
                let part = first..(first + per_thread).min(points.end);
                scope.spawn(move || part.map(|index| check(sweep, index)).collect::<Vec<_>>())
            })
            .collect();
        let joined = workers.into_iter().map(std::thread::ScopedJoinHandle::join);
        joined
            .flat_map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    let mut warnings: Vec<Diagnostic> = Vec::new();
    let mut wrong: Vec<Wrong> = Vec::new();
    for (index, found) in points.zip(checked) {
        match found {
            Ok(found) => {
                for warning in found {
                    if !warnings.contains(&warning) {
                        warnings.push(warning);
                    }
                }
            }
            Err(failure) => wrong.push(Wrong { number: index + 1, failure }),
        }
    }
    failure_of(sweep, wrong).map_or(Ok(warnings), Err)
}

/// Warnings of a case, or why it cannot be run.
type PointCheck = Result<Vec<Diagnostic>, Failure>;

fn check(sweep: &Sweep, index: usize) -> PointCheck {
    if sweep.is_soft() {
        let found = sweep.check_soft(&sweep.soft_case(index)?);
        return if found.is_empty() { Ok(found) } else { Err(Failure::wrong(&found)) };
    }
    let file = sweep.case(index)?;
    let mut found = sweep.check(&file);
    found.extend(check_flow(&file));
    if found.iter().any(|one| one.severity == Severity::Error) {
        return Err(Failure::wrong(&found));
    }
    found.extend(at_rest(&file));
    Ok(found)
}

/// A point that is wrong.
struct Wrong {
    number: usize,
    failure: Failure,
}

/// All points that are wrong: those with the same mistake together.
fn failure_of(sweep: &Sweep, wrong: Vec<Wrong>) -> Option<Failure> {
    let exit = wrong.first()?.failure.exit;
    let n_wrong = wrong.len();
    let mut order: Vec<String> = Vec::new();
    let mut by_message: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for Wrong { number, failure } in wrong {
        if !by_message.contains_key(&failure.message) {
            order.push(failure.message.clone());
        }
        by_message.entry(failure.message).or_default().push(number);
    }
    let mut texts = Vec::new();
    for message in order.iter().take(MOST_SHOWN) {
        let numbers = &by_message[message];
        let head = match numbers[..] {
            [number] => format!("point {number} ({}):", sweep.point(number - 1).label()),
            _ => format!("points {}:", listed(numbers)),
        };
        texts.push(format!("{head}\n{message}"));
    }
    if order.len() > MOST_SHOWN {
        let mut others: Vec<usize> =
            order[MOST_SHOWN..].iter().flat_map(|message| by_message[message].clone()).collect();
        others.sort_unstable();
        texts.push(format!("points {} are wrong, too", listed(&others)));
    }
    let n = sweep.n_points();
    let verb = if n_wrong == 1 { "is" } else { "are" };
    texts.push(format!("error: {n_wrong} of {n} points {verb} wrong; nothing was run"));
    Some(Failure { exit, message: texts.join("\n\n") })
}

/// Numbers in a row as ranges: 1-3, 7.
fn listed(numbers: &[usize]) -> String {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for &number in numbers {
        match ranges.last_mut() {
            Some(range) if range.end == number => range.end += 1,
            _ => ranges.push(number..number + 1),
        }
    }
    let text = |range: &Range<usize>| match range.len() {
        1 => range.start.to_string(),
        _ => format!("{}-{}", range.start, range.end - 1),
    };
    let shown: Vec<String> = ranges.iter().take(MOST_LISTED).map(text).collect();
    let more = if ranges.len() > MOST_LISTED { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn numbers_in_a_row_are_one_range() {
        assert_eq!(listed(&[1, 2, 3, 7, 9, 10]), "1-3, 7, 9-10");
        let odd: Vec<usize> = (0..50).map(|i| 2 * i + 1).collect();
        assert!(listed(&odd).ends_with("39, ..."), "{}", listed(&odd));
    }
}
