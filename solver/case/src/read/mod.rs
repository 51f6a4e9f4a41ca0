//! TOML to `Case`; unknown keys refused with file, line and column.
//!
//! A case is put together in this order, the later over the earlier: the file it `extends`, the
//! file itself, the variant, the settings of the command line. Tables are merged, everything else
//! is replaced. `reference`, `references`, `variant`, `quick` and `sweep` of an extended file are not
//! inherited: what is known of one problem does not hold for another. Then the values of files take the place of
//! their names.

pub(crate) mod case_text;
mod columns;
pub(crate) mod directory_name;
pub(crate) mod elsewhere;
pub(crate) mod files;
pub mod library;
mod named_file;
pub(crate) mod problem_keys;
pub(crate) mod recording;
mod reference_rows;
mod reference_table;
pub(crate) mod schema;
pub(crate) mod sought;
mod typing;
mod variants;

use std::sync::Arc;

use self::case_text::{
    CaseText, Located, is_same_file, locate, no_such_case, read_file, shipped_text, stem,
};
use self::columns::{midline_file, probe_line, profile_file, seed_file};
use self::files::stroke_file::RecordedStroke;
use self::files::{
    calibrated_file, data_files, hole_shape, outline_file, periodic_sides, read_mesh, region_file,
    stroke_file, surface_file,
};
use self::reference_rows::REFERENCES;
use self::typing::typed;
use self::variants::{apply_variant, check_names, variant_names};
use crate::spec::reduced::left_out::{Completed, completed};
use crate::sweep::spec;
use crate::text::diagnostic::{CaseError, Diagnostic, Severity};
use crate::text::names::SWEEP;
use crate::text::setting;
use crate::text::source::{Location, Source};
use crate::text::tree::{self, Found, TomlNode, TomlValue, TreeError};
use crate::{Case, Model, ShapeSpec};

/// Keys of a file that those who extend it do not inherit.
const OWN_KEYS: [&str; 5] = ["reference", REFERENCES, "variant", "quick", SWEEP];

/// A case and where everything in it is written.
#[derive(Debug, Clone)]
pub struct CaseFile {
    /// What follows from the case, with `extends`, variant and settings applied.
    pub model: Model,
    /// Name: that of the file, or of its directory if the file is `case.toml`.
    pub name: String,
    /// The variant that was applied.
    pub variant: Option<String>,
    /// Names of all variants the file has.
    pub variants: Vec<String>,
    /// Name of the file that was read.
    pub file: String,
    /// Whether the file has a `[sweep]`.
    pub has_sweep: bool,
    /// Strokes that were read from files.
    pub(crate) recorded: Vec<RecordedStroke>,
    root: TomlNode,
}

/// A number as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenNumber {
    /// Its key, with its tables.
    pub path: String,
    /// The number.
    pub value: f64,
}

impl CaseFile {
    /// The case as it is written, with `extends`, variant and settings applied.
    #[must_use]
    pub fn case(&self) -> &Case {
        &self.model.case
    }

    /// Where the value at a dotted path is written, or the table it would stand in.
    #[must_use]
    pub fn location(&self, path: &str) -> Option<Location> {
        location(&self.root, path)
    }

    /// All numbers that are written, but for those of variants.
    pub(crate) fn numbers(&self) -> Vec<WrittenNumber> {
        let mut numbers = Vec::new();
        for (key, node) in self.root.table().into_iter().flatten() {
            if key != "variant" {
                collect_numbers(node, key.clone(), &mut numbers);
            }
        }
        numbers
    }

    /// The number that is written at a dotted path, if there is one.
    #[must_use]
    pub fn number(&self, path: &str) -> Option<f64> {
        match self.root.get(path)?.value {
            TomlValue::Float(value) => Some(value),
            TomlValue::Integer(value) => Some(value as f64),
            _ => None,
        }
    }

    /// The keys of all numbers that are written, but for those of variants.
    #[must_use]
    pub fn number_keys(&self) -> Vec<String> {
        self.numbers().into_iter().map(|number| number.path).collect()
    }

    /// Name and variant: `sphere-in-tube/free-0.5`.
    #[must_use]
    pub fn full_name(&self) -> String {
        full_name(&self.name, self.variant.as_deref())
    }
}

fn full_name(name: &str, variant: Option<&str>) -> String {
    variant.map_or_else(|| name.to_owned(), |variant| format!("{name}/{variant}"))
}

impl Case {
    /// Reads a case: a path to a TOML file, the name of a shipped case, or either followed by
    /// `/VARIANT`; then sets `KEY=VALUE` for each of `settings`.
    ///
    /// # Errors
    /// [`CaseError`]: no such case, a file that cannot be read, or all that is wrong in it.
    pub fn read(argument: &str, settings: &[String]) -> Result<CaseFile, CaseError> {
        let Located { text, variant } = locate(argument)?;
        UntypedCase::assemble(&text, variant, settings)?.typed()
    }

    /// The text of a case as it is written, with the table of its references in it.
    ///
    /// # Errors
    /// [`CaseError`]: no such case, or a file that cannot be read.
    pub fn text(argument: &str) -> Result<String, CaseError> {
        Ok(reference_table::with_table(&locate(argument)?.text.source))
    }

    /// Reads a case from a text; `name` stands for its file in messages.
    ///
    /// # Errors
    /// [`CaseError::Wrong`] with all that is wrong in it.
    pub fn parse(name: &str, text: &str, settings: &[String]) -> Result<CaseFile, CaseError> {
        let source = Source { name: name.to_owned(), directory: None, text: text.to_owned() };
        let text = CaseText { name: stem(name), source: Arc::new(source) };
        UntypedCase::assemble(&text, None, settings)?.typed()
    }

    /// The case as a TOML text, with all defaults written out.
    ///
    /// # Errors
    /// When a value cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        if self.left_out.is_empty() {
            return toml::to_string_pretty(self);
        }
        let mut table = toml::Table::try_from(self)?;
        for name in &self.left_out {
            table.remove(*name);
        }
        toml::to_string_pretty(&table)
    }
}

pub(crate) fn collect_numbers(node: &TomlNode, path: String, numbers: &mut Vec<WrittenNumber>) {
    match &node.value {
        TomlValue::Float(value) => numbers.push(WrittenNumber { path, value: *value }),
        TomlValue::Integer(value) => {
            numbers.push(WrittenNumber { path, value: *value as f64 });
        }
        TomlValue::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                collect_numbers(item, format!("{path}.{index}"), numbers);
            }
        }
        TomlValue::Table(entries) => {
            for (key, entry) in entries {
                collect_numbers(entry, format!("{path}.{key}"), numbers);
            }
        }
        _ => {}
    }
}

/// A case that is put together and not typed yet.
#[derive(Debug, Clone)]
pub(crate) struct UntypedCase {
    /// Name, and name of the file.
    pub names: [String; 2],
    variant: Option<String>,
    variants: Vec<String>,
    /// The case, without its sweep.
    pub root: TomlNode,
    /// What a sweep varies, if the file has one.
    pub sweep: Option<TomlNode>,
}

impl UntypedCase {
    /// Puts the tree together.
    pub fn assemble(
        text: &CaseText,
        variant: Option<String>,
        settings: &[String],
    ) -> Result<Self, CaseError> {
        let mut root = extended(text)?;
        let variants = variant_names(&root);
        check_names(&root)?;
        let before = reduced_of(&root);
        if let Some(variant) = &variant {
            apply_variant(&mut root, &text.source, variant).map_err(wrong)?;
        }
        calibrated_file::laid_over(before.as_ref(), &mut root).map_err(wrong)?;
        let before = reduced_of(&root);
        for setting in settings {
            let setting::Setting { path, value } = setting::read(&root, setting).map_err(wrong)?;
            if path.split('.').next() == Some(REFERENCES) {
                return Err(wrong(TreeError {
                    origin: value.key,
                    message: "[references] is read with its file, before anything is set"
                        .to_owned(),
                    help: "set entries of `reference`, or write a file that extends the case"
                        .to_owned(),
                }));
            }
            root.set(&path, value).map_err(wrong)?;
        }
        calibrated_file::laid_over(before.as_ref(), &mut root).map_err(wrong)?;
        let sweep = root.table_mut().and_then(|entries| entries.remove(SWEEP));
        let names = [&text.name, &text.source.name].map(ToOwned::to_owned);
        Ok(Self { names, variant, variants, root, sweep })
    }

    /// Name and variant: `sphere-in-tube/free-0.5`.
    pub fn full_name(&self) -> String {
        full_name(&self.names[0], self.variant.as_deref())
    }

    /// Name of the file that was read.
    pub fn file(&self) -> &str {
        &self.names[1]
    }

    /// Reads its sweep to find what is wrong in it.
    pub fn check_sweep(&self) -> Result<(), CaseError> {
        self.sweep.as_ref().map_or(Ok(()), |sweep| spec::read(sweep).map(drop).map_err(wrong))
    }

    /// Types it; a sweep is read to find what is wrong in it, and left out.
    pub fn typed(mut self) -> Result<CaseFile, CaseError> {
        self.check_sweep()?;
        data_files::resolve(&mut self.root)?;
        outline_file::resolve(&mut self.root).map_err(wrong)?;
        seed_file::resolve(&mut self.root).map_err(wrong)?;
        probe_line::resolve(&mut self.root).map_err(wrong)?;
        midline_file::resolve(&mut self.root).map_err(wrong)?;
        profile_file::resolve(&mut self.root).map_err(wrong)?;
        let recorded = stroke_file::resolve(&mut self.root).map_err(wrong)?;
        region_file::resolve(&mut self.root).map_err(wrong)?;
        calibrated_file::resolve(&mut self.root).map_err(wrong)?;
        let Completed { root: mut complete, left_out } = completed(&self.root).map_err(wrong)?;
        hole_shape::without_center(&mut complete);
        let mut case = typed(&complete)?;
        case.left_out = left_out;
        read_mesh::read_into(&mut case, &self.root).map_err(wrong)?;
        periodic_sides::complete(&mut case);
        periodic_sides::read_into(&mut case, &self.root).map_err(wrong)?;
        hole_shape::read_into(&mut case, &self.root).map_err(wrong)?;
        region_file::read_into(&mut case, &self.root).map_err(wrong)?;
        surface_file::read_into(&mut case, &self.root).map_err(wrong)?;
        complete_cylinders(&mut case);
        let model = Model::new(case).map_err(|error| located(&self.root, error))?;
        let [name, file] = self.names;
        Ok(CaseFile {
            model,
            name,
            variant: self.variant,
            variants: self.variants,
            file,
            has_sweep: self.sweep.is_some(),
            recorded,
            root: self.root,
        })
    }
}

/// Where the value at a dotted path is written, or the table it would stand in.
pub(crate) fn location(root: &TomlNode, path: &str) -> Option<Location> {
    let Found { node, is_exact } = root.find(path);
    // A default is nowhere: its table is the next best location, by its header or its key.
    let is_value = is_exact && (node.table().is_none() || node.is_inline());
    let origin = if is_value { &node.origin } else { &node.key };
    (!origin.span.is_empty()).then(|| origin.location())
}

/// An error with the locations of the keys it names.
fn located(root: &TomlNode, error: CaseError) -> CaseError {
    let CaseError::Wrong(mut diagnostics) = error else { return error };
    for diagnostic in &mut diagnostics {
        diagnostic.location = location(root, &diagnostic.key);
    }
    CaseError::Wrong(diagnostics)
}

pub(crate) fn wrong(error: TreeError) -> CaseError {
    CaseError::Wrong(vec![Diagnostic {
        severity: Severity::Error,
        key: String::new(),
        message: error.message,
        help: error.help,
        location: Some(error.origin.location()),
    }])
}

/// The tree of a text, laid over that of the file it extends.
fn extended(text: &CaseText) -> Result<TomlNode, CaseError> {
    let mut root = tree::parse(&text.source).map_err(wrong)?;
    reference_table::resolve(&mut root)?;
    let Some(extends) = root.table_mut().and_then(|entries| entries.remove("extends")) else {
        calibrated_file::laid_over(None, &mut root).map_err(wrong)?;
        return Ok(root);
    };
    let refused = |message: String, help: &str| {
        wrong(TreeError { origin: extends.origin.clone(), message, help: help.to_owned() })
    };
    let Some(name) = extends.text() else {
        return Err(refused(
            "`extends` is not a string".to_owned(),
            "give the relative path of a case file, or the name of a shipped case",
        ));
    };
    let found = match (&text.source.directory, name.ends_with(".toml")) {
        (Some(directory), true) => read_file(&directory.join(name)),
        (None, true) => {
            return Err(refused(
                format!("`{name}` cannot be reached from here"),
                "a shipped case, or a text without a file, extends a shipped case by its name",
            ));
        }
        (_, false) => library::find(name).map(shipped_text).ok_or_else(|| no_such_case(name)),
    };
    let parent = found.map_err(|error| match error {
        CaseError::NotFound { what, help } => refused(format!("`extends`: {what}"), &help),
        other => other,
    })?;
    if is_same_file(&parent.source.name, &text.source.name) {
        return Err(refused(
            format!("{} extends itself", text.source.name),
            "give another file, or the name of a shipped case",
        ));
    }
    let mut base = tree::parse(&parent.source).map_err(wrong)?;
    if let Some(entries) = base.table_mut() {
        if let Some(second) = entries.get("extends") {
            return Err(wrong(TreeError {
                origin: second.key.clone(),
                message: format!("{} extends another file itself", parent.source.name),
                help: format!(
                    "one level of `extends` is allowed: let {} extend that file directly",
                    text.source.name
                ),
            }));
        }
        entries.retain(|key, _| !OWN_KEYS.contains(&key.as_str()));
    }
    calibrated_file::laid_over(None, &mut base).map_err(wrong)?;
    let before = reduced_of(&base);
    base.merge(root);
    calibrated_file::laid_over(before.as_ref(), &mut base).map_err(wrong)?;
    Ok(base)
}

/// What a tree has of `reduced`, before anything is laid over it.
fn reduced_of(root: &TomlNode) -> Option<TomlNode> {
    root.get("reduced").cloned()
}

/// Cylinders that go through a box are as long as it is.
fn complete_cylinders(case: &mut Case) {
    // The extent of the inside of a surface takes its mesh
    if !case.body.iter().any(|body| matches!(body.shape, ShapeSpec::Cylinder { .. })) {
        return;
    }
    let lengths = case.extent().lengths();
    for body in &mut case.body {
        if let ShapeSpec::Cylinder { axis, length, .. } = &mut body.shape {
            *length = lengths[axis.index()];
        }
    }
}
