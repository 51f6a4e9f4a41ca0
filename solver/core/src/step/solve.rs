//! The flow of a step on a configuration, with its contact.

use super::configuration::StepConfiguration;
use super::context::{Apart, Guess, Iterate, StepContext};
use super::coupled_flow::{CoupledFlow, FlowUnderLoads};
use super::error::StepError;
use super::newton::{Criterion, Flow, Tangents, newton};
use super::placement::{Passes, Placement};
use super::workspace::Workspace;
use crate::contact::{ByMobility, ByQuasiNewton, ContactLoads, CoupledSolver};
use crate::timing::Stage;

impl<const D: usize> StepContext<'_, D> {
    /// How contact is found in the flow of this step.
    pub fn contact_method(&self, work: &Workspace<D>) -> Box<dyn CoupledSolver<StepError>> {
        if work.system.is_iterative() && !self.has_elastic_contact() {
            Box::new(ByQuasiNewton::default())
        } else {
            Box::new(ByMobility)
        }
    }

    /// Solves for flow and contact on a configuration.
    ///
    /// # Errors
    /// When the linear system cannot be solved, Newton's method stalls, or contact forces are not found.
    pub fn solve(
        &self,
        work: &mut Workspace<D>,
        configuration: &mut StepConfiguration<D>,
        method: &mut dyn CoupledSolver<StepError>,
        guess: Guess<D>,
    ) -> Result<CoupledFlow<D>, StepError> {
        let contact = self.contact_at(&configuration.placement.poses, &configuration.bodies);
        let first = contact.as_ref().and_then(|contact| method.first_loads(contact));
        if let Some(loads) = &first {
            configuration.bodies.add_external(&loads.wrenches);
        }
        let has_contact = first.is_some_and(|loads| !loads.contacts.is_empty());
        let (first_scale, n_systems) = (guess.scale, guess.n_systems);
        let flow = self.solve_flow(work, configuration, guess, has_contact)?;
        let scale = first_scale.unwrap_or(flow.scale);
        let began = work.timing.begin();
        let mut flow = FlowUnderLoads::new(self, configuration, work, flow);
        let loads = match &contact {
            Some(contact) => method.solve(contact, &mut flow)?,
            None => ContactLoads::none(self.state.poses.len()),
        };
        let mut flow = flow.with_contact(loads);
        work.timing.book_rest(Stage::Contact, began);
        (flow.scale, flow.n_systems) = (scale, flow.n_systems + n_systems);
        Ok(flow)
    }

    /// Solves for the flow on a configuration with the loads on its bodies.
    ///
    /// # Errors
    /// When the linear system cannot be solved, or Newton's method stalls.
    pub fn solve_flow(
        &self,
        work: &mut Workspace<D>,
        configuration: &StepConfiguration<D>,
        guess: Guess<D>,
        has_contact: bool,
    ) -> Result<Flow<D>, StepError> {
        let equations = self.equations(configuration);
        let Workspace { system, mesh, timing } = work;
        let at = configuration.system(self.stepper.problem, mesh);
        let start = system.constrained(at.constraints, &guess.solution);
        let of_step = Criterion::of_step(equations.is_linear(), guess.scale, has_contact);
        let criterion = Criterion {
            is_damped: equations.shears_by_newton(),
            // Later passes correct what the first one leaves
            scale: guess.scale.filter(|_| self.stepper.problem.n_coordinates() > 0),
            tangents: match equations.has_linear_flow() {
                // Contact is found with factors of this mesh
                true if self.has_elastic_contact() => Tangents::Pass,
                true => of_step.tangents,
                false => Tangents::System,
            },
            ..of_step
        };
        newton(system, timing, &at, &equations, &criterion, start)
            .map_err(|failure| failure.in_step(&self.history.step).into())
    }

    /// What the next iteration for the poses starts from.
    ///
    /// # Errors
    /// When coordinates go away from a solution, or give a body no shape.
    pub fn iterate_again(
        &self,
        configuration: StepConfiguration<D>,
        flow: CoupledFlow<D>,
        reached: Placement,
        passes: &mut Passes,
    ) -> Result<Iterate<D>, StepError> {
        let CoupledFlow { solution, scale, n_systems, .. } = flow;
        let guess = Guess { solution, scale: Some(scale), n_systems };
        let solved_at = configuration.placement;
        let placement = self.next_placement(&solved_at, reached, passes)?;
        let Placement { poses, coordinates, .. } = solved_at;
        Ok(Iterate { placement, apart: Apart { poses, coordinates }, guess })
    }
}
