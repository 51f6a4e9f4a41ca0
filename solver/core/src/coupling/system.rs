//! One linear system for the fluid and every body in it.
//!
//! A step of Newton's method on R(x) = 0 with x = P y + g: solve P^T J P dy = -P^T R(x). On the
//! rows of U and omega, P^T gathers minus the fluid's load, to which Newton and Euler add
//! m dU/dt - F_ext and d(I omega)/dt - T_ext: no interface stress, no multiplier, and no added-mass
//! instability at any density ratio.

use alewife_mesh::Mesh;
use nalgebra::DMatrix;

use super::boundaries::Boundaries;
use super::constrain::{BodiesAt, Constrainer};
use super::error::SolveError;
use super::loads::{BodyLoads, ResidualOnMesh, body_loads};
use super::nullspace::TranslationNullspace;
use super::problem::Problem;
use super::rigid_equations::{RigidBodyEquations, rotations};
use super::shapes::BodyShapes;
use super::solution::Solution;
use super::surface_load::SurfaceStress;
use crate::algebra::{
    Accuracy, AffineConstraints, DirectSolver, LinearError, LinearSolver, SparseMatrix, Unknowns,
};
use crate::body::{Modes, Pose, RigidVector};
use crate::flow::{Assembly, FlowTerms, assemble, pressure_unknowns, residual};
use crate::space::{CellValues, DofLayout, FacetRule, Tables};
use crate::timing::{Stage, Timing};

/// Everything that defines the system on one configuration of the mesh.
#[derive(Clone, Copy)]
pub struct Configuration<'a, const D: usize> {
    /// What is solved.
    pub problem: &'a Problem<D>,
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Boundary conditions and bodies.
    pub constraints: &'a AffineConstraints,
    /// Newton's and Euler's equations.
    pub bodies: &'a RigidBodyEquations,
}

/// Pattern, factorisation and workspace for the systems on one mesh.
pub struct FluidSystem<const D: usize> {
    /// Numbering of the raw unknowns.
    pub layout: DofLayout<D>,
    /// Boundaries of the mesh.
    pub boundaries: Boundaries,
    /// Number of free unknowns.
    pub n_unknowns: usize,
    modes: Modes,
    facet_rule: FacetRule<D>,
    assembly: Assembly<D>,
    matrix: SparseMatrix,
    solver: Option<Box<dyn LinearSolver>>,
    accuracy: Accuracy,
    /// What each unknown is.
    pub(super) unknowns: Unknowns,
    /// int psi dx of each vertex, to make given velocities compatible with incompressibility.
    pressure_weights: Vec<f64>,
    /// The common velocity of fluid and bodies, where nothing holds them.
    nullspace: Option<TranslationNullspace<D>>,
}

impl<const D: usize> FluidSystem<D> {
    /// Analyses a problem on a mesh. `unknown_frame` makes the frame's velocity an unknown of the
    /// convection.
    #[must_use]
    pub fn new(problem: &Problem<D>, mesh: &Mesh<D>, poses: &[Pose], unknown_frame: bool) -> Self {
        let modes = problem.modes();
        let layout = DofLayout::new(mesh, problem.bodies.len(), modes.len());
        let boundaries = Boundaries::new(mesh);
        // Which unknowns are constrained does not depend on how bodies deform
        let shapes = BodyShapes::rigid(problem.bodies.len());
        let constraints = Constrainer { problem, mesh, layout: &layout }
            .constraints(&boundaries, BodiesAt { poses, shapes: &shapes });
        let frame = problem.frame.filter(|_| unknown_frame);
        let (pattern, assembly) = Assembly::new(
            mesh,
            layout,
            &constraints,
            problem.metric,
            &problem.do_nothing_sides(),
            frame,
        );
        let pressure_weights = pressure_weights(mesh, assembly.tables());
        let unknowns = unknowns(&layout, &constraints);
        Self {
            layout,
            boundaries,
            n_unknowns: constraints.n_unknowns(),
            modes,
            facet_rule: FacetRule::new(problem.metric),
            assembly,
            matrix: SparseMatrix::zeros(pattern),
            solver: None,
            accuracy: Accuracy::default(),
            unknowns,
            pressure_weights,
            nullspace: TranslationNullspace::new(problem, mesh),
        }
    }

    /// Entries of the matrix.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.matrix.pattern().n_entries()
    }

    /// What the linear solver is given of each free unknown.
    #[must_use]
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// How well the last system was solved for which the matrix was factorised.
    #[must_use]
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// Basis tables, for measurements.
    #[must_use]
    pub fn tables(&self) -> &Tables<D> {
        self.assembly.tables()
    }

    /// The stress of a flow on the boundaries of the mesh.
    #[must_use]
    pub fn surface_stress<'a>(
        &'a self,
        problem: &Problem<D>,
        mesh: &'a Mesh<D>,
        solution: &'a Solution<D>,
    ) -> SurfaceStress<'a, D> {
        SurfaceStress {
            mesh,
            boundaries: &self.boundaries,
            rule: &self.facet_rule,
            viscosity: problem.viscosity,
            fields: solution.fields(),
        }
    }

    /// Loads of a flow on the bodies at these poses in the mesh, from the raw residual at it.
    #[must_use]
    pub fn body_loads(
        &self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        poses: &[Pose],
        solution: &Solution<D>,
        residual: &[f64],
    ) -> Vec<BodyLoads> {
        let flow = ResidualOnMesh {
            mesh,
            layout: &self.layout,
            boundaries: &self.boundaries,
            velocity: &solution.velocity,
            residual,
        };
        body_loads(problem, poses, &flow)
    }

    /// Constraints with bodies at these poses, at the time of their shapes.
    #[must_use]
    pub fn constraints(
        &self,
        problem: &Problem<D>,
        mesh: &Mesh<D>,
        bodies: BodiesAt<'_>,
    ) -> AffineConstraints {
        Constrainer { problem, mesh, layout: &self.layout }.constraints(&self.boundaries, bodies)
    }

    /// Takes note that the mesh has moved.
    pub fn move_to(&mut self, problem: &Problem<D>, mesh: &Mesh<D>) {
        if problem.is_enclosed() {
            self.pressure_weights = pressure_weights(mesh, self.assembly.tables());
        }
        self.nullspace = TranslationNullspace::new(problem, mesh);
    }

    /// The raw residual of the fluid's equations at a solution.
    #[must_use]
    pub fn fluid_residual(
        &self,
        mesh: &Mesh<D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
    ) -> Vec<f64> {
        residual(&self.assembly, mesh, terms, &solution.fields())
    }

    /// P^T R: the residual of fluid and bodies on the free unknowns, from that of the fluid.
    #[must_use]
    pub fn reduced_residual(
        &self,
        at: &Configuration<'_, D>,
        solution: &Solution<D>,
        fluid: &[f64],
    ) -> Vec<f64> {
        let mut raw = fluid.to_vec();
        if at.problem.is_enclosed() {
            make_compatible(&mut raw[self.layout.pressures()], &self.pressure_weights);
        }
        let row = |body: usize, position: usize| self.layout.rigid(body, position);
        at.bodies.add_residual(&solution.twists, self.modes, row, &mut raw);
        at.constraints.restrict(&raw)
    }

    /// One Newton step: assembles and factorises the Jacobian at `solution` and returns the next
    /// solution for a given reduced residual.
    ///
    /// # Errors
    /// When the matrix is singular or the solution not finite.
    pub fn newton_step(
        &mut self,
        at: &Configuration<'_, D>,
        terms: &FlowTerms<'_, D>,
        solution: &Solution<D>,
        reduced: &[f64],
        timing: &mut Timing,
    ) -> Result<Solution<D>, SolveError> {
        timing.measure(Stage::Assembly, || {
            let (fields, values) = (solution.fields(), self.matrix.values_mut());
            assemble(&self.assembly, at.mesh, at.constraints, terms, &fields, values);
            self.add_rigid_matrix(at);
        });
        if let Some(nullspace) = &self.nullspace {
            nullspace.check_balance(at.bodies)?;
        }
        let mut free = at.constraints.pick(&self.pinned(solution).to_raw(self.modes));
        let mut step: Vec<f64> = reduced.iter().map(|value| -value).collect();
        self.solve_linear(&free, &mut step, timing).map_err(|error| self.explain(at, error))?;
        for (value, correction) in free.iter_mut().zip(&step) {
            *value += correction;
        }
        let raw = at.constraints.expand(&free);
        if let Some(index) = raw.iter().position(|value| !value.is_finite()) {
            let node = (index / D).min(self.layout.n_nodes - 1);
            let near = at.mesh.nodes[node].as_slice().to_vec();
            return Err(SolveError::NotFinite { near });
        }
        Ok(self.centered(Solution::from_raw(&self.layout, self.modes, &raw)))
    }

    /// The solution seen from where the system holds fluid and bodies.
    fn pinned(&self, solution: &Solution<D>) -> Solution<D> {
        let mut pinned = solution.clone();
        if let Some(nullspace) = &self.nullspace {
            nullspace.pin(&mut pinned);
        }
        pinned
    }

    /// The solution with the mean velocity that is asked for where nothing holds it.
    fn centered(&self, mut solution: Solution<D>) -> Solution<D> {
        if let Some(nullspace) = &self.nullspace {
            nullspace.center(&mut solution);
        }
        solution
    }

    /// Solves with the assembled matrix, in place, for a correction of the free unknowns `free`.
    fn solve_linear(
        &mut self,
        free: &[f64],
        rhs: &mut [f64],
        timing: &mut Timing,
    ) -> Result<(), LinearError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        let solver = timing.measure(Stage::Factorisation, || {
            self.solver.get_or_insert_with(|| analyse(matrix, unknowns))
        });
        let is_solved =
            timing.measure(Stage::Solve, || solver.solve_with_earlier_set_up(matrix, rhs, free))?;
        if !is_solved {
            timing.measure(Stage::Factorisation, || solver.set_up(matrix))?;
            self.accuracy = timing.measure(Stage::Solve, || solver.solve(matrix, rhs))?;
        }
        Ok(())
    }

    /// Adds what Newton's and Euler's equations have of the matrix.
    fn add_rigid_matrix(&mut self, at: &Configuration<'_, D>) {
        let layout = self.layout;
        let row = |body: usize, position: usize| at.constraints.row(layout.rigid(body, position));
        let modes = self.modes;
        for (body, equation) in at.bodies.bodies.iter().enumerate() {
            for (i, one) in modes.iter().enumerate() {
                for (j, other) in modes.iter().enumerate() {
                    let mut factor =
                        equation.inertia[(one.index(), other.index())] * at.bodies.rate;
                    if i == j {
                        factor += equation.resistance[one];
                    }
                    self.add_product(row(body, i), row(body, j), factor);
                }
            }
        }
        for pivot in &at.bodies.pivots {
            for (position, _) in rotations(modes) {
                let [child, parent] = [pivot.child, pivot.parent].map(|body| row(body, position));
                let opposite = parent.iter().map(|(unknown, weight)| (*unknown, -weight));
                let turn: Vec<(u32, f64)> = child.iter().copied().chain(opposite).collect();
                self.add_product(&turn, &turn, pivot.resistance);
            }
        }
    }

    /// Adds factor * v w^T with row vectors v and w of some unknowns.
    fn add_product(&mut self, v: &[(u32, f64)], w: &[(u32, f64)], factor: f64) {
        if factor == 0.0 {
            return;
        }
        for &(first, one) in v {
            for &(second, other) in w {
                let entry = self.matrix.pattern().entry(first as usize, second as usize);
                if let Some(entry) = entry {
                    self.matrix.values_mut()[entry] += one * other * factor;
                }
            }
        }
    }

    /// The solution with all free unknowns zero.
    #[must_use]
    pub fn at_rest(&self, constraints: &AffineConstraints) -> Solution<D> {
        let raw = constraints.expand(&vec![0.0; constraints.n_unknowns()]);
        Solution::from_raw(&self.layout, self.modes, &raw)
    }

    /// A solution that meets the constraints, from another one.
    #[must_use]
    pub fn constrained(&self, constraints: &AffineConstraints, from: &Solution<D>) -> Solution<D> {
        let free = constraints.pick(&self.pinned(from).to_raw(self.modes));
        Solution::from_raw(&self.layout, self.modes, &constraints.expand(&free))
    }

    /// Velocities (m/s, rad/s) of some bodies by unit loads in each of their rigid motions, with the
    /// matrix last assembled: n m x n m for n bodies with m motions, zero for motions that are given.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn mobility(
        &mut self,
        constraints: &AffineConstraints,
        bodies: &[usize],
        timing: &mut Timing,
    ) -> Result<DMatrix<f64>, SolveError> {
        let n_modes = self.modes.len();
        let layout = self.layout;
        let raw = bodies.iter().flat_map(|&body| (0..n_modes).map(move |mode| (body, mode)));
        let rows: Vec<&[(u32, f64)]> =
            raw.map(|(body, mode)| constraints.row(layout.rigid(body, mode))).collect();
        let mut masters: Vec<usize> =
            rows.iter().flat_map(|row| row.iter().map(|(unknown, _)| *unknown as usize)).collect();
        masters.sort_unstable();
        masters.dedup();
        let Factorised { matrix, solver } = self.factorised(timing)?;
        let inverse = timing.measure(Stage::Solve, || solver.inverse_of_dense(matrix, &masters))?;
        // Velocities by loads on the masters, one column each
        let inverse = DMatrix::from_column_slice(masters.len(), masters.len(), &inverse);
        let mut weights: DMatrix<f64> = DMatrix::zeros(rows.len(), masters.len());
        for (at, row) in rows.iter().enumerate() {
            for (unknown, weight) in *row {
                if let Ok(column) = masters.binary_search(&(*unknown as usize)) {
                    weights[(at, column)] += weight;
                }
            }
        }
        Ok(&weights * inverse * weights.transpose())
    }

    /// Adds to a solution what further loads (N, N m) on some bodies change, with the matrix last
    /// assembled.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn apply_body_loads(
        &mut self,
        constraints: &AffineConstraints,
        loads: &[BodyLoad],
        solution: &mut Solution<D>,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        let mut change = vec![0.0; self.n_unknowns];
        for BodyLoad { body, load } in loads {
            for (position, mode) in self.modes.iter().enumerate() {
                for (unknown, weight) in constraints.row(self.layout.rigid(*body, position)) {
                    change[*unknown as usize] += weight * load[mode];
                }
            }
        }
        let Factorised { matrix, solver } = self.factorised(timing)?;
        timing.measure(Stage::Solve, || solver.solve(matrix, &mut change))?;
        let mut free = constraints.pick(&self.pinned(solution).to_raw(self.modes));
        free.iter_mut().zip(&change).for_each(|(value, change)| *value += change);
        let raw = constraints.expand(&free);
        *solution = self.centered(Solution::from_raw(&self.layout, self.modes, &raw));
        Ok(())
    }

    /// The solver with factors of the matrix last assembled.
    fn factorised(&mut self, timing: &mut Timing) -> Result<Factorised<'_>, LinearError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        timing.measure(Stage::Factorisation, || {
            let solver = self.solver.get_or_insert_with(|| analyse(matrix, unknowns));
            solver.set_up(matrix)?;
            Ok(Factorised { matrix, solver: solver.as_mut() })
        })
    }

    /// Shifts the pressure of an enclosed flow to zero mean.
    pub fn center_pressure(&self, problem: &Problem<D>, solution: &mut Solution<D>) {
        if !problem.is_enclosed() {
            return;
        }
        let volume: f64 = self.pressure_weights.iter().sum();
        let weighted = solution.pressure.iter().zip(&self.pressure_weights);
        let mean = weighted.map(|(pressure, weight)| pressure * weight).sum::<f64>() / volume;
        for pressure in &mut solution.pressure {
            *pressure -= mean;
        }
    }
}

/// A matrix with a solver that is set up for it.
struct Factorised<'a> {
    matrix: &'a SparseMatrix,
    solver: &'a mut dyn LinearSolver,
}

/// A solver for matrices with the pattern of this one.
fn analyse(matrix: &SparseMatrix, unknowns: &Unknowns) -> Box<dyn LinearSolver> {
    Box::new(DirectSolver::new(matrix.pattern(), unknowns))
}

/// A load on a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyLoad {
    /// The body.
    pub body: usize,
    /// The load (N, N m).
    pub load: RigidVector,
}

/// What the linear solver has to know of each free unknown.
pub(super) fn unknowns<const D: usize>(
    layout: &DofLayout<D>,
    constraints: &AffineConstraints,
) -> Unknowns {
    let is_pressure = pressure_unknowns(layout, constraints);
    let mut unknowns =
        Unknowns { node: vec![0; is_pressure.len()], is_pressure, dense: Vec::new() };
    for node in layout.nodes() {
        let velocities = (0..D).map(|axis| layout.velocity(node, axis));
        let pressure = (node.index() < layout.n_vertices).then(|| layout.pressure(node));
        for unknown in velocities.chain(pressure).filter_map(|raw| constraints.unknown(raw)) {
            unknowns.node[unknown] = u32::from(node);
        }
    }
    let rigid = layout.n_fluid()..layout.n_raw();
    unknowns.dense = rigid.filter_map(|raw| constraints.unknown(raw)).collect();
    unknowns
}

/// Subtracts their sum from the residuals of the pressures, by the weights.
///
/// Boundary values interpolated on curved sides may carry a tiny net flux, which an enclosed
/// incompressible fluid cannot take: distributed evenly it is not left to the one vertex whose pressure
/// is fixed.
pub(super) fn make_compatible(residuals: &mut [f64], weights: &[f64]) {
    let flux: f64 = residuals.iter().sum();
    let volume: f64 = weights.iter().sum();
    for (value, weight) in residuals.iter_mut().zip(weights) {
        *value -= flux * weight / volume;
    }
}

/// int psi dx of each vertex.
pub(super) fn pressure_weights<const D: usize>(mesh: &Mesh<D>, tables: &Tables<D>) -> Vec<f64> {
    let mut weights = vec![0.0; mesh.n_vertices];
    let mut workspace = CellValues::default();
    for cell in mesh.cell_ids() {
        let nodes = mesh.cell(cell);
        workspace.for_each_point(tables, mesh, cell, |at| {
            for (&vertex, psi) in nodes.iter().zip(at.psi) {
                weights[vertex] += psi * at.dx;
            }
        });
    }
    weights
}

/// Memory a system takes with its factors (bytes), from the velocities and pressures of its mesh.
///
/// Fitted to planar runs with 1.1 10^4, 4.6 10^4 and 2 10^5 free unknowns (42, 152 and 712 MB).
#[must_use]
pub fn memory_estimate(n_dofs: usize) -> f64 {
    5e6 + 33e6 * (n_dofs as f64 / 1e4).powf(1.03)
}
