//! The syntax of the source files of all crates: names they use, and what is wrong with their functions.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use super::sources::all_sources;

/// Lines of a function, element kernels excepted.
const FUNCTION: usize = 70;

/// Arguments of a function besides `self`.
const ARGUMENTS: usize = 6;

/// Files of element kernels, whose functions may be longer.
const KERNELS: &str = "solver/flow/src/flow/taylor_hood/";

/// What tests ask of a file, which is parsed once for all of them: threads do not share its tree.
pub struct Parsed {
    /// The names it takes from others, by the path it takes them from.
    pub passed_on: BTreeMap<String, Vec<String>>,
    /// The paths it names, as they are written.
    pub named: Vec<Vec<String>>,
    /// What is wrong with its functions.
    pub wrong: Vec<String>,
}

static ALL: LazyLock<BTreeMap<String, Parsed>> = LazyLock::new(|| {
    let parsed = |(file, text): (String, String)| {
        let found = Parsed::new(&file, &syntax(&file, &text));
        (file, found)
    };
    all_sources().map(parsed).collect()
});

/// A source file of a crate, without its tests.
pub fn parsed(file: &str) -> &'static Parsed {
    ALL.get(file).unwrap_or_else(|| panic!("{file} is no source of a crate"))
}

impl Parsed {
    fn new(file: &str, tree: &syn::File) -> Self {
        let (mut passed_on, mut paths) = (BTreeMap::new(), Paths::default());
        for item in &tree.items {
            let syn::Item::Use(item) = item else {
                paths.visit_item(item);
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
        let mut functions = Functions { file, is_of_trait: false, wrong: Vec::new() };
        functions.visit_file(tree);
        Self { passed_on, named: paths.0, wrong: functions.wrong }
    }
}

/// A file as a syntax tree, without its tests.
fn syntax(file: &str, text: &str) -> syn::File {
    let mut tree = syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"));
    tree.items.retain(|item| !is_test(item));
    tree
}

/// Whether an item is compiled for tests only.
fn is_test(item: &syn::Item) -> bool {
    let syn::Item::Mod(module) = item else { return false };
    module.attrs.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|only| only == "test")
    })
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

impl<'ast> Visit<'ast> for Paths {
    /// Who may use an item is no use of that module.
    fn visit_visibility(&mut self, _visibility: &'ast syn::Visibility) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.segments.len() > 1 {
            self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }
}

/// What is wrong with the functions of a file.
struct Functions<'a> {
    file: &'a str,
    /// Whether the functions at hand are those of a trait, for some type.
    is_of_trait: bool,
    wrong: Vec<String>,
}

impl Functions<'_> {
    fn check(&mut self, signature: &syn::Signature, lines: usize) {
        let Self { file, wrong, .. } = self;
        let (name, line) = (&signature.ident, signature.ident.span().start().line);
        if lines >= FUNCTION && !file.starts_with(KERNELS) {
            wrong.push(format!("{file}:{line}: `{name}` has {lines} lines"));
        }
        if self.is_of_trait {
            return;
        }
        let arguments: Vec<&syn::PatType> = signature
            .inputs
            .iter()
            .filter_map(|input| match input {
                syn::FnArg::Receiver(_) => None,
                syn::FnArg::Typed(typed) => Some(typed),
            })
            .collect();
        if arguments.len() > ARGUMENTS {
            wrong.push(format!("{file}:{line}: `{name}` has {} arguments", arguments.len()));
        }
        let mut tuples = Tuples::default();
        arguments.iter().for_each(|argument| tuples.visit_type(&argument.ty));
        tuples.visit_return_type(&signature.output);
        if tuples.found {
            wrong.push(format!("{file}:{line}: `{name}` has a tuple in its signature"));
        }
    }
}

impl<'ast> Visit<'ast> for Functions<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.check(&item.sig, n_lines(item.block.span()));
        visit::visit_item_fn(self, item);
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        // The trait decides on the signatures of its methods
        let before = std::mem::replace(&mut self.is_of_trait, item.trait_.is_some());
        visit::visit_item_impl(self, item);
        self.is_of_trait = before;
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.check(&item.sig, n_lines(item.block.span()));
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        self.check(&item.sig, item.default.as_ref().map_or(0, |block| n_lines(block.span())));
        visit::visit_trait_item_fn(self, item);
    }
}

fn n_lines(span: proc_macro2::Span) -> usize {
    span.end().line - span.start().line + 1
}

/// Whether a type holds a tuple of two or more; the arguments of closures and what iterators pass
/// along do not count.
#[derive(Default)]
struct Tuples {
    found: bool,
}

impl<'ast> Visit<'ast> for Tuples {
    fn visit_type_tuple(&mut self, tuple: &'ast syn::TypeTuple) {
        self.found |= tuple.elems.len() > 1;
    }

    fn visit_type_impl_trait(&mut self, _: &'ast syn::TypeImplTrait) {}

    fn visit_type_trait_object(&mut self, _: &'ast syn::TypeTraitObject) {}

    fn visit_type_bare_fn(&mut self, _: &'ast syn::TypeBareFn) {}
}
