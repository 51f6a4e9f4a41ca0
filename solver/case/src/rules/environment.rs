//! Problems of `[environment]`: names nobody has, intervals no step ends at, laws that are none.

use super::Findings;
use crate::spec::formula::mistake_in_name;
use crate::text::nearest::several_nearest;
use crate::{CaseFile, Ending, EnvironmentSpec, Law, Mistake, Signals, TimeSettings};

/// Steps in an interval, less the nearest whole number, that are rounding.
const ROUNDING: f64 = 1e-6;

/// Most samples of a case: they are all read and checked before the first episode.
const MOST_SAMPLES: usize = 100_000;

pub fn check(findings: &mut Findings<'_>, file: &CaseFile) {
    let Some(spec) = &findings.case().environment else { return };
    interval(findings, spec);
    lists(findings, spec);
    distinct(findings, spec);
    names(findings, spec);
    if let Err(mistakes) = Signals::new(findings.model(), spec) {
        for Mistake { key, message, help } in mistakes {
            findings.error(&key, message, &help);
        }
    }
    for (name, one) in &spec.target {
        law(findings, &format!("environment.target.{name}"), one);
    }
    randomised(findings, spec, file);
}

/// Steps end where decisions are made.
fn interval(findings: &mut Findings<'_>, spec: &EnvironmentSpec) {
    let key = "environment.interval";
    let TimeSettings::Unsteady(time) = &findings.case().time else {
        findings.error(
            "environment",
            "a steady solution knows no time, in which something could be decided".to_owned(),
            "use [time.unsteady], or leave [environment] out",
        );
        return;
    };
    if time.adaptive.is_some() {
        findings.error(
            key,
            "decisions are made at the ends of steps, and those of this case are adaptive"
                .to_owned(),
            "write time.unsteady.step for fixed steps",
        );
        return;
    }
    let steps = spec.interval / time.step;
    let whole = steps.round().max(1.0);
    if (steps - whole).abs() > ROUNDING * whole {
        let near = [steps.floor().max(1.0), steps.ceil()].map(|n| (n * time.step).to_string());
        findings.error(
            key,
            format!("the interval of {} is {steps} steps of {}", spec.interval, time.step),
            &format!("a multiple of the step, such as {} or {}", near[0], near[1]),
        );
    } else if spec.interval > time.end * (1.0 + ROUNDING) {
        findings.error(
            key,
            format!("the interval of {} is longer than the case of {}", spec.interval, time.end),
            "an interval up to time.unsteady.end, at which an episode is truncated",
        );
    }
}

/// Something is observed, done and paid.
fn lists(findings: &mut Findings<'_>, spec: &EnvironmentSpec) {
    for (key, is_empty) in [
        ("observations", spec.observations.is_empty()),
        ("actions", spec.actions.is_empty()),
        ("reward", spec.reward.is_empty()),
    ] {
        if is_empty {
            let message = format!("`{key}` is empty");
            findings.error(&format!("environment.{key}"), message, "name one at least");
        }
    }
    for (nth, observation) in spec.observations.iter().enumerate() {
        let scaled = observation.scaled();
        if let Some([low, high]) = scaled.bounds.filter(|[low, high]| low >= high) {
            findings.error(
                &format!("environment.observations.{nth}.bounds"),
                format!("the bounds go from {low} to {high}"),
                "write bounds = [lowest, highest], the lowest below the highest",
            );
        }
    }
    if spec.samples == 0 || spec.samples > MOST_SAMPLES {
        findings.error(
            "environment.samples",
            format!("{} samples are asked for", spec.samples),
            &format!("a number from 1 to {MOST_SAMPLES}"),
        );
    }
}

/// Terms of the reward and ends are told apart by their names.
fn distinct(findings: &mut Findings<'_>, spec: &EnvironmentSpec) {
    let named = |ending: &Ending| ending.name.clone().unwrap_or_else(|| ending.when.clone());
    let terms = spec.reward.iter().map(|term| term.name.clone().unwrap_or_else(|| term.of.clone()));
    let lists: [(&str, &str, Vec<String>); 3] = [
        ("reward", "of", terms.collect()),
        ("terminate", "when", spec.terminate.iter().map(named).collect()),
        ("truncate", "when", spec.truncate.iter().map(named).collect()),
    ];
    for (list, own, names) in lists {
        for (nth, name) in
            names.iter().enumerate().filter(|(nth, name)| names[..*nth].contains(name))
        {
            let is_given = match list {
                "reward" => spec.reward[nth].name.is_some(),
                "terminate" => spec.terminate[nth].name.is_some(),
                _ => spec.truncate[nth].name.is_some(),
            };
            let key = if is_given { "name" } else { own };
            findings.error(
                &format!("environment.{list}.{nth}.{key}"),
                format!("two entries of `{list}` are called \"{name}\""),
                "give each a name of its own: name = \"...\"",
            );
        }
    }
}

/// Names of values and targets are words of their own.
fn names(findings: &mut Findings<'_>, spec: &EnvironmentSpec) {
    let defined = &findings.case().define;
    for name in spec.value.keys() {
        let taken = (name == "time" || defined.contains_key(name))
            .then(|| "this name has a meaning in expressions already".to_owned());
        if let Some(mistake) = mistake_in_name(name).or(taken) {
            findings.error(
                &format!("environment.value.{name}"),
                format!("a value cannot be called `{name}`"),
                &mistake,
            );
        }
    }
    for name in spec.target.keys() {
        let is_word = !name.is_empty()
            && name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
        if !is_word {
            findings.error(
                &format!("environment.target.{name}"),
                format!("a target cannot be called `{name}`"),
                "letters, digits, _ and -",
            );
        }
    }
}

fn law(findings: &mut Findings<'_>, key: &str, law: &Law) {
    match law {
        Law::Uniform([low, high]) if low >= high => findings.error(
            &format!("{key}.uniform"),
            format!("the range goes from {low} to {high}"),
            "write [lowest, highest], the lowest below the highest",
        ),
        Law::LogUniform([low, high]) if *low <= 0.0 || low >= high => findings.error(
            &format!("{key}.log-uniform"),
            format!("the range goes from {low} to {high}"),
            "write [lowest, highest], both positive and the lowest below the highest",
        ),
        Law::Uniform(_) | Law::LogUniform(_) | Law::Normal { .. } => {}
    }
}

/// What differs from sample to sample is a number of the case.
fn randomised(findings: &mut Findings<'_>, spec: &EnvironmentSpec, file: &CaseFile) {
    for (nth, one) in spec.randomise.iter().enumerate() {
        let key = format!("environment.randomise.{nth}");
        law(findings, &format!("{key}.law"), &one.law);
        let name = &one.key;
        let is_of_the_task =
            ["environment.", "time.", "define."].iter().any(|table| name.starts_with(table));
        if is_of_the_task {
            findings.error(
                &format!("{key}.key"),
                format!("`{name}` is no number of fluid, bodies or joints"),
                "a key of the swimmer or of the fluid it is in; targets are in environment.target",
            );
        } else if file.number(name).is_none() {
            let near = meant(name, &file.number_keys());
            findings.error(
                &format!("{key}.key"),
                format!("`{name}` is no number that is written in the case{near}"),
                "a key as for --set, of a number that the case has: write its usual value there first",
            );
        }
        if spec.randomise[..nth].iter().any(|other| other.key == *name) {
            findings.error(
                &format!("{key}.key"),
                format!("`{name}` is randomised twice"),
                "name each key once",
            );
        }
    }
}

/// Keys like a misspelt one, as a help.
fn meant(word: &str, known: &[String]) -> String {
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    match several_nearest(word, &known)[..] {
        [] => String::new(),
        ref near => format!("; did you mean {}?", near.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use crate::{Case, check};

    const CASE: &str = r#"
title = "t"
extends = "robot-eel"
[[swimmer]]
name = "eel"
[swimmer.kind.chain]
links = [[0.4, 0.12], [0.4, 0.12]]
gap = 0.15
joints = [{ bent.angle.command = { limits = [-0.8, 0.8], filter = 0.08 } }]
[references]
file = "none.csv"
[environment]
interval = 0.05
observations = ["eel.x", "way", { of = "cos([eel-1.angle])", scale = 0.5, bounds = [-2.0, 2.0] }]
actions = ["eel.joint.1"]
reward = [{ of = "eel.velocity.x", weight = 2.0 }, { of = "-abs([action.eel.joint.1])", name = "effort" }]
terminate = [{ when = "way < reach", reward = 300.0 }]
target.x = { uniform = [1.0, 2.0] }
value.way = "sqrt(side^2 + [eel.y]^2)"
value.side = "[target.x] - [eel.x]"
randomise = [{ key = "fluid.viscosity", law.log-uniform = [0.05, 0.2] }]
[define]
reach = 0.1
"#;

    /// All that the environment reports.
    fn told(setting: &str) -> String {
        let text = CASE.replace("[references]\nfile = \"none.csv\"\n", "");
        let settings = ["reference=[]".to_owned(), setting.to_owned()];
        let file = Case::parse("t.toml", &text, &settings).unwrap();
        let found = check(&file);
        let own = found.iter().filter(|found| found.key.starts_with("environment"));
        own.map(|found| format!("{} {} {}\n", found.key, found.message, found.help)).collect()
    }

    #[test]
    fn what_is_wrong_is_told_by_its_key() {
        assert_eq!(told("title=u"), "");
        for (setting, words) in [
            (
                "environment.interval=0.025",
                "interval the interval of 0.025 is 2.5 steps of 0.01 a multiple of the step, such as 0.02 or 0.03",
            ),
            ("environment.interval=50.0", "interval the interval of 50 is longer"),
            ("environment.interval=0.0", "environment.interval"),
            (
                "environment.observations=['eel.y', 'eel.z']",
                "observations.1 \"eel.z\" at character 1",
            ),
            ("environment.observations=[]", "observations `observations` is empty"),
            (
                "environment.actions=['eel.joint.2']",
                "actions.0 there is no command `eel.joint.2`; did you mean eel.joint.1",
            ),
            (
                "environment.actions=['eel.joint.1', 'eel.joint.1']",
                "actions.1 `eel.joint.1` is an action twice",
            ),
            (
                "environment.actions=[{ command = 'eel.joint.1', range = [1.0, -1.0] }]",
                "actions.0 the range goes from 1 to -1",
            ),
            (
                "environment.reward=[{ of = '[eel.velocity.w]' }]",
                "reward.0.of \"[eel.velocity.w]\" at character 1: there is no `eel.velocity.w` did you mean `eel.velocity.x`",
            ),
            (
                "environment.reward=[{ of = 'way' }, { of = 'eel.x', name = 'way' }]",
                "reward.1.name two entries of `reward` are called \"way\" give each a name",
            ),
            (
                "environment.terminate=[{ when = 'way < 1' }, { when = 'way < 1' }]",
                "terminate.1.when two entries of `terminate` are called \"way < 1\"",
            ),
            ("environment.value.side='way'", "value.side values depend on each other: side, way"),
            ("environment.value.sin='1'", "value.sin a value cannot be called `sin`"),
            ("environment.value.reach='1'", "value.reach"),
            ("environment.target.x={ uniform = [2.0, 1.0] }", "target.x.uniform the range"),
            ("environment.target.x={ log-uniform = [0.0, 1.0] }", "target.x.log-uniform the range"),
            ("environment.target.x={ normal = { mean = 0.0, deviation = -1.0 } }", "deviation"),
            (
                "environment.randomise.0.key='fluid.viscosty'",
                "randomise.0.key `fluid.viscosty` is no number that is written in the case; did you mean fluid.viscosity",
            ),
            ("environment.randomise.0.key='time.unsteady.step'", "randomise.0.key"),
            ("environment.samples=0", "samples 0 samples"),
            ("environment.terminate=[{ when = 'way <' }]", "terminate.0.when"),
            ("environment.observations.2.bounds=[1.0, 1.0]", "observations.2.bounds"),
            ("environment.observations.2.scale=0.0", "observations.2.scale"),
            ("time.unsteady={ end = 1.0 }", "interval decisions are made at the ends of steps"),
        ] {
            let found = told(setting);
            assert!(found.contains(words), "{setting}: {found}");
        }
    }
}
