//! No file uses, through others, itself; rooms of the crate of cases use those below them.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::{CRATES, sources};
use super::syntax::{Parsed, parsed};

/// Rooms of the crate of cases, and those each may use. Reading a case types what it says of a sweep, whose
/// cases are read in turn.
const ROOMS_OF_CASES: [(&str, &[&str]); 8] = [
    ("text", &[]),
    ("spec", &["text"]),
    ("model", &["spec", "text"]),
    ("quantity", &["model", "spec"]),
    ("read", &["model", "spec", "sweep", "text"]),
    ("rules", &["model", "quantity", "read", "spec", "text"]),
    ("soft", &["read", "spec", "text"]),
    ("sweep", &["model", "quantity", "read", "rules", "soft", "spec", "text"]),
];

/// A module of a crate by its path, the root of the crate having none.
type Module = Vec<String>;

/// The modules of a crate, and which module defines each name.
#[derive(Default)]
struct Crate {
    /// File of each module.
    files: BTreeMap<Module, String>,
    /// For each module the names it takes from others, which it passes on to its children at least, by
    /// the path it takes them from.
    passed_on: BTreeMap<Module, BTreeMap<String, Vec<String>>>,
    /// For each module the paths it names, as they are written.
    named: BTreeMap<Module, Vec<Vec<String>>>,
}

impl Crate {
    fn read(folder: &str) -> Self {
        let mut all = Self::default();
        for file in sources(folder).into_keys() {
            // A program is a crate of its own beside its library
            if file.ends_with("src/main.rs") {
                continue;
            }
            let inside = file.strip_prefix(folder).expect("a source lies in its folder");
            let inside = inside.trim_start_matches('/').trim_end_matches(".rs");
            let mut module: Module = inside.split('/').map(str::to_owned).collect();
            if module.last().is_some_and(|last| ["mod", "lib"].contains(&last.as_str())) {
                module.pop();
            }
            let Parsed { passed_on, named, .. } = parsed(&file);
            all.files.insert(module.clone(), file);
            all.passed_on.insert(module.clone(), passed_on.clone());
            all.named.insert(module, named.clone());
        }
        all
    }

    /// The module that defines what a path names in a module; none for other crates.
    fn definition(&self, module: &[String], path: &[String]) -> Option<Module> {
        let mut at = module.to_vec();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => (at, rest) = (Vec::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {}
            first => {
                let child = [module, &[first.to_owned()]].concat();
                let is_known =
                    self.files.contains_key(&child) || self.passed_on[module].contains_key(first);
                if !is_known {
                    return None;
                }
            }
        }
        while let Some((next, others)) = rest.split_first() {
            if next == "super" {
                at.pop();
            } else {
                let child = [at.as_slice(), std::slice::from_ref(next)].concat();
                if self.files.contains_key(&child) {
                    at = child;
                } else if let Some(from) = self.passed_on[&at].get(next) {
                    return self.definition(&at, &[from.as_slice(), others].concat());
                } else {
                    return Some(at);
                }
            }
            rest = others;
        }
        Some(at)
    }

    /// Which modules each module uses.
    fn uses(&self) -> BTreeMap<&Module, BTreeSet<Module>> {
        let mut uses = BTreeMap::new();
        for (module, paths) in &self.named {
            let used = paths.iter().filter_map(|path| self.definition(module, path));
            uses.insert(module, used.filter(|used| used != module).collect());
        }
        uses
    }
}

/// A way along `uses` from one module to another, if there is one.
fn way(
    uses: &BTreeMap<&Module, BTreeSet<Module>>,
    from: &Module,
    to: &Module,
) -> Option<Vec<Module>> {
    let mut reached = BTreeMap::from([(from.clone(), None::<Module>)]);
    let mut next = vec![from.clone()];
    while let Some(module) = next.pop() {
        for used in uses.get(&module).into_iter().flatten() {
            if used == to {
                let mut all = vec![to.clone(), module.clone()];
                let mut at = &module;
                while let Some(Some(before)) = reached.get(at) {
                    all.push(before.clone());
                    at = before;
                }
                all.reverse();
                return Some(all);
            }
            if !reached.contains_key(used) {
                reached.insert(used.clone(), Some(module.clone()));
                next.push(used.clone());
            }
        }
    }
    None
}

#[test]
fn no_file_uses_itself_through_others() {
    let mut wrong = Vec::new();
    for folder in CRATES {
        let all = Crate::read(folder);
        let uses = all.uses();
        let mut known = BTreeSet::new();
        for module in uses.keys() {
            let Some(circle) = way(&uses, module, module) else { continue };
            // One circle is reported once
            if circle.iter().all(|module| known.insert(module.clone()) || module == &circle[0]) {
                let files: Vec<_> =
                    circle.iter().map(|module| all.files[module].as_str()).collect();
                wrong.push(files.join(" -> "));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rooms_of_the_crate_of_cases_use_those_below_them() {
    let all = Crate::read("solver/case/src");
    let rules: BTreeMap<_, _> = ROOMS_OF_CASES.into_iter().collect();
    let mut wrong = Vec::new();
    let mut n_used = 0;
    for (module, used) in all.uses() {
        let Some(room) = module.first().filter(|room| rules.contains_key(room.as_str())) else {
            continue;
        };
        let elsewhere = used.iter().filter_map(|used| used.first()).filter(|used| *used != room);
        for used in elsewhere {
            n_used += 1;
            if !rules[room.as_str()].contains(&used.as_str()) {
                wrong.push(format!("{}: `{room}` may not use `{used}`", all.files[module]));
            }
        }
    }
    assert!(n_used > 100, "{n_used}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
