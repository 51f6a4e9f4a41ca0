//! A new mesh in the middle of a run, with both levels of the flow transferred to it.

use alewife_mesh::{Mesh, Point};
use nalgebra::Vector3;

use super::moving_mesh::MovingMesh;
use super::new_mesh::{NewMesh, new_mesh};
use super::scene::{MostCells, RemeshError};
use super::transfer::Transfer;
use crate::body::{MeshPoses, on_mesh};
use crate::coupling::{
    BodiesAt, BodyShapes, Boundaries, BoundaryValues, DivergenceFreeProjection, Problem,
    RestPlaces, Solution, impose_boundary_values,
};
use crate::scalar::{MassMatrix, ScalarField};
use crate::space::Tables;
use crate::state::{State, TransferredState};

/// One level of a flow, on the old mesh and where the new one is to be then.
struct Level<'a, const D: usize> {
    name: &'static str,
    solution: &'a Solution<D>,
    /// The old mesh then, seen from the frame.
    old: &'a Mesh<D>,
    /// The new mesh then, seen from the frame.
    new: &'a Mesh<D>,
    /// Bodies then, seen from the frame.
    bodies: BodiesAt<'a>,
    /// Position of the frame then (m).
    origin: Vector3<f64>,
}

/// Replaces the mesh of a state, with bodies where they are, and takes the flow over. On error the
/// state is where it was.
///
/// # Errors
/// When the mesh cannot be generated, would have more cells than it may have, or the flow not be made divergence-free on it.
pub fn replace_mesh<const D: usize>(
    problem: &Problem<D>,
    state: &mut State<D>,
    moving: &MovingMesh<D>,
    most: MostCells,
) -> Result<MovingMesh<D>, RemeshError> {
    let shapes = BodyShapes::with(&problem.bodies, state.time, &state.shapes.now)?;
    let NewMesh { mesh: new, moving: successor, image_shifts } =
        new_mesh(problem, state, moving, &shapes, most)?;
    let poses = MeshPoses::seen_from(&state.origin, &state.poses, &image_shifts);
    // The frame was elsewhere one level back, too
    let origin_before = state.origin_at(problem, &state.previous_poses);
    let previous_poses = MeshPoses::seen_from(&origin_before, &state.previous_poses, &image_shifts);

    // One level back the new mesh is where its own motion puts it: nodes whose way had a kink would
    // cost the next step its second order
    let before = &state.shapes.before;
    let shapes_before = BodyShapes::with(&problem.bodies, state.time_before(), before)?;
    let nodes_before = successor.nodes(&previous_poses, &shapes_before)?;
    let before = new.with_nodes(nodes_before);
    let old = state.mesh_in_frame();
    let old_before = old.with_nodes(state.nodes_before.clone());
    let bodies = |poses, shapes| BodiesAt { poses, shapes };
    let rest_places = successor.rest_places(&shapes);
    let mut transfer = FieldTransfer::new(problem, &new, &successor, &rest_places);
    transfer.has_scalars = !state.scalars.is_empty();
    let now = Level {
        name: "present level",
        solution: &state.now,
        old: &old,
        new: &new,
        bodies: bodies(&poses, &shapes),
        origin: state.origin,
    };
    let previous = Level {
        name: "level before",
        solution: &state.previous,
        old: &old_before,
        new: &before,
        bodies: bodies(&previous_poses, &shapes_before),
        origin: origin_before,
    };
    let (now, previous) = (transfer.level(&now)?, transfer.level(&previous)?);
    let rates = now.transfer.quadratic(&state.rates);
    let scalars = transfer.scalars(state, &now.transfer, &previous.transfer)?;
    let (now, previous) = (now.solution, previous.solution);
    state.replace_mesh(TransferredState {
        mesh: new,
        nodes_before: before.nodes,
        now,
        previous,
        rates,
        image_shifts,
        scalars,
    });
    Ok(successor)
}

/// A level on the new mesh.
struct TransferredLevel<'a, const D: usize> {
    solution: Solution<D>,
    /// From the old mesh to the new one.
    transfer: Transfer<'a, D>,
}

/// Takes levels of a flow from one mesh to another.
struct FieldTransfer<'a, const D: usize> {
    problem: &'a Problem<D>,
    moving: &'a MovingMesh<D>,
    rest_places: &'a RestPlaces,
    boundaries: Boundaries,
    tables: Tables<D>,
    /// None where nothing has inertia: the older velocities are first guesses only.
    projection: Option<DivergenceFreeProjection<D>>,
    /// Whether the projection is where the first level asks for it.
    is_placed: bool,
    /// Whether there are scalars, whose amounts are to be kept.
    has_scalars: bool,
}

impl<'a, const D: usize> FieldTransfer<'a, D> {
    /// With the new mesh where the first level has it.
    fn new(
        problem: &'a Problem<D>,
        new: &Mesh<D>,
        moving: &'a MovingMesh<D>,
        rest_places: &'a RestPlaces,
    ) -> Self {
        let projection = problem.has_inertia.then(|| DivergenceFreeProjection::new(problem, new));
        let (boundaries, tables) = (Boundaries::new(new), Tables::new(problem.metric));
        Self {
            problem,
            moving,
            rest_places,
            boundaries,
            tables,
            projection,
            is_placed: true,
            has_scalars: false,
        }
    }

    /// A level on the new mesh.
    fn level<'b>(&mut self, level: &Level<'b, D>) -> Result<TransferredLevel<'b, D>, RemeshError> {
        let images = self.moving.scene().images([level.old, level.new]);
        let not_found = || RemeshError::NotFound { level: level.name };
        let mut transfer = Transfer::new(level.old, level.new, &images).ok_or_else(not_found)?;
        let mut solution = Solution {
            velocity: transfer.quadratic(&level.solution.velocity),
            pressure: transfer.linear(&level.solution.pressure),
            twists: level.solution.twists.clone(),
            rates: level.solution.rates.clone(),
            pressure_gradient: level.solution.pressure_gradient,
        };
        let values = BoundaryValues {
            bodies: level.bodies,
            twists: &solution.twists,
            rates: &solution.rates,
            rest_places: self.rest_places,
            origin: on_mesh(&level.origin),
        };
        impose_boundary_values(
            self.problem,
            level.new,
            &self.boundaries,
            &values,
            &mut solution.velocity,
        );
        if self.projection.is_some() || self.has_scalars {
            transfer = transfer.with_points(&self.tables).ok_or_else(not_found)?;
        }
        if let Some(projection) = &mut self.projection {
            let residual =
                transfer.missed(&self.tables, &level.solution.velocity, &solution.velocity);
            if !std::mem::take(&mut self.is_placed) {
                projection.move_to(self.problem, level.new);
            }
            let momentum = projection.integral(level.old, &level.solution.velocity);
            solution.velocity = projection.project_with_integral(
                level.new,
                &solution.velocity,
                &residual,
                &momentum,
            )?;
        }
        Ok(TransferredLevel { solution, transfer })
    }

    /// The scalars of a state on the new mesh, each level with the integrals of the old one.
    fn scalars(
        &self,
        state: &State<D>,
        now: &Transfer<'_, D>,
        previous: &Transfer<'_, D>,
    ) -> Result<Vec<ScalarField>, RemeshError> {
        if state.scalars.is_empty() {
            return Ok(Vec::new());
        }
        let mut mass = MassMatrix::new(now.mesh(), self.problem.metric);
        let fields = state.scalars.iter().map(|field| {
            Ok(ScalarField {
                now: self.scalar(&mut mass, now, &field.now)?,
                previous: self.scalar(&mut mass, previous, &field.previous)?,
                ..field.clone()
            })
        });
        fields.collect()
    }

    /// Values at the nodes of the new mesh: what interpolation misses is added.
    fn scalar(
        &self,
        mass: &mut MassMatrix<D>,
        transfer: &Transfer<'_, D>,
        values: &[f64],
    ) -> Result<Vec<f64>, RemeshError> {
        // As one component of a vector field
        let as_vector =
            |value: &f64| Point::<D>::from_fn(|axis, _| if axis == 0 { *value } else { 0.0 });
        let old: Vec<Point<D>> = values.iter().map(as_vector).collect();
        let new = transfer.quadratic(&old);
        let missed = transfer.missed(&self.tables, &old, &new);
        let missed: Vec<f64> = missed.iter().map(|one| one[0]).collect();
        let correction = mass.solve(transfer.mesh(), &missed)?;
        Ok(new.iter().zip(&correction).map(|(value, more)| value[0] + more).collect())
    }
}
