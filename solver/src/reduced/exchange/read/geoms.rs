//! Geoms of MJCF: their masses, and the ellipsoids of the fluid.

use alewife_reduced::tree::Pose;
use nalgebra::Vector3;

use super::defaults::Element;
use super::mass::{Mass, Solid};
use super::source::{Read, refuse};
use super::turn::{Angles, from_z, rotation};
use crate::reduced::exchange::robot::RobotEllipsoid;

/// Coefficients of an ellipsoid where none are written.
const COEFFICIENTS: [f64; 5] = [0.5, 0.25, 1.5, 1.0, 1.0];

/// Density of a geom where none is written (kg/m3).
const DENSITY: f64 = 1000.0;

/// What is known of a geom.
#[derive(Debug, Clone, Copy)]
pub(super) struct Geom {
    pub pose: Pose<f64>,
    /// Its shape; none of a mesh.
    pub solid: Option<Solid>,
    /// In the frame of the body; none of a mesh.
    pub mass: Option<Mass>,
    /// Its ellipsoid in a fluid, if it has one.
    pub ellipsoid: Option<RobotEllipsoid>,
}

/// Reads a geom.
///
/// # Errors
/// When it is of no known shape, or a mesh in the fluid.
pub(super) fn geom(element: &Element<'_, '_, '_>, angles: &Angles) -> Read<Geom> {
    let node = element.node;
    let is_mesh = element.text("mesh").is_some();
    let kind = if is_mesh { "mesh" } else { element.text("type").unwrap_or("sphere") };
    let in_fluid = element.text("fluidshape") == Some("ellipsoid");
    if !["sphere", "capsule", "ellipsoid", "cylinder", "box"].contains(&kind) {
        if in_fluid {
            return refuse(
                node,
                format!("the loads of a {kind} are not known here"),
                "an ellipsoid in its place, with the half lengths that MuJoCo has for it: geom_size \
                 of the compiled model",
            );
        }
        let pose = Pose::identity();
        return Ok(Geom { pose, solid: None, mass: None, ellipsoid: None });
    }
    let ends = element.exactly::<6>("fromto")?;
    let solid = solid(element, kind, ends.as_ref())?;
    let pose = match ends {
        Some([a, b, c, d, e, f]) => {
            let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
            match (from - to).try_normalize(1e-12) {
                Some(along) => {
                    Pose { rotation: *from_z(&along).matrix(), position: (from + to) * 0.5 }
                }
                None => return refuse(node, "both ends of `fromto` are one point", "two points"),
            }
        }
        None => Pose { rotation: rotation(element, angles)?, position: element.vector("pos")? },
    };
    if element.text("shellinertia") == Some("true") {
        return refuse(
            node,
            "the masses of shells are not known here",
            "an <inertial> of the body",
        );
    }
    let mass = match element.text("mass") {
        Some(_) => element.not_negative("mass", 0.0)?,
        None => element.not_negative("density", DENSITY)? * solid.volume(),
    };
    let ellipsoid = match in_fluid {
        true => Some(RobotEllipsoid {
            pose,
            semi_axes: solid.semi_axes(),
            coefficients: coefficients(element)?,
        }),
        false => None,
    };
    let mass = solid.of_mass(mass).seen_from(&pose);
    Ok(Geom { pose, solid: Some(solid), mass: Some(mass), ellipsoid })
}

/// A shape as an ellipsoid of which a file says nothing.
pub(super) fn as_ellipsoid(pose: Pose<f64>, solid: &Solid) -> RobotEllipsoid {
    RobotEllipsoid { pose, semi_axes: solid.semi_axes(), coefficients: COEFFICIENTS }
}

fn coefficients(element: &Element<'_, '_, '_>) -> Read<[f64; 5]> {
    let own = element.numbers("fluidcoef")?.unwrap_or_default();
    if own.len() > COEFFICIENTS.len() || own.iter().any(|one| *one < 0.0) {
        let help = "up to five numbers of 0 or more: blunt, slender, angular, Kutta, Magnus";
        let what = match own.iter().find(|one| **one < 0.0) {
            Some(one) => format!("`fluidcoef` has {one}"),
            None => format!("`fluidcoef` has {} numbers", own.len()),
        };
        return refuse(element.node, what, help);
    }
    let mut coefficients = COEFFICIENTS;
    coefficients[..own.len()].copy_from_slice(&own);
    Ok(coefficients)
}

/// The shape by `size`, of which the length may be that between two ends.
fn solid(element: &Element<'_, '_, '_>, kind: &str, ends: Option<&[f64; 6]>) -> Read<Solid> {
    let node = element.node;
    let mut size = element.numbers("size")?.unwrap_or_default();
    if let Some([a, b, c, d, e, f]) = ends {
        let length = Vector3::new(d - a, e - b, f - c).norm();
        // Lengths across come before the one between the ends; one across is both
        let n_across = if matches!(kind, "box" | "ellipsoid") { 2 } else { 1 };
        size.truncate(n_across);
        while size.len() < n_across && !size.is_empty() {
            size.push(size[0]);
        }
        size.push(0.5 * length);
    }
    let n = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        _ => 3,
    };
    if size.len() < n || size[..n].iter().any(|one| *one <= 0.0) {
        let what = match size.iter().find(|one| **one <= 0.0) {
            Some(one) => format!("`size` of the {kind} has a {one}"),
            None => format!("`size` of the {kind} has {} of {n} numbers", size.len()),
        };
        let numbers = if n == 1 { "1 number".to_owned() } else { format!("{n} numbers") };
        let help =
            format!("{numbers} above 0, half lengths (m); with `fromto` only those across it");
        return refuse(node, what, help);
    }
    Ok(match kind {
        "sphere" => Solid::Ellipsoid(Vector3::repeat(size[0])),
        "capsule" => Solid::Capsule { radius: size[0], half: size[1] },
        "cylinder" => Solid::Cylinder { radius: size[0], half: size[1] },
        "box" => Solid::Box(Vector3::new(size[0], size[1], size[2])),
        _ => Solid::Ellipsoid(Vector3::new(size[0], size[1], size[2])),
    })
}
