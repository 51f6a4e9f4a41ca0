//! Problems of `skin`: what cannot be one body, bends without end, or would fold.

use crate::rules::Findings;
use crate::spec::body::link::Link;
use crate::spec::body::skin::{Layout, STEEPEST};
use crate::spec::body::swimmer::{Pivot, Skin};
use crate::{ShapedLink, Stroke};

/// A chain with a skin, and the key of the chain.
pub struct Chain<'a> {
    pub key: &'a str,
    pub links: &'a [Link],
    pub gap: f64,
    pub joints: &'a [Pivot],
    pub skin: Skin,
}

pub fn check(findings: &mut Findings<'_>, chain: &Chain<'_>) {
    let key = chain.key;
    for (nth, link) in chain.links.iter().enumerate() {
        if let Link::Shaped(ShapedLink { density: Some(density), .. }) = link {
            findings.error(
                &format!("{key}.links.{nth}.density"),
                format!("link {} has the density {density}, but a skin makes one body", nth + 1),
                "leave it out, and write density = ... for the swimmer",
            );
        }
    }
    for (nth, joint) in chain.joints.iter().enumerate() {
        match joint {
            Pivot::Hinge(_) => findings.error(
                &format!("{key}.joints.{nth}"),
                format!("joint {} is a hinge, but a skin bends by given angles only", nth + 1),
                "write bent = { angle = ... }, or leave `skin` out",
            ),
            Pivot::Bent { angle } => {
                has_rate(findings, &format!("{key}.joints.{nth}.bent.angle"), angle);
            }
        }
    }
    one_period(findings, chain);
    // A link without an outline is refused elsewhere
    let Ok(layout) = Layout::new(chain.links, chain.gap) else { return };
    let (rounding, shortest) = (layout.rounding(chain.skin), layout.shortest());
    if let Some(given) = chain.skin.rounding.filter(|given| *given > shortest) {
        findings.error(
            &format!("{key}.skin.rounding"),
            format!(
                "the skin bends over {given} at each pivot, and two pivots, or a pivot and an end, \
                 are {shortest:.4} apart"
            ),
            &format!("write {shortest:.4} or less, or leave it out for half of it"),
        );
        return;
    }
    if rounding > 0.0 {
        folds(findings, chain, &layout, rounding);
    }
}

/// Angles whose rate jumps would need an infinite force of a skin with mass.
pub(super) fn has_rate(findings: &mut Findings<'_>, key: &str, angle: &Stroke) {
    let name = match angle {
        Stroke::Table(_) => "a `table`",
        Stroke::Legs { smooth: false, .. } => "`legs` of straight lines",
        _ => return,
    };
    findings.error(
        key,
        format!("the rate of {name} jumps, which the gait of a deforming body may not"),
        "write a `sine`, a `file`, or `legs` with smooth = true",
    );
}

/// A deforming body has one cycle.
fn one_period(findings: &mut Findings<'_>, chain: &Chain<'_>) {
    let angle = |joint: &Pivot| match joint {
        Pivot::Bent { angle } => angle.period(),
        Pivot::Hinge(_) => None,
    };
    let periods: Vec<f64> = chain.joints.iter().filter_map(angle).collect();
    let Some(&first) = periods.first() else { return };
    if let Some(other) = periods.iter().find(|other| (**other - first).abs() > 1e-9 * first) {
        findings.error(
            &format!("{}.joints", chain.key),
            format!("the angles of a skin have the periods {first} and {other}"),
            "give all of them the same period, or the angles of a whole run in a `file`",
        );
    }
}

/// Where the skin bends, its inner side may not fold: curvature times half width below 1.
fn folds(findings: &mut Findings<'_>, chain: &Chain<'_>, layout: &Layout, rounding: f64) {
    for (nth, joint) in chain.joints.iter().enumerate() {
        let (Pivot::Bent { angle }, Some(neighbours)) = (joint, layout.sections.get(nth..nth + 2))
        else {
            continue;
        };
        let half_width = neighbours.iter().map(|[_, width]| *width).fold(0.0, f64::max);
        let [least, most] = angle.range();
        let largest = least.abs().max(most.abs());
        let allowed = rounding / (STEEPEST * half_width);
        if largest >= allowed {
            findings.error(
                &format!("{}.joints.{nth}.bent.angle", chain.key),
                format!(
                    "joint {} bends by up to {largest:.4} rad over {rounding:.4}: the skin, \
                     {half_width:.4} to each side, would fold",
                    nth + 1
                ),
                &format!(
                    "bend by less than {allowed:.4}, or over more than {:.4} (skin.rounding)",
                    largest * STEEPEST * half_width
                ),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Severity, check};

    /// Keys of the errors of a chain with a skin, the base of the keys left out.
    fn errors(settings: &[&str]) -> Vec<String> {
        let text = "
title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.box = { min = [-4.0, -4.0], max = [4.0, 4.0] }
boundary = { left = 'no-slip', right = 'no-slip', bottom = 'no-slip', top = 'no-slip' }
mesh = { size = 0.5, surface = 0.05 }
time.unsteady = { step = 0.05, end = 1.0 }
[[swimmer]]
name = 's'
[swimmer.kind.chain]
links = [[0.4, 0.1], { shape.ellipse.semi_axes = [0.5, 0.12] }, [0.4, 0.08]]
gap = 0.1
skin = {}
joints = [
    { bent.angle.sine = { amplitude = 0.5, period = 1.0 } },
    { bent.angle.sine = { amplitude = 0.5, period = 1.0, phase = 0.25 } },
]
";
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let file = Case::parse("t.toml", text, &settings).unwrap();
        let problems = check(&file).into_iter();
        let errors = problems.filter(|problem| problem.severity == Severity::Error);
        let key = |key: String| key.trim_start_matches("swimmer.0.kind.chain.").to_owned();
        errors.map(|problem| key(problem.key)).collect()
    }

    #[test]
    fn a_skin_that_can_be_has_no_errors() {
        assert_eq!(errors(&[]), Vec::<String>::new());
        let base = "swimmer.0.kind.chain";
        assert_eq!(errors(&[&format!("{base}.skin.rounding=0.8")]), Vec::<String>::new());
    }

    #[test]
    fn what_cannot_be_one_body_is_refused_at_its_key() {
        for (setting, key) in [
            ("links.1.density=2.0", "links.1.density"),
            ("joints.0={ hinge = { stiffness = 1.0 } }", "joints.0"),
            ("joints.0.bent.angle={ table = [[0.0, 0.0], [1.0, 0.3]] }", "joints.0.bent.angle"),
            (
                "joints.1.bent.angle={ legs = { period = 1.0, knots = [[0.0, 0.0], [0.5, 0.3]] } }",
                "joints.1.bent.angle",
            ),
            ("joints.1.bent.angle.sine.period=2.0", "joints"),
            ("skin.rounding=0.9", "skin.rounding"),
            ("skin.rounding=0.1", "joints.0.bent.angle"),
            ("joints.1.bent.angle.sine.amplitude=2.0", "joints.1.bent.angle"),
        ] {
            let found = errors(&[&format!("swimmer.0.kind.chain.{setting}")]);
            assert!(found.contains(&key.to_owned()), "{setting}: {found:?}");
        }
    }
}
