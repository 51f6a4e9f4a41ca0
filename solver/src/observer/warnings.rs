//! `Warning`: what a run warned of, when and how often; the one list of a process, from all stages.

use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use crate::case::Diagnostic;

/// The warnings of the run that this process makes just now: they come from all crates and threads.
static LIST: Mutex<List> = Mutex::new(List { time: None, all: Vec::new() });

/// Something that a run warned of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// What it said the first time.
    pub message: String,
    /// The time that the run had reached then (s); nothing before its first row.
    pub time: Option<f64>,
    /// How often it said so, with whatever numbers.
    pub count: usize,
}

impl Warning {
    /// What is odd in a case, in a line.
    #[must_use]
    pub fn of_case(diagnostic: &Diagnostic) -> Self {
        let Diagnostic { message, help, location, .. } = diagnostic;
        let place = location.as_ref().map_or_else(String::new, |place| format!("{place}: "));
        Self { message: format!("{place}{message}; {help}"), time: None, count: 1 }
    }

    /// In a line.
    #[must_use]
    pub fn line(&self) -> String {
        let Self { message, count, .. } = self;
        if *count == 1 { message.clone() } else { format!("{message} ({count} times)") }
    }
}

struct List {
    time: Option<f64>,
    all: Vec<Warning>,
}

impl List {
    /// Adds a warning, to one of the same kind if there is one.
    fn add(&mut self, message: String) {
        match self.all.iter_mut().find(|one| kind(&one.message) == kind(&message)) {
            Some(same) => same.count += 1,
            None => self.all.push(Warning { message, time: self.time, count: 1 }),
        }
    }

    /// Continues at a time, behind warnings up to then.
    fn continue_at(&mut self, time: f64, mut earlier: Vec<Warning>) {
        self.time = Some(time);
        earlier.retain(|one| one.time.is_none_or(|then| then <= time));
        // Those of the case are the same again
        self.all.retain(|one| earlier.iter().all(|before| before.message != one.message));
        self.all.splice(0..0, earlier);
    }
}

fn list() -> MutexGuard<'static, List> {
    LIST.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Begins the list of a run with warnings that are known.
pub fn begin_warnings(known: Vec<Warning>) {
    *list() = List { time: None, all: known };
}

/// The run continues at a time (s), after parts of it that gave warnings.
pub fn continue_warnings(time: f64, earlier: Vec<Warning>) {
    list().continue_at(time, earlier);
}

/// The warnings of the run so far.
#[must_use]
pub fn warnings() -> Vec<Warning> {
    list().all.clone()
}

/// The run has reached a time (s).
pub(super) fn reach(time: f64) {
    list().time = Some(time);
}

/// The run warns.
pub(super) fn add(message: String) {
    list().add(message);
}

/// A message without its numbers; those in names, which are quoted, stay.
fn kind(message: &str) -> String {
    let (mut text, mut is_name, mut is_number) = (String::new(), false, false);
    for c in message.chars() {
        is_name ^= c == '`' || c == '"';
        is_number = !is_name && (c.is_ascii_digit() || (is_number && ".e-+".contains(c)));
        if !is_number {
            text.push(c);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{List, Warning, kind};

    #[test]
    fn warnings_of_a_kind_are_one_and_those_before_a_checkpoint_stay() {
        let of_case = Warning { message: "odd".to_owned(), time: None, count: 1 };
        let begin = || List { time: None, all: vec![of_case.clone()] };
        let mut list = begin();
        for (time, step) in [(1.0, 10), (2.0, 20), (3.0, 30)] {
            list.time = Some(time);
            list.add(format!("step {step}: too long"));
        }
        list.add("step 30: too fast".to_owned());
        let [case, long, fast] = &list.all[..] else { panic!("are three: {:?}", list.all) };
        assert_eq!((case, long.time, long.count), (&of_case, Some(1.0), 3));
        assert_eq!((long.line().as_str(), fast.time), ("step 10: too long (3 times)", Some(3.0)));
        // From a checkpoint at 2.5
        let mut again = begin();
        again.continue_at(2.5, list.all.clone());
        assert_eq!(again.all, [of_case.clone(), long.clone()]);
        again.add("step 30: too fast".to_owned());
        assert_eq!(again.all[2].time, Some(2.5));
    }

    #[test]
    fn messages_are_of_a_kind_that_differ_in_numbers_alone() {
        let at = |step: usize, cfl: &str, name: &str| {
            format!("step {step}, t = {cfl}: CFL number {cfl} at `{name}`; take {cfl} or less")
        };
        assert_eq!(kind(&at(3, "7.1", "disc-1")), kind(&at(120, "1.25e-3", "disc-1")));
        assert_ne!(kind(&at(3, "7.1", "disc-1")), kind(&at(3, "7.1", "disc-2")));
        assert_ne!(kind("the gap is 3"), kind("the step is 3"));
    }
}
