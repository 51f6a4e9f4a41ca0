//! The Taylor-Hood element as a kernel: fixed sizes, one set of instructions chosen at run time.

mod lanes;
mod matrix;
#[cfg(test)]
mod plain;
mod points;
mod residual;
mod shear;

use std::any::Any;
use std::ops::Range;
use std::slice;
use std::sync::Arc;

use alewife_mesh::{CellId, Simplex};
use pulp::{Arch, Simd, WithSimd};

use self::matrix::cell_matrix;
#[cfg(test)]
pub(super) use self::plain::PlainKernel;
use self::points::PointTable;
use self::residual::cell_residual;
use super::kernel::{CellInput, CellKernel, LocalLayout};
use crate::space::{Metric, Tables};

/// Nodes of a triangle and of a tetrahedron.
const TRIANGLE: usize = Simplex::<2>::N_NODES;
const TETRAHEDRON: usize = Simplex::<3>::N_NODES;

/// Lanes for the nodes of a triangle and of a tetrahedron: whole registers of four.
const TRIANGLE_LANES: usize = TRIANGLE.next_multiple_of(4);
const TETRAHEDRON_LANES: usize = TETRAHEDRON.next_multiple_of(4);

/// The kernel of the P2-P1 element on meshes of dimension D, 2 or 3.
pub(super) fn quadratic_kernel<const D: usize>(
    tables: &Tables<D>,
    with_frame: bool,
) -> Arc<dyn CellKernel<D>> {
    // Stable Rust has no specialisation: the kernel of each dimension is a type of its own, found by
    // asking at run time, once a mesh, whether D is its dimension.
    let tables: &dyn Any = tables;
    let kernel: Box<dyn Any> = if let Some(tables) = tables.downcast_ref::<Tables<2>>() {
        Box::new(planar_kernel(tables, with_frame))
    } else if let Some(tables) = tables.downcast_ref::<Tables<3>>() {
        Box::new(spatial_kernel(tables, with_frame))
    } else {
        unreachable!("a mesh is planar or spatial")
    };
    *kernel.downcast::<Arc<dyn CellKernel<D>>>().expect("the kernel was chosen by D")
}

/// The kernel of plane and axisymmetric flow.
fn planar_kernel(tables: &Tables<2>, with_frame: bool) -> Arc<dyn CellKernel<2>> {
    match tables.metric() {
        Metric::Cartesian => {
            Arc::new(TaylorHood::<2, TRIANGLE, TRIANGLE_LANES, 8, 16>::new(tables, with_frame))
        }
        // The factor r asks for a rule of higher degree.
        Metric::Revolved => {
            Arc::new(TaylorHood::<2, TRIANGLE, TRIANGLE_LANES, 12, 16>::new(tables, with_frame))
        }
    }
}

/// The kernel of flow in space.
fn spatial_kernel(tables: &Tables<3>, with_frame: bool) -> Arc<dyn CellKernel<3>> {
    Arc::new(TaylorHood::<3, TETRAHEDRON, TETRAHEDRON_LANES, 16, 16>::new(tables, with_frame))
}

/// Tables of an element with N nodes a cell, in P lanes, for the QS points of straight cells, all at
/// a time, and for QC at a time of curved ones.
#[derive(Debug)]
struct TaylorHood<const D: usize, const N: usize, const P: usize, const QS: usize, const QC: usize>
{
    metric: Metric,
    local: LocalLayout<D>,
    straight: PointTable<D, N, P, QS>,
    curved: Vec<PointTable<D, N, P, QC>>,
}

impl<const D: usize, const N: usize, const P: usize, const QS: usize, const QC: usize>
    TaylorHood<D, N, P, QS, QC>
{
    fn new(tables: &Tables<D>, with_frame: bool) -> Self {
        const { assert!(N <= P, "there is a lane for each node") };
        let metric = tables.metric();
        let n_frame = (0..D).take_while(|&axis| with_frame && metric.has_translation(axis)).count();
        Self {
            metric,
            local: LocalLayout {
                n_velocity_nodes: N,
                n_pressure_nodes: PointTable::<D, N, P, QS>::N_PRESSURES,
                n_frame,
            },
            straight: PointTable::of_all(tables.element(), tables.rule(false)),
            curved: PointTable::batches(tables.element(), tables.rule(true)),
        }
    }

    /// The numbering, with sizes that the compiler knows.
    #[inline(always)]
    fn fixed_layout(&self) -> LocalLayout<D> {
        LocalLayout {
            n_velocity_nodes: N,
            n_pressure_nodes: PointTable::<D, N, P, QS>::N_PRESSURES,
            n_frame: self.local.n_frame,
        }
    }
}

impl<const D: usize, const N: usize, const P: usize, const QS: usize, const QC: usize> CellKernel<D>
    for TaylorHood<D, N, P, QS, QC>
{
    fn layout(&self) -> LocalLayout<D> {
        self.local
    }

    fn matrices(
        &self,
        input: CellInput<'_, D>,
        cells: Range<usize>,
        stride: usize,
        matrices: &mut [f64],
    ) {
        Arch::new().dispatch(Matrices { kernel: self, input, cells, stride, matrices });
    }

    fn residuals(&self, input: CellInput<'_, D>, cells: Range<usize>, residuals: &mut [f64]) {
        Arch::new().dispatch(Residuals { kernel: self, input, cells, residuals });
    }
}

/// The matrices of some cells.
struct Matrices<
    'a,
    const D: usize,
    const N: usize,
    const P: usize,
    const QS: usize,
    const QC: usize,
> {
    kernel: &'a TaylorHood<D, N, P, QS, QC>,
    input: CellInput<'a, D>,
    cells: Range<usize>,
    stride: usize,
    matrices: &'a mut [f64],
}

impl<const D: usize, const N: usize, const P: usize, const QS: usize, const QC: usize> WithSimd
    for Matrices<'_, D, N, P, QS, QC>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { kernel, input, cells, stride, matrices } = self;
        let TaylorHood { metric, straight, curved, .. } = kernel;
        let straight = slice::from_ref(straight);
        let local = kernel.fixed_layout();
        let n_entries = local.n_local() * local.n_local();
        for (cell, matrix) in cells.map(CellId::new).zip(matrices.chunks_exact_mut(stride)) {
            let matrix = &mut matrix[..n_entries];
            if input.mesh.curved[cell] {
                cell_matrix::<S, D, N, P, QC>(input, *metric, cell, curved, local, matrix);
            } else {
                cell_matrix::<S, D, N, P, QS>(input, *metric, cell, straight, local, matrix);
            }
        }
    }
}

/// The residuals of some cells.
struct Residuals<
    'a,
    const D: usize,
    const N: usize,
    const P: usize,
    const QS: usize,
    const QC: usize,
> {
    kernel: &'a TaylorHood<D, N, P, QS, QC>,
    input: CellInput<'a, D>,
    cells: Range<usize>,
    residuals: &'a mut [f64],
}

impl<const D: usize, const N: usize, const P: usize, const QS: usize, const QC: usize> WithSimd
    for Residuals<'_, D, N, P, QS, QC>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { kernel, input, cells, residuals } = self;
        let TaylorHood { metric, straight, curved, .. } = kernel;
        let straight = slice::from_ref(straight);
        let local = kernel.fixed_layout();
        let size = local.n_fluid();
        for (cell, residual) in cells.map(CellId::new).zip(residuals.chunks_exact_mut(size)) {
            if input.mesh.curved[cell] {
                cell_residual::<S, D, N, P, QC>(input, *metric, cell, curved, local, residual);
            } else {
                cell_residual::<S, D, N, P, QS>(input, *metric, cell, straight, local, residual);
            }
        }
    }
}
