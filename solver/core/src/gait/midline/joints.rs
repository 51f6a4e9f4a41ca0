//! `Joints`: a midline that is straight but for its joints, where it bends by given angles.

use std::fmt;
use std::sync::Arc;

use super::frame::{Frame, Frames};
use super::open::Open;
use crate::gait::grid::Grid;
use crate::gait::number::Number;

/// Angle and rate at a time (rad, rad/s, s).
#[derive(Clone)]
pub struct AngleInTime(pub Arc<dyn Fn(f64) -> [f64; 2] + Send + Sync>);

impl fmt::Debug for AngleInTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("AngleInTime")
    }
}

/// Links of a chain with smooth bends between them: the midline keeps its length, and its tangent turns at
/// each joint by an angle times a polynomial step of degree five, twice continuously differentiable.
#[derive(Debug, Clone)]
pub struct Joints {
    /// From the head on.
    pub joints: Vec<Joint>,
    /// Length of midline over which each of them bends (m).
    pub rounding: f64,
    /// Duration after which the gait is periodic (s), and the period (s).
    pub cycle: [f64; 2],
    /// Whether it is recorded: what happens before that duration is all of it.
    pub is_recorded: bool,
    /// Angles of which later parts may not be known.
    pub open: Option<Open>,
}

/// A joint of a midline.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Distance of its middle from the head (m).
    pub along: f64,
    /// Angle of the link farther from the root less that of the nearer one.
    pub angle: AngleInTime,
    /// Whether it is behind the root, the link whose angle is zero.
    pub is_behind_root: bool,
}

impl Joints {
    pub(super) fn discontinuities(&self) -> Vec<f64> {
        let ends = |joint: &Joint| [-0.5, 0.5].map(|side| joint.along + side * self.rounding);
        self.joints.iter().flat_map(ends).collect()
    }

    pub(super) fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        let now = |joint: &Joint| {
            let [angle, rate] = (joint.angle.0)(time.re());
            (time - time.re()) * rate + angle
        };
        let angles: Vec<D> = self.joints.iter().map(now).collect();
        // The straight midline runs along -x from head to tail
        let turned = |along: f64| {
            let (mut turn, mut curvature) = (D::from(0.0), D::from(0.0));
            for (joint, angle) in self.joints.iter().zip(&angles) {
                let [step, rate] = smooth_step((along - joint.along) / self.rounding + 0.5);
                let side = if joint.is_behind_root { 1.0 } else { -1.0 };
                turn += *angle * if joint.is_behind_root { step } else { 1.0 - step };
                curvature += *angle * (side * rate / self.rounding);
            }
            let (sin, cos) = turn.sin_cos();
            ([-cos, -sin], curvature)
        };
        let at_nodes: Vec<_> = grid.nodes.iter().map(|node| turned(node.along)).collect();
        let part = |axis: usize| -> Vec<D> { at_nodes.iter().map(|(t, _)| t[axis]).collect() };
        let x = grid.integrate(&part(0), D::from(0.0));
        let y = grid.integrate(&part(1), D::from(0.0));
        let frame = |x: D, y: D, (tangent, curvature): ([D; 2], D)| Frame {
            position: [x, y],
            tangent,
            stretch: D::from(1.0),
            curvature,
        };
        let nodes = x.nodes.iter().zip(&y.nodes).zip(at_nodes);
        let nodes = nodes.map(|((x, y), at)| frame(*x, *y, at));
        let stations = x.stations.iter().zip(&y.stations).zip(&grid.stations);
        let stations = stations.map(|((x, y), at)| frame(*x, *y, turned(at.along)));
        Frames { nodes: nodes.collect(), stations: stations.collect() }
    }
}

/// From 0 to 1 for x from 0 to 1, first and second derivative zero at both ends; and its rate.
fn smooth_step(x: f64) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 0.0];
    }
    if x >= 1.0 {
        return [1.0, 0.0];
    }
    [x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * x * x * (1.0 - x) * (1.0 - x)]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use alewife_mesh::{Point, Profile, TubeForm};

    use super::*;
    use crate::gait::{Midline, ShapeMotion, SlenderBody};

    const LENGTH: f64 = 3.0;
    const PIVOTS: [f64; 2] = [1.1, 2.0];

    fn profile(rounding: f64) -> Profile {
        let sections = vec![[0.5, 0.12], [1.55, 0.1], [2.5, 0.06]];
        let form = TubeForm { sections, length: LENGTH, spacing: rounding / 16.0 };
        Profile::tube(&form).unwrap()
    }

    /// A wave of two joints about the link in the middle.
    fn midline(rounding: f64, amplitude: f64) -> Joints {
        let joint = |nth: usize| {
            let angle = move |time: f64| {
                let (sin, cos) = (TAU * (time + 0.25 * nth as f64)).sin_cos();
                [amplitude * sin, amplitude * TAU * cos]
            };
            Joint {
                along: PIVOTS[nth],
                angle: AngleInTime(Arc::new(angle)),
                is_behind_root: nth == 1,
            }
        };
        let (joints, cycle) = (vec![joint(0), joint(1)], [0.0, 1.0]);
        Joints { joints, rounding, cycle, is_recorded: false, open: None }
    }

    fn swimmer(rounding: f64, amplitude: f64) -> SlenderBody {
        let midline = Midline::Joints(midline(rounding, amplitude));
        SlenderBody::new(&profile(rounding), midline).unwrap()
    }

    #[test]
    fn area_stays_and_velocities_are_those_of_the_points() {
        let swimmer = swimmer(0.4, 0.6);
        let straight = profile(0.4).spline().unwrap();
        let shape = alewife_mesh::Shape::Curve { spline: Arc::new(straight) };
        let rest = shape.moments().unwrap().measure;
        for time in [0.2, 0.9, 1.4, 3.7] {
            let now = swimmer.at(time).unwrap();
            let area = now.shape().unwrap().moments().unwrap().measure;
            assert!((area / rest - 1.0).abs() < 1e-12, "{time}: {area} {rest}");
            let recoil = &now.recoil;
            assert!(recoil.interior_drift < 1e-5 * recoil.mean_normal_speed, "{recoil:?}");
            let [before, after] = [-1e-5, 1e-5].map(|step| swimmer.at(time + step).unwrap());
            for parameter in [0.1, 1.3, 2.7] {
                let slope = (after.position(parameter) - before.position(parameter)) / 2e-5;
                assert!((slope - now.rate(parameter)).norm() < 1e-6, "{time} {parameter}");
            }
        }
    }

    #[test]
    fn without_angles_the_body_is_straight() {
        let now = swimmer(0.4, 0.0).at(0.8).unwrap();
        let straight = profile(0.4).spline().unwrap();
        for parameter in [0.0, 0.4, 1.9, 3.0] {
            let off = now.position(parameter) - straight.evaluate(parameter)[0];
            assert!(off.norm() < 1e-12, "{parameter}: {off}");
        }
    }

    /// The end of the tail as seen from the head, against rigid links with pivots.
    #[test]
    fn sharp_joints_make_the_chain_of_rigid_links() {
        let time = 0.8;
        let off = |rounding: f64| {
            let gait = midline(rounding, 0.6);
            let [front, back] = [0, 1].map(|nth| (gait.joints[nth].angle.0)(time)[0]);
            // The first link is turned by the first angle, the last one by the second
            let lengths = [PIVOTS[0], PIVOTS[1] - PIVOTS[0], LENGTH - PIVOTS[1]];
            let link =
                |length: f64, angle: f64| Point::<2>::new(-angle.cos(), -angle.sin()) * length;
            let tip = link(lengths[0], front) + link(lengths[1], 0.0) + link(lengths[2], back);
            let grid = Grid::new(&profile(rounding), &gait.discontinuities());
            let frames: Frames<f64> = gait.frames(&grid, time);
            (Point::<2>::from(frames.stations.last().unwrap().position) - tip).norm()
        };
        let [wide, narrow] = [0.4, 0.1].map(off);
        // The chord of a bend is shorter than its two halves by a part of the angle squared
        assert!(wide < 0.02 && (wide / narrow - 4.0).abs() < 1e-9, "{wide} {narrow}");
    }

    #[test]
    fn a_skin_that_would_fold_is_refused() {
        let midline = Midline::Joints(midline(0.1, 1.5));
        assert!(SlenderBody::new(&profile(0.1), midline).is_err());
    }
}
