//! Shipped cases with mistakes made at random are read and checked without a panic, and at once.
#![expect(clippy::unwrap_used, reason = "a test that cannot start a thread has failed")]

use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use alewife_case::{Case, CaseError, Severity, check, known_quantities, library, number_table};

/// Mutants tried, unless the variable `ALEWIFE_MUTANTS` says otherwise.
const MUTANTS: usize = 400;
/// Those of cases of rods.
const MUTANTS_OF_RODS: usize = 400;

/// What reading and checking may take.
const PATIENCE: Duration = Duration::from_secs(10);

/// Numbers that are put in the place of others.
const NUMBERS: [&str; 26] = [
    "0",
    "0.0",
    "-0.0",
    "-1",
    "1",
    "2.5",
    "45",
    "180.0",
    "1e-9",
    "1e-20",
    "1e-300",
    "5e-324",
    "1e9",
    "1e20",
    "1e80",
    "1e308",
    "-1e308",
    "nan",
    "inf",
    "-inf",
    "100000",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "0.1",
];

/// Values of other types.
const VALUES: [&str; 12] = [
    "\"text\"",
    "\"\"",
    "true",
    "[]",
    "{}",
    "[1.0, 2.0, 3.0]",
    "[[0.0, 1.0]]",
    "1979-05-27",
    "{ a = 1 }",
    "[\"a\"]",
    "\"a\\u001bb\"",
    "-7",
];

/// Characters that are put in the place of others.
const CHARACTERS: [char; 14] =
    ['=', '[', ']', '{', '}', '"', '.', ',', '#', '\n', '\t', '9', 'é', '\u{1b}'];

/// Numbers without a pattern, the same on every machine (@steele2014).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % (n.max(1) as u64)).unwrap()
    }

    fn one_of<'a, T>(&mut self, list: &'a [T]) -> Option<&'a T> {
        list.get(self.below(list.len()))
    }
}

/// Stretches of a text that are numbers.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let is_part = |c: char| c.is_ascii_digit() || "+-.eE_".contains(c);
    let mut found = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (start, is_part(c)) {
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

/// A text with one mistake more.
fn mutated(text: &str, random: &mut Random) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let line = random.below(lines.len());
    let with_lines = |lines: Vec<&str>| lines.join("\n") + "\n";
    match random.below(10) {
        0..=3 => {
            let found = numbers(text);
            let Some(range) = random.one_of(&found).cloned() else { return text.to_owned() };
            let number = random.one_of(&NUMBERS).copied().unwrap_or_default();
            format!("{}{number}{}", &text[..range.start], &text[range.end..])
        }
        4 => with_lines([&lines[..line], &lines[(line + 1).min(lines.len())..]].concat()),
        5 => with_lines([&lines[..line], &lines[(line + 4).min(lines.len())..]].concat()),
        6 => {
            let twice = lines.get(line).copied().unwrap_or_default();
            with_lines([&lines[..line], &[twice], &lines[line..]].concat())
        }
        7 => {
            let Some((key, _)) = lines.get(line).and_then(|line| line.split_once('=')) else {
                return text.to_owned();
            };
            let value = random.one_of(&VALUES).copied().unwrap_or_default();
            let changed = format!("{key}= {value}");
            with_lines([&lines[..line], &[&changed], &lines[line + 1..]].concat())
        }
        8 => {
            let at = random.below(text.chars().count());
            let other = random.one_of(&CHARACTERS).copied().unwrap_or(' ');
            text.chars().enumerate().map(|(n, c)| if n == at { other } else { c }).collect()
        }
        _ => {
            let at = random.below(text.chars().count());
            text.chars().take(at).collect()
        }
    }
}

/// What became of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fate {
    Accepted,
    Refused,
    Panicked,
}

/// Reads and checks a text, and writes all there is to say of it.
fn fate(text: &str) -> Fate {
    let judged = catch_unwind(AssertUnwindSafe(|| match Case::parse("mutant.toml", text, &[]) {
        Ok(file) => {
            let mut said = number_table(&file.model);
            // Names of columns, of which diagnostics show those they mean
            let _ = known_quantities(&file.model);
            let found = check(&file);
            for diagnostic in &found {
                let _ = writeln!(said, "{diagnostic}");
            }
            assert!(!said.chars().any(|c| c.is_control() && c != '\n' && c != '\t'), "{said:?}");
            let is_right = found.iter().all(|one| one.severity == Severity::Warning);
            if is_right { Fate::Accepted } else { Fate::Refused }
        }
        Err(error) => {
            if let CaseError::Wrong(diagnostics) = &error {
                assert!(!diagnostics.is_empty());
            }
            let _ = error.to_string();
            Fate::Refused
        }
    }));
    judged.unwrap_or(Fate::Panicked)
}

/// What became of so many mutants of some cases: accepted, refused, and panics or delays, which are printed.
fn fates(names: &[&str], n: usize) -> [usize; 3] {
    let mut random = Random(1);
    let (mut accepted, mut refused, mut panicked, mut slow) = (0, 0, 0, 0);
    for _ in 0..n {
        let Some(name) = random.one_of(names).copied() else { continue };
        let mut text = Case::text(name).unwrap();
        for _ in 0..=random.below(3) {
            text = mutated(&text, &mut random);
        }
        let (sender, receiver) = mpsc::channel();
        let mutant = text.clone();
        thread::spawn(move || sender.send(fate(&mutant)));
        match receiver.recv_timeout(PATIENCE) {
            Ok(Fate::Accepted) => accepted += 1,
            Ok(Fate::Refused) => refused += 1,
            Ok(Fate::Panicked) | Err(RecvTimeoutError::Disconnected) => {
                panicked += 1;
                eprintln!("---- a panic ({name}):\n{text}\n----");
            }
            Err(RecvTimeoutError::Timeout) => {
                slow += 1;
                eprintln!("---- more than {PATIENCE:?} ({name}):\n{text}\n----");
            }
        }
    }
    // Had one aborted, this line would not be reached
    println!("{n} mutants: {accepted} accepted, {refused} refused, {panicked} panics, {slow} slow");
    [accepted, refused, panicked + slow]
}

fn number_of_mutants(by_default: usize) -> usize {
    let given = std::env::var("ALEWIFE_MUTANTS").ok().and_then(|n| n.parse().ok());
    given.unwrap_or(by_default)
}

#[test]
fn mistakes_are_refused_without_a_panic_and_at_once() {
    let names: Vec<&str> = library::list().iter().map(|shipped| shipped.name).collect();
    let [accepted, refused, wrong] = fates(&names, number_of_mutants(MUTANTS));
    assert_eq!(wrong, 0);
    assert!(accepted > 0 && refused > 0);
}

/// Few of the shipped cases have rods.
#[test]
fn mistakes_in_cases_of_rods_are_refused_without_a_panic_and_at_once() {
    let names = [
        "elastic-flagellum",
        "settling-fibre",
        "cilia-pair",
        "biflagellate",
        "flexible-magnetic-swimmer",
    ];
    let [accepted, refused, wrong] = fates(&names, number_of_mutants(MUTANTS_OF_RODS));
    assert_eq!(wrong, 0);
    assert!(accepted > 0 && refused > 0);
}
