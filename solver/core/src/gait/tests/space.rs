//! Bodies of sections in space keep their volume and have no momentum; velocities are rates of places.

use std::f64::consts::{PI, TAU};

use alewife_mesh::spatial::SectionHeight;
use alewife_mesh::{GaussRule, Profile, SecondMoments};
use nalgebra::{Matrix3, Vector3};

use super::*;

/// A swimmer and what it is made of.
struct Swimmer {
    name: &'static str,
    profile: Profile,
    height: SectionHeight,
    midline: Midline,
    times: [f64; 3],
    body: SlenderBody,
}

/// All swimmers of the plane with round sections, and high fish.
fn swimmers() -> Vec<Swimmer> {
    let mut swimmers = Vec::new();
    for (name, profile, midline, times) in all() {
        let mut heights = vec![SectionHeight::Round];
        if profile.length() < 2.0 {
            heights.push(SectionHeight::Ellipse { half_height: 0.08 });
        }
        for height in heights {
            let body = SlenderBody::in_space(&profile, height, midline.clone()).unwrap();
            let (profile, midline) = (profile.clone(), midline.clone());
            swimmers.push(Swimmer { name, profile, height, midline, times, body });
        }
    }
    swimmers
}

fn tensor(deformed: &DeformedOutline) -> Matrix3<f64> {
    match deformed.moments.second {
        SecondMoments::Spatial { tensor } => tensor,
        _ => panic!("is in space"),
    }
}

/// Integrals over the surface by another rule than that of the moments, with the velocity of its points.
#[derive(Default)]
struct OverSurface {
    volume: f64,
    center: Vector3<f64>,
    squares: Matrix3<f64>,
    flux: f64,
    momentum: Vector3<f64>,
    /// Sum of the magnitudes of what the momentum is made of.
    size: f64,
}

fn over_surface(deformed: &DeformedOutline, knots: &[f64]) -> OverSurface {
    const ANGLES: usize = 24;
    let rule = GaussRule::new(9);
    let mut sums = OverSurface::default();
    for ends in knots.windows(2) {
        let span = ends[1] - ends[0];
        for (x, weight) in rule.points.iter().zip(&rule.weights) {
            let along = ends[0] + span * x;
            for i in 0..ANGLES {
                let around = TAU * i as f64 / ANGLES as f64;
                let at = |along: f64, around: f64| deformed.place(MaterialPoint { along, around });
                // Cubics, differentiated exactly, and turned by a quarter
                let step = 0.1 * span * x.min(1.0 - x);
                let ahead = difference(|along| at(along, around), along, step);
                let middle = (at(along, 0.0) + at(along, PI)) * 0.5;
                let turned = at(along, around + 0.25 * TAU) - middle;
                let area = ahead.cross(&turned) * (weight * span * TAU / ANGLES as f64);
                let place = at(along, around);
                let velocity = deformed.velocity(MaterialPoint { along, around });
                let through = velocity.dot(&area);
                let outward = place.dot(&area);
                sums.volume += outward / 3.0;
                sums.center += place * (outward / 4.0);
                sums.squares += place * place.transpose() * (outward / 5.0);
                sums.flux += through;
                sums.momentum += place * through;
                sums.size += (place * through).norm();
            }
        }
    }
    sums
}

/// Momentum of whatever fills the surface and keeps its volume everywhere is the closed integral of x (u . n).
#[test]
fn volume_and_centre_stay_and_velocities_are_the_rates_of_places() {
    for Swimmer { name, profile, midline, times, body, .. } in swimmers() {
        let [_, period] = midline.cycle();
        let length = profile.length();
        let rest = body.at(0.0).unwrap();
        let spline = profile.spline().unwrap();
        let knots = &spline.knots()[..profile.stations().len()];
        for time in times {
            let now = body.at(time).unwrap();
            let off = (now.moments.measure / rest.moments.measure - 1.0).abs();
            assert!(off < 1e-12, "{name} at {time}: volume off by {off:.1e}");
            let sums = over_surface(&now, knots);
            let off = (sums.volume / now.moments.measure - 1.0).abs();
            assert!(off < 1e-11, "{name} at {time}: volume off by {off:.1e}");
            assert!(sums.center.norm() < 1e-11 * length * sums.volume, "{name}: {}", sums.center);
            assert!(sums.flux.abs() * length < 1e-10 * sums.size, "{name}: {:.1e}", sums.flux);
            let left = sums.momentum.norm() / sums.size;
            assert!(left < 1e-10, "{name} at {time}: momentum {left:.1e}");
            let exact = Matrix3::identity() * sums.squares.trace() - sums.squares;
            let off = (tensor(&now) - exact).amax() / exact.amax();
            assert!(off < 1e-10, "{name} at {time}: inertia off by {off:.1e}");
            let step = 2e-3 * period;
            let inertia = difference(|t| tensor(&body.at(t).unwrap())[(2, 2)], time, step);
            let scale = tensor(&now)[(2, 2)] / period;
            assert!((inertia - now.inertia_rate).abs() < 1e-7 * scale, "{name}");
            let mut worst: f64 = 0.0;
            for i in 0..23 {
                let part = f64::from(i) / 23.0;
                let along = knots[knots.len() - 1] * part;
                let at = MaterialPoint { along, around: TAU * 7.0 * part };
                let exact = difference(|t| body.at(t).unwrap().place(at), time, step);
                worst = worst.max((exact - now.velocity(at)).norm());
                let found = now.material_at(&now.place(at));
                let off = (now.place(found) - now.place(at)).norm();
                // The ends themselves are known to 1e-9 of the length
                assert!(off < 3e-9 * length, "{name}: material point off by {off:.1e}");
            }
            assert!(worst < 1e-7 * length / period, "{name} at {time}: rates off by {worst:.1e}");
            let recoil = now.recoil;
            println!(
                "{name} at {time}: momentum {left:.1e}, drift of the interior {:.1e}, kept volume {:.1e}",
                recoil.interior_drift / recoil.mean_normal_speed,
                recoil.normal_speed / recoil.mean_normal_speed,
            );
            assert!(recoil.interior_drift < 1e-4 * recoil.mean_normal_speed, "{name}");
        }
    }
}

/// A point of the interior, in the frame of the head, and its part of the volume.
struct Inside {
    at: Vector3<f64>,
    part: f64,
}

fn interior(swimmer: &Swimmer, grid: &Grid, time: f64) -> Vec<Inside> {
    let frames: Frames<f64> = swimmer.midline.frames(grid, time);
    // Chords by an angle: trigonometric polynomials
    let (rule, angles) = (GaussRule::new(5), GaussRule::new(12));
    let mut points = Vec::new();
    for (node, frame) in grid.nodes.iter().zip(&frames.nodes) {
        let [tx, ty] = frame.normal();
        let length = swimmer.profile.length();
        let height = swimmer.height.at(node.along, node.half_width, length);
        let narrowing = frame.stretch.sqrt().recip();
        for (x, weight) in angles.points.iter().zip(&angles.weights) {
            let (sin, cos) = (PI * (x - 0.5)).sin_cos();
            let chord = node.half_width * cos;
            for (m, across) in rule.points.iter().zip(&rule.weights) {
                let y = offset(frame, narrowing * chord, 2.0 * m - 1.0);
                let [px, py] = frame.position;
                let at = Vector3::new(px + tx * y, py + ty * y, height * narrowing * sin);
                let part = 2.0 * across * chord * height * cos * PI * weight * node.weight;
                points.push(Inside { at, part });
            }
        }
    }
    points
}

/// Angular momentum over another grid, with other points across, and velocities by finite differences.
#[test]
fn no_angular_momentum_is_left_in_space() {
    for swimmer in swimmers() {
        let Swimmer { name, ref profile, ref midline, times, ref body, .. } = swimmer;
        let [_, period] = midline.cycle();
        let mut joints = midline.discontinuities();
        joints.extend((1..41).map(|i| profile.length() * f64::from(i) / 41.0));
        joints.sort_by(f64::total_cmp);
        let grid = Grid::new(profile, &joints);
        for time in times {
            let step = 1e-3 * period;
            let at = |steps: f64| interior(&swimmer, &grid, time + steps * step);
            let stencil = [1.0, -1.0, 2.0, -2.0, 3.0, -3.0].map(at);
            let factors = [45.0, -45.0, -9.0, 9.0, 1.0, -1.0].map(|factor| factor / (60.0 * step));
            let points = at(0.0);
            let rate = |i: usize| -> Vector3<f64> {
                stencil.iter().zip(factors).map(|(points, factor)| points[i].at * factor).sum()
            };
            let volume: f64 = points.iter().map(|inside| inside.part).sum();
            let mean = |f: &dyn Fn(usize) -> Vector3<f64>| -> Vector3<f64> {
                let parts = points.iter().enumerate().map(|(i, inside)| f(i) * inside.part);
                parts.sum::<Vector3<f64>>() / volume
            };
            let center = mean(&|i| points[i].at);
            let drift = mean(&rate);
            let now = body.at(time).unwrap();
            let recoil = now.recoil;
            let off = (volume / now.moments.measure - 1.0).abs();
            assert!(off < 1e-4, "{name}: volume off by {off:.1e}");
            let turning = Vector3::z() * recoil.angular_velocity;
            let (mut total, mut size) = (Vector3::zeros(), 0.0);
            for (i, Inside { at, part }) in points.iter().enumerate() {
                let arm = at - center;
                let moment = arm.cross(&(rate(i) - drift - turning.cross(&arm))) * *part;
                total += moment;
                size += moment.norm();
            }
            let left = total.norm() / size;
            println!("{name} at {time}: angular momentum {left:.1e} of its parts");
            // The square root of an elliptic height is nearly singular at the tail: 1e-8 there
            let allowed = if swimmer.height == SectionHeight::Round { 1e-10 } else { 1e-7 };
            assert!(left < allowed, "{name} at {time}: {left:.1e}");
            let slip = (drift.xy() - recoil.velocity).norm();
            assert!(slip < 1e-4 * recoil.mean_normal_speed, "{name}: {slip:.1e}");
        }
    }
}
