//! No file uses, through others, itself; rooms of the crate of cases use those below them.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::{CRATES, sources, syntax};

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

/// The paths of a `use`, flat, with the name each gets.
fn flatten(tree: &syn::UseTree, before: &[String], all: &mut Vec<(Vec<String>, String)>) {
    let with = |ident: &syn::Ident| [before, &[ident.to_string()]].concat();
    match tree {
        syn::UseTree::Path(path) => flatten(&path.tree, &with(&path.ident), all),
        syn::UseTree::Name(name) => all.push((with(&name.ident), name.ident.to_string())),
        syn::UseTree::Rename(rename) => all.push((with(&rename.ident), rename.rename.to_string())),
        syn::UseTree::Group(group) => {
            group.items.iter().for_each(|item| flatten(item, before, all));
        }
        syn::UseTree::Glob(_) => all.push((before.to_vec(), "*".to_owned())),
    }
}

/// Paths named in expressions and types, such as `super::ordering::order`.
#[derive(Default)]
struct Paths(Vec<Vec<String>>);

impl<'ast> syn::visit::Visit<'ast> for Paths {
    /// Who may use an item is no use of that module.
    fn visit_visibility(&mut self, _visibility: &'ast syn::Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.segments.len() > 1 {
            self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        syn::visit::visit_path(self, path);
    }
}

impl Crate {
    fn read(folder: &str) -> Self {
        let mut all = Self::default();
        for (file, text) in sources(folder) {
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
            all.add(module, &file, &syntax(&file, &text));
        }
        all
    }

    fn add(&mut self, module: Module, file: &str, tree: &syn::File) {
        let (mut passed_on, mut paths) = (BTreeMap::new(), Paths::default());
        for item in &tree.items {
            let syn::Item::Use(item) = item else {
                syn::visit::Visit::visit_item(&mut paths, item);
                continue;
            };
            let mut all = Vec::new();
            flatten(&item.tree, &[], &mut all);
            let is_private = matches!(item.vis, syn::Visibility::Inherited);
            for (path, name) in all {
                if is_private {
                    paths.0.push(path.clone());
                }
                passed_on.insert(name, path);
            }
        }
        self.files.insert(module.clone(), file.to_owned());
        self.passed_on.insert(module.clone(), passed_on);
        self.named.insert(module, paths.0);
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
