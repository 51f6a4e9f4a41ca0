//! Fields from mesh to mesh: exact where they can be, of third order where not.

use alewife_core::body::Pose;
use alewife_core::motion::{
    Landing, MeshMotion, MotionKind, RigidMove, Transfer, mesh_boundary_conditions,
};
use alewife_core::space::{CellValues, Metric, Tables};
use alewife_mesh::{Domain, Mesh, Point, Sizing, generate};
use tests::Study;

use super::{disc, disc_in_square, square};

fn sample(mesh: &Mesh<2>, field: impl Fn(&Point<2>) -> Point<2>) -> Vec<Point<2>> {
    mesh.nodes.iter().map(field).collect()
}

/// L2 norm of a quadratic field less a function.
pub fn distance(mesh: &Mesh<2>, field: &[Point<2>], exact: impl Fn(&Point<2>) -> Point<2>) -> f64 {
    let (tables, mut workspace) = (Tables::new(Metric::Cartesian), CellValues::default());
    let mut sum = 0.0;
    for cell in mesh.cell_ids() {
        let nodes = mesh.cell(cell);
        workspace.for_each_point(&tables, mesh, cell, |at| {
            let value = nodes.iter().zip(at.phi).map(|(&node, phi)| field[node] * *phi);
            sum += at.dx * (value.sum::<Point<2>>() - exact(&at.position)).norm_squared();
        });
    }
    sum.sqrt()
}

fn smooth(x: &Point<2>) -> Point<2> {
    Point::<2>::new((1.3 * x.x).sin() * (0.9 * x.y).cos(), (0.7 * x.x + x.y).cos())
}

/// The mesh around a disc that has moved to (0.3, 0.1), and a new one for it there.
pub fn moved_and_new(h: f64) -> (Mesh<2>, Mesh<2>) {
    let mesh = disc_in_square(h, 2.0 * h);
    let motion =
        MeshMotion::new(&mesh, MotionKind::default(), &mesh_boundary_conditions(&mesh, false))
            .unwrap();
    let rigid = RigidMove::between(&Pose::planar(0.0, 0.0, 0.0), &Pose::planar(0.3, 0.1, 0.37));
    let mut moved = mesh;
    motion.move_nodes(&mut moved, &|_, _, x| rigid.displacement(x)).unwrap();
    let sizing = Sizing::graded(h, 0.2, 2.0 * h);
    let new = generate(&square(false, false), &[disc("disc", 0.3, 0.1)], &sizing).unwrap();
    (moved, new)
}

#[test]
fn a_mesh_gives_itself_what_it_has() {
    let (mesh, _) = moved_and_new(0.15);
    let transfer = Transfer::new(&mesh, &mesh, &[]).unwrap();
    assert!(transfer.landings().all(|landing| landing == Landing::Inside));
    let field = sample(&mesh, smooth);
    for (value, wanted) in transfer.quadratic(&field).iter().zip(&field) {
        assert!((value - wanted).norm() < 1e-13);
    }
    let pressure: Vec<f64> = field[..mesh.n_vertices].iter().map(|v| v.x).collect();
    for (value, wanted) in transfer.linear(&pressure).iter().zip(&pressure) {
        assert!((value - wanted).abs() < 1e-13);
    }
}

#[test]
fn quadratic_and_linear_fields_are_exact_on_straight_cells() {
    let quadratic = |x: &Point<2>| {
        Point::<2>::new(x.x * x.x - 3.0 * x.x * x.y + 1.0, 2.0 * x.y * x.y - x.x + 0.5)
    };
    let mesh = |h| generate(&square(false, false), &[], &Sizing::graded(h, 0.2, h)).unwrap();
    let (old, new) = (mesh(0.3), mesh(0.17));
    let transfer = Transfer::new(&old, &new, &[]).unwrap();
    let moved = transfer.quadratic(&sample(&old, quadratic));
    for (value, place) in moved.iter().zip(&new.nodes) {
        assert!((value - quadratic(place)).norm() < 1e-12);
    }
    let linear = |x: &Point<2>| 2.0 * x.x - 0.3 * x.y + 0.7;
    let pressure: Vec<f64> = old.nodes[..old.n_vertices].iter().map(linear).collect();
    for (value, place) in transfer.linear(&pressure).iter().zip(&new.nodes) {
        assert!((value - linear(place)).abs() < 1e-12);
    }
}

/// Two meshes of the same round container.
fn containers(h: f64) -> (Mesh<2>, Mesh<2>) {
    let domain = Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 };
    let mesh = |h| generate(&domain, &[], &Sizing::graded(h, 0.2, h)).unwrap();
    (mesh(h), mesh(0.83 * h))
}

/// Quadratic sides lie inside the circle they approximate: around a disc all new nodes are in the
/// old mesh, in a round container those on the wall are outside by the fourth-order error.
#[test]
fn smooth_fields_are_transferred_with_third_order() {
    for (name, meshes) in
        [("disc", moved_and_new as fn(f64) -> (Mesh<2>, Mesh<2>)), ("container", containers)]
    {
        let study = Study::run(&[0.2, 0.1, 0.05], |h| {
            let (old, new) = meshes(h);
            let transfer = Transfer::new(&old, &new, &[]).unwrap();
            let report = transfer.report();
            println!("{name} {h}: {report:?}");
            assert_eq!(report.extrapolated > 10, name == "container");
            assert!(report.clamped == 0 && report.farthest < 0.01 * h.powi(4));
            distance(&new, &transfer.quadratic(&sample(&old, smooth)), smooth)
        });
        study.assert_order(name, 3.0, 0.2);
    }
}

#[test]
fn nodes_outside_are_extrapolated_near_the_mesh_and_clamped_far_away() {
    let wide = Domain::Disc { center: Point::<2>::zeros(), radius: 1.0 };
    let wider = Domain::Disc { center: Point::<2>::zeros(), radius: 1.4 };
    let old = generate(&wide, &[], &Sizing::graded(0.1, 0.2, 0.1)).unwrap();
    let new = generate(&wider, &[], &Sizing::graded(0.1, 0.2, 0.1)).unwrap();
    let transfer = Transfer::new(&old, &new, &[]).unwrap();
    let report = transfer.report();
    assert!(report.clamped > 100 && (report.farthest - 0.4).abs() < 1e-3, "{report:?}");
    let farthest = new.nodes[report.farthest_node.unwrap()];
    assert!((farthest.norm() - 1.4).abs() < 1e-12);
    // Clamping keeps the values bounded by the mesh's own, far from an extrapolation by four cells
    let steep = |x: &Point<2>| Point::<2>::new(x.x.powi(2), (8.0 * x.y).sin());
    for value in transfer.quadratic(&sample(&old, steep)) {
        assert!(value.amax() < 1.6, "{value}");
    }
    let mut broken = new.clone();
    broken.nodes[3].x = f64::NAN;
    assert!(Transfer::new(&old, &broken, &[]).is_none());
}

/// The sides of a periodic mesh move with the bodies; a new mesh has straight ones again.
#[test]
fn nodes_beyond_a_periodic_side_are_found_at_their_image() {
    let (domain, sizing) = (square(true, false), Sizing::graded(0.15, 0.2, 0.3));
    let periodic = |x: &Point<2>| {
        let phase = std::f64::consts::TAU * x.x / 4.0;
        Point::<2>::new(phase.sin(), phase.cos() * x.y)
    };
    let old = generate(&domain, &[disc("disc", 0.0, 0.2)], &sizing).unwrap();
    let motion =
        MeshMotion::new(&old, MotionKind::default(), &mesh_boundary_conditions(&old, false))
            .unwrap();
    let mut moved = old.clone();
    motion.move_nodes(&mut moved, &|_, _, _| Point::<2>::new(0.6, 0.0)).unwrap();
    let new = generate(&domain, &[disc("disc", 0.6, 0.2)], &sizing).unwrap();
    let without = Transfer::new(&moved, &new, &[]).unwrap().report();
    assert!(without.farthest > 0.1, "{without:?}");
    let transfer = Transfer::new(&moved, &new, &domain.images()).unwrap();
    assert!(transfer.report().farthest < 1e-4, "{:?}", transfer.report());
    let values = transfer.quadratic(&sample(&moved, periodic));
    assert!(distance(&new, &values, periodic) < 3e-3);
}
