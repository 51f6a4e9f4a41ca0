//! Fields, rigid velocities and contact as they are saved.

use alewife_mesh::Point;
use serde::{Deserialize, Serialize};

use crate::body::{Twist, Wrench};
use crate::contact::{ContactLoads, MinimumGap, Partner};
use crate::coupling::Solution;

/// Fields and rigid velocities of one level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedLevel<const D: usize> {
    velocity: Vec<Point<D>>,
    pressure: Vec<f64>,
    twists: Vec<Twist>,
    pressure_gradient: Point<D>,
}

/// Loads of contact and the smallest gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedContact {
    /// Load on each body.
    pub wrenches: Vec<Wrench>,
    minimum_gap: Option<SavedGap>,
}

/// A gap between a body and another one, or a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct SavedGap {
    body: usize,
    other: Option<usize>,
    wall: Option<usize>,
    gap: f64,
}

impl<const D: usize> SavedLevel<D> {
    pub(super) fn of(solution: &Solution<D>) -> Self {
        let Solution { velocity, pressure, twists, pressure_gradient } = solution.clone();
        Self { velocity, pressure, twists, pressure_gradient }
    }

    pub(super) fn is_consistent(&self, n_nodes: usize, n_vertices: usize, n_bodies: usize) -> bool {
        self.velocity.len() == n_nodes
            && self.pressure.len() == n_vertices
            && self.twists.len() == n_bodies
    }

    pub(super) fn solution(&self) -> Solution<D> {
        let Self { velocity, pressure, twists, pressure_gradient } = self.clone();
        Solution { velocity, pressure, twists, pressure_gradient }
    }
}

impl SavedContact {
    pub(super) fn of(contact: &ContactLoads) -> Self {
        let gap = |minimum: MinimumGap| {
            let (other, wall) = match minimum.partner {
                Partner::Body(body) => (Some(body), None),
                Partner::Wall(side) => (None, Some(side)),
            };
            SavedGap { body: minimum.body, other, wall, gap: minimum.gap }
        };
        Self { wrenches: contact.wrenches.clone(), minimum_gap: contact.minimum_gap.map(gap) }
    }

    pub(super) fn loads(&self) -> ContactLoads {
        let gap = |saved: SavedGap| {
            let partner = saved.other.map(Partner::Body).or(saved.wall.map(Partner::Wall))?;
            Some(MinimumGap { body: saved.body, partner, gap: saved.gap })
        };
        ContactLoads {
            wrenches: self.wrenches.clone(),
            contacts: Vec::new(),
            minimum_gap: self.minimum_gap.and_then(gap),
        }
    }
}
