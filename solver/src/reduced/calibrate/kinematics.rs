//! How bodies move in a run of the full solver, in the frame that a law of loads is in, and the loads on them.

use alewife_reduced::tree::{Pose, Twist, Wrench};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::record::Record;
use crate::run::Series;

/// Part of a run that is left out at its start, where it is set in motion.
const LEFT_OUT: f64 = 0.1;

/// A body at one time.
pub struct Moved {
    /// Number of the body.
    pub body: usize,
    /// Its axes in the laboratory.
    pub rotation: Matrix3<f64>,
    /// Its velocity where its law is, in its axes, and how that changes in them.
    pub twist: Twist<f64>,
    pub change: Twist<f64>,
    /// What the fluid does to it about its centre of mass, in the laboratory.
    pub load: Wrench<f64>,
}

/// Columns of a body.
struct Columns<'a> {
    series: &'a Series,
    body: &'a str,
    is_spatial: bool,
}

impl Columns<'_> {
    fn one(&self, name: &str) -> Result<Vec<f64>, String> {
        let full = format!("{}.{name}", self.body);
        self.series.column(&full).ok_or_else(|| format!("there is no column {full}"))
    }

    /// A vector that in the plane has one part about z, or two along it.
    fn vector(&self, name: &str, is_axial: bool) -> Result<Vec<Vector3<f64>>, String> {
        if is_axial && !self.is_spatial {
            return Ok(self.one(name)?.into_iter().map(|z| Vector3::new(0.0, 0.0, z)).collect());
        }
        let axis = |axis: &str| self.one(&format!("{name}.{axis}"));
        let (x, y) = (axis("x")?, axis("y")?);
        let z = if self.is_spatial { axis("z")? } else { vec![0.0; x.len()] };
        Ok((0..x.len()).map(|k| Vector3::new(x[k], y[k], z[k])).collect())
    }

    fn rotations(&self) -> Result<Vec<Matrix3<f64>>, String> {
        if !self.is_spatial {
            let turned = |angle| *Rotation3::from_axis_angle(&Vector3::z_axis(), angle).matrix();
            return Ok(self.one("angle")?.into_iter().map(turned).collect());
        }
        let part = |axis: &str| self.one(&format!("orientation.{axis}"));
        let (w, x, y, z) = (part("w")?, part("x")?, part("y")?, part("z")?);
        let turned = |k: usize| {
            let q = UnitQuaternion::from_quaternion(Quaternion::new(w[k], x[k], y[k], z[k]));
            *q.to_rotation_matrix().matrix()
        };
        Ok((0..w.len()).map(turned).collect())
    }
}

/// All bodies at all rows of a run but the first and the last ones.
///
/// # Errors
/// The column that is missing.
pub fn moved(record: &Record) -> Result<Vec<Moved>, String> {
    let Some(series) = &record.series else { return Ok(Vec::new()) };
    let (times, n) = (&series.times, series.times.len());
    let start = times.first().copied().unwrap_or_default();
    let end = times.last().copied().unwrap_or_default();
    let from = start + LEFT_OUT * (end - start);
    let is_spatial = record.model.case.geometry.dimensions() == 3;
    let mut all = Vec::new();
    for (body, part) in record.reduced.parts.iter().enumerate() {
        let columns = Columns { series, body: &record.model.bodies[body].name, is_spatial };
        let rotations = columns.rotations()?;
        let linear = columns.vector("velocity", false)?;
        let angular = columns.vector("angular_velocity", true)?;
        let forces = columns.vector("force", false)?;
        let torques = columns.vector("torque", true)?;
        let place = Pose::at(part.place);
        let twist = |k: usize| {
            let back = rotations[k].transpose();
            place.twist_inside(&Twist { linear: back * linear[k], angular: back * angular[k] })
        };
        for k in (1..n.saturating_sub(1)).filter(|k| times[*k] > from) {
            let per_time = 1.0 / (times[k + 1] - times[k - 1]);
            let change = Twist::zero().plus(&twist(k + 1), per_time).plus(&twist(k - 1), -per_time);
            all.push(Moved {
                body,
                rotation: rotations[k],
                twist: twist(k),
                change,
                load: Wrench { force: forces[k], torque: torques[k] },
            });
        }
    }
    Ok(all)
}
