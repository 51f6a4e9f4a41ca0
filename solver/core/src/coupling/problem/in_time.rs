//! Numbers as functions of time.

/// A number as a function of time (s).
pub type TimeValue = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A number and its rate as a function of time (s).
pub type MovingValue = Box<dyn Fn(f64) -> [f64; 2] + Send + Sync>;

/// Times (s) between two times, ascending.
pub type RateDiscontinuities = Box<dyn Fn(f64, f64) -> Vec<f64> + Send + Sync>;
