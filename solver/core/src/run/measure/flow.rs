//! The quantities of the flow: its integrals, its energy balance, and the mesh it is computed on.

use nalgebra::Vector3;

use super::integrals::Integrals;
use super::momentum::FluidMomentum;
use super::value::Value;
use crate::case::FlowQuantity;
use crate::coupling::{MeanFlowReport, Problem, SurfaceLoads};
use crate::flow::Viscosity;
use crate::run::simulation::{CellCrossing, Simulation};
use crate::state::EnergyRecord;

/// The whole flow at one time.
pub(in crate::run) struct FlowMeasurement {
    /// Dissipation int 2 mu D : D (W).
    dissipation: f64,
    /// Kinetic energy int rho u^2 / 2 (J).
    kinetic_energy: f64,
    /// Momentum int rho u (kg m/s).
    momentum: Vector3<f64>,
    /// int u^2 (m5/s2; m4/s2 planar).
    squared_speed: f64,
    /// int div u (m3/s).
    mass_defect: f64,
    /// Defect of the energy balance over the work; not a number where sides do work, too.
    pub energy_defect: f64,
    /// Defect of the balance of momentum over what is exchanged; not a number where sides are open.
    pub momentum_defect: f64,
    /// Area or volume (m2, m3).
    volume: f64,
    /// The mean flow, where one is given.
    mean_flow: Option<MeanFlowReport>,
    /// How fast the fluid crosses the cells, if it is convected.
    crossing: Option<CellCrossing>,
    /// The last step (s).
    last_step: f64,
    /// Density over viscosity, the least in the fluid (s/m2).
    density_over_viscosity: f64,
    /// Smallest gap between bodies and walls (m).
    minimum_gap: f64,
    /// Energy stored in contact, and made there by errors of the steps (J).
    contact: [f64; 2],
    cells: usize,
    remeshes: usize,
}

impl FlowMeasurement {
    /// Integrals over the fluid, with how fast it crosses the cells where that is known already.
    pub(super) fn new<const D: usize>(
        simulation: &Simulation<D>,
        crossing: Option<CellCrossing>,
    ) -> Self {
        let Simulation { problem, state, work, .. } = simulation;
        let tables = work.system.tables();
        let sums = Integrals::over_fluid(problem, &state.mesh, &state.now.velocity, tables);
        Self {
            dissipation: match problem.viscosity {
                Viscosity::Newtonian(viscosity) => 2.0 * viscosity * sums.squared_rate,
                _ => sums.dissipation,
            },
            kinetic_energy: 0.5 * problem.density * sums.squared_speed,
            momentum: problem.metric.total_force(&sums.velocity) * problem.density,
            squared_speed: sums.squared_speed,
            mass_defect: sums.divergence,
            energy_defect: f64::NAN,
            momentum_defect: f64::NAN,
            volume: sums.volume,
            mean_flow: work.system.mean_flow(&problem.mean_flow_at(state.time), &state.now),
            crossing: problem
                .has_convection
                .then(|| crossing.unwrap_or_else(|| simulation.cell_crossing())),
            last_step: state.last_step,
            density_over_viscosity: match problem.viscosity {
                Viscosity::Newtonian(viscosity) => problem.density / viscosity,
                _ => problem.density / sums.least_viscosity,
            },
            minimum_gap: state.contact.minimum_gap.map_or(f64::INFINITY, |minimum| minimum.gap),
            contact: [state.contact.energy, state.contact.energy_made],
            cells: state.mesh.n_cells(),
            remeshes: state.remeshes,
        }
    }

    /// What the balance of momentum records of the fluid of a density (kg/m3).
    pub(super) fn fluid_momentum(&self, density: f64) -> FluidMomentum {
        FluidMomentum {
            momentum: self.momentum,
            scale: density * (self.volume * self.squared_speed).sqrt(),
        }
    }

    /// What the energy balance records at a time (s).
    pub(super) fn energy_record<const D: usize>(
        &self,
        problem: &Problem<D>,
        time: f64,
        loads: &SurfaceLoads,
    ) -> EnergyRecord {
        let dimension = if problem.metric.is_revolved() { 3.0 } else { D as f64 };
        let squared_size = self.volume.powf(2.0 / dimension);
        let squared_rate = self.squared_speed / self.volume / squared_size;
        EnergyRecord {
            time,
            power: loads.power() + self.mean_flow.map_or(0.0, |report| report.power),
            dissipation: self.dissipation,
            kinetic_energy: self.kinetic_energy,
            dissipation_scale: problem.viscosity.at(squared_rate).value * self.squared_speed
                / squared_size,
        }
    }

    /// Cells the fluid crosses in the last step at most.
    pub(in crate::run) fn cfl(&self) -> f64 {
        self.crossing.map_or(0.0, |crossing| crossing.rate * self.last_step)
    }

    /// Largest Reynolds number of a cell.
    pub(in crate::run) fn cell_reynolds(&self) -> f64 {
        self.crossing.map_or(0.0, |crossing| crossing.reach * self.density_over_viscosity)
    }

    /// Kinetic energy of the fluid (J).
    pub(in crate::run) fn kinetic_energy(&self) -> f64 {
        self.kinetic_energy
    }

    /// Kinetic energy of all the fluid of a density (kg/m3) at a speed (m/s).
    pub(in crate::run) fn energy_at(&self, density: f64, speed: f64) -> f64 {
        0.5 * density * speed * speed * self.volume
    }

    pub(super) fn value(&self, quantity: FlowQuantity) -> Value {
        let of_mean_flow = |value: fn(&MeanFlowReport) -> Vector3<f64>| {
            Value::Vector(self.mean_flow.as_ref().map_or(Vector3::zeros(), value))
        };
        match quantity {
            FlowQuantity::Dissipation => self.dissipation.into(),
            FlowQuantity::KineticEnergy => self.kinetic_energy.into(),
            FlowQuantity::MassDefect => self.mass_defect.into(),
            FlowQuantity::EnergyDefect => self.energy_defect.into(),
            FlowQuantity::MomentumDefect => self.momentum_defect.into(),
            FlowQuantity::ContactEnergy => self.contact[0].into(),
            FlowQuantity::ContactEnergyMade => self.contact[1].into(),
            FlowQuantity::PressureGradient => of_mean_flow(|report| report.pressure_gradient),
            FlowQuantity::MeanVelocity => of_mean_flow(|report| report.velocity),
            FlowQuantity::Cfl => self.cfl().into(),
            FlowQuantity::CellReynolds => self.cell_reynolds().into(),
            FlowQuantity::MinimumGap => self.minimum_gap.into(),
            FlowQuantity::Cells => (self.cells as f64).into(),
            FlowQuantity::Remeshes => (self.remeshes as f64).into(),
        }
    }
}
