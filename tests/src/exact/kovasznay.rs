//! Flow behind a grid (Kovasznay 1948), density 1, mean speed 1.
//!
//! u = 1 - e^(l x) cos(2 pi y), v = l / (2 pi) e^(l x) sin(2 pi y), p = - e^(2 l x) / 2,
//! l = Re / 2 - sqrt(Re^2 / 4 + 4 pi^2).

use std::f64::consts::{PI, TAU};

use alewife_mesh::Point;

use super::Exact;

/// The flow at a Reynolds number (by the period of the grid).
#[derive(Debug, Clone, Copy)]
pub struct Kovasznay {
    /// Reynolds number.
    pub reynolds: f64,
}

impl Kovasznay {
    fn rate(&self) -> f64 {
        self.reynolds / 2.0 - (self.reynolds.powi(2) / 4.0 + 4.0 * PI * PI).sqrt()
    }
}

impl Exact<2> for Kovasznay {
    fn velocity(&self, place: &Point<2>, _time: f64) -> Point<2> {
        let rate = self.rate();
        let decay = (rate * place[0]).exp();
        let (sin, cos) = (TAU * place[1]).sin_cos();
        Point::<2>::new(1.0 - decay * cos, rate / TAU * decay * sin)
    }

    fn pressure(&self, place: &Point<2>, _time: f64) -> f64 {
        -(2.0 * self.rate() * place[0]).exp() / 2.0
    }
}
