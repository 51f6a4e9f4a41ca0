//! `OtherSteps`: the error of the distance of a cycle, from the first one with steps of another size.

use nalgebra::Vector3;

use super::simulation::Simulation;
use crate::body::Pose;
use crate::case::{Scheme, Unsteady};
use crate::coupling::Group;
use crate::state::PropulsionHistory;

/// Error of the distance of a cycle, relative to it, above which there is a warning.
const NOTABLE: f64 = 0.02;
/// Distance of a cycle over the extent of the stroke below which it counts as going nowhere.
const NOWHERE: f64 = 1e-3;
/// The same over the length of the swimmer: the middle of a symmetric one does not move at all.
const NOWHERE_OF_LENGTH: f64 = 1e-4;

/// What swimmers did in their first cycle with steps of another size.
#[derive(Debug, Clone)]
pub(super) struct OtherSteps {
    /// That size over the size of the run's steps.
    pub ratio: f64,
    /// When the cycle ended (s).
    pub end: f64,
    /// Displacement of each group in its cycle (m); not a number without a cycle.
    pub displacements: Vec<Vector3<f64>>,
}

/// The displacement of each group over its cycle up to the present (m); not a number before its end.
pub(super) fn displacements<const D: usize>(simulation: &Simulation<D>) -> Vec<Vector3<f64>> {
    let groups = simulation.problem.groups.iter().zip(&simulation.state.propulsion);
    let of_group = |(group, history): (&Group, &PropulsionHistory)| {
        group.period.map_or(Vector3::repeat(f64::NAN), |period| {
            history.cycles.means(period, group.resistance).displacement
        })
    };
    groups.map(of_group).collect()
}

/// The part of a run up to the end of the first cycle of all swimmers; none where there is no cycle, or
/// where steps are chosen by errors of their own.
pub(super) fn first_cycle<const D: usize>(
    simulation: &Simulation<D>,
    settings: &Unsteady,
) -> Option<Unsteady> {
    let periods = simulation.problem.groups.iter().filter_map(|group| group.period);
    let longest = periods.fold(0.0, f64::max);
    let step = settings.step;
    let end = step * (longest / step - 1e-9).ceil();
    let applies = longest > 0.0
        && settings.adaptive.is_none()
        && !simulation.problem.has_inertia
        && end <= settings.end * (1.0 + 1e-9);
    applies.then(|| Unsteady { end, ..settings.clone() })
}

/// Largest distance between bodies of a group (m).
fn length(group: &Group, poses: &[Pose]) -> f64 {
    let centers = group.bodies.iter().map(|&body| poses[body].center);
    let distances = centers.clone().flat_map(|one| centers.clone().map(move |other| one - other));
    distances.map(|distance| distance.norm()).fold(0.0, f64::max)
}

impl OtherSteps {
    /// Whether a simulation is where the cycle ended.
    pub fn is_due<const D: usize>(&self, simulation: &Simulation<D>) -> bool {
        simulation.state.time >= self.end * (1.0 - 1e-9)
    }

    /// Reports what the difference says of the error of a simulation at the end of its first cycle.
    pub fn compare<const D: usize>(&self, simulation: &Simulation<D>) {
        let order = match simulation.scheme.method {
            Scheme::Rk3 => 3,
            Scheme::Bdf2 => 2,
            Scheme::Bdf1 => 1,
        };
        let Simulation { problem, state, .. } = simulation;
        for (index, displacement) in displacements(simulation).into_iter().enumerate() {
            let swimmer = &problem.groups[index].name;
            let difference = (self.displacements[index] - displacement).norm();
            let nowhere = (NOWHERE * state.propulsion[index].cycles.extent())
                .max(NOWHERE_OF_LENGTH * length(&problem.groups[index], &state.poses));
            // Errors go with that power of the step
            let share = (self.ratio.powi(order) - 1.0).abs();
            let error = difference / share;
            let distance = displacement.norm();
            let percent = 100.0 * error / distance;
            if distance.max(error) <= nowhere {
                tracing::info!("`{swimmer}` goes nowhere in a cycle, within {error:.1e} m");
            } else if percent > 100.0 * NOTABLE {
                let cure = match simulation.scheme.method {
                    Scheme::Rk3 => "",
                    Scheme::Bdf1 | Scheme::Bdf2 => ", or write scheme = \"rk3\"",
                };
                tracing::warn!(
                    "the distance `{swimmer}` covers in a cycle is uncertain by about {percent:.1} %, as steps of \
                     another size show: lower time.unsteady.step{cure}"
                );
            } else if percent.is_finite() {
                tracing::info!(
                    "the distance `{swimmer}` covers in a cycle is good to about {percent:.1e} %, as steps of \
                     another size show"
                );
            }
        }
    }
}
