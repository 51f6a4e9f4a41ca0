//! Elongated-body theory in a case: it swims head first, its momentum is that of the wake, and what it needs is asked for.

use alewife::case::{Severity, check};

use super::{last, read, run};

const GAIT: &str = "reduced={ loads = 'ebt', depth = 1.0 }";

#[test]
fn an_eel_swims_head_first_by_what_its_tail_leaves_behind() {
    let way = |settings: &[&str]| {
        let series = run("robot-eel", settings);
        last(&series, "eel.x") - series.column("eel.x").unwrap()[0]
    };
    let of = |depth: f64, added_mass: f64| {
        way(&[&format!(
            "reduced={{ loads = 'ebt', depth = {depth:?}, \
             coefficients = {{ added_mass = {added_mass:?}, tangential_linear = 1.0 }} }}"
        )])
    };
    let swims = of(1.0, 1.0);
    assert!(swims > 1.0, "{swims}");
    // A body twice as high moves four times the fluid, a depth twice
    let high = of(2.0, 1.0);
    assert!(high > 1.5 * swims, "{high} {swims}");
    let heavy = of(1.0, 2.0);
    assert!((heavy / high - 1.0).abs() < 1e-12, "{heavy} {high}");
    // Without fluid that is moved there is nothing to push against, and friction along it drives it with its wave
    let idle = of(1.0, 0.0);
    assert!(idle < 0.0, "{idle}");
}

#[test]
fn what_it_needs_is_asked_for_by_key() {
    let wrong = |name: &str, setting: &str| -> Vec<String> {
        let found = check(&read(name, &[setting]));
        let errors = found.into_iter().filter(|one| one.severity == Severity::Error);
        errors.map(|one| format!("{} {} {}", one.key, one.message, one.help)).collect()
    };
    assert!(wrong("robot-eel", GAIT).is_empty());
    for (name, setting, words) in [
        ("robot-eel", "reduced={ loads = 'ebt' }", "reduced.loads elongated-body theory needs"),
        ("robot-eel", "reduced={ loads = 'ebt', depth = -1.0 }", "reduced.depth"),
        (
            "robot-eel",
            "reduced={ loads = 'links', depth = 1.0 }",
            "reduced.depth the law \"links\"",
        ),
        ("underwater-vehicle", "reduced={ loads = 'ebt', depth = 1.0 }", "for a planar case"),
        ("disc-settling", "reduced={ loads = 'ebt', depth = 1.0 }", "a chain of links"),
    ] {
        let found = wrong(name, setting);
        assert!(found.iter().any(|one| one.contains(words)), "{name} {setting}: {found:?}");
    }
    let error = read_error("reduced={ loads = 'ebt', depth = nan }");
    assert!(error.contains("depth"), "{error}");
}

fn read_error(setting: &str) -> String {
    match alewife::case::Case::read("robot-eel", &[setting.to_owned()]) {
        Err(error) => error.to_string(),
        Ok(file) => check(&file).iter().map(ToString::to_string).collect(),
    }
}
