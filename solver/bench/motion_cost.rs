//! What it costs to move, judge and replace a mesh with 10^5 nodes: CPU seconds as a table.
//!
//! `cargo bench --bench motion_cost`

use alewife_core::body::Pose;
use alewife_core::motion::{
    Fresh, Limits, MeshMotion, MotionKind, RigidMove, Stiffening, Transfer,
    mesh_boundary_conditions, needs_remesh,
};
use alewife_core::timing::cpu_seconds;
use alewife_mesh::{Domain, GapQuery, Locator, PlacedShape, Point, Shape, Sizing, generate};

fn timed<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let start = cpu_seconds();
    let result = run();
    println!("{what:>36} {:>8.4} s", cpu_seconds() - start);
    result
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (min, max) = (Point::<2>::new(-2.0, -2.0), Point::<2>::new(2.0, 2.0));
    let domain = Domain::Box { min, max, periodic_x: false, periodic_y: false };
    let disc = PlacedShape {
        name: "disc".into(),
        shape: Shape::Disc { radius: 0.5 },
        center: Point::<2>::zeros(),
        angle: 0.0,
        size: None,
    };
    let sizing = Sizing::graded(0.008, 0.1, 0.03);
    let mesh = timed("mesh", || generate(&domain, std::slice::from_ref(&disc), &sizing))?;
    println!("{:>36} {:>8}", "nodes", mesh.n_nodes());
    let rigid = RigidMove::between(&Pose::planar(0.0, 0.0, 0.0), &Pose::planar(0.3, 0.1, 0.4));
    let mut moved = mesh.clone();
    for (name, kind) in [
        ("harmonic", MotionKind::Harmonic(Stiffening::Distance { exponent: 0.5 })),
        ("elastic", MotionKind::default()),
    ] {
        let held = mesh_boundary_conditions(&mesh, false);
        let motion = timed(&format!("{name}: factorise"), || MeshMotion::new(&mesh, kind, &held))?;
        println!("{:>36} {:>8}", "entries of the factor", motion.n_entries());
        timed(&format!("{name}: move"), || {
            motion.move_nodes(&mut moved, &|_, _, x| rigid.displacement(x))
        })?;
    }
    let mut around = GapQuery::new(&domain, std::slice::from_ref(&disc))?;
    let fresh = timed("measure the new mesh", || Fresh::new(&mesh, &around, Limits::default()));
    let carried = rigid.carry(&disc);
    around.place_body(0, carried.center, carried.angle);
    let reason = timed("does it need a new one?", || needs_remesh(&moved, &fresh, &around));
    println!("{:>36} {reason:?}", "");
    let new = timed("new mesh", || generate(&domain, &[carried], &sizing))?;
    timed("tree of its cells", || Locator::new(&moved));
    let transfer = timed("find all nodes, tree included", || Transfer::new(&moved, &new, &[]))
        .ok_or("the meshes are finite")?;
    timed("transfer a velocity", || transfer.quadratic(&mesh.nodes));
    println!("{:>36} {:?}", "", transfer.report());
    Ok(())
}
