//! Checks that bodies lie inside the domain and apart from each other.

use crate::number::whole;
use crate::{Domain, MeshError, Outline, PlacedShape, Point, Shape};

/// Gaps below this fraction of a body's size count as contact: no mesh resolves them.
pub const SMALLEST_GAP: f64 = 1e-7;

/// Places per quarter, of a polygon a quarter of all places, at which the search for the smallest gap starts.
const STARTS: usize = 32;

/// Whether bodies can be meshed in a domain: sizes, kinds, names, inside, apart.
///
/// # Errors
/// The first of the reasons found, with the names of the bodies and the gap.
pub fn check_placement(domain: &Domain, bodies: &[PlacedShape]) -> Result<(), MeshError> {
    place(domain, bodies).map(|_| ())
}

/// The same where bodies may lie across the periodic sides of a domain, or beyond them: their images
/// are kept apart, too.
///
/// # Errors
/// Those of [`check_placement`].
pub fn check_wrapped_placement(domain: &Domain, bodies: &[PlacedShape]) -> Result<(), MeshError> {
    place_wrapped(domain, bodies).map(|_| ())
}

/// The outlines of the bodies, once [`check_placement`] holds for them.
pub(crate) fn place(domain: &Domain, bodies: &[PlacedShape]) -> Result<Vec<Outline>, MeshError> {
    place_among(domain, bodies, None)
}

/// The outlines of the bodies, once [`check_wrapped_placement`] holds for them.
pub(crate) fn place_wrapped(
    domain: &Domain,
    bodies: &[PlacedShape],
) -> Result<Vec<Outline>, MeshError> {
    place_among(domain, bodies, Some(&domain.images_of(bodies)))
}

/// The outlines of bodies that are apart from each other and from the sides of a domain; with
/// images, periodic sides do not count, and images do.
fn place_among(
    domain: &Domain,
    bodies: &[PlacedShape],
    images: Option<&[Point<2>]>,
) -> Result<Vec<Outline>, MeshError> {
    check_domain(domain)?;
    let sides = 0..domain.sides().len();
    let sides = sides.filter(|&side| images.is_none() || !domain.is_periodic(side)).collect();
    let distances = Distances { domain, sides, images };
    let mut outlines: Vec<Outline> = Vec::with_capacity(bodies.len());
    for (i, body) in bodies.iter().enumerate() {
        check_kind(domain, body)?;
        check_name_and_size(domain, body, &bodies[..i])?;
        let outline = Outline::new(body)?;
        let smallest_gap = SMALLEST_GAP * extent(&outline);
        let refused = |least: &Least| least.value.is_nan() || least.value <= smallest_gap;
        if let Some(Least { value, at }) = distances.to_sides(&outline).filter(refused) {
            return Err(MeshError::Outside {
                body: body.name.clone(),
                gap: value,
                x: at.x,
                y: at.y,
            });
        }
        let overlap = |other: &PlacedShape, least: Least| MeshError::Overlap {
            first: other.name.clone(),
            second: body.name.clone(),
            gap: least.value,
            x: least.at.x,
            y: least.at.y,
        };
        if let Some(least) = distances.to_own_images(&outline).filter(refused) {
            return Err(overlap(body, least));
        }
        for (other, placed) in bodies.iter().zip(&outlines) {
            let least = distances.between(&outline, placed, smallest_gap);
            if let Some(least) = least.filter(refused) {
                return Err(overlap(other, least));
            }
        }
        outlines.push(outline);
    }
    Ok(outlines)
}

/// Gaps between outlines, and to the sides of a domain that count.
struct Distances<'a> {
    domain: &'a Domain,
    sides: Vec<usize>,
    images: Option<&'a [Point<2>]>,
}

impl Distances<'_> {
    /// Least gap to the sides; `None` where none counts.
    fn to_sides(&self, outline: &Outline) -> Option<Least> {
        let gap = |x: Point<2>| {
            let gaps = self.sides.iter().map(|&side| self.domain.side_gap(side, x));
            gaps.fold(f64::INFINITY, f64::min)
        };
        (!self.sides.is_empty()).then(|| least(outline, gap))
    }

    /// Least gap of an outline to its own images; `None` where they are far.
    fn to_own_images(&self, outline: &Outline) -> Option<Least> {
        let mut own = self.images.iter().flat_map(|images| &images[1..]);
        let are_near = own.any(|shift| shift.norm() < 3.0 * outline.reach());
        are_near.then(|| least(outline, |x| self.gap_to(outline, x, true)))
    }

    /// Least gap between two outlines; `None` where circles around both are farther apart than
    /// this (m).
    fn between(&self, one: &Outline, other: &Outline, smallest_gap: f64) -> Option<Least> {
        if self.apart(other, one.center()) > one.reach() + other.reach() + smallest_gap {
            return None;
        }
        let near = least(one, |x| self.gap_to(other, x, false));
        let far = least(other, |x| self.gap_to(one, x, false));
        Some(if near.value < far.value { near } else { far })
    }

    /// Gap from a point to an outline and its images, or to its images alone.
    fn gap_to(&self, other: &Outline, x: Point<2>, is_own: bool) -> f64 {
        match self.images {
            None => other.nearest(x).gap,
            Some(images) => {
                let images = images.iter().skip(usize::from(is_own));
                images.fold(f64::INFINITY, |gap, shift| {
                    if other.least_gap(x - shift) < gap {
                        gap.min(other.nearest(x - shift).gap)
                    } else {
                        gap
                    }
                })
            }
        }
    }

    /// Distance from a point to the nearest centre of an outline and its images.
    fn apart(&self, other: &Outline, x: Point<2>) -> f64 {
        match self.images {
            None => (x - other.center()).norm(),
            Some(images) => {
                let gaps = images.iter().map(|shift| (x - shift - other.center()).norm());
                gaps.fold(f64::INFINITY, f64::min)
            }
        }
    }
}

fn check_name_and_size(
    domain: &Domain,
    body: &PlacedShape,
    before: &[PlacedShape],
) -> Result<(), MeshError> {
    let is_taken = before.iter().any(|other| other.name == body.name);
    if is_taken || domain.sides().contains(&body.name.as_str()) {
        return Err(MeshError::DuplicateName { name: body.name.clone() });
    }
    match body.size.filter(|size| !(*size > 0.0 && size.is_finite())) {
        Some(value) => Err(MeshError::Body {
            body: body.name.clone(),
            what: "size",
            value,
            wanted: "positive and finite",
        }),
        None => Ok(()),
    }
}

fn check_domain(domain: &Domain) -> Result<(), MeshError> {
    let lengths = match domain {
        Domain::Box { min, max, .. } => {
            vec![("box width", max.x - min.x), ("box height", max.y - min.y)]
        }
        Domain::Disc { radius, .. } | Domain::HalfDisc { radius, .. } => vec![("radius", *radius)],
        Domain::Cylinder { x, radius, .. } => {
            vec![("cylinder length", x[1] - x[0]), ("radius", *radius)]
        }
    };
    match lengths.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((what, value)) => Err(MeshError::Domain { what, value }),
        None => Ok(()),
    }
}

fn check_kind(domain: &Domain, body: &PlacedShape) -> Result<(), MeshError> {
    let (shape, axisymmetric) = match body.shape {
        Shape::Disc { .. } => ("a disc", false),
        Shape::Ellipse { .. } => ("an ellipse", false),
        Shape::Spline { .. } => ("a spline", false),
        Shape::Polygon { .. } => ("a polygon", false),
        Shape::Curve { .. } => ("a closed curve", false),
        Shape::Sphere { .. } => ("a sphere", true),
        Shape::Spheroid { .. } => ("a spheroid", true),
        Shape::Revolved { .. } => ("a turned profile", true),
    };
    if axisymmetric != domain.is_axisymmetric() {
        let (domain, remedy) = if axisymmetric {
            ("a planar", "disc, ellipse, spline or polygon")
        } else {
            ("an axisymmetric", "sphere, spheroid or turned profile")
        };
        return Err(MeshError::ShapeKind { body: body.name.clone(), shape, domain, remedy });
    }
    if axisymmetric && (body.center.y != 0.0 || body.angle != 0.0) {
        return Err(MeshError::OffAxis {
            body: body.name.clone(),
            y: body.center.y,
            angle: body.angle,
        });
    }
    Ok(())
}

/// Distance between the extreme points of an outline (m), its larger one.
fn extent(outline: &Outline) -> f64 {
    if outline.is_polygon() {
        return outline.reach();
    }
    let point = |quarter| outline.evaluate(quarter, 0.0)[0];
    (point(0) - point(2)).norm().max((point(1) - point(3)).norm())
}

/// Smallest value of a function over an outline.
#[derive(Debug, Clone, Copy)]
struct Least {
    value: f64,
    /// Where (m).
    at: Point<2>,
}

/// Smallest value of a function over an outline: samples, then golden sections.
fn least(outline: &Outline, f: impl Fn(Point<2>) -> f64) -> Least {
    let pieces = outline.n_pieces();
    let starts = (4 * STARTS / pieces).max(2);
    let n = pieces * starts;
    let at = |u: f64| {
        let u = u.rem_euclid(pieces as f64);
        let quarter = whole(u).min(pieces - 1);
        outline.evaluate(quarter, u - quarter as f64)[0]
    };
    let step = 1.0 / starts as f64;
    let values: Vec<f64> = (0..n).map(|i| f(at(i as f64 * step))).collect();
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut best = Least { value: f64::INFINITY, at: at(0.0) };
    for i in 0..n {
        let (before, after) = (values[(i + n - 1) % n], values[(i + 1) % n]);
        let hopeless = values[i] > lowest + 0.1 * (highest - lowest);
        if values[i] > before || values[i] > after || hopeless {
            continue;
        }
        let u = golden((i as f64 - 1.0) * step, (i as f64 + 1.0) * step, |u| f(at(u)));
        for u in [u, i as f64 * step] {
            let value = f(at(u));
            if value < best.value || value.is_nan() {
                best = Least { value, at: at(u) };
            }
        }
    }
    // No search may end above what a sample has seen
    match (0..n).find(|&i| values[i] == lowest) {
        Some(i) if best.value > lowest || best.value.is_nan() => {
            Least { value: lowest, at: at(i as f64 * step) }
        }
        _ => best,
    }
}

/// Minimum of a function that falls, then rises, on an interval.
fn golden(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut p, mut q) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut at_p, mut at_q) = (f(p), f(q));
    for _ in 0..48 {
        if at_p < at_q {
            (high, q, at_q) = (q, p, at_p);
            p = high - RATIO * (high - low);
            at_p = f(p);
        } else {
            (low, p, at_p) = (p, q, at_q);
            q = low + RATIO * (high - low);
            at_q = f(q);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(name: &str, x: f64, y: f64, radius: f64) -> PlacedShape {
        PlacedShape {
            name: name.into(),
            shape: Shape::Disc { radius },
            center: Point::<2>::new(x, y),
            angle: 0.0,
            size: None,
        }
    }

    const UNIT: Domain = Domain::Disc { center: Point::<2>::new(0.0, 0.0), radius: 10.0 };

    #[test]
    fn apart_and_inside_is_accepted_down_to_a_small_gap() {
        let bodies = [disc("a", 0.0, 0.0, 1.0), disc("b", 2.000_01, 0.0, 1.0)];
        assert_eq!(check_placement(&UNIT, &bodies), Ok(()));
    }

    #[test]
    fn overlap_is_refused_with_its_depth_and_both_names() {
        for x in [1.9, 1.0, 2.0] {
            let bodies = [disc("a", 0.0, 0.0, 1.0), disc("b", x, 0.0, 1.0)];
            match check_placement(&UNIT, &bodies) {
                Err(MeshError::Overlap { first, second, gap, .. }) => {
                    assert_eq!((first.as_str(), second.as_str()), ("a", "b"));
                    assert!((gap - (x - 2.0)).abs() < 1e-9, "{gap}");
                }
                other => panic!("{other:?}"),
            }
        }
        // One inside the other
        let bodies = [disc("a", 0.0, 0.0, 1.0), disc("b", 0.1, 0.0, 3.0)];
        assert!(matches!(check_placement(&UNIT, &bodies), Err(MeshError::Overlap { .. })));
    }

    #[test]
    fn spheroids_that_cross_on_the_axis_overlap() {
        let domain = Domain::HalfDisc { center: 0.2, radius: 4.0 };
        let spheroid = |name: &str, x: f64, semi_axes| PlacedShape {
            name: name.to_owned(),
            shape: Shape::Spheroid { semi_axes },
            center: Point::<2>::new(x, 0.0),
            angle: 0.0,
            size: None,
        };
        let flat = [0.3424411791923699, 1.1463715792599185];
        let round = [0.8362552227128046, 0.7383780411761944];
        let bodies = [
            spheroid("flat", 0.09736181242456764, flat),
            spheroid("round", 0.33260513598753466, round),
        ];
        let refused = check_placement(&domain, &bodies);
        assert!(matches!(refused, Err(MeshError::Overlap { .. })), "{refused:?}");
    }

    #[test]
    fn a_body_that_leaves_the_domain_is_refused_with_its_gap() {
        match check_placement(&UNIT, &[disc("a", 9.5, 0.0, 1.0)]) {
            Err(MeshError::Outside { gap, x, .. }) => {
                assert!((gap + 0.5).abs() < 1e-9 && (x - 10.5).abs() < 1e-6);
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn kinds_sizes_names_and_the_axis_are_checked() {
        let half = Domain::HalfDisc { center: 0.0, radius: 5.0 };
        let sphere =
            PlacedShape { shape: Shape::Sphere { radius: 1.0 }, ..disc("s", 0.0, 0.1, 1.0) };
        let error = |domain: &Domain, body: PlacedShape| {
            check_placement(domain, &[body]).expect_err("is refused")
        };
        assert!(matches!(error(&half, sphere), MeshError::OffAxis { y: 0.1, .. }));
        assert!(matches!(error(&half, disc("a", 0.0, 0.0, 1.0)), MeshError::ShapeKind { .. }));
        assert!(matches!(error(&UNIT, disc("a", 0.0, 0.0, -1.0)), MeshError::Body { .. }));
        assert!(matches!(
            error(&UNIT, disc("wall", 0.0, 0.0, 1.0)),
            MeshError::DuplicateName { .. }
        ));
        let flat = Domain::Cylinder { x: [1.0, 1.0], radius: 1.0, periodic_x: false };
        assert!(matches!(check_placement(&flat, &[]), Err(MeshError::Domain { .. })));
    }
}
