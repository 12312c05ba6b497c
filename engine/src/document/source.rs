//! Text of a scene: places of its paths, and diagnostics with their line of the text.
//!
//! Diagnostics are rendered here and not by `annotate-snippets` 0.12 or `codespan-reporting` 0.13. Both were tried on
//! thirteen diagnostics: long lines, wide characters, tabs, control characters, spans over several lines, at and
//! beyond the end of the text and inside of a character. `annotate-snippets` panics on the last two; both have no
//! room for the path in the document beside the place; `codespan-reporting` shows lines of any length whole and sends
//! control characters to the terminal. `annotate-snippets` is better in one thing: its carets count the columns of
//! wide characters, those here count characters.

use std::fmt::Write as _;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Place, Severity};
use super::legible::{NAME, legible, shortened};
use super::path::{ScenePath, Step};
use super::ron_text::{Node, Span, Value};

/// A scene's text and that of the files that it includes, one behind the other; its tree, and where
/// lines start.
#[derive(Clone, Debug)]
pub struct Source {
    files: Vec<SourceFile>,
    text: String,
    lines: Vec<usize>,
    tree: Option<Arc<Node>>,
}

/// A file of a scene.
#[derive(Clone, Debug)]
struct SourceFile {
    name: String,
    /// Prefix of its names in the scene: empty, or `birch.`.
    namespace: String,
    /// Prefix of its paths in the scene: empty, or `species/`.
    folder: String,
    /// First byte and first line in the text of all.
    start: usize,
    line: usize,
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        let mut source =
            Self { files: Vec::new(), text: String::new(), lines: Vec::new(), tree: None };
        source.add(name, text, ("", ""));
        source
    }

    /// Appends a file, with what its names and its paths start with; returns its first byte.
    pub(super) fn add(
        &mut self,
        name: &str,
        text: &str,
        (namespace, folder): (&str, &str),
    ) -> usize {
        if !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push('\n');
        }
        let start = self.text.len();
        self.files.push(SourceFile {
            name: name.to_owned(),
            namespace: namespace.to_owned(),
            folder: folder.to_owned(),
            start,
            line: self.lines.len(),
        });
        self.lines.push(start);
        self.lines.extend(text.match_indices('\n').map(|(at, _)| start + at + 1));
        self.text.push_str(text);
        start
    }

    fn file_at(&self, byte: usize) -> &SourceFile {
        // Files may be empty: of those that start there, the last holds the byte.
        &self.files[self.files.partition_point(|file| file.start <= byte).max(1) - 1]
    }

    /// Prefix of the names of a file: empty, or `birch.`.
    pub(super) fn namespace(&self, span: Span) -> &str {
        &self.file_at(span.start as usize).namespace
    }

    /// Prefix of the paths of a file: empty, or `species/`.
    pub(super) fn folder(&self, span: Span) -> &str {
        &self.file_at(span.start as usize).folder
    }

    pub(super) fn with_tree(self, tree: Arc<Node>) -> Self {
        Self { tree: Some(tree), ..self }
    }

    /// The scene file, as the reader was given it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.files[0].name
    }

    /// The text of all files, the scene's own first.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The node at a path of the document, or at its nearest ancestor that exists; true for the former.
    pub(super) fn nearest(&self, path: &ScenePath) -> Option<(&Node, bool)> {
        let mut node = self.tree.as_deref()?;
        for step in path.steps() {
            match self.step(node, step) {
                Some(child) => node = child,
                None => return Some((node, false)),
            }
        }
        Some((node, true))
    }

    /// Bytes where a path of the document stands, or its nearest ancestor that exists.
    #[must_use]
    pub fn locate(&self, path: &ScenePath) -> Option<Span> {
        let (node, is_exact) = self.nearest(path)?;
        Some(if is_exact { node.head(&self.text) } else { node.opening() })
    }

    /// Bytes of the key of a map at the end of a path.
    fn locate_key(&self, path: &ScenePath) -> Option<Span> {
        let (name, parents) = path.steps().split_last()?;
        let map =
            parents.iter().try_fold(self.tree.as_deref()?, |node, step| self.step(node, step))?;
        let Value::Map(entries) = &map.inner().value else { return None };
        entries.iter().map(|(key, _)| key).find(|key| self.is_named(key, name)).map(|key| key.span)
    }

    /// Place that a diagnostic is about.
    pub(super) fn place_of_path(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let Diagnostic { path, is_of_key, .. } = diagnostic;
        if path.is_root() {
            return None;
        }
        let key = if *is_of_key { self.locate_key(path) } else { None };
        key.map(|span| self.place_of(span)).or_else(|| self.place(path))
    }

    /// Place of a path of the document, or of its nearest ancestor that exists.
    #[must_use]
    pub fn place(&self, path: &ScenePath) -> Option<Place> {
        self.locate(path).map(|span| self.place_of(span))
    }

    pub(super) fn place_of(&self, span: Span) -> Place {
        let at = span.start as usize;
        let (line, start) = self.line_at(at);
        let file = self.file_at(at);
        let column = self.text.get(start..at).map_or(0, |before| before.chars().count()) + 1;
        Place { file: file.name.clone(), line: line - file.line, column, span }
    }

    /// Line of a byte, counted from 1 through all files, and that line's first byte.
    fn line_at(&self, at: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|&start| start <= at).max(1);
        (line, self.lines[line - 1])
    }

    /// Text of all diagnostics, each with its line of the file and a caret below it.
    #[must_use]
    pub fn render(&self, diagnostics: &[Diagnostic]) -> String {
        diagnostics.iter().map(|one| self.render_one(one)).collect::<Vec<_>>().join("\n")
    }

    fn render_one(&self, diagnostic: &Diagnostic) -> String {
        let severity = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        format!("{severity}: {}", self.describe(diagnostic))
    }

    /// Text of a diagnostic without the leading `error: `.
    pub(super) fn describe(&self, diagnostic: &Diagnostic) -> String {
        let Diagnostic { message, path, help, .. } = diagnostic;
        let mut out = format!("{}\n", legible(message));
        let at = if path.is_root() {
            String::new()
        } else {
            format!(" ({})", shortened(&legible(&path.to_string()), NAME))
        };
        let place = diagnostic.place.clone().or_else(|| self.place_of_path(diagnostic));
        let mut gutter = "     ".to_owned();
        match place {
            Some(Place { file, line, column, span }) => {
                let number = line.to_string();
                gutter = " ".repeat(number.len().max(2) + 3);
                write_line(&mut out, format_args!("  --> {file}:{line}:{column}{at}"));
                write_line(&mut out, format_args!("{gutter}|"));
                let (excerpt, marks) = self.excerpt(column, span);
                write_line(&mut out, format_args!("  {number:>2} | {excerpt}"));
                write_line(&mut out, format_args!("{gutter}| {marks}"));
            }
            None => write_line(&mut out, format_args!("  --> {}{at}", self.name())),
        }
        if let Some(advice) = help {
            write_line(&mut out, format_args!("{gutter}= help: {}", legible(advice)));
        }
        out
    }

    /// A line of the text, cut to a window where it is long, and the carets for the line below it.
    fn excerpt(&self, column: usize, span: Span) -> (String, String) {
        const BEFORE: usize = 60;
        const SHOWN: usize = 110;
        let (_, start) = self.line_at(span.start as usize);
        let text = self.text.get(start..).unwrap_or("");
        let text = text.lines().next().unwrap_or("");
        let skipped = (column - 1).saturating_sub(BEFORE);
        let shown: String = text
            .chars()
            .skip(skipped)
            .take(SHOWN)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let (lead, tail) = (
            if skipped > 0 { "…" } else { "" },
            if text.chars().nth(skipped + SHOWN).is_some() { "…" } else { "" },
        );
        let offset = column - 1 - skipped + lead.chars().count();
        let room = shown.chars().count().saturating_sub(column - 1 - skipped);
        let own = self.text.get(span.range()).unwrap_or("").lines().next().unwrap_or("");
        let width = own.chars().count().min(room).max(1);
        (format!("{lead}{shown}{tail}"), format!("{}{}", " ".repeat(offset), "^".repeat(width)))
    }

    /// The child of a node at a step.
    fn step<'a>(&self, node: &'a Node, step: &Step) -> Option<&'a Node> {
        match (&node.inner().value, step) {
            (Value::List(items) | Value::Tuple(items), Step::Index(index)) => items.get(*index),
            (Value::Record(fields), Step::Key(name)) => {
                fields.iter().find(|field| field.name == *name).map(|field| &field.value)
            }
            (Value::Map(entries), step) => {
                entries.iter().find(|(key, _)| self.is_named(key, step)).map(|(_, value)| value)
            }
            _ => None,
        }
    }

    /// Returns whether the key of a map is a name as it is written, or with the namespace of its file.
    fn is_named(&self, key: &Node, step: &Step) -> bool {
        let (Value::Text(key_name), Step::Name(name)) = (&key.value, step) else { return false };
        key_name == name || name.strip_prefix(self.namespace(key.span)) == Some(key_name)
    }
}

fn write_line(out: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _infallible = out.write_fmt(line);
    out.push('\n');
}
