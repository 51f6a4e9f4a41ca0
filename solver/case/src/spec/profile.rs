//! `ProfileSpec`: the velocity on a side by numbers at places of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::time_function::TimeFunction;

/// A velocity on a side by numbers at places of it, linear between them: a measurement, or another computation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ProfileSpec {
    /// Path of a CSV file whose header names coordinates and velocities, relative to the file in which it is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// What the numbers of a row are: coordinates and components of the velocity; what the header of a file becomes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<ProfileColumn>,
    /// Numbers at each place (m, m/s); what the rows of a file become.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<Vec<f64>>,
    /// Factor in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<TimeFunction>,
}

/// What the numbers of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub enum ProfileColumn {
    /// Coordinate x (m).
    #[serde(rename = "x")]
    X,
    /// Coordinate y (m).
    #[serde(rename = "y")]
    Y,
    /// Coordinate z (m).
    #[serde(rename = "z")]
    Z,
    /// Velocity along x (m/s); 0 without such a column.
    #[serde(rename = "velocity.x")]
    VelocityX,
    /// Velocity along y (m/s); 0 without such a column.
    #[serde(rename = "velocity.y")]
    VelocityY,
    /// Velocity along z (m/s); 0 without such a column.
    #[serde(rename = "velocity.z")]
    VelocityZ,
}

impl ProfileColumn {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::X, Self::Y, Self::Z, Self::VelocityX, Self::VelocityY, Self::VelocityZ];

    /// Its name in files and cases.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::VelocityX => "velocity.x",
            Self::VelocityY => "velocity.y",
            Self::VelocityZ => "velocity.z",
        }
    }

    /// The axis of a coordinate; `None` of a velocity.
    #[must_use]
    pub fn coordinate(self) -> Option<usize> {
        Self::ALL[..3].iter().position(|one| *one == self)
    }

    /// The axis of a velocity; `None` of a coordinate.
    #[must_use]
    pub fn velocity(self) -> Option<usize> {
        Self::ALL[3..].iter().position(|one| *one == self)
    }
}

impl ProfileSpec {
    /// Number of a column, and its axis, of each coordinate by which the velocity is given.
    #[must_use]
    pub fn coordinates(&self) -> Vec<ColumnAxis> {
        self.of(ProfileColumn::coordinate)
    }

    /// The same of each velocity.
    #[must_use]
    pub fn velocities(&self) -> Vec<ColumnAxis> {
        self.of(ProfileColumn::velocity)
    }

    fn of(&self, kind: fn(ProfileColumn) -> Option<usize>) -> Vec<ColumnAxis> {
        let all = self.columns.iter().enumerate();
        all.filter_map(|(column, what)| Some(ColumnAxis { column, axis: kind(*what)? })).collect()
    }

    /// Numbers, from 1, of two rows that are at one place by these coordinates, of rows that have them all.
    #[must_use]
    pub fn rows_at_one_place(&self, coordinates: &[ColumnAxis]) -> Option<[usize; 2]> {
        let mut places: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
        self.rows.iter().zip(1..).find_map(|(row, number)| {
            // Zeros of both signs are one place
            let place = coordinates.iter().map(|one| (row[one.column] + 0.0).to_bits());
            places.insert(place.collect(), number).map(|before| [before, number])
        })
    }

    /// The largest speed of a row (m/s).
    #[must_use]
    pub fn largest_speed(&self) -> f64 {
        let velocities = self.velocities();
        let speed = |row: &Vec<f64>| {
            let parts = velocities.iter().filter_map(|one| row.get(one.column));
            parts.map(|part| part * part).sum::<f64>().sqrt()
        };
        self.rows.iter().map(speed).filter(|speed| speed.is_finite()).fold(0.0, f64::max)
    }
}

/// A column and its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColumnAxis {
    /// Number of the column.
    pub column: usize,
    /// 0 of x, 1 of y, 2 of z.
    pub axis: usize,
}
