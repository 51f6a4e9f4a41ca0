//! Loop over cells: gather, add the terms, fold into the free unknowns, scatter.
//!
//! Cells are worked on in parallel in blocks; what they give is added in the order of the cells,
//! so that the sums have the same bits on any number of threads.

use std::ops::Range;

use alewife_mesh::{CellId, Facet, Mesh, Simplex};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::cell_terms::{Input, LocalLayout, cell_matrix, cell_residual};
use super::open_side::add_open_side;
use super::points::PointTable;
use super::terms::{Convection, Fields, FlowTerms};
use crate::algebra::{AffineConstraints, CellMaps, Pattern};
use crate::space::{DofLayout, Metric, Rule, Tables, interval_rule};

/// Cells a thread takes at a time: their matrices stay in its cache.
const CELLS_PER_TASK: usize = 64;

/// Nodes of a cell, and nodes rounded up to whole registers.
const N: usize = Simplex::<2>::N_NODES;
const P: usize = N.next_multiple_of(4);
/// Velocities and pressures of a cell.
const N_FLUID: usize = LocalLayout::<2, N>::FLUID;

/// Basis values on cells with straight sides.
#[derive(Debug, Clone)]
enum StraightTable {
    Planar(Box<PointTable<2, N, P, 8>>),
    /// The factor r asks for a rule of higher degree.
    Axisymmetric(Box<PointTable<2, N, P, 12>>),
}

/// What assembling needs of a mesh: derived from it, replaced with it.
#[derive(Debug, Clone)]
pub struct Assembly {
    tables: Tables<2>,
    straight: StraightTable,
    curved: PointTable<2, N, P, 16>,
    maps: CellMaps,
    /// The open side of each cell that has one.
    open: Vec<Option<Facet>>,
    facet_rule: Rule<1>,
    layout: DofLayout<2>,
    with_frame: bool,
}

impl Assembly {
    /// Pattern and maps of a mesh under constraints.
    ///
    /// `open_boundaries` lists the sides with the do-nothing condition; `frame` is the body whose
    /// velocity is an unknown of every cell, if any.
    #[must_use]
    pub fn new(
        mesh: &Mesh<2>,
        layout: DofLayout<2>,
        constraints: &AffineConstraints,
        metric: Metric,
        open_boundaries: &[usize],
        frame: Option<usize>,
    ) -> (Pattern, Self) {
        // In the order of `LocalLayout`.
        let n_local = N_FLUID + if frame.is_some() { 2 } else { 0 };
        let mut raw = Vec::with_capacity(n_local * mesh.n_cells());
        for nodes in mesh.cells() {
            for axis in 0..2 {
                raw.extend(nodes.iter().map(|&node| layout.velocity(node, axis) as u32));
            }
            raw.extend(nodes[..3].iter().map(|&vertex| layout.pressure(vertex) as u32));
            if let Some(body) = frame {
                raw.extend((0..2).map(|axis| layout.rigid(body, axis) as u32));
            }
        }
        let is_pressure = pressure_unknowns(&layout, constraints);
        let (pattern, maps) = CellMaps::new(n_local, raw, constraints, |row, column| {
            !(is_pressure[row] && is_pressure[column])
        });
        let mut open = vec![None; mesh.n_cells()];
        for facet in &mesh.facets {
            if open_boundaries.contains(&facet.boundary.index()) {
                open[facet.cell] = Some(*facet);
            }
        }
        let tables = Tables::new(metric);
        let straight = if metric.is_revolved() {
            StraightTable::Axisymmetric(Box::new(PointTable::new(tables.rule(false))))
        } else {
            StraightTable::Planar(Box::new(PointTable::new(tables.rule(false))))
        };
        let assembly = Self {
            straight,
            curved: PointTable::new(tables.rule(true)),
            tables,
            maps,
            open,
            facet_rule: interval_rule(4),
            layout,
            with_frame: frame.is_some(),
        };
        (pattern, assembly)
    }

    /// Basis tables.
    #[must_use]
    pub fn tables(&self) -> &Tables<2> {
        &self.tables
    }

    fn n_local(&self) -> usize {
        N_FLUID + if self.with_frame { 2 } else { 0 }
    }
}

/// Whether each free unknown is a pressure.
#[must_use]
pub fn pressure_unknowns(layout: &DofLayout<2>, constraints: &AffineConstraints) -> Vec<bool> {
    let mut is_pressure = vec![false; constraints.n_unknowns()];
    for vertex in layout.vertices() {
        if let Some(unknown) = constraints.unknown(layout.pressure(vertex)) {
            is_pressure[unknown] = true;
        }
    }
    is_pressure
}

/// Lets `compute` fill `size` numbers for each cell, in parallel, and hands those of one cell
/// after the other to `add`, in the order of the cells.
///
/// While one thread adds what a block of cells gave, the others work on the next block.
fn for_each_cell(
    n_cells: usize,
    size: usize,
    compute: impl Fn(Range<usize>, &mut [f64]) + Sync,
    mut add: impl FnMut(usize, &[f64]) + Send,
) {
    let block_size = CELLS_PER_TASK * rayon::current_num_threads();
    let block = |index: usize| {
        let start = (index * block_size).min(n_cells);
        start..(start + block_size).min(n_cells)
    };
    let compute_block = |index: usize, results: &mut [f64]| {
        let cells = block(index);
        results[..cells.len() * size].par_chunks_mut(CELLS_PER_TASK * size).enumerate().for_each(
            |(task, results)| {
                let start = cells.start + task * CELLS_PER_TASK;
                compute(start..start + results.len() / size, results);
            },
        );
    };
    let mut next = vec![0.0; block_size.min(n_cells) * size];
    let mut done = next.clone();
    // Inside the pool, so that no block has to be handed over to it.
    rayon::scope(|_| {
        compute_block(0, &mut next);
        for index in 0..n_cells.div_ceil(block_size) {
            std::mem::swap(&mut next, &mut done);
            rayon::join(
                || {
                    for (cell, result) in block(index).zip(done.chunks_exact(size)) {
                        add(cell, result);
                    }
                },
                || compute_block(index + 1, &mut next),
            );
        }
    });
}

/// Overwrites `values` with P^T A P of the terms, linearised at the fields.
pub fn assemble(
    assembly: &Assembly,
    mesh: &Mesh<2>,
    constraints: &AffineConstraints,
    terms: &FlowTerms<'_, 2>,
    fields: &Fields<'_, 2>,
    values: &mut [f64],
) {
    debug_assert!(assembly.with_frame || terms.convection != Convection::NewtonInFrame);
    values.fill(0.0);
    let input = Input { mesh, metric: assembly.tables.metric(), terms, fields };
    let size = assembly.maps.largest_matrix();
    for_each_cell(
        mesh.n_cells(),
        size,
        |cells, results| {
            Arch::new().dispatch(Matrices { assembly, constraints, input, cells, size, results });
        },
        |cell, matrix| assembly.maps.scatter(cell, matrix, values),
    );
}

/// The raw residual of the terms at the fields, without anything of the bodies' own.
#[must_use]
pub fn residual(
    assembly: &Assembly,
    mesh: &Mesh<2>,
    terms: &FlowTerms<'_, 2>,
    fields: &Fields<'_, 2>,
) -> Vec<f64> {
    let input = Input { mesh, metric: assembly.tables.metric(), terms, fields };
    let mut total = vec![0.0; assembly.layout.n_raw()];
    for_each_cell(
        mesh.n_cells(),
        N_FLUID,
        |cells, results| Arch::new().dispatch(Residuals { assembly, input, cells, results }),
        |cell, local| {
            for (&raw, value) in assembly.maps.raw_unknowns(cell).iter().zip(local) {
                total[raw as usize] += value;
            }
        },
    );
    total
}

/// The matrices of some cells, `size` numbers for each.
struct Matrices<'a> {
    assembly: &'a Assembly,
    constraints: &'a AffineConstraints,
    input: Input<'a, 2>,
    cells: Range<usize>,
    size: usize,
    results: &'a mut [f64],
}

impl WithSimd for Matrices<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { assembly, constraints, input, cells, size, results } = self;
        let n_local = assembly.n_local();
        let mut raw = vec![0.0; n_local * n_local];
        for (index, result) in cells.zip(results.chunks_exact_mut(size)) {
            let cell = CellId::new(index);
            let is_folded = assembly.maps.is_folded(index);
            let matrix = if is_folded { &mut raw[..] } else { &mut result[..n_local * n_local] };
            let with_frame = assembly.with_frame;
            if input.mesh.curved[cell] {
                cell_matrix::<S, 2, N, P, 16>(input, cell, &assembly.curved, with_frame, matrix);
            } else {
                match &assembly.straight {
                    StraightTable::Planar(table) => {
                        cell_matrix::<S, 2, N, P, 8>(input, cell, table, with_frame, matrix);
                    }
                    StraightTable::Axisymmetric(table) => {
                        cell_matrix::<S, 2, N, P, 12>(input, cell, table, with_frame, matrix);
                    }
                }
            }
            if let Some(facet) = &assembly.open[cell] {
                add_open_side(
                    input.mesh,
                    facet,
                    &assembly.facet_rule,
                    input.metric,
                    input.terms.viscosity,
                    Some((matrix, n_local)),
                    None,
                );
            }
            if is_folded {
                assembly.maps.fold(index, constraints, &raw, result);
            }
        }
    }
}

/// The residuals of some cells.
struct Residuals<'a> {
    assembly: &'a Assembly,
    input: Input<'a, 2>,
    cells: Range<usize>,
    results: &'a mut [f64],
}

impl WithSimd for Residuals<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { assembly, input, cells, results } = self;
        for (cell, local) in cells.map(CellId::new).zip(results.chunks_exact_mut(N_FLUID)) {
            if input.mesh.curved[cell] {
                cell_residual::<S, 2, N, P, 16>(input, cell, &assembly.curved, local);
            } else {
                match &assembly.straight {
                    StraightTable::Planar(table) => {
                        cell_residual::<S, 2, N, P, 8>(input, cell, table, local);
                    }
                    StraightTable::Axisymmetric(table) => {
                        cell_residual::<S, 2, N, P, 12>(input, cell, table, local);
                    }
                }
            }
            if let Some(facet) = &assembly.open[cell] {
                add_open_side(
                    input.mesh,
                    facet,
                    &assembly.facet_rule,
                    input.metric,
                    input.terms.viscosity,
                    None,
                    Some((local, input.fields.velocity)),
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use alewife_mesh::{Domain, Point, Sizing, generate};
    use nalgebra::SMatrix;

    use super::*;
    use crate::algebra::ConstraintBuilder;
    use crate::space::CellValues;

    const METRICS: [Metric; 2] = [Metric::Cartesian, Metric::Revolved];

    const CONVECTIONS: [Convection; 4] =
        [Convection::None, Convection::Oseen, Convection::Newton, Convection::NewtonInFrame];

    fn mesh_of_disc(curved: bool, metric: Metric) -> Mesh<2> {
        let domain = if metric.is_revolved() {
            Domain::HalfDisc { center: 0.0, radius: 1.0 }
        } else {
            Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 }
        };
        let sizing = Sizing { curved, ..Sizing::graded(0.4, 0.3, 0.4) };
        let mesh = generate(&domain, &[], &sizing).expect("a disc has a mesh");
        assert_eq!(mesh.curved.contains(&true), curved);
        assert!(mesh.curved.contains(&false));
        mesh
    }

    /// A smooth field with all derivatives.
    fn field(mesh: &Mesh<2>, shift: f64) -> Vec<Point<2>> {
        let value = |place: &Point<2>| {
            let [x, y] = [place[0] + shift, place[1] - 0.3 * shift];
            Point::<2>::new((2.0 * x + y).sin() + 0.3 * y, (x - 3.0 * y).cos() + x * y)
        };
        mesh.nodes.iter().map(value).collect()
    }

    /// A system without constraints, with one more body for its velocities.
    struct Setting {
        mesh: Mesh<2>,
        layout: DofLayout<2>,
        constraints: AffineConstraints,
        pattern: Pattern,
        assembly: Assembly,
        velocity: Vec<Point<2>>,
        pressure: Vec<f64>,
        history: Vec<Point<2>>,
        frame: Point<2>,
        rate: f64,
    }

    impl Setting {
        fn new(mesh: Mesh<2>, metric: Metric, with_frame: bool) -> Self {
            let layout = DofLayout::new(&mesh, 1);
            let constraints = ConstraintBuilder::new(layout.n_raw()).build();
            let frame = with_frame.then_some(0);
            // Every side is open, curved ones too.
            let (pattern, assembly) =
                Assembly::new(&mesh, layout, &constraints, metric, &[0, 1], frame);
            let nodes = &mesh.nodes[..mesh.n_vertices];
            Self {
                velocity: field(&mesh, 0.0),
                pressure: nodes.iter().map(|place| place[0] - place[1] * place[1]).collect(),
                history: field(&mesh, 0.4),
                frame: Point::<2>::new(0.3, -0.2),
                rate: 1.7,
                mesh,
                layout,
                constraints,
                pattern,
                assembly,
            }
        }

        /// What convects: given, or the velocity itself as seen from the frame.
        fn crossing(&self, convection: Convection) -> Vec<Point<2>> {
            match convection {
                Convection::None => Vec::new(),
                Convection::Oseen => field(&self.mesh, -0.6),
                Convection::Newton | Convection::NewtonInFrame => {
                    self.velocity.iter().map(|velocity| velocity - self.frame).collect()
                }
            }
        }

        fn with_terms<T>(
            &self,
            convection: Convection,
            work: impl FnOnce(&FlowTerms<'_, 2>, &Fields<'_, 2>) -> T,
        ) -> T {
            let crossing = self.crossing(convection);
            let terms = FlowTerms {
                viscosity: 0.7,
                density: 1.3,
                rate: self.rate,
                history: &self.history,
                crossing: &crossing,
                convection,
                body_force: None,
            };
            work(&terms, &Fields { velocity: &self.velocity, pressure: &self.pressure })
        }

        fn residual(&self, convection: Convection) -> Vec<f64> {
            self.with_terms(convection, |terms, fields| {
                residual(&self.assembly, &self.mesh, terms, fields)
            })
        }

        fn matrix(&self, convection: Convection) -> Vec<f64> {
            let mut values = vec![f64::NAN; self.pattern.rows.len()];
            self.with_terms(convection, |terms, fields| {
                let Self { assembly, mesh, constraints, .. } = self;
                assemble(assembly, mesh, constraints, terms, fields, &mut values);
            });
            values
        }

        /// Moves all unknowns by `step` along a direction, which is returned.
        fn moved(&mut self, step: f64, in_frame: bool) -> Vec<f64> {
            let mut direction = vec![0.0; self.layout.n_raw()];
            let velocity = field(&self.mesh, 0.9);
            for (node, change) in self.layout.nodes().zip(&velocity) {
                self.velocity[node] += change * step;
                for axis in 0..2 {
                    direction[self.layout.velocity(node, axis)] = change[axis];
                }
            }
            for (vertex, pressure) in self.layout.vertices().zip(&mut self.pressure) {
                let change = (5.0 * vertex.index() as f64).sin();
                *pressure += step * change;
                direction[self.layout.pressure(vertex)] = change;
            }
            if in_frame {
                let change = Point::<2>::new(0.8, 0.5);
                self.frame += change * step;
                for axis in 0..2 {
                    direction[self.layout.rigid(0, axis)] = change[axis];
                }
            }
            direction
        }
    }

    fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
        let size = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let pairs = one.iter().zip(other);
        pairs.fold(0.0f64, |most, (one, other)| most.max((one - other).abs())) / size
    }

    /// The residual is of second order in the unknowns, so central differences are exact.
    #[test]
    fn the_matrix_is_the_derivative_of_the_residual() {
        for (curved, metric) in
            [false, true].into_iter().flat_map(|curved| METRICS.map(|metric| (curved, metric)))
        {
            for convection in CONVECTIONS {
                let in_frame = convection == Convection::NewtonInFrame;
                let mesh = mesh_of_disc(curved, metric);
                let mut setting = Setting::new(mesh, metric, in_frame);
                let matrix = setting.matrix(convection);
                let direction = setting.moved(0.5, in_frame);
                let ahead = setting.residual(convection);
                setting.moved(-1.0, in_frame);
                let behind = setting.residual(convection);
                let difference: Vec<f64> =
                    ahead.iter().zip(&behind).map(|(ahead, behind)| ahead - behind).collect();
                let mut product = vec![0.0; direction.len()];
                setting.pattern.multiply_add(&matrix, &direction, &mut product);
                let error = largest_difference(&difference, &product);
                assert!(error < 1e-12, "{convection:?}, {curved}, {metric:?}: {error}");
            }
        }
    }

    #[test]
    fn on_straight_cells_both_maps_agree() {
        for metric in METRICS {
            let mut mesh = mesh_of_disc(false, metric);
            // Away from the axis, where 1 / r is nearly a polynomial on a cell.
            for node in &mut mesh.nodes {
                node[1] += 20.0;
            }
            let tolerance = if metric.is_revolved() { 1e-10 } else { 1e-13 };
            let mut bent = mesh.clone();
            bent.curved.fill(true);
            let straight = Setting::new(mesh, metric, false);
            let bent = Setting::new(bent, metric, false);
            for convection in &CONVECTIONS[..3] {
                let (one, other) = (straight.matrix(*convection), bent.matrix(*convection));
                assert!(largest_difference(&one, &other) < tolerance);
                let (one, other) = (straight.residual(*convection), bent.residual(*convection));
                assert!(largest_difference(&one, &other) < tolerance);
            }
        }
    }

    /// The same integrals point by point, without arrays of lanes: power of the residual.
    #[test]
    fn the_residual_tested_with_the_velocity_is_its_power() {
        for metric in METRICS {
            let mut setting = Setting::new(mesh_of_disc(true, metric), metric, false);
            setting.assembly.open.fill(None);
            let residual = setting.residual(Convection::Oseen);
            let mut power = 0.0;
            for (node, velocity) in setting.layout.nodes().zip(&setting.velocity) {
                for axis in 0..2 {
                    power += residual[setting.layout.velocity(node, axis)] * velocity[axis];
                }
            }
            let expected = setting.with_terms(Convection::Oseen, |terms, fields| {
                power_by_points(&setting, terms, fields, metric)
            });
            assert!((power - expected).abs() < 1e-12 * expected.abs(), "{power} {expected}");
        }
    }

    /// int rho (a0 u + h + (c . grad) u) . u + 2 mu D : D - p div u.
    fn power_by_points(
        setting: &Setting,
        terms: &FlowTerms<'_, 2>,
        fields: &Fields<'_, 2>,
        metric: Metric,
    ) -> f64 {
        let mut power = 0.0;
        let mut workspace = CellValues::default();
        for cell in setting.mesh.cell_ids() {
            let nodes = setting.mesh.cell(cell);
            workspace.for_each_point(setting.assembly.tables(), &setting.mesh, cell, |at| {
                let mut velocity = Point::<2>::zeros();
                let (mut history, mut crossing) = (velocity, velocity);
                let mut gradient = SMatrix::<f64, 2, 2>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    velocity += fields.velocity[node] * at.phi[a];
                    history += terms.history[node] * at.phi[a];
                    crossing += terms.crossing[node] * at.phi[a];
                    gradient += fields.velocity[node] * at.grad_phi[a].transpose();
                }
                let pressure: f64 = (0..3).map(|v| fields.pressure[nodes[v]] * at.psi[v]).sum();
                let stretch = metric.hoop_strain(&velocity, &at.position);
                let strain = (gradient + gradient.transpose()) / 2.0;
                let change = velocity * terms.rate + history + gradient * crossing;
                power += at.dx
                    * (terms.density * change.dot(&velocity)
                        + 2.0 * terms.viscosity * (strain.norm_squared() + stretch * stretch)
                        - pressure * (gradient.trace() + stretch));
            });
        }
        power
    }
}
