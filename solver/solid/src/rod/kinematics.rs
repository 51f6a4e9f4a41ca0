//! `Kinematics`: the strains of an element as functions of its coordinates, and their derivatives.

use nalgebra::{SMatrix, SVector};
use num_dual::{Dual64, DualNum, HyperDual64};

use super::clamp::Element;

/// Reals and dual numbers over them, so that derivatives of strains are exact.
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// What a strain of an element measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrainKind {
    /// Bending or twist (1/m), of which a rod has one in the plane and three in space: by number.
    Flexure(usize),
    /// Length over that at rest, less one.
    Stretch,
    /// What only fixes the vectors across at the knots: no property of the rod depends on it.
    Gauge,
}

/// A strain at a point of an element.
#[derive(Debug, Clone, Copy)]
pub struct StrainPoint {
    /// What it measures.
    pub kind: StrainKind,
    /// Where it is taken, as a part of the element.
    pub xi: f64,
    /// Part of the element that it stands for.
    pub weight: f64,
}

/// An element with N coordinates, which follow each other, and S strains.
pub trait Kinematics<const N: usize, const S: usize>: Send + Sync {
    /// Dimension of space.
    const DIMENSION: usize;

    /// Which strains there are.
    fn points(&self) -> [StrainPoint; S];

    /// The strains of an element of a length (m).
    fn strains<D: Number>(&self, length: f64, coordinates: &[D; N]) -> [D; S];
}

/// Strains and their first derivatives.
pub struct Gradients<const N: usize, const S: usize> {
    pub values: SVector<f64, S>,
    /// Derivatives of a strain (row) by a coordinate.
    pub first: SMatrix<f64, S, N>,
}

/// Derivatives by pairs of coordinates, of each strain.
pub type SecondDerivatives<const N: usize, const S: usize> = [SMatrix<f64, N, N>; S];

/// The strains of an element, with its tangents as clamps have them.
pub fn strains<K: Kinematics<N, S>, D: Number, const N: usize, const S: usize>(
    kinematics: &K,
    element: &Element,
    coordinates: &[D; N],
) -> [D; S] {
    kinematics.strains(element.length, &element.shaped(coordinates))
}

/// Strains with their first derivatives.
pub fn gradients<K: Kinematics<N, S>, const N: usize, const S: usize>(
    kinematics: &K,
    element: &Element,
    coordinates: &SVector<f64, N>,
) -> Gradients<N, S> {
    let mut result = Gradients { values: SVector::zeros(), first: SMatrix::zeros() };
    for j in 0..N {
        let at = std::array::from_fn(|i| Dual64::new(coordinates[i], unit(i == j)));
        for (i, strain) in strains(kinematics, element, &at).iter().enumerate() {
            result.values[i] = strain.re;
            result.first[(i, j)] = strain.eps;
        }
    }
    result
}

/// The second derivatives of strains.
pub fn second_derivatives<K: Kinematics<N, S>, const N: usize, const S: usize>(
    kinematics: &K,
    element: &Element,
    coordinates: &SVector<f64, N>,
) -> SecondDerivatives<N, S> {
    let mut second = [SMatrix::zeros(); S];
    for j in 0..N {
        for k in 0..=j {
            let at = std::array::from_fn(|i| {
                HyperDual64::new(coordinates[i], unit(i == j), unit(i == k), 0.0)
            });
            for (i, strain) in strains(kinematics, element, &at).iter().enumerate() {
                second[i][(j, k)] = strain.eps1eps2;
                second[i][(k, j)] = strain.eps1eps2;
            }
        }
    }
    second
}

fn unit(is_this: bool) -> f64 {
    f64::from(u8::from(is_this))
}
