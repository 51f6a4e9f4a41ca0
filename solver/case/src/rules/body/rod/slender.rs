//! `Slender`: what the keys of a rod are checked against: its length, its thickness, distances along it.

use crate::rules::Findings;

/// A table may end behind the tail by this part of the length: that of a fish is that up to where its sides would meet.
const BEHIND: f64 = 0.1;

/// Half width over the radius of curvature at rest above which a rod is no slender one.
const BENT: f64 = 0.5;

/// Lengths of a slender body (m).
#[derive(Clone, Copy)]
pub(super) struct Slender {
    pub length: f64,
    pub half_width: f64,
}

/// Distances of a table rise from row to row, and lie on the body.
pub(super) fn rises_along(
    findings: &mut Findings<'_>,
    key: &str,
    rows: &[[f64; 2]],
    body: Slender,
) {
    let does_rise = rows.windows(2).all(|pair| pair[1][0] > pair[0][0]);
    let is_inside = rows.iter().all(|row| (0.0..=body.length * (1.0 + BEHIND)).contains(&row[0]));
    if rows.is_empty() || !does_rise || !is_inside {
        findings.error(
            key,
            format!(
                "the table has no distances that rise from the head to the tail at {}",
                body.length
            ),
            "write [[distance from the head, value], ...] with distances from 0 to the length",
        );
    }
}

/// A rod must not be thicker than it is bent.
pub(super) fn too_sharp(
    findings: &mut Findings<'_>,
    key: &str,
    curvature: f64,
    body: Slender,
    when: &str,
) {
    let part = curvature * body.half_width;
    if part >= 1.0 {
        findings.error(
            key,
            format!(
                "{when} the radius of curvature is {}, and half of the thickness {}: the body would \
                 fold",
                1.0 / curvature,
                body.half_width
            ),
            &format!("write a curvature well below {}", 1.0 / body.half_width),
        );
    } else if part > BENT {
        findings.warning(
            key,
            format!(
                "{when} the radius of curvature is {} only, and half of the thickness {}: that is no \
                 slender body",
                1.0 / curvature,
                body.half_width
            ),
            &format!("write a curvature below {}, or make the body thinner", BENT / body.half_width),
        );
    }
}
