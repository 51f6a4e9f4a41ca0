//! `Sweep`: the points of a sweep, and the case of each of them.

use std::collections::BTreeMap;

use serde_json::Value;

use super::axis_setting;
use super::quantity::SweepQuantity;
use super::range::MOST_POINTS;
use super::spec;
use super::spec::{Block, SweepSpec, SweptKey, overlap};
use crate::Diagnostic;
use crate::model::numbers::reynolds;
use crate::read::case_text::{Located, locate};
use crate::read::files::calibrated_file;
use crate::read::{CaseFile, UntypedCase, wrong};
use crate::soft::{self, SoftFile, is_soft};
use crate::spec::fluid::viscosity::ViscositySpec;
use crate::text::diagnostic::CaseError;
use crate::text::setting;
use crate::text::tree::{TomlNode, TomlValue, TreeError};

/// The number that the viscosity follows where it is swept.
const REYNOLDS: &str = "numbers.reynolds";

/// The key that follows it.
const VISCOSITY: &str = "fluid.viscosity";

/// A case of which several keys take several values.
#[derive(Debug, Clone)]
pub struct Sweep {
    untyped: UntypedCase,
    blocks: Vec<Block>,
    /// Quantities to collect, besides those of references.
    pub quantities: Vec<SweepQuantity>,
    n_points: usize,
}

/// What one point sets.
#[derive(Debug, Clone)]
pub struct SweepPoint {
    settings: Vec<PointSetting>,
}

#[derive(Debug, Clone)]
struct PointSetting {
    path: String,
    value: TomlNode,
}

impl SweepPoint {
    /// The values of all swept keys, in their order.
    #[must_use]
    pub fn values(&self) -> Vec<Value> {
        self.settings.iter().map(|setting| json(&setting.value)).collect()
    }

    /// The same with their keys, as a reader writes them: `fluid.viscosity = 2.0`.
    #[must_use]
    pub fn label(&self) -> String {
        let settings = self.settings.iter();
        settings
            .map(|one| format!("{} = {}", one.path, json(&one.value)))
            .collect::<Vec<_>>()
            .join(", ")
    }
}

impl Sweep {
    /// Reads a case with its `[sweep]`. Settings give a key one value in all points, or
    /// several (`KEY=a:b:n`); both take the place of what `sweep.grid` says of the same key.
    ///
    /// # Errors
    /// [`CaseError`]: no such case, or all that is wrong in it before the first point is made.
    pub fn read(argument: &str, settings: &[String]) -> Result<Self, CaseError> {
        let axes: Vec<Option<Block>> = settings
            .iter()
            .map(|setting| axis_setting::read(setting).map_err(wrong))
            .collect::<Result<_, _>>()?;
        let is_plain =
            |(setting, axis): (&String, &Option<Block>)| axis.is_none().then(|| setting.clone());
        let plain: Vec<String> = settings.iter().zip(&axes).filter_map(is_plain).collect();
        let Located { text, variant } = locate(argument)?;
        let mut untyped = UntypedCase::assemble(&text, variant, &plain)?;
        let SweepSpec { mut blocks, quantities } = match untyped.sweep.take() {
            Some(sweep) => spec::read(&sweep).map_err(wrong)?,
            None => SweepSpec::default(),
        };
        for (setting, axis) in settings.iter().zip(axes) {
            match axis {
                Some(axis) => lay_over(&mut blocks, axis),
                None => fix(&untyped.root, setting, &mut blocks),
            }
            .map_err(wrong)?;
        }
        if blocks.is_empty() {
            let help = "add a [sweep] to the case, or --set KEY=FROM:TO:N, such as --set \
                        fluid.viscosity=1:10:4";
            return Err(CaseError::at("sweep", "no key of the case is swept".to_owned(), help));
        }
        let n_points = blocks
            .iter()
            .try_fold(1_usize, |n, block| n.checked_mul(block.rows.len()))
            .filter(|n| *n <= MOST_POINTS)
            .ok_or_else(|| {
                let help =
                    "take fewer values of some keys, or points at random: sweep.latin-hypercube";
                let message = format!("the sweep has more than {MOST_POINTS} points");
                CaseError::at("sweep", message, help)
            })?;
        Ok(Self { untyped, blocks, quantities, n_points })
    }

    /// Name of the case, with its variant.
    #[must_use]
    pub fn name(&self) -> String {
        self.untyped.full_name()
    }

    /// Name of the file of the case.
    #[must_use]
    pub fn file(&self) -> &str {
        self.untyped.file()
    }

    /// Paths of the keys that are swept.
    #[must_use]
    pub fn keys(&self) -> Vec<&str> {
        self.blocks.iter().flat_map(|block| &block.keys).map(|key| key.path.as_str()).collect()
    }

    /// Number of points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.n_points
    }

    /// The point of an index below [`n_points`](Self::n_points): keys that come last change first.
    #[must_use]
    pub fn point(&self, index: usize) -> SweepPoint {
        let mut rest = index;
        let mut rows: Vec<usize> = Vec::with_capacity(self.blocks.len());
        for block in self.blocks.iter().rev() {
            rows.push(rest % block.rows.len());
            rest /= block.rows.len();
        }
        let mut settings = Vec::new();
        for (block, row) in self.blocks.iter().zip(rows.iter().rev()) {
            let keys = block.keys.iter().map(|SweptKey { path, .. }| path.clone());
            let values = block.rows[*row].iter().cloned();
            settings.extend(keys.zip(values).map(|(path, value)| PointSetting { path, value }));
        }
        SweepPoint { settings }
    }

    /// The case of a point, typed and not checked.
    ///
    /// # Errors
    /// [`CaseError::Wrong`] with what is wrong in it.
    pub fn case(&self, index: usize) -> Result<CaseFile, CaseError> {
        let mut untyped = self.set(index)?;
        if !self.keys().contains(&REYNOLDS) || self.keys().contains(&VISCOSITY) {
            return untyped.typed();
        }
        let file = untyped.clone().typed()?;
        let Some(value) = viscosity_by_reynolds(&file) else { return Ok(file) };
        let Some(node) = untyped.root.get(REYNOLDS).cloned() else { return Ok(file) };
        let node = TomlNode { value: TomlValue::Float(value), ..node };
        untyped.root.set(VISCOSITY, node).map_err(wrong)?;
        untyped.typed()
    }

    /// Whether it is of a soft case, an elastic body without a flow.
    #[must_use]
    pub fn is_soft(&self) -> bool {
        is_soft(&self.untyped.root)
    }

    /// The soft case of a point, typed and not checked.
    ///
    /// # Errors
    /// [`CaseError::Wrong`] with what is wrong in it.
    pub fn soft_case(&self, index: usize) -> Result<SoftFile, CaseError> {
        SoftFile::typed(self.set(index)?)
    }

    /// The case of a point, not typed yet.
    fn set(&self, index: usize) -> Result<UntypedCase, CaseError> {
        let mut untyped = self.untyped.clone();
        let before = untyped.root.get("reduced").cloned();
        for PointSetting { path, value } in self.point(index).settings {
            untyped.root.set(&path, value).map_err(wrong)?;
        }
        calibrated_file::laid_over(before.as_ref(), &mut untyped.root).map_err(wrong)?;
        Ok(untyped)
    }

    /// What is wrong in a soft case of the sweep, with quantities to collect that its run does not have.
    #[must_use]
    pub fn check_soft(&self, file: &SoftFile) -> Vec<Diagnostic> {
        let known = file.case.quantities();
        let mut found = soft::check(file);
        found.extend(self.quantities.iter().filter_map(|one| one.mistake_among(&known)));
        found
    }

    /// What is wrong in a case of the sweep: all that [`check`](crate::check) finds, and quantities to
    /// collect that its run does not have.
    #[must_use]
    pub fn check(&self, file: &CaseFile) -> Vec<Diagnostic> {
        let mut found = crate::check(file);
        found.extend(self.quantities.iter().filter_map(|one| one.mistake(&file.model)));
        found
    }
}

/// The viscosity (Pa s) of a Newtonian fluid by which a case has the Reynolds number that it declares, by the scales
/// it has; nothing where these give none.
fn viscosity_by_reynolds(file: &CaseFile) -> Option<f64> {
    let case = file.case();
    let ViscositySpec::Newtonian(viscosity) = case.fluid.viscosity else { return None };
    let wanted = case.numbers.reynolds.filter(|number| *number > 0.0)?;
    let value = viscosity * reynolds(case)? / wanted;
    (value > 0.0 && value.is_finite()).then_some(value)
}

/// Adds what the command line sweeps, in the place of what the file says of the same key.
fn lay_over(blocks: &mut Vec<Block>, axis: Block) -> Result<(), TreeError> {
    let [key] = &axis.keys[..] else { return Ok(()) };
    let meets = |block: &Block| block.keys.iter().any(|other| overlap(&other.path, &key.path));
    match blocks.iter().position(meets) {
        None => blocks.push(axis),
        Some(at) if matches!(&blocks[at].keys[..], [other] if other.path == key.path) => {
            blocks[at] = axis;
        }
        Some(_) => {
            return Err(TreeError {
                origin: key.origin.clone(),
                message: format!("`{}` is swept together with other keys already", key.path),
                help: "change the [sweep] of the file instead".to_owned(),
            });
        }
    }
    Ok(())
}

/// Puts a setting that gives a swept key one value in the place of its values.
fn fix(root: &TomlNode, text: &str, blocks: &mut [Block]) -> Result<(), TreeError> {
    let setting::Setting { path, value } = setting::read(root, text)?;
    let meets = |block: &&mut Block| block.keys.iter().any(|key| overlap(&key.path, &path));
    match blocks.iter_mut().find(meets) {
        None => Ok(()),
        Some(Block { keys, rows }) if keys.len() == 1 && keys[0].path == path => {
            *rows = vec![vec![value]];
            Ok(())
        }
        Some(Block { keys, .. }) => Err(TreeError {
            origin: value.origin,
            message: format!("`{path}` is set once, and `{}` is swept", keys[0].path),
            help: "leave the setting out, or change the [sweep] of the file".to_owned(),
        }),
    }
}

/// A value as JSON.
fn json(node: &TomlNode) -> Value {
    match &node.value {
        TomlValue::String(text) | TomlValue::Date(text) => text.clone().into(),
        TomlValue::Integer(value) => (*value).into(),
        TomlValue::Float(value) => (*value).into(),
        TomlValue::Boolean(value) => (*value).into(),
        TomlValue::Array(items) => items.iter().map(json).collect(),
        TomlValue::Table(entries) => {
            let entries: BTreeMap<_, _> =
                entries.iter().map(|(key, entry)| (key.clone(), json(entry))).collect();
            Value::Object(entries.into_iter().collect())
        }
    }
}
