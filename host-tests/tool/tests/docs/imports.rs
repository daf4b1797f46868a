//! The import graph of every crate: no circle between files, and none between the folders that are its layers.
//!
//! `cargo test -p palpate-tool --test docs imports -- --nocapture` prints the layers. An arrow goes from a file to the
//! file that defines what it names, through any re-exports; tests are left out, and so is what a file only passes on.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::Visit;
use syn::{Attribute, Item, UseTree, Visibility};

/// A module's path from the root of its crate.
type Module = Vec<String>;

/// A file: what it names, and what it passes on.
#[derive(Default)]
struct File {
    /// Paths in it, as they stand.
    named: Vec<Vec<String>>,
    /// Names that others may find here, and the paths they stand for; `*` for all of a path.
    imports: Vec<(String, Vec<String>)>,
}

struct Crate {
    files: BTreeMap<Module, File>,
}

type Arrows = BTreeMap<Module, BTreeSet<Module>>;

impl Crate {
    fn read(source: &Path) -> Self {
        let mut files = BTreeMap::new();
        add_folder(source, &mut Vec::new(), &mut files);
        Self { files }
    }

    /// The module that defines what a path in `from` leads to.
    fn home(&self, from: &Module, path: &[String], depth: usize) -> Option<Module> {
        let (mut module, mut rest) = (from.clone(), path);
        match path.first()?.as_str() {
            "crate" => module.clear(),
            "self" => {}
            "super" => drop(module.pop()?),
            // A path of this edition begins with a module declared here, or leads to another crate.
            child if path.len() > 1 && self.files.contains_key(&joined(from, child)) => {
                return self.walk(from.clone(), rest, depth);
            }
            _ => return None,
        }
        rest = &rest[1..];
        while rest.first().is_some_and(|name| name == "super") {
            module.pop()?;
            rest = &rest[1..];
        }
        self.walk(module, rest, depth)
    }

    fn walk(&self, mut module: Module, path: &[String], depth: usize) -> Option<Module> {
        for name in path {
            let child = joined(&module, name);
            if self.files.contains_key(&child) {
                module = child;
                continue;
            }
            // What is imported there is defined elsewhere.
            let file = self.files.get(&module)?;
            let import = file.imports.iter().find(|(known, _)| known == name).map(|(_, target)| target.clone());
            return match import {
                Some(target) if depth < 16 => self.home(&module, &target, depth + 1),
                _ => Some(module),
            };
        }
        Some(module)
    }

    fn arrows(&self) -> Arrows {
        let arrows = |(module, file): (&Module, &File)| {
            let homes = file.named.iter().filter_map(|path| self.home(module, path, 0));
            (module.clone(), homes.filter(|home| home != module).collect())
        };
        self.files.iter().map(arrows).collect()
    }
}

fn joined(module: &[String], child: &str) -> Module {
    module.iter().cloned().chain([child.to_owned()]).collect()
}

/// Reads a folder of modules: `x.rs`, `x/mod.rs`, and in the crate's own folder `lib.rs` or `main.rs`.
fn add_folder(folder: &Path, module: &mut Module, files: &mut BTreeMap<Module, File>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = entry.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if entry.is_dir() {
            module.push(name);
            add_folder(&entry, module, files);
            module.pop();
        } else if entry.extension().is_some_and(|extension| extension == "rs") && name != "main" {
            let path = if name == "mod" || name == "lib" { module.clone() } else { joined(module, &name) };
            let text = fs::read_to_string(&entry).expect("a file");
            let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", entry.display()));
            let mut file = File::default();
            file.visit_file(&parsed);
            files.insert(path, file);
        }
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}

impl<'ast> Visit<'ast> for File {
    fn visit_item(&mut self, item: &'ast Item) {
        match item {
            Item::Mod(of) if is_test(&of.attrs) => {}
            Item::Fn(of) if is_test(&of.attrs) => {}
            Item::Impl(of) if is_test(&of.attrs) => {}
            Item::Use(of) if is_test(&of.attrs) => {}
            Item::Use(of) => {
                let passes_on = !matches!(of.vis, Visibility::Inherited);
                self.add_use(&of.tree, &mut Vec::new(), passes_on);
            }
            _ => syn::visit::visit_item(self, item),
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.named.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        syn::visit::visit_path(self, path);
    }

    // `pub(super)` names no import.
    fn visit_vis_restricted(&mut self, _: &'ast syn::VisRestricted) {}

    fn visit_macro(&mut self, of: &'ast syn::Macro) {
        self.add_tokens(of.tokens.clone());
    }
}

impl File {
    fn add_use(&mut self, tree: &UseTree, path: &mut Vec<String>, passes_on: bool) {
        let mut add = |name: String, path: Vec<String>| {
            if !passes_on {
                self.named.push(path.clone());
            }
            self.imports.push((name, path));
        };
        match tree {
            UseTree::Path(of) => {
                path.push(of.ident.to_string());
                self.add_use(&of.tree, path, passes_on);
                path.pop();
            }
            UseTree::Name(of) if of.ident == "self" => add(path.last().cloned().unwrap_or_default(), path.clone()),
            UseTree::Name(of) => add(of.ident.to_string(), joined(path, &of.ident.to_string())),
            UseTree::Rename(of) => add(of.rename.to_string(), joined(path, &of.ident.to_string())),
            UseTree::Glob(_) => add("*".to_owned(), path.clone()),
            UseTree::Group(of) => {
                for tree in &of.items {
                    self.add_use(tree, path, passes_on);
                }
            }
        }
    }

    /// Paths among the tokens of a macro's call.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        for token in tokens {
            match token {
                TokenTree::Ident(name) => path.push(name.to_string()),
                TokenTree::Punct(of) if of.as_char() == ':' => {}
                other => {
                    self.named.push(std::mem::take(&mut path));
                    if let TokenTree::Group(group) = other {
                        self.add_tokens(group.stream());
                    }
                }
            }
        }
        self.named.push(path);
    }
}

/// Sets of nodes that lead to each other, by what each can reach.
fn circles<T: Ord + Clone>(arrows: &BTreeMap<T, BTreeSet<T>>) -> Vec<Vec<T>> {
    let reach = |from: &T| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(node) = next.pop() {
            for to in arrows.get(&node).into_iter().flatten() {
                if seen.insert(to.clone()) {
                    next.push(to.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<_, _> = arrows.keys().map(|node| (node.clone(), reach(node))).collect();
    let mut found: Vec<Vec<T>> = Vec::new();
    for (node, own) in &reached {
        if own.contains(node) && !found.iter().flatten().any(|other| other == node) {
            found.push(own.iter().filter(|to| reached.get(to).is_some_and(|of| of.contains(node))).cloned().collect());
        }
    }
    found
}

/// The arrows between the folders and files that lie in one module: its layers.
fn layers(arrows: &Arrows, parent: &[String]) -> BTreeMap<String, BTreeSet<String>> {
    let part = |module: &Module| module.strip_prefix(parent).and_then(|rest| rest.first().cloned());
    let mut layers: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (from, homes) in arrows {
        let Some(from) = part(from) else { continue };
        let to = homes.iter().filter_map(part).filter(|to| *to != from);
        layers.entry(from.clone()).or_default().extend(to);
    }
    layers
}

/// What is wrong with a crate.
fn findings(name: &str, source: &Path) -> Vec<String> {
    let arrows = Crate::read(source).arrows();
    let mut bad: Vec<String> = circles(&arrows)
        .into_iter()
        .map(|circle| {
            format!(
                "{name}: files in a circle: {}",
                circle.iter().map(|of| of.join("::")).collect::<Vec<_>>().join(", ")
            )
        })
        .collect();
    let parents: BTreeSet<Module> =
        arrows.keys().filter(|of| !of.is_empty()).map(|of| of[..of.len() - 1].to_vec()).collect();
    for parent in parents {
        let layers = layers(&arrows, &parent);
        if parent.is_empty() {
            println!("{name}:");
            layers
                .iter()
                .for_each(|(from, to)| println!("  {from:<16} {}", to.iter().cloned().collect::<Vec<_>>().join(" ")));
        }
        for circle in circles(&layers) {
            bad.push(format!("{name}::{}: layers in a circle: {}", parent.join("::"), circle.join(", ")));
        }
    }
    bad
}

#[test]
fn no_file_and_no_layer_imports_what_imports_it() {
    let root = palpate_tool::repository::root().expect("tests run in it");
    let crates = [
        ("palpate", "src"),
        ("palpate-bake", "host-tests/bake/src"),
        ("palpate-truth", "host-tests/truth/src"),
        ("palpate-sim", "host-tests/sim/src"),
        ("palpate-tool", "host-tests/tool/src"),
    ];
    let bad: Vec<String> = crates.into_iter().flat_map(|(name, source)| findings(name, &root.join(source))).collect();
    assert_eq!(bad, [""; 0], "{}", bad.join("\n"));
}

#[test]
fn a_circle_is_found_through_a_re_export_and_in_a_macro() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |file: &str, text: &str| fs::write(folder.path().join(file), text).expect("a file");
    fs::create_dir(folder.path().join("high")).expect("a folder");
    write("lib.rs", "mod low; mod high; pub use high::One;");
    write("low.rs", "pub struct Two; #[cfg(test)] mod tests { use crate::high::One; }");
    write("high/mod.rs", "mod one; mod three; pub use one::One; pub use three::Three;");
    write("high/one.rs", "use crate::low::Two; pub struct One(Two);");
    write("high/three.rs", "pub struct Three;");
    assert_eq!(findings("clean", folder.path()), [""; 0]);
    write("low.rs", "pub struct Two; fn f() { println!(\"{}\", size_of::<crate::One>()); }");
    let bad = findings("spoilt", folder.path());
    assert_eq!(bad, ["spoilt: files in a circle: high::one, low", "spoilt::: layers in a circle: high, low"]);
    // Not between files, but between layers.
    write("low.rs", "use crate::high::Three; pub struct Two(Three);");
    assert_eq!(findings("spoilt", folder.path()), ["spoilt::: layers in a circle: high, low"]);
}
