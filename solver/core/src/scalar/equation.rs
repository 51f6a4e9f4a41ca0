//! `Equation`: the system of a scalar on a mesh; each step is one linear solution.

use std::sync::Arc;

use alewife_mesh::{BoundaryId, BoundaryKind, CellId, Mesh, NodeId, Point, Simplex};
use rayon::prelude::*;

use super::cells::Terms;
use super::field::{Condition, Level, Scalar};
use super::surface::Surface;
use crate::algebra::{
    AffineConstraints, CellFolds, CellMaps, ConstraintBuilder, DirectSolver, LinearError,
    LinearSolver, SparseMatrix, Unknowns,
};
use crate::space::{CellValues, FacetRule, Metric, Tables};

/// Cells a thread takes at a time.
const CELLS_PER_TASK: usize = 64;

/// What carries a scalar, on the mesh at the new level.
#[derive(Clone, Copy)]
pub struct Carrier<'a, const D: usize> {
    /// The mesh, in the laboratory.
    pub mesh: &'a Mesh<D>,
    /// Velocities at the nodes, seen from the mesh (m/s).
    pub velocity: &'a [Point<D>],
    /// Time (s).
    pub time: f64,
}

/// The rate of a step: `rate` times the new values and `history`, none of a steady solution.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    /// Factor of the new level (1/s).
    pub rate: f64,
    /// What older levels give at each node.
    pub history: &'a [f64],
}

/// A solution of the equation.
pub type Solved = Result<Level, LinearError>;

/// The system of one scalar on one mesh: its pattern, its factors.
#[derive(Debug)]
pub struct Equation<const D: usize> {
    tables: Tables<D>,
    rule: FacetRule<D>,
    folds: CellFolds,
    maps: CellMaps,
    unknowns: Unknowns,
    /// None before the first solution.
    solver: Option<DirectSolver>,
    /// For each node the boundary that holds its value.
    holder: Vec<Option<BoundaryId>>,
}

/// Matrices and loads of all cells.
struct Assembled {
    cells: Vec<f64>,
    size: usize,
}

impl<const D: usize> Equation<D> {
    /// The system of a scalar on a mesh, whichever way that moves.
    #[must_use]
    pub fn new(scalar: &Scalar<D>, mesh: &Mesh<D>, metric: Metric) -> Self {
        let holder = holders(scalar, mesh);
        let constraints = constraints(mesh, &holder, |_, _| 0.0);
        let raw = mesh.cells.iter().map(|node| raw_unknown(node.index())).collect::<Vec<u32>>();
        let folds = CellFolds::new(Simplex::<D>::N_NODES, raw, &constraints);
        let maps = CellMaps::new(&folds.unknowns(&constraints), |_, _| true);
        let mut node = vec![0; constraints.n_unknowns()];
        for raw in 0..constraints.n_raw() {
            if let Some(unknown) = constraints.unknown(raw) {
                node[unknown] = raw_unknown(raw);
            }
        }
        let is_pressure = vec![false; node.len()];
        let unknowns = Unknowns { node, is_pressure, dense: Vec::new() };
        let (tables, rule) = (Tables::new(metric), FacetRule::new(metric));
        Self { tables, rule, folds, maps, unknowns, solver: None, holder }
    }

    /// The values after a step, with what comes through each boundary: by diffusion from the residual, as forces are.
    ///
    /// # Errors
    /// When the system has no solution, as where nothing determines the level of a steady scalar.
    pub fn solve(&mut self, scalar: &Scalar<D>, carrier: Carrier<'_, D>, step: Step<'_>) -> Solved {
        let assembled = self.assemble(scalar, carrier, step);
        let values = self.values(scalar, carrier, &assembled, &[])?;
        let residual = self.residual(carrier.mesh, &assembled, &values);
        let fluxes = self.fluxes(scalar, carrier, &values, &residual);
        let source = self.source(scalar, carrier);
        Ok(Level { values, fluxes, source })
    }

    /// The values that have integrals with the test functions (m3; m2 planar, times the unit) besides what a step has.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub(super) fn solve_for(
        &mut self,
        scalar: &Scalar<D>,
        carrier: Carrier<'_, D>,
        step: Step<'_>,
        wanted: &[f64],
    ) -> Result<Vec<f64>, LinearError> {
        let assembled = self.assemble(scalar, carrier, step);
        self.values(scalar, carrier, &assembled, wanted)
    }

    /// The values at the nodes that make the residual `wanted`, zero where that is empty.
    fn values(
        &mut self,
        scalar: &Scalar<D>,
        carrier: Carrier<'_, D>,
        assembled: &Assembled,
        wanted: &[f64],
    ) -> Result<Vec<f64>, LinearError> {
        let mesh = carrier.mesh;
        let constraints = constraints(mesh, &self.holder, |boundary, node| {
            match &scalar.conditions[boundary.index()] {
                Some(Condition::Value(value)) => value(&mesh.nodes[node], carrier.time),
                _ => 0.0,
            }
        });
        let given = constraints.expand(&vec![0.0; constraints.n_unknowns()]);
        let mut defect = self.residual(mesh, assembled, &given);
        defect.iter_mut().for_each(|value| *value = -*value);
        defect.iter_mut().zip(wanted).for_each(|(value, wanted)| *value += wanted);
        let mut free = constraints.restrict(&defect);
        let matrix = self.matrix(&constraints, assembled);
        let solver = match &mut self.solver {
            Some(solver) => solver,
            none => none.insert(DirectSolver::new(self.maps.pattern(), &self.unknowns)?),
        };
        solver.set_up(&matrix)?;
        solver.solve(&matrix, &mut free)?;
        Ok(constraints.expand(&free))
    }

    fn assemble(&self, scalar: &Scalar<D>, carrier: Carrier<'_, D>, step: Step<'_>) -> Assembled {
        let Carrier { mesh, velocity, time } = carrier;
        let terms = Terms {
            tables: &self.tables,
            mesh,
            carrying: velocity,
            diffusivity: scalar.diffusivity,
            rate: step.rate,
            history: step.history,
            source: scalar.source.as_ref(),
            time,
        };
        let n = Simplex::<D>::N_NODES;
        let size = n * n + n;
        let mut cells = vec![0.0; size * mesh.n_cells()];
        cells.par_chunks_mut(CELLS_PER_TASK * size).enumerate().for_each(|(task, results)| {
            let first = task * CELLS_PER_TASK;
            terms.fill(first..first + results.len() / size, results);
        });
        for facet in &mesh.facets {
            if let Some(condition) = &scalar.conditions[facet.boundary.index()] {
                let cell = facet.cell.index() * size;
                let surface = Surface { mesh, facet, rule: &self.rule, time };
                surface.add(condition, &mut cells[cell..cell + size]);
            }
        }
        Assembled { cells, size }
    }

    /// A c - b for all nodes.
    fn residual(&self, mesh: &Mesh<D>, assembled: &Assembled, values: &[f64]) -> Vec<f64> {
        let n = Simplex::<D>::N_NODES;
        let mut total = vec![0.0; values.len()];
        for (cell, numbers) in assembled.cells.chunks_exact(assembled.size).enumerate() {
            let nodes = mesh.cell(CellId::new(cell));
            let (matrix, load) = numbers.split_at(n * n);
            for (&node, column) in nodes.iter().zip(matrix.chunks_exact(n)) {
                for (&row, entry) in nodes.iter().zip(column) {
                    total[row.index()] += entry * values[node.index()];
                }
            }
            for (&row, value) in nodes.iter().zip(load) {
                total[row.index()] -= value;
            }
        }
        total
    }

    /// P^T A P.
    fn matrix(&self, constraints: &AffineConstraints, assembled: &Assembled) -> SparseMatrix {
        let n = Simplex::<D>::N_NODES;
        let mut values = vec![0.0; self.maps.pattern().n_entries()];
        let mut folded = vec![0.0; self.folds.largest_matrix()];
        for (cell, numbers) in assembled.cells.chunks_exact(assembled.size).enumerate() {
            let matrix = &numbers[..n * n];
            if self.folds.is_folded(cell) {
                self.folds.fold(cell, constraints, matrix, &mut folded);
                self.maps.scatter(cell, &folded, &mut values);
            } else {
                self.maps.scatter(cell, matrix, &mut values);
            }
        }
        SparseMatrix::new(Arc::clone(self.maps.pattern()), values)
    }

    /// What comes into the fluid through each boundary.
    fn fluxes(
        &self,
        scalar: &Scalar<D>,
        carrier: Carrier<'_, D>,
        values: &[f64],
        residual: &[f64],
    ) -> Vec<f64> {
        let Carrier { mesh, velocity, time } = carrier;
        let mut fluxes = vec![0.0; mesh.boundaries.len()];
        for (holder, defect) in self.holder.iter().zip(residual) {
            if let Some(boundary) = holder {
                fluxes[boundary.index()] += defect;
            }
        }
        for facet in &mesh.facets {
            let surface = Surface { mesh, facet, rule: &self.rule, time };
            let influx = &mut fluxes[facet.boundary.index()];
            if let Some(condition) = &scalar.conditions[facet.boundary.index()] {
                *influx += surface.diffused(condition, values);
            }
            *influx += surface.carried(velocity, values);
        }
        fluxes
    }

    /// What is made in the fluid.
    fn source(&self, scalar: &Scalar<D>, carrier: Carrier<'_, D>) -> f64 {
        let Some(source) = &scalar.source else { return 0.0 };
        let mut workspace = CellValues::default();
        let mut total = 0.0;
        for cell in carrier.mesh.cell_ids() {
            workspace.for_each_point(&self.tables, carrier.mesh, cell, |at| {
                total += source(&at.position, carrier.time) * at.dx;
            });
        }
        total
    }
}

fn raw_unknown(unknown: usize) -> u32 {
    u32::try_from(unknown).expect("indices of nodes take at most 32 bits")
}

/// For each node the boundary that holds its value, a body rather than a side; copies across periods with their originals.
fn holders<const D: usize>(scalar: &Scalar<D>, mesh: &Mesh<D>) -> Vec<Option<BoundaryId>> {
    let is_body =
        |boundary: BoundaryId| matches!(mesh.boundaries[boundary].kind, BoundaryKind::Body(_));
    let mut holder: Vec<Option<BoundaryId>> = vec![None; mesh.n_nodes()];
    for facet in &mesh.facets {
        let boundary = facet.boundary;
        if !matches!(scalar.conditions[boundary.index()], Some(Condition::Value(_))) {
            continue;
        }
        for node in mesh.facet_nodes(facet) {
            let known = &mut holder[node.index()];
            if known.is_none() || is_body(boundary) {
                *known = Some(boundary);
            }
        }
    }
    for pair in &mesh.periodic {
        let [copy, original] = [pair.copy.index(), pair.original.index()];
        let either = holder[original].or(holder[copy]);
        (holder[copy], holder[original]) = (either, either);
    }
    holder
}

fn constraints<const D: usize>(
    mesh: &Mesh<D>,
    holder: &[Option<BoundaryId>],
    value: impl Fn(BoundaryId, NodeId) -> f64,
) -> AffineConstraints {
    let mut builder = ConstraintBuilder::new(mesh.n_nodes());
    for (node, holder) in holder.iter().enumerate() {
        if let Some(boundary) = holder {
            builder.fix(node, value(*boundary, NodeId::new(node)));
        }
    }
    for pair in &mesh.periodic {
        let [copy, original] = [pair.copy.index(), pair.original.index()];
        if holder[copy].is_none() {
            builder.equate(copy, original);
        }
    }
    builder.build()
}
