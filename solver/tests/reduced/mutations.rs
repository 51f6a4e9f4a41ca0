//! Reduced cases with mistakes made at random are read, checked and run without a panic.

use std::panic::{AssertUnwindSafe, catch_unwind};

use alewife::case::{Case, Severity, check, check_reduced, library};
use alewife::reduced::simulate;

/// Cases they are made of.
const CASES: [&str; 4] =
    ["underwater-vehicle", "robot-eel", "purcell-three-link", "eel-calibration"];

/// What is put in the place of numbers.
const NUMBERS: [&str; 14] = [
    "0", "-1", "1e-300", "1e308", "nan", "inf", "-inf", "1e9", "-0.0", "2", "\"text\"", "[]", "{}",
    "1e-9",
];

/// Numbers without a pattern, the same on every machine.
fn next(seed: &mut u64) -> usize {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    usize::try_from(*seed >> 33).unwrap()
}

/// Stretches of a text that are numbers.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (start, c.is_ascii_digit() || "+-.e".contains(c)) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                if text[from..at].parse::<f64>().is_ok() {
                    found.push(from..at);
                }
                start = None;
            }
            _ => {}
        }
    }
    found
}

#[test]
fn some_hundred_mutants_are_refused_or_run() {
    let mut seed = 7;
    let mut runs = 0;
    for nth in 0..240 {
        let name = CASES[nth % CASES.len()];
        let text = library::find(name).unwrap().text;
        let found = numbers(text);
        let range = found[next(&mut seed) % found.len()].clone();
        let number = NUMBERS[next(&mut seed) % NUMBERS.len()];
        let mutant = format!("{}{number}{}", &text[..range.start], &text[range.end..]);
        let mutant = mutant.replace("file = \"references.csv\"", "");
        // Short, whatever is asked for
        let settings = ["time.unsteady={ step = 0.05, end = 0.5 }".to_owned()];
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let Ok(file) = Case::parse(&format!("{name}.toml"), &mutant, &settings) else {
                return 0;
            };
            let wrong = |found: Vec<alewife::case::Diagnostic>| {
                found.iter().any(|one| one.severity == Severity::Error)
            };
            if wrong(check(&file)) || wrong(check_reduced(&file)) {
                return 0;
            }
            let finite = simulate(&file.model).is_ok_and(|series| series.rows.len() > 1);
            usize::from(finite)
        }));
        match outcome {
            Ok(run) => runs += run,
            Err(_) => panic!("mutant {nth} of {name}, {number} at {range:?}, panics"),
        }
    }
    assert!(runs > 30, "{runs}");
}
