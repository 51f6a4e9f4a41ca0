//! Functions, files, folders and signatures stay small enough to be read.

use std::collections::BTreeMap;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use super::sources::{all_sources, sources, syntax};

/// Lines of a file.
const FILE: usize = 400;

/// Source files of a folder, its door `mod.rs` or `lib.rs` included.
const FOLDER: usize = 15;

/// Lines of a function, element kernels excepted.
const FUNCTION: usize = 70;

/// Arguments of a function besides `self`.
const ARGUMENTS: usize = 6;

/// Files of element kernels, whose functions may be longer.
const KERNELS: &str = "solver/flow/src/flow/taylor_hood/";

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

#[test]
fn functions_are_short_and_their_signatures_plain() {
    let mut wrong = Vec::new();
    for (file, text) in all_sources().filter(|(file, _)| !file.ends_with("tests.rs")) {
        let tree = syntax(&file, &text);
        let mut functions = Functions { file: &file, is_of_trait: false, wrong: Vec::new() };
        functions.visit_file(&tree);
        wrong.append(&mut functions.wrong);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_are_short() {
    let mut wrong = Vec::new();
    for folder in ["interrupt", "mesh", "solver", "tests"] {
        for (file, text) in sources(folder) {
            let lines = text.lines().count();
            if lines > FILE {
                wrong.push(format!("{file} has {lines} lines"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn folders_have_few_files() {
    let all: Vec<String> = ["interrupt", "mesh", "solver", "tests"]
        .into_iter()
        .flat_map(sources)
        .map(|(file, _)| file)
        .collect();
    let mut n_files = BTreeMap::<&str, usize>::new();
    for file in &all {
        let (folder, _) = file.rsplit_once('/').expect("a file lies in a folder");
        *n_files.entry(folder).or_default() += 1;
    }
    let crowded: Vec<_> = n_files.iter().filter(|&(_, &n_files)| n_files > FOLDER).collect();
    assert!(crowded.is_empty(), "more than {FOLDER} files: {crowded:?}");
}
