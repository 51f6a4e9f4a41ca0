//! The matrices that all shipped cases begin with are solved to rounding, with one refinement at most;
//! in space, where the solver iterates, as far as Newton's method asks, in three systems at most.

use alewife_core::case::{Case, CaseFile, Model, Steady, library};
use alewife_core::run::{CaseMesh, Dimension, build_mesh, build_problem};
use rayon::prelude::*;
use tests::{steady_with, workspace};

/// Relative residual that every system has to reach.
const RESIDUAL: f64 = 1e-12;

/// Half as many unknowns, and fewer.
const COARSE: &[&str] = &["mesh.scale=1.5"];

/// Residual and refinements of the Stokes flow that every run of a case begins with.
///
/// # Panics
/// When Newton's method does not find it.
fn accuracy<const D: usize>(model: &Model) -> (f64, usize)
where
    Dimension<D>: CaseMesh<D>,
{
    let mesh = build_mesh::<D>(model).expect("the mesh can be made");
    let mut problem = build_problem(model, &mesh).expect("the problem can be built");
    problem.has_convection = false;
    let mut work = workspace(&problem, &mesh);
    let settings = Steady { tolerance: 1e-9, max_iterations: 3 };
    let _flow = steady_with(&mut work, &problem, &settings, false);
    (work.system.accuracy().residual, work.system.accuracy().refinements)
}

/// Which shipped cases are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Which {
    /// Those in the plane, by themselves, on coarser meshes.
    Coarse,
    /// The same on their own meshes.
    Planar,
    /// The first and the last of their variants.
    PlanarVariants,
    /// In space, where a system may have several hundred thousand unknowns, those that take seconds.
    Spatial,
}

impl Which {
    /// Those of a case by the names the command line takes.
    fn of(self, file: &CaseFile) -> Vec<String> {
        let (name, case) = (&file.name, file.case());
        if self == Self::Spatial {
            let quick = case.variant.iter().filter(|variant| variant.quick);
            return quick.map(|variant| format!("{name}/{}", variant.name)).collect();
        }
        // The two that are farthest from each other in a list stand for those between
        let mut variants: Vec<&String> =
            file.variants.first().into_iter().chain(file.variants.last()).collect();
        variants.dedup();
        let variants = variants.into_iter().map(|variant| format!("{name}/{variant}"));
        match self {
            Self::Coarse | Self::Planar => vec![name.clone()],
            _ => variants.collect(),
        }
    }
}

/// Shipped cases, of which there are more than some number.
fn assert_solved(which: Which, more_than: usize) {
    let in_space = which == Which::Spatial;
    let members = library::list().par_iter().flat_map_iter(|shipped| {
        let file = Case::read(shipped.name, &[]).expect("shipped cases are valid");
        // Some are moved by their reduced models alone
        let has_flow = file.case().left_out.is_empty();
        let is_in_space = file.case().geometry.dimensions() == 3;
        if has_flow && is_in_space == in_space { which.of(&file) } else { Vec::new() }
    });
    let members: Vec<String> = members.collect();
    assert!(members.len() > more_than, "cases and variants: {}", members.len());
    let wrong: Vec<String> = members
        .par_iter()
        .filter_map(|name| {
            let settings = if which == Which::Coarse { COARSE } else { &[] };
            let settings: Vec<String> = settings.iter().map(|&key| key.to_owned()).collect();
            let model = Case::read(name, &settings).expect("shipped cases are valid").model;
            // The rates of rods follow from a step, they are free in a steady flow
            if model.bodies.iter().any(|body| body.rod.is_some()) {
                return None;
            }
            let (residual, refinements) =
                if in_space { accuracy::<3>(&model) } else { accuracy::<2>(&model) };
            let is_right = in_space || (residual <= RESIDUAL && refinements <= 1);
            (!is_right).then(|| format!("{name}: {residual:.1e} after {refinements} refinements"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn shipped_cases_on_coarser_meshes_are_solved_to_rounding() {
    assert_solved(Which::Coarse, 25);
}

#[test]
#[ignore = "long: 15 s; small: shipped_cases_on_coarser_meshes_are_solved_to_rounding"]
fn shipped_cases_in_the_plane_are_solved_to_rounding() {
    assert_solved(Which::Planar, 25);
}

/// Other numbers of the same cases, on meshes that are much the same.
#[test]
#[ignore = "long: 10 s; small: shipped_cases_on_coarser_meshes_are_solved_to_rounding"]
fn variants_of_cases_in_the_plane_are_solved_to_rounding() {
    assert_solved(Which::PlanarVariants, 25);
}

/// The quick validation runs them to their ends every day.
#[test]
#[ignore = "long: 40 s; small: shipped_cases_on_coarser_meshes_are_solved_to_rounding"]
fn shipped_cases_in_space_are_solved() {
    assert_solved(Which::Spatial, 5);
}
