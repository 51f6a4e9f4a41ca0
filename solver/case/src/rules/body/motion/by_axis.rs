//! Problems of `body.motion = { x = ..., y = ..., rotation = ... }`.

use crate::rules::Findings;
use crate::rules::body::joints::stroke;
use crate::rules::flow::boundary::check_factor;
use crate::spec::body::motion::by_axis::{Said, SaidOf};
use crate::{Body, Geometry, Lock, Motion, MotionsByAxis, TimeSettings};

/// Checks what is written of a body, which is free but for what is locked in `body`.
pub fn check(findings: &mut Findings<'_>, index: usize, body: &Body) {
    let case = findings.case();
    let Some(Motion::ByAxis(motions)) = case.body.get(index).map(|written| &written.motion) else {
        return;
    };
    let key = format!("body.{index}");
    if !case.body[index].locked.is_empty() {
        findings.error(
            &format!("{key}.locked"),
            format!("\"{}\" has motions by axis, which say what is held, and `locked`", body.name),
            "leave `locked` out, and write \"held\" for the motion",
        );
    }
    if findings.model().joint_above(index).is_some() {
        findings.error(
            &format!("{key}.motion"),
            format!("\"{}\" hangs on another body, and its joint says how it moves", body.name),
            "write motion = \"free\" for it; the body all others hang on may be held or moved",
        );
    }
    for SaidOf { motion, said } in motions.all() {
        check_law(findings, &format!("{key}.motion.{}", motion.name()), body, said);
    }
    check_axis(findings, &key, motions);
}

/// Numbers of what is given.
fn check_law(findings: &mut Findings<'_>, key: &str, body: &Body, said: Said<'_>) {
    match said {
        Said::Free | Said::Held => {}
        Said::Way(way) => {
            stroke(findings, &format!("{key}.imposed"), way);
            if matches!(findings.case().time, TimeSettings::Steady(_)) {
                findings.error(
                    &format!("{key}.imposed"),
                    format!("\"{}\" goes a way in time, and a steady flow has none", body.name),
                    "use [time.unsteady], or write velocity = { value = ... }",
                );
            }
        }
        Said::Rate(rate) => {
            if let Some(factor) = &rate.factor {
                check_factor(findings, &format!("{key}.velocity.factor"), factor);
            }
        }
    }
}

/// In space a rotation that is given has an axis.
fn check_axis(findings: &mut Findings<'_>, key: &str, motions: &MotionsByAxis) {
    let turning = motions.all().into_iter().find(|said| said.motion == Lock::Rotation);
    let is_given =
        turning.is_some_and(|turning| matches!(turning.said, Said::Way(_) | Said::Rate(_)));
    let is_spatial = findings.case().geometry == Geometry::Spatial;
    if is_spatial && is_given && motions.axis.is_none() {
        findings.error(
            &format!("{key}.motion.rotation"),
            "a rotation in space that is given needs an axis".to_owned(),
            "add axis = [x, y, z] to `motion`, in the laboratory",
        );
    }
    if motions.axis.is_some() && !is_given {
        findings.warning(
            &format!("{key}.motion.axis"),
            "`axis` has no effect: no rotation is given".to_owned(),
            "leave it out, or write rotation = { imposed = ... }",
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Lock, Motion, check};

    fn case(geometry: &str, motion: &str, rest: &str) -> String {
        let (shape, domain, center) = match geometry {
            "planar" => ("disc", "disc", "[0.0, 0.0]"),
            "axisymmetric" => ("sphere", "half-disc", "[0.0, 0.0]"),
            _ => ("sphere", "sphere", "[0.0, 0.0, 0.0]"),
        };
        format!(
            "title = 't'
geometry = '{geometry}'
fluid = {{ model = 'navier-stokes', viscosity = 1.0, density = 1.0 }}
domain.{domain}.radius = 4.0
boundary.wall = 'no-slip'
mesh = {{ size = 0.5, surface = 0.1 }}
time.unsteady = {{ step = 0.1, end = 1.0 }}
[[body]]
name = 'b'
shape.{shape}.radius = 1.0
center = {center}
motion = {motion}
{rest}
"
        )
    }

    fn wrong(geometry: &str, motion: &str, settings: &[&str]) -> Vec<String> {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", &case(geometry, motion, ""), &settings).unwrap();
        check(&file).into_iter().map(|found| found.key).collect()
    }

    const SINE: &str = "{ imposed.sine = { amplitude = 0.3, period = 1.0 } }";

    #[test]
    fn each_motion_may_have_its_own_way() {
        for (geometry, motion) in [
            ("planar", format!("{{ x = 'free', y = {SINE}, rotation = {SINE} }}")),
            ("planar", "{ x = 'free', y.velocity = { value = 0.1 } }".to_owned()),
            (
                "planar",
                "{ x = 'free', rotation.imposed.sine = { amplitude = '20 deg', period = 1 } }"
                    .to_owned(),
            ),
            ("axisymmetric", format!("{{ x = {SINE} }}")),
            (
                "spatial",
                format!("{{ x = 'free', z = {SINE}, rotation = {SINE}, axis = [0, 1, 1] }}"),
            ),
        ] {
            assert_eq!(wrong(geometry, &motion, &[]), Vec::<String>::new(), "{motion}");
        }
        let text = case("planar", &format!("{{ x = 'free', y = {SINE} }}"), "");
        let file = Case::parse("t.toml", &text, &[]).unwrap();
        let body = &file.model.bodies[0];
        assert_eq!((&body.motion, body.drives(Lock::Y)), (&Motion::Free, true));
        assert_eq!(body.locked, [Lock::Y, Lock::Z, Lock::Rotation]);
        // It is written as it was
        let again = Case::parse("t.toml", &file.model.case.to_toml().unwrap(), &[]).unwrap();
        assert_eq!(again.model.case.body, file.model.case.body);
    }

    #[test]
    fn what_moves_no_way_is_refused() {
        let steady = "time={ steady = {} }";
        let sine = format!("{{ x = {SINE} }}");
        for (geometry, motion, settings, key) in [
            ("planar", sine.as_str(), vec![steady], "body.0.motion.x.imposed"),
            ("planar", &sine, vec!["body.0.locked=['y']"], "body.0.locked"),
            ("planar", "{ z = 'free' }", vec![], "body.0.motion.z"),
            ("axisymmetric", "{ x = 'free', y = 'free' }", vec![], "body.0.motion.y"),
            ("spatial", &sine.replace("x =", "rotation ="), vec![], "body.0.motion.rotation"),
            ("spatial", "{ x = 'free', axis = [1, 0, 0] }", vec![], "body.0.motion.axis"),
            (
                "planar",
                "{ x.imposed.sine = { amplitude = 1.0, period = -1.0 } }",
                vec![],
                "body.0.motion.x.imposed.sine.period",
            ),
        ] {
            let found = wrong(geometry, motion, &settings);
            assert!(found.contains(&key.to_owned()), "{motion}: {found:?}");
        }
    }

    #[test]
    fn mistakes_in_motions_say_what_is_accepted() {
        for (motion, parts) in [
            ("{ w = 'free' }", vec!["unknown key `w`", "x, y, z, rotation"]),
            ("{ x = 'loose' }", vec!["loose", "free", "held", "imposed"]),
            ("'loose'", vec!["loose", "held, free, imposed"]),
            ("{ imposed.speed = 1.0 }", vec!["unknown key `speed`", "angular_velocity"]),
            ("{ imposed.velocity = [1, 0], x = 'free' }", vec!["imposed"]),
        ] {
            let said = Case::parse("t.toml", &case("planar", motion, ""), &[]).unwrap_err();
            let said = said.to_string();
            assert!(parts.iter().all(|part| said.contains(part)), "{motion}: {said}");
        }
    }
}
