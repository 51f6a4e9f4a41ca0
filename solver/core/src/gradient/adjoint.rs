//! Derivatives by the adjoint flows of a case, from the case at both sides of the value of each number.

use super::error::GradientError;
use super::flow::BaseFlow;
use super::mesh_of_bodies::MeshOfBodies;
use super::point::CasePoint;
use crate::run::{CaseMesh, Dimension};

/// A quantity with its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// Name of its column.
    pub of: String,
    /// Its value.
    pub value: f64,
    /// How large the loads, powers or velocities are that it is made of: what would be zero is small beside it.
    pub size: f64,
    /// By each number, in the order in which they were asked for.
    pub by: Vec<f64>,
    /// The same by central differences of complete solutions on the mesh that moves with the number; empty unless asked
    /// for.
    pub differences: Vec<f64>,
}

/// The case at both sides of the value of a number.
pub(super) struct Ends<const D: usize> {
    /// Below and above.
    pub points: [CasePoint<D>; 2],
    /// How far each is from the value.
    pub step: f64,
}

/// Part of an edge by which nodes on bodies move at most.
const WAY: f64 = 0.02;

/// The ends of a step from a case on its mesh, which is made shorter where surfaces would move too far; `at` is the
/// case with the number larger by so much.
pub(super) fn ends<const D: usize>(
    mesh: &MeshOfBodies<D>,
    here: &CasePoint<D>,
    mut step: f64,
    at: &dyn Fn(f64) -> Result<CasePoint<D>, GradientError>,
) -> Result<Ends<D>, GradientError>
where
    Dimension<D>: CaseMesh<D>,
{
    let mut above = at(step)?;
    let way = mesh.way(here, &above);
    if way > WAY {
        step *= WAY / way;
        above = at(step)?;
    }
    Ok(Ends { points: [at(-step)?, above], step })
}

/// The quantities of a flow, of these names, and their derivatives by so many numbers, whose ends `ends` gives.
pub(super) fn derivatives<const D: usize>(
    flow: &mut BaseFlow<D>,
    of: &[String],
    n_numbers: usize,
    ends: &mut dyn FnMut(&BaseFlow<D>, usize) -> Result<Ends<D>, GradientError>,
) -> Result<Vec<Derivatives>, GradientError> {
    let adjoints = flow.adjoints()?;
    let values = flow.values().iter().zip(flow.sizes()).zip(of);
    let empty = |((value, size), name): ((&f64, &f64), &String)| Derivatives {
        of: name.clone(),
        value: *value,
        size: *size,
        by: Vec::new(),
        differences: Vec::new(),
    };
    let mut found: Vec<Derivatives> = values.map(empty).collect();
    for nth in 0..n_numbers {
        let ends = ends(flow, nth)?;
        let sides = [
            flow.lagrangians(&ends.points[0], &adjoints)?,
            flow.lagrangians(&ends.points[1], &adjoints)?,
        ];
        for (quantity, derivatives) in found.iter_mut().enumerate() {
            derivatives.by.push((sides[1][quantity] - sides[0][quantity]) / (2.0 * ends.step));
        }
    }
    Ok(found)
}
