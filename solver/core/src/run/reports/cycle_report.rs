//! `CycleReport`: how far a swimmer got in its first cycle, and whether steps are too long for it.

use crate::body::Pose;
use crate::case::Scheme;
use crate::coupling::Group;
use crate::run::simulation::Simulation;

/// Error of the distance of a cycle, relative to it, above which there is a warning.
const NOTABLE: f64 = 0.02;
/// Distance of a cycle over the extent of the stroke below which it counts as going nowhere.
const NOWHERE: f64 = 1e-3;
/// The same over the length of the swimmer: the middle of a symmetric one does not move at all.
const NOWHERE_OF_LENGTH: f64 = 1e-4;
/// Part of a period by which its end may be off.
const AT_END: f64 = 1e-6;

/// The first cycle of a swimmer.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleReport {
    /// Its name.
    pub swimmer: String,
    /// How far it got (m).
    pub distance: f64,
    /// Estimate of the error of its displacement by steps in time (m); none where steps were too
    /// few.
    pub error: Option<f64>,
    /// Distance below which it counts as going nowhere (m).
    nowhere: f64,
}

impl<const D: usize> Simulation<D> {
    /// Reports of the swimmers that are at the end of their first cycle.
    pub(in crate::run) fn first_cycles_that_end(&mut self) -> Vec<CycleReport> {
        let Self { problem, state, .. } = self;
        let mut reports = Vec::new();
        for (index, group) in problem.groups.iter().enumerate() {
            let history = &state.propulsion[index];
            let unreported = group.period.filter(|_| !history.error.is_reported());
            let Some(period) = unreported else { continue };
            if history.error.elapsed() < period * (1.0 - AT_END) {
                continue;
            }
            let means = history.cycles.means(period, group.resistance);
            let extent = NOWHERE * history.cycles.extent();
            reports.push(CycleReport {
                swimmer: group.name.clone(),
                distance: means.displacement.norm(),
                error: history.error.of_displacement(),
                nowhere: extent.max(NOWHERE_OF_LENGTH * length(group, &state.poses)),
            });
            state.end_cycle_error(index);
        }
        reports
    }
}

/// Largest distance between bodies of a group (m).
fn length(group: &Group, poses: &[Pose]) -> f64 {
    let centers = group.bodies.iter().map(|&body| poses[body].center);
    let distances = centers.clone().flat_map(|one| centers.clone().map(move |other| one - other));
    distances.map(|distance| distance.norm()).fold(0.0, f64::max)
}

impl CycleReport {
    /// Warns where fixed steps of a method are too long.
    pub(in crate::run) fn log(&self, method: Scheme) {
        let Self { swimmer, distance, nowhere, .. } = self;
        let Some(error) = self.error else {
            tracing::info!(
                "steps are too few between jumps of the stroke to estimate the error of the distance of \
                 `{swimmer}` in a cycle"
            );
            return;
        };
        let percent = 100.0 * error / distance;
        if distance.max(error) <= *nowhere {
            tracing::info!("`{swimmer}` goes nowhere in a cycle, within {error:.1e} m");
        } else if percent > 100.0 * NOTABLE {
            let cure = match method {
                Scheme::Rk3 => "",
                Scheme::Bdf1 | Scheme::Bdf2 => ", or write scheme = \"rk3\"",
            };
            tracing::warn!(
                "the distance `{swimmer}` covers in a cycle is uncertain by about {percent:.1} %, by \
                 the errors of its steps: lower time.unsteady.step{cure}"
            );
        } else if percent.is_finite() {
            tracing::info!(
                "the distance `{swimmer}` covers in a cycle is good to about {percent:.1e} %, by the \
                 errors of its steps"
            );
        }
    }
}
