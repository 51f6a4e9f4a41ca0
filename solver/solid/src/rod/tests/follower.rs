//! A clamped rod under a force at its tip that turns with it, in the drag of resistive theory.
//!
//! Small motions obey zeta y_t = -B y_ssss - F y_ss, with y = y_s = 0 at the base and y_ss = y_sss = 0 at the tip: Beck's column
//! (@bigoni2024) with drag in place of inertia. Polynomials to the degree 30 on this equation (own computation) give the
//! loads and rates below; the determinant of its four exponentials vanishes at them.

use nalgebra::{Complex, DMatrix, DVector, Vector2};

use super::common::{along_x, assert_near, at_rest, cantilever, unit};
use crate::dry::{DrySystem, Motion};
use crate::rod::{
    Along, Axes, End, EndLoad, EndPose, LoadedEnd, PlanarRodBody, Resistance, RodProperties,
    Support, Supports,
};
use crate::structure::{Load, Structure};

/// F L^2 / B from which on the rod flutters.
const CRITICAL: f64 = 37.695_431;
/// Its angular velocity there, by zeta L^4 / B.
const FLUTTER: f64 = 191.258_64;
/// F L^2 / B at which two motions without oscillation become one with it.
const MEET: f64 = 20.050_954;

/// Under a force against the tangent, with the drag one across and one half along.
struct Follower {
    force: f64,
    body: PlanarRodBody,
    drag: Resistance,
}

impl Follower {
    fn new(elements: usize, force: f64) -> Self {
        let rod = cantilever(RodProperties { mass: Along::Constant(0.0), ..unit(elements) });
        let drag = Resistance::new(&rod, 0.5, 1.0);
        let load = move |_| EndLoad { force: Vector2::new(-force, 0.0), moment: 0.0 };
        let tip = LoadedEnd { end: End::Tip, axes: Axes::OfSection, load: Box::new(load) };
        let body = PlanarRodBody::new(rod, EndPose::default(), Supports::FREE);
        Self { force, body: body.with_loaded_ends(vec![tip]), drag }
    }

    /// Rates of small motions about the straight rod: that which grows most comes first.
    fn rates(&self) -> Vec<Complex<f64>> {
        // As short as the load presses it, which is what bends it
        let straight =
            along_x(self.body.rod()) * (1.0 - self.force / RodProperties::stiff(1.0, 1.0));
        let still = DVector::zeros(straight.len());
        let stiffness = self.body.tangents(&straight, &still, 0.0).stiffness;
        let damping = -self.drag.tangents(&straight, &still, 0.0).damping;
        // Across components behind the base: y and dy/ds
        let across: Vec<usize> = (4..straight.len()).filter(|i| i % 2 == 1).collect();
        let part = |of: &DMatrix<f64>| {
            DMatrix::from_fn(across.len(), across.len(), |i, j| of[(across[i], across[j])])
        };
        let matrix = part(&damping).lu().solve(&-part(&stiffness)).expect("there is drag");
        let mut rates: Vec<_> = matrix.complex_eigenvalues().iter().copied().collect();
        rates.sort_by(|a, b| b.re.total_cmp(&a.re));
        rates
    }
}

/// Where a number that is false below and true above is on the way from one to the other.
fn border(range: [f64; 2], is_above: impl Fn(f64) -> bool) -> f64 {
    let [mut low, mut high] = range;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if is_above(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

fn critical(elements: usize) -> f64 {
    border([30.0, 45.0], |force| Follower::new(elements, force).rates()[0].re > 0.0)
}

#[test]
fn a_load_that_turns_with_the_tip_makes_a_rod_flutter_as_linear_theory_has_it() {
    let errors = [4, 8].map(|elements| (critical(elements) / CRITICAL - 1.0).abs());
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[1] < 5e-4 && order > 3.5, "{errors:?}, order {order:.2}");
    let rod = Follower::new(8, CRITICAL);
    assert_near(rod.rates()[0].im.abs(), FLUTTER, 1e-3);
    let meet = border([10.0, 30.0], |force| Follower::new(8, force).rates()[0].im.abs() > 1e-3);
    assert_near(meet, MEET, 1e-3);
}

/// At 1.6 times the critical load, after the growth has ended: what the load gives the drag takes, and in half a cycle all is
/// mirrored.
#[test]
fn a_rod_that_flutters_takes_from_its_load_what_the_drag_dissipates() {
    const STEP: f64 = 2.5e-4;
    let rod = Follower::new(6, 1.6 * CRITICAL);
    let system = DrySystem::new(&rod.body, vec![&rod.drag], |_| {
        rod.body.rod().held(End::Base, Support::Clamped, &EndPose::default())
    });
    let mut start = along_x(rod.body.rod());
    let n = start.len();
    // A little across, so that it has a way to go
    start[n - 3] += 1e-3;
    let mut motion = Motion::new(&system, at_rest(start), STEP);
    let mut rows = Vec::new();
    for _ in 0..500 {
        motion.advance().expect("the step converges");
        let now = motion.now();
        let given = rod.body.inner_power(&now.coordinates, &now.velocities, now.time).ends;
        let drag = rod.drag.load(&now.coordinates, &now.velocities, now.time);
        rows.push([now.coordinates[n - 3], given, -drag.dot(&now.velocities)]);
    }
    // Whole cycles, from one way up to another
    let ups: Vec<usize> =
        (1..rows.len()).filter(|i| rows[i - 1][0] < 0.0 && rows[*i][0] >= 0.0).collect();
    let [first, last] = [ups[ups.len() - 3], ups[ups.len() - 1]];
    let sum = |column: usize| rows[first..last].iter().map(|row| row[column]).sum::<f64>();
    let [given, taken] = [sum(1), sum(2)];
    assert!(given > 0.0, "{given}");
    assert_near(given, taken, 1e-2);
    let ends = |of: fn(f64, f64) -> f64| rows[first..last].iter().map(|row| row[0]).fold(0.0, of);
    let [least, most] = [ends(f64::min), ends(f64::max)];
    assert!(most > 0.2 && (most + least).abs() < 2e-2 * most, "{least} {most}");
}
