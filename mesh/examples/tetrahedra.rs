//! Meshes of typical cases in space: cells, quality and time, as a table.
//!
//! `cargo run --release -p alewife-mesh --example tetrahedra [name [scale of all sizes]]`

use alewife_mesh::spatial::{Body, BodySurface, Centreline, Domain, Part, Shape, generate};
use alewife_mesh::{Mesh, Point, Quality, Sizing, Surface, check_mesh, map_quadratic};
use nalgebra::{Isometry3, UnitQuaternion};
use rustix::time::{ClockId, clock_gettime};
use tail::flagellate;

#[path = "../tests/common/tail.rs"]
mod tail;

/// A domain with its bodies and the sizes asked for.
type Case = (Domain, Vec<Body>, Sizing<3>);

fn surface(body: &Body) -> BodySurface {
    BodySurface::new(body).expect("a body has a surface")
}

fn sphere(name: &str, radius: f64, x: f64, y: f64, z: f64) -> Body {
    Body::new(name, Shape::Sphere { radius }, Isometry3::translation(x, y, z))
}

/// An ellipsoidal head with a helical tail.
fn swimmer(turns: f64) -> Body {
    let head = Shape::Ellipsoid { semi_axes: [0.6, 0.35, 0.3] };
    let helix = Centreline::Helix { radius: 0.3, pitch: 1.0, turns };
    let tail = Shape::Tube { centreline: helix, radius: 0.05 };
    let turn = UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1);
    let mut body = Body::new("swimmer", tail, Isometry3::from_parts([-1.2, 0.0, 0.0].into(), turn));
    body.parts.insert(0, Part { shape: head, pose: Isometry3::translation(-0.55, 0.3, 0.0) });
    body
}

fn cube(half: f64) -> Domain {
    Domain::walls(Point::<3>::repeat(-half), Point::<3>::repeat(half))
}

fn cases() -> Vec<(String, Case)> {
    let sizing = |surface, size| Sizing { gap_layers: 2.0, ..Sizing::graded(surface, 0.3, size) };
    let tube = |radius, half: f64| Domain::Cylinder { x: [-half, half], radius };
    let above = Domain::walls(Point::<3>::new(-5.0, -5.0, 0.0), Point::<3>::new(5.0, 5.0, 8.0));
    let mut cases = vec![
        (
            "tube".into(),
            (tube(5.0, 10.0), vec![sphere("s", 1.0, 0.0, 0.0, 0.0)], sizing(0.15, 0.8)),
        ),
        ("cylinder".into(), (tube(1.0, 1.0), vec![], sizing(0.15, 0.15))),
        ("box".into(), (cube(0.5), vec![], sizing(0.1, 0.1))),
        ("box_1_50".into(), (cube(15.0), vec![sphere("s", 0.3, 0.0, 0.0, 0.0)], sizing(0.05, 2.5))),
        (
            "sphere_in_sphere".into(),
            (
                Domain::Ball { center: Point::<3>::zeros(), radius: 5.0 },
                vec![sphere("s", 1.0, 0.5, 0.2, -0.3)],
                sizing(0.15, 0.8),
            ),
        ),
    ];
    for (name, turns) in [("swimmer_1.5", 1.5), ("swimmer_3", 3.0)] {
        cases.push((name.into(), (cube(4.0), vec![swimmer(turns)], sizing(0.1, 0.8))));
    }
    for gap in [0.05, 0.02, 0.01, 0.005] {
        let at = 1.0 + 0.5 * gap;
        let two = vec![sphere("a", 1.0, -at, 0.0, 0.0), sphere("b", 1.0, at, 0.0, 0.0)];
        cases.push((format!("two_{gap}"), (cube(5.0), two, sizing(0.2, 0.8))));
        let one = vec![sphere("s", 1.0, 0.0, 0.0, 1.0 + gap)];
        cases.push((format!("wall_{gap}"), (above.clone(), one, sizing(0.2, 0.8))));
    }
    let channel = Domain::Cylinder { x: [-10.0, 85.0], radius: 7.5 };
    let graded = |surface, growth, layers, turn| {
        let sizing = Sizing::graded(surface, growth, 3.0);
        Sizing { gap_layers: layers, turn, ..sizing }
    };
    let stout = graded(0.225, 0.795, 4.0 / 1.5, 0.75);
    let thin = graded(0.3, 0.6, 2.0, 1.0);
    for phase in [0.0, 0.3, 0.7] {
        let stout = (channel.clone(), vec![flagellate([50.0, 0.5], phase)], stout.clone());
        cases.push((format!("stout_{phase}"), stout));
        let thin = (channel.clone(), vec![flagellate([50.0, 0.2], phase)], thin.clone());
        cases.push((format!("tail_{phase}"), thin));
        let end = Domain::Cylinder { x: [10.0, 45.0], radius: 7.5 };
        let short = (end, vec![flagellate([12.0, 0.2], phase)], graded(0.3, 0.6, 2.0, 1.0));
        cases.push((format!("short_{phase}"), short));
    }
    cases.push(("many".into(), twenty()));
    cases
}

/// Twenty spheres in a periodic box, in no order.
fn twenty() -> Case {
    let length = 9.427;
    let domain = Domain::Box {
        min: Point::<3>::zeros(),
        max: Point::<3>::repeat(length),
        periodic: [true; 3],
        symmetric: [false; 6],
    };
    // A sequence of low discrepancy, without those that would overlap
    let part = |i: u32, k: f64| (f64::from(i) * k).fract() * length;
    let mut places: Vec<Point<3>> = Vec::new();
    for i in 0..4000 {
        let place = Point::<3>::new(part(i, 0.819_173), part(i, 0.671_044), part(i, 0.549_700));
        let is_free = places.iter().all(|other| {
            let off = (place - other).map(|x| x - length * (x / length).round());
            off.norm() > 2.2
        });
        if is_free && places.len() < 20 {
            places.push(place);
        }
    }
    let bodies =
        places.iter().enumerate().map(|(i, p)| sphere(&format!("s{i}"), 1.0, p.x, p.y, p.z));
    (domain, bodies.collect(), Sizing { gap_layers: 1.0, ..Sizing::graded(0.5, 0.5, 1.5) })
}

/// Largest distance of the curved facets of bodies from their surfaces, over the radius of curvature.
fn surface_error(mesh: &Mesh<3>, n_sides: usize, bodies: &[Body]) -> f64 {
    let surfaces: Vec<BodySurface> = bodies.iter().map(surface).collect();
    let corner =
        |local: usize| Point::<3>::from_fn(|axis, _| f64::from(u8::from(axis + 1 == local)));
    let mut worst = 0.0_f64;
    for facet in mesh.facets.iter().filter(|facet| facet.boundary.index() >= n_sides) {
        let surface = &surfaces[facet.boundary.index() - n_sides];
        let [a, b, c] =
            alewife_mesh::Simplex::<3>::facet_vertices(usize::from(facet.side)).map(corner);
        let nodes = mesh.cell_nodes(facet.cell);
        for i in 0..=4 {
            for j in 0..=4 - i {
                let at = (a * f64::from(i) + b * f64::from(j) + c * f64::from(4 - i - j)) / 4.0;
                let point = map_quadratic(&nodes, at.into()).position;
                let gap = surface.nearest_point(point).gap.abs();
                worst = worst.max(gap / surface.radius_of_curvature(point));
            }
        }
    }
    worst
}

fn cpu_seconds() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

fn main() {
    let wanted = std::env::args().nth(1);
    let scale: f64 = std::env::args().nth(2).and_then(|scale| scale.parse().ok()).unwrap_or(1.0);
    println!(
        "{:>18} {:>8} {:>7} {:>6} {:>6} {:>7} {:>7} {:>8} {:>7}",
        "case", "cells", "CPU s", "angle", "ratio", "meanrat", "curvJ", "error", "us/cell"
    );
    for (name, (domain, bodies, mut sizing)) in cases() {
        if wanted.as_ref().is_some_and(|wanted| !name.starts_with(wanted.as_str())) {
            continue;
        }
        sizing.surface *= scale;
        sizing.size *= scale;
        sizing.gap_layers /= scale;
        let start = cpu_seconds();
        let mesh = match generate(&domain, &bodies, &sizing) {
            Ok(mesh) => mesh,
            Err(error) => {
                println!("{name:>18} {error}");
                continue;
            }
        };
        let seconds = cpu_seconds() - start;
        if let Err(error) = check_mesh(&mesh) {
            println!("{name:>18} {error}");
        }
        let quality = Quality::of(&mesh);
        println!(
            "{name:>18} {:>8} {seconds:>7.2} {:>6.1} {:>6.3} {:>7.4} {:>7.3} {:>8.1e} {:>7.1}",
            quality.n_cells,
            quality.min_angle,
            quality.min_ratio,
            quality.mean_ratio,
            quality.min_curved_jacobian,
            surface_error(&mesh, domain.sides().len(), &bodies),
            1e6 * seconds / quality.n_cells as f64,
        );
    }
}
