//! Checks that bodies in space lie inside the domain and apart from each other.

use nalgebra::Translation3;

use super::curve::Centreline;
use super::domain::Domain;
use super::geometry::{sides, surfaces_of};
use super::imported::Imported;
use super::least_gap::{Least, STARTS, least_gap};
use super::shape::{Body, Shape};
use super::surface::SmoothSurface;
use crate::periods::Periods;
use crate::{MeshError, Point, SMALLEST_GAP};

/// Whether bodies can be meshed in a domain: sizes, names, inside, apart.
///
/// # Errors
/// The first of the reasons found, with the names of the bodies and the gap.
pub fn check_placement(domain: &Domain, bodies: &[Body]) -> Result<(), MeshError> {
    check_domain(domain)?;
    let (walls, names) = (sides(domain), domain.sides());
    let periods = Periods::new(domain.periods());
    for (i, body) in bodies.iter().enumerate() {
        check_body(domain, body, &bodies[..i])?;
        for surface in surfaces_of(body)? {
            if let Domain::Imported(imported) = domain {
                check_inside(imported, body, &surface)?;
            }
            for (side, wall) in walls.iter().enumerate() {
                let is_endless = surface.endless_axis().is_some();
                // Other bodies go through periodic sides
                let is_open =
                    if domain.is_periodic(side) { !is_endless } else { surface.goes_through(wall) };
                if is_open {
                    continue;
                }
                let gap = least_gap(&surface, wall);
                if gap.is_refused(&surface) && domain.is_periodic(side) {
                    return Err(MeshError::BodyMeetsPeriodicSide {
                        body: body.name.clone(),
                        side: names[side].into(),
                        gap: gap.value,
                        at: gap.at.into(),
                    });
                }
                // A body that crosses a plane of symmetry is cut by it
                if gap.is_refused(&surface) && !domain.is_symmetric(side) {
                    return Err(MeshError::BodyMeetsSide {
                        body: body.name.clone(),
                        side: names[side].into(),
                        gap: gap.value,
                        at: gap.at.into(),
                    });
                }
            }
            for other in &bodies[..i] {
                for facing in surfaces_of(other)? {
                    check_apart_from_images(body, &surface, other, &facing, &periods)?;
                }
            }
            let own = if periods.is_any() { surfaces_of(body)? } else { Vec::new() };
            for facing in own {
                check_apart_from_images(body, &surface, body, &facing, &periods)?;
            }
        }
    }
    Ok(())
}

/// Planes of symmetry that cut a body, by the index of their side.
///
/// # Errors
/// When the body has no surface.
pub fn cutting_planes(domain: &Domain, body: &Body) -> Result<Vec<usize>, MeshError> {
    let surfaces = surfaces_of(body)?;
    let cuts = |wall: &SmoothSurface| {
        surfaces.iter().any(|surface| least_gap(surface, wall).is_refused(surface))
    };
    let walls = sides(domain).into_iter().enumerate();
    Ok(walls
        .filter(|(side, wall)| domain.is_symmetric(*side) && cuts(wall))
        .map(|(side, _)| side)
        .collect())
}

/// Whether a part of a body is inside a given mesh: places all around it are, and none of the sides is
/// in it.
fn check_inside(
    imported: &Imported,
    body: &Body,
    surface: &SmoothSurface,
) -> Result<(), MeshError> {
    let refuse = |side: usize, gap: f64, at: Point<3>| {
        let side = imported.mesh().boundaries[side].name.as_str().into();
        Err(MeshError::BodyMeetsSide { body: body.name.clone(), side, gap, at: at.into() })
    };
    let n_sides = imported.mesh().boundaries.len();
    for at in surface.places(STARTS) {
        if !imported.contains(at) {
            let gaps = (0..n_sides).map(|side| imported.side(side).foot(at).gap.abs()).enumerate();
            let nearest = gaps.min_by(|one, other| one.1.total_cmp(&other.1));
            let (side, gap) = nearest.unwrap_or_default();
            return refuse(side, -gap, at);
        }
    }
    for side in 0..n_sides {
        let gaps = imported.side(side).points().map(|point| (surface.gap(point), point));
        if let Some((gap, at)) = gaps.min_by(|one, other| one.0.total_cmp(&other.0))
            && gap <= 0.0
        {
            return refuse(side, gap, at);
        }
    }
    Ok(())
}

/// Whether a part of a body is apart from a part of another one.
fn check_apart(
    body: &Body,
    surface: &SmoothSurface,
    other: &Body,
    facing: &SmoothSurface,
) -> Result<(), MeshError> {
    let apart = (surface.origin() - facing.origin()).norm();
    // Never so of a cylinder without ends
    if apart > (surface.reach() + facing.reach()) * (1.0 + SMALLEST_GAP) {
        return Ok(());
    }
    let gap = match (surface.endless_axis(), facing.endless_axis()) {
        (None, None) => {
            let [one, two] = [least_gap(surface, facing), least_gap(facing, surface)];
            if two.value < one.value { two } else { one }
        }
        (None, Some(_)) => least_gap(surface, facing),
        (Some(_), None) => least_gap(facing, surface),
        (Some(one), Some(other)) => between_axes(surface, facing, &one.cross(&other)),
    };
    if gap.is_refused(surface) {
        return Err(MeshError::BodiesMeet {
            first: other.name.clone(),
            second: body.name.clone(),
            gap: gap.value,
            at: gap.at.into(),
        });
    }
    Ok(())
}

/// Whether a part of a body is apart from all images of a part of another one, or of its own but itself.
fn check_apart_from_images(
    body: &Body,
    surface: &SmoothSurface,
    other: &Body,
    facing: &SmoothSurface,
    periods: &Periods<3>,
) -> Result<(), MeshError> {
    let is_own = body.name == other.name;
    let nearest = periods.beside(facing.origin(), surface.origin()) - facing.origin();
    for shift in periods.shifts().into_iter().map(|shift| nearest + shift) {
        if is_own && shift.norm() < 0.5 * periods.shortest() {
            continue;
        }
        let image = facing.moved(&Translation3::from(shift).into());
        match check_apart(body, surface, other, &image) {
            Err(MeshError::BodiesMeet { second: body, gap, at, .. }) if is_own => {
                return Err(MeshError::BodyMeetsImage { body, gap, at });
            }
            checked => checked?,
        }
    }
    Ok(())
}

/// Gap between two cylinders without ends, whose axes have this product.
fn between_axes(one: &SmoothSurface, other: &SmoothSurface, normal: &Point<3>) -> Least {
    let way = other.origin() - one.origin();
    let distance = if normal.norm() > 0.5 {
        way.dot(normal).abs()
    } else {
        let along = one.endless_axis().unwrap_or_default();
        (way - along * along.dot(&way)).norm()
    };
    Least { value: distance - one.scale() - other.scale(), at: one.origin() + way * 0.5 }
}

fn check_domain(domain: &Domain) -> Result<(), MeshError> {
    let [min, max] = domain.corners();
    let what = match domain {
        Domain::Box { .. } => ["max x - min x", "max y - min y", "max z - min z"],
        Domain::Cylinder { .. } => ["length", "radius", "radius"],
        Domain::Ball { .. } => ["radius"; 3],
        Domain::Imported(_) => ["width"; 3],
    };
    for (axis, what) in what.into_iter().enumerate() {
        let value = max[axis] - min[axis];
        if !value.is_finite() || value <= 0.0 {
            return Err(MeshError::Domain { what, value });
        }
    }
    Ok(())
}

fn check_body(domain: &Domain, body: &Body, others: &[Body]) -> Result<(), MeshError> {
    let is_taken = others.iter().any(|other| other.name == body.name);
    if is_taken || domain.sides().contains(&body.name.as_str()) {
        return Err(MeshError::DuplicateName { name: body.name.clone() });
    }
    let refuse =
        |what, value, wanted| Err(MeshError::Body { body: body.name.clone(), what, value, wanted });
    if body.parts.is_empty() {
        return refuse("number of parts", 0.0, "at least 1");
    }
    if let Some(size) = body.size
        && (size.is_nan() || size <= 0.0)
    {
        return refuse("size", size, "positive");
    }
    for part in &body.parts {
        for Length { what, value } in lengths(&part.shape) {
            if !value.is_finite() || value <= 0.0 {
                return refuse(what, value, "positive and finite");
            }
        }
        if matches!(part.shape, Shape::Cylinder { .. }) {
            let axis: Point<3> = body.pose * part.pose * nalgebra::Vector3::x();
            let off_axis = 1.0 - axis.amax();
            if !matches!(domain, Domain::Box { .. }) || off_axis > 1e-12 {
                let wanted = "0: the axis is along x, y or z of a box";
                return refuse("axis off the normals of sides", off_axis, wanted);
            }
            if body.parts.len() > 1 {
                let n = body.parts.len() as f64;
                return refuse("number of parts", n, "1 of a cylinder without ends");
            }
        }
        if let Shape::Tube { centreline, radius } = &part.shape
            && *radius >= centreline.widest_tube()
        {
            return refuse("radius", *radius, "so small that the tube does not meet itself");
        }
    }
    Ok(())
}

/// A length of a shape and its name.
struct Length {
    what: &'static str,
    value: f64,
}

/// The lengths of a shape that must be positive.
fn lengths(shape: &Shape) -> Vec<Length> {
    let all = match shape {
        Shape::Sphere { radius } | Shape::Cylinder { radius } => vec![("radius", *radius)],
        Shape::Ellipsoid { semi_axes } => semi_axes.map(|axis| ("semi_axes", axis)).to_vec(),
        Shape::Capsule { radius, length } => vec![("radius", *radius), ("length", *length)],
        // Checked where its surface is made
        Shape::Revolved { .. } | Shape::Slender(_) | Shape::Triangulated(_) => Vec::new(),
        Shape::Tube { centreline, radius } => {
            let mut all = vec![("radius", *radius)];
            if let Centreline::Helix { radius, pitch, turns } = centreline {
                all.push(("|helix.turns|", turns.abs()));
                all.extend([("helix.radius", *radius), ("helix.pitch", *pitch)]);
            }
            all
        }
    };
    all.into_iter().map(|(what, value)| Length { what, value }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Isometry3;

    fn sphere(name: &str, at: [f64; 3]) -> Body {
        Body::new(name, Shape::Sphere { radius: 1.0 }, Isometry3::translation(at[0], at[1], at[2]))
    }

    #[test]
    fn bodies_outside_or_in_each_other_are_refused() {
        let domain = Domain::walls(Point::<3>::repeat(-3.0), Point::<3>::repeat(3.0));
        let check = |bodies: &[Body]| check_placement(&domain, bodies);
        assert!(check(&[sphere("a", [0.0, -1.0, 0.0]), sphere("b", [0.0, 1.001, 0.0])]).is_ok());
        match check(&[sphere("a", [0.0, 0.0, 2.1])]) {
            Err(MeshError::BodyMeetsSide { side, gap, at, .. }) => {
                assert_eq!(&*side, "front");
                assert!(gap < 0.0 && at[2] > 2.9, "{gap} {at:?}");
            }
            other => panic!("{other:?}"),
        }
        match check(&[sphere("a", [0.0; 3]), sphere("b", [0.0, 1.9, 0.0])]) {
            Err(MeshError::BodiesMeet { first, second, .. }) => {
                assert_eq!([first.as_str(), second.as_str()], ["a", "b"]);
            }
            other => panic!("{other:?}"),
        }
        let inside = Shape::Ellipsoid { semi_axes: [0.3, 0.2, 0.1] };
        let inside = Body::new("b", inside, Isometry3::translation(0.2, 0.0, 0.0));
        assert!(check(&[sphere("a", [0.0; 3]), inside]).is_err());
        let named = check(&[sphere("top", [0.0; 3])]);
        assert!(matches!(named, Err(MeshError::DuplicateName { .. })));
    }

    /// Nothing but the last digits keeps bodies apart that touch.
    #[test]
    fn bodies_that_touch_are_refused() {
        let domain = Domain::walls(Point::<3>::repeat(-3.0), Point::<3>::repeat(3.0));
        let ellipsoid = |semi_axes| Shape::Ellipsoid { semi_axes };
        let egg = |name: &str, semi_axes, y: f64| {
            Body::new(name, ellipsoid(semi_axes), Isometry3::translation(0.1, y, 0.0))
        };
        let below = egg("a", [1.5, 0.5, 0.8], -0.5);
        for (above, is_apart) in [(0.0, false), (1e-9, false), (1e-3, true)] {
            let pair = [below.clone(), egg("b", [0.9, 0.7, 1.4], 0.7 + above)];
            assert_eq!(check_placement(&domain, &pair).is_ok(), is_apart, "{above}");
            let top = egg("b", [0.9, 0.7, 1.4], 2.3 - above);
            assert_eq!(check_placement(&domain, &[top]).is_ok(), is_apart, "{above}");
        }
        match check_placement(&domain, &[below, sphere("b", [0.1, 0.9, 0.0])]) {
            Err(MeshError::BodiesMeet { gap, .. }) => assert!((gap + 0.1).abs() < 1e-12, "{gap}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_gap_of_ellipsoid_and_wall_is_found() {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.4, 0.7, -0.3);
        let semi_axes = [1.0, 0.4, 0.2];
        let body = Body::new("a", Shape::Ellipsoid { semi_axes }, nalgebra::convert(turn));
        let surface = surfaces_of(&body).unwrap().remove(0);
        let plane = SmoothSurface::plane(Point::<3>::new(0.0, 0.0, -1.1), 2, 1.0);
        // The support function of an ellipsoid
        let normal = turn.inverse() * Point::<3>::z();
        let half = Point::from(semi_axes).component_mul(&normal).norm();
        let least = least_gap(&surface, &plane);
        assert!((least.value - (1.1 - half)).abs() < 1e-6, "{}", least.value);
    }
}
