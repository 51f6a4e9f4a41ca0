//! Slender bodies against the elastica and the theory of beams.

use alewife_mesh::Point;
use alewife_solid::material::Law;
use alewife_solid::solid::{Frame, Minimiser, Order, Potential, Solid};

use crate::meshes::{material, solid, square};

const THICKNESS: f64 = 0.01;

/// A strip of length one along x, held at x = 0 so that its section there stays plane and may become thinner.
fn strip(n: usize, poisson: f64) -> Solid<2> {
    let mesh = square([n, 2], Order::Quadratic, |s, t| Point::from([s, THICKNESS * (t - 0.5)]));
    let mut held: Vec<usize> = mesh.nodes_where(|x| x[0] == 0.0).iter().map(|n| 2 * n).collect();
    held.extend(mesh.nodes_where(|x| x[0] == 0.0 && x[1] == 0.0).iter().map(|n| 2 * n + 1));
    solid(mesh, Frame::Plane, material(Law::NeoHookean, 1e6, poisson), held)
}

/// B = E t^3/(12 (1 - nu^2)) of a wide strip.
fn bending_stiffness(poisson: f64) -> f64 {
    1e6 * THICKNESS.powi(3) / (12.0 * (1.0 - poisson * poisson))
}

/// The end of an elastica of length one that is clamped along x and loaded across x: theta'' = -p cos theta,
/// with theta' = 0 at the loaded end, by bisection for the curvature at the clamp.
fn elastica(load: f64) -> [f64; 2] {
    let integrate = |start: f64| {
        let n = 2000;
        let h = 1.0 / f64::from(n);
        let rate = |y: [f64; 4]| [y[1], -load * y[0].cos(), y[0].cos(), y[0].sin()];
        let mut y = [0.0, start, 0.0, 0.0];
        for _ in 0..n {
            let add = |y: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
            let k1 = rate(y);
            let k2 = rate(add(y, k1, 0.5 * h));
            let k3 = rate(add(y, k2, 0.5 * h));
            let k4 = rate(add(y, k3, h));
            y = std::array::from_fn(|i| {
                y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])
            });
        }
        y
    };
    let (mut low, mut high) = (0.0, load);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if integrate(middle)[1] > 0.0 { high = middle } else { low = middle }
    }
    let end = integrate(low);
    [end[2], end[3]]
}

#[test]
fn a_strip_under_a_heavy_end_load_is_the_elastica() {
    // Of @mattiasson1981, to five digits
    let published = elastica(5.0);
    assert!((published[0] - (1.0 - 0.38763)).abs() < 1e-5, "{published:?}");
    assert!((published[1] - 0.71379).abs() < 1e-5, "{published:?}");
    for poisson in [0.3, 0.5] {
        bends_as_the_elastica(poisson);
    }
}

fn bends_as_the_elastica(poisson: f64) {
    let body = strip(60, poisson);
    let mut state = body.at_rest();
    for load in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0] {
        let mut loads = vec![0.0; body.n_components()];
        let total = load * bending_stiffness(poisson);
        let end =
            body.spec().mesh.facets.iter().filter(|facet| {
                facet.nodes.iter().all(|node| body.spec().mesh.nodes[*node][0] == 1.0)
            });
        for facet in end {
            for (node, part) in facet.nodes.iter().zip([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) {
                loads[2 * node + 1] += 0.5 * total * part;
            }
        }
        let potential = Potential::at_rest(&body, &[], &loads);
        let minimum = Minimiser::default().minimise(&potential, &state).expect("it bends");
        state.clone_from(&minimum.places);
        let tip = body.spec().mesh.nodes_where(|x| x[0] == 1.0 && x[1] == 0.0)[0];
        let exact = elastica(load);
        for i in 0..2 {
            let error = minimum.places[2 * tip + i] / exact[i] - 1.0;
            println!(
                "nu {poisson} load {load} axis {i} {error:+.2e} in {} iterations",
                minimum.iterations
            );
            assert!(error.abs() < 1e-3, "{load} {i} {error}");
        }
    }
}

#[test]
fn a_cantilever_has_the_frequencies_of_a_beam() {
    for poisson in [0.3, 0.5] {
        swings_as_a_beam(poisson);
    }
}

fn swings_as_a_beam(poisson: f64) {
    let body = strip(40, poisson);
    let found = {
        let none = vec![0.0; body.n_components()];
        body.frequencies(&body.at_rest(), &[], &none, 2)
    };
    let found = found.expect("it has modes");
    let speed = (bending_stiffness(poisson) / (1e3 * THICKNESS)).sqrt();
    for (found, wave) in found.iter().zip([1.875_104_068_711_961, 4.694_091_132_974_175_f64]) {
        let error = found / (wave * wave * speed) - 1.0;
        println!("{error:+.2e}");
        assert!(error.abs() < 1e-3, "{error}");
    }
}
