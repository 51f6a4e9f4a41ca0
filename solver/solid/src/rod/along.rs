//! Numbers along a rod: constant, from a table, or functions of place and time.

use std::fmt;
use std::sync::Arc;

/// A number along a rod, such as its bending stiffness.
#[derive(Clone)]
pub enum Along {
    /// The same everywhere.
    Constant(f64),
    /// Rows of distance along the rod (m), ascending, and value; linear between rows, constant outside.
    Table(Vec<[f64; 2]>),
    /// A function of the distance along the rod (m).
    Function(Arc<dyn Fn(f64) -> f64 + Send + Sync>),
}

impl Along {
    /// A function of the distance along the rod (m).
    pub fn function(function: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(function))
    }

    /// The value at a distance along the rod (m).
    #[must_use]
    pub fn at(&self, along: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(rows) => between(rows, along),
            Self::Function(function) => function(along),
        }
    }
}

/// Value of a table, 0 of an empty one.
fn between(rows: &[[f64; 2]], along: f64) -> f64 {
    let next = rows.partition_point(|row| row[0] <= along);
    match (next.checked_sub(1).and_then(|last| rows.get(last)), rows.get(next)) {
        (Some([from, start]), Some([to, end])) => {
            start + (end - start) * (along - from) / (to - from)
        }
        (Some([_, value]), None) | (None, Some([_, value])) => *value,
        (None, None) => 0.0,
    }
}

impl fmt::Debug for Along {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => f.debug_tuple("Constant").field(value).finish(),
            Self::Table(rows) => f.debug_tuple("Table").field(rows).finish(),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

/// A number that changes in time, with its rate (1/s).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Varying {
    /// Its value.
    pub value: f64,
    /// Its derivative by time.
    pub rate: f64,
}

/// A number along a rod and in time, such as the curvature of its rest shape.
#[derive(Clone)]
pub enum Field {
    /// One that does not change in time.
    Steady(Along),
    /// A function of the distance along the rod (m) and of time (s).
    InTime(Arc<dyn Fn(f64, f64) -> Varying + Send + Sync>),
}

impl Field {
    /// Zero everywhere and always.
    pub const ZERO: Self = Self::Steady(Along::Constant(0.0));

    /// A function of the distance along the rod (m) and of time (s).
    pub fn in_time(function: impl Fn(f64, f64) -> Varying + Send + Sync + 'static) -> Self {
        Self::InTime(Arc::new(function))
    }

    /// The value and its rate at a distance along the rod (m) and a time (s).
    #[must_use]
    pub fn at(&self, along: f64, time: f64) -> Varying {
        match self {
            Self::Steady(number) => Varying { value: number.at(along), rate: 0.0 },
            Self::InTime(function) => function(along, time),
        }
    }
}

impl fmt::Debug for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steady(number) => f.debug_tuple("Steady").field(number).finish(),
            Self::InTime(_) => f.write_str("InTime"),
        }
    }
}
