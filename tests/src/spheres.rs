//! Free spheres in a chain that winds up like a helix, each near the next.

use alewife_core::body::{Pose, Wrench};
use alewife_core::coupling::{Problem, RigidBody, Side};
use alewife_core::space::Metric;
use alewife_mesh::spatial::{Body, Domain, Shape, generate};
use alewife_mesh::{BoundaryKind, Mesh, Point, Sizing};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::fluid_only;

/// Turn of the helix from one centre to the next (radians).
const TURN: f64 = std::f64::consts::FRAC_PI_3;
/// Way along its axis (m): six spheres later it has passed one and a half diameters.
const RISE: f64 = 0.55;

/// Spheres of radius one (m) in a box whose walls are two radii away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainOfSpheres {
    /// Number of spheres.
    pub n: usize,
    /// Distance between the surfaces of neighbours (m).
    pub gap: f64,
    /// Edge length of the cells at the spheres (m), less in the gaps.
    pub surface: f64,
}

impl ChainOfSpheres {
    fn centers(self) -> Vec<Point<3>> {
        let chord = 2.0 + self.gap;
        let radius = (chord * chord - RISE * RISE).sqrt() / (2.0 * (0.5 * TURN).sin());
        let at = |index: usize| {
            let index = index as f64;
            let (sine, cosine) = (TURN * index).sin_cos();
            Point::<3>::new(radius * cosine, radius * sine, RISE * index)
        };
        (0..self.n).map(at).collect()
    }

    /// The mesh, with one layer of cells in the gaps.
    ///
    /// # Panics
    /// When there are no spheres, or there is no such mesh.
    #[must_use]
    pub fn mesh(self) -> Mesh<3> {
        let centers = self.centers();
        let corner = |least: fn(&Point<3>, &Point<3>) -> Point<3>| {
            centers.iter().copied().reduce(|a, b| least(&a, &b)).expect("there are spheres")
        };
        let margin = Point::<3>::repeat(3.0);
        let domain =
            Domain::walls(corner(Point::<3>::inf) - margin, corner(Point::<3>::sup) + margin);
        let body = |(index, center): (usize, &Point<3>)| {
            let pose = Isometry3::from(Vector3::from(*center));
            Body::new(&format!("sphere-{index}"), Shape::Sphere { radius: 1.0 }, pose)
        };
        let bodies: Vec<Body> = centers.iter().enumerate().map(body).collect();
        let sizing = Sizing { gap_layers: 1.0, ..Sizing::graded(self.surface, 0.5, 2.0) };
        generate(&domain, &bodies, &sizing).expect("there is a mesh")
    }

    /// Free spheres that sink without inertia.
    #[must_use]
    pub fn problem(self, mesh: &Mesh<3>) -> Problem<3> {
        let wall =
            || Side::Velocity { profile: Box::new(|_, _| Point::<3>::zeros()), is_wall: true };
        let sides = mesh.boundaries.iter().map(|boundary| match boundary.kind {
            BoundaryKind::Body(_) => None,
            _ => Some(wall()),
        });
        let fluid = fluid_only(mesh, sides.collect(), 0.0, 1.0, Metric::Cartesian);
        let load = Wrench { force: Vector3::new(0.3, 0.2, -1.0), torque: Vector3::zeros() };
        let bodies = self.centers().into_iter().zip(&fluid.bodies).map(|(center, body)| {
            let pose = Pose::spatial(center, UnitQuaternion::identity());
            let held = RigidBody::held(body.name.clone(), body.boundary, pose);
            RigidBody { load, ..held.free() }
        });
        Problem { bodies: bodies.collect(), ..fluid }
    }
}
