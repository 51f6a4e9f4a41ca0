//! `FlowByNumbers`: quantities of the steady flow or of the motion of a case and their derivatives, for one set of numbers after the other.

use std::rc::Rc;

use super::adjoint::{Derivatives, derivatives, ends};
use super::error::GradientError;
use super::flow::BaseFlow;
use super::in_time::{Changed, Motions, is_in_time};
use super::mesh_of_bodies::MeshOfBodies;
use super::moment::Moment;
use super::objective::objectives;
use crate::case::{CaseError, CaseFile};
use crate::run::{CaseMesh, Dimension};

/// Part of the size of a number by which it is changed: differences leave its square.
const STEP: f64 = 1e-4;

/// A case by values of some numbers, and what is asked of its flow.
#[derive(Clone, Copy)]
pub struct NumberedCase<'a> {
    /// The case with these values.
    pub case: &'a dyn Fn(&[f64]) -> Result<CaseFile, CaseError>,
    /// Quantities by the names of their columns.
    pub of: &'a [String],
    /// How large a change of each number is one.
    pub sizes: &'a [f64],
}

impl NumberedCase<'_> {
    /// The case with one of the values larger by so much.
    fn changed(&self, values: &[f64], nth: usize, change: f64) -> Result<CaseFile, CaseError> {
        let mut values = values.to_vec();
        values[nth] += change;
        (self.case)(&values)
    }
}

/// The steady flow of a case, for one set of its numbers after the other: on one mesh that follows the bodies, as long as
/// its cells are fit, so that quantities are smooth functions of the numbers. What is found for a set of numbers does not
/// depend on those before it.
pub struct FlowByNumbers {
    flows: Box<dyn Flows>,
}

impl FlowByNumbers {
    /// Makes the mesh of a case that others of these numbers are solved on.
    ///
    /// # Errors
    /// [`GradientError`]: it has no mesh, or what gradients are not taken of.
    pub fn new(file: &CaseFile) -> Result<Self, GradientError> {
        let in_space = file.case().geometry.dimensions() == 3;
        let flows: Box<dyn Flows> = match (is_in_time(file), in_space) {
            (false, false) => Box::new(Followed::<2>::new(file)?),
            (false, true) => Box::new(Followed::<3>::new(file)?),
            (true, false) => Box::new(Motions::<2>::new(file)?),
            (true, true) => Box::new(Motions::<3>::new(file)?),
        };
        Ok(Self { flows })
    }

    /// The quantities at values of the numbers, and their derivatives by them.
    ///
    /// # Errors
    /// [`GradientError`]: there is no such case, or no flow.
    pub fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, GradientError> {
        self.flows.at(numbered, values)
    }
}

/// Flows in one dimension.
trait Flows {
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, GradientError>;
}

/// The mesh of a case, which others follow.
struct Followed<const D: usize> {
    mesh: Rc<MeshOfBodies<D>>,
}

impl<const D: usize> Followed<D>
where
    Dimension<D>: CaseMesh<D>,
{
    fn new(file: &CaseFile) -> Result<Self, GradientError> {
        Ok(Self { mesh: BaseFlow::<D>::prepared(file)?.mesh })
    }

    /// The flow of a case: on the mesh whose nodes have moved, or on one of its own where its cells are not fit any more.
    fn flow(&self, file: CaseFile, of: &[String]) -> Result<BaseFlow<D>, GradientError> {
        let columns = objectives(&file.model, of)?;
        let point = self.mesh.point(file.clone(), &Moment::START)?;
        if self.mesh.is_fit(&point) {
            BaseFlow::on(Rc::clone(&self.mesh), point, columns)
        } else {
            BaseFlow::solve(&file, columns)
        }
    }
}

impl<const D: usize> Flows for Followed<D>
where
    Dimension<D>: CaseMesh<D>,
{
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, GradientError> {
        let mut flow = self.flow((numbered.case)(values)?, numbered.of)?;
        derivatives(&mut flow, numbered.of, values.len(), &mut |flow, nth| {
            ends(&flow.mesh, &flow.point, STEP * numbered.sizes[nth], &|change| {
                flow.mesh.point(numbered.changed(values, nth, change)?, &Moment::START)
            })
        })
    }
}

impl<const D: usize> Flows for Motions<D>
where
    Dimension<D>: CaseMesh<D>,
{
    fn at(
        &self,
        numbered: &NumberedCase<'_>,
        values: &[f64],
    ) -> Result<Vec<Derivatives>, GradientError> {
        let file = (numbered.case)(values)?;
        let columns = objectives(&file.model, numbered.of)?;
        let case = |nth: usize| move |change: f64| numbered.changed(values, nth, change);
        let cases: Vec<_> = (0..values.len()).map(case).collect();
        let numbers: Vec<Changed<'_>> = cases
            .iter()
            .zip(numbered.sizes)
            .map(|(case, size)| Changed { key: "optimisation", case, step: STEP * size })
            .collect();
        self.derivatives(&file, &columns, &numbers)
    }
}
