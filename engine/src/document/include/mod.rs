//! Included files: their definitions become part of the scene's tree, under names of their own.
//!
//! Each map of an included file (`materials`, `meshes`, `params`, ..) joins the scene's, its keys
//! behind the name of the include; its instances stand behind the scene's own; any other key counts
//! where no file closer to the scene has it. What stands closer to the scene always goes first.

mod names;
mod pass;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::decode::{Decode as _, Reader};
use super::diagnostic::Diagnostic;
use super::params::plain_number;
use super::path::ScenePath;
use super::read::{FILE_SIZE, ReadError, text_of_file};
use super::ron_text::{Field, Node, Span, Value, parse};
use super::scene::{Include, Map, Scene};
use super::schema::ReadKeys as _;
use super::source::Source;
use pass::{Passed, simplify};

/// Files may include others so deep.
const DEPTH: usize = 32;

/// A scene may include so many files.
const FILES: usize = 1000;

/// Result of including files.
#[derive(Clone, Debug)]
pub(super) struct Included {
    pub(super) diagnostics: Vec<Diagnostic>,
    /// Namespaces of files that could not be read.
    pub(super) lost: Vec<String>,
}

/// Takes the files that `tree` includes into it and into `source`; paths are relative to the folder
/// of the scene file.
pub(super) fn include(tree: &mut Node, source: &mut Source) -> Included {
    let file = PathBuf::from(source.name());
    let chain = vec![Link { real: real_path(&file), shown: file.display().to_string() }];
    let mut including = Including {
        source,
        chain,
        files: 0,
        single: Vec::new(),
        included: Included { diagnostics: Vec::new(), lost: Vec::new() },
    };
    let Some((includes, repeated)) = take_includes(tree) else { return including.included };
    including.refuse_repeated(&repeated);
    let mut own = fields(tree).map(std::mem::take).unwrap_or_default();
    including.single = own.iter().map(|field| (field.name.clone(), String::new())).collect();
    including.entries(&includes, "", &mut own);
    if let Some(fields) = fields(tree) {
        *fields = own;
    }
    including.included
}

/// A file that is being included.
struct Link {
    real: PathBuf,
    shown: String,
}

struct Including<'a> {
    source: &'a mut Source,
    /// Chain of files from the scene file to the current one.
    chain: Vec<Link>,
    files: usize,
    /// Keys of the scene, and the namespace that each was taken from.
    single: Vec<(String, String)>,
    included: Included,
}

impl Including<'_> {
    fn refuse_repeated(&mut self, repeated: &[Span]) {
        for &span in repeated {
            let help = "name all files in one `include: {..}`".to_owned();
            self.error(span, "include", "the key `include` is given twice".to_owned(), help);
        }
    }

    /// The files that an `include` names, into the scene's keys.
    fn entries(&mut self, includes: &Node, namespace: &str, scene: &mut Vec<Field>) {
        let mut plain = includes.clone();
        let written = simplify(&mut plain);
        let mut reader = Reader::new(self.source);
        let map = reader.within("include".into(), |r| Map::<Include>::decode(&plain, r));
        let findings = reader.finish();
        let broken = findings.broken;
        self.included.diagnostics.extend(findings.diagnostics);
        for (name, node, passed) in written {
            let at = ScenePath::from("include").name(&name);
            let full = format!("{namespace}{name}.");
            if let Value::Formula(formula) = &node.value {
                let message = format!("`={formula}` cannot name an included file");
                let help = "files are included before parameters have values: write the name of the file, \
                            and pass parameters to it by `params: { .. }` or choose its `variant`";
                self.error(node.span, &at, message, help.to_owned());
                self.included.lost.push(full);
                continue;
            }
            let Some(include) = map
                .get(&name)
                .filter(|_| !broken.iter().any(|path| at.is_within(path) || path.is_within(&at)))
            else {
                self.included.lost.push(full);
                continue;
            };
            let lawful = name.chars().all(|c| c == '_' || c.is_alphanumeric());
            if !lawful || name.chars().next().is_none_or(char::is_numeric) {
                let message = format!("`{name}` cannot be the name of an included file");
                let help = "start with a letter, go on with letters, digits and `_`";
                self.error(node.span, &at, message, help.to_owned());
                self.included.lost.push(full);
            } else if self.include_file(include, passed, &node, &full, scene).is_none() {
                self.included.lost.push(full);
            }
        }
    }

    fn error(&mut self, span: Span, path: impl Into<ScenePath>, message: String, help: String) {
        let place = self.source.place_of(span);
        self.included.diagnostics.push(Diagnostic::error(path, message).help(help).at(place));
    }

    /// Includes a file, and those that it includes.
    fn include_file(
        &mut self,
        include: &Include,
        passed: Passed,
        entry: &Node,
        namespace: &str,
        scene: &mut Vec<Field>,
    ) -> Option<()> {
        let at = path_of(namespace);
        let folder = Path::new(&self.chain.last()?.shown).parent().unwrap_or(Path::new(""));
        let path = folder.join(&include.file);
        let link = Link { real: real_path(&path), shown: path.display().to_string() };
        self.check_chain(&link, entry, &at)?;
        let mut tree = self.parse_file(&path, &link, entry, namespace)?;
        let inner = take_includes(&mut tree).map(|(inner, repeated)| {
            self.refuse_repeated(&repeated);
            inner
        });
        names::qualify(&mut tree, namespace);
        self.pass(&mut tree, include, passed, entry, namespace)?;
        let fields = fields(&mut tree).map(std::mem::take)?;
        self.merge(fields, namespace, scene);
        if let Some(inner) = inner {
            self.chain.push(link);
            self.entries(&inner, namespace, scene);
            self.chain.pop();
        }
        Some(())
    }

    /// Refuses a file that includes itself, and files beyond the limits.
    fn check_chain(&mut self, link: &Link, entry: &Node, at: &ScenePath) -> Option<()> {
        if let Some(first) = self.chain.iter().position(|other| other.real == link.real) {
            let circle = self.chain[first..].iter().chain([link]);
            let circle: Vec<_> = circle.map(|link| link.shown.as_str()).collect();
            let message = format!("{} includes itself", link.shown);
            self.error(entry.span, at, message, format!("the circle: {}", circle.join(" -> ")));
            return None;
        }
        let depth = self.chain.len();
        self.files += 1;
        if depth > DEPTH || self.files > FILES {
            // One word of it is enough.
            if self.files <= FILES + 1 {
                let message = if depth > DEPTH {
                    format!("files include others more than {DEPTH} deep here")
                } else {
                    format!("more than {FILES} files are included")
                };
                self.error(entry.span, at, message, "include fewer files".to_owned());
            }
            return None;
        }
        Some(())
    }

    /// Reads and parses a file, whose text joins the source; reports an error if it holds no definitions.
    fn parse_file(
        &mut self,
        path: &Path,
        link: &Link,
        entry: &Node,
        namespace: &str,
    ) -> Option<Node> {
        let at = path_of(namespace);
        let read = text_of_file(path, true).and_then(|text| {
            let bytes = (self.source.text().len() + text.len()) as u64;
            let file = link.shown.clone();
            if bytes > FILE_SIZE {
                return Err(ReadError::TooLarge { file, bytes, limit: FILE_SIZE });
            }
            Ok(text)
        });
        let text = match read {
            Ok(text) => text,
            Err(error) => {
                let help = match &error {
                    ReadError::Io { .. } | ReadError::Missing { .. } => {
                        "paths are relative to the folder of the file that includes"
                    }
                    _ => "an included file looks like `Library(materials: { .. }, meshes: { .. })`",
                };
                self.error(entry.span, &at, error.to_string(), help.to_owned());
                return None;
            }
        };
        let folder = relative_folder(&self.chain[0].shown, path);
        let start = self.source.add(&link.shown, &text, (namespace, &folder));
        let mut tree = match parse(&text) {
            Ok(tree) => tree,
            Err(error) => {
                let span = error.span.shifted(start);
                let place = self.source.place_of(span);
                let diagnostic = Diagnostic::error(&at, error.message).at(place);
                self.included.diagnostics.push(Diagnostic { help: error.help, ..diagnostic });
                return None;
            }
        };
        tree.shift(start);
        if fields(&mut tree).is_none() {
            let message = format!("expected definitions, found {}", tree.describe());
            let help = "write, for example, `Library(materials: { .. }, meshes: { .. })`";
            self.error(tree.opening(), &at, message, help.to_owned());
            return None;
        }
        Some(tree)
    }

    /// Adds what a file defines and what no file closer to the scene does.
    fn merge(&mut self, fields: Vec<Field>, namespace: &str, scene: &mut Vec<Field>) {
        let known: HashSet<String> = scene.iter().map(|field| field.name.clone()).collect();
        for field in fields {
            let Field { name, name_span, value } = field;
            if name == "format" && plain_number(&value) != Some(1.0) {
                let message = "this version reads `format: 1`".to_owned();
                self.error(value.span, "format", message, "write `format: 1`".to_owned());
            }
            if matches!(name.as_str(), "format" | "title") {
                continue;
            }
            let own = scene.iter_mut().find(|field| field.name == name);
            match (own.map(|field| &mut field.value.value), value.value) {
                (Some(Value::Map(own)), Value::Map(more)) if known.contains(&name) => {
                    let taken: HashSet<String> = own
                        .iter()
                        .filter_map(|(key, _)| match &key.value {
                            Value::Text(name) => Some(name.clone()),
                            _ => None,
                        })
                        .collect();
                    own.extend(more.into_iter().filter(
                        |(key, _)| !matches!(&key.value, Value::Text(name) if taken.contains(name)),
                    ));
                }
                (Some(Value::List(own)), Value::List(more)) if name == "instances" => {
                    own.extend(more);
                }
                (Some(_), _) if known.contains(&name) => {
                    self.refuse_second(&name, name_span, namespace);
                }
                (_, kind) => {
                    self.single.push((name.clone(), namespace.to_owned()));
                    let value = Node { span: value.span, value: kind };
                    scene.push(Field { name, name_span, value });
                }
            }
        }
    }

    /// A key that the scene has once, from two files of which neither includes the other.
    fn refuse_second(&mut self, name: &str, span: Span, namespace: &str) {
        let Some((_, from)) = self.single.iter().find(|(single, _)| single == name) else { return };
        if let Some(&key) = Scene::KEYS.iter().find(|key| **key == name)
            && !namespace.starts_with(from.as_str())
        {
            let (a, b) = (from.trim_end_matches('.'), namespace.trim_end_matches('.'));
            let message = format!("both `{a}` and `{b}` say `{name}`");
            let help = format!("write the `{name}` that is meant into the file that includes them");
            self.error(span, key, message, help);
        }
    }
}

/// Path of the include that put a namespace before names.
fn path_of(namespace: &str) -> ScenePath {
    ScenePath::from("include").name(namespace.trim_end_matches('.'))
}

/// Keys of a file, with or without a word before the parentheses.
pub(super) fn fields(tree: &mut Node) -> Option<&mut Vec<Field>> {
    let is_file = |name: &str| matches!(name, "Scene" | "Library");
    let body = if matches!(&tree.value, Value::Named(named) if is_file(&named.name)) {
        let Value::Named(named) = &mut tree.value else { return None };
        named.body.as_mut()?
    } else {
        tree
    };
    if matches!(&body.value, Value::Tuple(items) if items.is_empty()) {
        body.value = Value::Record(Vec::new());
    }
    match &mut body.value {
        Value::Record(fields) => Some(fields),
        _ => None,
    }
}

/// Takes the value of the key `include` out of a tree, and the places of the same key where it is repeated.
fn take_includes(tree: &mut Node) -> Option<(Node, Vec<Span>)> {
    let fields = fields(tree)?;
    let mut taken = fields.extract_if(.., |field| field.name == "include");
    let includes = taken.next()?.value;
    Some((includes, taken.map(|field| field.name_span).collect()))
}

/// Identity of a file, whatever path names it.
fn real_path(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_not_there| path.to_owned())
}

/// The folder of an included file as the scene file would name it: empty, or with a `/` at its end.
fn relative_folder(scene: &str, file: &Path) -> String {
    let scene = Path::new(scene).parent().unwrap_or(Path::new(""));
    let folder = file.parent().unwrap_or(Path::new(""));
    let folder = folder.strip_prefix(scene).unwrap_or(folder);
    let parts: Vec<_> = folder.iter().map(|part| part.to_string_lossy()).collect();
    match parts.join("/").replace("//", "/") {
        folder if folder.is_empty() => folder,
        folder => folder + "/",
    }
}
