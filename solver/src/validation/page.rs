//! The page of a validation: counts by kind, then a section a case; those of other cases stay as they were.

use std::collections::BTreeMap;

use super::comparison::Verdict;
use super::evidence::EvidenceCount;
use super::report::{Judged, count_cells, count_header, counts, summary_of};
use super::section::{CaseReport, Coverage, VERDICT, known_outside, row, section};
use crate::case::ReferenceKind;

/// How the page begins, by which it is known.
const TITLE: &str = "# Validation\n";

/// What is between sections.
const HEADING: &str = "\n## ";

/// How the line of a value that is outside begins, up to its case.
const OUTSIDE: &str = "- `";

const HEAD: &str = "\
Written by `alewife validate --report`, not edited by hand. A section is replaced when its case is
validated again; each says which program made its runs and when. Runs with the same mesh, steps and
companion share a row, their CPU times in the order of their names; a variant is named in the first row
of its values. Behind the band stands what is not within it.";

/// What bands and evidence are.
const VERDICTS: &str = "\
A *band* is a regression band: at most five times the discretisation error of the shipped mesh and step, or the own
uncertainty of the reference (the second ±) where that is larger. Where the error is small by
chance, it is the size of the differences of the same quantity in the case; a value that is zero but
for rounding has a band far above rounding and far below anything that matters. A value that leaves its band has
changed; that it is within says little of whether it is right.

*Evidence* says that: a value is *confirmed* where |computed - reference| is not above the numerical uncertainty and that of
the reference together, what is not known counting as nothing; otherwise it is *consistent* with the reference to the
difference shown, and the cause is below the table. Conditions (`property`) and earlier values (`regression`)
are no evidence.";

/// The rule of `uncertainty.rs`.
const UNCERTAINTIES: &str = "\
The *numerical* uncertainty (the first ±) is the discretisation error of a computed value as the rule of
Roache estimates it: 3 |f - g| / (r^p - 1), where g is the value of a companion with cells and steps r times as
long, p the order and 3 the factor of safety where the order is not observed. The companion has
`mesh.scale` and the step times the square root of 2; r is what its numbers of cells and steps come
to, the smaller one. p is 2, or 1 with steps by backward Euler: Taylor-Hood elements on smooth flow
do better, and then the uncertainty is too large. Two meshes may agree by chance: no uncertainty is taken to be below 2e-5 of the
value, nor below the median of the same quantity in the case. Where the value has no companion, or the companion
failed or is hardly coarser, there is a dash; so there is where a mesh file gives the sides, which the companion shares.";

/// A page under way.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReportPage {
    sections: BTreeMap<String, Section>,
}

#[derive(Debug, Clone, Default, PartialEq)]
struct Section {
    /// All below its heading.
    text: String,
    /// Lines of its values that are known to be outside.
    outside: Vec<String>,
}

impl ReportPage {
    /// The page in a text.
    ///
    /// # Errors
    /// When it is another one.
    pub fn read(text: &str) -> Result<Self, &'static str> {
        if !text.starts_with(TITLE) {
            return Err("it does not begin as the page of a validation does");
        }
        let mut parts = text.split(HEADING);
        let head = parts.next().unwrap_or_default();
        let mut sections = BTreeMap::new();
        for part in parts {
            let (name, text) = part.split_once('\n').unwrap_or((part, ""));
            let of_case = |line: &&str| {
                let case =
                    line.strip_prefix(OUTSIDE).and_then(|rest| rest.split(['/', '`']).next());
                case == Some(name)
            };
            let outside = head.lines().filter(of_case).map(str::to_owned).collect();
            let text = text.trim().to_owned() + "\n";
            sections.insert(name.to_owned(), Section { text, outside });
        }
        Ok(Self { sections })
    }

    /// Replaces the section of a case, or adds it.
    pub fn set(&mut self, case: &CaseReport) {
        let own = Section { text: section(case), outside: known_outside(case) };
        self.sections.insert(case.name.clone(), own);
    }

    /// The page as a text, which names those of some cases that have no section.
    #[must_use]
    pub fn text(&self, cases: &[&str]) -> String {
        let all: Vec<Judged> =
            self.sections.values().flat_map(|section| judged_in(&section.text)).collect();
        let evidence = self.sections.values().fold(EvidenceCount::default(), |sum, section| {
            cells_in(&section.text, "evidence").iter().fold(sum, |sum, cell| sum.with(cell))
        });
        let mut page = format!(
            "{TITLE}\n{HEAD}\n\n{}.\n\n{VERDICTS}\n\n{UNCERTAINTIES}\n\n",
            summary_of(&all, evidence)
        );
        let absent: Vec<String> = cases
            .iter()
            .filter(|name| !self.sections.contains_key(**name))
            .map(|name| format!("`{name}`"))
            .collect();
        if !absent.is_empty() {
            page += &format!("Not on this page yet: {}.\n\n", absent.join(", "));
        }
        if let Some(coverage) = self.coverage() {
            page += &format!("{coverage}\n\n");
        }
        let mut header = count_header();
        header.insert(1, "what it is".to_owned());
        page += &row(&header);
        page += &row(&vec!["---".to_owned(); header.len()]);
        for count in counts(&all) {
            let mut cells = count_cells(&count);
            cells.insert(1, count.kind.meaning().to_owned());
            page += &row(&cells);
        }
        let outside: Vec<&String> =
            self.sections.values().flat_map(|section| &section.outside).collect();
        if !outside.is_empty() {
            page += "\nOutside for a known reason:\n\n";
        }
        for line in outside {
            page += &format!("{line}\n");
        }
        for (name, Section { text, .. }) in &self.sections {
            page += &format!("{HEADING}{name}\n\n{text}");
        }
        page
    }

    /// A sentence on how good the rule of the uncertainties is, where exact values are known.
    fn coverage(&self) -> Option<String> {
        let lines = self.sections.values().flat_map(|section| section.text.lines());
        let total = lines.filter_map(Coverage::read).fold(Coverage::default(), |sum, one| {
            Coverage { n: sum.n + one.n, of: sum.of + one.of }
        });
        (total.of > 0).then(|| {
            format!(
                "Of {} values whose exact value is known, {} differ from it by less than this \
                 uncertainty.",
                total.of, total.n
            )
        })
    }
}

/// Kinds and verdicts in the tables of a section.
fn judged_in(text: &str) -> Vec<Judged> {
    let kinds = cells_in(text, "kind");
    // Pages of earlier programs have a column of verdicts, or of tolerances
    let columns = ["verdict", "band", "tolerance"].map(|column| cells_in(text, column));
    let verdicts = columns.into_iter().find(|cells| !cells.is_empty()).unwrap_or_default();
    let judged = |(kind, cell): (&&str, &str)| {
        let kind = ReferenceKind::ALL.into_iter().find(|one| one.name() == *kind)?;
        let said = cell.split(VERDICT).last().unwrap_or_default();
        let verdict = Verdict::ALL.into_iter().find(|one| one.name() == said);
        Some(Judged { kind, verdict: verdict.unwrap_or(Verdict::Within) })
    };
    kinds.iter().zip(verdicts).filter_map(judged).collect()
}

/// Cells of a column of those tables in a section that have it.
fn cells_in<'a>(text: &'a str, column: &str) -> Vec<&'a str> {
    let mut index: Option<usize> = None;
    let mut found = Vec::new();
    for line in text.lines() {
        let Some(inner) = line.strip_prefix("| ").and_then(|rest| rest.strip_suffix(" |")) else {
            if !line.starts_with('|') {
                index = None;
            }
            continue;
        };
        let cells: Vec<&str> = inner.split(" | ").collect();
        match index {
            Some(index) => found.push(cells.get(index).copied().unwrap_or_default()),
            None => index = cells.iter().position(|cell| *cell == column),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, Reference};
    use crate::validation::comparison::judge;
    use crate::validation::section::{Links, MemberReport};
    use crate::validation::uncertainty::{MeshSize, RunSize};

    /// The section of a case whose computed values are its references times these factors.
    fn report(name: &str, factors: [f64; 2]) -> CaseReport {
        let case = Case::read("dfg-2d-1", &[]).unwrap().model.case;
        let judged = |(index, factor): (usize, f64)| {
            let reference: &Reference = &case.reference[index];
            let computed = Ok(factor * reference.expected.value);
            judge(&format!("{name}/v"), reference, computed, 1, 0.0)
        };
        let member = MemberReport {
            name: format!("{name}/v"),
            size: None,
            companion: None,
            comparisons: factors.into_iter().enumerate().map(judged).collect(),
            made_by: "alewife 0".to_owned(),
        };
        let links = Links { page: None, pictures: vec!["pictures/a.png".to_owned()] };
        let [title, gist] = ["T", "A case."].map(str::to_owned);
        CaseReport { name: name.to_owned(), title, gist, links, members: vec![member] }
    }

    #[test]
    fn sections_of_other_cases_stay_and_are_counted() {
        let mut page = ReportPage::default();
        page.set(&report("b", [1.0, 1.0]));
        page.set(&report("a", [1.0, 2.0]));
        let text = page.text(&[]);
        assert!(text.contains("3 of 4 values within their band"), "{text}");
        assert!(text.find("## a\n").unwrap() < text.find("## b\n").unwrap());
        assert!(text.contains("\n**T.** A case.\n\n![T](pictures/a.png)\n\nRuns by alewife 0.\n"));
        let mut again = ReportPage::read(&text).unwrap();
        assert_eq!(again, page);
        assert_eq!(again.text(&[]), text);
        let reported = again.text(&["a", "c", "d"]);
        assert!(reported.contains("\nNot on this page yet: `c`, `d`.\n"), "{reported}");
        assert_eq!(ReportPage::read(&reported).unwrap(), page);
        again.set(&report("a", [1.0, 1.0]));
        assert!(again.text(&[]).contains("4 of 4 values within their band"));
        assert!(again.text(&[]).ends_with(text.split("## b\n").nth(1).unwrap()));
    }

    #[test]
    fn a_value_known_to_be_outside_is_listed_as_long_as_its_section_stays() {
        let mut case = report("a", [2.0, 1.0]);
        let value = &mut case.members[0].comparisons[0];
        value.reference.expected.outside = Some("it is hard".to_owned());
        *value = judge("a/v", &value.reference, value.computed.clone(), 1, 0.0);
        let mut page = ReportPage::default();
        page.set(&case);
        let page = ReportPage::read(&page.text(&[])).unwrap().text(&[]);
        assert!(page.contains("1 of 2 values within their band, 1 outside for a known"));
        let line = page.lines().find(|line| line.starts_with("- `a/v`, ")).unwrap();
        assert!(line.ends_with(": it is hard."), "{line}");
        let mut page = ReportPage::read(&page).unwrap();
        page.set(&report("a", [1.0, 1.0]));
        assert!(!page.text(&[]).contains("it is hard"));
    }

    #[test]
    fn runs_alike_share_a_row_and_pages_with_a_column_of_verdicts_are_counted() {
        let mut case = report("a", [1.0, 2.0]);
        let mut own = case.members[0].clone();
        own.name = "a".to_owned();
        case.members.insert(0, own);
        for (member, cpu_seconds) in case.members.iter_mut().zip([1.0, 2.0]) {
            let mesh = MeshSize { cells: 7, shortest_edge: 0.5 };
            member.size = Some(RunSize { mesh, dofs: 9, steps: 3, cpu_seconds });
        }
        let mut page = ReportPage::default();
        page.set(&case);
        let text = page.text(&[]);
        assert!(text.contains("\n| (itself), v | 7 | 9 | 0.5 | 3 | 1.00, 2.00 | - |\n"), "{text}");
        assert_eq!(text.matches(": OUTSIDE |\n").count(), 2, "{text}");
        assert!(text.contains("2 of 4 values within"), "{text}");
        let old = "| quantity | kind | tolerance | verdict |\n|---|---|---|---|\n\
                   | q | exact | 1.0% | within |\n| q | exact | 1.0% | OUTSIDE |\n";
        let old = ReportPage::read(&format!("{TITLE}{HEADING}a\n\n{old}")).unwrap().text(&[]);
        assert!(old.contains("1 of 2 values within"), "{old}");
    }

    #[test]
    fn another_page_is_refused() {
        assert!(ReportPage::read("# Thesis\n\n## a\n").is_err());
        assert!(ReportPage::read("").is_err());
    }

    #[test]
    fn the_uncertainty_is_held_against_exact_values() {
        let mut case = report("a", [1.001, 1.01]);
        for value in &mut case.members[0].comparisons {
            value.reference.expected.kind = ReferenceKind::Exact;
            value.numerical = Some(Ok(0.002 * value.reference.expected.value.abs()));
        }
        let mut page = ReportPage::default();
        page.set(&case);
        let reported = "Of 2 values whose exact value is known, 1 differ from it by less";
        assert!(page.text(&[]).contains(reported), "{}", page.text(&[]));
        case.members[0].comparisons[0].numerical = Some(Err("no | period".to_owned()));
        page.set(&case);
        let reason = "No uncertainty: v, cylinder.drag_coefficient: no \\| period.";
        assert!(page.text(&[]).contains(reason), "{}", page.text(&[]));
    }
}
