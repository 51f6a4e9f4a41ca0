//! The matrices that all shipped cases begin with are solved to rounding, with one refinement at most;
//! in space, where the solver iterates, as far as Newton's method asks, in three systems at most.

use alewife_core::case::{Case, Model, Steady, library};
use alewife_core::run::{CaseMesh, Dimension, build_mesh, build_problem};
use rayon::prelude::*;
use tests::{steady_with, workspace};

/// Relative residual that every system has to reach.
const RESIDUAL: f64 = 1e-12;

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

/// A shipped case with the first and the last of its variants, by the names the command line takes; in
/// space, where a system may have several hundred thousand unknowns, those that take seconds.
fn members(name: &str) -> Vec<String> {
    let file = Case::read(name, &[]).expect("shipped cases are valid");
    if file.case().geometry.dimensions() == 3 {
        let quick = file.case().variant.iter().filter(|variant| variant.quick);
        return quick.map(|variant| format!("{name}/{}", variant.name)).collect();
    }
    // The two that are farthest from each other in a list stand for those between
    let mut variants: Vec<&String> =
        file.variants.first().into_iter().chain(file.variants.last()).collect();
    variants.dedup();
    let variants = variants.into_iter().map(|variant| format!("{name}/{variant}"));
    std::iter::once(name.to_owned()).chain(variants).collect()
}

/// Shipped cases with their variants as above, in space or not, of which there are more than some number.
fn assert_solved(in_space: bool, more_than: usize) {
    let names = library::list().iter().filter(|shipped| {
        let file = Case::read(shipped.name, &[]).expect("shipped cases are valid");
        // Some are moved by their reduced models alone
        let has_flow = file.case().left_out.is_empty();
        has_flow && (file.case().geometry.dimensions() == 3) == in_space
    });
    let members: Vec<String> = names.flat_map(|shipped| members(shipped.name)).collect();
    assert!(members.len() > more_than, "cases and variants: {}", members.len());
    let wrong: Vec<String> = members
        .par_iter()
        .filter_map(|name| {
            let model = Case::read(name, &[]).expect("shipped cases are valid").model;
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
fn shipped_cases_in_the_plane_are_solved_to_rounding() {
    assert_solved(false, 25);
}

/// The quick validation runs them to their ends every day.
#[test]
#[ignore = "long: 40 s; small: shipped_cases_in_the_plane_are_solved_to_rounding"]
fn shipped_cases_in_space_are_solved() {
    assert_solved(true, 5);
}
