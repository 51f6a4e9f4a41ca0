//! `SoftBody`: a solid under loads facet by facet.

use alewife_mesh::Point;
use alewife_solid::solid::{Frame, Solid};

use super::facets::{Attitude, FacetLaw, add_area_slope, area};

/// Parts of a load that the corners and middles of a facet take: integrals of their shape functions.
const PARTS: [&[f64]; 4] = [
    &[0.5, 0.5],
    &[1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
    &[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
    &[0.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
];

/// A solid, and the loads of the fluid it swims in; without any it moves as in vacuum.
#[derive(Debug, Clone)]
pub struct SoftBody<const D: usize> {
    /// The solid.
    pub solid: Solid<D>,
    /// The law of its loads.
    pub law: Option<FacetLaw>,
}

/// Derivatives of z . f, with the loads f of a state.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LoadSlopes {
    pub places: Vec<f64>,
    pub velocities: Vec<f64>,
    pub drag: Vec<f64>,
    pub thrust: Vec<f64>,
}

/// Values at the nodes of a facet.
fn at_nodes<const D: usize>(nodes: &[usize], all: &[f64]) -> Vec<Point<D>> {
    nodes.iter().map(|node| Point::from_column_slice(&all[D * node..D * (node + 1)])).collect()
}

/// Mean over a facet.
fn mean<const D: usize>(nodes: &[usize], parts: &[f64], all: &[f64]) -> Point<D> {
    let mut sum = Point::zeros();
    for (node, part) in nodes.iter().zip(parts) {
        sum += Point::<D>::from_column_slice(&all[D * node..D * (node + 1)]) * *part;
    }
    sum
}

/// Parts of the nodes of a facet.
fn parts<const D: usize>(n_nodes: usize) -> &'static [f64] {
    PARTS[2 * (D - 2) + usize::from(n_nodes > D)]
}

impl<const D: usize> SoftBody<D> {
    fn is_axis(&self) -> bool {
        self.solid.spec().frame == Frame::Axis
    }

    /// Loads (N) on all components, in a state with these places (m) and velocities (m/s).
    #[must_use]
    pub fn loads(&self, places: &[f64], velocities: &[f64]) -> Vec<f64> {
        let mut loads = vec![0.0; places.len()];
        let Some(law) = &self.law else { return loads };
        for facet in &self.solid.spec().mesh.facets {
            let parts = parts::<D>(facet.nodes.len());
            let corners = at_nodes::<D>(&facet.nodes[..D], places);
            let load = law.load(&Attitude {
                area: area(&corners, self.is_axis()),
                velocity: mean(&facet.nodes, parts, velocities),
            });
            for (node, part) in facet.nodes.iter().zip(parts) {
                for i in 0..D {
                    loads[D * node + i] += part * load[i];
                }
            }
        }
        loads
    }

    /// Derivatives of z . f by the state and by the points of the curves.
    pub(super) fn load_slopes(&self, places: &[f64], velocities: &[f64], z: &[f64]) -> LoadSlopes {
        let n = |curve: fn(&FacetLaw) -> usize| vec![0.0; self.law.as_ref().map_or(0, curve)];
        let mut slopes = LoadSlopes {
            places: vec![0.0; places.len()],
            velocities: vec![0.0; places.len()],
            drag: n(|law| law.drag.points().len()),
            thrust: n(|law| law.thrust.points().len()),
        };
        let Some(law) = &self.law else { return slopes };
        for facet in &self.solid.spec().mesh.facets {
            let parts = parts::<D>(facet.nodes.len());
            let corners = at_nodes::<D>(&facet.nodes[..D], places);
            let attitude = Attitude {
                area: area(&corners, self.is_axis()),
                velocity: mean(&facet.nodes, parts, velocities),
            };
            let z = mean(&facet.nodes, parts, z);
            let found = law.slopes(&attitude, &z, &mut slopes.drag, &mut slopes.thrust);
            let mut by_corners = [Point::<D>::zeros(); 3];
            add_area_slope(&corners, self.is_axis(), &found.area, &mut by_corners);
            for (k, node) in facet.nodes.iter().enumerate() {
                for i in 0..D {
                    slopes.velocities[D * node + i] += parts[k] * found.velocity[i];
                    if k < D {
                        slopes.places[D * node + i] += by_corners[k][i];
                    }
                }
            }
        }
        slopes
    }
}
