//! Checks that only the catalogue refers to terms by their ids and to settings by their names.
//!
//! Both are for files and their readers. Code asks a setting for its kind and compares a term with the constant of the catalogue,
//! which the compiler checks.

use std::collections::BTreeSet;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::Visit;
use syn::{ExprStruct, Item, Lit, LitStr, Member};

use super::Finding;
use super::cycles::{is_for_tests, module_of};
use super::sources::sources;
use crate::Result;
use crate::manifest::{Manifest, crate_folders};

/// The crate of the catalogue.
const CATALOGUE: &str = "rins-terms";

/// The crate that reads and writes files, some of whose own keys are also names of settings: `time`, `axes`.
const FILES: &str = "rins-io";

/// Words that are a setting's name and have another meaning in a crate, with that meaning.
const OTHER_WORDS: &[(&str, &str, &str)] = &[
    ("rins", "axis", "a section of a scenario that is proposed"),
    ("rins", "duration", "a key of a scenario that is proposed"),
    ("rins", "time", "a word of the report: what a change goes along with"),
    ("rins-trials", "time", "a command of the program"),
];

/// The ids of the catalogue's terms and the names of their settings.
#[derive(Default)]
struct Names {
    terms: BTreeSet<String>,
    settings: BTreeSet<String>,
}

impl Names {
    /// Whether this is the id of a term or of one of its parameters.
    fn is_of_term(&self, word: &str) -> bool {
        let is_parameter = |id: &String| {
            let name = word.strip_prefix(id).and_then(|rest| rest.strip_prefix('.'));
            name.is_some_and(|name| !name.is_empty() && !name.contains(char::is_whitespace))
        };
        self.terms.contains(word) || self.terms.iter().any(is_parameter)
    }
}

/// Every literal in the sources of the crates at `root` that is a term's id or a setting's name, outside tests, in the crates
/// that use the catalogue.
pub(super) fn findings(root: &Path) -> Result<Vec<Finding>> {
    let folders = crate_folders(root)?;
    let mut names = Names::default();
    for folder in folders.iter().filter(|folder| folder.ends_with(CATALOGUE)) {
        for file in sources(&folder.join("src"))?.values() {
            names.visit_file(file);
        }
    }
    let mut findings = Vec::new();
    for folder in folders {
        let manifest = Manifest::read(&folder.join("Cargo.toml"))?;
        let uses = |package: &str| {
            let mut own = manifest.dependencies.iter().filter(|dependency| !dependency.dev);
            own.any(|dependency| dependency.package == package)
        };
        if uses(CATALOGUE) {
            findings.extend(of_crate(root, &folder, &manifest.name, &names)?);
        }
    }
    Ok(findings)
}

fn of_crate(root: &Path, folder: &Path, name: &str, names: &Names) -> Result<Vec<Finding>> {
    let source = folder.join("src");
    let files = sources(&source)?;
    let module =
        |path: &Path| -> Result<Vec<String>> { Ok(module_of(path.strip_prefix(&source)?)) };
    let mut for_tests = Vec::new();
    for (path, file) in &files {
        for item in file.items.iter().filter(|item| is_for_tests(item)) {
            if let Item::Mod(child) = item {
                for_tests.push([module(path)?, vec![child.ident.to_string()]].concat());
            }
        }
    }
    let mut findings = Vec::new();
    for (path, file) in &files {
        let module = module(path)?;
        if for_tests.iter().any(|tests| module.starts_with(tests)) {
            continue;
        }
        let mut literals = Literals { name, names, found: Vec::new() };
        literals.visit_file(file);
        let shown = path.strip_prefix(root).unwrap_or(path);
        findings.extend(literals.found.into_iter().map(|(line, what)| Finding {
            path: shown.to_path_buf(),
            line,
            what,
        }));
    }
    Ok(findings)
}

/// The fields of a term or of a setting, if this expression constructs one.
fn defined(made: &ExprStruct) -> Option<&'static [&'static str]> {
    match made.path.segments.last()?.ident.to_string().as_str() {
        "Term" => Some(&["id", "also"]),
        "Setting" => Some(&["name"]),
        _ => None,
    }
}

fn is_one_of(member: &Member, fields: &[&str]) -> bool {
    matches!(member, Member::Named(name) if fields.iter().any(|field| name == field))
}

/// Collects the names of terms and settings from their definitions.
impl<'a> Visit<'a> for Names {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_for_tests(item) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_expr_struct(&mut self, made: &'a ExprStruct) {
        let fields = defined(made).unwrap_or_default();
        for field in made.fields.iter().filter(|field| is_one_of(&field.member, fields)) {
            let names = if fields.contains(&"id") { &mut self.terms } else { &mut self.settings };
            let mut words = Words(Vec::new());
            words.visit_expr(&field.expr);
            names.extend(words.0);
        }
        syn::visit::visit_expr_struct(self, made);
    }
}

/// The literals of an expression.
struct Words(Vec<String>);

impl<'a> Visit<'a> for Words {
    fn visit_lit_str(&mut self, literal: &'a LitStr) {
        self.0.push(literal.value());
    }
}

/// Collects the literals of a crate's file that are one of these names.
struct Literals<'n> {
    /// The name of the crate.
    name: &'n str,
    names: &'n Names,
    /// The lines, with the violation.
    found: Vec<(usize, String)>,
}

impl Literals<'_> {
    fn see(&mut self, literal: &LitStr) {
        let word = literal.value();
        let is_other = |(name, other, _): &(&str, &str, &str)| *name == self.name && *other == word;
        let what = if self.names.is_of_term(&word) {
            format!("`{word}` has a term's id: use its constant in `rins_terms::catalogue`")
        } else if self.names.settings.contains(&word)
            && self.name != FILES
            && !OTHER_WORDS.iter().any(is_other)
        {
            format!("`{word}` is a setting's name: use its `SettingKind`")
        } else {
            return;
        };
        self.found.push((literal.span().start().line, what));
    }

    /// The literals of a macro's input, except the keys of an object that is written: `{"table_sense": …}`.
    fn see_tokens(&mut self, tokens: TokenStream) {
        let mut tokens = tokens.into_iter().peekable();
        while let Some(token) = tokens.next() {
            match token {
                TokenTree::Group(group) => self.see_tokens(group.stream()),
                TokenTree::Literal(literal) => {
                    let is_key = matches!(tokens.peek(), Some(TokenTree::Punct(mark)) if mark.as_char() == ':');
                    if let (Lit::Str(literal), false) = (Lit::new(literal), is_key) {
                        self.see(&literal);
                    }
                }
                TokenTree::Ident(_) | TokenTree::Punct(_) => {}
            }
        }
    }
}

impl<'a> Visit<'a> for Literals<'_> {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_for_tests(item) {
            syn::visit::visit_item(self, item);
        }
    }

    /// Documentation may use any word.
    fn visit_attribute(&mut self, _: &'a syn::Attribute) {}

    fn visit_lit_str(&mut self, literal: &'a LitStr) {
        self.see(literal);
    }

    fn visit_macro(&mut self, called: &'a syn::Macro) {
        self.see_tokens(called.tokens.clone());
    }

    /// The definition of a term or a setting outside the catalogue may use the names of the catalogue.
    fn visit_expr_struct(&mut self, made: &'a ExprStruct) {
        let fields = defined(made).unwrap_or_default();
        let others = made.fields.iter().filter(|field| !is_one_of(&field.member, fields));
        others.for_each(|field| self.visit_expr(&field.expr));
        if let Some(rest) = &made.rest {
            self.visit_expr(rest);
        }
    }
}
