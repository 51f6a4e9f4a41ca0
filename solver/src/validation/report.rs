//! Table of computed, published, difference, verdict.

use serde_json::{Value, json};

use super::statistic::measured_value;
use crate::case::{Case, Reference, significant};
use crate::simulation::RunSummary;

/// What a comparison came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Within the tolerance.
    Within,
    /// Outside the tolerance.
    Outside,
    /// There is nothing to compare.
    NotComputed,
}

impl Verdict {
    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Within => "within",
            Self::Outside => "OUTSIDE",
            Self::NotComputed => "NOT COMPUTED",
        }
    }
}

/// A published value beside what was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the case, with its variant.
    pub case: String,
    /// Which quantity, with its statistic unless that is the final value.
    pub quantity: String,
    /// What was computed, or why it was not.
    pub computed: Result<f64, String>,
    /// What was published, where, and how near we should be.
    pub reference: Reference,
    /// The verdict.
    pub verdict: Verdict,
    /// Unknowns of the linear system; 0 if it was not made.
    pub dofs: usize,
    /// CPU seconds of the run.
    pub cpu_seconds: f64,
}

/// Compares a run with all references of its case.
#[must_use]
pub fn compare(name: &str, case: &Case, outcome: &RunSummary) -> Vec<Comparison> {
    let cpu_seconds = outcome.timing.cpu.iter().sum();
    case.reference
        .iter()
        .map(|reference| {
            let computed =
                measured_value(&outcome.series, case, reference).map_err(|error| error.to_string());
            let computed = computed.and_then(|value| {
                let is_of_cycle = reference.quantity.contains(".cycle.");
                match value {
                    value if value.is_finite() => Ok(value),
                    _ if is_of_cycle => Err(format!(
                        "{} is not a number: no whole cycle had ended by then",
                        reference.quantity
                    )),
                    value => Err(format!("{} is {value}", reference.quantity)),
                }
            });
            judge(name, reference, computed, outcome.n_dofs, cpu_seconds)
        })
        .collect()
}

/// The references of a case that could not be run, and why.
#[must_use]
pub fn not_computed(name: &str, case: &Case, reason: &str) -> Vec<Comparison> {
    case.reference
        .iter()
        .map(|reference| judge(name, reference, Err(reason.to_owned()), 0, 0.0))
        .collect()
}

fn judge(
    name: &str,
    reference: &Reference,
    computed: Result<f64, String>,
    dofs: usize,
    cpu_seconds: f64,
) -> Comparison {
    let verdict = match &computed {
        Err(_) => Verdict::NotComputed,
        // Written so that a value that is not a number is outside, too.
        Ok(value) if (value - reference.value).abs() <= allowed(reference) => Verdict::Within,
        Ok(_) => Verdict::Outside,
    };
    Comparison {
        case: name.to_owned(),
        quantity: reference.label(),
        computed,
        reference: reference.clone(),
        verdict,
        dofs,
        cpu_seconds,
    }
}

/// Largest accepted difference.
fn allowed(reference: &Reference) -> f64 {
    match (reference.relative, reference.absolute) {
        (Some(relative), _) => relative * reference.value.abs(),
        (None, Some(absolute)) => absolute,
        (None, None) => 0.0,
    }
}

impl Comparison {
    /// Computed less published, relative if the tolerance is.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        let difference = self.computed.as_ref().ok()? - self.reference.value;
        Some(match self.reference.relative {
            Some(_) => difference / self.reference.value.abs(),
            None => difference,
        })
    }

    /// The comparison as an object: numbers as numbers, `null` where there is none.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "case": self.case,
            "quantity": self.reference.quantity,
            "minus": self.reference.minus,
            "statistic": self.reference.statistic.name(),
            "at": self.reference.at,
            "level": self.reference.level,
            "of": self.reference.of,
            "computed": self.computed.as_ref().ok(),
            "published": self.reference.value,
            "difference": self.difference(),
            "tolerance": self.reference.relative.or(self.reference.absolute),
            "is_relative": self.reference.relative.is_some(),
            "source": self.reference.source,
            "note": self.reference.note,
            "verdict": match self.verdict {
                Verdict::Within => "within",
                Verdict::Outside => "outside",
                Verdict::NotComputed => "not computed",
            },
            "reason": self.computed.as_ref().err(),
            "dofs": self.dofs,
            "cpu_seconds": self.cpu_seconds,
        })
    }

    fn cells(&self) -> [String; 7] {
        let is_relative = self.reference.relative.is_some();
        let share = |value: f64| {
            if is_relative { format!("{}%", two_digits(100.0 * value)) } else { two_digits(value) }
        };
        let tolerance = self.reference.relative.or(self.reference.absolute).unwrap_or(0.0);
        [
            self.case.clone(),
            self.quantity.clone(),
            self.computed.as_ref().map_or("-".to_owned(), |value| significant(*value)),
            significant(self.reference.value),
            self.difference().map_or("-".to_owned(), |difference| {
                format!("{}{}", if difference < 0.0 { "" } else { "+" }, share(difference))
            }),
            share(tolerance),
            self.verdict.name().to_owned(),
        ]
    }
}

/// A number with two digits, in the shorter notation.
fn two_digits(value: f64) -> String {
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

/// All comparisons as a JSON array.
#[must_use]
pub fn comparisons_to_json(comparisons: &[Comparison]) -> Value {
    Value::Array(comparisons.iter().map(Comparison::to_json).collect())
}

/// The comparisons as a page of Markdown: one table a case, with sources and notes.
#[must_use]
pub fn comparison_page(comparisons: &[Comparison]) -> String {
    let n_within = comparisons.iter().filter(|row| row.verdict == Verdict::Within).count();
    let mut page = format!(
        "# Validation\n\nWritten by `alewife validate --markdown` of version {}; not edited by \
         hand. {n_within} of {} values are within their tolerance.\n",
        env!("CARGO_PKG_VERSION"),
        comparisons.len()
    );
    let case_of = |row: &Comparison| row.case.split('/').next().unwrap_or_default().to_owned();
    for rows in comparisons.chunk_by(|one, other| case_of(one) == case_of(other)) {
        page += &format!("\n## {}\n\n", case_of(&rows[0]));
        page += "| variant | quantity | computed | published | difference | tolerance | verdict \
                 | unknowns | CPU (s) |\n";
        page += "|---|---|---|---|---|---|---|---|---|\n";
        for row in rows {
            let [case, quantity, computed, published, difference, tolerance, verdict] = row.cells();
            let variant = case.split_once('/').map_or("", |(_, variant)| variant);
            page += &format!(
                "| {variant} | {quantity} | {computed} | {published} | {difference} | {tolerance} \
                 | {verdict} | {} | {:.2} |\n",
                row.dofs, row.cpu_seconds
            );
        }
        let mut listed = Vec::new();
        for row in rows {
            let note =
                row.reference.note.as_ref().map_or(String::new(), |note| format!(" ({note})"));
            let line = format!("{}{note}", row.reference.source);
            if !listed.contains(&line) {
                listed.push(line);
            }
        }
        page += &format!("\nSources: {}.\n", listed.join("; "));
    }
    page
}

/// The table, its header first, one line a comparison in their order.
#[must_use]
pub fn comparison_table(comparisons: &[Comparison]) -> Vec<String> {
    let header =
        ["case", "quantity", "computed", "published", "difference", "tolerance", "verdict"];
    let mut rows = vec![header.map(ToOwned::to_owned)];
    rows.extend(comparisons.iter().map(Comparison::cells));
    let width: Vec<usize> = (0..header.len())
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    rows.iter()
        .map(|row| {
            let mut line = String::new();
            for (column, cell) in row.iter().enumerate() {
                // Words to the left, numbers to the right.
                let padding = " ".repeat(width[column] - cell.chars().count());
                let is_number = (2..6).contains(&column);
                line += &if is_number {
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
    use super::*;
    use crate::case::Statistic;

    fn reference(relative: Option<f64>, absolute: Option<f64>) -> Reference {
        Reference {
            quantity: "body.force.x".to_owned(),
            minus: None,
            statistic: Statistic::Max,
            at: None,
            level: None,
            of: None,
            value: -2.0,
            per: 1.0,
            relative,
            absolute,
            source: "somebody".to_owned(),
            note: None,
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
        let named = |reference: Reference| judge("c", &reference, Ok(-2.0), 1, 0.0).quantity;
        assert_eq!(named(plain.clone()), "body.force.x (max)");
        let apart = Reference { minus: Some("other.force.x".to_owned()), ..plain };
        assert_eq!(named(apart.clone()), "body.force.x - other.force.x (max)");
        let last = Reference { statistic: Statistic::Final, ..apart.clone() };
        assert_eq!(named(last), "body.force.x - other.force.x");
        let crossing =
            Reference { statistic: Statistic::Crossing, level: Some(0.5), ..apart.clone() };
        assert_eq!(named(crossing), "body.force.x - other.force.x (crossing 0.5)");
        let of = Some("body.y".to_owned());
        let when = Reference {
            statistic: Statistic::When,
            level: Some(-0.5),
            of,
            minus: None,
            ..apart.clone()
        };
        assert_eq!(named(when), "body.force.x (when body.y = -0.5)");
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
        let page = comparison_page(&rows);
        assert!(page.contains("1 of 2 values") && page.contains("## long-name"), "{page}");
        assert!(page.contains("| variant | body.force.x (max) | -2.01"), "{page}");
        let json = comparisons_to_json(&rows);
        assert_eq!(json[0]["computed"], -2.01);
        assert_eq!(json[1]["reason"], "it diverged");
        assert!(json[1]["computed"].is_null());
    }
}
