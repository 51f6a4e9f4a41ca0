//! The section of a case on the page of a validation: set-up, meshes, values, sources, disagreements.

use super::comparison::{Comparison, Verdict};
use super::evidence::Evidence;
use super::report::two_digits;
use super::uncertainty::{Refinement, RunSize};
use crate::case::{ReferenceKind, significant};

/// What the page says of a case.
#[derive(Debug, Clone)]
pub struct CaseReport {
    /// Its name, without a variant.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The sentence that says its set-up.
    pub gist: String,
    /// Its page and pictures.
    pub links: Links,
    /// Its runs.
    pub members: Vec<MemberReport>,
}

/// What the section of a case leads to, as links from the page.
#[derive(Debug, Clone, Default)]
pub struct Links {
    /// The page of the case.
    pub page: Option<String>,
    /// Pictures of it.
    pub pictures: Vec<String>,
}

/// One run of a case against its references.
#[derive(Debug, Clone)]
pub struct MemberReport {
    /// Name of the case, with its variant.
    pub name: String,
    /// What it was made with, unless it failed or nobody asked.
    pub size: Option<RunSize>,
    /// Its companion, or why there is none; nothing if nobody asked.
    pub companion: Option<Result<Companion, String>>,
    /// Its values.
    pub comparisons: Vec<Comparison>,
    /// Which program made it and when.
    pub made_by: String,
}

/// A run with longer cells and steps beside another one.
#[derive(Debug, Clone)]
pub struct Companion {
    /// What it was made with.
    pub size: RunSize,
    /// How it differs, or why no uncertainty follows from it.
    pub refinement: Result<Refinement, String>,
}

/// The variant in the name of a case.
fn variant_of(name: &str) -> &str {
    name.split_once('/').map_or("", |(_, variant)| variant)
}

/// The row of runs that have one mesh, number of steps and companion in common.
struct SizeRow {
    /// Cells, unknowns, shortest edge, steps, companion.
    common: [String; 5],
    variants: Vec<String>,
    cpu_seconds: Vec<String>,
}

impl SizeRow {
    fn from_member(member: &MemberReport) -> Self {
        let companion = match &member.companion {
            None => "-".to_owned(),
            Some(Err(reason)) => format!("none: {}", in_a_cell(reason)),
            Some(Ok(companion)) => companion.in_words(),
        };
        let none = || "-".to_owned();
        let (common, cpu_seconds) = match &member.size {
            Some(size) => {
                let edge = significant(size.mesh.shortest_edge);
                let [cells, steps] = [size.mesh.cells, size.steps].map(|n| n.to_string());
                let common = [cells, size.dofs.to_string(), edge, steps, companion];
                (common, format!("{:.2}", size.cpu_seconds))
            }
            None => ([none(), none(), none(), none(), companion], none()),
        };
        let variants = vec![variant_of(&member.name).to_owned()];
        Self { common, variants, cpu_seconds: vec![cpu_seconds] }
    }

    fn as_text(&self) -> String {
        let named = |variant: &String| match variant.as_str() {
            "" if self.variants.len() > 1 => "(itself)".to_owned(),
            variant => variant.to_owned(),
        };
        let variants: Vec<String> = self.variants.iter().map(named).collect();
        let [cells, unknowns, edge, steps, companion] = self.common.clone();
        let cpu_seconds = self.cpu_seconds.join(", ");
        row(&[variants.join(", "), cells, unknowns, edge, steps, cpu_seconds, companion])
    }
}

/// The table of meshes, steps and companions.
fn sizes(members: &[MemberReport]) -> String {
    let mut rows: Vec<SizeRow> = Vec::new();
    for one in members.iter().map(SizeRow::from_member) {
        if let Some(row) = rows.iter_mut().find(|row| row.common == one.common) {
            row.variants.extend(one.variants);
            row.cpu_seconds.extend(one.cpu_seconds);
        } else {
            rows.push(one);
        }
    }
    let header = "\n| variants | cells | unknowns | shortest edge | steps | CPU (s) | companion |\n\
                  |---|---|---|---|---|---|---|\n";
    header.to_owned() + &rows.iter().map(SizeRow::as_text).collect::<String>()
}

impl Companion {
    fn in_words(&self) -> String {
        let (cells, steps) = (self.size.mesh.cells, self.size.steps);
        let steps = if steps == 0 { String::new() } else { format!(", {steps} steps") };
        match &self.refinement {
            Ok(Refinement { ratio, order }) => {
                format!("{cells} cells{steps}; ratio {ratio:.2}, order {order}")
            }
            Err(reason) => format!("{cells} cells{steps}; {}", in_a_cell(reason)),
        }
    }
}

/// A text as it may stand in a table.
fn in_a_cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// What is between a tolerance and the verdict, which most rows do without: they are within.
pub(super) const VERDICT: &str = ": ";

pub(super) fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// The section below its heading.
pub(super) fn section(case: &CaseReport) -> String {
    let CaseReport { title, gist, links, members, .. } = case;
    let more = links.page.as_ref().map_or(String::new(), |page| format!(" [More]({page})."));
    let mut text = format!("**{title}.** {gist}{more}\n");
    for picture in &links.pictures {
        text += &format!("\n![{title}]({picture})\n");
    }
    let made_by = each_once(members.iter().map(|member| member.made_by.clone()));
    text += &format!("\nRuns by {}.\n", made_by.join("; "));
    if members.iter().any(|member| member.size.is_some()) {
        text += &sizes(members);
    }
    text += "\n| variant | quantity | computed | ± | reference | ± | kind | difference | evidence | band \
             |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for member in members {
        for (index, value) in member.comparisons.iter().enumerate() {
            let variant = if index == 0 { variant_of(&member.name) } else { "" };
            text += &value_row(variant, value);
        }
    }
    let values: Vec<&Comparison> = members.iter().flat_map(|member| &member.comparisons).collect();
    text += &coverage(&values).map_or(String::new(), |reported| format!("\n{reported}\n"));
    text += &sources(&values);
    text += &reasons(members);
    text
}

fn value_row(variant: &str, value: &Comparison) -> String {
    let [_, quantity, computed, reference, kind, difference, evidence, band, verdict] =
        value.cells();
    let share = |own: Option<f64>| own.map_or("-".to_owned(), |own| value.share(own));
    let numerical = share(value.numerical_share());
    let uncertainty = share(value.reference_share());
    let band = match value.verdict {
        Verdict::Within => band,
        _ => format!("{band}{VERDICT}{verdict}"),
    };
    row(&[
        variant.to_owned(),
        quantity,
        computed,
        numerical,
        reference,
        uncertainty,
        kind,
        difference,
        evidence,
        band,
    ])
}

/// How often the numerical uncertainty covers what is wrong with a value, where that is known: a check of
/// the rule.
fn coverage(values: &[&Comparison]) -> Option<String> {
    let wrong_by = |value: &Comparison| {
        let numerical = value.numerical_uncertainty()?;
        let is_exact = value.reference.expected.kind == ReferenceKind::Exact;
        let difference = value.computed.as_ref().ok()? - value.reference.expected.value;
        is_exact.then_some(difference.abs() <= numerical)
    };
    let covered: Vec<bool> = values.iter().filter_map(|value| wrong_by(value)).collect();
    let n = covered.iter().filter(|is_covered| **is_covered).count();
    (!covered.is_empty()).then(|| Coverage { n, of: covered.len() }.in_words())
}

/// How many differences from exact values are within the numerical uncertainty.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Coverage {
    pub n: usize,
    pub of: usize,
}

impl Coverage {
    const BEFORE: &'static str = "Within the numerical uncertainty of the exact value: ";

    fn in_words(self) -> String {
        format!("{}{} of {}.", Self::BEFORE, self.n, self.of)
    }

    /// That of a line of a section.
    pub fn read(line: &str) -> Option<Self> {
        let (n, of) = line.strip_prefix(Self::BEFORE)?.strip_suffix('.')?.split_once(" of ")?;
        Some(Self { n: n.parse().ok()?, of: of.parse().ok()? })
    }
}

fn sources(values: &[&Comparison]) -> String {
    let all = each_once(values.iter().map(|value| {
        let date = value
            .reference
            .expected
            .date
            .as_ref()
            .map_or(String::new(), |date| format!(", {date}"));
        let note = value
            .reference
            .expected
            .note
            .as_ref()
            .map_or(String::new(), |note| format!(" ({note})"));
        format!("{}{date}{note}", value.reference.expected.source)
    }));
    let list: String = all.iter().map(|source| format!("- {source}\n")).collect();
    format!("\nSources:\n\n{list}")
}

/// Why values are outside, were not computed or have no uncertainty.
fn reasons(members: &[MemberReport]) -> String {
    let values = || members.iter().flat_map(|member| &member.comparisons);
    let mut lines = each_once(values().filter_map(|value| {
        Some(format!("Outside, known: {}.", value.reference.expected.outside.as_ref()?))
    }));
    lines.extend(causes(members));
    let named = |value: &Comparison| {
        let variant = variant_of(&value.case);
        let between = if variant.is_empty() { "" } else { ", " };
        format!("{variant}{between}{}", value.quantity)
    };
    for member in members {
        // What holds of a whole companion is in its row
        let is_of_all =
            matches!(member.companion, Some(Err(_) | Ok(Companion { refinement: Err(_), .. })));
        for value in &member.comparisons {
            let numerical = value.numerical.as_ref().and_then(|numerical| numerical.as_ref().err());
            if let Err(reason) = &value.computed {
                lines.push(format!("Not computed: {}: {}.", named(value), in_a_cell(reason)));
            } else if let Some(reason) = numerical.filter(|_| !is_of_all) {
                lines.push(format!("No uncertainty: {}: {}.", named(value), in_a_cell(reason)));
            }
        }
    }
    each_once(lines.into_iter()).iter().map(|line| format!("\n{line}\n")).collect()
}

/// Why values are only consistent with their references, a line for each cause.
fn causes(members: &[MemberReport]) -> Vec<String> {
    let values = members.iter().flat_map(|member| &member.comparisons);
    let reported = values.filter_map(|value| {
        let cause = value.reference.expected.cause.as_ref()?;
        let is_open = matches!(value.evidence(), Some(Evidence::Consistent(_)));
        is_open.then(|| format!("Consistent, not confirmed: {cause}."))
    });
    each_once(reported)
}

/// The values that are known to be outside, as lines of a list with the reason of each.
pub(super) fn known_outside(case: &CaseReport) -> Vec<String> {
    let values = case.members.iter().flat_map(|member| &member.comparisons);
    let outside = values.filter(|value| value.verdict == Verdict::KnownOutside);
    let line = |value: &Comparison| {
        let [case, quantity, computed, reference, _, difference, _, band, _] = value.cells();
        let reason = value.reference.expected.outside.as_deref().unwrap_or_default();
        let numerical = value
            .numerical_uncertainty()
            .map_or(String::new(), |own| format!(" ± {}", two_digits(own)));
        format!(
            "- `{case}`, {quantity}: {computed}{numerical} for {reference} ({difference}, \
             band {band}): {reason}."
        )
    };
    outside.map(line).collect()
}

/// Lines in their order, each the first time only.
fn each_once(lines: impl Iterator<Item = String>) -> Vec<String> {
    let mut listed = Vec::new();
    for line in lines {
        if !listed.contains(&line) {
            listed.push(line);
        }
    }
    listed
}
