//! Problems of `[contact]`: laws too weak or of long range, and cases without contact.

use super::Findings;
use crate::model::impact::Impact;
use crate::model::speed::weight;
use crate::{ContactSpec, Convection, Lock, Motion, Scheme, TimeSettings};

/// Range over half the least width of a body above which contact is no short-range force.
const SHORT_RANGE: f64 = 0.5;

pub fn check(findings: &mut Findings<'_>) {
    let case = findings.case();
    let (key, range) = match case.contact {
        None => return,
        Some(ContactSpec::Quadratic { range, .. }) => ("contact.quadratic.range", range),
        Some(ContactSpec::Barrier { range, .. }) => ("contact.barrier.range", range),
    };
    check_range(findings, key, range);
    match &case.time {
        TimeSettings::Steady(_) => findings.error(
            "contact",
            "a steady solution knows no contact".to_owned(),
            "use [time.unsteady], or leave [contact] out",
        ),
        TimeSettings::Unsteady(unsteady) => {
            if unsteady.convection == Convection::Newton {
                findings.error(
                    "time.unsteady.convection",
                    "contact is solved together with extrapolated convection only".to_owned(),
                    "write convection = \"extrapolated\", or leave [contact] out",
                );
            }
            check_yielding(findings);
            check_strength(findings, &case.contact);
            check_impact(findings, &case.contact);
            check_losses(findings, unsteady.scheme);
        }
    }
}

/// Gap over the range left by an impact below which no mesh follows it.
const LEAST_GAP: f64 = 0.01;

/// A law that cannot store the energy of a fall, or only in a film that no mesh resolves.
fn check_impact(findings: &mut Findings<'_>, contact: &Option<ContactSpec>) {
    let (Some(contact), Some(impact)) = (contact, findings.model().hardest_impact()) else {
        return;
    };
    let gap = contact.gap_of_energy(impact.energy);
    if gap.is_nan() || gap >= LEAST_GAP * contact.range() {
        return;
    }
    let key = match contact {
        ContactSpec::Quadratic { .. } => "contact.quadratic.epsilon",
        ContactSpec::Barrier { .. } => "contact.barrier.stiffness",
    };
    let Impact { body, speed, energy, .. } = impact;
    let left = if gap > 0.0 { format!("a gap of {gap:.1e}") } else { "no gap".to_owned() };
    findings.warning(
        key,
        format!(
            "\"{body}\" may meet a wall with {speed:.2e} m/s: contact stores its energy of {energy:.2e} with {left} left"
        ),
        "make the law stronger: `check` has the value that leaves half of the range",
    );
}

/// What takes energy.
fn check_losses(findings: &mut Findings<'_>, scheme: Scheme) {
    let case = findings.case();
    let Some(contact) = &case.contact else { return };
    let law = match contact {
        ContactSpec::Quadratic { .. } => "contact.quadratic",
        ContactSpec::Barrier { .. } => "contact.barrier",
    };
    let losses = contact.losses();
    if !losses.are_any() {
        return;
    }
    if scheme == Scheme::Rk3 {
        findings.error(
            "time.unsteady.scheme",
            "friction and restitution are solved for implicitly".to_owned(),
            "write scheme = \"bdf2\", or leave them out of [contact]",
        );
    }
    if case.frame.is_some() {
        findings.error(
            law,
            "friction and restitution are those of walls at rest, and the domain travels with a body".to_owned(),
            "leave `frame` out, or friction and restitution",
        );
    }
    if losses.slip.is_none() && findings.model().expected_speed().is_none() {
        findings.error(
            &format!("{law}.slip"),
            "no speed can be expected that the slip could be a thousandth of".to_owned(),
            "give `slip`: a speed far below those of the bodies",
        );
    }
}

/// A range is small beside the bodies, or they feel each other from afar.
fn check_range(findings: &mut Findings<'_>, key: &str, range: f64) {
    let widths = findings.model().bodies.iter().map(|body| (body.shape.half_width(), &body.name));
    let Some((width, name)) = widths.min_by(|one, other| one.0.total_cmp(&other.0)) else { return };
    if width > 0.0 && range > SHORT_RANGE * width {
        findings.warning(
            key,
            format!("the range {range} of contact is large beside \"{name}\", {width:.3} thin"),
            "about the edge length on the bodies is usual",
        );
    }
}

/// Contact needs a body that gives way.
fn check_yielding(findings: &mut Findings<'_>) {
    let case = findings.case();
    let motions: &[Lock] = case.geometry.motions();
    let yields = findings.model().bodies.iter().any(|body| {
        body.motion == Motion::Free && motions.iter().any(|lock| !body.locked.contains(lock))
    });
    if !yields {
        findings.warning(
            "contact",
            "contact has no effect: no body is free to give way".to_owned(),
            "leave [contact] out, or write motion = \"free\"",
        );
    } else if !findings.model().mesh_moves() {
        findings.warning(
            "contact",
            "contact has no effect: nothing moves as seen from the frame".to_owned(),
            "leave [contact] out, or leave `frame` out",
        );
    }
}

/// A law that cannot hold a body against gravity, or only in a film that no mesh resolves.
fn check_strength(findings: &mut Findings<'_>, contact: &Option<ContactSpec>) {
    let case = findings.case();
    // At a hundredth of the range.
    let (key, greatest) = match *contact {
        Some(ContactSpec::Quadratic { range, epsilon, .. }) => {
            ("contact.quadratic.epsilon", range * range / epsilon)
        }
        Some(ContactSpec::Barrier { range, stiffness, .. }) => {
            let (gap, short) = (0.01f64, 0.99f64);
            let force = short * short / gap - 2.0 * short * gap.ln();
            ("contact.barrier.stiffness", stiffness * range * force)
        }
        None => return,
    };
    for body in &findings.model().bodies {
        let weight = weight(case, body);
        if body.motion == Motion::Free && greatest > 0.0 && greatest < weight {
            findings.warning(
                key,
                format!(
                    "contact can hold {greatest:.3e} at a hundredth of its range, and \"{}\" \
                     weighs {weight:.3e} less its buoyancy",
                    body.name
                ),
                "make the law stronger: it carries a body at half its range when that is its force \
                 there",
            );
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, ContactSpec, Diagnostic, Severity, check};

    const CASE: &str = "
title = 'A disc in a box'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain = { box = { min = [-1.0, -1.0], max = [1.0, 1.0] } }
mesh = { size = 0.2 }
[time.unsteady]
step = 0.1
end = 1.0
[boundary]
left = 'no-slip'
right = 'no-slip'
bottom = 'no-slip'
top = 'no-slip'
[[body]]
name = 'disc'
shape = { disc = { radius = 0.3 } }
center = [0.0, 0.0]
motion = 'free'
[contact.quadratic]
range = 0.03
epsilon = 1e-6
";

    /// Problems of the case with these settings, and with another contact if one is given.
    fn problems(settings: &[&str], contact: Option<ContactSpec>) -> Vec<Diagnostic> {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let mut file = Case::parse("t.toml", CASE, &settings).unwrap();
        file.model.case.contact = contact.or(file.model.case.contact);
        check(&file)
    }

    /// Keys and messages of the errors of a case with this contact.
    fn errors(contact: ContactSpec) -> Vec<(String, String)> {
        let errors =
            problems(&[], Some(contact)).into_iter().filter(|p| p.severity == Severity::Error);
        errors.map(|problem| (problem.key, problem.message)).collect()
    }

    #[test]
    fn contact_is_refused_where_it_is_not_solved() {
        assert_eq!(problems(&[], None), []);
        for (setting, key, message) in [
            ("time.steady={}", "contact", "a steady solution knows no contact"),
            ("time.unsteady.convection=newton", "time.unsteady.convection", "extrapolated"),
        ] {
            let found = problems(&[setting], None);
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!((found[0].key.as_str(), found[0].severity), (key, Severity::Error));
            assert!(found[0].message.contains(message), "{found:?}");
        }
    }

    #[test]
    fn contact_without_effect_or_of_long_range_is_warned_about() {
        for (settings, key, message) in [
            (["body.0.motion=held"].as_slice(), "contact", "no body is free"),
            (&["body.0.locked=['x', 'y', 'rotation']"], "contact", "no body is free"),
            (&["contact.quadratic.range=0.16"], "contact.quadratic.range", "0.300 thin"),
            (
                &[
                    "body.0.shape={ellipse={semi_axes=[0.5, 0.05]}}",
                    "contact={barrier={range=0.03, stiffness=1.0}}",
                ],
                "contact.barrier.range",
                "0.050 thin",
            ),
        ] {
            let mut found = problems(settings, None);
            // That a body with all locks is held is told besides
            found.retain(|one| one.key != "body.0.locked");
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!((found[0].key.as_str(), found[0].severity), (key, Severity::Warning));
            assert!(found[0].message.contains(message), "{found:?}");
        }
    }

    #[test]
    fn numbers_that_are_not_positive_are_refused() {
        let quadratic = |range, epsilon| {
            let (restitution, friction, slip) = (None, None, None);
            ContactSpec::Quadratic { range, epsilon, restitution, friction, slip }
        };
        let barrier = |range, stiffness| {
            let (restitution, friction, slip) = (None, None, None);
            ContactSpec::Barrier { range, stiffness, restitution, friction, slip }
        };
        assert_eq!(errors(quadratic(0.03, 1e-6)), []);
        assert_eq!(errors(barrier(0.03, 10.0)), []);
        let refused = |contact, key: &str, value: &str| {
            let wanted = (key.to_owned(), format!("`{key}` is {value}, but must be positive"));
            assert_eq!(errors(contact), [wanted]);
        };
        refused(quadratic(0.0, 1e-6), "contact.quadratic.range", "0");
        refused(quadratic(0.03, -1.0), "contact.quadratic.epsilon", "-1");
        refused(barrier(-0.03, 10.0), "contact.barrier.range", "-0.03");
        refused(barrier(0.03, 0.0), "contact.barrier.stiffness", "0");
    }

    #[test]
    fn losses_that_cannot_be_are_refused() {
        for (settings, key) in [
            (
                ["contact.quadratic={range=0.03, epsilon=1e-6, restitution=1.2, slip=1e-3}"]
                    .as_slice(),
                "contact.quadratic.restitution",
            ),
            (
                &["contact.quadratic={range=0.03, epsilon=1e-6, friction=-0.1, slip=1e-3}"],
                "contact.quadratic.friction",
            ),
            (
                &["contact.quadratic.friction=0.1", "contact.quadratic.slip=0.0"],
                "contact.quadratic.slip",
            ),
            (&["contact.quadratic.friction=0.1"], "contact.quadratic.slip"),
            (
                &[
                    "contact.quadratic={range=0.03, epsilon=1e-6, friction=0.1, slip=1e-3}",
                    "time.unsteady.scheme=rk3",
                ],
                "time.unsteady.scheme",
            ),
        ] {
            let found = problems(settings, None);
            let errors = found.iter().filter(|problem| problem.severity == Severity::Error);
            assert_eq!(
                errors.map(|problem| &problem.key[..]).collect::<Vec<_>>(),
                [key],
                "{found:?}"
            );
        }
        let fine = ["contact.quadratic={range=0.03, epsilon=1e-6, friction=0.1, slip=1e-3}"];
        assert_eq!(problems(&fine, None), []);
    }

    /// A disc of the weight that the law carries, but not from this height.
    #[test]
    fn an_impact_too_hard_for_the_law_is_warned_about() {
        let fall = [
            "fluid={model='navier-stokes', viscosity=1e-3, density=1.0, gravity=[0.0, -1.0]}",
            "body.0.density=100.0",
        ];
        let law = |law: &str| {
            let settings = [fall[0], fall[1], law];
            let found = problems(&settings, None);
            let messages = found.iter().map(|problem| problem.message.clone());
            messages.filter(|message| message.contains("meet a wall")).collect::<Vec<_>>()
        };
        let weak = law("contact={quadratic={range=0.03, epsilon=1e-5}}");
        assert!(weak.len() == 1 && weak[0].contains("with no gap left"), "{weak:?}");
        let weak = law("contact={barrier={range=0.03, stiffness=3e3}}");
        assert!(weak.len() == 1 && weak[0].contains("a gap of"), "{weak:?}");
        assert_eq!(law("contact={barrier={range=0.03, stiffness=1e5}}"), [""; 0]);
    }
}
