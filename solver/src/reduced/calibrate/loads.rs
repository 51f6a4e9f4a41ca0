//! Loads on bodies that move as in runs of the full solver, and the coefficients that make them those of the runs.

use alewife_reduced::tree::{
    Dual64, Fit, Number, Pose, Residuals, TreeError, Twist, Wrench, fit, fit_linear, real,
};

use super::error::CalibrateError;
use super::kinematics::{Moved, moved};
use super::record::Record;
use super::sought::Sought;
use crate::reduced::part::Part;

/// Steps of Gauss and Newton at most, where a law is not linear.
const MOST_STEPS: usize = 100;

/// A run with the sizes of its loads.
struct Loaded<'a> {
    record: &'a Record,
    moved: Vec<Moved>,
    sizes: [f64; 2],
}

/// Root mean squares of forces and torques.
pub fn sizes(moved: &[Moved]) -> [f64; 2] {
    let mean = |square: fn(&Moved) -> f64| {
        let sum: f64 = moved.iter().map(square).sum();
        (sum / moved.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
    };
    [mean(|one| one.load.force.norm_squared()), mean(|one| one.load.torque.norm_squared())]
}

/// What the law does to a body about its centre of mass, in the laboratory.
pub fn load<T: Number>(part: &Part, moved: &Moved, coefficients: &[T]) -> Wrench<T> {
    let Some(law) = part.law.load(coefficients) else { return Wrench::zero() };
    let lifted = |twist: &Twist<f64>| Twist {
        linear: twist.linear.map(real::<T>),
        angular: twist.angular.map(real::<T>),
    };
    let (twist, change) = (lifted(&moved.twist), lifted(&moved.change));
    let (masses, one): (_, T) = (law.added_mass(), real(1.0));
    let met = law
        .resist(&twist)
        .wrench
        .plus(&masses.times(&change), -one)
        .plus(&twist.cross_momentum(&masses.times(&twist)), -one);
    let own = Pose::at(part.place.map(real::<T>)).wrench_outside(&met);
    let rotation = moved.rotation.map(real::<T>);
    Wrench { force: rotation * own.force, torque: rotation * own.torque }
}

impl Loaded<'_> {
    /// What is left of the loads, a size.
    fn left<T: Number>(&self, sought: &Sought, parameters: &[T], left: &mut Vec<T>) {
        for moved in &self.moved {
            let part = &self.record.reduced.parts[moved.body];
            let made =
                load(part, moved, &sought.filled(moved.body, &part.coefficients, parameters));
            for axis in 0..3 {
                left.push((made.force[axis] - moved.load.force[axis]) / self.sizes[0]);
                left.push((made.torque[axis] - moved.load.torque[axis]) / self.sizes[1]);
            }
        }
    }
}

/// Loads of some runs.
pub struct Loads<'a> {
    runs: Vec<Loaded<'a>>,
    sought: &'a Sought,
}

impl<'a> Loads<'a> {
    /// Of runs.
    ///
    /// # Errors
    /// The run whose columns are missing.
    pub fn new(records: &[&'a Record], sought: &'a Sought) -> Result<Self, CalibrateError> {
        let mut runs = Vec::new();
        for (number, record) in records.iter().enumerate() {
            let moved = moved(record).map_err(|what| CalibrateError::Record {
                number,
                key: "run".to_owned(),
                what: format!("{}: {what}", record.name),
            })?;
            let sizes = sizes(&moved);
            runs.push(Loaded { record, moved, sizes });
        }
        Ok(Self { runs, sought })
    }

    /// What is left of all loads, over their sizes.
    pub fn left<T: Number>(&self, parameters: &[T]) -> Vec<T> {
        let mut left = Vec::new();
        self.runs.iter().for_each(|run| run.left(self.sought, parameters, &mut left));
        left
    }
}

impl Residuals for Loads<'_> {
    fn residuals(&self, parameters: &[Dual64]) -> Result<Vec<Dual64>, TreeError> {
        Ok(self.left(parameters))
    }
}

/// Fits loads by least squares, in one step where they are linear in the coefficients.
pub fn fitted(loads: &Loads<'_>, sought: &Sought, is_linear: bool) -> Result<Fit, CalibrateError> {
    if !is_linear {
        return Ok(fit(loads, &sought.start, &sought.bounds, MOST_STEPS)?);
    }
    let n = sought.start.len();
    let constant = loads.left(&vec![0.0; n]);
    let columns: Vec<Vec<f64>> = (0..n)
        .map(|k| {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            let with = loads.left(&unit);
            with.iter().zip(&constant).map(|(with, without)| with - without).collect()
        })
        .collect();
    let fit = fit_linear(&columns, &constant, &sought.bounds)?;
    let start = loads.left(&sought.start);
    Ok(Fit { start_cost: 0.5 * start.iter().map(|one| one * one).sum::<f64>(), ..fit })
}
