//! Meshes of typical cases: cells, quality and time, as a table.
//!
//! `cargo run --release -p alewife-mesh --example speed [directory for VTU files]`

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use alewife_mesh::{
    Array, Domain, Locator, PlacedShape, Point, Quality, Shape, SizeField, Sizing, check_mesh,
    generate, write_vtu,
};

/// A domain with its bodies and the sizes asked for.
type Case = (Domain, Vec<PlacedShape>, Sizing);

fn body(name: &str, shape: Shape, x: f64, y: f64, angle: f64) -> PlacedShape {
    PlacedShape { name: name.into(), shape, center: Point::<2>::new(x, y), angle, size: None }
}

fn rectangle(x: [f64; 2], y: [f64; 2], periodic: bool) -> Domain {
    Domain::Box {
        min: Point::<2>::new(x[0], y[0]),
        max: Point::<2>::new(x[1], y[1]),
        periodic_x: periodic,
        periodic_y: periodic,
    }
}

fn cases() -> Vec<(&'static str, Case)> {
    let channel = || rectangle([0.0, 2.2], [0.0, 0.41], false);
    let disc = |r| body("disc", Shape::Disc { radius: r }, 0.2, 0.2, 0.0);
    let sphere = |name, x| body(name, Shape::Sphere { radius: 1.0 }, x, 0.0, 0.0);
    let cylinder = |left: f64| Domain::Cylinder { x: [left, 10.0], radius: 8.0, periodic_x: false };
    let half = |radius| Domain::HalfDisc { center: 0.0, radius };
    let ellipse =
        |a, b, angle| body("ellipse", Shape::Ellipse { semi_axes: [a, b] }, 0.1, -0.2, angle);
    let kidney = || {
        let points = (0..24).map(|i| std::f64::consts::TAU * f64::from(i) / 24.0).map(|t| {
            let r = 1.0 + 0.45 * (2.0 * t).cos();
            [r * t.cos(), r * t.sin()]
        });
        body("kidney", Shape::Spline { points: points.collect() }, 0.0, 0.0, 0.4)
    };
    let layers = |sizing: Sizing, gap_layers| Sizing { gap_layers, ..sizing };
    let g = Sizing::graded;
    let square = || rectangle([-3.0, 3.0], [-3.0, 3.0], false);
    let pair = |gap: f64| vec![sphere("left", -1.0 - 0.5 * gap), sphere("right", 1.0 + 0.5 * gap)];
    vec![
        ("channel", (channel(), vec![disc(0.05)], g(0.01, 0.2, 0.05))),
        ("channel_fine", (channel(), vec![disc(0.05)], g(0.002, 0.05, 0.01))),
        ("empty_box", (rectangle([0.0, 1.0], [0.0, 1.0], false), vec![], g(0.05, 0.2, 0.05))),
        ("wall_0.02", (cylinder(-1.02), vec![sphere("s", 0.0)], layers(g(0.1, 0.2, 1.0), 4.0))),
        ("wall_0.005", (cylinder(-1.005), vec![sphere("s", 0.0)], layers(g(0.1, 0.2, 1.0), 3.0))),
        ("pair_0.05", (half(1000.0), pair(0.05), g(0.1, 0.2, 200.0))),
        ("pair_0.005", (half(1000.0), pair(0.005), layers(g(0.1, 0.2, 200.0), 4.0))),
        ("far_1e4", (half(1e4), vec![sphere("s", 0.0)], g(0.05, 0.2, 1e4))),
        ("ellipse", (square(), vec![ellipse(1.0, 0.3, 0.5)], g(0.08, 0.2, 0.4))),
        ("slender", (square(), vec![ellipse(2.0, 0.05, 0.3)], g(0.08, 0.2, 0.4))),
        (
            "periodic",
            (
                rectangle([-3.0, 3.0], [-3.0, 3.0], true),
                vec![ellipse(2.7, 0.5, 0.0)],
                g(0.1, 0.2, 0.4),
            ),
        ),
        ("spline", (square(), vec![kidney()], g(0.06, 0.2, 0.4))),
        (
            "disc",
            (
                Domain::Disc { center: Point::<2>::zeros(), radius: 5.0 },
                vec![ellipse(1.0, 1.0, 0.0)],
                g(0.1, 0.3, 0.5),
            ),
        ),
        (
            "uniform_100k",
            (rectangle([0.0, 1.0], [0.0, 1.0], false), vec![], g(0.0048, 0.2, 0.0048)),
        ),
        ("graded_100k", (half(1e4), pair(0.1), g(0.005, 0.04, 1e4))),
    ]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1);
    println!(
        "{:>14} {:>7} {:>7} {:>6} {:>6} {:>6} {:>7} {:>6} {:>11} {:>7} {:>8} {:>8}",
        "case",
        "cells",
        "dofs",
        "angle",
        "mean",
        "ratio",
        "meanrat",
        "curvJ",
        "edge/h",
        "in",
        "ms",
        "us/find"
    );
    for (name, (domain, bodies, sizing)) in cases() {
        let start = Instant::now();
        let mesh = match generate(&domain, &bodies, &sizing) {
            Ok(mesh) => mesh,
            Err(error) => {
                println!("{name:>14} {error}");
                continue;
            }
        };
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        if let Err(error) = check_mesh(&mesh) {
            println!("{name:>14} {error}");
        }
        let quality = Quality::of(&mesh);
        // Edge lengths over the wanted size: extremes, and the share between 0.6 and 1.5
        let sizes = SizeField::new(&domain, &bodies, &sizing)?;
        let (mut low, mut high, mut fit, mut all) = (f64::INFINITY, 0.0_f64, 0, 0);
        for cell in mesh.cell_ids() {
            for edge in mesh.cell_edges(cell) {
                let [a, b] = edge.ends.map(|vertex| mesh.nodes[vertex]);
                let relative = (b - a).norm() / sizes.at((a + b) * 0.5);
                low = low.min(relative);
                high = high.max(relative);
                fit += usize::from((0.6..=1.5).contains(&relative));
                all += 1;
            }
        }
        let locator = Locator::new(&mesh);
        let start = Instant::now();
        let found = mesh.nodes.iter().filter(|x| locator.locate(**x).is_some()).count();
        let each = start.elapsed().as_secs_f64() * 1e6 / mesh.n_nodes() as f64;
        assert_eq!(found, mesh.n_nodes());
        println!(
            "{name:>14} {:>7} {:>7} {:>6.1} {:>6.1} {:>6.3} {:>7.4} {:>6.2} {low:>5.2}-{high:<5.2} {:>6.1}% {milliseconds:>8.1} {each:>8.2}",
            quality.n_cells,
            quality.n_dofs,
            quality.min_angle,
            quality.mean_angle,
            quality.min_ratio,
            quality.mean_ratio,
            quality.min_curved_jacobian,
            100.0 * fit as f64 / f64::from(all),
        );
        if let Some(directory) = &directory {
            let file = BufWriter::new(File::create(format!("{directory}/{name}.vtu"))?);
            let x: Vec<f64> = mesh.nodes.iter().map(|p| p.x).collect();
            let both: Vec<f64> = mesh.nodes.iter().flat_map(|p| [p.x, p.y]).collect();
            let number: Vec<f64> = (0..mesh.n_cells()).map(|c| c as f64).collect();
            let arrays = [Array::new("x", 1, &x), Array::new("position", 2, &both)];
            write_vtu(file, &mesh, Some(0.5), &arrays, &[Array::new("cell", 1, &number)])?;
        }
    }
    Ok(())
}
