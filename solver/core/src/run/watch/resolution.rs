//! Whether cells resolve the flow at the bodies.

use super::force_agreement::ForceAgreement;
use crate::run::run::Run;
use crate::run::snapshot::BodyReport;

/// Difference of the force by the integral of the stress from that by the residual, over it, above which cells are too large.
/// In the cases of `validate --quick` it is 0.024 at most. Of a sphere at Reynolds number 1000 it was 0.08, 0.08, 0.05, 0.002 with edges of
/// 0.19, 0.1, 0.05 and 0.025 diameters, and the force was wrong by 36, 22, 5 and 0.1 %.
const NOTABLE: f64 = 0.04;

impl<const D: usize> Run<'_, D> {
    /// Notes the forces on the bodies.
    pub(in crate::run) fn compare_forces(&mut self, bodies: &[BodyReport]) {
        self.forces.resize(bodies.len(), ForceAgreement::default());
        for (own, body) in self.forces.iter_mut().zip(bodies) {
            own.add(&body.load.force, &body.surface_load.force, body.friction);
        }
    }

    /// Warns of bodies whose cells do not resolve the flow.
    pub(in crate::run) fn warn_of_resolution(&self) {
        let parts = self.forces.iter().enumerate();
        let parts = parts.filter_map(|(body, forces)| Some((body, forces.part()?)));
        let Some((body, part)) = parts.max_by(|one, other| one.1.total_cmp(&other.1)) else {
            return;
        };
        if part > NOTABLE {
            let name = &self.simulation.problem.bodies[body].name;
            tracing::warn!(
                "the cells at `{name}` are too large for the flow: `{name}.force` and `{name}.surface_force` \
                 differ by {:.0} %, where 4 % and less is usual; the force is wrong by some per cent or \
                 more: lower mesh.surface, and mesh.growth behind it",
                100.0 * part
            );
        }
    }
}
