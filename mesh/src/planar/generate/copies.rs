//! `Copies`: the points of a torus with as many of their images as the triangles around them need.

use std::collections::HashMap;
use std::f64::consts::SQRT_2;

use super::edges::BoundaryEdge;
use crate::Point;
use crate::number::index_u32;
use crate::planar::torus::Torus;

/// Part of the wanted size by which points are moved, so that no four of them are on a circle, whose
/// images rounding would divide in different ways.
const JITTER: f64 = 1e-6;

/// The golden ratio: the fractional parts of its multiples, as of those of the root of 2, are spread evenly.
const GOLDEN: f64 = 1.618_033_988_749_895;

/// Images are needed up to this many of the largest sizes from the box.
const MARGIN: f64 = 8.0;

/// An image of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Copy {
    /// The point.
    pub vertex: u32,
    /// Whole periods to it.
    pub steps: [i32; 2],
}

/// Points with images of them.
pub struct Copies {
    /// Places (m), those of the points themselves first.
    pub places: Vec<Point<2>>,
    /// The point of each.
    pub of: Vec<Copy>,
    torus: Torus,
}

/// From one number of whole periods to another one.
pub fn steps_between(from: [i32; 2], to: [i32; 2]) -> [i32; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

impl Copies {
    /// Those of points (m) with the sizes wanted there (m); without periods, the points as they are.
    pub fn new(points: &[Point<2>], sizes: &[f64], torus: Torus) -> Self {
        let own = |vertex| Copy { vertex, steps: [0; 2] };
        let of = (0..index_u32(points.len())).map(own).collect();
        let mut copies = Self { places: points.to_vec(), of, torus };
        if torus.is_closed() {
            copies.add_images(sizes);
        }
        copies
    }

    fn add_images(&mut self, sizes: &[f64]) {
        for (i, (place, size)) in self.places.iter_mut().zip(sizes).enumerate() {
            let part = |k: f64| (k * (i + 1) as f64).fract() - 0.5;
            let way = Point::<2>::new(part(GOLDEN), part(SQRT_2)) * (JITTER * size);
            *place = self.torus.inside(*place) + way;
        }
        let margin = MARGIN * sizes.iter().copied().fold(0.0, f64::max);
        let [min, max] = self.torus.corners();
        let n_points = self.places.len();
        for steps in self.neighbours().into_iter().skip(1) {
            let shift = self.torus.periods().shift(steps);
            for vertex in 0..n_points {
                let place = self.places[vertex] + shift;
                if (min - place).max().max((place - max).max()) < margin {
                    self.places.push(place);
                    self.of.push(Copy { vertex: index_u32(vertex), steps });
                }
            }
        }
    }

    /// Whether there are others than the points themselves.
    pub fn has_images(&self) -> bool {
        self.torus.is_closed()
    }

    /// Whole periods to the images around the box, none first.
    fn neighbours(&self) -> Vec<[i32; 2]> {
        let periods = self.torus.periods();
        let steps = |shift| periods.steps(Point::<2>::zeros(), shift);
        periods.shifts().into_iter().map(steps).collect()
    }

    /// Numbers of the ends of edges and of their images.
    pub fn edges(&self, edges: &[BoundaryEdge]) -> Vec<[usize; 2]> {
        let images = self.of.iter().enumerate().map(|(number, copy)| (*copy, number));
        let numbers: HashMap<Copy, usize> =
            if self.torus.is_closed() { images.collect() } else { HashMap::new() };
        let number = |vertex: u32, steps: [i32; 2]| match steps {
            [0, 0] => Some(vertex as usize),
            _ => numbers.get(&Copy { vertex, steps }).copied(),
        };
        let mut all = Vec::new();
        for steps in self.neighbours() {
            for [a, b] in edges.iter().map(|edge| edge.vertices) {
                // The image of the end that is beside the start
                let [from, to] = [a, b].map(|v| self.places[v as usize]);
                let back = self.torus.periods().steps(from, to);
                let ends = number(a, steps).zip(number(b, steps_between(back, steps)));
                all.extend(ends.map(<[usize; 2]>::from));
            }
        }
        all
    }

    /// Whether a triangle of copies stands for all its images: its lowest point is itself.
    pub fn is_original(&self, corners: [usize; 3]) -> bool {
        let lowest =
            corners.map(|number| self.of[number]).into_iter().min_by_key(|copy| copy.vertex);
        lowest.is_some_and(|copy| copy.steps == [0; 2])
    }
}
