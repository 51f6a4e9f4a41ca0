//! `Projections`: the latest places on surfaces that were looked for, so that none is found twice in a row.

use std::cell::RefCell;

use crate::Point;
use crate::spatial::generate::tetrahedra::surface_set::SurfaceSet;
use crate::spatial::geometry::Geometry;

/// Places of the cache, a power of two.
const PLACES: usize = 1 << 16;

#[derive(Debug, Clone, Copy)]
struct Entry {
    surfaces: SurfaceSet,
    from: Point<3>,
    to: Projected,
}

/// A place on one or several surfaces.
#[derive(Debug, Clone, Copy)]
pub struct Projected {
    /// Where (m).
    pub point: Point<3>,
    /// Unit normal of a single surface there, into the fluid; zero on several.
    pub normal: Point<3>,
}

/// A cache with one place for each hash: a projection is a function of its argument alone, so what
/// is in the cache changes no result.
#[derive(Debug)]
pub struct Projections<'a> {
    geometry: &'a Geometry,
    entries: RefCell<Vec<Entry>>,
}

impl<'a> Projections<'a> {
    /// An empty cache of projections onto these surfaces.
    pub fn new(geometry: &'a Geometry) -> Self {
        let to = Projected { point: Point::zeros(), normal: Point::zeros() };
        let empty = Entry { surfaces: SurfaceSet::EMPTY, from: Point::zeros(), to };
        Self { geometry, entries: RefCell::new(vec![empty; PLACES]) }
    }

    /// The place on some surfaces near a point (m), which stays where it is without surfaces.
    pub fn of(&self, surfaces: SurfaceSet, point: Point<3>) -> Projected {
        if surfaces.is_empty() {
            return Projected { point, normal: Point::zeros() };
        }
        let place = place_of(&point);
        let entry = self.entries.borrow()[place];
        if entry.surfaces == surfaces && entry.from == point {
            return entry.to;
        }
        let to = if let [one] = surfaces.as_slice() {
            let foot = self.geometry.foot(usize::from(*one), point);
            Projected { point: foot.point, normal: foot.normal }
        } else {
            let point = self.geometry.project(surfaces.as_slice(), point);
            Projected { point, normal: Point::zeros() }
        };
        self.entries.borrow_mut()[place] = Entry { surfaces, from: point, to };
        to
    }
}

fn place_of(point: &Point<3>) -> usize {
    let mix = |hash: u64, x: &f64| {
        let mixed = (hash ^ x.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        mixed ^ (mixed >> 29)
    };
    let hash = point.iter().fold(0, mix) >> 32;
    usize::try_from(hash).unwrap_or(0) & (PLACES - 1)
}
