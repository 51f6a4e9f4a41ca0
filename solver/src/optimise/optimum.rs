//! `Optimum`: what a search of a flow came to, its report and its files.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use alewife_reduced::search::{
    Bounded, Certainties, Found, Slope, number_lines, numbers_to_json, write_whole,
};
use alewife_reduced::tier::checksum_of_case;
use serde_json::{Value, json};

use super::constraints::Held;
use crate::case::{CaseFile, MeshFile, OptimumReference};

/// What a search of a flow came to.
#[derive(Debug)]
pub struct Optimum {
    /// The case with the numbers that were found.
    pub file: CaseFile,
    /// A number that tells the case it was before from others, which its journals begin with.
    pub searched: String,
    /// The objective at the best.
    pub objective: f64,
    /// The same where the search started.
    pub objective_at_start: f64,
    /// What was held, at the best.
    pub held: Vec<Held>,
    /// The best of the last round, and all evaluations; what is made small is the objective with its sign turned, and what
    /// it costs to be off what is held.
    pub found: Found,
    /// Number of rounds.
    pub n_rounds: usize,
    /// The numbers that were sought.
    pub bounded: Vec<Bounded>,
    /// How well each is determined.
    pub certainties: Certainties,
    /// The slopes of the objective by each.
    pub slopes: Vec<Slope>,
    /// Names of the quantities the objective is made of.
    pub names: Vec<String>,
    /// Their values at the best.
    pub quantities: Vec<f64>,
    /// The same where the search started.
    pub quantities_at_start: Vec<f64>,
    pub(super) references: Vec<OptimumReference>,
}

/// A reference beside what was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The reference.
    pub reference: OptimumReference,
    /// What was found.
    pub computed: f64,
}

/// The mesh of a case that has one of its own, beside it.
const MESH: &str = "mesh.msh";

impl Optimum {
    /// References beside what was found.
    #[must_use]
    pub fn compared(&self) -> Vec<Compared> {
        let compared = |reference: &OptimumReference| Compared {
            computed: self.value(&reference.quantity),
            reference: reference.clone(),
        };
        self.references.iter().map(compared).collect()
    }

    /// What was found, by its name.
    fn value(&self, name: &str) -> f64 {
        if name == "objective" {
            return self.objective;
        }
        if let Some(held) = self.held.iter().find(|held| held.name == name) {
            return held.value;
        }
        let number = self.bounded.iter().position(|one| one.name == name);
        let quantity = self.names.iter().position(|one| one == name);
        number
            .map(|at| self.found.best.values[at])
            .or(quantity.map(|at| self.quantities[at]))
            .unwrap_or(f64::NAN)
    }

    /// The report, as it is printed.
    #[must_use]
    pub fn text(&self) -> String {
        let Found { all, ended, .. } = &self.found;
        let mut text = format!(
            "optimisation after {} evaluations in {} rounds: objective {:.6e}, {:.6e} at the start; {}\n",
            all.len(),
            self.n_rounds,
            self.objective,
            self.objective_at_start,
            ended.text()
        );
        let width = self.names.iter().map(String::len).max().unwrap_or(0);
        let values = self.quantities.iter().zip(&self.quantities_at_start);
        for (name, (value, start)) in self.names.iter().zip(values) {
            let _ = writeln!(text, "  {name:<width$}  {value:.6e}  from {start:.4e}");
        }
        self.held.iter().for_each(|held| text += &held.line());
        text + &number_lines(&self.bounded, &self.found, &self.certainties, &self.slopes)
    }

    /// The report as JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let Found { all, ended, .. } = &self.found;
        let quantities =
            self.names.iter().zip(self.quantities.iter().zip(&self.quantities_at_start));
        let quantities = quantities
            .map(|(name, (value, start))| json!({ "name": name, "value": value, "start": start }));
        json!({
            "search": "optimisation",
            "objective": self.objective,
            "start": self.objective_at_start,
            "evaluations": all.len(),
            "rounds": self.n_rounds,
            "ended": ended.word(),
            "quantities": quantities.collect::<Vec<_>>(),
            "constraints": self.held.iter().map(Held::to_json).collect::<Vec<_>>(),
            "parameters": self.numbers_to_json(),
            "comparison": self.compared().iter().map(Compared::to_json).collect::<Vec<_>>(),
        })
    }

    fn numbers_to_json(&self) -> Value {
        numbers_to_json(&self.bounded, &self.found, &self.certainties, &self.slopes)
    }

    /// All evaluations as a table: the objective, the numbers and its slopes by them.
    fn table(&self) -> String {
        let names = || self.bounded.iter().map(|one| one.name.as_str());
        let slopes = names().map(|name| format!("slope.{name}"));
        let header: Vec<String> = ["evaluation", "objective"]
            .into_iter()
            .chain(names())
            .map(str::to_owned)
            .chain(slopes)
            .collect();
        let mut text = header.join(",") + "\n";
        for (nth, one) in self.found.all.iter().enumerate() {
            let numbers = [-one.objective].into_iter().chain(one.values.iter().copied());
            let numbers = numbers.chain(one.slopes.iter().map(|slope| -slope));
            let cells: Vec<String> = numbers.map(|number| format!("{number:?}")).collect();
            let _ = writeln!(text, "{},{}", nth + 1, cells.join(","));
        }
        text
    }

    /// Writes `evaluations.csv`, `case.toml`, the case with what was found, which runs as it stands there, and then
    /// `report.json`.
    ///
    /// # Errors
    /// What the file system reports.
    pub fn write(&self, directory: &Path) -> io::Result<()> {
        let mut case = self.file.case().naming_mesh(MESH);
        if let Some(mesh) = self.file.case().given_mesh().and_then(MeshFile::bytes) {
            write_whole(&directory.join(MESH), mesh)?;
        }
        // References are values of the case as it was
        case.reference = Vec::new();
        case.variant = Vec::new();
        if let Some(optimisation) = &mut case.optimisation {
            for parameter in &mut optimisation.parameter {
                let found = self.bounded.iter().position(|one| one.name == parameter.name);
                let value = found.map(|at| self.found.best.values[at]);
                parameter.start = value.filter(|_| !parameter.values.is_empty());
            }
        }
        let text = case.to_toml().map_err(io::Error::other)?;
        write_whole(&directory.join("evaluations.csv"), self.table())?;
        write_whole(&directory.join("case.toml"), text)?;
        let mut report = self.to_json();
        report["case"] = json!(checksum_of_case(directory)?);
        report["searched"] = json!(self.searched);
        write_whole(&directory.join("report.json"), format!("{report:#}\n"))
    }
}

impl Compared {
    /// Whether the value is within its tolerance.
    #[must_use]
    pub fn is_within(&self) -> bool {
        (self.computed - self.reference.value).abs() <= self.reference.allowed()
    }

    /// In a line.
    #[must_use]
    pub fn line(&self) -> String {
        let OptimumReference { quantity, value, kind, source, .. } = &self.reference;
        let verdict = if self.is_within() { "within" } else { "OUTSIDE" };
        format!(
            "{verdict:<8} {quantity} = {:.6e}, {value:.6e} +- {:.1e} ({}: {source})",
            self.computed,
            self.reference.allowed(),
            kind.name()
        )
    }

    /// As JSON.
    #[must_use]
    pub fn to_json(&self) -> Value {
        json!({
            "quantity": self.reference.quantity,
            "reference": self.reference.value,
            "allowed": self.reference.allowed(),
            "kind": self.reference.kind.name(),
            "source": self.reference.source,
            "computed": self.computed,
            "within": self.is_within(),
        })
    }
}
