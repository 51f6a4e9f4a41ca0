//! Equilibria in space: bending in two directions, twist, and the same as in the plane.

use nalgebra::{DVector, Rotation3, Vector3};

use super::common::{TWISTING, along_x, at_base, simple};
use crate::dry::{DrySystem, Scaled};
use crate::rod::tests::common::{assert_near, at_rest, cantilever, unit};
use crate::rod::{
    Along, End, EndPose, Flexure, LineForce, SpatialEndPose, SpatialProperties, SpatialRod, Support,
};
use crate::structure::Structure;

#[test]
fn bending_about_each_direction_has_its_stiffness() {
    let flexure = |stiffness: f64| Flexure::passive(Along::Constant(stiffness));
    let bending = [flexure(2.0), flexure(5.0)];
    let properties = SpatialProperties { rod: unit(4), bending, twisting: flexure(1.0) };
    let rod = SpatialRod::new(properties).expect("there is such a rod").clamped(End::Base);
    let load = LineForce::new(&rod, &[0.0; 3], &[0.0, 1e-3, 1e-3]);
    let system = DrySystem::new(&rod, vec![&load], |_| at_base(&rod, Support::Clamped));
    let q = system.equilibrium(along_x(&rod), [0.0, 1.0], 1).expect("there is an equilibrium");
    let tip = rod.place(&q, 1.0);
    // A force along d1 bends about d2
    assert_near(tip.y, 1e-3 / (3.0 * 5.0), 1e-3);
    assert_near(tip.z, 1e-3 / (3.0 * 2.0), 1e-3);
}

#[test]
fn a_rod_in_space_bends_as_one_in_the_plane() {
    let (spatial, flat) = (simple(4).clamped(End::Base), cantilever(unit(4)));
    let weight = Vector3::new(0.0, -3.0, 4.0);
    let load = Scaled {
        load: LineForce::new(&spatial, weight.as_slice(), &[0.0; 3]),
        factor: |time| time,
    };
    let system = DrySystem::new(&spatial, vec![&load], |_| at_base(&spatial, Support::Clamped));
    let q = system.equilibrium(along_x(&spatial), [0.0, 1.0], 4).expect("an equilibrium");
    let in_plane =
        Scaled { load: LineForce::new(&flat, &[0.0, -5.0], &[0.0; 2]), factor: |time| time };
    let held = |_: f64| flat.held(End::Base, Support::Clamped, &EndPose::default());
    let system = DrySystem::new(&flat, vec![&in_plane], held);
    let start = flat.straight(nalgebra::Vector2::zeros(), 0.0);
    let p = system.equilibrium(start, [0.0, 1.0], 4).expect("there is an equilibrium");
    let (tip, expected) = (spatial.place(&q, 1.0), flat.place(&p, 1.0));
    let deflection = tip.dot(&weight) / 5.0;
    assert_near(tip.x, expected.x, 1e-9);
    assert_near(deflection, -expected.y, 1e-9);
    assert_near(spatial.elastic_energy(&q, 0.0), flat.elastic_energy(&p, 0.0), 1e-9);
}

/// Turns the tip of a straight rod about its axis, both ends being clamped.
fn twisted(rod: &SpatialRod, angle: f64) -> DVector<f64> {
    let held = |time: f64| {
        let pose = SpatialEndPose {
            place: Vector3::x(),
            rotation: Rotation3::new(Vector3::x() * (angle * time)),
            ..SpatialEndPose::default()
        };
        [at_base(rod, Support::Clamped), rod.held(End::Tip, Support::Clamped, &pose)].concat()
    };
    let system = DrySystem::new(rod, vec![], held);
    system.equilibrium(along_x(rod), [0.0, 1.0], 8).expect("there is an equilibrium")
}

#[test]
fn twist_has_the_torque_of_its_stiffness() {
    let rod = simple(5).clamped(End::Base).clamped(End::Tip);
    for angle in [0.3, 3.0] {
        let q = twisted(&rod, angle);
        let system = DrySystem::new(&rod, vec![], |_| Vec::new());
        let residual = system.unbalanced(&at_rest(q.clone()));
        let load = rod.end_load(End::Tip, &q, &residual);
        assert_near(load.moment.x, TWISTING * angle, 1e-5);
        let base = rod.end_load(End::Base, &q, &residual);
        assert_near(base.moment.x, -TWISTING * angle, 1e-5);
        assert_near(rod.turning(&q, 0.37).z, angle, 1e-5);
        assert!(load.force.norm() < 1e-9, "{}", load.force);
    }
}
