//! Layout: values and comments to lines.

use std::fmt::Write as _;

use super::super::path::{ScenePath, Step};

/// Largest number of characters of a line, where a value can be broken.
const WIDTH: usize = 100;

/// Text before it is broken into lines.
#[derive(Debug)]
pub(in super::super) enum Text {
    Leaf(String),
    Group(Group),
}

/// Items between brackets.
#[derive(Debug, Default)]
pub(in super::super) struct Group {
    pub(in super::super) open: String,
    pub(in super::super) items: Vec<Item>,
    pub(in super::super) close: String,
    /// Comments behind the last item, a line each; empty for a blank line.
    pub(in super::super) tail: Vec<String>,
    /// True if it has one item per line even where it fits on one.
    pub(in super::super) is_broken: bool,
}

/// An item of a group.
#[derive(Debug)]
pub(in super::super) struct Item {
    /// Step of a path in the document to its value; none in lists.
    pub(in super::super) step: Option<Step>,
    /// Text before the value.
    pub(in super::super) key: String,
    pub(in super::super) text: Text,
    /// Comments above it, a line each; empty for a blank line.
    pub(in super::super) above: Vec<String>,
    /// Comment behind it.
    pub(in super::super) behind: String,
}

impl Item {
    pub(in super::super) fn new(step: Option<Step>, key: String, text: Text) -> Self {
        Self { step, key, text, above: Vec::new(), behind: String::new() }
    }

    fn has_comments(&self) -> bool {
        !self.above.is_empty() || !self.behind.is_empty()
    }
}

/// Remark at the end of the line of a path in the document.
pub(in super::super) type Remark<'a> = &'a dyn Fn(&ScenePath) -> Option<String>;

impl Text {
    /// `Name(key: value)`; a name alone where nothing else is to be said.
    pub(in super::super) fn record(name: &str, items: Vec<Item>) -> Self {
        if items.is_empty() && !name.is_empty() {
            return Self::Leaf(name.to_owned());
        }
        Self::group(format!("{name}("), items, ")")
    }

    pub(in super::super) fn group(open: String, items: Vec<Item>, close: &str) -> Self {
        Self::Group(Group { open, items, close: close.to_owned(), ..Group::default() })
    }

    /// `key: value`.
    pub(in super::super) fn item(name: &'static str, value: Self) -> Item {
        Item::new(Some(name.into()), format!("{name}: "), value)
    }

    /// `Name(value)`; of a tuple `Name(value, value)`.
    pub(in super::super) fn newtype(name: &str, value: Self) -> Self {
        match value {
            Self::Group(group)
                // `Some` holds one value, never several.
                if name != "Some"
                    // `Name(())` and `Name((1))` are not what `Name()` and `Name(1)` are.
                    && group.items.len() > 1
                    && group.open == "("
                    && group.items.iter().all(|item| item.key.is_empty()) =>
            {
                Self::Group(Group { open: format!("{name}("), ..group })
            }
            Self::Leaf(leaf) => Self::Leaf(format!("{name}({leaf})")),
            Self::Group(group) => {
                let (open, close) = (format!("{name}({}", group.open), format!("{})", group.close));
                Self::Group(Group { open, close, ..group })
            }
        }
    }

    /// Text of a file: the outermost group always has one item per line.
    pub(in super::super) fn into_file(self) -> String {
        self.into_file_with(&|_| None)
    }

    /// Text of a file with remarks at the ends of lines.
    pub(in super::super) fn into_file_with(self, remark: Remark<'_>) -> String {
        let mut writer = Writer { out: String::new(), path: ScenePath::root(), remark };
        writer.broken(&self, 0);
        writer.out.push('\n');
        writer.out
    }

    /// Text on one line.
    pub(in super::super) fn into_line(self) -> String {
        let mut writer = Writer { out: String::new(), path: ScenePath::root(), remark: &|_| None };
        writer.flat(&self);
        writer.out
    }

    /// Characters on one line, if at most `limit`, and if it may stand on one.
    fn width(&self, limit: usize) -> Option<usize> {
        let within = |width: usize| (width <= limit).then_some(width);
        match self {
            Self::Leaf(leaf) => within(leaf.chars().count()),
            Self::Group(group) => {
                let Group { open, items, close, tail, is_broken } = group;
                if *is_broken || !tail.is_empty() {
                    return None;
                }
                let mut width = open.chars().count() + close.chars().count();
                if open.ends_with('{') && !items.is_empty() {
                    width += 2;
                }
                for (index, item) in items.iter().enumerate() {
                    if item.has_comments() {
                        return None;
                    }
                    width += item.key.chars().count() + if index > 0 { 2 } else { 0 };
                    width += item.text.width(limit.checked_sub(width)?)?;
                }
                within(width)
            }
        }
    }
}

struct Writer<'a> {
    out: String,
    /// Path in the document of what is being written.
    path: ScenePath,
    remark: Remark<'a>,
}

impl Writer<'_> {
    fn text(&mut self, text: &Text, used: usize, indent: usize) {
        // One more for the comma that follows.
        if text.width(WIDTH.saturating_sub(used + 1)).is_some() {
            self.flat(text);
        } else {
            self.broken(text, indent);
        }
    }

    fn flat(&mut self, text: &Text) {
        match text {
            Text::Leaf(leaf) => self.out.push_str(leaf),
            Text::Group(Group { open, items, close, .. }) => {
                let pad = if open.ends_with('{') && !items.is_empty() { " " } else { "" };
                self.out.push_str(open);
                self.out.push_str(pad);
                for (index, item) in items.iter().enumerate() {
                    if index > 0 {
                        self.out.push_str(", ");
                    }
                    self.out.push_str(&item.key);
                    self.flat(&item.text);
                }
                self.out.push_str(pad);
                self.out.push_str(close);
            }
        }
    }

    fn broken(&mut self, text: &Text, indent: usize) {
        let Text::Group(Group { open, items, close, tail, .. }) = text else {
            return self.flat(text);
        };
        let inner = indent + 4;
        // Long lists of numbers fill their lines.
        let small = |item: &Item| {
            item.key.is_empty() && !item.has_comments() && item.text.width(40).is_some()
        };
        let fill = items.len() > 8 && items.iter().all(small);
        self.out.push_str(open);
        if !self.path.is_root() {
            self.remark();
        }
        let mut column = WIDTH;
        for (index, item) in items.iter().enumerate() {
            let width = item.text.width(40).unwrap_or(WIDTH) + 2;
            if fill && column + width <= WIDTH {
                self.out.push(' ');
                column += width;
            } else {
                self.comments(&item.above, inner);
                self.line(inner);
                column = inner + width;
            }
            self.path.push(item.step.clone().unwrap_or(Step::Index(index)));
            self.out.push_str(&item.key);
            self.text(&item.text, inner + item.key.chars().count(), inner);
            self.out.push(',');
            if !item.behind.is_empty() {
                self.out.extend([" ", &item.behind]);
            }
            let is_flat = item.text.width(WIDTH.saturating_sub(inner + item.key.len() + 1));
            if !fill && (is_flat.is_some() || matches!(item.text, Text::Leaf(_))) {
                self.remark();
            }
            self.path.pop();
        }
        self.comments(tail, inner);
        self.line(indent);
        self.out.push_str(close);
    }

    fn remark(&mut self) {
        if let Some(remark) = (self.remark)(&self.path) {
            self.out.extend(["  // ", &remark]);
        }
    }

    fn comments(&mut self, comments: &[String], indent: usize) {
        for comment in comments {
            if comment.is_empty() {
                self.out.push('\n');
            } else {
                self.line(indent);
                self.out.push_str(comment);
            }
        }
    }

    fn line(&mut self, indent: usize) {
        self.out.push('\n');
        self.out.push_str(&" ".repeat(indent));
    }
}

/// Text in quotes. A value that starts with `=` would be read as a formula: only where a key stands
/// may it stay as it is.
pub(in super::super) fn quoted(text: &str, is_key: bool) -> String {
    let mut out = String::from("\"");
    for (index, letter) in text.chars().enumerate() {
        match letter {
            '=' if index == 0 && !is_key => out.push_str("\\u{3D}"),
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            _ if letter.is_control() => {
                // Writing to a string cannot fail.
                let _infallible = write!(out, "\\u{{{:X}}}", u32::from(letter));
            }
            _ => out.push(letter),
        }
    }
    out.push('"');
    out
}
