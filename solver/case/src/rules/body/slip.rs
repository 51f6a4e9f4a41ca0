//! Problems of `gait.slip`: expressions that are not understood, or have no value on the body.

use crate::model::speed::slip_trials;
use crate::rules::Findings;
use crate::{Body, SlipGait};

/// Tells what is wrong with the slip of a body.
pub fn check(findings: &mut Findings<'_>, key: &str, body: &Body, gait: &SlipGait) {
    let case = findings.case();
    let dimensions = case.geometry.dimensions();
    let mut trials = None;
    for (axis, formula) in gait.velocity.iter().enumerate() {
        let key = format!("{key}.velocity.{axis}");
        match formula.parsed(&case.define, dimensions) {
            Err(error) => findings.error(
                &key,
                format!("{formula} at character {}: {}", error.column, error.found),
                &error.accepted,
            ),
            Ok(parsed) => {
                let trials = trials.get_or_insert_with(|| slip_trials(case, body));
                let Some(at) = trials.iter().find(|at| !parsed.at(at).is_finite()) else {
                    continue;
                };
                let place: Vec<String> =
                    at[..dimensions].iter().map(|part| format!("{part:.4}")).collect();
                let (place, time) = (place.join(", "), at[3]);
                findings.error(
                    &key,
                    format!(
                        "{formula} is {} at [{place}] of the body, t = {time:.4}",
                        parsed.at(at)
                    ),
                    "write an expression that is finite all over the surface, at all times",
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, Model, check};

    const CASE: &str = "
title = 't'
geometry = 'planar'
fluid = { model = 'stokes', viscosity = 1.0 }
domain.disc = { radius = 4.0 }
boundary.wall = 'no-slip'
mesh = { size = 0.5, surface = 0.1 }
time.unsteady = { step = 0.1, end = 2.0 }
define.b = 3.0
[[body]]
name = 'b'
center = [1.0, 0.0]
motion = 'free'
shape.disc.radius = 2.0
gait.slip.velocity = ['b*t', 'x']
";

    fn first(setting: &str) -> Option<String> {
        let file = Case::parse("t.toml", CASE, &[setting.to_owned()]).unwrap();
        check(&file).first().map(|found| format!("{} {} {}", found.key, found.message, found.help))
    }

    #[test]
    fn expressions_of_slip_are_checked_on_the_surface_and_in_time() {
        assert_eq!(first("title=u"), None);
        for (slip, words) in [
            ("['y', 'z']", "body.0.gait.slip.velocity.1 \"z\" at character 1: there is no `z`"),
            ("['c', 'y']", "velocity.0 \"c\" at character 1: there is no `c`"),
            ("['y', 'sqrt(x + 1.5)']", "velocity.1 \"sqrt(x + 1.5)\" is NaN at [-"),
            (
                "['1/(t - 2)', 0]",
                "velocity.0 \"1/(t - 2)\" is inf at [2.0000, 0.0000] of the body, t = 2.0000",
            ),
            ("['y']", "has 1 number"),
        ] {
            let setting = format!("body.0.gait={{ slip = {{ velocity = {slip} }} }}");
            let found = first(&setting).unwrap_or_else(|| panic!("{slip} is accepted"));
            assert!(found.contains(words), "{slip}: {found}");
        }
        let found = first("body.0.shape={ box = { size = [1.0, 1.0] } }").unwrap();
        assert!(found.starts_with("body.0.gait this gait is that of a disc or ellipse"), "{found}");
        let possible =
            "give the body the shape of a disc or ellipse or spline or fish or flagellate, or";
        assert!(found.contains(possible), "{found}");
    }

    #[test]
    fn the_largest_slip_is_the_expected_speed() {
        let file = Case::parse("t.toml", CASE, &[]).unwrap();
        let speed = Model::new(file.case().clone()).unwrap().expected_speed().unwrap();
        // b t and x at x = 2, t = 2
        assert!((speed - 40.0_f64.sqrt()).abs() < 1e-12, "{speed}");
    }
}
