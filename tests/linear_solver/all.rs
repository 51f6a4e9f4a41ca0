//! The matrices of every member of the planar and axisymmetric cases that goes in steps.

use alewife_core::case::{Case, Geometry, TimeSettings, library};

use super::middle::{Run, judge};

/// Matrices do not differ in kind on meshes of twice the size.
const SETTINGS: [&str; 1] = ["mesh.scale=2"];

/// Steps after which matrices are taken: past the start, and before coarse meshes are replaced.
const STEPS: usize = 3;

/// Error of a correction by iterations, over the solution that is corrected: pressures of a film, or of a region a
/// thousand radii wide, are determined less well by equations that are met to 10^-12 of their terms.
const ITERATED_DIFFERENCE: f64 = 1e-6;

/// Those members, by the names the command line takes.
fn members() -> Vec<String> {
    let mut wanted = Vec::new();
    for shipped in library::list() {
        let file = Case::read(shipped.name, &[]).expect("shipped cases are valid");
        let variants = file.variants.iter().map(|variant| format!("{}/{variant}", shipped.name));
        for member in std::iter::once(shipped.name.to_owned()).chain(variants) {
            let file = Case::read(&member, &[]).expect("shipped cases are valid");
            let is_in_steps = matches!(file.case().time, TimeSettings::Unsteady(_));
            if file.case().geometry != Geometry::Spatial && is_in_steps {
                wanted.push(member);
            }
        }
    }
    wanted
}

#[test]
#[ignore = "long: minutes; small: matrices_in_the_middle_of_runs_are_solved_to_rounding_both_ways"]
fn matrices_in_the_middle_of_all_runs_are_solved_to_rounding() {
    let members = members();
    let run = |member| Run { member, settings: &SETTINGS, steps: STEPS, shows: |_| true };
    let runs: Vec<Run<'_>> = members.iter().map(|member| run(member.as_str())).collect();
    let (wrong, iterated) = judge(&runs, ITERATED_DIFFERENCE);
    println!("{} runs, {iterated} solved for by earlier factors, too", runs.len());
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), runs.len(), wrong.join("\n"));
    assert!(runs.len() > 100);
}
