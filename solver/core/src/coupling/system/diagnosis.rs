//! What an error of the linear algebra means: which unknown, where, and what may be missing.

use super::super::error::{SolveError, coordinates};
use super::super::problem::Problem;
use super::{Configuration, FluidSystem};
use crate::algebra::LinearError;
use crate::body::Mode;

/// Most unknowns that are listed by name.
const LISTED: usize = 3;

impl<const D: usize> FluidSystem<D> {
    /// An error of the linear solver in terms of the unknowns of the problem.
    pub(super) fn explain(&self, at: &Configuration<'_, D>, error: LinearError) -> SolveError {
        let LinearError::Singular(singular) = error else {
            return SolveError::Linear(error);
        };
        let name = |unknown: usize| {
            let raw =
                (0..self.layout.n_raw()).find(|&raw| at.constraints.unknown(raw) == Some(unknown));
            raw.map_or_else(|| format!("unknown {unknown}"), |raw| self.name(at, raw))
        };
        let listed = |unknowns: &[usize]| {
            let mut names: Vec<String> =
                unknowns.iter().take(LISTED).map(|&one| name(one)).collect();
            if unknowns.len() > names.len() {
                names.push(format!("{} more", unknowns.len() - names.len()));
            }
            names.join(", ")
        };
        let is_rigid = singular.unknowns.iter().any(|one| self.unknowns().dense.contains(one));
        SolveError::Undetermined {
            unknowns: listed(&singular.unknowns),
            equations: listed(&singular.equations),
            advice: if is_rigid {
                "; nothing holds body and fluid: a wall, a given velocity or locked directions would"
            } else {
                ""
            },
        }
    }

    /// A raw unknown in words.
    fn name(&self, at: &Configuration<'_, D>, raw: usize) -> String {
        let Configuration { problem, mesh, .. } = at;
        let pressures = self.layout.pressures();
        if raw < pressures.start {
            let axis = problem.metric.axis_name(raw % D);
            return format!(
                "the {axis} velocity at {}",
                coordinates(mesh.nodes[raw / D].as_slice())
            );
        }
        if pressures.contains(&raw) {
            return format!(
                "the pressure at {}",
                coordinates(mesh.nodes[raw - pressures.start].as_slice())
            );
        }
        let modes = problem.modes();
        if raw >= self.layout.rate(0) {
            let coordinate = raw - self.layout.rate(0);
            return format!("the rate of coordinate {coordinate} of bodies that bend");
        }
        let rigid = raw - self.layout.n_fluid();
        let mode = modes.iter().nth(rigid % modes.len()).unwrap_or(Mode::X);
        let body = &problem.bodies[rigid / modes.len()].name;
        format!("the {} velocity of body {body:?}", velocity_name(problem, mode))
    }
}

/// A rigid velocity as an adjective.
fn velocity_name<const D: usize>(problem: &Problem<D>, mode: Mode) -> String {
    match (mode.is_rotation(), D) {
        (false, _) => problem.metric.axis_name(mode.axis()).to_owned(),
        (true, 2) => "angular".to_owned(),
        (true, _) => format!("angular {}", ["x", "y", "z"][mode.axis()]),
    }
}
