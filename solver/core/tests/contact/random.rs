//! Heaps of random bodies.

use std::f64::consts::TAU;

use alewife_core::body::{Modes, Pose, Twist};
use alewife_core::contact::{ContactStep, PlanarGaps};
use alewife_mesh::{PlacedShape, Shape};
use nalgebra::DMatrix;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::common::{barrier, body, pose, quadratic, tank};

/// Bodies of random shape, dropped one above the other, with a mobility that couples them.
fn random_heap() -> impl Strategy<Value = (Vec<PlacedShape>, Vec<Pose>, DMatrix<f64>)> {
    let shape = prop_oneof![
        (0.2f64..0.8, 0.2f64..0.8).prop_map(|(a, b)| Shape::Ellipse { semi_axes: [a, b] }),
        (0.2f64..0.6).prop_map(|radius| Shape::Disc { radius }),
        (2u8..5, 0.0f64..0.35, 16usize..30).prop_map(|(lobes, depth, n)| {
            let points = (0..n)
                .map(|i| TAU * i as f64 / n as f64)
                .map(|t| (t, 0.5 * (1.0 + depth * (f64::from(lobes) * t).cos())))
                .map(|(t, r)| [r * t.cos(), r * t.sin()])
                .collect();
            Shape::Spline { points }
        }),
    ];
    let one = (shape, -0.4f64..0.4, 0.0..TAU);
    let coupling = proptest::collection::vec(-1.0f64..1.0, 144);
    (proptest::collection::vec(one, 4), coupling).prop_map(|(all, coupling)| {
        let bodies = all.iter().enumerate();
        let bodies = bodies.map(|(i, (shape, ..))| body(&format!("{i}"), shape.clone())).collect();
        let poses = all.iter().enumerate();
        let poses = poses.map(|(i, (_, x, angle))| pose([*x, 0.9 + 1.7 * i as f64, *angle]));
        // Close to symmetric and positive, as with some convection in the fluid
        let root = DMatrix::from_vec(12, 12, coupling);
        let skew = &root - root.transpose();
        let mobility = DMatrix::identity(12, 12) + &root * root.transpose() * 0.03 + skew * 0.02;
        (bodies, poses.collect(), mobility)
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1987),
        // Each case is a run of its own: shrinking would take minutes
        max_shrink_iters: 0,
        ..ProptestConfig::with_cases(16)
    })]

    #[test]
    fn random_heaps_settle_without_an_overlap(
        (bodies, start, mobility) in random_heap(), is_barrier in any::<bool>(),
    ) {
        let gaps = PlanarGaps::new(&tank(), &[0, 1, 2, 3], &bodies).unwrap();
        let law = if is_barrier { barrier(20.0) } else { quadratic(1e-6) };
        let load = nalgebra::DVector::from_fn(12, |row, _| if row % 3 == 1 { -1.0 } else { 0.0 });
        let free = &mobility * load;
        let free: Vec<Twist> =
            (0..4).map(|i| Twist::planar([0, 1, 2].map(|mode| free[3 * i + mode]))).collect();
        let (mut poses, mut velocities) = (start, vec![Twist::default(); 4]);
        for step in 0..400 {
            let predicted: Vec<Pose> = poses
                .iter()
                .zip(&velocities)
                .map(|(pose, velocity)| pose.displaced(&(velocity.to_vector() * 0.03)))
                .collect();
            let end = ContactStep {
                gaps: &gaps,
                law: &law,
                modes: Modes::PLANAR,
                bodies: &[0, 1, 2, 3],
                free_velocities: &free,
                mobility: &mobility,
                predicted: &predicted,
                predicted_velocities: &velocities,
                coefficient: 0.03,
                start: &poses,
            elastic: None,
            }
            .solve();
            prop_assert!(end.is_ok(), "step {step}: {}", end.unwrap_err());
            let end = end.unwrap();
            prop_assert!(end.loads.minimum_gap.unwrap().gap > 0.0, "step {step}");
            // The velocities are those of the loads
            let mut pushed = nalgebra::DVector::zeros(12);
            for (i, wrench) in end.loads.wrenches.iter().enumerate() {
                let load = [wrench.force.x, wrench.force.y, wrench.torque.z];
                (0..3).for_each(|mode| pushed[3 * i + mode] = load[mode]);
            }
            let pushed = &mobility * pushed;
            for i in 0..4 {
                for (row, mode) in Modes::PLANAR.iter().enumerate() {
                    let wanted = free[i].component(mode) + pushed[3 * i + row];
                    prop_assert!((end.velocities[i].component(mode) - wanted).abs() < 1e-9);
                }
            }
            (poses, velocities) = (end.poses, end.velocities);
        }
    }
}
