//! Whether a flow can be believed: its convection is resolved in time, and contact keeps bodies apart.

use crate::case::Convection;
use crate::run::RunError;
use crate::run::measure::FlowMeasurement;
use crate::run::run::Run;
use crate::run::simulation::Simulation;
use crate::step::at_step;

/// Gap over the range of contact below which its force is too weak for what presses bodies together.
const PRESSED: f64 = 0.01;

/// Gap over the largest one so far below which bodies are near each other.
const NEAR: f64 = 0.1;
/// Meshes while bodies are near each other from which contact is proposed: one for each half of a gap that closes.
const MANY_MESHES: usize = 3;

/// CFL number up to which extrapolated convection was found to agree with Newton's method
/// (docs/method.md, section 6).
const LARGEST_CFL: f64 = Convection::LARGEST_CFL;

impl<const D: usize> Run<'_, D> {
    /// Ends a run whose flow has blown up, and warns of steps too long for its convection and of contact
    /// too weak for its bodies.
    ///
    /// # Errors
    /// When it has blown up.
    pub(in crate::run) fn check_soundness(
        &mut self,
        flow: &FlowMeasurement,
    ) -> Result<(), RunError> {
        self.check_pace(flow)?;
        let Simulation { problem, state, scheme, .. } = &self.simulation;
        let (step, time, cfl) = (state.step, state.time, flow.cfl());
        if let (Some(law), Some(minimum)) = (&self.simulation.law, state.contact.minimum_gap)
            && minimum.gap < PRESSED * law.range()
            && step > 0
            && !self.warned.of_gap
        {
            self.warned.of_gap = true;
            let (gap, name) = (minimum.gap, &problem.bodies[minimum.body].name);
            tracing::warn!(
                "{}: the smallest gap, at `{name}`, is {gap:.2e}, less than a \
                 hundredth of the range of contact: a larger stiffness (a smaller epsilon) keeps \
                 bodies at about half the range; `check` proposes one",
                at_step(step, time)
            );
        }
        let is_extrapolated = scheme.convection == Convection::Extrapolated;
        if is_extrapolated && cfl > LARGEST_CFL && !self.warned.of_cfl {
            self.warned.of_cfl = true;
            let shorter = state.last_step * LARGEST_CFL / cfl;
            tracing::warn!(
                "{}: CFL number {cfl:.1}; extrapolated convection was shown to \
                 hold up to {LARGEST_CFL}, and what comes of more may be wrong by any amount: stop the \
                 run, and start again with steps of {shorter:.1e} or less (time.unsteady.step, or \
                 time.unsteady.adaptive.cfl), larger cells where the flow is fast, or \
                 time.unsteady.convection = \"newton\"",
                at_step(step, time)
            );
        }
        Ok(())
    }
}

impl<const D: usize> Run<'_, D> {
    /// Proposes contact where bodies that could give way have come near each other without it, and stay there
    /// at the cost of one mesh after the other.
    pub(in crate::run) fn propose_contact(&mut self) {
        let Simulation { problem, state, moving_mesh: Some(moving), law: None, .. } =
            &self.simulation
        else {
            return;
        };
        let Some(minimum) = state.contact.minimum_gap else { return };
        let nearness = &mut self.warned.nearness;
        nearness.largest_gap = nearness.largest_gap.max(minimum.gap);
        if minimum.gap >= NEAR * nearness.largest_gap {
            nearness.since_mesh = None;
            return;
        }
        let since = *nearness.since_mesh.get_or_insert(state.remeshes);
        if nearness.is_told || state.remeshes < since + MANY_MESHES || !problem.gives_way() {
            return;
        }
        nearness.is_told = true;
        let (step, time, gap) = (state.step, state.time, minimum.gap);
        let gaps = moving.gaps();
        let names = [gaps.body_name(minimum.body), gaps.partner_name(minimum.partner)];
        tracing::warn!(
            "{}: `{}` and `{}` are {gap:.2e} apart, and {} meshes were made since \
             they came near: if they may meet, [contact], such as contact.barrier, keeps bodies apart from \
             each other and from walls, with longer steps and fewer meshes",
            at_step(step, time),
            names[0],
            names[1],
            state.remeshes - since
        );
    }
}
