//! Problems of `[[tracer]]`: seeds that are given twice or not at all, empty boxes, too many particles.

use crate::rules::Findings;
use crate::{TimeSettings, TracerSpec};

/// Most particles of a run.
const MOST: f64 = 1e7;

pub fn check(findings: &mut Findings<'_>) {
    for (index, tracer) in findings.case().tracer.iter().enumerate() {
        let key = format!("tracer.{index}");
        check_seeds(findings, &key, tracer);
        check_vectors(findings, &key, tracer);
        check_time(findings, &key, tracer);
    }
}

/// One key says where particles begin.
fn check_seeds(findings: &mut Findings<'_>, key: &str, tracer: &TracerSpec) {
    let given = [
        ("box", tracer.grid.is_some()),
        ("line", tracer.line.is_some()),
        ("points", !tracer.points.is_empty()),
    ];
    let given: Vec<&str> =
        given.into_iter().filter_map(|(name, is_given)| is_given.then_some(name)).collect();
    match given.as_slice() {
        [_] => {}
        [] => findings.error(
            key,
            format!("nothing says where the particles of \"{}\" begin", tracer.name),
            "write box = { min, max, count }, line = { from, to, count }, points = [[...], ...] or \
             file = \"seeds.csv\"",
        ),
        several => findings.error(
            &format!("{key}.{}", several[1]),
            format!(
                "the tracers \"{}\" have both `{}` and `{}`",
                tracer.name, several[0], several[1]
            ),
            "give one of them, and write another [[tracer]] for the other",
        ),
    }
}

/// Boxes have an inside, and all points a number for each dimension.
fn check_vectors(findings: &mut Findings<'_>, key: &str, tracer: &TracerSpec) {
    let seeds = tracer.grid.as_ref().map(|grid| ("box", &grid.min, &grid.max));
    let region = tracer.region.as_ref().map(|region| ("region", &region.min, &region.max));
    for (name, min, max) in seeds.into_iter().chain(region) {
        let are_corners = findings.is_vector(min) && findings.is_vector(max);
        if are_corners && min.iter().zip(max).any(|(low, high)| high <= low) {
            findings.error(
                &format!("{key}.{name}.max"),
                format!("the box from {min:?} to {max:?} is empty"),
                "all numbers of `max` must be larger than those of `min`; `line` and `points` have seeds \
                 that fill no box",
            );
        }
    }
    let n = findings.case().geometry.dimensions();
    let is_told = !findings.is_right(&format!("{key}.points"));
    let wrong = tracer.points.iter().position(|point| point.len() != n);
    if let Some(nth) = wrong.filter(|_| !is_told) {
        findings.error(
            &format!("{key}.points"),
            format!(
                "point {} is {:?}, of {} numbers",
                nth + 1,
                tracer.points[nth],
                tracer.points[nth].len()
            ),
            &format!(
                "write {n} numbers for each point: the case is {}",
                findings.case().geometry.name()
            ),
        );
    }
}

/// Particles need a flow in time, and memory.
fn check_time(findings: &mut Findings<'_>, key: &str, tracer: &TracerSpec) {
    let TimeSettings::Unsteady(time) = &findings.case().time else {
        findings.error(
            key,
            "a steady solution has no time in which tracers could be carried".to_owned(),
            "write [time.unsteady], or trace lines through the steady flow afterwards: alewife-post trace RUN",
        );
        return;
    };
    if tracer.start > time.end {
        findings.error(
            &format!("{key}.start"),
            format!(
                "the tracers are released at t = {}, after the end of the run at {}",
                tracer.start, time.end
            ),
            "release them earlier, or run for longer",
        );
    }
    let n = tracer.n_seeds().map_or(f64::INFINITY, |n| n as f64) * tracer.n_releases(time.end);
    if n > MOST {
        findings.error(
            key,
            format!("\"{}\" would be {n:.0} particles at the end of the run", tracer.name),
            &format!("take {MOST:.0} at most: lower `count`, or raise `every`"),
        );
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = r#"
title = "t"
geometry = "planar"
fluid = { model = "stokes", viscosity = 1.0 }
domain.channel = { length = 2.0, height = 1.0 }
mesh.size = 0.05
time.unsteady = { step = 0.1, end = 1.0 }
boundary = { left.parabolic.peak = 1.0, right = "do-nothing", bottom = "no-slip", top = "no-slip" }
body = [{ name = "b", shape.disc.radius = 0.1, center = [1.0, 0.5], motion = "held" }]
"#;

    fn first(tracer: &str) -> Option<String> {
        let setting = format!("tracer=[{{ name = 'a', {tracer} }}]");
        let file = Case::parse("t.toml", CASE, &[setting]).unwrap_or_else(|e| panic!("{e}"));
        check(&file).first().map(|found| format!("{} {} {}", found.key, found.message, found.help))
    }

    #[test]
    fn what_is_wrong_with_tracers_is_told() {
        for right in [
            "points = [[0.5, 0.5]]",
            "points = [[1.0, 0.5]], start = 0.5",
            "line = { from = [0.1, 0.1], to = [0.1, 0.9], count = 5 }, every = 0.1",
            "box = { min = [0, 0], max = [1, 1], count = [9, 9] }, region = { min = [0, 0], max = [1, 1] }",
        ] {
            assert_eq!(first(right), None, "{right}");
        }
        for (wrong, words) in [
            ("start = 0.0", "tracer.0 nothing says where"),
            ("points = [[0.5, 0.5]], line = { from = [0, 0], to = [1, 1], count = 2 }", "both"),
            ("points = [[0.5, 0.5, 0.0]]", "tracer.0.points"),
            ("points = [[0.5, 1.5]]", "tracer.0.points.0 the point [0.5, 1.5] is outside"),
            ("points = [[1.0, 0.5]]", "inside the body \"b\""),
            (
                "points = [[0.5, 0.5]], start = 2.0",
                "tracer.0.start the tracers are released at t = 2",
            ),
            ("points = [[0.5, 0.5]], every = 0.0", "tracer.0.every"),
            ("line = { from = [0, 0], to = [1, 1], count = 1 }", "tracer.0.line.count"),
            ("box = { min = [0, 0], max = [0, 1], count = [2, 2] }", "tracer.0.box.max"),
            ("box = { min = [0, 0], max = [1, 1], count = [9999, 9999] }", "99980001 particles"),
            (
                "points = [[0.5, 0.5]], region = { min = [1, 0], max = [0, 1] }",
                "tracer.0.region.max",
            ),
        ] {
            let found = first(wrong).unwrap_or_else(|| panic!("{wrong} is accepted"));
            assert!(found.contains(words), "{wrong}: {found}");
        }
        let twice = "tracer=[{ name = 'b', points = [[0.5, 0.5]] }]".to_owned();
        let file = Case::parse("t.toml", CASE, &[twice]).unwrap();
        assert!(check(&file)[0].message.contains("taken by"), "{:?}", check(&file)[0]);
        let steady = ["time.steady={}", "tracer=[{ name = 'a', points = [[0.5, 0.5]] }]"];
        let file = Case::parse("t.toml", CASE, &steady.map(str::to_owned)).unwrap();
        assert!(check(&file)[0].help.contains("alewife-post trace"));
    }
}
