//! Deforming outlines against finite differences, published numbers and other quadratures.

mod momentum;
mod open;
mod pulse;
mod space;

use std::time::Instant;

use alewife_mesh::{
    FishForm, FlagellateForm, GaussRule, Outline, PlacedShape, Point, Profile, Shape,
};

use super::grid::Grid;
use super::midline::Frames;
use super::momentum::offset;
use super::number::cross;
use super::*;
use crate::case::{AnguilliformGait, CarangiformGait, FlagellumGait};

fn fish() -> Profile {
    fish_with_tip(1e-3)
}

fn fish_with_tip(tip_radius: f64) -> Profile {
    let form = FishForm {
        length: 1.0,
        head_width: 0.04,
        tail_width: 0.01,
        head_end: 0.04,
        tail_start: 0.95,
        tip_radius,
        corner_radius: 0.01,
    };
    Profile::fish(&form).unwrap()
}

fn carangiform() -> Midline {
    let points = [0.0, 0.15, 0.4, 0.65, 0.9, 1.0];
    let curvatures = [0.82014, 1.46515, 2.57136, 3.75425, 5.09147, 5.70449];
    let curvature = points.into_iter().zip(curvatures).map(|(s, k)| [s, k]).collect();
    Midline::Carangiform(Carangiform {
        length: 1.0,
        gait: CarangiformGait {
            curvature,
            bending: 0.0,
            period: 1.0,
            phase: 0.0,
            ramp: None,
            beat: None,
            bend: None,
        },
    })
}

fn anguilliform(amplitude: f64) -> Midline {
    Midline::Anguilliform(Anguilliform {
        length: 1.0,
        gait: AnguilliformGait {
            amplitude,
            offset: 1.0 / 32.0,
            period: 1.0,
            phase: 0.0,
            ramp: None,
        },
    })
}

fn flagellate() -> Profile {
    let form = FlagellateForm { head: [2.0, 1.0], tail_length: 50.0, thickness: 0.2, fillet: 0.2 };
    Profile::flagellate(&form).unwrap()
}

fn flagellum(inextensible: bool) -> Midline {
    Midline::Flagellum(Flagellum {
        head: 4.0,
        tail: 50.0,
        gait: FlagellumGait {
            amplitude: 4.0,
            wavelength: 20.0,
            period: 0.3,
            phase: 0.0,
            ramp: Some(1.0),
            joint: None,
            inextensible,
        },
    })
}

/// Name, profile, midline and times of all swimmers.
fn all() -> Vec<(&'static str, Profile, Midline, [f64; 3])> {
    vec![
        ("carangiform", fish(), carangiform(), [0.4, 1.3, 7.77]),
        ("anguilliform", fish(), anguilliform(4.0 / 33.0), [0.4, 1.3, 7.77]),
        ("inextensible flagellum", flagellate(), flagellum(true), [0.05, 0.31, 1.7]),
        ("extensible flagellum", flagellate(), flagellum(false), [0.05, 0.31, 1.7]),
    ]
}

fn polar(deformed: &DeformedOutline) -> f64 {
    match deformed.moments.second {
        alewife_mesh::SecondMoments::Planar { polar } => polar,
        alewife_mesh::SecondMoments::Revolved { across, .. } => across,
        alewife_mesh::SecondMoments::Spatial { .. } => panic!("is planar or round"),
    }
}

/// Derivative by central differences of sixth order.
fn difference<
    V: std::ops::Sub<Output = V> + std::ops::Add<Output = V> + std::ops::Mul<f64, Output = V>,
>(
    f: impl Fn(f64) -> V,
    at: f64,
    step: f64,
) -> V {
    let by = |n: f64| f(at + n * step) - f(at - n * step);
    (by(1.0) * 45.0 - by(2.0) * 9.0 + by(3.0)) * (1.0 / (60.0 * step))
}

#[test]
fn area_and_centre_stay_and_rates_are_the_derivatives_of_positions() {
    for (name, profile, midline, times) in all() {
        let [_, period] = midline.cycle();
        let length = profile.length();
        let swimmer = SlenderBody::new(&profile, midline).unwrap();
        let rest = swimmer.at(0.0).unwrap();
        for time in times {
            let now = swimmer.at(time).unwrap();
            let moments = now.shape().unwrap().moments().unwrap();
            let off = (moments.measure / rest.moments.measure - 1.0).abs();
            assert!(off < 1e-12, "{name} at {time}: area off by {off:.1e}");
            assert!((now.moments.measure / moments.measure - 1.0).abs() < 1e-13);
            assert!(moments.centroid.norm() < 1e-12 * length, "{name}: {}", moments.centroid);
            let step = 2e-3 * period;
            let inertia = difference(|t| polar(&swimmer.at(t).unwrap()), time, step);
            let scale = polar(&now) / period;
            assert!((inertia - now.inertia_rate).abs() < 1e-7 * scale, "{name}");
            let knots = match now.shape().unwrap() {
                Shape::Curve { spline } => spline.period(),
                _ => panic!("is a curve"),
            };
            let mut worst: f64 = 0.0;
            for i in 0..97 {
                let parameter = knots * f64::from(i) / 97.0;
                let exact = difference(|t| swimmer.at(t).unwrap().position(parameter), time, step);
                worst = worst.max((exact - now.rate(parameter)).norm());
            }
            assert!(worst < 1e-7 * length / period, "{name} at {time}: rates off by {worst:.1e}");
            println!(
                "{name} at {time}: drift of the interior {:.2e}, kept area {:.2e}",
                now.recoil.interior_drift / now.recoil.mean_normal_speed,
                now.recoil.normal_speed / now.recoil.mean_normal_speed,
            );
            assert!(now.recoil.interior_drift < 1e-5 * now.recoil.mean_normal_speed, "{name}");
        }
    }
}

/// Points of the interior on a grid of its own, in the frame of the head.
fn interior(grid: &Grid, midline: &Midline, time: f64, across: &[f64]) -> Vec<Point<2>> {
    let frames: Frames<f64> = midline.frames(grid, time);
    let mut points = Vec::new();
    for (node, frame) in grid.nodes.iter().zip(&frames.nodes) {
        let normal = Point::<2>::from(frame.normal());
        for m in across {
            points.push(
                Point::<2>::from(frame.position)
                    + normal * offset(frame, node.half_width / frame.stretch, *m),
            );
        }
    }
    points
}

/// Angular momentum over another grid, with other points across, and velocities by
/// finite differences; and that areas within the interior stay.
#[test]
fn no_angular_momentum_is_left() {
    for (name, profile, midline, times) in all() {
        let [_, period] = midline.cycle();
        let swimmer = SlenderBody::new(&profile, midline.clone()).unwrap();
        let length = profile.length();
        let mut joints = midline.discontinuities();
        joints.extend((1..101).map(|i| length * f64::from(i) / 101.0));
        joints.sort_by(f64::total_cmp);
        let grid = Grid::new(&profile, &joints);
        let rule = GaussRule::new(11);
        let across: Vec<f64> = rule.points.iter().map(|x| 2.0 * x - 1.0).collect();
        let weights: Vec<f64> = grid
            .nodes
            .iter()
            .flat_map(|node| rule.weights.iter().map(|w| 2.0 * node.weight * node.half_width * w))
            .collect();
        for time in times {
            let step = 1e-3 * period;
            let at = |t: f64| interior(&grid, &midline, t, &across);
            let stencil: Vec<(f64, Vec<Point<2>>)> =
                [(45.0, 1.0), (-45.0, -1.0), (-9.0, 2.0), (9.0, -2.0), (1.0, 3.0), (-1.0, -3.0)]
                    .into_iter()
                    .map(|(weight, steps)| (weight / (60.0 * step), at(time + steps * step)))
                    .collect();
            let points = at(time);
            let rate = |i: usize| -> Point<2> { stencil.iter().map(|(w, p)| p[i] * *w).sum() };
            let area: f64 = weights.iter().sum();
            let mean = |f: &dyn Fn(usize) -> Point<2>| -> Point<2> {
                weights.iter().enumerate().map(|(i, w)| f(i) * *w).sum::<Point<2>>() / area
            };
            let center = mean(&|i| points[i]);
            let drift = mean(&|i| rate(i));
            let recoil = swimmer.at(time).unwrap().recoil;
            let (mut total, mut size) = (0.0, 0.0);
            for (i, weight) in weights.iter().enumerate() {
                let arm = points[i] - center;
                let turning = Point::<2>::new(-arm.y, arm.x) * recoil.angular_velocity;
                let velocity = rate(i) - drift - turning;
                let part = weight * cross([arm.x, arm.y], [velocity.x, velocity.y]);
                total += part;
                size += part.abs();
            }
            assert!(total.abs() < 1e-10 * size, "{name} at {time}: {total:.1e} of {size:.1e}");
            let slip = (drift - recoil.velocity).norm();
            assert!(slip < 1e-5 * recoil.mean_normal_speed, "{name}: {slip:.1e}");
        }
    }
}

/// Tangent, stretch and curvature are those of the positions, the interior keeps its areas, and the
/// midline its length where it is inextensible.
#[test]
fn midlines_agree_with_their_derivatives() {
    for (name, profile, midline, times) in all() {
        let grid = Grid::new(&profile, &midline.discontinuities());
        for time in times {
            let frames: Frames<f64> = midline.frames(&grid, time);
            let integral = |f: &dyn Fn(usize) -> f64| -> f64 {
                grid.nodes.iter().enumerate().map(|(i, node)| f(i) * node.weight).sum()
            };
            let (first, last) = (&frames.stations[0], &frames.stations[frames.stations.len() - 1]);
            for axis in 0..2 {
                let whole = integral(&|i| frames.nodes[i].stretch * frames.nodes[i].tangent[axis]);
                let off = (whole - (last.position[axis] - first.position[axis])).abs();
                assert!(off < 1e-10 * profile.length(), "{name}: points off by {off:.1e}");
            }
            let turned: f64 = frames
                .stations
                .windows(2)
                .map(|pair| cross(pair[0].tangent, pair[1].tangent).asin())
                .sum();
            let whole = integral(&|i| frames.nodes[i].stretch * frames.nodes[i].curvature);
            assert!((turned - whole).abs() < 1e-9, "{name}: {turned} {whole}");
            if name != "extensible flagellum" {
                // Chords, lengthened by their curvature
                let length: f64 = frames
                    .stations
                    .windows(2)
                    .map(|pair| {
                        let [a, b] = [pair[0].position, pair[1].position];
                        let chord = (b[0] - a[0]).hypot(b[1] - a[1]);
                        let turn = cross(pair[0].tangent, pair[1].tangent).asin();
                        chord * (1.0 + turn * turn / 24.0)
                    })
                    .sum();
                let off = (length / profile.length() - 1.0).abs();
                assert!(off < 1e-6, "{name}: length off by {off:.1e}");
            }
            for (node, frame) in grid.nodes.iter().zip(&frames.nodes) {
                let width = node.half_width / frame.stretch;
                for m in [-0.8, 0.1, 0.9] {
                    let slope = difference(|m| offset(frame, width, m), m, 1e-2);
                    let y: f64 = offset(frame, width, m);
                    let density = frame.stretch * (1.0 + frame.curvature * y) * slope;
                    assert!((density / node.half_width - 1.0).abs() < 1e-9, "{name}");
                }
            }
        }
    }
}

/// Range of head and end of the tail across the mean direction of the body, over a period.
fn swing(swimmer: &SlenderBody, tip: f64) -> [f64; 2] {
    let n = 400;
    let points: Vec<[Point<2>; 2]> = (0..n)
        .map(|i| swimmer.at(3.0 + f64::from(i) / f64::from(n)).unwrap())
        .map(|deformed| [0.0, tip].map(|parameter| deformed.position(parameter)))
        .collect();
    let axis: Point<2> = points.iter().map(|[head, tail]| head - tail).sum();
    let axis = axis.normalize();
    [0, 1].map(|k| {
        let heights = points.iter().map(|at| cross(axis.into(), at[k].into()));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for height in heights {
            (low, high) = (low.min(height), high.max(height));
        }
        high - low
    })
}

#[test]
fn fish_have_their_published_shapes() {
    // The round end takes 0.4 % of the length, and the tail swings there: a sharper one
    let profile = fish_with_tip(1e-4);
    let spline = profile.spline().unwrap();
    let tip = spline.knots()[profile.stations().len() - 1];
    let swimmer = SlenderBody::new(&profile, carangiform()).unwrap();
    let area = swimmer.at(2.0).unwrap().moments.measure;
    assert!((area - 0.04851).abs() < 5e-6, "{area}");
    let [head, tail] = swing(&swimmer, tip);
    // A wave that is its own mirror image half a period later turns the body to and fro only
    assert!(
        (swimmer.recoil_angle(5.0).unwrap() - swimmer.recoil_angle(1.0).unwrap()).abs() < 1e-12
    );
    assert!((tail - 0.349).abs() < 1.5e-3, "{tail}");
    assert!((head - 0.134).abs() < 1.5e-3, "{head}");
    let grid = Grid::new(&profile, &[]);
    let amplitude = (0..100)
        .map(|i| {
            let frames: Frames<f64> =
                anguilliform(4.0 / 33.0).frames(&grid, 2.0 + f64::from(i) / 100.0);
            frames.stations[frames.stations.len() - 1].position[1]
        })
        .fold(0.0, f64::max);
    assert!((amplitude - 0.125).abs() < 1e-3, "{amplitude}");
}

#[test]
fn outlines_do_not_cross_themselves_and_are_fast_to_make() {
    for (name, profile, midline, times) in all() {
        let [_, period] = midline.cycle();
        let start = Instant::now();
        let swimmer = SlenderBody::new(&profile, midline).unwrap();
        let built = start.elapsed();
        let start = Instant::now();
        swimmer.at(times[2] + period).unwrap();
        let table = start.elapsed();
        let start = Instant::now();
        let shapes: Vec<DeformedOutline> =
            (0..50).map(|i| swimmer.at(times[2] + period * f64::from(i) / 50.0).unwrap()).collect();
        let each = start.elapsed() / 50;
        let start = Instant::now();
        for deformed in shapes {
            let body = PlacedShape {
                name: name.to_owned(),
                shape: deformed.shape().unwrap(),
                center: Point::<2>::zeros(),
                angle: 0.0,
                size: None,
            };
            Outline::new(&body).unwrap();
        }
        let outline = start.elapsed() / 50;
        println!("{name}: built {built:?}, table {table:?}, at {each:?}, outline {outline:?}");
        assert!(each.as_secs_f64() < 0.02);
    }
}

#[test]
fn gaits_that_cannot_be_made_are_refused() {
    let refused = SlenderBody::new(&fish(), anguilliform(0.3)).unwrap_err();
    assert!(matches!(refused, GaitError::Midline { .. }), "{refused}");
    let Midline::Carangiform(Carangiform { length, gait }) = carangiform() else {
        panic!("is carangiform")
    };
    let bent = CarangiformGait { bending: 6.0, ..gait.clone() };
    let bent = Midline::Carangiform(Carangiform { length, gait: bent });
    let straight = CarangiformGait { curvature: Vec::new(), ..gait };
    let straight = Midline::Carangiform(Carangiform { length, gait: straight });
    let refused = SlenderBody::new(&fish(), straight).unwrap_err();
    assert_eq!(refused, GaitError::Curvature { points: 0 });
    let refused = SlenderBody::new(&fish(), bent).unwrap_err();
    assert!(matches!(refused, GaitError::Crossing { .. }), "{refused}");
}

/// The outline crosses itself between the times at which the gait is evaluated when it is made.
#[test]
fn a_gait_that_fails_later_is_an_error_with_its_time() {
    let Midline::Carangiform(Carangiform { length, gait }) = carangiform() else {
        panic!("is carangiform")
    };
    let phase = 0.75 - 1.0 / 48.0;
    let gait = CarangiformGait { bending: 1.683, phase, ramp: Some(0.01), ..gait };
    let bent = Midline::Carangiform(Carangiform { length, gait });
    let body = SlenderBody::new(&fish(), bent).unwrap();
    assert!(body.at(0.012).unwrap().outline(0.012).is_ok());
    let failure = body.at(0.033).unwrap().outline(0.033).unwrap_err();
    assert!(matches!(failure, GaitError::Crossing { time: 0.033, .. }), "{failure}");
    let failure = body.at(f64::NAN).unwrap_err();
    assert!(matches!(failure, GaitError::Midline { .. }), "{failure}");
    let law = PulseLaw::Table { knots: Vec::new(), period: None };
    let failure = Pulse { radius: 1.0, is_sphere: false, law }.at(2.0).unwrap_err();
    assert!(matches!(failure, GaitError::Radius { time: 2.0, .. }), "{failure}");
}
