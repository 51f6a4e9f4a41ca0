//! Contact in space where each answer to a load takes iterations: loads of the law at the gaps they lead to.

use alewife_core::body::{Pose, Wrench};
use alewife_core::contact::{ContactLoads, Law, LawKind, SpatialGaps};
use alewife_core::run::{Attempt, Observer, Snapshot, build_mesh, simulate, simulation_on};
use alewife_mesh::Point;
use alewife_mesh::spatial::{Body, Domain, Shape};
use nalgebra::Isometry3;
use std::io;
use std::sync::{Arc, Mutex};
use tests::cases::case;
use tests::figure;

const RANGE: f64 = 0.15;
const STIFFNESS: f64 = 300.0;

/// Bodies of a step.
#[derive(Debug, Clone)]
struct Seen {
    poses: Vec<Pose>,
    contact: Vec<Wrench>,
    n_unknowns: usize,
}

#[derive(Debug, Default, Clone)]
struct Watch(Arc<Mutex<Vec<Seen>>>);

impl Observer<3> for Watch {
    fn on_step(&mut self, snapshot: &Snapshot<'_, 3>) -> io::Result<()> {
        let bodies = snapshot.bodies;
        self.0.lock().expect("no other thread fails").push(Seen {
            poses: bodies.iter().map(|body| body.pose).collect(),
            contact: bodies.iter().map(|body| body.contact).collect(),
            n_unknowns: snapshot.n_dofs,
        });
        Ok(())
    }
}

/// A chain of an ellipsoid and two spheres pressed against a wall, and far away a sphere against another.
const BODIES: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("ellipsoid", [0.62, 1.0, 1.0], [-4.0, 0.0, 0.0]),
    ("middle", [1.64, 1.1, 1.0], [-9.0, 0.0, 0.0]),
    ("last", [2.6, 0.95, 1.1], [-14.0, 0.0, 0.0]),
    ("far", [4.5, 1.0, 0.55], [0.0, 0.0, -20.0]),
];
const ELLIPSOID: [f64; 3] = [0.5, 0.35, 0.4];
const RADIUS: f64 = 0.42;

fn text() -> String {
    let bodies = BODIES.map(|(name, center, force)| {
        let shape = match name {
            "ellipsoid" => format!("ellipsoid.semi_axes = {ELLIPSOID:?}"),
            _ => format!("sphere.radius = {RADIUS}"),
        };
        format!(
            r#"
            [[body]]
            name = "{name}"
            shape.{shape}
            center = {center:?}
            motion = "free"
            density = 1.5
            force = {force:?}
            "#
        )
    });
    format!(
        r#"
        title = "bodies pressed together"
        geometry = "spatial"
        fluid = {{ model = "navier-stokes", density = 1.0, viscosity = 1.0 }}
        domain.box = {{ min = [0.0, 0.0, 0.0], max = [5.0, 2.0, 2.0] }}
        boundary.left = "no-slip"
        boundary.right = "no-slip"
        boundary.bottom = "no-slip"
        boundary.top = "no-slip"
        boundary.back = "no-slip"
        boundary.front = "no-slip"
        mesh = {{ size = 0.7, surface = 0.3, growth = 0.5, gap_layers = 1 }}
        time.unsteady = {{ step = 0.02, end = 0.16 }}
        contact.barrier = {{ range = {RANGE}, stiffness = {STIFFNESS} }}
        {}
        "#,
        bodies.concat()
    )
}

fn gaps() -> SpatialGaps {
    let shape = |name: &str| match name {
        "ellipsoid" => Shape::Ellipsoid { semi_axes: ELLIPSOID },
        _ => Shape::Sphere { radius: RADIUS },
    };
    let place = |center: [f64; 3]| Isometry3::translation(center[0], center[1], center[2]);
    let bodies = BODIES.map(|(name, center, _)| Body::new(name, shape(name), place(center)));
    let (min, max) = (Point::<3>::zeros(), Point::<3>::new(5.0, 2.0, 2.0));
    let domain = Domain::Box { min, max, periodic: [false; 3], symmetric: [false; 6] };
    SpatialGaps::new(&domain, &bodies, &[Point::<3>::zeros(); 4]).expect("bodies have surfaces")
}

#[test]
fn contact_found_by_a_few_solutions_is_that_of_the_law_at_the_end_of_the_step() {
    let watch = Watch::default();
    simulate::<3>(&case(&text()), &mut [Box::new(watch.clone())]).expect("the case runs");
    let steps = watch.0.lock().expect("no other thread fails").clone();
    let (gaps, law) = (gaps(), Law::new(LawKind::Barrier { stiffness: STIFFNESS }, RANGE).unwrap());
    let mut largest = 0.0f64;
    for seen in &steps[1..] {
        // Factors would give the mobility
        assert!(seen.n_unknowns > 7000, "{}", seen.n_unknowns);
        let of_law = ContactLoads::new(&gaps, &law, &seen.poses);
        let size = of_law.wrenches.iter().map(|w| w.force.norm()).fold(0.0, f64::max);
        for (found, expected) in seen.contact.iter().zip(&of_law.wrenches) {
            let off =
                (found.force - expected.force).norm() + (found.torque - expected.torque).norm();
            largest = largest.max(off / size);
        }
    }
    let last = &steps[steps.len() - 1];
    // All are in contact, and the ellipsoid is turned by it
    assert!(last.contact.iter().all(|contact| contact.force.norm() > 1.0), "{:?}", last.contact);
    assert!(last.contact[0].torque.norm() > 1e-2, "{:?}", last.contact[0]);
    figure!(largest, "largest difference of a force");
    assert!(largest < 1e-5, "{largest}");
}

/// Poses are predicted with what contact changes in a step, and may be off by more with it: else these steps took 25 flows,
/// as most were repeated at the poses they led to. The first ones, from a jump of all forces, still are.
#[test]
fn steps_with_contact_are_not_repeated() {
    let model = case(&text());
    let mesh = build_mesh::<3>(&model).expect("it is meshed");
    let mut simulation = simulation_on(&model, mesh).expect("the case is a problem");
    // Contact is resolved in time: what is repeated for that is no step
    let (mut size, mut steps, mut flows) = (0.02, 0, 0);
    while steps < 12 {
        match simulation.try_step(size, f64::INFINITY).expect("the step can be made") {
            Attempt::Made(report) => {
                (steps, flows) = (steps + 1, flows + report.iterations);
                size = f64::min(1.5 * size, 0.02);
            }
            Attempt::Rejected(_) => size *= 0.5,
        }
        assert!(size > 1e-3, "{size}");
    }
    assert!(simulation.state.contact.contacts.len() >= 3, "{:?}", simulation.state.contact);
    figure!(f64::from(u32::try_from(flows).expect("few flows")), "flows in 12 steps");
    // One iteration for the poses a step but the first few, from a jump of all forces, whose poses cannot be predicted
    assert!(flows <= 16, "{flows}");
}
