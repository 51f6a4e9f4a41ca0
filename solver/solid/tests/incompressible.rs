//! Solids that keep their volume: orders of convergence, exact inflation, no locking, beams.

use std::f64::consts::FRAC_PI_2;

use alewife_mesh::Point;
use alewife_solid::material::{Law, Principal, Tensor};
use alewife_solid::solid::{
    Frame, Minimiser, Motion, Order, Potential, Scheme, Solid, SolidError, SolidMesh, StepInput,
};

use crate::meshes::{all_of, cube, material, moved, solid, square};

/// Its shear modulus is one.
const YOUNG: f64 = 3.0;

/// Shears one after the other: none changes a volume.
fn made<const D: usize>(x: &Point<D>) -> Point<D> {
    let mut y = *x;
    y[0] += 0.15 * (2.0 * y[1]).sin();
    if D == 3 {
        y[2] += 0.1 * (1.5 * y[0]).sin();
        y[1] += 0.1 * (2.0 * y[2]).sin();
    } else {
        y[1] += 0.15 * (1.5 * y[0]).sin();
    }
    y
}

fn made_pressure<const D: usize>(x: &Point<D>) -> f64 {
    0.4 * (2.0 * x[0]).cos() + 0.3 * x[1] * x[D - 1]
}

/// Central difference of fourth order along an axis.
fn slope<const D: usize, T>(of: impl Fn(&Point<D>) -> T, x: &Point<D>, axis: usize, h: f64) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let at = |by: f64| {
        let mut moved = *x;
        moved[axis] += by;
        of(&moved)
    };
    (at(h) - at(-h)) * (8.0 / (12.0 * h)) - (at(2.0 * h) - at(-2.0 * h)) * (1.0 / (12.0 * h))
}

fn stress<const D: usize>(law: Law, x: &Point<D>) -> Tensor {
    let mut f = Tensor::identity();
    for j in 0..D {
        let column = slope(made, x, j, 1e-4);
        (0..D).for_each(|i| f[(i, j)] = column[i]);
    }
    let at = Principal::of(&f).expect("it is not turned over");
    let lame = material(law, YOUNG, 0.5).lame();
    at.stress(law, lame).stress - at.cofactor() * made_pressure(x)
}

/// The force a volume that holds the made state: -Div P.
fn force<const D: usize>(law: Law, x: &Point<D>) -> Point<D> {
    let mut force = Point::zeros();
    for j in 0..D {
        let column = slope(|x| stress(law, x), x, j, 1e-3);
        (0..D).for_each(|i| force[i] -= column[(i, j)]);
    }
    force
}

/// Integrals of products of the shape functions of an edge and of a triangle, of its size.
const EDGE: [[f64; 3]; 3] = [[4.0, -1.0, 2.0], [-1.0, 4.0, 2.0], [2.0, 2.0, 16.0]];
const TRIANGLE: [[f64; 6]; 6] = [
    [6.0, -1.0, -1.0, 0.0, -4.0, 0.0],
    [-1.0, 6.0, -1.0, 0.0, 0.0, -4.0],
    [-1.0, -1.0, 6.0, -4.0, 0.0, 0.0],
    [0.0, 0.0, -4.0, 32.0, 16.0, 16.0],
    [-4.0, 0.0, 0.0, 16.0, 32.0, 16.0],
    [0.0, -4.0, 0.0, 16.0, 16.0, 32.0],
];

/// Adds the stress of the made state on the side x = 1, of a grid with so many squares along its edges.
fn add_traction<const D: usize>(law: Law, body: &Solid<D>, n: usize, loads: &mut [f64]) {
    let mesh = &body.spec().mesh;
    let size = if D == 2 { 1.0 / n as f64 / 30.0 } else { 0.5 / (n * n) as f64 / 180.0 };
    for facet in &mesh.facets {
        if facet.nodes.iter().any(|node| mesh.nodes[*node][0] < 1.0 - 1e-9) {
            continue;
        }
        for (a, to) in facet.nodes.iter().enumerate() {
            for (b, from) in facet.nodes.iter().enumerate() {
                let part = size * if D == 2 { EDGE[a][b] } else { TRIANGLE[a][b] };
                let stress = stress(law, &mesh.nodes[*from]);
                (0..D).for_each(|i| loads[D * to + i] += part * stress[(i, 0)]);
            }
        }
    }
}

/// Errors of places, pressures, and the volumes of single cells.
fn errors<const D: usize>(law: Law, mesh: SolidMesh<D>, frame: Frame, n: usize) -> [f64; 3] {
    let exact = moved(&mesh, made);
    let sides =
        mesh.nodes_where(|x| x[0] < 1e-9 || (1..D).any(|i| x[i] < 1e-9 || x[i] > 1.0 - 1e-9));
    let body: Solid<D> = solid(mesh, frame, material(law, YOUNG, 0.5), all_of::<D>(&sides));
    let mut start = body.at_rest();
    start[..exact.len()].copy_from_slice(&exact);
    let mut given = start.clone();
    for (node, x) in body.spec().mesh.nodes.iter().enumerate() {
        given[D * node..D * (node + 1)].copy_from_slice(force(law, x).as_slice());
    }
    let density = body.spec().materials[0].density;
    let mut loads = body.times_mass(&given);
    loads.iter_mut().for_each(|load| *load /= density);
    add_traction(law, &body, n, &mut loads);
    let potential = Potential::at_rest(&body, &[], &loads);
    let found = Minimiser::default().minimise(&potential, &start).expect("there is an equilibrium");
    let apart: Vec<f64> = found.places.iter().zip(&start).map(|(x, y)| x - y).collect();
    let squares: f64 = body.times_mass(&apart).iter().zip(&apart).map(|(m, e)| m * e).sum();
    let pressures = &found.places[body.n_places()..];
    let nodes = body.pressure_nodes().iter().map(|node| &body.spec().mesh.nodes[*node]);
    let differences = nodes.zip(pressures).map(|(x, p)| (made_pressure(x) - p).powi(2));
    let ratios = body.volume_ratios(&found.places);
    let total: f64 = ratios.iter().map(|ratio| ratio - 1.0).sum::<f64>() / ratios.len() as f64;
    assert!(total.abs() < 1e-10, "the whole keeps its volume: {total}");
    [
        (squares / density).sqrt(),
        (differences.sum::<f64>() / pressures.len() as f64).sqrt(),
        ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max),
    ]
}

fn check_orders(name: &str, of: impl Fn(usize) -> [f64; 3], n: usize, least: [f64; 3]) {
    let (coarse, fine) = (of(n), of(2 * n));
    for (k, what) in ["places", "pressures", "volumes of cells"].into_iter().enumerate() {
        let found = (coarse[k] / fine[k]).log2();
        println!("{name}, {what}: {:.1e} {:.1e}, order {found:.2}", coarse[k], fine[k]);
        assert!(found > least[k], "{name} {what} {found}");
    }
}

#[test]
fn places_converge_by_third_order_and_pressures_by_second() {
    for law in [Law::NeoHookean, Law::SaintVenantKirchhoff, Law::Corotated] {
        let plane = |n: usize| {
            let mesh = square([n, n], Order::Quadratic, |s, t| Point::from([s, t]));
            errors(law, mesh, Frame::Plane, n)
        };
        check_orders(&format!("plane, {law:?}"), plane, 6, [2.75, 1.75, 1.75]);
    }
    let space = |n: usize| {
        errors(Law::NeoHookean, cube([n, n, n], Order::Quadratic, |x| x), Frame::Space, n)
    };
    check_orders("space", space, 3, [2.65, 1.65, 1.65]);
}

/// Radii at rest, and the square by which the wall is blown up: r^2 = R^2 + c.
const INNER: f64 = 0.5;
const OUTER: f64 = 1.0;
const BLOWN: f64 = 0.5;

/// The radial stress of the blown cylinder, of its shear modulus, and its pressure.
fn cylinder(rest: f64) -> [f64; 2] {
    let sum = |rest: f64| {
        let square = rest * rest + BLOWN;
        0.5 * (rest * rest / square).ln() - 0.5 * BLOWN / square
    };
    let radial = sum(rest) - sum(OUTER);
    [radial, rest * rest / (rest * rest + BLOWN) - 1.0 - radial]
}

/// Errors of places, pressures and the volumes of cells, and that of the force on the inner wall, where its radius is held.
fn blown<const D: usize>(
    mesh: SolidMesh<D>,
    frame: Frame,
    radius: impl Fn(&Point<D>) -> f64,
    rails: impl Fn(&Point<D>) -> [bool; D],
    length: f64,
) -> [f64; 4] {
    let is_inner = |x: &Point<D>| (radius(x) - INNER).abs() < 1e-9;
    let grown = |x: &Point<D>| {
        let ratio = (1.0 + BLOWN / radius(x).powi(2)).sqrt();
        if frame == Frame::Axis {
            Point::from_fn(|i, _| if i == 1 { ratio * x[1] } else { x[i] })
        } else {
            *x * ratio
        }
    };
    let mut held = Vec::new();
    for (node, x) in mesh.nodes.iter().enumerate() {
        let rails = rails(x);
        held.extend((0..D).filter(|i| rails[*i] || is_inner(x)).map(|i| D * node + i));
    }
    let exact = moved(&mesh, grown);
    let body: Solid<D> = solid(mesh, frame, material(Law::NeoHookean, YOUNG, 0.5), held);
    let mut state = body.at_rest();
    state[..exact.len()].copy_from_slice(&exact);
    let loads = vec![0.0; state.len()];
    let potential = Potential::at_rest(&body, &[], &loads);
    let found = Minimiser::default().minimise(&potential, &state).expect("it is blown up");
    let nodes = &body.spec().mesh.nodes;
    let places = found.places.iter().zip(&exact).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let pressures = body.pressure_nodes().iter().zip(&found.places[body.n_places()..]);
    let pressures = pressures
        .map(|(node, p)| (p - cylinder(radius(&nodes[*node]))[1]).abs())
        .fold(0.0, f64::max);
    let ratios = body.volume_ratios(&found.places);
    let volumes = ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max);
    let mut force = 0.0;
    for (node, x) in nodes.iter().enumerate().filter(|(_, x)| is_inner(x)) {
        let out = if frame == Frame::Axis {
            found.slope[D * node + 1]
        } else {
            (0..D).map(|i| found.slope[D * node + i] * x[i] / radius(x)).sum()
        };
        force += out;
    }
    let expected = -cylinder(INNER)[0] * length * (INNER * INNER + BLOWN).sqrt();
    [places, pressures, volumes, (force / expected - 1.0).abs()]
}

#[test]
fn a_thick_cylinder_is_blown_up_as_finite_elasticity_has_it() {
    let axis = |n: usize| {
        let mesh = square([2, n], Order::Quadratic, |s, t| {
            Point::from([0.2 * s, INNER + t * (OUTER - INNER)])
        });
        let all = blown(mesh, Frame::Axis, |x| x[1], |_| [true, false], 0.2 * 4.0 * FRAC_PI_2);
        println!("axis: {all:.1?}");
        assert!(all[3] < 1e-3, "force on the inner wall {}", all[3]);
        [all[0], all[1], all[2]]
    };
    check_orders("around the axis", axis, 8, [2.75, 1.75, 1.75]);
    let plane = |n: usize| {
        let mut mesh = square([n, n], Order::Quadratic, |s, t| Point::from([t, s]));
        for x in &mut mesh.nodes {
            let (radius, angle) = (INNER + x[0] * (OUTER - INNER), FRAC_PI_2 * x[1]);
            *x = Point::from([radius * angle.cos(), radius * angle.sin()]);
        }
        let rails = |x: &Point<2>| [x[0] < 1e-9, x[1] < 1e-9];
        let all = blown(mesh, Frame::Plane, |x| x.norm(), rails, FRAC_PI_2);
        println!("plane: {all:.1?}");
        assert!(all[3] < 2e-2, "force on the inner wall {}", all[3]);
        [all[0], all[1], all[2]]
    };
    check_orders("in the plane", plane, 6, [2.5, 1.5, 1.5]);
}

/// How far the end of a cantilever of length 10 and thickness 1 is lifted by a load there, for a load of one.
fn cantilever(n: [usize; 2], poisson: f64, law: Law, load: f64) -> f64 {
    let mesh = square(n, Order::Quadratic, |s, t| Point::from([10.0 * s, t - 0.5]));
    let held = all_of::<2>(&mesh.nodes_where(|x| x[0] == 0.0));
    let end = mesh.nodes_where(|x| x[0] == 10.0);
    let body = solid(mesh, Frame::Plane, material(law, YOUNG, poisson), held);
    let mut loads = vec![0.0; body.n_components()];
    for node in &end {
        loads[2 * node + 1] = load / end.len() as f64;
    }
    let potential = Potential::at_rest(&body, &[], &loads);
    let found = Minimiser::default().minimise(&potential, &body.at_rest()).expect("it bends");
    println!("{n:?}, nu = {poisson}: {} iterations", found.iterations);
    (found.places[2 * end[0] + 1] + 0.5) / load
}

#[test]
fn a_cantilever_that_keeps_its_volume_does_not_lock() {
    for law in [Law::NeoHookean, Law::SaintVenantKirchhoff] {
        let small = 1e-7;
        let fine = cantilever([80, 8], 0.5, law, small);
        let mixed = cantilever([20, 2], 0.5, law, small) / fine - 1.0;
        let locked = cantilever([20, 2], 0.499_999, law, 10.0 * small) / fine - 1.0;
        println!(
            "{law:?}: {fine:.4}, two cells across: mixed {mixed:+.1e}, places only {locked:+.1e}"
        );
        // The limit of bodies that can nearly not be compressed
        for poisson in [0.49, 0.499] {
            let near = cantilever([80, 8], poisson, law, small) / fine - 1.0;
            println!("nu = {poisson}: {near:+.1e}");
            assert!(near.abs() < 2.0 * (0.5 - poisson), "{near}");
        }
        // And far from straight, in one step
        let coarse = cantilever([40, 4], 0.5, law, 3e-3);
        let bent = coarse / cantilever([80, 8], 0.5, law, 3e-3) - 1.0;
        println!("bent by {:.2}: {bent:+.1e}", 3e-3 * coarse);
        assert!(bent.abs() < 5e-3, "{bent}");
        assert!(mixed.abs() < 2e-2 && locked.abs() > 1.4 * mixed.abs(), "{mixed} {locked}");
    }
}

#[test]
fn linear_cells_and_conservative_steps_cannot_keep_volumes() {
    let mesh = |order| square([2, 2], order, |s, t| Point::from([s, t]));
    let spec =
        solid(mesh(Order::Linear), Frame::Plane, material(Law::NeoHookean, 1.0, 0.4), vec![0]);
    let mut spec = spec.spec().clone();
    spec.materials[0].poisson = 0.5;
    let refused = Solid::new(spec).map(|_| ());
    assert_eq!(refused, Err(SolidError::LinearVolume));
    let mut body =
        solid(mesh(Order::Quadratic), Frame::Plane, material(Law::NeoHookean, 1.0, 0.5), vec![0]);
    let loads = vec![0.0; body.n_components()];
    let given = StepInput {
        scheme: Scheme::Conservative,
        step: 0.01,
        targets: &[],
        loads: &loads,
        held: None,
    };
    let motion = Motion::at_rest(&body);
    let refused = body.advance(&mut Minimiser::default(), &motion, &given).map(|_| ());
    assert_eq!(refused, Err(SolidError::KeptVolume));
    assert!(body.set_moduli(0, 2.0, 0.5).is_ok());
    assert!(body.set_moduli(0, 2.0, 0.4).is_err());
}
