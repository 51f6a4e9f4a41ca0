//! The flow of the shipped case dfg-2d-2 in the middle of a time step, at a wanted size.

use std::sync::Arc;

use alewife_core::algebra::{AffineConstraints, CellMaps, SparseMatrix, Unknowns};
use alewife_core::body::MeshPoses;
use alewife_core::case::{Case, Model};
use alewife_core::coupling::{BodiesAt, BodyShapes, FluidSystem, Problem, Solution};
use alewife_core::flow::{Assembly, Convection, FlowTerms, assemble, residual};
use alewife_core::run::{build_mesh, build_problem};
use alewife_core::time::Bdf;
use alewife_core::timing::cpu_seconds;
use alewife_mesh::{Mesh, Point};
use criterion::Throughput;
use criterion::measurement::{Measurement, ValueFormatter};

/// Step of the time discretisation, BDF2 (s).
const STEP: f64 = 1e-3;
/// A size this close to the wanted one will do.
const SIZE_TOLERANCE: f64 = 0.02;

/// Mesh, constraints and fields of a time step with given convection.
pub struct TimeStep {
    /// The mesh.
    pub mesh: Mesh<2>,
    /// The constraints at time zero: the cylinder is held.
    pub constraints: AffineConstraints,
    problem: Problem<2>,
    /// Pattern and maps of the mesh.
    assembly: Assembly<2>,
    pub maps: CellMaps,
    solution: Solution<2>,
    /// The inflow's parabola everywhere, which convects.
    crossing: Vec<Point<2>>,
    history: Vec<Point<2>>,
    rate: f64,
    unknowns: Unknowns,
}

/// A linear system, with what each unknown is.
#[allow(dead_code, reason = "not every benchmark solves the system")]
pub struct LinearSystem {
    /// The matrix.
    pub matrix: SparseMatrix,
    /// Right-hand side.
    pub rhs: Vec<f64>,
    /// What each unknown is.
    pub unknowns: Unknowns,
}

fn mesh_at_scale(scale: f64) -> (Model, Mesh<2>) {
    let setting = format!("mesh.scale={scale:e}");
    let model = Case::read("dfg-2d-2", &[setting]).expect("the case is shipped").model;
    let mesh = build_mesh(&model).expect("the mesh can be made at any size");
    (model, mesh)
}

impl TimeStep {
    /// The time step on a mesh with about `n_unknowns` free unknowns.
    pub fn new(n_unknowns: usize) -> Self {
        let mut scale = 1.0;
        // The number of unknowns goes with the square of the size of the cells, nearly.
        for _ in 0..4 {
            let step = Self::at_scale(scale);
            let ratio = step.constraints.n_unknowns() as f64 / n_unknowns as f64;
            if (ratio - 1.0).abs() < SIZE_TOLERANCE {
                return step;
            }
            scale *= ratio.sqrt();
        }
        Self::at_scale(scale)
    }

    fn at_scale(scale: f64) -> Self {
        let (model, mesh) = mesh_at_scale(scale);
        let problem = build_problem(&model, &mesh).expect("the case can be built");
        let poses = MeshPoses::of(problem.bodies.iter().map(|body| body.pose));
        let system = FluidSystem::new(&problem, &mesh, &poses, false);
        let shapes = BodyShapes::at(&problem.bodies, 0.0).expect("no body deforms");
        let constraints =
            system.constraints(&problem, &mesh, BodiesAt { poses: &poses, shapes: &shapes });
        let sides = problem.open_sides();
        let assembly =
            Assembly::new(&mesh, system.layout, &constraints, problem.metric, &sides, None);
        let maps = assembly.maps(&constraints, &[]);
        let (peak, height) = (1.5, 0.41);
        let parabola = |place: &Point<2>| {
            let s = place[1] / height;
            Point::<2>::new(4.0 * peak * s * (1.0 - s), 0.0)
        };
        let crossing: Vec<_> = mesh.nodes.iter().map(parabola).collect();
        let bdf = Bdf::second_order(STEP, STEP);
        let history = crossing.iter().map(|&velocity| bdf.history(velocity, velocity)).collect();
        let mut solution = Solution::at_rest(&system.layout);
        solution.velocity.clone_from(&crossing);
        let solution = system.constrained(&constraints, &solution);
        Self {
            mesh,
            constraints,
            problem,
            assembly,
            maps,
            solution,
            crossing,
            history,
            rate: bdf.next,
            unknowns: system.unknowns().clone(),
        }
    }

    fn terms(&self) -> FlowTerms<'_, 2> {
        FlowTerms {
            viscosity: self.problem.viscosity_at(&[], false),
            density: self.problem.density,
            rate: self.rate,
            history: &self.history,
            convecting_velocity: &self.crossing,
            convection: Convection::Oseen,
        }
    }

    /// Overwrites `values` with the matrix.
    pub fn assemble(&self, values: &mut [f64]) {
        values.fill(0.0);
        let fields = self.solution.fields();
        let scatter = |cell, matrix: &[f64]| self.maps.scatter(cell, matrix, values);
        assemble(&self.assembly, &self.mesh, &self.constraints, &self.terms(), &fields, scatter);
    }

    /// The raw residual.
    pub fn residual(&self) -> Vec<f64> {
        residual(&self.assembly, &self.mesh, &self.terms(), &self.solution.fields())
    }

    /// The same step with the full quadratic map on every cell.
    #[allow(dead_code, reason = "only assembly cares")]
    pub fn with_curved_cells(mut self) -> Self {
        self.mesh.topology_mut().curved.fill(true);
        self
    }

    /// The system to be solved for the change of the free unknowns.
    #[allow(dead_code, reason = "not every benchmark solves the system")]
    pub fn linear_system(&self) -> LinearSystem {
        let mut matrix = SparseMatrix::zeros(Arc::clone(self.maps.pattern()));
        self.assemble(matrix.values_mut());
        let rhs = self.constraints.restrict(&self.residual()).iter().map(|value| -value).collect();
        LinearSystem { matrix, rhs, unknowns: self.unknowns.clone() }
    }
}

#[allow(dead_code, reason = "not every benchmark is timed by criterion")]
/// CPU seconds of the whole process, which other programs on the machine do not change much.
pub struct CpuTime;

impl Measurement for CpuTime {
    type Intermediate = f64;
    type Value = f64;

    fn start(&self) -> f64 {
        cpu_seconds()
    }

    fn end(&self, start: f64) -> f64 {
        cpu_seconds() - start
    }

    fn add(&self, one: &f64, other: &f64) -> f64 {
        one + other
    }

    fn zero(&self) -> f64 {
        0.0
    }

    fn to_f64(&self, value: &f64) -> f64 {
        *value
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        &CpuTime
    }
}

impl ValueFormatter for CpuTime {
    fn scale_values(&self, _: f64, values: &mut [f64]) -> &'static str {
        for value in values {
            *value *= 1e3;
        }
        "ms CPU"
    }

    fn scale_throughputs(
        &self,
        _: f64,
        throughput: &Throughput,
        values: &mut [f64],
    ) -> &'static str {
        let (Throughput::Elements(count) | Throughput::Bytes(count)) = throughput else {
            return "";
        };
        for value in values {
            *value = *value * 1e6 / *count as f64;
        }
        "us/cell"
    }

    fn scale_for_machines(&self, _: &mut [f64]) -> &'static str {
        "s"
    }
}

/// A name for a size: `10k`.
pub fn name_of_size(n_unknowns: usize) -> String {
    format!("{}k", n_unknowns / 1000)
}
