//! The engine's source as syntax trees: what each file uses, and what it makes public.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{Item, UseTree, Visibility};

/// Path of a module or of something in it, below the crate.
pub(crate) type ModulePath = Vec<String>;

/// A file of the engine that is no test.
pub(crate) struct SourceFile {
    /// Its path below `src`.
    pub(crate) path: String,
    pub(crate) text: String,
    /// Its module.
    module: ModulePath,
    syntax: syn::File,
}

/// Path of a file or folder below the engine's folder.
pub(crate) fn engine(path: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../engine")).join(path)
}

/// All files of the engine but tests, in the order of their paths.
pub(crate) fn read_engine() -> Vec<SourceFile> {
    let root = engine("src");
    let (mut folders, mut files) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the folder exists") {
            let path = entry.expect("the entry is readable").path();
            if path.is_dir() && !path.ends_with("tests") {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs")
                && !path.ends_with("tests.rs")
            {
                let name = path.strip_prefix(&root).expect("it lies below the root");
                files.push(SourceFile::read(name.display().to_string(), &path));
            }
        }
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(files.len() > 200, "the engine has {} files", files.len());
    files
}

impl SourceFile {
    fn read(path: String, file: &Path) -> Self {
        let text = fs::read_to_string(file).expect("the file is text");
        let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut module: ModulePath =
            path.trim_end_matches(".rs").split('/').map(ToOwned::to_owned).collect();
        if matches!(module.last().map(String::as_str), Some("mod" | "lib")) {
            module.pop();
        }
        Self { path, text, module, syntax }
    }

    /// Paths that it names, below the crate, but for those that it re-exports.
    pub(crate) fn used(&self) -> BTreeSet<ModulePath> {
        let mut paths = Paths { reexports: false, ..Paths::default() };
        paths.visit_file(&self.syntax);
        paths.found.iter().filter_map(|path| self.absolute(path)).collect()
    }

    /// Names that it re-exports, and the paths behind them.
    pub(crate) fn reexports(&self) -> BTreeMap<String, ModulePath> {
        let mut paths = Paths { reexports: true, ..Paths::default() };
        paths.visit_file(&self.syntax);
        let absolute = paths.found.iter().filter_map(|path| self.absolute(path));
        absolute.filter_map(|path| Some((path.last()?.clone(), path))).collect()
    }

    /// Names of the types that other files may use.
    pub(crate) fn shared_types(&self) -> Vec<String> {
        self.syntax.items.iter().filter_map(shared_type).collect()
    }

    fn absolute(&self, path: &[String]) -> Option<ModulePath> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" => Some([&self.module, rest].concat()),
            "super" => {
                let ups = path.iter().take_while(|part| *part == "super").count();
                let above = self.module.len().checked_sub(ups)?;
                Some([&self.module[..above], &path[ups..]].concat())
            }
            _ => Some([&self.module, path].concat()),
        }
    }
}

/// Name of an item that is a type with a visibility of its own, declared in plain Rust or by `record!` or `choice!`.
fn shared_type(item: &Item) -> Option<String> {
    let (visibility, name) = match item {
        Item::Struct(item) => (&item.vis, item.ident.to_string()),
        Item::Enum(item) => (&item.vis, item.ident.to_string()),
        Item::Trait(item) => (&item.vis, item.ident.to_string()),
        Item::Type(item) => (&item.vis, item.ident.to_string()),
        // `macro_rules!` has a name, calls have none.
        Item::Macro(item) if item.ident.is_none() => {
            let tokens = item.mac.tokens.to_string();
            let words: Vec<&str> = tokens.split_whitespace().collect();
            let declaration = words
                .windows(3)
                .find(|three| three[0] == "pub" && ["struct", "enum"].contains(&three[1]))?;
            return Some(declaration[2].to_owned());
        }
        _ => return None,
    };
    (!matches!(visibility, Visibility::Inherited)).then_some(name)
}

/// Collects paths: of `use` declarations, re-exports or not, and paths that start with `crate` or `super`.
#[derive(Default)]
struct Paths {
    reexports: bool,
    found: Vec<ModulePath>,
}

impl Paths {
    fn add_tree(&mut self, tree: &UseTree, before: &[String]) {
        match tree {
            UseTree::Path(path) => {
                self.add_tree(&path.tree, &[before, &[path.ident.to_string()]].concat());
            }
            UseTree::Name(name) => self.found.push([before, &[name.ident.to_string()]].concat()),
            UseTree::Rename(name) => self.found.push([before, &[name.ident.to_string()]].concat()),
            UseTree::Glob(_) => self.found.push(before.to_vec()),
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.add_tree(tree, before);
                }
            }
        }
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item(&mut self, item: &'ast Item) {
        let is_test = match item {
            Item::Mod(module) => {
                module.attrs.iter().any(|attribute| attribute.path().is_ident("cfg"))
            }
            _ => false,
        };
        if !is_test {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if self.reexports != matches!(item.vis, Visibility::Inherited) {
            self.add_tree(&item.tree, &[]);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: ModulePath = path.segments.iter().map(|part| part.ident.to_string()).collect();
        if !self.reexports && parts.len() > 1 && ["crate", "super"].contains(&parts[0].as_str()) {
            self.found.push(parts);
        }
        visit::visit_path(self, path);
    }
}

/// Files by module, with their re-exports.
pub(crate) struct Modules<'f> {
    files: BTreeMap<&'f [String], &'f SourceFile>,
    reexports: BTreeMap<&'f [String], BTreeMap<String, ModulePath>>,
}

impl<'f> Modules<'f> {
    pub(crate) fn new(files: &'f [SourceFile]) -> Self {
        Self {
            files: files.iter().map(|file| (file.module.as_slice(), file)).collect(),
            reexports: files
                .iter()
                .map(|file| (file.module.as_slice(), file.reexports()))
                .collect(),
        }
    }

    /// File that declares what a path names, behind all re-exports; `None` outside the crate.
    pub(crate) fn declaring(&self, path: &[String]) -> Option<&'f SourceFile> {
        let mut path = path.to_vec();
        // A chain of re-exports is no longer than the folders are deep.
        for _ in 0..8 {
            let depth = (1..=path.len()).rev().find(|&n| self.files.contains_key(&path[..n]))?;
            let behind = path.get(depth).and_then(|name| self.reexports[&path[..depth]].get(name));
            match behind {
                Some(behind) if *behind != path => path = [behind, &path[depth + 1..]].concat(),
                _ => return Some(self.files[&path[..depth]]),
            }
        }
        panic!("{path:?} is re-exported in a circle");
    }
}
