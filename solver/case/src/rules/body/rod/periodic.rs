//! Problems of `rod.periodic`: sheets that do not reach from head to tail across the domain, or that something holds.

use crate::rules::Findings;
use crate::{Activation, Body, Geometry, RodSpec, Stroke, TimeSettings, significant};

/// Widest slit between tail and head over the period: slits of 0.028 and 0.036 change the rate at which a wave as long
/// as the period relaxes by 0.35 and 0.6 %, by the square of their width, which leads to some 5 % here.
const WIDEST: f64 = 0.1;

/// Difference of what muscles want on both sides of the joint, over the largest that they want, which is warned about: the slit
/// there leaves a wave off by a similar part.
const JUMP: f64 = 1e-2;

/// Times of a run at which what muscles want is compared: multiples of the golden section, which no period divides.
const TIMES: u32 = 64;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

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
        Some(period) => {
            if let Some(active) = &body.activation {
                joint(findings, &key.replace(".rod", ".activation"), active, period);
            }
        }
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

/// Whether muscles want the same at the head and a period (m) further, where the rod is joined to itself.
fn joint(findings: &mut Findings<'_>, key: &str, active: &Activation, period: f64) {
    let end = match &findings.case().time {
        TimeSettings::Steady(_) => 0.0,
        TimeSettings::Unsteady(time) => time.end,
    };
    let delay = active.wave_speed.map_or(0.0, |speed| period / speed);
    let at_head = active.envelope.first().map_or(1.0, |row| row[1]);
    let at_joint = active.envelope.last().map_or(1.0, |row| row[1]);
    for (name, stroke) in [("curvature", &active.curvature), ("moment", &active.moment)] {
        // What will be asked for is not known
        let Some(stroke) = stroke.as_ref().filter(|stroke| stroke.command().is_none()) else {
            continue;
        };
        // From when on there is a wave along all of the rod
        let from = if let Stroke::Sine { ramp, .. } = stroke { ramp + delay.abs() } else { 0.0 };
        let times = (1..=TIMES).map(|nth| from + end * (f64::from(nth) * GOLDEN).fract());
        let (mut jump, mut largest): (f64, f64) = (0.0, 0.0);
        for time in times {
            let [head, tail] =
                [at_head * stroke.at(time)[0], at_joint * stroke.at(time - delay)[0]];
            jump = jump.max((head - tail).abs());
            largest = largest.max(head.abs()).max(tail.abs());
        }
        if jump <= JUMP * largest {
            continue;
        }
        let part = format!("{:.0}", 100.0 * jump / largest);
        let message = format!(
            "the {name} that muscles want differs by {part} % where the rod is joined to itself, {} from its head",
            significant(period)
        );
        let (at, help) = match (stroke, active.wave_speed) {
            (Stroke::Sine { period: time, .. }, Some(speed)) if at_head == at_joint => {
                let waves = (period / (speed.abs() * time)).round().max(1.0);
                let fitting = significant(speed.signum() * period / (waves * time));
                (format!("{key}.wave_speed"), format!("write wave_speed = {fitting}, with which whole waves fit"))
            }
            (_, None) => (format!("{key}.envelope"), "give its first and its last row the same factor".to_owned()),
            (_, Some(_)) => (
                format!("{key}.wave_speed"),
                "let a sine run along it, with as many whole waves as fit, and an envelope that ends as it begins".to_owned(),
            ),
        };
        findings.warning(&at, message, &help);
    }
}
