//! Each kind of derivative of a whole motion against central differences, to 1e-5.

use alewife_reduced::soft::{Markers, Objective, Plan, SoftBody};
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Frame, Order, RigidPart, Scheme, Solid};

use crate::swimmers::{MATERIAL, bar_in_space, disc, plane_bar, short_bar_in_space};

/// Largest relative difference that is accepted, of the largest derivative of the kind.
const CLOSE: f64 = 1e-5;

fn plan(scheme: Scheme) -> Plan {
    let targets = (0..3).map(|frame| vec![1.0 - 0.03 * (f64::from(frame) + 1.0)]).collect();
    Plan { scheme, tolerance: 1e-13, ..Plan::new(0.02, 2, targets) }
}

/// Marks on some nodes, with displacements they do not have.
fn marks<const D: usize>(body: &SoftBody<D>, plan: &Plan) -> Markers {
    let n = body.solid.spec().mesh.nodes.len();
    let nodes = vec![0, n / 3, n / 2, n - 1];
    let frames = plan.targets.len() + 1;
    let mark = |frame: usize, k: usize| vec![1e-3 * (frame * k) as f64, -5e-4 * frame as f64];
    Markers {
        dimension: D,
        weights: vec![1.0, 2.0, 1.0, 10.0],
        axes: vec![0, 1],
        substeps: plan.substeps,
        displacements: (0..frames)
            .map(|f| (0..nodes.len()).map(|k| mark(f, k)).collect())
            .collect(),
        nodes,
    }
}

/// A change of a body and a plan.
type Change<'a, const D: usize> = &'a dyn Fn(&mut SoftBody<D>, &mut Plan, f64);

/// Checks derivatives of a kind against changes of size h.
fn compare<const D: usize>(
    name: &str,
    body: &SoftBody<D>,
    scheme: Scheme,
    found: &[f64],
    changes: &[(Change<'_, D>, f64)],
) {
    let plan = plan(scheme);
    let largest = found.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let mut worst = 0.0_f64;
    for (found, (change, h)) in found.iter().zip(changes) {
        let at = |by: f64| {
            let (mut body, mut plan) = (body.clone(), plan.clone());
            // The marks stay, and the plan of the change only differs in what is told
            let objective = marks(&body, &plan);
            change(&mut body, &mut plan, by);
            let trajectory = body.simulate(&plan).expect("it moves");
            body.value(&trajectory, &objective as &dyn Objective)
        };
        let expected = (at(*h) - at(-h)) / (2.0 * h);
        worst = worst.max((found - expected).abs() / largest);
    }
    println!("{name} {scheme:?}: {worst:.1e} of {largest:.2e}");
    assert!(largest > 0.0 && worst < CLOSE, "{name} {scheme:?} {worst}");
}

/// All kinds of derivatives of a body.
fn check<const D: usize>(name: &str, body: &SoftBody<D>, scheme: Scheme) {
    let plan = plan(scheme);
    let objective = marks(body, &plan);
    // Derivatives by the shape are not known where parts are rigid
    let with_shape = body.solid.spec().rigid.is_empty();
    let found = body.with_gradient(&plan, &objective, with_shape).expect("it moves");
    let again = body.value(&found.trajectory, &objective);
    assert!((found.value - again).abs() <= 1e-15 * again.abs());
    let gradient = &found.gradient;
    let material = body.solid.spec().materials[0];
    let moduli = |by_young: f64, by_poisson: f64| {
        move |body: &mut SoftBody<D>, _: &mut Plan, by: f64| {
            let (young, poisson) =
                (material.young + by * by_young, material.poisson + by * by_poisson);
            body.solid.set_moduli(0, young, poisson).expect("they are moduli");
        }
    };
    compare(&format!("{name}, E"), body, scheme, &gradient.young, &[(&moduli(1.0, 0.0), 1.0)]);
    // Where the volume is kept there is no other ratio
    if material.poisson < 0.5 {
        compare(
            &format!("{name}, nu"),
            body,
            scheme,
            &gradient.poisson,
            &[(&moduli(0.0, 1.0), 1e-5)],
        );
    }
    let stiffness = |body: &mut SoftBody<D>, _: &mut Plan, by: f64| {
        let old = body.solid.spec().fibres[0].stiffness;
        body.solid.set_fibre_stiffness(0, old + by).expect("there are fibres");
    };
    let kind = format!("{name}, fibre stiffness");
    compare(&kind, body, scheme, &gradient.fibre_stiffness, &[(&stiffness, 1.0)]);
    let told: Vec<_> = (0..3)
        .map(|frame: usize| {
            move |_: &mut SoftBody<D>, plan: &mut Plan, by: f64| plan.targets[frame][0] += by
        })
        .collect();
    let told: Vec<(Change<'_, D>, f64)> = told.iter().map(|c| (c as Change<'_, D>, 1e-5)).collect();
    let targets: Vec<f64> = gradient.targets.iter().map(|frame| frame[0]).collect();
    compare(&format!("{name}, activation"), body, scheme, &targets, &told);
    for (kind, found) in [("drag", &gradient.drag), ("thrust", &gradient.thrust)] {
        let points: Vec<_> = (0..4)
            .map(|k: usize| {
                move |body: &mut SoftBody<D>, _: &mut Plan, by: f64| {
                    let law = body.law.as_mut().expect("it has loads");
                    let curve = if kind == "drag" { &mut law.drag } else { &mut law.thrust };
                    curve.points_mut()[k] += by;
                }
            })
            .collect();
        let points: Vec<(Change<'_, D>, f64)> =
            points.iter().map(|c| (c as Change<'_, D>, 1e-3)).collect();
        compare(&format!("{name}, {kind}"), body, scheme, found, &points);
    }
    if !with_shape {
        let refused = body.with_gradient(&plan, &objective, true).err().map(|one| one.to_string());
        assert!(refused.is_some_and(|said| said.contains("where parts are rigid")));
        return;
    }
    // Every seventh component, and one that is held; nodes on an axis stay there
    let nodes = &body.solid.spec().mesh.nodes;
    let is_axis = body.solid.spec().frame == Frame::Axis;
    let is_free = |c: &usize| !(is_axis && c % D == 1 && nodes[c / D][1] == 0.0);
    let held = body.solid.held().into_iter().find(is_free).expect("something is held");
    let mut components: Vec<usize> = (0..gradient.shape.len()).step_by(7).filter(is_free).collect();
    components.push(held);
    let shapes: Vec<_> = components
        .iter()
        .map(|component| {
            let component = *component;
            move |body: &mut SoftBody<D>, _: &mut Plan, by: f64| {
                let mut spec = body.solid.spec().clone();
                spec.mesh.nodes[component / D][component % D] += by;
                body.solid = Solid::new(spec).expect("it is a solid");
            }
        })
        .collect();
    let shapes: Vec<(Change<'_, D>, f64)> =
        shapes.iter().map(|c| (c as Change<'_, D>, 1e-7)).collect();
    let found: Vec<f64> = components.iter().map(|c| gradient.shape[*c]).collect();
    compare(&format!("{name}, shape"), body, scheme, &found, &shapes);
}

#[test]
fn derivatives_of_a_plane_bar_are_exact() {
    check("linear", &plane_bar(Order::Linear, MATERIAL), Scheme::ImplicitEuler);
    let damped = Material { viscosity: 30.0, ..MATERIAL };
    check("quadratic, damped", &plane_bar(Order::Quadratic, damped), Scheme::Bdf2);
}

#[test]
fn derivatives_around_the_axis_are_exact() {
    check("disc", &disc(MATERIAL), Scheme::Bdf2);
}

#[test]
fn derivatives_where_volumes_are_kept_are_exact() {
    let kept = Material { poisson: 0.5, law: Law::NeoHookean, viscosity: 30.0, ..MATERIAL };
    check("volume kept", &plane_bar(Order::Quadratic, kept), Scheme::ImplicitEuler);
    check("volume kept", &plane_bar(Order::Quadratic, kept), Scheme::Bdf2);
    check("disc, volume kept", &disc(Material { viscosity: 0.0, ..kept }), Scheme::Bdf2);
    check("bar in space, volume kept", &short_bar_in_space(kept), Scheme::Bdf2);
}

/// The same body with the cells beyond a place rigid.
fn with_head<const D: usize>(body: SoftBody<D>, from: f64) -> SoftBody<D> {
    let mut spec = body.solid.spec().clone();
    let n = spec.mesh.n_local();
    let middle = |cell: &[usize]| {
        cell[..=D].iter().map(|node| spec.mesh.nodes[*node][0]).sum::<f64>() / (D + 1) as f64
    };
    let cells = spec.mesh.cells.chunks_exact(n).enumerate();
    let cells = cells.filter(|(_, cell)| middle(cell) > from).map(|(number, _)| number).collect();
    spec.rigid.push(RigidPart { cells, density: 2e3 });
    SoftBody { solid: Solid::new(spec).expect("it is a solid"), law: body.law }
}

#[test]
fn derivatives_with_rigid_parts_are_exact() {
    let damped = Material { viscosity: 30.0, ..MATERIAL };
    let plane = plane_bar(Order::Quadratic, damped);
    check("plane, rigid head", &with_head(plane, 0.12), Scheme::Bdf2);
    let kept = Material { poisson: 0.5, law: Law::NeoHookean, ..damped };
    let plane = plane_bar(Order::Quadratic, kept);
    check("volume kept, rigid head", &with_head(plane, 0.12), Scheme::ImplicitEuler);
    let space = bar_in_space(MATERIAL);
    check("space, rigid head", &with_head(space, 0.12), Scheme::Bdf2);
    check("disc, rigid head", &with_head(disc(MATERIAL), 0.02), Scheme::Bdf2);
}

#[test]
fn derivatives_in_space_are_exact() {
    for scheme in [Scheme::ImplicitEuler, Scheme::Bdf2] {
        check("bar in space", &bar_in_space(MATERIAL), scheme);
    }
}
