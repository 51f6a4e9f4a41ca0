//! Loads that are given at the ends of a rod.

use nalgebra::{DVector, Rotation2, Vector2};

use super::common::{planar, scatter, unit};
use crate::rod::{Axes, End, EndLoad, EndPose, LoadedEnd, PlanarRodBody, RodProperties, Supports};
use crate::structure::{Flexible, Structure};

fn loaded(end: End, axes: Axes, force: [f64; 2], moment: f64) -> LoadedEnd {
    let load =
        move |time: f64| EndLoad { force: Vector2::from(force) * time, moment: moment * time };
    LoadedEnd { end, axes, load: Box::new(load) }
}

/// The same rod without loads, and with two.
fn pair(axes: Axes) -> [PlanarRodBody; 2] {
    // Loads are differences of forces, which are not to be large
    let soft = || RodProperties { stretching: 1.0, ..unit(3) };
    let two =
        vec![loaded(End::Base, axes, [0.4, -0.2], -0.7), loaded(End::Tip, axes, [-0.3, 0.5], 1.3)];
    [Vec::new(), two].map(|ends| {
        PlanarRodBody::new(planar(soft()), EndPose::default(), Supports::FREE)
            .with_loaded_ends(ends)
    })
}

/// Forces are what does the work at the ends, and tangents their derivatives.
#[test]
fn loads_at_ends_do_their_work_on_places_and_turns() {
    for axes in [Axes::Fixed, Axes::OfSection] {
        work_and_tangents(axes);
    }
}

fn work_and_tangents(axes: Axes) {
    const TIME: f64 = 0.8;
    let [free, loaded] = pair(axes);
    let n = free.n_coordinates();
    let at = free.initial() + scatter(n, 0.3) * 0.1;
    let rates = scatter(n, 0.7);
    let load = |q: &DVector<f64>| free.forces(q, &rates, TIME) - loaded.forces(q, &rates, TIME);
    let power = loaded.inner_power(&at, &rates, TIME).ends;
    assert!((load(&at).dot(&rates) - power).abs() < 1e-12, "{power}");
    // By places and angles of both ends, by differences
    let [before, after] = [-1e-6, 1e-6].map(|by| &at + &rates * by);
    let change = |of: &dyn Fn(&DVector<f64>) -> f64| (of(&after) - of(&before)) / 2e-6;
    let (mut work, mut sum) = (0.0, Vector2::zeros());
    for (first, force, moment) in [(0, [0.4, -0.2], -0.7), (n - 4, [-0.3, 0.5], 1.3)] {
        let angle = move |q: &DVector<f64>| q[first + 3].atan2(q[first + 2]);
        let turn = Rotation2::new(if axes == Axes::Fixed { 0.0 } else { angle(&at) });
        let force = turn * Vector2::from(force) * TIME;
        work += force.dot(&rates.fixed_rows::<2>(first)) + TIME * moment * change(&angle);
        sum += force;
    }
    assert!((work - power).abs() < 1e-8, "{work} {power}");
    let slope = (load(&after) - load(&before)) / 2e-6;
    let tangents = [&free, &loaded].map(|body| body.tangents(&at, &rates, TIME).stiffness);
    let off = (tangents[0].clone() - &tangents[1]) * &rates - slope;
    assert!(off.amax() < 1e-6 * tangents[0].amax(), "{off}");
    let given = loaded.given_load(&at, TIME);
    assert!((given.force.xy() - sum).norm() < 1e-15);
    assert!((given.moment.z - 0.6 * TIME).abs() < 1e-15);
}
