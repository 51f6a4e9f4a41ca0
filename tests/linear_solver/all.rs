//! Every member of every planar and axisymmetric case: the matrices of its steps, or of the last iteration of
//! its steady flow.

use alewife_core::case::{Case, FlowModel, Geometry, TimeSettings, library};
use alewife_core::simulation::{build_mesh, build_problem};
use rayon::prelude::*;
use tests::{steady_with, workspace};

use super::middle::{RESIDUAL, Run, judge};

/// Matrices do not differ in kind on meshes of twice the size.
const SETTINGS: [&str; 1] = ["mesh.scale=2"];

/// Steps after which matrices are taken: past the start, and before coarse meshes are replaced.
const STEPS: usize = 3;

/// All members of cases, by the names the command line takes, that are wanted.
fn members(is_wanted: impl Fn(&Case) -> bool) -> Vec<String> {
    let mut wanted = Vec::new();
    for shipped in library::list() {
        let file = Case::read(shipped.name, &[]).expect("shipped cases are valid");
        let variants = file.variants.iter().map(|variant| format!("{}/{variant}", shipped.name));
        for member in std::iter::once(shipped.name.to_owned()).chain(variants) {
            let file = Case::read(&member, &[]).expect("shipped cases are valid");
            if file.case().geometry != Geometry::Spatial && is_wanted(file.case()) {
                wanted.push(member);
            }
        }
    }
    wanted
}

#[test]
#[ignore = "takes some minutes; run after changes of the linear solver"]
fn matrices_in_the_middle_of_all_runs_are_solved_to_rounding() {
    let members = members(|case| matches!(case.time, TimeSettings::Unsteady(_)));
    let run = |member| Run { member, settings: &SETTINGS, steps: STEPS, shows: |_| true };
    let runs: Vec<Run<'_>> = members.iter().map(|member| run(member.as_str())).collect();
    let (wrong, iterated) = judge(&runs);
    println!("{} runs, {iterated} solved for by earlier factors, too", runs.len());
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), runs.len(), wrong.join("\n"));
    assert!(runs.len() > 100);
}

#[test]
#[ignore = "takes a minute; run after changes of the linear solver"]
fn matrices_of_all_steady_flows_with_convection_are_solved_to_rounding() {
    let members = members(|case| {
        matches!(case.time, TimeSettings::Steady(_)) && case.fluid.model == FlowModel::NavierStokes
    });
    let wrong: Vec<String> = members
        .par_iter()
        .filter_map(|member| {
            let settings = SETTINGS.map(str::to_owned);
            let model = Case::read(member, &settings).expect("shipped cases are valid").model;
            let TimeSettings::Steady(steady) = &model.case.time else { return None };
            let mesh = build_mesh::<2>(&model).expect("the mesh can be made");
            let problem = build_problem(&model, &mesh).expect("the problem can be built");
            let mut work = workspace(&problem, &mesh);
            let _flow = steady_with(&mut work, &problem, steady, true);
            let accuracy = work.system.accuracy();
            let is_right = accuracy.residual <= RESIDUAL && accuracy.refinements <= 1;
            (!is_right).then(|| format!("{member}: {accuracy:?}"))
        })
        .collect();
    println!("{} steady flows", members.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(members.len() > 50);
}
