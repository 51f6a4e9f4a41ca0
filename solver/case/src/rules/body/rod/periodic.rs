//! Problems of `rod.periodic`: sheets that do not reach from head to tail across the domain, or that something holds.

use crate::rules::Findings;
use crate::{Body, Geometry, RodSpec, significant};

/// Widest slit between tail and head over the period: slits of 0.028 and 0.036 change the rate at which a wave as long
/// as the period relaxes by 0.35 and 0.6 %, by the square of their width, which leads to some 5 % here.
const WIDEST: f64 = 0.1;

/// Whether a rod of a length (m) can be a sheet without ends.
pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body, rod: &RodSpec, length: f64) {
    // In space the key is refused already
    if !rod.periodic || findings.case().geometry != Geometry::Planar {
        return;
    }
    let (case, name) = (findings.case(), &body.name);
    match case.period_along(body.angle) {
        None => findings.error(
            &format!("{key}.periodic"),
            format!("the domain is not periodic along \"{name}\", from its tail to its head"),
            "write boundary.left = { periodic = \"right\" } and angle = 0, or leave `periodic` out",
        ),
        Some(period) if !(1.0 - WIDEST..1.0).contains(&(length / period)) => findings.error(
            &format!("{key}.periodic"),
            format!(
                "\"{name}\" is {} long from head to tail, and the period is {}",
                significant(length),
                significant(period)
            ),
            &format!(
                "give it a length below the period by the slit that is to be left, {} at most",
                significant(WIDEST * period)
            ),
        ),
        Some(_) => {}
    }
    if rod.stretching.is_none() {
        findings.error(
            key,
            format!("\"{name}\" has no ends and is stretched where it bends, as the period does not change"),
            "write stretching = ... (N/m), tension over stretch",
        );
    }
    let contact = case.contact.is_some();
    for (at, what, is_given) in [
        (format!("{key}.rest"), "shape at rest of its own", rod.rest.is_some()),
        (format!("{key}.load"), "loads at ends", rod.load.is_some()),
        (key.replace(".rod", ".attached"), "head to be held", body.attached.is_some()),
        ("contact".to_owned(), "contact", contact),
    ] {
        if is_given {
            findings.error(
                &at,
                format!("\"{name}\" is joined to itself, and has no {what}"),
                "leave it out, or `periodic`",
            );
        }
    }
}
