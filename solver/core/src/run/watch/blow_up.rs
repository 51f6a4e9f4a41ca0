//! Whether a flow has blown up: its energy and its speeds against what drives it.

use super::pace::Pace;
use super::sound_state::SoundState;
use crate::case::TimeSettings;
use crate::coupling::SurfaceLoads;
use crate::run::measure::FlowMeasurement;
use crate::run::run::Run;
use crate::run::simulation::Simulation;
use crate::run::{RunError, SavedState, Series};

/// Speed over the size of the domain and the time since the start that is rounding.
const ROUNDING: f64 = 1e-9;

/// Speed over that of what drives the fluid below which its energy does not matter.
const NEGLIGIBLE: f64 = 1e-3;

impl<const D: usize> Run<'_, D> {
    /// Ends a run whose flow has blown up.
    ///
    /// # Errors
    /// When it has.
    pub(super) fn check_pace(&mut self, flow: &FlowMeasurement) -> Result<(), RunError> {
        if !self.simulation.problem.has_inertia {
            return Ok(());
        }
        let is_steady = matches!(self.case().time, TimeSettings::Steady(_));
        self.pace = self.simulation.pace(flow, is_steady)?;
        let Some(excess) = self.pace.excess() else { return Ok(()) };
        Err(RunError::BlownUp {
            step: self.simulation.state.step,
            time: self.simulation.state.time,
            excess,
            cfl: flow.cfl(),
            cell_reynolds: self.pace.cell_reynolds,
            near: self.simulation.fastest_node(),
            sound: self.sound.as_ref().map(SoundState::time),
        })
    }
}

impl<const D: usize> Run<'_, D> {
    /// Keeps the present state where it is time for it and the flow is sound.
    ///
    /// # Errors
    /// When the case cannot be written.
    pub(in crate::run) fn keep_sound_state(&mut self) -> Result<(), RunError> {
        let simulation = &self.simulation;
        let next = self.sound.as_ref().map(SoundState::next);
        let is_due = next.is_none_or(|next| simulation.state.step >= next);
        if simulation.problem.has_inertia && is_due && self.pace.is_sound() {
            let state =
                SavedState::of(self.case(), simulation, &Series::default(), &self.recording)?;
            self.sound = Some(SoundState::new(state));
        }
        Ok(())
    }
}

impl<const D: usize> Simulation<D> {
    /// How fast the flow is beside what drives it; as nothing at the start of a run, before anything drives it.
    fn pace(&mut self, flow: &FlowMeasurement, is_steady: bool) -> Result<Pace, RunError> {
        let cell_reynolds = flow.cell_reynolds();
        let elastic = self.elastic_energy()?;
        let energy = flow.kinetic_energy() + self.kinetic_energy_of_bodies() + elastic;
        if self.state.supply.initial.is_none() {
            if !is_steady {
                let contact = self.contact_energy();
                let speed = self.start_speed(elastic + contact);
                self.state.record_start(energy + contact, speed);
            }
            self.record_drives(&SurfaceLoads::none(self.problem.bodies.len()))?;
            if !is_steady {
                return Ok(Pace { cell_reynolds, ..Pace::default() });
            }
        }
        let Self { problem, state, .. } = &*self;
        let density = problem.density;
        let rounding = if is_steady { 0.0 } else { ROUNDING * self.extent() / state.time };
        let speed = self.drive_speed(is_steady) + rounding;
        if speed == 0.0 {
            return Ok(Pace { cell_reynolds, ..Pace::default() });
        }
        let supply = &state.supply;
        let negligible = flow.energy_at(density, NEGLIGIBLE * speed);
        let supplied = supply.initial.unwrap_or(0.0) + supply.work + negligible;
        Ok(Pace {
            energy: if is_steady { 0.0 } else { energy / supplied },
            mean_speed: (flow.kinetic_energy() / flow.energy_at(density, speed)).sqrt(),
            largest_speed: state.now.top_speed() / speed,
            body_speed: self.fastest_body() / speed,
            cell_reynolds,
        })
    }

    /// Where the fluid is fastest (m).
    fn fastest_node(&self) -> Vec<f64> {
        let Self { state, .. } = self;
        let speeds = state.now.velocity.iter().map(|velocity| velocity.norm());
        let fastest = speeds.enumerate().max_by(|one, other| one.1.total_cmp(&other.1));
        let node = fastest.map(|(node, _)| alewife_mesh::NodeId::new(node));
        node.map_or_else(Vec::new, |node| state.mesh.nodes[node].iter().copied().collect())
    }
}
