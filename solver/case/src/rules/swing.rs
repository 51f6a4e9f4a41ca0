//! How far a gait swings the surface of a body sideways.

use std::f64::consts::TAU;

use crate::{BentJoint, Body, CarangiformGait, GaitSpec, JointsGait, ShapeSpec};

/// Places along a body, and times of a period, at which a midline is looked at.
const SAMPLES: u32 = 32;

/// Largest distance by which a gait moves the surface of its body from where it is at rest (m), to
/// some per cent; 0 of one that slips.
pub fn swing(body: &Body) -> f64 {
    let length = match &body.shape {
        ShapeSpec::Fish(fish) => fish.length,
        ShapeSpec::Flagellate(_) | ShapeSpec::Tube(_) => 1.0,
        shape => shape.reach(),
    };
    let relative = match &body.gait {
        None | Some(GaitSpec::Squirmer(_)) => 0.0,
        Some(GaitSpec::Carangiform(gait)) => carangiform(gait),
        Some(GaitSpec::Anguilliform(gait)) => gait.amplitude * (1.0 + gait.offset),
        Some(GaitSpec::Flagellum(gait)) => gait.amplitude,
        Some(GaitSpec::Joints(gait)) => joints(gait, &body.shape),
        Some(GaitSpec::Pulsating(gait)) => {
            let of_table = gait.table.iter().map(|row| row[1]).fold(1.0, f64::max);
            let largest = gait.amplitude.map_or(of_table, |amplitude| 1.0 + amplitude.abs());
            let is_sphere = matches!(body.shape, ShapeSpec::Sphere { .. });
            largest.powf(if is_sphere { 1.0 / 3.0 } else { 0.5 }) - 1.0
        }
    };
    relative * length
}

/// Largest displacement of the midline of a chain with a skin (m): that of a line with one kink from the
/// chord of its ends, summed over all joints.
fn joints(gait: &JointsGait, shape: &ShapeSpec) -> f64 {
    let ShapeSpec::Tube(tube) = shape else { return 0.0 };
    let kink = |joint: &BentJoint| {
        let [least, most] = joint.angle.range();
        let lever = joint.along * (tube.length - joint.along) / tube.length;
        least.abs().max(most.abs()) * lever
    };
    gait.joints.iter().map(kink).sum()
}

/// Largest displacement of a midline of length 1 from its mean line, its curvature integrated twice.
fn carangiform(gait: &CarangiformGait) -> f64 {
    let step = 1.0 / f64::from(SAMPLES);
    let mut largest = 0.0f64;
    for time in 0..SAMPLES {
        let (mut slope, mut height) = (0.0, 0.0);
        let mut heights = Vec::new();
        for place in 0..SAMPLES {
            let s = step * (f64::from(place) + 0.5);
            let wave = (TAU * (f64::from(time) * step - s)).sin() + gait.bending;
            slope += step * curvature(&gait.curvature, s) * wave;
            height += step * slope;
            heights.push(height);
        }
        let n = f64::from(SAMPLES);
        let mean = heights.iter().sum::<f64>() / n;
        // The mean line is turned so that the midline leans to neither side
        let lean = heights
            .iter()
            .zip(0..)
            .map(|(height, place)| (height - mean) * (f64::from(place) + 0.5 - 0.5 * n))
            .sum::<f64>()
            * 12.0
            / (n * n * n - n);
        for (height, place) in heights.iter().zip(0..) {
            let line = mean + lean * (f64::from(place) + 0.5 - 0.5 * n);
            largest = largest.max((height - line).abs());
        }
    }
    largest
}

/// A curvature between its rows, linearly.
fn curvature(rows: &[[f64; 2]], s: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= s);
    match (after.checked_sub(1).map(|before| rows[before]), rows.get(after)) {
        (Some([s0, k0]), Some(&[s1, k1])) => k0 + (k1 - k0) * (s - s0) / (s1 - s0),
        (Some([_, k]), None) | (None, Some(&[_, k])) => k,
        (None, None) => 0.0,
    }
}
