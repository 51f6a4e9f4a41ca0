//! Soft cases, reduced models and optima of steady flows in a validation: what is computed, against their references.

use std::path::{Path, PathBuf};

use alewife_reduced::tier::{
    Bodies, Compared as SoftCompared, Job, Model, SolidOf, TierError, Which, compare, series,
};

use super::super::exit::{Exit, Failure};
use super::super::optimise::search_failure;
use super::super::read::{CheckedCase, read_and_check};
use super::members::{LeftOut, members_of};
use crate::case::soft::SoftFile;
use crate::case::soft::spec::ReferenceOf;
use crate::case::{
    Case, CaseFile, Expected, OptimumReference, Reference, Statistic, StatisticKind, directory_name,
};
use crate::observer::Origin;
use crate::optimise::{Compared, FlowSearch};
use crate::reduced::{ReducedError, simulate};
use crate::validation::{Comparison, MemberReport, Verdict, compare_series};

/// What a validation computes besides runs of flows.
pub enum Searched {
    /// Motion and searches of a soft case.
    Soft(Box<SoftFile>),
    /// The optimum of a flow or of a reduced motion.
    Optimum(Box<CaseFile>),
    /// A case or a variant that has a reduced model alone.
    Reduced(Box<CaseFile>),
}

/// Names of cases, by what is done with them.
pub struct Split {
    /// Cases of flows, which are run.
    pub flows: Vec<String>,
    /// Soft cases, and optima of flows.
    pub searched: Vec<Searched>,
}

/// Finds out which of these cases are soft, and which have an optimum with references.
///
/// # Errors
/// With all that is wrong in a case, and that of `is_to_end`, which is asked before each. What has data that is elsewhere
/// is left out.
pub fn split(
    names: &[String],
    only_quick: bool,
    left_out: &LeftOut,
    is_to_end: &dyn Fn() -> Result<(), Failure>,
) -> Result<Split, Failure> {
    let mut split = Split { flows: Vec::new(), searched: Vec::new() };
    for name in names {
        is_to_end()?;
        if left_out.takes(name) {
            continue;
        }
        match SoftFile::read_if_soft(name, &[]) {
            Ok(Some(file)) if !only_quick => {
                let variants = file.case.variant.clone();
                split.searched.push(Searched::Soft(Box::new(file)));
                for variant in variants {
                    let name = format!("{name}/{}", variant.name);
                    if !left_out.takes(&name) {
                        let file = SoftFile::read(&name, &[])?;
                        split.searched.push(Searched::Soft(Box::new(file)));
                    }
                }
            }
            Ok(Some(_)) => {}
            Ok(None) if has_no_flow(name) => {
                for member in members_of(name, only_quick)? {
                    let CheckedCase { file, .. } = read_and_check(&member, &[])?;
                    split.searched.push(Searched::Reduced(Box::new(file)));
                }
                split.searched.extend(optimum(name, only_quick)?);
            }
            Ok(None) => {
                split.flows.push(name.clone());
                split.searched.extend(optimum(name, only_quick)?);
            }
            Err(error) => {
                let said = error.to_string();
                let of_flow = Case::read(name, &[]).err();
                if of_flow.is_some_and(|other| other.to_string() == said) {
                    // It is told with all that is wrong in other cases
                    split.flows.push(name.clone());
                } else {
                    return Err(Failure::from(error).of(name));
                }
            }
        }
    }
    Ok(split)
}

/// Whether a case has a reduced model alone.
fn has_no_flow(name: &str) -> bool {
    // What is wrong in a case is told where its runs are read
    Case::read(name, &[]).is_ok_and(|file| file.case().is_reduced_only())
}

/// The optimum of a case, if it has references.
fn optimum(name: &str, only_quick: bool) -> Result<Option<Searched>, Failure> {
    // What is wrong in a case is told where its runs are read
    let Ok(CheckedCase { file, .. }) = read_and_check(name, &[]) else { return Ok(None) };
    let has_references =
        file.case().optimisation.as_ref().is_some_and(|own| !own.reference.is_empty());
    let is_wanted = has_references && (file.case().quick || !only_quick);
    Ok(is_wanted.then(|| Searched::Optimum(Box::new(file))))
}

impl Searched {
    /// Name of the case.
    pub fn name(&self) -> String {
        match self {
            Self::Soft(file) => file.name.clone(),
            Self::Optimum(file) | Self::Reduced(file) => file.full_name(),
        }
    }

    /// What is computed and compared; searches have their journals in directories of their own in `out`, or in one
    /// that is taken away.
    pub fn validate(&self, out: Option<&Path>, n_threads: usize) -> Result<MemberReport, Failure> {
        let place = Place::new(out)?;
        let comparisons = match self {
            Self::Soft(file) if file.case.geometry.dimensions() == 2 => soft::<2>(file, &place)?,
            Self::Soft(file) => soft::<3>(file, &place)?,
            Self::Optimum(file) => optimum_of(file, &place)?,
            Self::Reduced(file) => reduced(file)?,
        };
        let origin = Origin::of_this_process("", n_threads);
        let day = origin.started_at.get(..10).unwrap_or_default();
        let made_by = format!("{}, {day}", origin.program());
        Ok(MemberReport { name: self.name(), size: None, companion: None, comparisons, made_by })
    }
}

/// Where journals are.
struct Place {
    directory: PathBuf,
    is_temporary: bool,
}

impl Place {
    fn new(out: Option<&Path>) -> Result<Self, Failure> {
        let temporary =
            || std::env::temp_dir().join(format!("alewife-validate-{}", std::process::id()));
        let directory = out.map_or_else(temporary, Path::to_owned);
        Ok(Self { directory, is_temporary: out.is_none() })
    }

    /// The directory of a search.
    fn of(&self, name: &str, what: &str) -> Result<PathBuf, Failure> {
        let place = self.directory.join(format!("{}-{what}", directory_name(name)));
        std::fs::create_dir_all(&place)?;
        Ok(place)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        if self.is_temporary {
            // What is left of a search that nobody keeps
            drop(std::fs::remove_dir_all(&self.directory));
        }
    }
}

/// The motion and the searches of a soft case that have references.
fn soft<const D: usize>(file: &SoftFile, place: &Place) -> Result<Vec<Comparison>, Failure>
where
    Bodies: SolidOf<D>,
{
    let is_of = |of: ReferenceOf| file.case.reference.iter().any(|one| one.of == of);
    let mut all = Vec::new();
    if is_of(ReferenceOf::Run) {
        let model = Model::<D>::new(file)?;
        let motion = Bodies::simulate(&model.body, &model.plan).map_err(TierError::from)?;
        let table = series(&model, &motion).map_err(TierError::from)?;
        all.extend(compare(&file.case, ReferenceOf::Run, &|name| table.last(name)));
    }
    for (of, which) in [
        (ReferenceOf::Calibration, Which::Calibration),
        (ReferenceOf::Optimisation, Which::Optimisation),
    ] {
        if is_of(of) {
            let directory = place.of(&file.name, which.name())?;
            let job = Job::<D>::new(file, which)?;
            let result = job.seek(&directory, &mut |_| {});
            let result = result.map_err(|error| crate::cli::soft::search_failure(&error))?;
            all.extend(result.compared);
        }
    }
    Ok(all.iter().map(|one| of_soft(&file.name, one)).collect())
}

/// The motion of a reduced model.
fn reduced(file: &CaseFile) -> Result<Vec<Comparison>, Failure> {
    let series = simulate(&file.model).map_err(|error| {
        let exit = match error {
            ReducedError::Unknown(_) => Exit::BadCase,
            ReducedError::Tree(_) => Exit::Diverged,
        };
        Failure::new(exit, error.to_string()).of(&file.full_name())
    })?;
    Ok(compare_series(&file.full_name(), file.case(), &series, 0, 0.0))
}

/// The optimum of a flow or of a reduced motion.
fn optimum_of(file: &CaseFile, place: &Place) -> Result<Vec<Comparison>, Failure> {
    let directory = place.of(&file.full_name(), "optimisation")?;
    let optimum = FlowSearch::new(file).and_then(|search| search.seek(&directory, &mut |_| {}));
    let optimum = optimum.map_err(|error| search_failure(file, error))?;
    let name = file.full_name();
    Ok(optimum.compared().iter().map(|one| of_optimum(&name, one)).collect())
}

fn of_soft(case: &str, one: &SoftCompared) -> Comparison {
    let reference = &one.reference;
    let what = match reference.of {
        ReferenceOf::Run => "",
        ReferenceOf::Calibration => " (calibration)",
        ReferenceOf::Optimisation => " (optimisation)",
    };
    let computed = one.computed.ok_or_else(|| "there is no such quantity".to_owned());
    let plain = OptimumReference {
        quantity: reference.quantity.clone(),
        value: reference.value,
        relative: reference.relative,
        absolute: reference.absolute,
        kind: reference.kind,
        source: reference.source.clone(),
    };
    comparison(case, what, &plain, computed)
}

fn of_optimum(case: &str, one: &Compared) -> Comparison {
    comparison(case, " (optimisation)", &one.reference, Ok(one.computed))
}

/// A comparison as those of runs are.
fn comparison(
    case: &str,
    what: &str,
    reference: &OptimumReference,
    computed: Result<f64, String>,
) -> Comparison {
    let OptimumReference { quantity, value, relative, absolute, kind, source } = reference.clone();
    let verdict = match computed {
        Ok(found) if (found - value).abs() <= reference.allowed() => Verdict::Within,
        Ok(_) => Verdict::Outside,
        Err(_) => Verdict::NotComputed,
    };
    let statistic = Statistic {
        quantity: quantity.clone(),
        minus: None,
        kind: StatisticKind::default(),
        at: None,
        level: None,
        of: None,
    };
    let expected = Expected {
        value,
        per: 1.0,
        relative,
        absolute,
        uncertainty: None,
        kind,
        source,
        date: None,
        outside: None,
        cause: None,
        note: None,
    };
    Comparison {
        case: case.to_owned(),
        quantity: format!("{quantity}{what}"),
        computed,
        reference: Reference { statistic, expected },
        verdict,
        dofs: 0,
        cpu_seconds: 0.0,
        numerical: None,
    }
}
