//! `PeriodicCell`: a periodic domain cut open where no body is, with the bodies moved into it.

use alewife_mesh::{
    Cut, Domain, Mesh, MeshError, Outline, PlacedShape, Point, Sizing, check_placement, generate,
    generate_along,
};

/// Part of the widest free strip of a periodic domain that has to be left at its sides.
const STRIP_LEFT: f64 = 0.25;

/// A straight strip narrower than this part of the smallest body's size is left to a curved cut.
const STRIP_NARROW: f64 = 0.25;

/// Periods by which a domain may be off where it was at first: it moves by less than one at a time.
const MOST_OFF: f64 = 1.5;

/// A domain ready to be meshed.
#[derive(Debug, Clone)]
pub(in crate::run) struct PeriodicCell {
    /// The domain, where its straight sides are.
    pub domain: Domain,
    /// Whole periods by which each body has been moved (m).
    pub shifts: Vec<Point<2>>,
    /// The bodies, moved.
    pub shapes: Vec<PlacedShape>,
    /// The curved sides of a domain without straight ones that are free.
    cut: Option<Cut>,
}

impl PeriodicCell {
    /// A domain as it is, with bodies where they are.
    pub fn whole(domain: &Domain, shapes: Vec<PlacedShape>) -> Self {
        let shifts = vec![Point::<2>::zeros(); shapes.len()];
        Self { domain: domain.clone(), shifts, shapes, cut: None }
    }

    /// The mesh.
    ///
    /// # Errors
    /// Those of [`generate`] and [`generate_along`].
    pub fn mesh(&self, sizing: &Sizing) -> Result<Mesh<2>, MeshError> {
        match &self.cut {
            None => generate(&self.domain, &self.shapes, sizing),
            Some(cut) => generate_along(cut, &self.domain, &self.shapes, sizing),
        }
    }
}

/// A domain with bodies anywhere, cut where it was if that leaves them enough room, else along other
/// straight lines, else along curves. `home` is the domain as it was at first.
///
/// # Errors
/// When no cut is found.
pub(super) fn choose_periodic_cell(
    domain: &Domain,
    home: &Domain,
    mut shapes: Vec<PlacedShape>,
) -> Result<PeriodicCell, MeshError> {
    let (domain, cut) = match straight(domain, &shapes)? {
        Some(moved) => (returned(moved, home), None),
        None => (home.clone(), Some(Cut::between(home, &shapes)?)),
    };
    let shifts: Vec<Point<2>> = match &cut {
        None => shapes.iter().map(|shape| into(&domain, &shape.center)).collect(),
        Some(cut) => cut.shifts().to_vec(),
    };
    for (shape, shift) in shapes.iter_mut().zip(&shifts) {
        shape.center += shift;
    }
    Ok(PeriodicCell { domain, shifts, shapes, cut })
}

/// A domain as it is where bodies are whole inside it, else as [`choose_periodic_cell`] has it.
///
/// # Errors
/// When no cut is found.
pub(super) fn initial_cell(
    domain: &Domain,
    shapes: Vec<PlacedShape>,
) -> Result<PeriodicCell, MeshError> {
    if domain.images().len() == 1 || check_placement(domain, &shapes).is_ok() {
        return Ok(PeriodicCell::whole(domain, shapes));
    }
    choose_periodic_cell(domain, domain, shapes)
}

/// The domain, its straight periodic sides put where no body is; `None` when bodies leave no free
/// strip.
fn straight(domain: &Domain, shapes: &[PlacedShape]) -> Result<Option<Domain>, MeshError> {
    let mut moved = domain.clone();
    for axis in 0..2 {
        let Some(Period { start, length }) = period(&moved, axis) else { continue };
        let (mut taken, mut smallest) = (Vec::new(), f64::INFINITY);
        for shape in shapes {
            let outline = Outline::new(shape)?;
            let reach = outline.reach();
            smallest = smallest.min(reach);
            let from = (outline.center()[axis] - reach - start).rem_euclid(length);
            taken.push((from, from + 2.0 * reach));
        }
        taken.sort_by(|one, other| one.0.total_cmp(&other.0));
        let Some(&(first, _)) = taken.first() else { continue };
        // Free strips, each from the farthest end so far to the next start.
        let mut end = taken.iter().map(|(_, end)| end - length).fold(f64::NEG_INFINITY, f64::max);
        let mut strips = Vec::new();
        for &(from, to) in taken.iter().chain(&[(first + length, first + length)]) {
            if from > end {
                strips.push((end, from));
            }
            end = end.max(to);
        }
        let widest = strips.iter().copied().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
        let is_wide = |&(from, to): &(f64, f64)| {
            domain.is_axisymmetric() || to - from > STRIP_NARROW * smallest
        };
        let Some((from, to)) = widest.filter(is_wide) else { return Ok(None) };
        let margin = STRIP_LEFT * (to - from);
        let is_free = strips.iter().any(|&(from, to)| {
            [0.0, length].iter().any(|at| at - from >= margin && to - at >= margin)
        });
        if !is_free {
            shift(&mut moved, axis, (0.5 * (from + to)).rem_euclid(length));
        }
    }
    Ok(Some(moved))
}

/// A domain moved back by whole periods where it has gone far.
fn returned(mut domain: Domain, home: &Domain) -> Domain {
    for axis in 0..2 {
        let (Some(Period { start, length }), Some(first)) =
            (period(&domain, axis), period(home, axis))
        else {
            continue;
        };
        let off = (start - first.start) / length;
        if off.abs() > MOST_OFF {
            shift(&mut domain, axis, -off.round() * length);
        }
    }
    domain
}

/// Where a domain is along a periodic axis.
#[derive(Debug, Clone, Copy)]
struct Period {
    start: f64,
    length: f64,
}

/// The period along an axis; `None` where the domain does not repeat.
fn period(domain: &Domain, axis: usize) -> Option<Period> {
    let between = |start: f64, end: f64| Period { start, length: end - start };
    match (domain, axis) {
        (Domain::Box { min, max, periodic_x: true, .. }, 0)
        | (Domain::Box { min, max, periodic_y: true, .. }, 1) => {
            Some(between(min[axis], max[axis]))
        }
        (Domain::Cylinder { x, periodic_x: true, .. }, 0) => Some(between(x[0], x[1])),
        _ => None,
    }
}

/// Where a domain starts along its periodic directions (m), zero along others.
pub(super) fn start_of(domain: &Domain) -> Point<2> {
    Point::<2>::from_fn(|axis, _| period(domain, axis).map_or(0.0, |period| period.start))
}

/// A domain that starts elsewhere along its periodic directions.
pub(super) fn started_at(domain: &Domain, start: &Point<2>) -> Domain {
    let mut moved = domain.clone();
    for axis in 0..2 {
        if let Some(now) = period(domain, axis) {
            shift(&mut moved, axis, start[axis] - now.start);
        }
    }
    moved
}

fn shift(domain: &mut Domain, axis: usize, way: f64) {
    match domain {
        Domain::Box { min, max, .. } => {
            min[axis] += way;
            max[axis] += way;
        }
        Domain::Cylinder { x, .. } => {
            x[0] += way;
            x[1] += way;
        }
        Domain::Disc { .. } | Domain::HalfDisc { .. } => {}
    }
}

/// Whole periods that take a point into the domain (m).
fn into(domain: &Domain, point: &Point<2>) -> Point<2> {
    let mut shift = Point::<2>::zeros();
    for axis in 0..2 {
        if let Some(Period { start, length }) = period(domain, axis) {
            shift[axis] = -((point[axis] - start) / length).floor() * length;
        }
    }
    shift
}

#[cfg(test)]
mod tests {
    use super::*;
    use alewife_mesh::Shape;

    fn disc(x: f64, y: f64) -> PlacedShape {
        PlacedShape {
            name: "disc".into(),
            shape: Shape::Disc { radius: 0.2 },
            center: Point::<2>::new(x, y),
            angle: 0.0,
            size: None,
        }
    }

    fn strip() -> Domain {
        let (min, max) = (Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
        Domain::Box { min, max, periodic_x: true, periodic_y: false }
    }

    #[test]
    fn the_cut_of_a_periodic_domain_keeps_off_the_bodies() {
        let range = |domain: &Domain| period(domain, 0).unwrap().start;
        assert_eq!(range(&straight(&strip(), &[disc(1.0, 0.0)]).unwrap().unwrap()), 0.0);
        // Half way round from a body on the cut, and from one that went round
        for x in [0.1, 2.1, -1.9, 14.1] {
            let moved = straight(&strip(), &[disc(x, 0.0)]).unwrap().unwrap();
            assert!((range(&moved) - 1.1).abs() < 1e-12, "{x}: {moved:?}");
            let inside = x + into(&moved, &Point::<2>::new(x, 0.0)).x;
            assert!((1.1..3.1).contains(&inside), "{x}: {inside}");
        }
        let two = straight(&strip(), &[disc(0.0, 0.5), disc(0.5, 0.0)]).unwrap().unwrap();
        assert!((range(&two) - 1.25).abs() < 1e-12, "{two:?}");
        let height = |i: i32| if i % 2 == 0 { 0.5 } else { -0.5 };
        let named =
            |i| PlacedShape { name: format!("{i}"), ..disc(0.25 * f64::from(i), height(i)) };
        let crowd: Vec<_> = (0..8).map(named).collect();
        assert!(straight(&strip(), &crowd).unwrap().is_none());
        let cell = choose_periodic_cell(&strip(), &strip(), crowd).unwrap();
        assert!(cell.cut.is_some());
        assert!(cell.mesh(&Sizing::graded(0.1, 0.3, 0.4)).is_ok());
    }
}
