//! Checks that the files of a crate have no cyclic imports.
//!
//! A file uses another if a path leads to an item that the other defines, by `crate`, `self` or `super`. A re-exported item
//! belongs to the file of its definition, and items for tests only do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::Visit;
use syn::{Attribute, Item, ItemMod, ItemUse, UseTree, Visibility};

use super::Finding;
use super::sources::sources;
use crate::Result;
use crate::manifest::crate_folders;

/// The path of a module in its crate, such as `["inspection", "lag"]`.
type Module = Vec<String>;

/// The imports and exports of a module's file.
#[derive(Default)]
struct File {
    path: PathBuf,
    /// The items that it re-exports, by their name here, with their origin.
    exports: BTreeMap<String, Vec<String>>,
    /// The paths from the crate's root that it uses, with their lines.
    uses: Vec<(Vec<String>, usize)>,
}

/// All cycles in the sources of the crates at `root`, except those of `exempt` crates, which must have one.
pub(super) fn findings(root: &Path, exempt: &[&str]) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for folder in crate_folders(root)? {
        let shown = folder.strip_prefix(root).unwrap_or(&folder);
        let files = files(&folder.join("src"))?;
        let circles = circles(&files);
        match exempt.iter().find(|name| shown.ends_with(name)) {
            None => findings.extend(circles.iter().map(|circle| finding(root, &files, circle))),
            Some(name) if circles.is_empty() => findings.push(Finding {
                path: shown.join("Cargo.toml"),
                line: 1,
                what: format!("{name} has no more circles: take it out of IN_CIRCLES"),
            }),
            Some(_) => {}
        }
    }
    Ok(findings)
}

fn finding(root: &Path, files: &BTreeMap<Module, File>, circle: &[Module]) -> Finding {
    let mut imports: Vec<String> = Vec::new();
    let mut first = None;
    for module in circle {
        let mut told = BTreeSet::new();
        for (path, line) in &files[module].uses {
            let used =
                resolved(files, path).filter(|used| *used != module && circle.contains(used));
            if let Some(used) = used.filter(|used| told.insert(*used)) {
                first.get_or_insert((module, *line));
                imports.push(format!("{} in {}:{line}", named(used), named(module)));
            }
        }
    }
    let (module, line) = first.unwrap_or((&circle[0], 1));
    let path = &files[module].path;
    Finding {
        path: path.strip_prefix(root).unwrap_or(path).to_path_buf(),
        line,
        what: format!("these files import each other in a circle: {}", imports.join(", ")),
    }
}

fn named(module: &[String]) -> String {
    if module.is_empty() { "the crate's root".to_owned() } else { module.join("::") }
}

/// The files of a crate, by module; empty if it has no sources.
fn files(source: &Path) -> Result<BTreeMap<Module, File>> {
    let mut files = BTreeMap::new();
    if !source.is_dir() {
        return Ok(files);
    }
    for (path, parsed) in sources(source)? {
        let module = module_of(path.strip_prefix(source)?);
        let children = parsed.items.iter().filter_map(|item| match item {
            Item::Mod(child) if !is_for_tests(item) => Some(child.ident.to_string()),
            _ => None,
        });
        let mut reader = Reader {
            children: children.collect(),
            module: module.clone(),
            file: File { path, ..File::default() },
        };
        reader.visit_file(&parsed);
        files.insert(module, reader.file);
    }
    Ok(files)
}

pub(super) fn module_of(path: &Path) -> Module {
    let mut module: Module =
        path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        module.pop();
    }
    module
}

/// Collects the imports and exports of a file.
struct Reader {
    /// The modules that it declares.
    children: BTreeSet<String>,
    module: Module,
    file: File,
}

impl Reader {
    /// A path from the crate's root; `None` if it leads out of the crate or is relative to something unknown.
    fn of_crate(&self, path: &[String]) -> Option<Vec<String>> {
        let mut from = match path.first()?.as_str() {
            "crate" => Vec::new(),
            "self" => self.module.clone(),
            "super" => self.module.split_last()?.1.to_vec(),
            child if self.children.contains(child) => {
                return Some([&self.module[..], path].concat());
            }
            _ => return None,
        };
        let mut rest = &path[1..];
        while let Some(("super", after)) =
            rest.split_first().map(|(first, rest)| (first.as_str(), rest))
        {
            from.pop()?;
            rest = after;
        }
        from.extend_from_slice(rest);
        Some(from)
    }

    fn used(&mut self, path: &[String], line: usize) {
        if let Some(path) = self.of_crate(path) {
            self.file.uses.push((path, line));
        }
    }

    /// All names in a tree of imports, with their path and their local name.
    fn leaves(tree: &UseTree, before: &[String], leaves: &mut Vec<(Vec<String>, String)>) {
        let and = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        match tree {
            UseTree::Path(path) => Self::leaves(&path.tree, &and(&path.ident), leaves),
            UseTree::Name(name) if name.ident == "self" => {
                leaves.push((before.to_vec(), before.last().cloned().unwrap_or_default()));
            }
            UseTree::Name(name) => leaves.push((and(&name.ident), name.ident.to_string())),
            UseTree::Rename(name) => leaves.push((and(&name.ident), name.rename.to_string())),
            UseTree::Glob(_) => leaves.push((before.to_vec(), "*".to_owned())),
            UseTree::Group(group) => {
                group.items.iter().for_each(|tree| Self::leaves(tree, before, leaves));
            }
        }
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_for_tests(item) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, inner: &'a ItemMod) {
        // A module inside the file has its own path.
        self.module.push(inner.ident.to_string());
        syn::visit::visit_item_mod(self, inner);
        self.module.pop();
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        let mut leaves = Vec::new();
        Self::leaves(&item.tree, &[], &mut leaves);
        let line = item.use_token.span.start().line;
        for (path, name) in leaves {
            if matches!(item.vis, Visibility::Inherited) {
                self.used(&path, line);
                continue;
            }
            // `pub use lag::TableLag` refers to a child of the module.
            let here = || [&self.module[..], &path[..]].concat();
            let from = self.of_crate(&path).unwrap_or_else(here);
            self.file.exports.insert(name, from);
        }
    }

    /// `pub(super)` imports nothing.
    fn visit_vis_restricted(&mut self, _: &'a syn::VisRestricted) {}

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|part| part.ident.to_string()).collect();
        if let Some(first) = path.segments.first() {
            self.used(&names, first.ident.span().start().line);
        }
        syn::visit::visit_path(self, path);
    }
}

pub(super) fn is_for_tests(item: &Item) -> bool {
    let attributes: &[Attribute] = match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => &[],
    };
    let is_test = |meta: &syn::MetaList| {
        meta.tokens.to_string().split_whitespace().any(|word| word == "test")
    };
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.meta.require_list().is_ok_and(is_test)
    })
}

/// The module whose file defines the item at this path.
fn resolved<'f>(files: &'f BTreeMap<Module, File>, path: &[String]) -> Option<&'f Module> {
    /// The maximum number of nested re-exports.
    const MOST: usize = 8;
    let mut path = path.to_vec();
    for _ in 0..MOST {
        let (module, file, rest) = (0..=path.len()).rev().find_map(|length| {
            let (module, file) = files.get_key_value(&path[..length])?;
            Some((module, file, &path[length..]))
        })?;
        let Some(name) = rest.first() else { return Some(module) };
        if let Some(from) = file.exports.get(name) {
            path = [&from[..], &rest[1..]].concat();
        } else {
            return Some(module);
        }
    }
    None
}

/// The sets of files that use each other, each in order.
fn circles(files: &BTreeMap<Module, File>) -> Vec<Vec<Module>> {
    let uses = |module: &Module| -> BTreeSet<Module> {
        let used = files[module].uses.iter().filter_map(|(path, _)| resolved(files, path));
        used.filter(|used| *used != module).cloned().collect()
    };
    let graph: BTreeMap<&Module, BTreeSet<Module>> =
        files.keys().map(|module| (module, uses(module))).collect();
    let reached = |from: &Module| {
        let (mut reached, mut left) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(module) = left.pop() {
            for next in &graph[&module] {
                if reached.insert(next.clone()) {
                    left.push(next.clone());
                }
            }
        }
        reached
    };
    let all: BTreeMap<&Module, BTreeSet<Module>> =
        files.keys().map(|module| (module, reached(module))).collect();
    let mut circles: BTreeSet<Vec<Module>> = BTreeSet::new();
    for (module, reached) in &all {
        let circle: Vec<Module> =
            reached.iter().filter(|other| all[other].contains(*module)).cloned().collect();
        if circle.len() > 1 {
            circles.insert(circle);
        }
    }
    circles.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cycles of a crate with these files, by their modules.
    fn circles_of(sources: &[(&str, &str)]) -> Vec<Vec<String>> {
        let folder = tempfile::tempdir().unwrap();
        for (path, text) in sources {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let files = files(folder.path()).unwrap();
        let circles = circles(&files).into_iter();
        circles.map(|circle| circle.iter().map(|module| named(module)).collect()).collect()
    }

    #[test]
    fn files_that_use_each_other_are_a_circle() {
        let sources = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "pub struct B; fn b() -> super::c::C { crate::c::C }"),
            ("c.rs", "pub struct C(crate::a::A);"),
        ];
        assert_eq!(circles_of(&sources), [["a", "b", "c"]]);
        assert_eq!(circles_of(&sources[..3]), Vec::<Vec<String>>::new());
    }

    #[test]
    fn what_is_exported_again_is_where_it_is_defined() {
        let child = ("a/b.rs", "use super::c::C; pub struct B(C);");
        let sibling = ("a/c.rs", "pub struct C;");
        let parent = ("a/mod.rs", "mod b; mod c; pub use b::B; pub use c::C; fn a(_: B) {}");
        let root = ("lib.rs", "mod a; pub use a::{B, C};");
        let of_root = ("d.rs", "use crate::{B, C};");
        let none = Vec::<Vec<String>>::new();
        assert_eq!(circles_of(&[root, parent, child, sibling, of_root]), none);
        // An item that the parent itself defines is a real use.
        let own = ("a/mod.rs", "mod b; pub struct A; fn a(_: b::B) {}");
        let uses = ("a/b.rs", "use super::A; pub struct B(A);");
        assert_eq!(circles_of(&[root, own, uses]), [["a", "a::b"]]);
    }

    #[test]
    fn tests_and_visibilities_import_nothing() {
        let sources = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b::B; pub(super) struct A(pub(crate) B);"),
            ("b.rs", "pub(super) struct B; #[cfg(test)] mod tests { use crate::a::A; }"),
        ];
        assert_eq!(circles_of(&sources), Vec::<Vec<String>>::new());
    }
}
