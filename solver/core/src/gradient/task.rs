//! `GradientTask`: which quantities of a case, by which of its numbers.

use super::adjoint::{Derivatives, Ends, derivatives, ends};
use super::differences::Differences;
use super::error::GradientError;
use super::flow::BaseFlow;
use super::in_time::{Changed, Motions, is_in_time, refuse_in_time};
use super::moment::Moment;
use super::objective::objectives;
use super::parameter::{Parameter, parameters};
use crate::case::{CaseError, CaseFile, Column};
use crate::run::{CaseMesh, Dimension};

/// Reads a case with further settings, `KEY=VALUE` each.
pub type ReadCase<'a> = &'a dyn Fn(&[String]) -> Result<CaseFile, CaseError>;

/// Which quantities of a case, by which of its numbers.
#[derive(Clone, Copy)]
pub struct GradientTask<'a> {
    /// Reads the case.
    pub read: ReadCase<'a>,
    /// Quantities by the names of their columns, such as `ball.force.x`.
    pub of: &'a [String],
    /// Keys of numbers, such as `body.0.shape.disc.radius`.
    pub by: &'a [String],
    /// Whether each derivative is compared with a difference of complete solutions.
    pub checks: bool,
}

/// The values of quantities of the steady flow of a case, and their derivatives.
///
/// # Errors
/// [`GradientError`]: the case, a quantity or a key is none of those, or there is no flow.
pub fn gradients(task: &GradientTask<'_>) -> Result<Vec<Derivatives>, GradientError> {
    // The expectations of the author are those of the case as it is written
    let file = (task.read)(&["numbers={}".to_owned()])?;
    if file.case().geometry.dimensions() == 3 {
        gradients_in::<3>(task, &file)
    } else {
        gradients_in::<2>(task, &file)
    }
}

/// A number of a case, as a search sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberAt<'a> {
    /// Its key.
    pub key: &'a str,
    /// Its value.
    pub value: f64,
}

/// A quantity of the steady flow of a case with other numbers, and its derivatives by them: what a search asks for.
///
/// # Errors
/// As [`gradients`].
pub fn value_and_gradient(
    read: ReadCase<'_>,
    of: &str,
    numbers: &[NumberAt<'_>],
) -> Result<Derivatives, GradientError> {
    let setting = |number: &NumberAt<'_>| format!("{}={:?}", number.key, number.value);
    let here: Vec<String> = numbers.iter().map(setting).collect();
    let read = |more: &[String]| read(&[&here[..], more].concat());
    let by: Vec<String> = numbers.iter().map(|number| number.key.to_owned()).collect();
    let task = GradientTask { read: &read, of: &[of.to_owned()], by: &by, checks: false };
    let mut found = gradients(&task)?;
    Ok(found.swap_remove(0))
}

fn gradients_in<const D: usize>(
    task: &GradientTask<'_>,
    file: &CaseFile,
) -> Result<Vec<Derivatives>, GradientError>
where
    Dimension<D>: CaseMesh<D>,
{
    refuse_in_time(file)?;
    let columns = objectives(&file.model, task.of)?;
    let parameters = parameters(file, task.by)?;
    if is_in_time(file) {
        return gradients_in_time::<D>(task, file, &columns, &parameters);
    }
    let mut flow = BaseFlow::<D>::solve(file, columns)?;
    let mut found = derivatives(&mut flow, task.of, parameters.len(), &mut |flow, nth| {
        ends_by(task, flow, &parameters[nth])
    })?;
    if task.checks {
        let mut differences = Differences::new(flow);
        for parameter in &parameters {
            let ends = ends_by(task, differences.flow(), &parameter.with_longer_step())?;
            let by_number = differences.between(&ends.points, ends.step)?;
            for (derivatives, difference) in found.iter_mut().zip(by_number) {
                derivatives.differences.push(difference);
            }
        }
    }
    Ok(found)
}

/// The case at both sides of the value of a number.
fn ends_by<const D: usize>(
    task: &GradientTask<'_>,
    flow: &BaseFlow<D>,
    parameter: &Parameter,
) -> Result<Ends<D>, GradientError>
where
    Dimension<D>: CaseMesh<D>,
{
    ends(&flow.mesh, &flow.point, parameter.step, &|change| {
        flow.mesh.point(changed(task, parameter, change)?, &Moment::START)
    })
}

/// The case with a number larger by so much.
fn changed(
    task: &GradientTask<'_>,
    parameter: &Parameter,
    change: f64,
) -> Result<CaseFile, CaseError> {
    let settings = ["numbers={}".to_owned(), parameter.setting(parameter.value + change)];
    (task.read)(&settings)
}

/// Of the end of a motion.
fn gradients_in_time<const D: usize>(
    task: &GradientTask<'_>,
    file: &CaseFile,
    columns: &[Column],
    parameters: &[Parameter],
) -> Result<Vec<Derivatives>, GradientError>
where
    Dimension<D>: CaseMesh<D>,
{
    let motions = Motions::<D>::new(file)?;
    let longer: Vec<Parameter> = parameters.iter().map(Parameter::with_longer_step).collect();
    let cases = |parameters: &[Parameter]| -> Vec<_> {
        let of = |parameter: &Parameter| {
            let parameter = parameter.clone();
            move |change: f64| changed(task, &parameter, change)
        };
        parameters.iter().map(of).collect()
    };
    let case_of = cases(parameters);
    let numbers: Vec<Changed<'_>> = case_of
        .iter()
        .zip(parameters)
        .map(|(case, parameter)| Changed { key: &parameter.key, case, step: parameter.step })
        .collect();
    let mut found = motions.derivatives(file, columns, &numbers)?;
    if task.checks {
        for (case, parameter) in case_of.iter().zip(&longer) {
            let number = Changed { key: &parameter.key, case, step: parameter.step };
            let by_number = motions.differences(file, columns, &number)?;
            for (derivatives, difference) in found.iter_mut().zip(by_number) {
                derivatives.differences.push(difference);
            }
        }
    }
    Ok(found)
}
