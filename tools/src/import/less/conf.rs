//! JSON of a LESS project: values with their line and the path of keys, and which of them were read.

use std::cell::Cell;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow, bail};
use indexmap::IndexMap;
use serde_json::Value;
use serde_json::value::RawValue;

use super::text;

/// A file of settings is not larger, bytes.
pub(super) const LARGEST: u64 = 16 << 20;

/// A value of a JSON file.
#[derive(Debug)]
pub(super) struct Node {
    /// `file:line`, for a person.
    pub(super) place: String,
    /// Keys that lead to it, joined by dots.
    pub(super) path: String,
    content: Content,
    is_read: Cell<bool>,
}

#[derive(Debug)]
enum Content {
    Object(Vec<(String, Node)>),
    /// Number, text, truth value or list, as text; items of a list have commas between them.
    Scalar(String),
    Nothing,
}

impl Node {
    /// The content of a file.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = text::whole(path, LARGEST)?;
        let text = text.trim_start_matches('\u{feff}');
        // Parses all at once first: this limits the depth and locates errors of syntax.
        serde_json::from_str::<Value>(text).map_err(|error| {
            let (file, line, column) = (path.display(), error.line(), error.column());
            anyhow!("{file}:{line}:{column}: not JSON: {error}")
        })?;
        let raw: &RawValue = serde_json::from_str(text).context("the text was JSON")?;
        let starts = text.match_indices('\n').map(|(at, _)| at).collect();
        Tree { text, starts, file: path.display().to_string() }.node(raw, String::new())
    }

    /// The value of a key; none if it is absent, null or a blank text.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        self.entry(key).filter(|node| match &node.content {
            Content::Nothing => false,
            Content::Scalar(text) => !text.trim().is_empty(),
            Content::Object(_) => true,
        })
    }

    /// Form of a key without a value in the file: absent, null or empty.
    pub(super) fn lack_of(&self, key: &str) -> &'static str {
        match self.entry(key).map(|node| &node.content) {
            None => "absent",
            Some(Content::Nothing) => "null",
            Some(_) => "empty",
        }
    }

    /// The value of a key, whatever it is.
    fn entry(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Makes sure that the keys lead to objects: those without a value become empty ones.
    pub(super) fn ensure_object(&mut self, keys: &[&str]) -> Result<()> {
        let Some((key, rest)) = keys.split_first() else { return Ok(()) };
        let path = self.path_of(key);
        let empty = Self {
            place: self.place.clone(),
            path,
            content: Content::Object(Vec::new()),
            is_read: Cell::new(false),
        };
        let has_value = self.get(key).is_some();
        let Content::Object(entries) = &mut self.content else { return Ok(()) };
        let index = match entries.iter().position(|(name, _)| name == key) {
            Some(index) if has_value => index,
            Some(index) => {
                entries[index].1 = empty;
                index
            }
            None => {
                entries.push(((*key).to_owned(), empty));
                entries.len() - 1
            }
        };
        let node = &mut entries[index].1;
        if let Content::Scalar(text) = &node.content {
            let text = text::excerpt(text);
            return Err(node.wrong(&format!("{text:?} is not an object: write {{ .. }}")));
        }
        node.ensure_object(rest)
    }

    /// The value at the end of several keys.
    pub(super) fn at(&self, keys: &[&str]) -> Option<&Self> {
        keys.iter().try_fold(self, |node, key| node.get(key))
    }

    /// The value of a key that has to be there.
    pub(super) fn need(&self, key: &str) -> Result<&Self> {
        self.get(key).with_context(|| {
            let path = self.path_of(key);
            match self.lack_of(key) {
                "absent" => format!("{}: there is no `{path}`", self.place),
                lack => format!("{}: `{path}` is {lack}", self.place),
            }
        })
    }

    /// Keys and their values; none if it is no object.
    pub(super) fn entries(&self) -> &[(String, Self)] {
        match &self.content {
            Content::Object(entries) => entries,
            _ => &[],
        }
    }

    /// A number, or text that is one.
    pub(super) fn number(&self) -> Result<f64> {
        let text = self.text()?;
        finite(&text)
            .ok_or_else(|| self.wrong(&format!("{:?} is not a number", text::excerpt(&text))))
    }

    /// A text; of a number or a truth value what it is written as.
    pub(super) fn text(&self) -> Result<String> {
        self.is_read.set(true);
        match &self.content {
            Content::Scalar(text) => Ok(text.trim().to_owned()),
            _ => Err(self.wrong("is no single value")),
        }
    }

    /// A truth value.
    pub(super) fn flag(&self) -> Result<bool> {
        match self.text()?.to_ascii_lowercase().as_str() {
            "true" | "1" => Ok(true),
            "false" | "0" | "" => Ok(false),
            other => {
                let other = text::excerpt(other);
                Err(self.wrong(&format!("{other:?} is neither true nor false")))
            }
        }
    }

    /// The flag of a key; false if it has no value.
    pub(super) fn flag_of(&self, key: &str) -> Result<bool> {
        self.get(key).map_or(Ok(false), Self::flag)
    }

    /// Numbers with commas between them.
    pub(super) fn numbers(&self) -> Result<Vec<f64>> {
        let text = self.text()?;
        numbers(&text)
            .map_err(|part| self.wrong(&format!("{:?} is not a number", text::excerpt(part))))
    }

    /// The last key of its path.
    pub(super) fn name(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or_default()
    }

    /// The error of a wrong value: file, line, path and `what`.
    pub(super) fn wrong(&self, what: &str) -> anyhow::Error {
        anyhow!("{}: {}: {what}", self.place, self.path)
    }

    /// Text of the value; `{..}` for an object.
    pub(super) fn shown(&self) -> String {
        match &self.content {
            Content::Scalar(text) => text::excerpt(text),
            Content::Object(_) => "{..}".to_owned(),
            Content::Nothing => "null".to_owned(),
        }
    }

    /// Takes it, and all below it, as read.
    pub(super) fn settle(&self) {
        self.is_read.set(true);
        self.entries().iter().for_each(|(_, node)| node.settle());
    }

    /// Values that nothing has read.
    pub(super) fn unread(&self) -> Vec<&Self> {
        match &self.content {
            Content::Object(entries) if !self.is_read.get() => {
                entries.iter().flat_map(|(_, node)| node.unread()).collect()
            }
            Content::Scalar(text) if !self.is_read.get() && !text.trim().is_empty() => vec![self],
            _ => Vec::new(),
        }
    }

    /// The path of one of its keys.
    pub(super) fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }
}

/// Numbers with commas between them, perhaps one behind the last, or the part that is none.
pub(super) fn numbers(text: &str) -> Result<Vec<f64>, &str> {
    let text = text.trim();
    let text = text.strip_suffix(',').unwrap_or(text);
    text.split(',').map(|part| finite(part).ok_or(part)).collect()
}

/// The items of a list as LESS writes lists: a text with commas.
fn joined(items: &[Value]) -> String {
    let item = |item: &Value| match item {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    items.iter().map(item).collect::<Vec<_>>().join(",")
}

/// A finite number.
pub(super) fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

struct Tree<'a> {
    text: &'a str,
    /// Bytes where lines end.
    starts: Vec<usize>,
    file: String,
}

impl Tree<'_> {
    fn node(&self, raw: &RawValue, path: String) -> Result<Node> {
        // Raw values borrow from the text: where they lie in memory is where they stand in it.
        let offset = (raw.get().as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        let line = 1 + self.starts.partition_point(|&start| start < offset);
        let mut node = Node {
            place: format!("{}:{line}", self.file),
            path,
            content: Content::Nothing,
            is_read: Cell::new(false),
        };
        node.content = match serde_json::from_str(raw.get())? {
            Value::Null => Content::Nothing,
            Value::String(text) => Content::Scalar(text),
            Value::Object(_) => {
                let entries: IndexMap<String, &RawValue> = serde_json::from_str(raw.get())?;
                let entry = |(key, raw): (String, &RawValue)| {
                    let child = self.node(raw, node.path_of(&key))?;
                    Ok((key, child))
                };
                Content::Object(entries.into_iter().map(entry).collect::<Result<_>>()?)
            }
            Value::Array(items) => Content::Scalar(joined(&items)),
            other => Content::Scalar(other.to_string()),
        };
        if node.path.is_empty() && !matches!(node.content, Content::Object(_)) {
            bail!("{}: not a JSON object", node.place);
        }
        Ok(node)
    }
}
