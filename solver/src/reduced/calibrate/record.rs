//! `Record`: a run of the full solver or rows of a CSV file, with the reduced model of its case.

use std::borrow::Cow;
use std::fmt::Display;

use alewife_reduced::tree::TreeError;

use super::sought::Sought;
use crate::case::{CaseFile, Model, ReducedSpec, TimeSettings};
use crate::reduced::build::Reduced;
use crate::run::Series;

/// Where a run or record is from.
#[derive(Debug, Clone)]
pub struct Origin {
    pub name: String,
    pub hash: String,
    pub is_held_out: bool,
    pub rows: usize,
    pub periods: Vec<f64>,
    pub amplitudes: Vec<f64>,
    pub viscosity: f64,
}

/// A way or an angle of a body, and its values.
#[derive(Debug, Clone)]
pub struct Track {
    /// Its name: `NAME.x`.
    pub name: String,
    /// Number of the body.
    pub body: usize,
    /// 0, 1 and 2 for x, y and z, 3 for the angle.
    pub axis: usize,
    /// In the units and the frame of the case.
    pub values: Vec<f64>,
}

/// The law that is calibrated, in the case of a record.
#[derive(Debug, Clone)]
pub struct Law {
    pub reduced: ReducedSpec,
    /// Whether the case of the record has its own of what moves the swimmer.
    pub keeps_own: bool,
}

impl Law {
    /// Has a model take the law.
    pub fn put_into(&self, model: &mut Model) {
        let law = self.reduced.clone();
        let own = model.case.reduced.take().filter(|_| self.keeps_own);
        model.case.reduced = Some(match own {
            Some(own) => ReducedSpec {
                loads: law.loads,
                coefficients: law.coefficients,
                body: law.body,
                depth: law.depth,
                added_mass: law.added_mass,
                lift: law.lift,
                ..own
            },
            None => law,
        });
    }
}

/// A run or a record.
#[derive(Debug, Clone)]
pub struct Record {
    pub name: String,
    pub hash: String,
    pub is_held_out: bool,
    /// The case it is of.
    pub read: CaseFile,
    /// The law that is calibrated.
    pub law: Law,
    pub model: Model,
    pub reduced: Reduced,
    /// Times of rows (s).
    pub times: Vec<f64>,
    pub tracks: Vec<Track>,
    /// Whether ways and angles count from the first row.
    pub is_relative: bool,
    /// All quantities of a run.
    pub series: Option<Series>,
}

impl Record {
    /// The same with other numbers of its case, where such are found.
    ///
    /// # Errors
    /// When the case is wrong with them.
    pub fn at(&self, sought: &Sought, found: &[f64]) -> Result<Cow<'_, Self>, TreeError> {
        if !sought.has_numbers() {
            return Ok(Cow::Borrowed(self));
        }
        let wrong = |error: &dyn Display| TreeError::Given(error.to_string());
        let numbers = sought.numbers(&self.read, found).map_err(|error| wrong(&error))?;
        let read = self.read.with_numbers(&numbers).map_err(|error| wrong(&error))?;
        let mut model = read.model;
        self.law.put_into(&mut model);
        let reduced = Reduced::new(&model).map_err(|error| wrong(&error))?;
        Ok(Cow::Owned(Self { model, reduced, ..self.clone() }))
    }

    pub fn origin(&self) -> Origin {
        let strokes = self.model.joints.iter().filter_map(|joint| joint.kind.stroke());
        let (mut periods, mut amplitudes) = (Vec::new(), Vec::new());
        for stroke in strokes {
            periods.extend(stroke.period());
            let [least, most] = stroke.range();
            amplitudes.push(0.5 * (most - least));
        }
        let case = &self.model.case;
        Origin {
            name: self.name.clone(),
            hash: self.hash.clone(),
            is_held_out: self.is_held_out,
            rows: self.times.len(),
            periods,
            amplitudes,
            viscosity: case.reference_viscosity() / case.fluid.density,
        }
    }

    /// Step (s) of its reduced model.
    pub fn step(&self) -> f64 {
        match &self.model.case.time {
            TimeSettings::Unsteady(time) => time.step,
            TimeSettings::Steady(_) => f64::NAN,
        }
    }
}
