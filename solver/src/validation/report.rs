//! Comparisons for the terminal and as JSON: computed, reference, kind, difference, evidence, verdict; counts.

use serde_json::{Map, Value, json};

use super::comparison::{Comparison, Verdict};
use super::evidence::EvidenceCount;
use crate::case::{ReferenceKind, significant};

/// The kind of a reference and what a comparison with it came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Judged {
    pub kind: ReferenceKind,
    pub verdict: Verdict,
}

/// Those of comparisons.
pub(super) fn judged(comparisons: &[Comparison]) -> Vec<Judged> {
    let of = |row: &Comparison| Judged { kind: row.reference.expected.kind, verdict: row.verdict };
    comparisons.iter().map(of).collect()
}

/// How many comparisons of one kind came to which verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Count {
    pub kind: ReferenceKind,
    /// In the order of `Verdict::ALL`.
    of_verdict: [usize; Verdict::ALL.len()],
}

impl Count {
    fn total(&self) -> usize {
        self.of_verdict.iter().sum()
    }
}

/// Counts of the kinds that occur.
pub(super) fn counts(all: &[Judged]) -> Vec<Count> {
    let count = |kind| Count {
        kind,
        of_verdict: Verdict::ALL
            .map(|verdict| all.iter().filter(|one| **one == Judged { kind, verdict }).count()),
    };
    ReferenceKind::ALL.map(count).into_iter().filter(|count| count.total() > 0).collect()
}

/// Counts by kind, one line a kind, a header first.
#[must_use]
pub fn count_table(comparisons: &[Comparison]) -> Vec<String> {
    let mut rows = vec![count_header()];
    rows.extend(counts(&judged(comparisons)).iter().map(count_cells));
    aligned(&rows, &[1, 2, 3, 4, 5, 6])
}

pub(super) fn count_header() -> Vec<String> {
    let verdicts = Verdict::ALL.iter().map(|verdict| verdict.name().to_lowercase());
    ["kind".to_owned(), "values".to_owned()].into_iter().chain(verdicts).collect()
}

pub(super) fn count_cells(count: &Count) -> Vec<String> {
    let numbers = count.of_verdict.iter().map(ToString::to_string);
    [count.kind.name().to_owned(), count.total().to_string()].into_iter().chain(numbers).collect()
}

/// How many values are within their band, how many are known not to be, and how many are confirmed.
#[must_use]
pub fn summary(comparisons: &[Comparison]) -> String {
    summary_of(&judged(comparisons), EvidenceCount::of(comparisons))
}

pub(super) fn summary_of(all: &[Judged], evidence: EvidenceCount) -> String {
    let number = |verdict| all.iter().filter(|one| one.verdict == verdict).count();
    let known = match number(Verdict::KnownOutside) {
        0 => String::new(),
        n => format!(", {n} outside for a known reason"),
    };
    let (n_within, n) = (number(Verdict::Within), all.len());
    let evidence = evidence.in_words().map_or(String::new(), |words| format!("; {words}"));
    format!("{n_within} of {n} values within their band{known}{evidence}")
}

impl Comparison {
    /// Case, quantity, computed, reference, kind, difference, evidence, band and verdict.
    pub(super) fn cells(&self) -> [String; 9] {
        let tolerance =
            self.reference.expected.relative.or(self.reference.expected.absolute).unwrap_or(0.0);
        [
            self.case.clone(),
            self.quantity.clone(),
            self.computed.as_ref().map_or("-".to_owned(), |value| significant(*value)),
            significant(self.reference.expected.value),
            self.reference.expected.kind.name().to_owned(),
            self.difference().map_or("-".to_owned(), |difference| {
                format!("{}{}", if difference < 0.0 { "" } else { "+" }, self.share(difference))
            }),
            self.evidence_in_words(),
            self.share(tolerance),
            self.verdict.name().to_owned(),
        ]
    }

    /// A difference from the reference, in per cent where its tolerance is relative.
    pub(super) fn share(&self, value: f64) -> String {
        if self.reference.expected.relative.is_some() {
            format!("{}%", two_digits(100.0 * value))
        } else {
            two_digits(value)
        }
    }
}

/// A number with two digits, in the shorter notation.
pub(super) fn two_digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (0.01..1000.0).contains(&size) {
        let digits = [10.0, 1.0, 0.1].iter().take_while(|power| size < **power).count();
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}

/// All comparisons as a JSON object, with their counts by kind.
#[must_use]
pub fn comparisons_to_json(comparisons: &[Comparison]) -> Value {
    let of_kind = |count: &Count| {
        let verdicts = Verdict::ALL.iter().zip(count.of_verdict);
        let numbers = verdicts.map(|(verdict, n)| (verdict.name().to_lowercase(), n.into()));
        let all = [("values".to_owned(), Value::from(count.total()))].into_iter().chain(numbers);
        (count.kind.name().to_owned(), Value::Object(all.collect()))
    };
    let counts: Map<String, Value> = counts(&judged(comparisons)).iter().map(of_kind).collect();
    let rows: Vec<Value> = comparisons.iter().map(Comparison::to_json).collect();
    let EvidenceCount { confirmed, consistent } = EvidenceCount::of(comparisons);
    json!({
        "counts": counts,
        "evidence": { "confirmed": confirmed, "consistent": consistent },
        "comparisons": rows,
    })
}

/// The table, its header first, one line a comparison in their order.
#[must_use]
pub fn comparison_table(comparisons: &[Comparison]) -> Vec<String> {
    let header = [
        "case",
        "quantity",
        "computed",
        "reference",
        "kind",
        "difference",
        "evidence",
        "band",
        "verdict",
    ];
    let mut rows = vec![header.map(ToOwned::to_owned).to_vec()];
    rows.extend(comparisons.iter().map(|row| row.cells().to_vec()));
    aligned(&rows, &[2, 3, 5, 7])
}

/// Lines of cells in columns: words to the left, the columns of numbers to the right.
fn aligned(rows: &[Vec<String>], numbers: &[usize]) -> Vec<String> {
    let n_columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width: Vec<usize> = (0..n_columns)
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    rows.iter()
        .map(|row| {
            let mut line = String::new();
            for (column, cell) in row.iter().enumerate() {
                let padding = " ".repeat(width[column] - cell.chars().count());
                line += &if numbers.contains(&column) {
                    format!("{padding}{cell}  ")
                } else {
                    format!("{cell}{padding}  ")
                };
            }
            line.trim_end().to_owned()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::comparison::judge;
    use super::*;
    use crate::case::{Expected, Reference, Statistic, StatisticKind};

    fn reference(relative: Option<f64>, absolute: Option<f64>) -> Reference {
        let quantity = "body.force.x".to_owned();
        Reference {
            statistic: Statistic { quantity, kind: StatisticKind::Max, ..Statistic::default() },
            expected: Expected {
                value: -2.0,
                per: 1.0,
                relative,
                absolute,
                uncertainty: None,
                kind: ReferenceKind::Literature,
                source: "somebody".to_owned(),
                date: None,
                outside: None,
                cause: None,
                note: None,
            },
        }
    }

    #[test]
    fn a_wrong_value_is_called_wrong() {
        let verdict = |computed: f64, relative, absolute| {
            judge("c", &reference(relative, absolute), Ok(computed), 1, 0.0).verdict
        };
        assert_eq!(verdict(-2.01, Some(0.01), None), Verdict::Within);
        assert_eq!(verdict(-2.03, Some(0.01), None), Verdict::Outside);
        assert_eq!(verdict(-2.03, None, Some(0.05)), Verdict::Within);
        assert_eq!(verdict(2.0, None, Some(0.05)), Verdict::Outside);
        assert_eq!(verdict(f64::NAN, Some(0.5), None), Verdict::Outside);
    }

    #[test]
    fn a_comparison_says_what_was_subtracted_and_waited_for() {
        let plain = reference(Some(0.01), None);
        let named = |statistic: Statistic| {
            judge("c", &Reference { statistic, ..plain.clone() }, Ok(-2.0), 1, 0.0).quantity
        };
        assert_eq!(named(plain.statistic.clone()), "body.force.x (max)");
        let minus = Some("other.force.x".to_owned());
        let apart = Statistic { minus, ..plain.statistic.clone() };
        assert_eq!(named(apart.clone()), "body.force.x - other.force.x (max)");
        let last = Statistic { kind: StatisticKind::Final, ..apart.clone() };
        assert_eq!(named(last), "body.force.x - other.force.x");
        let kind = StatisticKind::Crossing;
        let crossing = Statistic { kind, level: Some(0.5), ..apart.clone() };
        assert_eq!(named(crossing), "body.force.x - other.force.x (crossing 0.5)");
        let (kind, of) = (StatisticKind::When, Some("body.y".to_owned()));
        let when = Statistic { kind, level: Some(-0.5), of, minus: None, ..apart.clone() };
        assert_eq!(named(when), "body.force.x (when body.y = -0.5)");
        let apart = Reference { statistic: apart, ..plain.clone() };
        let json = judge("c", &apart, Ok(-2.0), 1, 0.0).to_json();
        assert_eq!(
            (&json["quantity"], &json["minus"]),
            (&"body.force.x".into(), &"other.force.x".into())
        );
    }

    #[test]
    fn the_table_lines_up_and_the_json_has_numbers() {
        let rows = [
            judge("long-name/variant", &reference(Some(0.01), None), Ok(-2.01), 10, 0.5),
            judge("c", &reference(None, Some(1e-3)), Err("it diverged".to_owned()), 0, 0.0),
        ];
        let table = comparison_table(&rows);
        assert!(table[1].contains("body.force.x (max)"), "{}", table[1]);
        assert!(table[1].contains("-0.50%") && table[1].contains("1.0%"), "{}", table[1]);
        assert!(table[2].ends_with("NOT COMPUTED"), "{}", table[2]);
        assert_eq!(table[0].find("verdict"), table[1].find("within"));
        let json = &comparisons_to_json(&rows)["comparisons"];
        assert_eq!(json[0]["computed"], -2.01);
        assert_eq!(json[1]["reason"], "it diverged");
        assert!(json[1]["computed"].is_null());
    }

    #[test]
    fn values_are_counted_by_kind() {
        let mut own = reference(Some(0.01), None);
        own.expected.kind = ReferenceKind::Regression;
        let rows = [
            judge("c", &own, Ok(-2.0), 1, 0.0),
            judge("c", &reference(Some(0.01), None), Ok(-2.01), 1, 0.0),
            judge("c", &own, Ok(-3.0), 1, 0.0),
        ];
        let json = comparisons_to_json(&rows);
        assert_eq!(json["counts"]["literature"]["values"], 1);
        assert_eq!(json["counts"]["regression"]["values"], 2);
        assert_eq!(json["counts"]["regression"]["outside"], 1);
        assert!(json["counts"]["measured"].is_null());
        let table = count_table(&rows);
        assert_eq!(table.len(), 3);
        assert!(table[1].starts_with("literature") && table[2].starts_with("regression"));
    }

    #[test]
    fn a_value_known_to_be_outside_fails_only_once_it_is_not() {
        let outside = Some("they sum up less".to_owned());
        let mut known = reference(Some(0.01), None);
        known.expected.outside = outside;
        let row = |computed| judge("c", &known, computed, 1, 0.0);
        assert_eq!(row(Ok(-2.5)).verdict, Verdict::KnownOutside);
        assert_eq!(row(Ok(-2.0)).verdict, Verdict::NoLongerOutside);
        assert_eq!(row(Ok(f64::NAN)).verdict, Verdict::Outside);
        assert_eq!(row(Err("it diverged".to_owned())).verdict, Verdict::NotComputed);
        let failures = Verdict::ALL.map(Verdict::is_failure);
        assert_eq!(failures, [false, false, true, true, true]);
        assert!(summary(&[row(Ok(-2.5))]).contains("1 outside for a known reason; of 1 with"));
    }
}
