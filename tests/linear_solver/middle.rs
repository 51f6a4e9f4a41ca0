//! Matrices in the middle of runs: with convection, bodies on their way, in contact or deforming.

use alewife_core::algebra::{DirectSolver, LinearSolver, SparseMatrix, Unknowns};
use alewife_core::case::{Case, TimeSettings};
use alewife_core::run::{Attempt, Simulation, build_mesh, simulation_on};
use rayon::prelude::*;

/// Relative residual that every system has to reach.
const RESIDUAL: f64 = 1e-12;

/// Residual of iterations with earlier factors, over the terms of the equations: a hundred times what
/// they are asked for, which is a norm of scaled equations, and here the largest entry.
const ITERATED: f64 = 1e-10;

/// Error of a correction by new factors, over the correction.
const DIFFERENCE: f64 = 1e-7;

/// Error of a correction by iterations, over the solution that is corrected: a tenth of the correction.
const ITERATED_DIFFERENCE: f64 = 1e-7;

/// The correction that is solved for over the solution it corrects: that of a late pass of a step.
const CORRECTION: f64 = 1e-6;

/// Steps after which the matrices are taken at the latest, where a mesh is replaced in between.
const MOST_STEPS: usize = 12;

/// A run that is stopped on its way.
pub(super) struct Run<'a> {
    pub member: &'a str,
    /// Coarser mesh, longer steps, a start near what is to be seen.
    pub settings: &'a [&'a str],
    pub steps: usize,
    /// Whether what it stands for is there.
    pub shows: fn(&Simulation<2>) -> bool,
}

/// Matrices of two steps on one mesh.
struct Matrices {
    earlier: SparseMatrix,
    latest: SparseMatrix,
    unknowns: Unknowns,
}

const RUNS: [Run<'_>; 15] = [
    // A stream, and a body on springs in it
    Run {
        member: "dfg-2d-2",
        settings: &["mesh.scale=2", "time.unsteady.step=0.02"],
        steps: 6,
        shows: is_oseen,
    },
    Run {
        member: "vortex-induced-vibration",
        settings: &["mesh.scale=2", "time.unsteady.step=0.2"],
        steps: 6,
        shows: is_oseen,
    },
    // Imposed and free bodies, seen from the laboratory and from a frame that travels
    Run {
        member: "oscillating-cylinder",
        settings: &["mesh.scale=2", "time.unsteady.step=0.25"],
        steps: 6,
        shows: is_oseen,
    },
    Run {
        member: "disc-in-couette-unsteady",
        settings: &["mesh.scale=1.5", "time.unsteady.step=0.4"],
        steps: 6,
        shows: is_oseen,
    },
    Run { member: "disc-free-fall", settings: &["mesh.scale=1.5"], steps: 6, shows: has_frame },
    Run {
        member: "sphere-settling",
        settings: &["mesh.scale=2", "time.unsteady.step=4e-3"],
        steps: 6,
        shows: is_oseen,
    },
    Run {
        member: "sphere-settling-re",
        settings: &["mesh.scale=2", "time.unsteady.step=0.8"],
        steps: 6,
        shows: |simulation| is_oseen(simulation) && has_frame(simulation),
    },
    // Contact
    Run {
        member: "disc-on-wall",
        settings: &["mesh.scale=1.5", "body.0.center=[0.0, 1.03]"],
        steps: 6,
        shows: is_in_contact,
    },
    Run {
        member: "drafting-kissing-tumbling",
        settings: &["mesh.scale=2", "body.0.center=[0.999, 4.7525]"],
        steps: 10,
        shows: is_in_contact,
    },
    // A mean flow through a periodic domain
    Run {
        member: "suspension-in-channel",
        settings: &["mesh.scale=1.5", "time.unsteady.step=0.05"],
        steps: 6,
        shows: is_oseen,
    },
    // Shapes that deform
    Run {
        member: "carangiform",
        settings: &["mesh.scale=2", "time.unsteady.step=0.03"],
        steps: 6,
        shows: has_frame,
    },
    Run {
        member: "tandem-fish",
        settings: &["mesh.scale=2.5", "time.unsteady.step=0.03"],
        steps: 6,
        shows: |simulation| has_frame(simulation) && simulation.problem.bodies.len() == 2,
    },
    Run {
        member: "sperm-2d",
        settings: &["mesh.scale=2"],
        steps: 5,
        shows: |simulation| simulation.problem.bodies[0].shape.is_some(),
    },
    // Swimmers with joints
    Run {
        member: "robot-eel",
        settings: &["mesh.scale=1.5", "time.unsteady.step=0.05"],
        steps: 6,
        shows: is_oseen,
    },
    Run {
        member: "three-sphere/re-0.01",
        settings: &["mesh.scale=1.5", "time.unsteady.step=0.1"],
        steps: 6,
        shows: is_oseen,
    },
];

/// Convection is there, and strong enough that the matrix is not that of a Stokes flow.
fn is_oseen(simulation: &Simulation<2>) -> bool {
    let Simulation { problem, .. } = simulation;
    let cell_reynolds =
        simulation.cell_crossing().reach * problem.density / problem.viscosity.zero_shear();
    problem.has_convection && cell_reynolds > 1e-3
}

fn has_frame(simulation: &Simulation<2>) -> bool {
    simulation.problem.frame.is_some()
}

fn is_in_contact(simulation: &Simulation<2>) -> bool {
    !simulation.state.contact.contacts.is_empty()
}

/// Matrices of the last two steps of a run, with what is wrong with the solutions of the run itself.
fn matrices(run: &Run<'_>) -> Result<Matrices, String> {
    let settings: Vec<String> = run.settings.iter().map(|&setting| setting.to_owned()).collect();
    let model = Case::read(run.member, &settings).map_err(|error| error.to_string())?.model;
    let TimeSettings::Unsteady(unsteady) = &model.case.time else {
        return Err("it has no steps".to_owned());
    };
    let mesh = build_mesh(&model).map_err(|error| error.to_string())?;
    let mut simulation = simulation_on(&model, mesh).map_err(|error| error.to_string())?;
    let (mut size, mut earlier) = (unsteady.step, None);
    for step in 1..=MOST_STEPS {
        loop {
            match simulation.try_step(size, f64::INFINITY) {
                Ok(Attempt::Made(_)) => break,
                Ok(Attempt::Rejected(_)) => size *= 0.5,
                Err(error) => return Err(error.to_string()),
            }
        }
        let system = &simulation.work.system;
        let accuracy = system.accuracy();
        if accuracy.residual > RESIDUAL || accuracy.refinements > 1 {
            return Err(format!("step {step}: {accuracy:?}"));
        }
        let latest = system.matrix();
        if let Some(earlier) = earlier.take_if(|_| step >= run.steps)
            && SparseMatrix::pattern(&earlier) == latest.pattern()
        {
            let unknowns = system.unknowns().clone();
            let is_shown = (run.shows)(&simulation);
            let not_shown = || "what the run stands for is not there".to_owned();
            return is_shown
                .then_some(Matrices { earlier, latest, unknowns })
                .ok_or_else(not_shown);
        }
        earlier = Some(latest);
    }
    Err("the mesh was replaced too often".to_owned())
}

/// Numbers in [-1, 1] without order, always the same.
fn scattered(n: usize) -> Vec<f64> {
    let mut state = 1u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| next()).collect()
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Solves for a known correction by new factors and by iterations with those of an earlier step, which may
/// be off by a part of the solution that is corrected; whether the iterations converged.
fn solved_both_ways(matrices: &Matrices, difference: f64) -> Result<bool, String> {
    let Matrices { earlier, latest, unknowns } = matrices;
    let typical = scattered(latest.n());
    let exact: Vec<f64> = typical.iter().map(|value| CORRECTION * value).collect();
    let mut b = vec![0.0; latest.n()];
    latest.multiply(&exact, &mut b);
    let off = |x: &[f64]| largest(x.iter().zip(&exact).map(|(x, exact)| x - exact)) / CORRECTION;
    let mut direct =
        DirectSolver::new(&latest.shared_pattern(), unknowns).map_err(|error| error.to_string())?;
    direct.set_up(latest).map_err(|error| error.to_string())?;
    let mut x = b.clone();
    let accuracy = direct.solve(latest, &mut x).map_err(|error| error.to_string())?;
    if accuracy.residual > RESIDUAL || accuracy.refinements > 1 || off(&x) > DIFFERENCE {
        return Err(format!("by new factors: {accuracy:?}, off by {:.1e}", off(&x)));
    }
    let mut iterative = DirectSolver::new(&earlier.shared_pattern(), unknowns)
        .map_err(|error| error.to_string())?;
    iterative.set_up(earlier).map_err(|error| error.to_string())?;
    let mut y = b.clone();
    let solved = iterative.solve_with_earlier_set_up(latest, &mut y, &typical);
    if !solved.map_err(|error| error.to_string())? {
        return if y == b { Ok(false) } else { Err("a trial changed the right-hand side".into()) };
    }
    let terms = largest(latest.absolute_product(&typical));
    let residual = largest(latest.residual(&y, &b).defect) / terms;
    if residual > ITERATED || CORRECTION * off(&y) > difference {
        return Err(format!("by earlier factors: {residual:.1e}, off by {:.1e}", off(&y)));
    }
    Ok(true)
}

/// What is wrong with the matrices of runs, where iterations may be off by this part, and how many were solved for by earlier factors, too.
pub(super) fn judge(runs: &[Run<'_>], difference: f64) -> (Vec<String>, usize) {
    let results: Vec<(&str, Result<bool, String>)> = runs
        .par_iter()
        .map(|run| {
            let judged = matrices(run).and_then(|found| solved_both_ways(&found, difference));
            (run.member, judged)
        })
        .collect();
    let wrong = results
        .iter()
        .filter_map(|(member, result)| Some(format!("{member}: {}", result.as_ref().err()?)))
        .collect();
    (wrong, results.iter().filter(|(_, result)| *result == Ok(true)).count())
}

#[test]
fn matrices_in_the_middle_of_runs_are_solved_to_rounding_both_ways() {
    let (wrong, iterated) = judge(&RUNS, ITERATED_DIFFERENCE);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(2 * iterated > RUNS.len(), "by earlier factors: {iterated} of {}", RUNS.len());
}
