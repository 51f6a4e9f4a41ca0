//! Steps in time: what they keep, their order, and damping.

use alewife_mesh::Point;
use alewife_solid::material::{Law, Material};
use alewife_solid::solid::{Frame, Minimiser, Motion, Order, Scheme, Solid, SolidError, StepInput};

use crate::meshes::{all_of, cube, material, solid, square};

/// The motion after steps of a scheme, from rest in shape with these velocities.
fn run<const D: usize>(
    body: &Solid<D>,
    scheme: Scheme,
    step: f64,
    n: usize,
    start: &Motion,
) -> Motion {
    let mut motion = start.clone();
    let mut minimiser = Minimiser::with_tolerance(1e-13);
    let loads = vec![0.0; body.n_components()];
    let given = StepInput { scheme, step, targets: &[], loads: &loads, held: None };
    for _ in 0..n {
        motion = body.advance(&mut minimiser, &motion, &given).expect("it moves");
    }
    motion
}

fn spin<const D: usize>(body: &Solid<D>) -> Motion {
    let mut motion = Motion::at_rest(body);
    for (node, x) in body.spec().mesh.nodes.iter().enumerate() {
        motion.velocities[D * node] = -3.0 * (x[1] - 0.5) + 2.0 * (x[0] - 0.5);
        motion.velocities[D * node + 1] = 4.0 * (x[0] - 0.5);
    }
    motion
}

fn energy<const D: usize>(body: &Solid<D>, motion: &Motion) -> f64 {
    motion.kinetic_energy(body) + body.elastic_energy(&motion.places, &[]).expect("it is whole")
}

#[test]
fn a_conservative_step_keeps_the_energy_to_rounding() {
    let laws = [Law::SaintVenantKirchhoff, Law::NeoHookean, Law::Corotated, Law::CorotatedVolume];
    for law in laws {
        for order in [Order::Linear, Order::Quadratic] {
            let mesh = cube([2, 2, 1], order, |x| x);
            let body = solid(mesh, Frame::Space, material(law, 1e5, 0.3), Vec::new());
            let start = spin(&body);
            let before = energy(&body, &start);
            let end = run(&body, Scheme::Conservative, 0.005, 40, &start);
            let change = energy(&body, &end) / before - 1.0;
            let stored = body.elastic_energy(&end.places, &[]).expect("it is whole") / before;
            println!("{law:?} {order:?} {change:+.1e}, elastic part {stored:.2}");
            assert!(change.abs() < 1e-11, "{law:?} {order:?} {change}");
            // Momentum, which is zero, too
            let momentum = body.times_mass(&end.velocities);
            let along: f64 = momentum.iter().step_by(3).sum();
            assert!(along.abs() < 1e-9, "{along}");
        }
    }
    let mesh = square([2, 2], Order::Linear, |s, t| Point::from([s, t]));
    let damped = Material { viscosity: 1.0, ..material(Law::NeoHookean, 1e5, 0.3) };
    let body = solid(mesh, Frame::Plane, damped, Vec::new());
    let motion = Motion::at_rest(&body);
    let loads = vec![0.0; body.n_components()];
    let given = StepInput {
        scheme: Scheme::Conservative,
        step: 0.01,
        targets: &[],
        loads: &loads,
        held: None,
    };
    let refused = body.advance(&mut Minimiser::default(), &motion, &given);
    assert_eq!(refused, Err(SolidError::Damped));
}

#[test]
fn steps_converge_by_their_order() {
    for viscosity in [0.0, 20.0] {
        let mesh = square([3, 3], Order::Quadratic, |s, t| Point::from([s, t]));
        let material = Material { viscosity, ..material(Law::NeoHookean, 1e4, 0.3) };
        let body = solid(mesh, Frame::Plane, material, Vec::new());
        let start = spin(&body);
        let end = 0.2;
        let at = |scheme, n: usize| run(&body, scheme, end / n as f64, n, &start).places;
        let exact = {
            let (coarse, fine) = (at(Scheme::Bdf2, 320), at(Scheme::Bdf2, 640));
            let both = coarse.iter().zip(&fine);
            both.map(|(c, f)| (4.0 * f - c) / 3.0).collect::<Vec<f64>>()
        };
        for (scheme, expected) in
            [(Scheme::ImplicitEuler, 1.0), (Scheme::Bdf2, 2.0), (Scheme::Conservative, 2.0)]
        {
            if scheme == Scheme::Conservative && viscosity > 0.0 {
                continue;
            }
            let error = |n: usize| -> f64 {
                let apart = at(scheme, n);
                apart.iter().zip(&exact).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
            };
            let (coarse, fine) = (error(40), error(80));
            let found = (coarse / fine).log2();
            println!("{scheme:?} viscosity {viscosity} {fine:.1e} {found:.2}");
            assert!((found - expected).abs() < 0.3, "{scheme:?} {viscosity} {found}");
        }
    }
}

#[test]
fn damping_is_that_of_kelvin_and_voigt() {
    // A bar that can move along itself only, and not across: u'' (lambda + 2 mu) + 2 eta u_t'' = rho u_tt
    let mesh = square([8, 1], Order::Quadratic, |s, t| Point::from([s, 0.1 * t]));
    let mut held = all_of::<2>(&mesh.nodes_where(|x| x[0] == 0.0));
    held.extend((0..mesh.nodes.len()).map(|node| 2 * node + 1));
    let material = Material { viscosity: 100.0, ..material(Law::NeoHookean, 1e5, 0.3) };
    let lame = material.lame();
    let body = solid(mesh, Frame::Plane, material, held);
    let wave = 0.5 * std::f64::consts::PI;
    let mut motion = Motion::at_rest(&body);
    let small = 1e-5;
    for (node, x) in body.spec().mesh.nodes.iter().enumerate() {
        motion.places[2 * node] += small * (wave * x[0]).sin();
    }
    // m u'' + c u' + k u = 0 of the first mode
    let stiffness = (lame.volume + 2.0 * lame.shear) * wave * wave;
    let damping = 2.0 * material.viscosity * wave * wave;
    let decay = 0.5 * damping / material.density;
    let frequency = (stiffness / material.density - decay * decay).sqrt();
    let end = 0.4;
    let n = 800;
    let tip = body.spec().mesh.nodes_where(|x| x[0] == 1.0)[0];
    let found = run(&body, Scheme::Bdf2, end / f64::from(n), 800, &motion).places[2 * tip] - 1.0;
    let exact = (-decay * end).exp()
        * ((frequency * end).cos() + decay / frequency * (frequency * end).sin());
    println!("{:.6} {exact:.6}, undamped {:.6}", found / small, (frequency * end).cos());
    assert!((found / small - exact).abs() < 2e-3, "{} {exact}", found / small);
}
