//! Tests of viscosities that depend on the rate of shear: tangents, linearised stresses, kernels.

use alewife_mesh::Mesh;

use super::setting::{BEND, Setting, discs, field, tetrahedra};
use super::{largest_difference, results};
use crate::flow::kernel::CellInput;
use crate::flow::taylor_hood::{PlainKernel, quadratic_kernel};
use crate::flow::*;
use crate::space::sample_mesh::{bent, two_simplices};
use crate::space::{Metric, Tables};

const PLATEAUS: Plateaus = Plateaus { zero: 0.9, infinite: 0.1, time: 0.8, index: 0.3 };
const YIELD: YieldLaw =
    YieldLaw { yield_stress: 0.4, consistency: 0.6, index: 0.5, least_rate: 0.3 };
const LAWS: [Viscosity; 3] =
    [Viscosity::Carreau(PLATEAUS), Viscosity::Cross(PLATEAUS), Viscosity::HerschelBulkley(YIELD)];

/// matrix * direction, by rows.
fn product<const D: usize>(setting: &Setting<D>, matrix: &[f64], direction: &[f64]) -> Vec<f64> {
    let pattern = setting.maps.pattern();
    let row = |row: usize| {
        let entries = pattern.entries(row).zip(pattern.row(row));
        entries.map(|(entry, &column)| matrix[entry] * direction[column as usize]).sum()
    };
    (0..setting.layout.n_fluid()).map(row).collect()
}

/// What the residual gains when the unknowns move from -step to step, over twice the step.
fn slope<const D: usize>(setting: &mut Setting<D>, convection: Convection, step: f64) -> Vec<f64> {
    setting.moved(step, false);
    let ahead = setting.residual(convection);
    setting.moved(-2.0 * step, false);
    let behind = setting.residual(convection);
    setting.moved(step, false);
    let n = setting.layout.n_fluid();
    ahead[..n].iter().zip(&behind).map(|(ahead, behind)| (ahead - behind) / (2.0 * step)).collect()
}

fn meshes(check: impl Fn(Mesh<2>, Metric), check_space: impl Fn(Mesh<3>)) {
    discs().for_each(|(mesh, metric)| check(mesh, metric));
    tetrahedra().into_iter().for_each(check_space);
}

fn check_tangent<const D: usize>(mesh: &Mesh<D>, metric: Metric) {
    for law in LAWS {
        for convection in [Convection::None, Convection::Newton] {
            let mut setting = Setting::new(mesh.clone(), metric, false);
            setting.viscosity = law;
            let matrix = setting.matrix(convection);
            let direction = setting.moved(0.0, false);
            let expected = product(&setting, &matrix, &direction);
            let error = largest_difference(&slope(&mut setting, convection, 1e-5), &expected);
            assert!(error < 1e-7, "{D} {metric:?} {law:?} {convection:?}: {error}");
            setting.has_tangent = false;
            let other = product(&setting, &setting.matrix(convection), &direction);
            let error = largest_difference(&other, &expected);
            assert!(error > 1e-3, "{D} {metric:?} {law:?}: without its tangent {error}");
        }
    }
}

/// All sides are open, so that their term is there, too.
#[test]
fn with_the_viscosity_of_the_iterate_the_matrix_is_the_derivative_of_the_residual() {
    meshes(
        |mesh, metric| check_tangent(&mesh, metric),
        |mesh| check_tangent(&mesh, Metric::Cartesian),
    );
}

fn check_linear<const D: usize>(mesh: &Mesh<D>, metric: Metric) {
    for law in LAWS {
        for has_tangent in [false, true] {
            let mut setting = Setting::new(mesh.clone(), metric, false);
            (setting.viscosity, setting.has_tangent) = (law, has_tangent);
            setting.sheared = Some(field(mesh, 0.25));
            let matrix = setting.matrix(Convection::Oseen);
            let direction = setting.moved(0.0, false);
            let expected = product(&setting, &matrix, &direction);
            let error = largest_difference(&slope(&mut setting, Convection::Oseen, 1.0), &expected);
            assert!(error < 1e-12, "{D} {metric:?} {law:?} {has_tangent}: {error}");
        }
    }
}

#[test]
fn with_the_viscosity_of_a_given_velocity_the_residual_is_linear() {
    meshes(
        |mesh, metric| check_linear(&mesh, metric),
        |mesh| check_linear(&mesh, Metric::Cartesian),
    );
}

fn check_kernels<const D: usize>(mesh: &Mesh<D>, metric: Metric) {
    let tables = Tables::new(metric);
    for law in LAWS {
        for (is_given, has_tangent) in [(false, true), (true, true), (true, false)] {
            let mut setting = Setting::new(mesh.clone(), metric, false);
            (setting.viscosity, setting.has_tangent) = (law, has_tangent);
            setting.sheared = is_given.then(|| field(mesh, 0.25));
            let kernel = quadratic_kernel(&tables, false);
            let plain = PlainKernel { tables: tables.clone(), local: kernel.layout() };
            setting.with_terms(Convection::Newton, |terms, fields| {
                let input = CellInput { mesh, terms, fields };
                let (fast, plain) = (results(&*kernel, input), results(&plain, input));
                for (fast, plain) in fast.iter().zip(&plain) {
                    let error = largest_difference(plain, fast);
                    assert!(error < 1e-13, "{D} {metric:?} {law:?} {is_given}: {error}");
                }
            });
        }
    }
}

#[test]
fn a_kernel_gives_the_sums_of_plain_loops_with_a_local_viscosity() {
    meshes(
        |mesh, metric| check_kernels(&mesh, metric),
        |mesh| check_kernels(&mesh, Metric::Cartesian),
    );
}

/// A law whose index is 1 is a Newtonian fluid.
#[test]
fn a_law_without_thinning_has_the_residual_of_a_newtonian_fluid() {
    let mesh = bent(two_simplices::<3>(), BEND);
    let mut setting = Setting::new(mesh, Metric::Cartesian, false);
    let newtonian = setting.residual(Convection::Oseen);
    setting.viscosity = Viscosity::Carreau(Plateaus { zero: 0.7, index: 1.0, ..PLATEAUS });
    let error = largest_difference(&setting.residual(Convection::Oseen), &newtonian);
    assert!(error < 1e-15, "{error}");
}
