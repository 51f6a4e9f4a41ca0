//! Orders of convergence against made solutions, in the plane, around the axis and in space.

use alewife_mesh::Point;
use alewife_solid::material::{Law, Material, Principal, Tensor};
use alewife_solid::solid::{Frame, Minimiser, Order, Potential, Solid, SolidMesh};

use crate::meshes::{all_of, cube, material, moved, solid, square, surface};

const MATERIAL: Material =
    Material { law: Law::NeoHookean, young: 1.0, poisson: 0.3, density: 1e3, viscosity: 0.0 };

/// The made deformation: smooth, and no polynomial; around the axis its radius vanishes there.
fn made<const D: usize>(x: &Point<D>, frame: Frame) -> Point<D> {
    let mut y = *x;
    y[0] += 0.1 * (2.0 * x[1]).sin() * x[0];
    y[1] += 0.1 * x[1] * (1.5 * x[0]).cos();
    if frame == Frame::Axis {
        y[0] = x[0] + 0.1 * (x[1] * x[1]).sin() * x[0];
    }
    if D == 3 {
        y[2] += 0.1 * (x[2] + x[0]).sin();
    }
    y
}

/// Its gradient, by central differences so small that their error does not show.
fn gradient<const D: usize>(x: &Point<D>, frame: Frame) -> Tensor {
    let h = 1e-4;
    let mut f = Tensor::identity();
    for j in 0..D {
        let at = |by: f64| {
            let mut moved = *x;
            moved[j] += by;
            made(&moved, frame)
        };
        // Fourth order
        let slope =
            (at(h) - at(-h)) * (8.0 / (12.0 * h)) - (at(2.0 * h) - at(-2.0 * h)) / (12.0 * h);
        for i in 0..D {
            f[(i, j)] = slope[i];
        }
    }
    if frame == Frame::Axis {
        f[(2, 2)] = if x[1].abs() > 1e-9 { made(x, frame)[1] / x[1] } else { f[(1, 1)] };
    }
    f
}

fn stress<const D: usize>(x: &Point<D>, frame: Frame) -> Tensor {
    let principal = Principal::of(&gradient(x, frame)).expect("it is not turned over");
    principal.stress(MATERIAL.law, MATERIAL.lame())
}

/// The force a volume that holds the made deformation: -Div P.
fn force<const D: usize>(x: &Point<D>, frame: Frame) -> Point<D> {
    let h = 1e-3;
    let mut force = Point::zeros();
    for j in 0..D {
        let at = |by: f64| {
            let mut moved = *x;
            moved[j] += by;
            stress(&moved, frame)
        };
        let slope =
            (at(h) - at(-h)) * (8.0 / (12.0 * h)) - (at(2.0 * h) - at(-2.0 * h)) / (12.0 * h);
        for i in 0..D {
            force[i] -= slope[(i, j)];
        }
    }
    if frame == Frame::Axis && x[1] > 1e-9 {
        let p = stress(x, frame);
        force[0] -= p[(0, 1)] / x[1];
        force[1] -= (p[(1, 1)] - p[(2, 2)]) / x[1];
    }
    force
}

fn error<const D: usize>(mesh: SolidMesh<D>, frame: Frame) -> f64 {
    let exact = moved(&mesh, |x| made(x, frame));
    let held = all_of::<D>(&surface(&mesh));
    let body: Solid<D> = solid(mesh, frame, MATERIAL, held);
    let density = MATERIAL.density;
    let acceleration = moved(&body.spec().mesh, |x| force(x, frame) / density);
    let loads = body.times_mass(&acceleration);
    let potential = Potential::at_rest(&body, &[], &loads);
    let minimum =
        Minimiser::default().minimise(&potential, &exact).expect("there is an equilibrium");
    let apart: Vec<f64> = minimum.places.iter().zip(&exact).map(|(x, y)| x - y).collect();
    let squares: f64 = body.times_mass(&apart).iter().zip(&apart).map(|(m, e)| m * e).sum();
    (squares / density).sqrt()
}

#[test]
fn places_converge_by_the_order_of_the_cells() {
    for (order, expected) in [(Order::Linear, 2.0), (Order::Quadratic, 3.0)] {
        for frame in [Frame::Plane, Frame::Axis] {
            let of = |n: usize| {
                let first = if frame == Frame::Axis { 0.3 } else { 0.0 };
                error(square([n, n], order, |s, t| Point::from([s, first + t])), frame)
            };
            let (coarse, fine) = (of(6), of(12));
            let found = (coarse / fine).log2();
            println!("{frame:?} {order:?} {fine:.2e} {found:.2}");
            assert!(found > expected - 0.25, "{frame:?} {order:?} {found}");
        }
        let of = |n: usize| error(cube([n, n, n], order, |x| x), Frame::Space);
        let (coarse, fine) = (of(4), of(8));
        let found = (coarse / fine).log2();
        println!("space {order:?} {fine:.2e} {found:.2}");
        assert!(found > expected - 0.35, "space {order:?} {found}");
    }
}

#[test]
fn a_thick_cylinder_under_its_axis_is_lame_s() {
    // Small displacements a r + b/r between held cylinders, without motion along the axis
    let of = |n: usize| {
        let mesh = square([2, n], Order::Quadratic, |s, t| Point::from([0.2 * s, 0.5 + t]));
        let small = 1e-6;
        let exact = moved(&mesh, |x| Point::from([x[0], x[1] + small * (x[1] - 0.75 / x[1])]));
        let mut held: Vec<usize> = (0..mesh.nodes.len()).map(|node| 2 * node).collect();
        let walls = mesh.nodes_where(|x| (x[1] - 0.5).abs() < 1e-9 || (x[1] - 1.5).abs() < 1e-9);
        held.extend(walls.iter().map(|node| 2 * node + 1));
        let body = solid(mesh, Frame::Axis, material(Law::NeoHookean, 1.0, 0.3), held);
        let none = vec![0.0; exact.len()];
        let minimum = Minimiser::with_tolerance(1e-13)
            .minimise(&Potential::at_rest(&body, &[], &none), &exact)
            .expect("there is an equilibrium");
        let worst = minimum.places.iter().zip(&exact).map(|(x, y)| (x - y).abs() / small);
        worst.fold(0.0, f64::max)
    };
    let (coarse, fine) = (of(8), of(16));
    println!("{coarse:.2e} {fine:.2e}");
    assert!(fine < 1e-3 && coarse / fine > 5.0, "{coarse} {fine}");
}
