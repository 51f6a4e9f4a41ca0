//! A twin of the recorded starfish: a body of its own shape, and records of a model with other numbers.

use alewife_mesh::Point;
use alewife_reduced::search::{Bounded, Ended, Evaluated, Found, Search, minimise};
use alewife_reduced::soft::{Markers, Plan, SoftBody, SoftError, Trajectory, Travel};
use alewife_solid::solid::{Fibres, Frame, Order, Scheme, Solid, SolidMesh, SolidSpec};
use nalgebra::Vector3;

use crate::swimmers::{MATERIAL, law, triangles};

const YOUNG: f64 = 4e4;

/// Limbs along y with fibres below, which swims along x on a rail at its middle.
fn star(young: f64, poisson: f64) -> SoftBody<2> {
    let map = |s: f64, t: f64| Point::from([0.01 * s, 0.16 * (t - 0.5)]);
    let mesh: SolidMesh<2> = triangles([1, 16], map).quadratic();
    let rail = mesh.nodes_where(|x| x[1].abs() < 0.012);
    let centre =
        |cell: &[usize]| cell[..3].iter().map(|node| mesh.nodes[*node]).sum::<Point<2>>() / 3.0;
    let cells: Vec<usize> = mesh
        .cells
        .chunks_exact(6)
        .enumerate()
        .filter(|(_, cell)| centre(cell)[0] < 0.005 && centre(cell)[1].abs() > 0.02)
        .map(|(number, _)| number)
        .collect();
    let spec = SolidSpec {
        frame: Frame::Plane,
        materials: vec![alewife_solid::material::Material { young, poisson, ..MATERIAL }],
        material_of: Vec::new(),
        fibres: vec![Fibres { directions: vec![Vector3::y(); cells.len()], cells, stiffness: 1e5 }],
        rigid: Vec::new(),
        held: rail.iter().map(|node| 2 * node + 1).collect(),
        mesh,
    };
    assert_eq!(spec.mesh.order, Order::Quadratic);
    SoftBody { solid: Solid::new(spec).expect("it is a solid"), law: Some(law()) }
}

fn plan(targets: &[f64]) -> Plan {
    Plan::new(0.05, 2, targets.iter().map(|target| vec![*target]).collect())
}

fn marked(body: &SoftBody<2>) -> Vec<usize> {
    let mesh = &body.solid.spec().mesh;
    let at = |y: f64| mesh.nodes_where(|x| x[0] == 0.0 && (x[1] - y).abs() < 1e-9)[0];
    [-0.08, -0.04, 0.04, 0.08].map(at).to_vec()
}

/// What a camera sees of a motion.
fn record(body: &SoftBody<2>, plan: &Plan, motion: &Trajectory) -> Markers {
    let (nodes, rest) = (marked(body), body.solid.at_rest());
    let frames = motion.levels.iter().step_by(plan.substeps);
    let place = |at: &Vec<f64>, node: usize| -> Vec<f64> {
        [0, 1].map(|axis| at[2 * node + axis] - rest[2 * node + axis]).to_vec()
    };
    Markers {
        dimension: 2,
        weights: vec![10.0, 1.0, 1.0, 10.0],
        axes: vec![0, 1],
        substeps: plan.substeps,
        displacements: frames
            .map(|level| nodes.iter().map(|node| place(&level.places, *node)).collect())
            .collect(),
        nodes,
    }
}

fn bounded(name: &str, start: f64, lower: f64, upper: f64) -> Bounded {
    Bounded { name: name.to_owned(), start, lower, upper, scale: None }
}

/// Moduli that make a model move as recorded.
fn identify(model: &mut SoftBody<2>, plan: &Plan, seen: &Markers) -> Found {
    let material = model.solid.spec().materials[0];
    let parameters =
        [bounded("E", material.young, 1e4, 1e6), bounded("nu", material.poisson, 0.1, 0.45)];
    let search = Search { decrease: 1e-12, slope: 1e-9, ..Search::default() };
    let mut moved = model.clone();
    let found = minimise(&parameters, &search, |values| {
        moved.solid.set_moduli(0, values[0], values[1])?;
        let found = moved.with_gradient(plan, seen, false)?;
        Ok::<_, SoftError>(Evaluated {
            values: values.to_vec(),
            objective: found.value,
            slopes: vec![found.gradient.young[0], found.gradient.poisson[0]],
        })
    })
    .expect("it starts");
    let best = &found.best.values;
    model.solid.set_moduli(0, best[0], best[1]).expect("they are moduli");
    found
}

fn travel(body: &SoftBody<2>, plan: &Plan) -> Travel {
    Travel {
        shares: vec![1.0; plan.targets.len()],
        substeps: plan.substeps,
        nodes: marked(body),
        direction: vec![1.0, 0.0],
    }
}

/// How far a body swims (m).
fn way(body: &SoftBody<2>, plan: &Plan) -> f64 {
    let motion = body.simulate(plan).expect("it swims");
    -body.value(&motion, &travel(body, plan))
}

/// The stretches that make a model swim farthest.
fn optimise(model: &SoftBody<2>, start: &[f64], n: usize) -> Vec<f64> {
    let parameter = |k: usize| Bounded {
        name: format!("stretch {k}"),
        start: start[k],
        lower: 0.85,
        upper: 1.0,
        scale: Some(0.1),
    };
    let parameters: Vec<Bounded> = (0..start.len()).map(parameter).collect();
    let objective = travel(model, &plan(start));
    let search = Search { max_evaluations: n, ..Search::default() };
    let found = minimise(&parameters, &search, |values| {
        let found = model.with_gradient(&plan(values), &objective, false)?;
        Ok::<_, SoftError>(Evaluated {
            values: values.to_vec(),
            objective: found.value,
            slopes: found.gradient.targets.iter().map(|frame| frame[0]).collect(),
        })
    });
    found.expect("it starts").best.values
}

fn strokes() -> Vec<f64> {
    (0..16).map(|k| 0.95 + 0.03 * (f64::from(k) * 1.3).sin()).collect()
}

#[test]
fn the_moduli_of_a_twin_are_found_from_its_marks() {
    let robot = star(YOUNG, 0.3);
    // With several steps a frame, marks within it are compared with its start, and a model cannot be exact
    let plan = Plan { substeps: 1, ..plan(&strokes()) };
    let motion = robot.simulate(&plan).expect("it swims");
    let seen = record(&robot, &plan, &motion);
    seen.check(plan.targets.len()).expect("the record is complete");
    let mut model = star(2.0 * YOUNG, 0.4);
    let found = identify(&mut model, &plan, &seen);
    println!("{:?} after {}", found.best, found.all.len());
    assert!(matches!(found.ended, Ended::Converged), "{:?}", found.ended);
    assert!((found.best.values[0] / YOUNG - 1.0).abs() < 1e-2, "{:?}", found.best);
    assert!((found.best.values[1] - 0.3).abs() < 1e-2, "{:?}", found.best);
    assert!(found.best.objective < 1e-6 * found.all[0].objective);
}

#[test]
fn a_body_in_air_that_is_told_nothing_rests() {
    let mut body = star(YOUNG, 0.3);
    body.law = None;
    let rest = body.simulate(&plan(&[1.0; 4])).expect("it rests");
    let start = body.solid.at_rest();
    let moved = rest.levels[8].places.iter().zip(&start).map(|(x, y)| (x - y).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-12);
    // Without water, strokes leave the centre of mass where it is
    let motion = body.simulate(&plan(&strokes())).expect("it moves");
    let momentum = body.solid.times_mass(&motion.levels[32].velocities);
    let along: f64 = momentum.iter().step_by(2).sum();
    let size: f64 = momentum.iter().step_by(2).map(|p| p.abs()).sum();
    assert!(along.abs() < 1e-6 * size, "{along} {size}");
}

#[test]
fn three_rounds_with_a_robot_make_it_faster_and_the_model_truer() {
    let robot = star(YOUNG, 0.3);
    let mut model = star(2.5 * YOUNG, 0.4);
    let mut told = strokes();
    let (mut last_way, mut last_gap) = (way(&robot, &plan(&told)), f64::INFINITY);
    println!("start: {:.3} mm", 1e3 * last_way);
    for round in 0..3 {
        told = optimise(&model, &told, 4 + 8 * round);
        let plan = plan(&told);
        let motion = robot.simulate(&plan).expect("it swims");
        let seen = record(&robot, &plan, &motion);
        let (real, thought) = (way(&robot, &plan), way(&model, &plan));
        let gap = (real - thought).abs();
        println!("round {round}: robot {:.3}, model {:.3} mm", 1e3 * real, 1e3 * thought);
        assert!(real > last_way, "round {round}: {real} after {last_way}");
        assert!(gap < last_gap, "round {round}: {gap} after {last_gap}");
        (last_way, last_gap) = (real, gap);
        identify(&mut model, &plan, &seen);
    }
}

#[test]
fn plans_and_records_that_do_not_fit_are_refused() {
    let body = star(YOUNG, 0.3);
    let said = |plan: &Plan| body.simulate(plan).expect_err("it is wrong").to_string();
    assert_eq!(said(&plan(&[])), "a plan has at least one frame of one step");
    assert!(said(&plan(&[1.0, 0.0])).starts_with("frame 1 has the stretch 0: one is positive"));
    let two = Plan { targets: vec![vec![1.0, 1.0]], ..plan(&[1.0]) };
    assert_eq!(said(&two), "frame 0 has 2 stretches for 1 sets of fibres");
    let conservative = Plan { scheme: Scheme::Conservative, ..plan(&[1.0]) };
    assert_eq!(said(&conservative), "the soft tier steps by implicit Euler or BDF2");
    let short = plan(&[1.0, 1.0]);
    let seen = record(&body, &short, &body.simulate(&short).expect("it rests"));
    let refused = seen.check(3).expect_err("the record is too short").to_string();
    assert!(refused.starts_with("the control has 3 frames"), "{refused}");
    let mut gap = seen.clone();
    gap.displacements[1].pop();
    assert!(gap.check(2).expect_err("a mark is missing").to_string().contains("frame 1"));
}
