//! How large the loads on the fluid are that are given: forces per volume, and tractions of sides.

use alewife_mesh::Point;

use crate::run::simulation::Simulation;

impl<const D: usize> Simulation<D> {
    /// The largest force per volume that is given, and tractions of sides over the length of the domain (N/m3).
    pub(super) fn given_loads(&self) -> f64 {
        let Self { problem, state, .. } = self;
        if !problem.has_given_loads() {
            return 0.0;
        }
        let (mesh, time) = (&state.mesh, state.time);
        let force = problem
            .force
            .iter()
            .flat_map(|force| mesh.nodes.iter().map(move |place| force(place, time).norm()));
        let along = Point::<D>::from_fn(|axis, _| if axis == 0 { 1.0 } else { 0.0 });
        let tractions = mesh.facets.iter().flat_map(|facet| {
            let side = problem.sides[facet.boundary].as_ref();
            let nodes = mesh
                .facet_nodes(facet)
                .filter_map(move |node| side?.given_traction(&mesh.nodes[node], &along, time));
            nodes.map(|traction| traction.norm())
        });
        force.fold(0.0, f64::max) + tractions.fold(0.0, f64::max) / self.extent()
    }
}
