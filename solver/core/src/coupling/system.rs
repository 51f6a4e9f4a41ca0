//! One linear system for the fluid and every body in it.
//!
//! A step of Newton's method on R(x) = 0 with x = P y + g: solve P^T J P dy = -P^T R(x). On the
//! rows of U and omega, P^T gathers minus the fluid's load, to which Newton and Euler add
//! m dU/dt - F_ext and I domega/dt - T_ext: no interface stress, no multiplier, and no added-mass
//! instability at any density ratio.

use alewife_mesh::{Mesh, Point};
use nalgebra::DMatrix;
use thiserror::Error;

use super::constrain::{NodeSides, constrain};
use super::drift::Drift;
use super::link::{Link, Turn};
use super::problem::Problem;
use super::shapes::BodyShapes;
use crate::algebra::{
    Accuracy, AffineConstraints, DirectSolver, LinearError, LinearSolver, SparseMatrix, Unknowns,
};
use crate::body::{Pose, Twist};
use crate::flow::{Assembly, Convection, Fields, FlowTerms, assemble, pressure_unknowns, residual};
use crate::space::{CellValues, DofLayout, Tables};
use crate::timing::{Stage, Timing};

/// Why a system could not be solved.
#[derive(Debug, Error)]
pub enum SolveError {
    /// No inverse, or no accurate solution.
    #[error("{0}")]
    Singular(String),
    /// A value of the solution is not a number.
    #[error("the solution is not finite near ({}, {})", .place[0], .place[1])]
    NotFinite {
        /// Where (m).
        place: Point<2>,
    },
}

/// Values of all raw unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Velocity at the nodes (m/s).
    pub velocity: Vec<Point<2>>,
    /// Pressure at the vertices (Pa).
    pub pressure: Vec<f64>,
    /// Rigid velocities of the bodies.
    pub twists: Vec<Twist>,
}

impl Solution {
    /// Everything at rest.
    #[must_use]
    pub fn at_rest(layout: &DofLayout<2>) -> Self {
        Self {
            velocity: vec![Point::<2>::zeros(); layout.n_nodes],
            pressure: vec![0.0; layout.n_vertices],
            twists: vec![Twist::default(); layout.n_bodies],
        }
    }

    /// The fields among the unknowns.
    #[must_use]
    pub fn fields(&self) -> Fields<'_, 2> {
        Fields { velocity: &self.velocity, pressure: &self.pressure }
    }
}

/// A solution as one vector of raw unknowns.
#[must_use]
pub fn flatten(solution: &Solution) -> Vec<f64> {
    let velocities = solution.velocity.iter().flat_map(|velocity| [velocity[0], velocity[1]]);
    let rigid = solution.twists.iter().flat_map(Twist::in_plane);
    velocities.chain(solution.pressure.iter().copied()).chain(rigid).collect()
}

/// A vector of raw unknowns as a solution.
#[must_use]
pub fn embed(layout: &DofLayout<2>, raw: &[f64]) -> Solution {
    let mut solution = Solution::at_rest(layout);
    for (node, velocity) in layout.nodes().zip(&mut solution.velocity) {
        *velocity = Point::<2>::new(raw[layout.velocity(node, 0)], raw[layout.velocity(node, 1)]);
    }
    solution.pressure.copy_from_slice(&raw[layout.pressures()]);
    for (body, twist) in solution.twists.iter_mut().enumerate() {
        *twist = Twist::planar([0, 1, 2].map(|mode| raw[layout.rigid(body, mode)]));
    }
    solution
}

/// What Newton's and Euler's equations of the bodies are at one time: with V one of U_x, U_y, omega,
/// inertia * (rate * V + history) + resistance * V = fluid + external.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Levels {
    /// Factor of the new value in its time derivative (1/s), 0 when steady.
    pub rate: f64,
    /// Older part of the time derivative for each body (m/s2, rad/s2); none when steady.
    pub history: Vec<[f64; 3]>,
    /// Load per velocity of each body (N s/m, N m s/rad); none without springs.
    pub resistance: Vec<[f64; 3]>,
    /// Load from outside on each body (N, N m).
    pub external: Vec<[f64; 3]>,
    /// Loads in free pivots.
    pub pivots: Vec<PivotLoad>,
    /// Moments of inertia, where bodies deform.
    pub inertia: Vec<f64>,
}

impl Levels {
    /// What resists the three velocities of a body.
    fn inertia_of(&self, problem: &Problem, body: usize) -> [f64; 3] {
        let rigid = &problem.bodies[body];
        let turning = self.inertia.get(body).copied().unwrap_or(rigid.inertia);
        [rigid.mass, rigid.mass, turning]
    }
}

/// Torque torque - resistance (omega_child - omega_parent) on a child in its pivot, the opposite on
/// its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PivotLoad {
    /// The body that hangs.
    pub child: usize,
    /// The body it hangs on.
    pub parent: usize,
    /// Torque per angular velocity (N m s).
    pub resistance: f64,
    /// Torque without the turning of this step (N m).
    pub torque: f64,
}

impl Levels {
    /// Bodies without acceleration where they are at the start, under the loads of a time.
    #[must_use]
    pub fn steady(problem: &Problem, time: f64) -> Self {
        let places: Vec<[f64; 3]> = problem.bodies.iter().map(|body| body.start()).collect();
        Self::default().with_loads(problem, time, &places, 0.0)
    }

    /// With loads and springs of a time, where a body gets to `unmoved` plus `coefficient` (s) times
    /// its velocity.
    #[must_use]
    pub fn with_loads(
        mut self,
        problem: &Problem,
        time: f64,
        unmoved: &[[f64; 3]],
        coefficient: f64,
    ) -> Self {
        self.external = problem.bodies.iter().map(|body| body.external(time)).collect();
        for (child, rigid) in problem.bodies.iter().enumerate() {
            let Some(Link { parent, turn: Turn::Free(pivot), .. }) = &rigid.link else { continue };
            let bend = unmoved[child][2] - unmoved[*parent][2] - pivot.rest;
            let motor = pivot.motor.as_ref().map_or(0.0, |motor| motor(time));
            self.pivots.push(PivotLoad {
                child,
                parent: *parent,
                resistance: pivot.damping + pivot.stiffness * coefficient,
                torque: motor - pivot.stiffness * bend,
            });
        }
        for (body, rigid) in problem.bodies.iter().enumerate() {
            let Some(spring) = &rigid.spring else { continue };
            self.resistance.resize(problem.bodies.len(), [0.0; 3]);
            for mode in 0..3 {
                let stiffness = spring.stiffness[mode];
                self.resistance[body][mode] = spring.damping[mode] + stiffness * coefficient;
                self.external[body][mode] -= stiffness * (unmoved[body][mode] - spring.rest[mode]);
            }
        }
        self
    }
}

/// Pattern, factorisation and workspace for the systems on one mesh.
pub struct FluidSystem {
    /// Numbering of the raw unknowns.
    pub layout: DofLayout<2>,
    /// Boundaries of the nodes.
    pub sides: NodeSides,
    /// Number of free unknowns.
    pub n_unknowns: usize,
    assembly: Assembly,
    matrix: SparseMatrix,
    solver: Option<Box<dyn LinearSolver>>,
    accuracy: Accuracy,
    /// What each unknown is.
    unknowns: Unknowns,
    /// int psi dx of each vertex, to spread a flux imbalance evenly.
    pressure_weights: Vec<f64>,
    /// The common velocity of fluid and bodies, where nothing holds them.
    drift: Option<Drift>,
}

impl FluidSystem {
    /// Analyses a problem on a mesh. `unknown_frame` makes the frame's velocity an unknown of the
    /// convection.
    #[must_use]
    pub fn new(problem: &Problem, mesh: &Mesh<2>, poses: &[Pose], unknown_frame: bool) -> Self {
        let layout = DofLayout::new(mesh, problem.bodies.len());
        let sides = NodeSides::new(mesh);
        // Which unknowns are constrained does not depend on how bodies deform
        let shapes = BodyShapes::rigid(problem.bodies.len());
        let constraints = constrain(problem, mesh, &layout, &sides, poses, &shapes);
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
            sides,
            n_unknowns: constraints.n_unknowns(),
            assembly,
            matrix: SparseMatrix::zeros(pattern),
            solver: None,
            accuracy: Accuracy::default(),
            unknowns,
            pressure_weights,
            drift: Drift::new(problem, mesh),
        }
    }

    /// Entries of the matrix.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.matrix.pattern().n_entries()
    }

    /// What the linear solver is told of each free unknown.
    #[must_use]
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// How well the last system was solved for which the matrix was factorised.
    #[must_use]
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }

    /// Constraints at the time of `shapes`.
    #[must_use]
    pub fn constraints(
        &self,
        problem: &Problem,
        mesh: &Mesh<2>,
        poses: &[Pose],
        shapes: &BodyShapes,
    ) -> AffineConstraints {
        constrain(problem, mesh, &self.layout, &self.sides, poses, shapes)
    }

    /// The raw residual of the fluid's equations at a solution.
    #[must_use]
    pub fn fluid_residual(
        &self,
        mesh: &Mesh<2>,
        terms: &FlowTerms<'_, 2>,
        solution: &Solution,
    ) -> Vec<f64> {
        residual(&self.assembly, mesh, terms, &solution.fields())
    }

    /// P^T R: the residual of fluid and bodies on the free unknowns.
    #[must_use]
    pub fn reduced_residual(
        &self,
        problem: &Problem,
        constraints: &AffineConstraints,
        levels: &Levels,
        solution: &Solution,
        mut raw: Vec<f64>,
    ) -> Vec<f64> {
        if problem.is_enclosed() {
            spread_flux(&mut raw[self.layout.pressures()], &self.pressure_weights);
        }
        for body in 0..problem.bodies.len() {
            let rates = solution.twists[body].in_plane();
            let inertia = levels.inertia_of(problem, body);
            for mode in 0..3 {
                let of = |values: &[[f64; 3]]| values.get(body).map_or(0.0, |value| value[mode]);
                raw[self.layout.rigid(body, mode)] += inertia[mode]
                    * (levels.rate * rates[mode] + of(&levels.history))
                    + of(&levels.resistance) * rates[mode]
                    - of(&levels.external);
            }
        }
        for pivot in &levels.pivots {
            let rate = |body: usize| solution.twists[body].angular.z;
            let torque = pivot.torque - pivot.resistance * (rate(pivot.child) - rate(pivot.parent));
            raw[self.layout.rigid(pivot.child, 2)] -= torque;
            raw[self.layout.rigid(pivot.parent, 2)] += torque;
        }
        constraints.restrict(&raw)
    }

    /// One Newton step: assembles and factorises the Jacobian at `solution` and returns the next
    /// solution for a given reduced residual.
    ///
    /// # Errors
    /// When the matrix is singular or the solution not finite.
    #[expect(clippy::too_many_arguments, reason = "the step needs all that defines the system")]
    pub fn newton_step(
        &mut self,
        problem: &Problem,
        mesh: &Mesh<2>,
        constraints: &AffineConstraints,
        terms: &FlowTerms<'_, 2>,
        levels: &Levels,
        solution: &Solution,
        reduced: &[f64],
        timing: &mut Timing,
    ) -> Result<Solution, SolveError> {
        timing.measure(Stage::Assembly, || {
            let fields = solution.fields();
            let values = self.matrix.values_mut();
            assemble(&self.assembly, mesh, constraints, terms, &fields, values);
            self.add_rigid_inertia(problem, constraints, levels);
        });
        if let Some((axis, sum)) = self.drift.as_ref().and_then(|d| d.unbalanced(&levels.external))
        {
            return Err(SolveError::Singular(format!(
                "the forces on the bodies sum up to {sum:.3e} along {}, where nothing holds fluid and \
                 bodies; balance them, or hold a body or a side",
                ["x", "y"][axis]
            )));
        }
        let mut free = constraints.pick(&flatten(&self.pinned(solution)));
        let mut step: Vec<f64> = reduced.iter().map(|value| -value).collect();
        self.solve_linear(&free, &mut step, timing)
            .map_err(|error| self.explain(problem, mesh, constraints, &error))?;
        for (value, correction) in free.iter_mut().zip(&step) {
            *value += correction;
        }
        let raw = constraints.expand(&free);
        if let Some(raw_index) = raw.iter().position(|value| !value.is_finite()) {
            let node = (raw_index / 2).min(self.layout.n_nodes - 1);
            return Err(SolveError::NotFinite { place: mesh.nodes[node] });
        }
        Ok(self.centred(embed(&self.layout, &raw)))
    }

    /// The solution seen from where the system holds fluid and bodies.
    fn pinned(&self, solution: &Solution) -> Solution {
        let mut pinned = solution.clone();
        if let Some(drift) = &self.drift {
            drift.pin(&mut pinned);
        }
        pinned
    }

    /// The solution with the mean velocity that is asked for where nothing holds it.
    fn centred(&self, mut solution: Solution) -> Solution {
        if let Some(drift) = &self.drift {
            drift.center(&mut solution);
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

    /// What an error of the linear algebra means: which unknown, where, and what may be missing.
    fn explain(
        &self,
        problem: &Problem,
        mesh: &Mesh<2>,
        constraints: &AffineConstraints,
        error: &LinearError,
    ) -> SolveError {
        let LinearError::Singular(singular) = error else {
            return SolveError::Singular(error.to_string());
        };
        let name = |unknown: usize| {
            let raw =
                (0..self.layout.n_raw()).find(|&raw| constraints.unknown(raw) == Some(unknown));
            raw.map_or_else(|| format!("unknown {unknown}"), |raw| self.name(problem, mesh, raw))
        };
        let listed = |unknowns: &[usize]| {
            let mut names: Vec<String> = unknowns.iter().take(3).map(|&one| name(one)).collect();
            if unknowns.len() > names.len() {
                names.push(format!("{} more", unknowns.len() - names.len()));
            }
            names.join(", ")
        };
        let advice = if singular.unknowns.iter().any(|one| self.unknowns.dense.contains(one)) {
            "; nothing holds body and fluid: a wall, a given velocity or locked directions would"
        } else {
            ""
        };
        SolveError::Singular(format!(
            "the equations do not determine {}; left without an unknown is the equation of {}{advice}",
            listed(&singular.unknowns),
            listed(&singular.equations)
        ))
    }

    /// A raw unknown in words.
    fn name(&self, problem: &Problem, mesh: &Mesh<2>, raw: usize) -> String {
        let at =
            |node: usize| format!("({:.4e}, {:.4e})", mesh.nodes[node][0], mesh.nodes[node][1]);
        let first_pressure = self.layout.pressures().start;
        if raw < first_pressure {
            format!("the {} velocity at {}", problem.metric.axis_name(raw % 2), at(raw / 2))
        } else if raw < self.layout.n_fluid() {
            format!("the pressure at {}", at(raw - first_pressure))
        } else {
            let (body, mode) =
                ((raw - self.layout.n_fluid()) / 3, (raw - self.layout.n_fluid()) % 3);
            let what = if mode < 2 { problem.metric.axis_name(mode) } else { "angular" };
            format!("the {what} velocity of body {:?}", problem.bodies[body].name)
        }
    }

    fn add_rigid_inertia(
        &mut self,
        problem: &Problem,
        constraints: &AffineConstraints,
        levels: &Levels,
    ) {
        for body in 0..problem.bodies.len() {
            let inertia = levels.inertia_of(problem, body);
            for (mode, inertia) in inertia.into_iter().enumerate() {
                let resistance = levels.resistance.get(body).map_or(0.0, |all| all[mode]);
                let row = constraints.row(self.layout.rigid(body, mode));
                self.add_square(row, inertia * levels.rate + resistance);
            }
        }
        for pivot in &levels.pivots {
            let [child, parent] =
                [pivot.child, pivot.parent].map(|body| constraints.row(self.layout.rigid(body, 2)));
            let opposite = parent.iter().map(|(unknown, weight)| (*unknown, -weight));
            let turn: Vec<(u32, f64)> = child.iter().copied().chain(opposite).collect();
            self.add_square(&turn, pivot.resistance);
        }
    }

    /// Adds factor * v v^T with the row vector v of some unknowns.
    fn add_square(&mut self, row: &[(u32, f64)], factor: f64) {
        if factor == 0.0 {
            return;
        }
        for &(first, one) in row {
            for &(second, other) in row {
                let pattern = self.matrix.pattern();
                if let Some(entry) = pattern.entry(first as usize, second as usize) {
                    self.matrix.values_mut()[entry] += one * other * factor;
                }
            }
        }
    }

    /// Takes note that the mesh has moved.
    pub fn move_to(&mut self, problem: &Problem, mesh: &Mesh<2>) {
        if problem.is_enclosed() {
            self.pressure_weights = pressure_weights(mesh, self.assembly.tables());
        }
        self.drift = Drift::new(problem, mesh);
    }

    /// A solution that meets the constraints, from values of all raw unknowns.
    #[must_use]
    pub fn constrained(&self, constraints: &AffineConstraints, raw: &[f64]) -> Solution {
        let mut solution = embed(&self.layout, raw);
        if let Some(drift) = &self.drift {
            drift.pin(&mut solution);
        }
        let free = constraints.pick(&flatten(&solution));
        embed(&self.layout, &constraints.expand(&free))
    }

    /// Velocities (m/s, rad/s) of some bodies by unit force along x, along y and unit torque on each
    /// of them, with the matrix last assembled: 3 n x 3 n, zero for motions that are given.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn mobility(
        &mut self,
        constraints: &AffineConstraints,
        bodies: &[usize],
        timing: &mut Timing,
    ) -> Result<DMatrix<f64>, SolveError> {
        let modes = bodies.iter().flat_map(|&body| [0, 1, 2].map(|mode| (body, mode)));
        let rows: Vec<&[(u32, f64)]> =
            modes.map(|(body, mode)| constraints.row(self.layout.rigid(body, mode))).collect();
        let mut masters: Vec<usize> =
            rows.iter().flat_map(|row| row.iter().map(|(unknown, _)| *unknown as usize)).collect();
        masters.sort_unstable();
        masters.dedup();
        let Factorised { matrix, solver } = self.factorised(timing)?;
        let inverse = timing
            .measure(Stage::Solve, || solver.inverse_of_dense(matrix, &masters))
            .map_err(|error| SolveError::Singular(error.to_string()))?;
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

    /// Adds to a solution what further loads (N, N, N m) on some bodies change, with the matrix last
    /// assembled.
    ///
    /// # Errors
    /// When the matrix is singular.
    pub fn respond(
        &mut self,
        constraints: &AffineConstraints,
        loads: &[(usize, [f64; 3])],
        solution: &mut Solution,
        timing: &mut Timing,
    ) -> Result<(), SolveError> {
        let mut change = vec![0.0; self.n_unknowns];
        for &(body, load) in loads {
            for (mode, load) in load.into_iter().enumerate() {
                for (unknown, weight) in constraints.row(self.layout.rigid(body, mode)) {
                    change[*unknown as usize] += weight * load;
                }
            }
        }
        let Factorised { matrix, solver } = self.factorised(timing)?;
        timing
            .measure(Stage::Solve, || solver.solve(matrix, &mut change))
            .map_err(|error| SolveError::Singular(error.to_string()))?;
        let mut free = constraints.pick(&flatten(&self.pinned(solution)));
        free.iter_mut().zip(&change).for_each(|(value, change)| *value += change);
        *solution = self.centred(embed(&self.layout, &constraints.expand(&free)));
        Ok(())
    }

    /// The solver with factors of the matrix last assembled.
    fn factorised(&mut self, timing: &mut Timing) -> Result<Factorised<'_>, SolveError> {
        let (matrix, unknowns) = (&self.matrix, &self.unknowns);
        timing.measure(Stage::Factorisation, || {
            let solver = self.solver.get_or_insert_with(|| analyse(matrix, unknowns));
            solver.set_up(matrix).map_err(|error| SolveError::Singular(error.to_string()))?;
            Ok(Factorised { matrix, solver: solver.as_mut() })
        })
    }

    /// Shifts the pressure of an enclosed flow to zero mean.
    pub fn center_pressure(&self, problem: &Problem, solution: &mut Solution) {
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

    /// Basis tables, for measurements.
    #[must_use]
    pub fn tables(&self) -> &Tables<2> {
        self.assembly.tables()
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

/// What the linear solver has to know of each free unknown.
pub(super) fn unknowns(layout: &DofLayout<2>, constraints: &AffineConstraints) -> Unknowns {
    let is_pressure = pressure_unknowns(layout, constraints);
    let mut unknowns =
        Unknowns { node: vec![0; is_pressure.len()], is_pressure, dense: Vec::new() };
    for node in layout.nodes() {
        let velocities = (0..2).map(|axis| layout.velocity(node, axis));
        let pressure = (node.index() < layout.n_vertices).then(|| layout.pressure(node));
        for unknown in velocities.chain(pressure).filter_map(|raw| constraints.unknown(raw)) {
            unknowns.node[unknown] = u32::from(node);
        }
    }
    let rigid = layout.n_fluid()..layout.n_raw();
    unknowns.dense = rigid.filter_map(|raw| constraints.unknown(raw)).collect();
    unknowns
}

/// Takes their sum out of the residuals of the pressures, by the weights.
///
/// Boundary values interpolated on curved sides may carry a tiny net flux, which an enclosed
/// incompressible fluid cannot take: spread evenly it is not left to the one vertex whose pressure is
/// fixed.
pub(super) fn spread_flux(residuals: &mut [f64], weights: &[f64]) {
    let flux: f64 = residuals.iter().sum();
    let volume: f64 = weights.iter().sum();
    for (value, weight) in residuals.iter_mut().zip(weights) {
        *value -= flux * weight / volume;
    }
}

/// int psi dx of each vertex.
pub(super) fn pressure_weights(mesh: &Mesh<2>, tables: &Tables<2>) -> Vec<f64> {
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

/// How a convection acts when the frame's velocity may be an unknown.
#[must_use]
pub(crate) fn newton_convection(problem: &Problem) -> Convection {
    let frame_is_unknown = problem.frame.is_some();
    match (problem.has_convection, frame_is_unknown) {
        (false, _) => Convection::None,
        (true, false) => Convection::Newton,
        (true, true) => Convection::NewtonInFrame,
    }
}
