//! Problems of shapes in space made of curves, profiles and parts.

use alewife_mesh::spatial::{Body, BodySurface, Centreline};
use nalgebra::Isometry3;

use crate::rules::Findings;
use crate::rules::space::check_orientation;
use crate::{CurveShape, HelixShape, PartSpec, ShapeSpec};

pub fn check_helix(findings: &mut Findings<'_>, key: &str, helix: &HelixShape) {
    let HelixShape { radius, pitch, turns, tube_radius } = *helix;
    let widest = Centreline::Helix { radius, pitch, turns }.widest_tube();
    if tube_radius >= widest {
        findings.error(
            &format!("{key}.tube_radius"),
            format!("a tube of the radius {tube_radius} along this helix meets itself"),
            &format!("write less than {widest:.3e}, or a larger radius or pitch"),
        );
    }
}

pub fn check_curve(findings: &mut Findings<'_>, key: &str, curve: &CurveShape) {
    let points = format!("{key}.points");
    if curve.points.len() < 2 {
        return;
    }
    if let Some(index) = curve.points.windows(2).position(|pair| pair[0] == pair[1]) {
        findings.error(
            &format!("{points}.{}", index + 1),
            format!("the points {index} and {} are the same", index + 1),
            "leave one of them out",
        );
        return;
    }
    let Some(spline) = curve.spline() else {
        let what = "neighbouring points are too close, or too far away, for a curve";
        findings.error(&points, what.to_owned(), "give points along a curve, in metres");
        return;
    };
    let widest = Centreline::Spline(spline).widest_tube();
    if curve.tube_radius >= widest {
        findings.error(
            &format!("{key}.tube_radius"),
            format!("a tube of the radius {} along this curve meets itself", curve.tube_radius),
            &format!("write less than {widest:.3e}, or points of a curve that bends less"),
        );
    }
}

pub fn check_profile(findings: &mut Findings<'_>, key: &str, profile: &[[f64; 2]]) {
    let n = profile.len();
    for (index, [_, off]) in profile.iter().enumerate() {
        let is_end = index == 0 || index == n - 1;
        let is_right = if is_end { *off == 0.0 } else { *off > 0.0 };
        if !is_right {
            findings.error(
                &format!("{key}.{index}"),
                format!("point {index} of the profile is {off} from the axis"),
                "the first and the last point are on the axis, at 0, and all others off it",
            );
            return;
        }
    }
}

/// Parts, each by what checks a shape at a key.
pub fn check_parts(
    findings: &mut Findings<'_>,
    key: &str,
    parts: &[PartSpec],
    check_shape: impl Fn(&mut Findings<'_>, &str, &ShapeSpec),
) {
    for (index, part) in parts.iter().enumerate() {
        let key = format!("{key}.{index}");
        check_shape(findings, &format!("{key}.shape"), &part.shape);
        if let Some(orientation) = &part.orientation {
            check_orientation(findings, &format!("{key}.orientation"), orientation);
        }
    }
    if findings.has_no_error() {
        check_overlaps(findings, key, parts);
    }
}

/// Parts that overlap one after the other: others make several bodies of one.
fn check_overlaps(findings: &mut Findings<'_>, key: &str, parts: &[PartSpec]) {
    let surface = |part: &PartSpec| {
        let parts = ShapeSpec::Union(vec![part.clone()]).parts()?;
        let (name, pose) = (String::new(), Isometry3::identity());
        BodySurface::new(&Body { name, parts, pose, size: None }).ok()
    };
    let Some(surfaces) = parts.iter().map(surface).collect::<Option<Vec<_>>>() else { return };
    let Some((first, rest)) = surfaces.split_first() else { return };
    let mut joined = vec![first];
    let mut left: Vec<(usize, &BodySurface)> = (1..).zip(rest).collect();
    loop {
        let n_left = left.len();
        left.retain(|(_, surface)| {
            let is_apart = joined.iter().all(|other| surface.is_apart_from(other));
            if !is_apart {
                joined.push(surface);
            }
            is_apart
        });
        if left.len() == n_left {
            break;
        }
    }
    for (index, _) in left {
        findings.error(
            &format!("{key}.{index}.center"),
            format!("part {index} of the union overlaps none of those that hang together with part 0"),
            "move parts together until they overlap, or write two bodies, with a joint if they move as one",
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    /// Keys of the errors in a case of a body of some shape in a box.
    fn wrong(shape: &str) -> Vec<String> {
        let text = format!(
            "title = 't'
geometry = 'spatial'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.box = {{ min = [-4, -4, -4], max = [4, 4, 4] }}
mesh = {{ size = 0.5 }}
time = {{ steady = {{}} }}
body = [{{ name = 'b', shape = {{ {shape} }}, center = [0, 0, 0], motion = 'free' }}]
boundary = {{ left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip', back = 'no-slip', front = 'no-slip' }}
"
        );
        let found = check(&Case::parse("t.toml", &text, &[]).unwrap());
        let errors = found.into_iter().filter(|one| one.severity == crate::Severity::Error);
        errors.map(|found| found.key).collect()
    }

    #[test]
    fn solids_are_refused_at_their_keys() {
        let helix = |radius, pitch, turns, tube| {
            format!(
                "helix = {{ radius = {radius}, pitch = {pitch}, turns = {turns}, tube_radius = {tube} }}"
            )
        };
        assert!(wrong(&helix(0.3, 0.8, -2.5, 0.08)).is_empty());
        let of_helix = |key: &str| vec![format!("body.0.shape.helix.{key}")];
        assert_eq!(wrong(&helix(0.3, 0.8, 2.0, 0.5)), of_helix("tube_radius"));
        assert_eq!(wrong(&helix(0.3, 0.1, 2.0, 0.06)), of_helix("tube_radius"));
        assert_eq!(wrong(&helix(0.3, 0.8, 0.0, 0.08)), of_helix("turns"));
        assert!(wrong(&helix(0.3, -0.8, 1.0, 0.08)).contains(&of_helix("pitch")[0]));
        // Too long for the box
        assert_eq!(wrong(&helix(0.3, 0.8, 6.0, 0.08)), ["body.0.center"]);

        let curve = |points: &str, radius: f64| {
            format!("curve = {{ points = {points}, tube_radius = {radius} }}")
        };
        let of_curve = |key: &str| vec![format!("body.0.shape.curve.{key}")];
        let bent = "[[-1, 0, 0], [0, 0.5, 0.2], [1, 0, 0]]";
        assert!(wrong(&curve(bent, 0.1)).is_empty());
        assert_eq!(wrong(&curve(bent, 0.9)), of_curve("tube_radius"));
        assert_eq!(wrong(&curve("[[-1, 0, 0]]", 0.1)), of_curve("points"));
        assert_eq!(wrong(&curve("[[1, 0, 0], [1, 0, 0]]", 0.1)), of_curve("points.1"));
        assert_eq!(wrong(&curve("[[-5, 0, 0], [5, 0, 0]]", 0.1)), ["body.0.center"]);

        let profile = |points: &str| format!("revolved = {{ profile = {points} }}");
        assert!(wrong(&profile("[[-1, 0], [0, 0.5], [1, 0]]")).is_empty());
        let key = "body.0.shape.revolved.profile";
        assert_eq!(wrong(&profile("[[-1, 0], [1, 0]]")), [key]);
        assert_eq!(wrong(&profile("[[-1, 0], [0, 0.5], [1, 0.1]]")), [format!("{key}.2")]);
        assert_eq!(wrong(&profile("[[-1, 0], [0, -0.5], [1, 0]]")), [format!("{key}.1")]);

        let head = "shape.sphere.radius = 0.5";
        let tail = "shape.capsule = { length = 2.0, radius = 0.1 }, center = [1.2, 0, 0]";
        assert!(wrong(&format!("union = [{{ {head} }}, {{ {tail} }}]")).is_empty());
        let part = |x: f64| format!("{{ {head}, center = [{x}, 0, 0] }}");
        let union = |at: &[f64]| {
            format!("union = [{}]", at.iter().map(|x| part(*x)).collect::<Vec<_>>().join(", "))
        };
        assert!(wrong(&union(&[0.0, 1.8, 0.9])).is_empty());
        let key = |index: usize| format!("body.0.shape.union.{index}.center");
        assert_eq!(wrong(&union(&[0.0, 1.0])), [key(1)]);
        assert_eq!(wrong(&union(&[-1.0, 1.0, 1.5, -0.5])), [key(1), key(2)]);
        assert_eq!(wrong("union = []"), ["body.0.shape.union"]);
        let disc = "shape.disc.radius = 0.5";
        assert_eq!(wrong(&format!("union = [{{ {disc} }}]")), ["body.0.shape.union.0.shape"]);
        let nowhere = "orientation = { along = [0, 0, 0] }";
        assert_eq!(
            wrong(&format!("union = [{{ {head} }}, {{ {tail}, {nowhere} }}]")),
            ["body.0.shape.union.1.orientation.along"]
        );
    }

    /// The same on the axis as in space, and what its mirror image crosses.
    #[test]
    fn turned_profiles_on_the_axis_are_refused_at_their_points() {
        let wrong = |geometry: &str, profile: &str| {
            let text = format!(
                "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'stokes', viscosity = 1.0 }}
domain.half-disc = {{ radius = 4.0 }}
mesh = {{ size = 0.5 }}
time = {{ steady = {{}} }}
boundary = {{ wall = 'no-slip' }}
body = [{{ name = 'b', shape.revolved.profile = {profile}, center = [0, 0], motion = 'free' }}]
"
            );
            let found = check(&Case::parse("t.toml", &text, &[]).unwrap());
            let errors = found.into_iter().filter(|one| one.severity == crate::Severity::Error);
            errors.map(|found| found.key).collect::<Vec<_>>()
        };
        let axis = "axisymmetric";
        let key = "body.0.shape.revolved.profile";
        assert!(wrong(axis, "[[-1, 0], [0, 0.5], [1, 0]]").is_empty());
        assert!(wrong(axis, "[[1, 0], [0, 0.5], [-1, 0]]").is_empty());
        assert_eq!(wrong(axis, "[[-1, 0], [1, 0]]"), [key]);
        assert_eq!(wrong(axis, "[[-1, 0.1], [0, 0.5], [1, 0]]"), [format!("{key}.0")]);
        assert_eq!(wrong(axis, "[[-1, 0], [0, -0.5], [1, 0]]"), [format!("{key}.1")]);
        // Through the same point twice, and across itself
        for crossed in
            ["[[-1, 0], [0, 0.5], [0, 0.5], [1, 0]]", "[[-1, 0], [2, 1], [-2, 1], [1, 0]]"]
        {
            assert_eq!(wrong(axis, crossed), ["body.0.shape"], "{crossed}");
        }
        assert_eq!(wrong(axis, "[[-9, 0], [0, 0.5], [1, 0]]"), ["body.0.center"]);
    }
}
