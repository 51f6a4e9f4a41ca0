//! The sum of a function over a domain, by squares or cubes that are halved until it hardly changes.

use crate::{Point, interrupt};

/// A square of the plane or a cube of space.
#[derive(Debug, Clone, Copy)]
pub struct Cube<const D: usize> {
    /// Its middle (m).
    pub center: Point<D>,
    /// Half its edge (m).
    pub half: f64,
    /// How often it was halved.
    pub depth: u32,
}

impl<const D: usize> Cube<D> {
    /// The cubes of half its edge, those along the first axis one after the other.
    fn parts(&self) -> impl Iterator<Item = Self> + use<D> {
        let Self { center, half, depth } = *self;
        let half = 0.5 * half;
        (0..1_u32 << D).map(move |corner| {
            let to = |axis: usize| if corner >> axis & 1 == 1 { half } else { -half };
            let center = center + Point::from_fn(|axis, _| to(axis));
            Self { center, half, depth: depth + 1 }
        })
    }
}

/// The sum of what `value` gives for cubes and, where it gives none, for their parts; infinite above
/// a limit, and up to where it was asked to end.
pub fn sum_over<const D: usize>(
    cubes: impl IntoIterator<Item = Cube<D>>,
    limit: f64,
    value: impl Fn(&Cube<D>) -> Option<f64>,
) -> f64 {
    let mut total = 0.0;
    let mut stack = Vec::new();
    for cube in cubes {
        stack.push(cube);
        while let Some(cube) = stack.pop() {
            match value(&cube) {
                Some(value) => total += value,
                None => stack.extend(cube.parts()),
            }
            if total > limit {
                return f64::INFINITY;
            }
            if interrupt::is_requested() {
                return total;
            }
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_cube_have_its_volume() {
        let cube = Cube { center: Point::<3>::new(1.0, 2.0, 3.0), half: 0.5, depth: 0 };
        let volume = |cube: &Cube<3>| (cube.depth == 3).then(|| (2.0 * cube.half).powi(3));
        assert_eq!(sum_over([cube, cube], 10.0, volume), 2.0);
        assert_eq!(sum_over([cube, cube], 1.5, volume), f64::INFINITY);
        let center = |cube: &Cube<3>| (cube.depth == 1).then(|| cube.center.x / 8.0);
        assert_eq!(sum_over([cube], 10.0, center), 1.0);
    }
}
