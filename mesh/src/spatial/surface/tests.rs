//! Feet, gaps and curvature of all forms against what they must be.

use super::*;
use crate::spatial::SpaceSpline;
use crate::spatial::closest::facing;
use crate::spatial::curve::Centreline;
use crate::spatial::sections::on_section;
use crate::spatial::sections::test_bodies::{bent_fish, ellipsoid};
use nalgebra::{Translation3, UnitQuaternion};

fn forms() -> Vec<Form> {
    vec![
        Form::Plane,
        Form::Sphere(0.7),
        Form::Cylinder(0.4),
        Form::Capsule { radius: 0.3, half_length: 0.5 },
        Form::Ellipsoid(Ellipsoid::new([0.9, 0.5, 0.3])),
        Form::Tube(Arc::new(Tube::new(helix(), 0.1))),
        Form::Tube(Arc::new(Tube::new(bent(), 0.1))),
        Form::Revolved(Arc::new(Revolved::new("bean", &bean()).unwrap())),
        Form::Slender(Arc::new(Slender::new(bent_fish()))),
    ]
}

fn helix() -> Centreline {
    Centreline::Helix { radius: 0.4, pitch: 0.9, turns: -1.3 }
}

fn bent() -> Centreline {
    let points = [[-1.0, 0.2, 0.0], [-0.3, -0.2, 0.1], [0.4, 0.3, 0.2], [1.0, 0.0, -0.3]];
    Centreline::Spline(SpaceSpline::new(points.map(Point::<3>::from).to_vec()).unwrap())
}

fn bean() -> Vec<[f64; 2]> {
    let on = |t: f64| [-0.8 * t.cos(), t.sin() * (0.3 + 0.1 * t.cos())];
    let mut points: Vec<_> =
        (0..=12).map(|i| on(f64::from(i) / 12.0 * std::f64::consts::PI)).collect();
    points[12][1] = 0.0;
    points
}

fn pose() -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1);
    Isometry3::from_parts(Translation3::new(0.1, -0.2, 0.3), rotation)
}

fn points() -> impl Iterator<Item = Point<3>> {
    let part = |i: usize, k: f64| (0.618_034 * k * (i + 1) as f64).fract() - 0.5;
    (0..200).map(move |i| Point::<3>::new(part(i, 1.0), part(i, 7.0), part(i, 31.0)) * 3.0)
}

#[test]
fn the_foot_is_on_the_surface_and_the_way_to_it_is_normal() {
    for form in forms() {
        for is_hollow in [false, true] {
            let surface = SmoothSurface::new(form.clone(), &pose(), is_hollow);
            for x in points() {
                let foot = surface.foot(x);
                assert!(surface.gap(foot.point).abs() < 1e-12, "{form:?}");
                assert!((foot.gap - surface.gap(x)).abs() < 1e-12);
                assert!((foot.normal.norm() - 1.0).abs() < 1e-12);
                let back = foot.point + foot.normal * foot.gap;
                assert!((back - x).norm() < 1e-10, "{form:?} {x} {back}");
            }
        }
    }
}

/// No point of the surface is nearer than the foot: the gap changes by no more than the way.
#[test]
fn gaps_are_distances() {
    let points: Vec<_> = points().collect();
    for form in forms() {
        let surface = SmoothSurface::new(form.clone(), &pose(), false);
        for pair in points.windows(2) {
            let change = surface.gap(pair[0]) - surface.gap(pair[1]);
            assert!(change.abs() <= (pair[0] - pair[1]).norm() + 1e-12, "{form:?}");
        }
    }
}

/// In the direction in which it bends most, a surface leaves its tangent by s²/2R.
#[test]
fn the_radius_of_curvature_is_that_of_the_sharpest_section() {
    for form in forms().into_iter().skip(1) {
        let surface = SmoothSurface::new(form.clone(), &pose(), false);
        for x in points().take(30) {
            let foot = surface.foot(x);
            let [u, v] = tangents(&foot.normal);
            let step = 1e-4;
            let least = (0..720).map(|i| f64::from(i) * 0.5_f64.to_radians()).map(|angle| {
                let to = foot.point + (u * angle.cos() + v * angle.sin()) * step;
                step * step / (2.0 * surface.gap(to).abs().max(1e-300))
            });
            let least = least.fold(f64::INFINITY, f64::min);
            let radius = surface.radius_of_curvature(foot.point);
            assert!((least / radius - 1.0).abs() < 1e-2, "{form:?} {least} {radius}");
        }
    }
}

/// The ball of that radius inside fits, and touches nowhere else; one that is larger does not fit.
#[test]
fn the_radius_inside_an_ellipsoid_is_that_of_the_largest_ball() {
    let ellipsoid = Ellipsoid::new([2.0, 0.3, 1.1]);
    for x in points() {
        let foot = ellipsoid.foot(x);
        let radius = ellipsoid.radius_inside(foot.point);
        let depth = |center: Point<3>| -ellipsoid.foot(center).gap;
        assert!((depth(foot.point - foot.normal * radius) - radius).abs() < 1e-6 * radius);
        let larger = 1.1 * radius;
        assert!(depth(foot.point - foot.normal * larger) < (1.0 - 1e-4) * larger);
    }
}

/// Through sections of an ellipsoid a slender body is the ellipsoid, ends included.
#[test]
fn a_slender_body_of_elliptic_sections_is_an_ellipsoid() {
    let semi_axes = [0.9, 0.3, 0.5];
    let (slender, exact) = (Slender::new(ellipsoid(semi_axes, 80)), Ellipsoid::new(semi_axes));
    let on_axes = [[2.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.95, 0.0, 1e-9]];
    for x in points().chain(on_axes.map(Point::<3>::from)) {
        let (own, foot) = (slender.foot(x), exact.foot(x));
        // Deep inside there may be two nearest points
        assert!((own.gap - foot.gap).abs() < 1e-5, "{x} {own:?} {foot:?}");
        if foot.gap > 0.0 {
            assert!(
                (own.point - foot.point).norm() < 1e-4 && (own.normal - foot.normal).norm() < 1e-3
            );
            let radii =
                [slender.radius_of_curvature(own.point), exact.radius_of_curvature(foot.point)];
            assert!((radii[0] / radii[1] - 1.0).abs() < 2e-2, "{x} {radii:?}");
            let inside = [slender.radius_inside(own.point), exact.radius_inside(foot.point)];
            assert!(inside[0] / inside[1] > 0.6 && inside[0] / inside[1] < 1.6, "{x} {inside:?}");
        }
    }
}

fn tangents(normal: &Point<3>) -> [Point<3>; 2] {
    let u = normal.cross(&Point::<3>::new(0.3, 0.5, -0.8)).normalize();
    [u, normal.cross(&u)]
}

/// A bent body lies nearest to a plane where the lowest of many of its points is, by a search from few places.
#[test]
fn the_gap_of_a_slender_body_to_a_plane_is_that_of_its_lowest_point() {
    let body = Slender::new(bent_fish());
    let surface = SmoothSurface::new(Form::Slender(Arc::new(body)), &Isometry3::identity(), false);
    for normal in directions(40) {
        let mut plane = SmoothSurface::plane(normal * -2.0, 0, 1.0);
        plane.rotation.set_column(0, &normal);
        let found = facing(&surface, &plane, f64::INFINITY);
        let least = found.iter().map(|at| at.gap).fold(f64::INFINITY, f64::min);
        let Form::Slender(slender) = &surface.form else { unreachable!() };
        let points = (0..4000).flat_map(|i| {
            let section =
                slender.sections().at(slender.sections().end() * f64::from(i) / 4000.0)[0];
            (0..90).map(move |k| on_section(&section, f64::from(k) * std::f64::consts::TAU / 90.0))
        });
        let sampled = points.map(|point| plane.gap(point)).fold(f64::INFINITY, f64::min);
        assert!(least <= sampled + 1e-12 && sampled < least + 1e-3, "{normal}: {least} {sampled}");
    }
}
