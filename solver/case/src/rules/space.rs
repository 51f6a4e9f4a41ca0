//! Problems of cases in three dimensions, and of vectors that only such cases have.

use super::Findings;
use crate::model::speed::norm;
use crate::{Body, DomainSpec, Geometry, Motion, Orientation, ShapeSpec};

/// Difference of the length of a quaternion from 1 that is taken for rounding.
const ROUNDING: f64 = 1e-6;

pub fn check(findings: &mut Findings<'_>) {
    let is_spatial = findings.case().geometry == Geometry::Spatial;
    if is_spatial {
        check_supported(findings);
    }
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let key = format!("body.{index}");
        if is_spatial {
            check_turns(findings, &key, body);
            check_cylinder(findings, &key, body);
        } else {
            refuse_turns(findings, &key, body);
        }
    }
}

/// What is not solved in three dimensions so far.
fn check_supported(findings: &mut Findings<'_>) {
    let (case, model) = (findings.case(), findings.model());
    let has_periods = case.periodic_axes().contains(&true);
    let may_repeat = matches!(case.domain, DomainSpec::Box { .. } | DomainSpec::Mesh(_));
    let missing = [
        (
            "boundary",
            has_periods && !may_repeat,
            "periodic sides of other domains than a box or a given mesh",
        ),
        ("frame", case.frame.is_some() && model.mesh_moves(), "a frame that other bodies move in"),
    ];
    for (key, is_there, what) in missing {
        if is_there {
            findings.error(
                key,
                format!("{what} cannot be computed in three dimensions so far"),
                "take geometry = \"planar\" or \"axisymmetric\", or single bodies",
            );
        }
    }
}

/// A cylinder goes through a box from side to side, and does not leave its sides.
fn check_cylinder(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let ShapeSpec::Cylinder { axis, length, .. } = &body.shape else { return };
    let case = findings.case();
    let (name, axis) = (&body.name, axis.index());
    let along = ["x", "y", "z"][axis];
    if !matches!(case.domain, DomainSpec::Box { .. }) {
        findings.error(
            &format!("{key}.shape.cylinder"),
            format!("\"{name}\" goes through a box from side to side, and the domain is none"),
            "take domain.box, or a capsule",
        );
        return;
    }
    if body.motion == Motion::Free {
        findings.error(
            &format!("{key}.motion"),
            format!("\"{name}\" ends at two sides of the box and cannot be free"),
            "write motion = \"held\", or { imposed = ... }; a capsule may be free",
        );
    }
    let moves = matches!(body.motion, Motion::Imposed(_)) && findings.model().mesh_moves();
    if moves {
        findings.error(
            &format!("{key}.motion"),
            format!("\"{name}\" ends at two sides of the box and cannot move in time so far"),
            "write motion = \"held\", or time = { steady = {} }",
        );
    }
    if body.orientation.is_some() {
        findings.error(
            &format!("{key}.orientation"),
            format!("\"{name}\" would be turned away from the sides it ends at"),
            "leave it out, and write shape.cylinder.axis = \"x\", \"y\" or \"z\"",
        );
    }
    let middle = case.extent().min[axis] + 0.5 * length;
    let center = body.center.get(axis).copied().unwrap_or(middle);
    if (center - middle).abs() > ROUNDING * length {
        findings.error(
            &format!("{key}.center"),
            format!(
                "the centre of \"{name}\" along {along} is {center}, not in the middle of the box"
            ),
            &format!("write {middle} there: the cylinder goes from side to side"),
        );
    }
    if case.periodic_axes()[axis] {
        findings.error(
            &format!("{key}.shape.cylinder.axis"),
            format!(
                "\"{name}\" goes through periodic sides, which cylinders without ends cannot do"
            ),
            "make them planes of symmetry or walls",
        );
    }
}

/// Quaternions by which a body is turned are of unit length.
fn check_turns(findings: &mut Findings<'_>, key: &str, body: &Body) {
    if let Some(orientation) = &body.orientation {
        check_orientation(findings, &format!("{key}.orientation"), orientation);
    }
    let at_rest = body.spring.as_ref().and_then(|spring| spring.rest_orientation.as_ref());
    if let Some(orientation) = at_rest {
        check_orientation(findings, &format!("{key}.spring.rest_orientation"), orientation);
    }
}

/// An orientation, of this key, by a quaternion of unit length.
pub(in crate::rules) fn check_orientation(
    findings: &mut Findings<'_>,
    key: &str,
    orientation: &Orientation,
) {
    if let Orientation::Quaternion(parts) = orientation
        && (norm(parts) - 1.0).abs() > ROUNDING
    {
        findings.error(
            &format!("{key}.quaternion"),
            format!("the quaternion {parts:?} has the length {:.6}", norm(parts)),
            &unit_quaternion(parts),
        );
    }
}

/// How a quaternion is written that is of no unit length.
fn unit_quaternion(parts: &[f64; 4]) -> String {
    let length = norm(parts);
    if length == 0.0 {
        return "write [w, x, y, z] of length 1; without a turn it is [1.0, 0.0, 0.0, 0.0]"
            .to_owned();
    }
    let unit = parts.map(|part| format!("{:?}", (part / length * 1e12).round() / 1e12 + 0.0));
    format!("write [w, x, y, z] of length 1: in this direction [{}]", unit.join(", "))
}

/// Vectors that turn a body out of the plane.
fn refuse_turns(findings: &mut Findings<'_>, key: &str, body: &Body) {
    let tilts =
        matches!(&body.motion, Motion::Imposed(imposed) if imposed.angular_velocity.tilts());
    for (name, is_given) in [
        ("torque", body.torque.tilts()),
        ("angular_velocity", body.angular_velocity.tilts()),
        ("motion.imposed.angular_velocity", tilts),
    ] {
        if is_given {
            findings.error(
                &format!("{key}.{name}"),
                format!("`{key}.{name}` turns \"{}\" out of the plane", body.name),
                "write one number, about z, or take geometry = \"spatial\"",
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Keys of the errors in a case of a sphere in a box, with some settings.
    fn wrong(geometry: &str, center: &str, settings: &[&str]) -> Vec<String> {
        let corner = if geometry == "spatial" { "4.0, 4.0, 4.0" } else { "4.0, 4.0" };
        let (sides, shape) = match geometry {
            "spatial" => (", back = 'no-slip', front = 'no-slip'", "sphere"),
            _ => ("", "disc"),
        };
        let text = format!(
            "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [{}], max = [{corner}] }}
boundary = {{ left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip'{sides} }}
mesh = {{ size = 0.3 }}
time = {{ steady = {{}} }}
body = [{{ name = 'b', shape = {{ {shape} = {{ radius = 1.0 }} }}, center = [{center}], motion = 'free' }}]
",
            corner.replace('4', "-4")
        );
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", &text, &settings).unwrap();
        check(&file).into_iter().map(|found| found.key).collect()
    }

    #[test]
    fn turns_in_space_are_about_an_axis_that_points_somewhere() {
        let space = |settings: &[&str]| wrong("spatial", "0.0, 0.0, 0.0", settings);
        assert!(space(&[]).is_empty());
        assert!(space(&["body.0.orientation={ along = [0.0, 1.0, 1.0] }"]).is_empty());
        assert!(space(&["body.0.torque=[0.0, 1.0, 1.0]"]).is_empty());
        assert!(space(&["time={ unsteady = { step = 0.1, end = 1.0 } }"]).is_empty());
        for (setting, key) in [
            ("body.0.angle=0.5", "body.0.angle"),
            ("body.0.orientation={ along = [0.0, 0.0, 0.0] }", "body.0.orientation.along"),
            (
                "body.0.orientation={ turned = { axis = [0.0, 0.0, 0.0], angle = 1.0 } }",
                "body.0.orientation.turned.axis",
            ),
            (
                "body.0.orientation={ quaternion = [1.0, 1.0, 0.0, 0.0] }",
                "body.0.orientation.quaternion",
            ),
            (
                "body.0.gait={ squirmer = { modes = [1.0], heading = 0.5 } }",
                "body.0.gait.squirmer.heading",
            ),
            ("body.0.spring={ torsion = 1.0, rest_angle = 0.1 }", "body.0.spring.rest_angle"),
            (
                "body.0.spring={ torsion = 1.0, rest_orientation = { along = [0.0, 0.0, 0.0] } }",
                "body.0.spring.rest_orientation.along",
            ),
            ("body.0.center=[0.0, 0.0]", "body.0.center"),
            ("domain.box.max=[4.0, 4.0]", "domain.box.max"),
            ("body.0.shape={ disc = { radius = 1.0 } }", "body.0.shape"),
        ] {
            let found = space(&[setting]);
            assert!(found.contains(&key.to_owned()), "{setting}: {found:?}");
        }
    }

    #[test]
    fn boxes_may_be_periodic_and_other_domains_may_not() {
        let space = |settings: &[&str]| wrong("spatial", "0.0, 0.0, 0.0", settings);
        let pair = "boundary={ left = { periodic = 'right' }, bottom = 'no-slip', top = 'no-slip', \
                    back = 'no-slip', front = 'no-slip' }";
        assert!(space(&[pair]).is_empty());
        let tube = "domain={ cylinder = { x = [-4.0, 4.0], radius = 4.0 } }";
        let pair = "boundary={ left = { periodic = 'right' }, wall = 'no-slip' }";
        assert!(space(&[tube, pair]).contains(&"boundary".to_owned()));
    }

    #[test]
    fn cylinders_go_from_side_to_side_and_stay_there() {
        let space = |center: &str, settings: &[&str]| {
            let mut all = vec!["body.0.shape={ cylinder = { radius = 0.5, axis = 'z' } }"];
            all.extend(settings);
            wrong("spatial", center, &all)
        };
        let held = "body.0.motion='held'";
        assert!(space("0.5, 0.2, 0.0", &[held]).is_empty());
        assert_eq!(space("0.5, 0.2, 0.1", &[held]), ["body.0.center"]);
        assert_eq!(space("0.5, 0.2, 0.0", &[]), ["body.0.motion"]);
        let moved = "body.0.motion={ imposed = { velocity = [1.0, 0.0, 0.0] } }";
        assert!(space("0.5, 0.2, 0.0", &[moved]).is_empty());
        let in_time = "time={ unsteady = { step = 0.1, end = 1.0 } }";
        assert_eq!(space("0.5, 0.2, 0.0", &[moved, in_time]), ["body.0.motion"]);
        let turned = "body.0.orientation={ along = [0.0, 1.0, 1.0] }";
        assert_eq!(space("0.5, 0.2, 0.0", &[held, turned]), ["body.0.orientation"]);
        let pair = "boundary={ back = { periodic = 'front' }, bottom = 'no-slip', top = 'no-slip', \
                    left = 'no-slip', right = 'no-slip' }";
        assert_eq!(space("0.5, 0.2, 0.0", &[held, pair]), ["body.0.shape.cylinder.axis"]);
        let ball = "domain={ sphere = { center = [0.0, 0.0, 0.0], radius = 4.0 } }";
        let wall = "boundary={ wall = 'no-slip' }";
        assert_eq!(space("0.5, 0.2, 0.0", &[held, ball, wall]), ["body.0.shape.cylinder"]);
        let thin = "body.0.shape.cylinder.radius=-0.5";
        assert!(
            space("0.5, 0.2, 0.0", &[held, thin])
                .contains(&"body.0.shape.cylinder.radius".to_owned())
        );
    }

    #[test]
    fn nothing_turns_out_of_the_plane() {
        for (setting, key) in [
            ("body.0.orientation={ along = [0.0, 1.0, 0.0] }", "body.0.orientation"),
            ("body.0.torque=[0.0, 1.0, 1.0]", "body.0.torque"),
            (
                "body.0.spring={ torsion = 1.0, rest_orientation = { along = [0.0, 1.0, 0.0] } }",
                "body.0.spring.rest_orientation",
            ),
            (
                "body.0.motion={ imposed = { angular_velocity = [1.0, 0.0, 0.0] } }",
                "body.0.motion.imposed.angular_velocity",
            ),
        ] {
            let found = wrong("planar", "0.0, 0.0", &[setting]);
            assert!(found.contains(&key.to_owned()), "{setting}: {found:?}");
        }
        assert!(wrong("planar", "0.0, 0.0", &["body.0.torque=1.0"]).is_empty());
    }
}
