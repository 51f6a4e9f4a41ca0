//! `Midline`: how the midlines of fish and flagellates bend in time.
//!
//! The head is in the origin and points along +x; the midline is followed from there, tangent to
//! tail. Waves run from head to tail, so swimmers swim towards +x.

mod anguilliform;
mod carangiform;
mod flagellum;
mod frame;
mod joints;
mod natural_spline;
mod open;
mod own;

pub use anguilliform::Anguilliform;
pub use carangiform::Carangiform;
pub use flagellum::Flagellum;
pub use frame::{Frame, Frames};
pub use joints::{AngleInTime, Joint, Joints};
pub use open::Open;
pub use own::Own;

use super::grid::Grid;
use super::number::Number;

/// Ramps of the form 1 - exp(-t / ramp) have ended after this many times `ramp`: exp(-37) < 1e-16.
const RAMP_TIMES: f64 = 37.0;

/// How a midline bends.
#[derive(Debug, Clone)]
pub enum Midline {
    /// A wave of curvature.
    Carangiform(Carangiform),
    /// A wave of displacements as a function of arc length.
    Anguilliform(Anguilliform),
    /// A wave in the tail of a body with a rigid head.
    Flagellum(Flagellum),
    /// By an expression or a table.
    Own(Own),
    /// Bends between links.
    Joints(Joints),
}

impl Midline {
    /// Duration after which the gait is periodic (s), and the period (s).
    pub fn cycle(&self) -> [f64; 2] {
        match self {
            Self::Carangiform(Carangiform { gait, .. }) => [gait.ramp(), gait.period],
            Self::Anguilliform(Anguilliform { gait, .. }) => [gait.ramp(), gait.period],
            Self::Flagellum(Flagellum { gait, .. }) => [RAMP_TIMES * gait.ramp(), gait.period],
            Self::Own(Own { gait, .. }) => [gait.ramp(), gait.period],
            Self::Joints(gait) => gait.cycle,
        }
    }

    /// What of it is given by strokes of which later parts may not be known; none of a gait that is periodic in the end.
    pub fn open(&self) -> Option<Open> {
        match self {
            Self::Carangiform(gait) => gait.open(),
            Self::Joints(gait) => gait.open.clone(),
            Self::Anguilliform(_) | Self::Flagellum(_) | Self::Own(_) => None,
        }
    }

    /// Start (s) and duration (s) of what the gait does again and again, or of all it does.
    pub fn span(&self) -> [f64; 2] {
        match self {
            Self::Joints(gait) if gait.is_recorded => [0.0, gait.cycle[0]],
            _ => self.cycle(),
        }
    }

    /// Distances along the midline (m) at which a derivative of it jumps.
    pub fn discontinuities(&self) -> Vec<f64> {
        match self {
            Self::Carangiform(Carangiform { length, gait }) => {
                gait.curvature.iter().map(|[position, _]| position * length).collect()
            }
            Self::Anguilliform(_) => Vec::new(),
            Self::Flagellum(gait) => vec![gait.head],
            Self::Own(Own { length, gait, .. }) => {
                gait.knots().iter().map(|position| position * length).collect()
            }
            Self::Joints(gait) => gait.discontinuities(),
        }
    }

    /// The midline at a time (s).
    pub fn frames<D: Number>(&self, grid: &Grid, time: D) -> Frames<D> {
        match self {
            Self::Carangiform(gait) => gait.frames(grid, time),
            Self::Anguilliform(gait) => gait.frames(grid, time),
            Self::Own(gait) => gait.frames(grid, time),
            Self::Joints(gait) => gait.frames(grid, time),
            Self::Flagellum(tail) if tail.gait.inextensible => tail.inextensible_frames(grid, time),
            Self::Flagellum(tail) => {
                let frame = |along: f64| tail.displaced(along, time);
                Frames {
                    nodes: grid.nodes.iter().map(|node| frame(node.along)).collect(),
                    stations: grid.stations.iter().map(|at| frame(at.along)).collect(),
                }
            }
        }
    }
}
