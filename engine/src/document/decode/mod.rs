//! Tree to types: always a value, and every error on the way.

mod advice;
mod keys;
mod plain;

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

pub(super) use keys::{Fields, Variant};
pub(super) use plain::MapKey;

use super::describe::Book;
use super::diagnostic::{Diagnostic, Place};
use super::path::{ScenePath, Step};
use super::ron_text::{Node, Span, Value};
use super::scene::Param;
use super::source::Source;

/// No more errors than this are kept: nobody reads them.
const ERRORS: usize = 100;

/// Nor more paths without a value.
const BROKEN: usize = 1000;

/// A type that can be read from the tree.
pub(super) trait Decode: Sized {
    /// True if its values stand in parentheses of their own; those of a variant serve as well.
    const IS_TUPLE: bool = false;

    /// Name of such a value in messages: `a number`.
    fn expected() -> Cow<'static, str>;

    /// An example of a value.
    fn example() -> String;

    /// JSON schema of its values.
    fn schema(book: &mut Book) -> serde_json::Value;

    /// The value; where it cannot be read, the reader is told and the value is a placeholder.
    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self;

    /// A value that stands where none could be read.
    fn placeholder() -> Self;
}

/// State of the reader, and the faults found so far.
pub(super) struct Reader<'a> {
    source: &'a Source,
    path: ScenePath,
    diagnostics: Vec<Diagnostic>,
    dropped: usize,
    /// Values of formulas, by their first byte; none where there was no value.
    computed: HashMap<u32, Option<Param>>,
    /// Paths without a value, beside those of `diagnostics`.
    broken: Vec<ScenePath>,
    /// Namespaces of included files that could not be read.
    lost: Vec<String>,
    /// The scene, and the names of its parameters, for advice.
    tree: Option<&'a Node>,
    params: HashSet<String>,
    /// Example of the value of the key at this depth.
    example: Option<(usize, &'static str)>,
}

/// Faults of a tree.
pub(super) struct Findings {
    pub(super) diagnostics: Vec<Diagnostic>,
    /// Number of further errors.
    pub(super) dropped: usize,
    /// Paths without a value.
    pub(super) broken: Vec<ScenePath>,
    /// Namespaces of included files that could not be read.
    pub(super) lost: Vec<String>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            source,
            path: ScenePath::root(),
            diagnostics: Vec::new(),
            dropped: 0,
            computed: HashMap::new(),
            broken: Vec::new(),
            lost: Vec::new(),
            tree: None,
            params: HashSet::new(),
            example: None,
        }
    }

    /// Adds faults found before reading; `lost` are the namespaces of files that could not be read.
    pub(super) fn start_with(&mut self, diagnostics: Vec<Diagnostic>, lost: &[String]) {
        for one in diagnostics {
            self.push(one);
        }
        self.lost = lost.iter().take(BROKEN / 2).cloned().collect();
    }

    /// Returns whether some included file could not be read: missing names may stand there.
    fn has_lost_files(&self) -> bool {
        !self.lost.is_empty()
    }

    /// The faults.
    pub(super) fn finish(self) -> Findings {
        let Self { diagnostics, dropped, mut broken, lost, .. } = self;
        let errors = diagnostics.iter().filter(|one| one.is_error());
        broken.extend(errors.map(|error| error.path.clone()));
        Findings { diagnostics, dropped, broken, lost }
    }

    /// There is no value here, for a reason that has been reported elsewhere.
    pub(super) fn mark_broken(&mut self) {
        if self.broken.len() < BROKEN {
            self.broken.push(self.path.clone());
        }
    }

    pub(super) fn text(&self) -> &'a str {
        self.source.text()
    }

    /// Reads something one step down.
    pub(super) fn within<T>(&mut self, step: Step, read: impl FnOnce(&mut Self) -> T) -> T {
        self.path.push(step);
        let value = read(self);
        self.path.pop();
        value
    }

    /// Something wrong where reading has come to.
    pub(super) fn error(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        if self.has_room() {
            let error = Diagnostic::error(&self.path, message).at(self.place_of(span));
            self.diagnostics.push(Diagnostic { help, ..error });
        }
    }

    /// A value that is lawful and may not be meant, where reading has come to.
    pub(super) fn warn(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        if self.has_room() {
            let warning = Diagnostic::warning(&self.path, message).at(self.place_of(span));
            self.diagnostics.push(Diagnostic { help, ..warning });
        }
    }

    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        if self.has_room() {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Returns whether one more error can be kept; if not, it is counted.
    pub(super) fn has_room(&mut self) -> bool {
        let has_room = self.diagnostics.len() < ERRORS;
        self.dropped += usize::from(!has_room);
        has_room
    }

    /// Prefix of the names of a node's file: empty, or `birch.`.
    pub(super) fn namespace(&self, node: &Node) -> &'a str {
        self.source.namespace(node.span)
    }

    /// Prefix of the paths in a node's file: empty, or `species/`.
    pub(super) fn folder(&self, node: &Node) -> &'a str {
        self.source.folder(node.span)
    }

    pub(super) fn place_of(&self, span: Span) -> Place {
        self.source.place_of(span)
    }

    /// Notes the scene and the names of its parameters, for advice.
    pub(super) fn advise_from<'p>(
        &mut self,
        tree: &'a Node,
        params: impl Iterator<Item = &'p String>,
    ) {
        self.tree = Some(tree);
        self.params = params.cloned().collect();
    }

    /// Sets the value of a formula; none where it was wrong, which has been reported.
    pub(super) fn set_computed(&mut self, formula: &Node, value: Option<Param>) {
        self.computed.insert(formula.span.start, value);
    }

    pub(super) fn computed(&self, formula: &Node) -> Option<&Param> {
        self.computed.get(&formula.span.start)?.as_ref()
    }

    /// Reads a value that is written, for example, like this.
    fn by_example<T>(
        &mut self,
        example: Option<&'static str>,
        read: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.example = example.map(|example| (self.path.steps().len(), example));
        let value = read(self);
        self.example = None;
        value
    }

    /// A value of the wrong kind.
    pub(super) fn mismatch<T: Decode>(&mut self, node: &Node) -> T {
        let computed = self.computed.get(&node.span.start);
        let reported = matches!(node.value, Value::BadNumber(_)) || computed == Some(&None);
        if !reported {
            let found = match computed {
                Some(Some(Param::Number(value))) => format!("a formula that gives {value:?}"),
                Some(Some(Param::Text(text))) => format!("a parameter that is the text {text:?}"),
                _ => node.describe(),
            };
            let message = format!("expected {}, found {found}", T::expected());
            let example = match self.example {
                Some((depth, example)) if depth == self.path.steps().len() => example.to_owned(),
                _ => T::example(),
            };
            let help = self
                .advice(&T::expected(), node)
                .unwrap_or_else(|| format!("write, for example, `{example}`"));
            self.error(node.head(self.text()), message, Some(help));
        }
        T::placeholder()
    }

    fn number_error<T: Decode>(&mut self, node: &Node, message: String, help: Option<String>) -> T {
        self.error(node.span, message, help);
        T::placeholder()
    }
}
