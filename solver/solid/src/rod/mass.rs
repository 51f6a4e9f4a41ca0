//! The mass matrix of a rod.

use nalgebra::DMatrix;

use super::hermite::{GAUSS, GAUSS_WEIGHTS, Hermite};
use super::properties::RodProperties;

/// Parts of an element with a Gauss rule each: widths of rounded ends grow like a root.
const PARTS: u32 = 16;

/// Mass matrix of centreline and turning sections, whose knots have `stride` coordinates; of rods in space the
/// last three of them are the vector across.
pub fn mass(rod: &RodProperties, dimension: usize, stride: usize) -> DMatrix<f64> {
    let n = stride * (rod.elements + 1);
    let mut mass = DMatrix::zeros(n, n);
    let length = rod.length / rod.elements as f64;
    for element in 0..rod.elements {
        // Of the four weights of a cubic, where their first components are
        let first = element * stride;
        let line = [0, dimension, stride, stride + dimension].map(|at| first + at);
        let across = [2 * dimension, stride + 2 * dimension].map(|at| first + at);
        for i in 0..PARTS {
            for (part, weight) in GAUSS.iter().zip(GAUSS_WEIGHTS) {
                let xi = (f64::from(i) + part) / f64::from(PARTS);
                let along = (element as f64 + xi) * length;
                let weight = weight * length / f64::from(PARTS);
                let basis = Hermite::at(xi, length);
                let of_line = rod.mass.at(along) * weight;
                let of_turning = rod.section_inertia.at(along) * weight;
                add(&mut mass, &line, &basis.place, of_line, dimension);
                if dimension == 2 {
                    add(&mut mass, &line, &basis.first, of_turning, dimension);
                } else {
                    add(&mut mass, &across, &[1.0 - xi, xi], of_turning, dimension);
                }
            }
        }
    }
    mass
}

/// Adds a mass at the point that some coordinates and those behind them have these weights on.
fn add(
    mass: &mut DMatrix<f64>,
    coordinates: &[usize],
    weights: &[f64],
    amount: f64,
    dimension: usize,
) {
    for (i, a) in coordinates.iter().zip(weights) {
        for (j, b) in coordinates.iter().zip(weights) {
            for axis in 0..dimension {
                mass[(i + axis, j + axis)] += amount * a * b;
            }
        }
    }
}
