//! The divergence-free projection: what it makes zero, keeps, and how far it goes.

use alewife_core::coupling::{DivergenceFreeProjection, Problem, Side};
use alewife_core::motion::Transfer;
use alewife_core::space::{Metric, Tables};
use alewife_mesh::{Mesh, Point, Sizing, generate};
use tests::{Study, figure, fluid_only, sides};

use super::transfer::{distance, moved_and_new};
use super::{disc, square, tube};

/// Not free of divergence, with no net flux through the square.
fn any(x: &Point<2>) -> Point<2> {
    Point::<2>::new((1.3 * x.y).sin() + x.x * x.x, (0.7 * x.x).cos() * x.y * x.y)
}

/// The curl of a stream function.
fn curl(x: &Point<2>) -> Point<2> {
    let (sx, cx, sy, cy) =
        ((1.1 * x.x).sin(), (1.1 * x.x).cos(), (0.9 * x.y).sin(), (0.9 * x.y).cos());
    Point::<2>::new(0.9 * sx * cy, -1.1 * cx * sy)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

fn walled(mesh: &Mesh<2>, metric: Metric) -> Problem<2> {
    fluid_only(mesh, sides(mesh, |_, _| Point::<2>::zeros()), 1.0, 1.0, metric)
}

/// Sets problems with walls, an open side, periodic sides, and an axis.
fn problems() -> Vec<(&'static str, Mesh<2>, Problem<2>)> {
    let sizing = Sizing::graded(0.15, 0.2, 0.4);
    let body = [disc("disc", 0.2, 0.1)];
    let closed = generate(&square(false, false), &body, &sizing).unwrap();
    let looped = generate(&square(true, false), &body, &sizing).unwrap();
    let (domain, sphere) = tube(0.2);
    let round = generate(&domain, &[sphere], &sizing).unwrap();
    let enclosed = walled(&closed, Metric::Cartesian);
    let mut open = walled(&closed, Metric::Cartesian);
    open.sides[1] = Some(Side::DoNothing);
    let mut periodic = walled(&looped, Metric::Cartesian);
    periodic.sides[0] = Some(Side::Periodic);
    periodic.sides[1] = Some(Side::Periodic);
    let axial = walled(&round, Metric::Revolved);
    vec![
        ("walls", closed.clone(), enclosed),
        ("open", closed, open),
        ("periodic", looped, periodic),
        ("axis", round, axial),
    ]
}

#[test]
fn the_projection_is_divergence_free_keeps_boundary_values_and_is_one() {
    for (name, mesh, problem) in problems() {
        let periodic_any = |x: &Point<2>| {
            let phase = std::f64::consts::TAU * x.x / 4.0;
            // The radial velocity vanishes on the axis
            Point::<2>::new(phase.cos(), any(x).y)
        };
        let field: Vec<Point<2>> = match name {
            "periodic" | "axis" => mesh.nodes.iter().map(periodic_any).collect(),
            _ => mesh.nodes.iter().map(any).collect(),
        };
        let mut projection = DivergenceFreeProjection::new(&problem, &mesh);
        let before = largest(&projection.defect(&mesh, &field));
        let once = projection.project(&mesh, &field).unwrap();
        let after = largest(&projection.defect(&mesh, &once));
        figure!(after, "{name}: divergence");
        assert!(before > 1e-3 && after < 1e-13, "{name}: {before:.1e} to {after:.1e}");
        for facet in &mesh.facets {
            for node in mesh.facet_nodes(facet) {
                match &problem.sides[facet.boundary] {
                    None | Some(Side::Velocity { .. }) => assert_eq!(once[node], field[node]),
                    Some(Side::Symmetry { normal_axis }) => {
                        assert_eq!(once[node][*normal_axis], field[node][*normal_axis]);
                    }
                    _ => {}
                }
            }
        }
        for pair in &mesh.periodic {
            let [d, e] = [pair.copy, pair.original].map(|node| once[node] - field[node]);
            assert!((d - e).norm() < 1e-15);
        }
        let twice = projection.project(&mesh, &once).unwrap();
        let moved = once.iter().zip(&twice).map(|(one, two)| (one - two).norm());
        assert!(moved.fold(0.0, f64::max) < 1e-12, "{name}");
    }
}

/// Boundary values that are held take momentum from the nearest field along periods, where neither they nor the
/// divergence determine it; it is given back there, and left alone where walls do.
#[test]
fn along_periods_the_projection_has_the_momentum_that_is_asked_for() {
    for (name, mesh, problem) in problems() {
        let wave = |x: &Point<2>| {
            let phase = std::f64::consts::TAU * x.x / 4.0;
            Point::<2>::new(0.4 + phase.cos(), phase.sin() * (4.0 - x.y * x.y))
        };
        let field: Vec<Point<2>> = mesh.nodes.iter().map(wave).collect();
        let mut projection = DivergenceFreeProjection::new(&problem, &mesh);
        let plain = projection.project(&mesh, &field).unwrap();
        let wanted = projection.integral(&mesh, &field);
        let kept = projection.project_with_integral(&mesh, &field, &[], &wanted).unwrap();
        if name != "periodic" {
            assert_eq!(kept, plain, "{name}");
            continue;
        }
        let [before, after] = [&plain, &kept].map(|it| projection.integral(&mesh, it) - wanted);
        println!("{before:?} to {after:?}");
        // Across the channel walls hold it, but for what bent cells let through
        let across = before.y.abs();
        assert!(before.x.abs() > 1e-3, "{before:?}");
        assert!(after.x.abs() < 1e-5 * across + 1e-12, "{before:?} {after:?}");
        assert!((after.y - before.y).abs() < 1e-4 * before.x.abs(), "{before:?} {after:?}");
        assert!(largest(&projection.defect(&mesh, &kept)) < 1e-12);
        for facet in &mesh.facets {
            if !matches!(problem.sides[facet.boundary], Some(Side::Periodic)) {
                mesh.facet_nodes(facet).for_each(|node| assert_eq!(kept[node], field[node]));
            }
        }
    }
}

/// The correction is no larger than a few errors of the transfer and falls as fast.
#[test]
fn the_projection_goes_no_farther_than_the_error_of_the_transfer() {
    let mut ratios = Vec::new();
    let study = Study::run(&[0.2, 0.1, 0.05], |h| {
        let (old, new) = moved_and_new(h);
        let field: Vec<Point<2>> = old.nodes.iter().map(curl).collect();
        let transferred = Transfer::new(&old, &new, &[]).unwrap().quadratic(&field);
        let error = distance(&new, &transferred, curl);
        let mut projection = DivergenceFreeProjection::new(&walled(&new, Metric::Cartesian), &new);
        let projected = projection.project(&new, &transferred).unwrap();
        let correction: Vec<Point<2>> =
            projected.iter().zip(&transferred).map(|(one, two)| one - two).collect();
        let way = distance(&new, &correction, |_| Point::<2>::zeros());
        ratios.push(way / error);
        // Closer to the exact field, which is divergence-free, or hardly farther
        assert!(distance(&new, &projected, curl) < 2.0 * error);
        way
    });
    figure!(ratios[ratios.len() - 1], "correction over error of the transfer");
    assert!(ratios.iter().all(|ratio| *ratio < 2.0), "{ratios:?}");
    study.assert_order("correction", 3.0, 0.3);
}

#[test]
fn a_velocity_that_is_not_finite_is_refused() {
    let (_, mesh, problem) = problems().swap_remove(0);
    let mut field = vec![Point::<2>::zeros(); mesh.n_nodes()];
    let mut projection = DivergenceFreeProjection::new(&problem, &mesh);
    assert_eq!(projection.project(&mesh, &field).unwrap(), field);
    field[mesh.n_nodes() / 2].x = f64::NAN;
    assert!(projection.project(&mesh, &field).is_err());
}

/// Interpolation takes what waves have at the nodes: their energy goes up or down with the first power
/// of its error. The nearest field to what is between the nodes, too, loses it with the second.
#[test]
fn what_is_between_the_nodes_keeps_the_energy_of_waves() {
    let waves = |x: &Point<2>| {
        let (x, y) = (9.0 * x.x, 8.0 * x.y);
        Point::<2>::new(8.0 * x.sin() * y.cos(), -9.0 * x.cos() * y.sin())
    };
    let energy =
        |mesh: &Mesh<2>, field: &[Point<2>]| distance(mesh, field, |_| Point::<2>::zeros()).powi(2);
    let (old, new) = moved_and_new(0.15);
    let tables = Tables::new(Metric::Cartesian);
    let field: Vec<Point<2>> = old.nodes.iter().map(waves).collect();
    let transfer = Transfer::new(&old, &new, &[]).unwrap().with_points(&tables).unwrap();
    let transferred = transfer.quadratic(&field);
    let missed = transfer.missed(&tables, &field, &transferred);
    let mut projection = DivergenceFreeProjection::new(&walled(&new, Metric::Cartesian), &new);
    let without = projection.project(&new, &transferred).unwrap();
    let with = projection.project_with(&new, &transferred, &missed).unwrap();
    assert!(largest(&projection.defect(&new, &with)) < 1e-12 * 9.0);
    let whole = energy(&old, &field);
    let [without, with] = [without, with].map(|field| energy(&new, &field) / whole - 1.0);
    figure!(without, "energy without what is between the nodes");
    figure!(with, "energy with it");
    assert!(with.abs() < 0.4 * without.abs(), "{with:e} {without:e}");
}
