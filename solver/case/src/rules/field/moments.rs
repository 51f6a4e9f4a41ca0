//! Problems of `magnetic_moment`: vectors that are none, and bodies that no field turns.

use crate::rules::Findings;
use crate::{Geometry, Lock, Motion, SwimmerKind};

/// A moment as it is written.
struct Written<'a> {
    /// Its key.
    key: String,
    /// What it is of.
    owner: String,
    moment: &'a [f64],
}

pub fn check(findings: &mut Findings<'_>) {
    for written in all(findings) {
        check_vector(findings, &written);
        if findings.case().field.is_none() && findings.is_right(&written.key) {
            findings.warning(
                &written.key,
                format!("there is no field to turn the magnetic moment of {}", written.owner),
                "write [field] with magnetic = { rotating = { strength = ..., frequency = ... } } or magnetic = { \
                 components = [...] }, or leave the moment out",
            );
        }
    }
    in_skins(findings);
}

/// Bodies that a field does not move.
pub fn check_effect(findings: &mut Findings<'_>) {
    let field = findings.case().magnetic_field();
    let pulls = field.is_some_and(crate::MagneticSpec::has_gradient);
    for (index, body) in findings.model().bodies.iter().enumerate() {
        let key = format!("body.{index}.magnetic_moment");
        if body.magnetic_moment.is_empty() || field.is_none() || !findings.is_right(&key) {
            continue;
        }
        let (name, geometry) = (&body.name, findings.case().geometry);
        let turns = body.turns() && geometry != Geometry::Axisymmetric;
        if body.motion != Motion::Free {
            findings.warning(
                &key,
                format!("the field does not move \"{name}\", which is not free"),
                "leave `magnetic_moment` out unless its torque is to be reported, or write motion = \"free\"",
            );
        } else if !turns && !pulls {
            findings.warning(
                &key,
                format!(
                    "the field does not move \"{name}\": it {}, and a field that is the same everywhere does \
                     not pull",
                    if body.locked.contains(&Lock::Rotation) { "is locked" } else { "cannot turn" }
                ),
                "unlock \"rotation\", give the field `linear` or `dipoles`, or leave the moment out",
            );
        }
    }
}

/// All moments as they are written.
fn all<'a>(findings: &Findings<'a>) -> Vec<Written<'a>> {
    let case = findings.case();
    let mut all = Vec::new();
    for (index, body) in case.body.iter().enumerate() {
        let (key, owner) = (format!("body.{index}.magnetic_moment"), format!("\"{}\"", body.name));
        all.push(Written { key, owner, moment: &body.magnetic_moment });
    }
    for (index, swimmer) in case.swimmer.iter().enumerate() {
        let (key, owner) = (format!("swimmer.{index}"), format!("\"{}\"", swimmer.name));
        if let SwimmerKind::Chain { links, .. } = &swimmer.kind {
            for (nth, link) in links.iter().enumerate() {
                let key = format!("{key}.kind.chain.links.{nth}.magnetic_moment");
                let owner = format!("link {} of {owner}", nth + 1);
                all.push(Written { key, owner, moment: link.magnetic_moment() });
            }
        }
        let key = format!("{key}.magnetic_moment");
        all.push(Written { key, owner, moment: &swimmer.magnetic_moment });
    }
    all.retain(|written| !written.moment.is_empty());
    all
}

/// A moment points somewhere, within the dimensions of the case.
fn check_vector(findings: &mut Findings<'_>, written: &Written<'_>) {
    let Written { key, owner, moment } = written;
    let geometry = findings.case().geometry;
    let n = geometry.dimensions();
    if geometry == Geometry::Planar && moment.get(2).is_some_and(|part| *part != 0.0) {
        findings.error(
            key,
            format!("the magnetic moment of {owner}, {moment:?}, points out of the plane"),
            "write [x, y]: the field turns it about z alone; or take geometry = \"spatial\"",
        );
    } else if moment.len() != n {
        let plural = if moment.len() == 1 { "" } else { "s" };
        findings.error(
            key,
            format!(
                "`{key}` has {} number{plural}, but this case has {n} dimensions",
                moment.len()
            ),
            if n == 3 { "write [x, y, z]" } else { "write [x, y]" },
        );
    } else if moment.iter().all(|part| *part == 0.0) {
        findings.error(
            key,
            format!("the magnetic moment of {owner} is zero"),
            "write a vector such as [1.0, 0.0], or leave it out",
        );
    } else if geometry == Geometry::Axisymmetric && moment[1] != 0.0 {
        findings.error(
            key,
            format!("the magnetic moment of {owner}, {moment:?}, breaks the symmetry"),
            "write [x, 0.0]: along the axis a field only pulls; or take geometry = \"spatial\"",
        );
    }
}

/// Links with a skin are one body, and bodies that a swimmer names have moments of their own.
fn in_skins(findings: &mut Findings<'_>) {
    for (index, swimmer) in findings.case().swimmer.iter().enumerate() {
        let key = format!("swimmer.{index}");
        match &swimmer.kind {
            SwimmerKind::Chain { links, skin: Some(_), .. } => {
                let magnets = links.iter().enumerate();
                let magnets = magnets.filter(|(_, link)| !link.magnetic_moment().is_empty());
                for (nth, _) in magnets {
                    findings.error(
                        &format!("{key}.kind.chain.links.{nth}.magnetic_moment"),
                        format!(
                            "link {} has a magnetic moment, but a skin makes one body",
                            nth + 1
                        ),
                        "leave it out, and write magnetic_moment = [...] for the swimmer",
                    );
                }
            }
            SwimmerKind::Bodies(_) if !swimmer.magnetic_moment.is_empty() => findings.error(
                &format!("{key}.magnetic_moment"),
                "`magnetic_moment` has no effect on bodies that are there already".to_owned(),
                "leave it out, and write it for the bodies themselves",
            ),
            SwimmerKind::Chain { links, .. } => {
                let root = links.len().saturating_sub(1) / 2;
                let own = links.get(root).map_or(&[][..], |link| link.magnetic_moment());
                if !own.is_empty() && !swimmer.magnetic_moment.is_empty() {
                    findings.error(
                        &format!("{key}.magnetic_moment"),
                        format!(
                            "the root body of \"{}\" is link {}, which has a magnetic moment of its own",
                            swimmer.name,
                            root + 1
                        ),
                        "write one of both",
                    );
                }
            }
            _ => {}
        }
    }
}
