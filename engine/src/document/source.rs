//! Text of a scene: places of its paths, and diagnostics with their line of the text.
//!
//! Diagnostics are rendered here and not by `annotate-snippets` 0.12 or `codespan-reporting` 0.13. Both were tried on
//! thirteen diagnostics: long lines, wide characters, tabs, control characters, spans over several lines, at and
//! beyond the end of the text and inside of a character. `annotate-snippets` panics on the last two; both have no
//! room for the path in the document beside the place; `codespan-reporting` shows lines of any length whole and sends
//! control characters to the terminal. `annotate-snippets` is better in one thing: its carets count the columns of
//! wide characters, those here count characters.

use std::fmt::Write as _;

use super::diagnostic::{Diagnostic, Place, Severity};
use super::legible::{NAME, legible, shortened};
use super::ron_text::{Node, Span, Value};

/// A scene's text and that of the files that it includes, one behind the other; its tree, and where
/// lines start.
#[derive(Clone, Debug)]
pub struct Source {
    files: Vec<SourceFile>,
    text: String,
    lines: Vec<usize>,
    tree: Option<Node>,
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

    pub(super) fn with_tree(self, tree: Node) -> Self {
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

    /// The node at a path of the document, or at its nearest ancestor that exists.
    pub(super) fn node(&self, path: &str) -> Option<&Node> {
        let mut node = self.tree.as_ref()?;
        let mut rest = path;
        while let Some((child, after)) = self.step(node.inner(), rest) {
            (node, rest) = (child, after);
        }
        Some(node)
    }

    /// Bytes where a path of the document stands, or its nearest ancestor that exists.
    #[must_use]
    pub fn locate(&self, path: &str) -> Option<Span> {
        let mut node = self.tree.as_ref()?;
        let mut rest = path;
        while !rest.is_empty() {
            // `Fraction([..])` is passed through on the way to `[0]`, yet all of it is `sky`.
            match self.step(node.inner(), rest) {
                Some((child, after)) => (node, rest) = (child, after),
                None => return Some(node.opening()),
            }
        }
        Some(node.head(&self.text))
    }

    /// Bytes of the key of a map at the end of a path.
    fn locate_key(&self, path: &str) -> Option<Span> {
        let mut node = self.tree.as_ref()?;
        let mut rest = path;
        loop {
            let inner = node.inner();
            let key = match &inner.value {
                Value::Map(entries) => entries
                    .iter()
                    .find(|(key, _)| self.after_name(key, rest).is_some_and(str::is_empty))
                    .map(|(key, _)| key.span),
                _ => None,
            };
            if key.is_some() {
                return key;
            }
            (node, rest) = self.step(inner, rest)?;
        }
    }

    /// Place that a diagnostic is about.
    pub(super) fn place_of_path(&self, diagnostic: &Diagnostic) -> Option<Place> {
        let Diagnostic { path, is_of_key, .. } = diagnostic;
        if path.is_empty() {
            return None;
        }
        let key = if *is_of_key { self.locate_key(path) } else { None };
        key.map(|span| self.place_of(span)).or_else(|| self.place(path))
    }

    /// Place of a path of the document, or of its nearest ancestor that exists.
    #[must_use]
    pub fn place(&self, path: &str) -> Option<Place> {
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
        let at = if path.is_empty() {
            String::new()
        } else {
            format!(" ({})", shortened(&legible(path), NAME))
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

    /// The child that a path starts with, and the rest of the path. Keys may hold dots: of the keys
    /// that fit, the longest is meant.
    fn step<'a, 'p>(&self, node: &'a Node, path: &'p str) -> Option<(&'a Node, &'p str)> {
        if let Some((index, after)) = path.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            let (Value::List(items) | Value::Tuple(items)) = &node.value else { return None };
            let child = items.get(index.parse::<usize>().ok()?)?;
            return Some((child, after.strip_prefix('.').unwrap_or(after)));
        }
        match &node.value {
            Value::Record(fields) => fields
                .iter()
                .filter_map(|field| Some((&field.value, after_key(path, &field.name)?)))
                .min_by_key(|(_, after)| after.len()),
            Value::Map(entries) => entries
                .iter()
                .filter_map(|(key, value)| Some((value, self.after_name(key, path)?)))
                .min_by_key(|(_, after)| after.len()),
            _ => None,
        }
    }

    /// The rest of a path behind the key of a map: as it is written, or with the namespace of its file.
    fn after_name<'p>(&self, key: &Node, path: &'p str) -> Option<&'p str> {
        let Value::Text(name) = &key.value else { return None };
        after_key(path, name).or_else(|| {
            let rest = path.strip_prefix(self.namespace(key.span))?;
            after_key(rest, name)
        })
    }
}

fn write_line(out: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _infallible = out.write_fmt(line);
    out.push('\n');
}

/// The rest of a path behind a key that it starts with.
fn after_key<'p>(path: &'p str, key: &str) -> Option<&'p str> {
    let after = path.strip_prefix(key)?;
    match after.as_bytes().first() {
        None | Some(b'[') => Some(after),
        Some(b'.') => Some(&after[1..]),
        Some(_) => None,
    }
}
