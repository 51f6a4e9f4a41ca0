//! Quadrature on the reference triangle and tetrahedron, and shape functions of their nodes.

use alewife_mesh::{Point, Simplex};

use crate::solid::mesh::Order;

/// A point of a rule, by barycentric coordinates; weights add to one.
#[derive(Debug, Clone, Copy)]
pub(super) struct RulePoint {
    /// Barycentric coordinates, D + 1 of them.
    pub at: [f64; 4],
    /// Part of the volume of the cell.
    pub weight: f64,
}

/// All points with one coordinate that differs from the others, which are `same`.
fn around<const D: usize>(same: f64, weight: f64) -> Vec<RulePoint> {
    let corner = |i: usize| {
        let other = 1.0 - D as f64 * same;
        let at = std::array::from_fn(|j| match j {
            _ if j > D => 0.0,
            _ if i == j => other,
            _ => same,
        });
        RulePoint { at, weight }
    };
    (0..=D).map(corner).collect()
}

/// A rule that integrates exactly what a cell of this order needs where its sides are straight: polynomials
/// of degree four for quadratic ones, around the axis of degree two for linear ones.
///
/// # Source
/// @dunavant1985 in the triangle, @walkington2000 in the tetrahedron.
pub(super) fn rule<const D: usize>(order: Order, is_axis: bool) -> Vec<RulePoint> {
    match (order, D) {
        (Order::Linear, _) if !is_axis => around::<D>(1.0 / (D as f64 + 1.0), 1.0)[..1].to_vec(),
        (Order::Linear, _) => around::<D>(1.0 / 6.0, 1.0 / 3.0),
        (Order::Quadratic, 2) => [
            around::<D>(0.445_948_490_915_964_9, 0.223_381_589_678_011_47),
            around::<D>(0.091_576_213_509_770_74, 0.109_951_743_655_321_87),
        ]
        .concat(),
        (Order::Quadratic, _) => {
            let (near, far) = (0.045_503_704_125_649_65, 0.454_496_295_874_350_35);
            let middle = |[i, j]: &[usize; 2]| RulePoint {
                at: std::array::from_fn(|k| if k == *i || k == *j { far } else { near }),
                weight: 6.0 * 0.007_091_003_462_846_911,
            };
            [
                around::<D>(0.310_885_919_263_300_6, 6.0 * 0.018_781_320_953_002_64),
                around::<D>(0.092_735_250_310_891_23, 6.0 * 0.012_248_840_519_393_658),
                Simplex::<3>::EDGES.iter().map(middle).collect(),
            ]
            .concat()
        }
    }
}

/// Shape functions of the nodes of a cell at barycentric coordinates.
pub(super) fn shapes<const D: usize>(order: Order, at: [f64; 4]) -> Vec<f64> {
    match order {
        Order::Linear => at[..=D].to_vec(),
        Order::Quadratic => {
            let vertices = at[..=D].iter().map(|l| l * (2.0 * l - 1.0));
            let edges = Simplex::<D>::EDGES.iter().map(|[i, j]| 4.0 * at[*i] * at[*j]);
            vertices.chain(edges).collect()
        }
    }
}

/// Gradients of the shape functions, from those of the barycentric coordinates.
pub(super) fn gradients<const D: usize>(
    order: Order,
    at: [f64; 4],
    barycentric: &[Point<D>],
) -> Vec<Point<D>> {
    match order {
        Order::Linear => barycentric.to_vec(),
        Order::Quadratic => {
            let vertices = (0..=D).map(|i| barycentric[i] * (4.0 * at[i] - 1.0));
            let edges = Simplex::<D>::EDGES
                .iter()
                .map(|[i, j]| (barycentric[*j] * at[*i] + barycentric[*i] * at[*j]) * 4.0);
            vertices.chain(edges).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of a product of powers of barycentric coordinates over a simplex.
    fn exact(powers: &[i32], d: i32) -> f64 {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        let total: i32 = powers.iter().sum();
        powers.iter().map(|p| factorial(*p)).product::<f64>() * factorial(d) / factorial(total + d)
    }

    fn check<const D: usize>(order: Order, is_axis: bool, degree: i32) {
        let rule = rule::<D>(order, is_axis);
        for a in 0..=degree {
            for b in 0..=degree - a {
                for c in 0..=(degree - a - b) {
                    let powers = [a, b, c];
                    let sum: f64 = rule
                        .iter()
                        .map(|p| {
                            p.weight * (0..3).map(|i| p.at[i].powi(powers[i])).product::<f64>()
                        })
                        .sum();
                    let d = i32::try_from(D).expect("it is small");
                    assert!((sum - exact(&powers, d)).abs() < 1e-15, "{D} {powers:?} {sum}");
                }
            }
        }
    }

    #[test]
    fn rules_are_exact_to_their_degree() {
        check::<2>(Order::Linear, false, 1);
        check::<2>(Order::Linear, true, 2);
        check::<3>(Order::Linear, false, 1);
        check::<2>(Order::Quadratic, false, 4);
        check::<3>(Order::Quadratic, false, 5);
    }
}
