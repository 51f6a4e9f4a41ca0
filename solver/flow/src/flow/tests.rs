//! Tests of element terms and assembly, in the plane, about an axis and in space.

mod setting;
mod shear;

use std::sync::Arc;

use alewife_mesh::{Mesh, Point};
use nalgebra::SMatrix;

use self::setting::{BEND, METRICS, Setting, discs, mesh_of_disc, tetrahedra};
use super::kernel::{CellInput, CellKernel};
use super::taylor_hood::PlainKernel;
use super::taylor_hood::quadratic_kernel;
use super::*;
use crate::algebra::SparseMatrix;
use crate::space::sample_mesh::{bent, two_simplices};
use crate::space::{CellValues, FacetRule, Metric, Tables};

const CONVECTIONS: [Convection; 4] =
    [Convection::None, Convection::Oseen, Convection::Newton, Convection::NewtonInFrame];

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let size = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let pairs = one.iter().zip(other);
    pairs.fold(0.0f64, |most, (one, other)| most.max((one - other).abs())) / size
}

/// Central differences over a step, with sides that take a part of the momentum of fluid that enters.
#[derive(Clone, Copy)]
struct Differences {
    backflow: f64,
    step: f64,
    tolerance: f64,
}

/// The residual is of second order in the unknowns, so that central differences are exact.
const OF_POLYNOMIALS: Differences = Differences { backflow: 0.0, step: 1.0, tolerance: 1e-12 };

/// Fluid turns round at few points within a short step, on which rounding tells.
const OF_BACKFLOW: Differences = Differences { backflow: 0.5, step: 1e-6, tolerance: 1e-8 };

fn check_derivative<const D: usize>(mesh: &Mesh<D>, metric: Metric, by: Differences) {
    for convection in CONVECTIONS {
        let in_frame = convection == Convection::NewtonInFrame;
        let mut setting = Setting::with_backflow(mesh.clone(), metric, in_frame, by.backflow);
        let matrix = setting.matrix(convection);
        let direction = setting.moved(0.5 * by.step, in_frame);
        let ahead = setting.residual(convection);
        setting.moved(-by.step, in_frame);
        let behind = setting.residual(convection);
        let difference: Vec<f64> =
            ahead.iter().zip(&behind).map(|(ahead, behind)| (ahead - behind) / by.step).collect();
        let mut product = vec![0.0; direction.len()];
        let matrix = SparseMatrix::new(Arc::clone(setting.maps.pattern()), matrix);
        matrix.multiply(&direction, &mut product);
        let error = largest_difference(&difference, &product);
        assert!(error < by.tolerance, "{D}, {convection:?}, {metric:?}: {error}");
    }
}

#[test]
fn the_matrix_is_the_derivative_of_the_residual() {
    for by in [OF_POLYNOMIALS, OF_BACKFLOW] {
        discs().for_each(|(mesh, metric)| check_derivative(&mesh, metric, by));
        tetrahedra().iter().for_each(|mesh| check_derivative(mesh, Metric::Cartesian, by));
    }
}

fn check_maps<const D: usize>(mesh: Mesh<D>, metric: Metric, tolerance: f64) {
    let mut bent = mesh.clone();
    bent.topology_mut().curved.fill(true);
    let straight = Setting::new(mesh, metric, false);
    let bent = Setting::new(bent, metric, false);
    for convection in &CONVECTIONS[..3] {
        let (one, other) = (straight.matrix(*convection), bent.matrix(*convection));
        assert!(largest_difference(&one, &other) < tolerance);
        let (one, other) = (straight.residual(*convection), bent.residual(*convection));
        assert!(largest_difference(&one, &other) < tolerance);
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
        check_maps(mesh, metric, if metric.is_revolved() { 1e-10 } else { 1e-13 });
    }
    check_maps(two_simplices::<3>(), Metric::Cartesian, 1e-13);
}

/// Matrices and residuals of all cells by a kernel.
fn results<const D: usize>(kernel: &dyn CellKernel<D>, input: CellInput<'_, D>) -> [Vec<f64>; 2] {
    let (n_cells, local) = (input.mesh.n_cells(), kernel.layout());
    let stride = local.n_local() * local.n_local();
    let mut matrices = vec![f64::NAN; stride * n_cells];
    let mut residuals = vec![f64::NAN; local.n_fluid() * n_cells];
    kernel.matrices(input, 0..n_cells, stride, &mut matrices);
    kernel.residuals(input, 0..n_cells, &mut residuals);
    [matrices, residuals]
}

fn check_kernel<const D: usize>(mesh: &Mesh<D>, metric: Metric) {
    let tables = Tables::new(metric);
    for convection in CONVECTIONS {
        let in_frame = convection == Convection::NewtonInFrame;
        let setting = Setting::new(mesh.clone(), metric, in_frame);
        let kernel = quadratic_kernel(&tables, in_frame);
        let plain = PlainKernel { tables: tables.clone(), local: kernel.layout() };
        setting.with_terms(convection, |terms, fields| {
            let input = CellInput { mesh, terms, fields };
            let (fast, plain) = (results(&*kernel, input), results(&plain, input));
            for (fast, plain) in fast.iter().zip(&plain) {
                let error = largest_difference(plain, fast);
                assert!(error < 1e-13, "{D}, {convection:?}, {metric:?}: {error}");
            }
        });
    }
}

#[test]
fn a_kernel_gives_the_sums_of_plain_loops() {
    discs().for_each(|(mesh, metric)| check_kernel(&mesh, metric));
    tetrahedra().iter().for_each(|mesh| check_kernel(mesh, Metric::Cartesian));
}

/// Without inertia the matrix of a closed domain is symmetric.
fn check_symmetry<const D: usize>(mesh: Mesh<D>, metric: Metric) {
    let mut setting = Setting::closed(mesh, metric);
    setting.density = 0.0;
    let matrix = setting.matrix(Convection::None);
    let pattern = setting.maps.pattern();
    let most = matrix.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    for row in 0..setting.layout.n_fluid() {
        for (position, &column) in pattern.entries(row).zip(pattern.row(row)) {
            let column = column as usize;
            let mirrored = pattern.entry(column, row).expect("the pattern is symmetric");
            assert!((matrix[position] - matrix[mirrored]).abs() < 1e-14 * most);
        }
    }
}

#[test]
fn viscous_stress_pressure_and_divergence_are_symmetric() {
    discs().for_each(|(mesh, metric)| check_symmetry(mesh, metric));
    tetrahedra().into_iter().for_each(|mesh| check_symmetry(mesh, Metric::Cartesian));
}

/// The velocities with which a mesh can move as one piece.
fn rigid_motions<const D: usize>(metric: Metric) -> Vec<SMatrix<f64, D, D>> {
    let pairs = (0..D).flat_map(|i| (0..i).map(move |j| (i, j)));
    let turns = pairs.filter(|_| metric.has_rotation()).map(|(i, j)| {
        let mut spin = SMatrix::zeros();
        (spin[(i, j)], spin[(j, i)]) = (1.0, -1.0);
        spin
    });
    turns.chain([SMatrix::zeros()]).collect()
}

/// On curved cells, too, where positions have the basis of the velocity.
fn check_rigid_motions<const D: usize>(mesh: Mesh<D>, metric: Metric) {
    let mut setting = Setting::closed(mesh, metric);
    (setting.rate, setting.density) = (0.0, 0.0);
    setting.pressure.fill(0.0);
    let size =
        setting.residual(Convection::None).iter().fold(0.0f64, |most, at| most.max(at.abs()));
    for spin in rigid_motions::<D>(metric) {
        let shift =
            Point::<D>::from_fn(
                |axis, _| {
                    if metric.has_translation(axis) { 0.7 - axis as f64 } else { 0.0 }
                },
            );
        setting.velocity = setting.mesh.nodes.iter().map(|x| spin * x + shift).collect();
        for value in setting.residual(Convection::None) {
            assert!(value.abs() < 1e-13 * size, "{D}, {metric:?}: {value} of {size}");
        }
    }
}

#[test]
fn rigid_motions_have_no_strain() {
    assert_eq!(rigid_motions::<2>(Metric::Cartesian).len(), 2);
    assert_eq!(rigid_motions::<3>(Metric::Cartesian).len(), 4);
    discs().for_each(|(mesh, metric)| check_rigid_motions(mesh, metric));
    tetrahedra().into_iter().for_each(|mesh| check_rigid_motions(mesh, Metric::Cartesian));
}

/// The pressure's functions add to one: the sum of the rows of continuity is minus the flux outwards.
fn check_flux<const D: usize>(mesh: Mesh<D>, metric: Metric) {
    let setting = Setting::new(mesh, metric, false);
    let residual = setting.residual(Convection::None);
    let sum: f64 = residual[setting.layout.pressures()].iter().sum();
    let (mut flux, mut size) = (0.0, 0.0);
    for facet in &setting.mesh.facets {
        FacetRule::new(metric).for_each_point(&setting.mesh, facet, |at| {
            let nodes = setting.mesh.cell(facet.cell).iter().zip(at.phi);
            let velocity = nodes
                .fold(Point::<D>::zeros(), |sum, (&node, phi)| sum + setting.velocity[node] * *phi);
            flux += velocity.dot(&at.normal_ds);
            size += velocity.norm() * at.normal_ds.norm();
        });
    }
    assert!((sum + flux).abs() < 1e-13 * size, "{D}, {metric:?}: {sum} {flux}");
}

#[test]
fn the_divergence_of_the_flow_is_the_flux_through_the_boundary() {
    discs().for_each(|(mesh, metric)| check_flux(mesh, metric));
    tetrahedra().into_iter().for_each(|mesh| check_flux(mesh, Metric::Cartesian));
}

/// The same integrals point by point, without arrays of lanes: power of the residual.
fn check_power<const D: usize>(mesh: Mesh<D>, metric: Metric) {
    let setting = Setting::closed(mesh, metric);
    let power = setting.power(&setting.residual(Convection::Oseen), &setting.velocity);
    let expected = setting
        .with_terms(Convection::Oseen, |terms, fields| power_by_points(&setting, terms, fields));
    assert!((power - expected).abs() < 1e-12 * expected.abs(), "{power} {expected}");
}

#[test]
fn the_residual_tested_with_the_velocity_is_its_power() {
    for metric in METRICS {
        check_power(mesh_of_disc(true, metric), metric);
    }
    check_power(bent(two_simplices::<3>(), BEND), Metric::Cartesian);
}

/// int rho (a0 u + h + (c . grad) u) . u + 2 mu D : D - p div u.
fn power_by_points<const D: usize>(
    setting: &Setting<D>,
    terms: &FlowTerms<'_, D>,
    fields: &Fields<'_, D>,
) -> f64 {
    let viscosity = terms.viscosity.constant().expect("the fluid is Newtonian");
    let mut power = 0.0;
    let mut workspace = CellValues::default();
    for cell in setting.mesh.cell_ids() {
        let nodes = setting.mesh.cell(cell);
        workspace.for_each_point(setting.assembly.tables(), &setting.mesh, cell, |at| {
            let mut velocity = Point::<D>::zeros();
            let (mut history, mut convecting) = (velocity, velocity);
            let mut gradient = SMatrix::<f64, D, D>::zeros();
            for (a, &node) in nodes.iter().enumerate() {
                velocity += fields.velocity[node] * at.phi[a];
                history += terms.history[node] * at.phi[a];
                convecting += terms.convecting_velocity[node] * at.phi[a];
                gradient += fields.velocity[node] * at.grad_phi[a].transpose();
            }
            let pressure: f64 = (0..=D).map(|v| fields.pressure[nodes[v]] * at.psi[v]).sum();
            let stretch = setting.metric.hoop_strain(&velocity, &at.position);
            let strain = (gradient + gradient.transpose()) / 2.0;
            let change = velocity * terms.rate + history + gradient * convecting;
            power += at.dx
                * (terms.density * change.dot(&velocity)
                    + 2.0 * viscosity * (strain.norm_squared() + stretch * stretch)
                    - pressure * (gradient.trace() + stretch));
        });
    }
    power
}
