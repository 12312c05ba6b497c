//! Changes of a scene's text that leave all else as its author wrote it.

use std::ops::Range;

use super::read::{ReadError, parse_text};
use super::ron_text::{Comment, Node, Value, comments, normal_form};
use super::source::Source;

/// A scene's text with the values of another one: comments, order and layout stay where values do.
///
/// Keys and items that only `new` has stand behind the one that they follow there; a value that differs is written as
/// in `new`. A text in its normal form ([`format`](super::format)) comes out in it. `name` stands for the file of the
/// text in messages.
///
/// # Errors
/// Where one of the texts is not RON.
pub fn with_values_of(name: &str, text: &str, new: &str) -> Result<String, ReadError> {
    let old_tree = parse_text(&Source::new(name, text))?;
    let new_tree = parse_text(&Source::new(name, new))?;
    let (_, comments) = comments(text);
    let mut editor = Editor { text, new, comments, edits: Vec::new() };
    editor.node(&old_tree, &new_tree);
    let edited = editor.finish();
    if edited == text || normal_form(text, &old_tree) != text {
        return Ok(edited);
    }
    let tree = parse_text(&Source::new(name, &edited))?;
    Ok(normal_form(&edited, &tree))
}

struct Editor<'a> {
    text: &'a str,
    new: &'a str,
    comments: Vec<Comment>,
    /// Bytes that are replaced, and by what.
    edits: Vec<(Range<usize>, String)>,
}

/// Item of a group: a value, a key with its value, or an entry of a map.
#[derive(Clone, Copy)]
struct GroupItem<'n> {
    /// Key, or none in lists.
    key: Option<&'n str>,
    start: usize,
    value: &'n Node,
}

impl GroupItem<'_> {
    const fn end(&self) -> usize {
        self.value.span.end as usize
    }
}

/// Record, list or map with some items.
struct Group<'n> {
    node: &'n Node,
    items: Vec<GroupItem<'n>>,
}

impl<'n> Group<'n> {
    /// Group of a node; none if it is none, or empty.
    fn of(node: &'n Node) -> Option<Self> {
        items(node).filter(|items| !items.is_empty()).map(|items| Self { node, items })
    }

    /// Place behind its bracket.
    const fn open(&self) -> usize {
        self.node.span.start as usize + 1
    }

    /// End of what stands before an item.
    fn end_before(&self, item: usize) -> usize {
        item.checked_sub(1).map_or(self.open(), |before| self.items[before].end())
    }
}

/// Step from the items of a text to those of another.
enum Step {
    /// Item `.0` becomes item `.1`.
    Change(usize, usize),
    Remove(usize),
    /// Item `.1` is put behind item `.0`, or first of all.
    Insert(Option<usize>, usize),
}

impl Editor<'_> {
    fn finish(mut self) -> String {
        // Stable: what is put in one place stays in order.
        self.edits.sort_by_key(|(range, _)| range.start);
        let mut edited = String::with_capacity(self.text.len());
        let mut at = 0;
        for (range, by) in &self.edits {
            edited.push_str(&self.text[at..range.start.max(at)]);
            edited.push_str(by);
            at = at.max(range.end);
        }
        edited.push_str(&self.text[at..]);
        edited
    }

    fn node(&mut self, old: &Node, new: &Node) {
        let (old, new) = (without_some(old), without_some(new));
        if is_same(old, new) {
            return;
        }
        match (&old.value, &new.value) {
            (Value::Named(a), Value::Named(b)) if a.name == b.name => {
                if let (Some(a), Some(b)) = (&a.body, &b.body) {
                    return self.node(a, b);
                }
            }
            (Value::Record(_), Value::Record(_))
            | (Value::Map(_), Value::Map(_))
            | (Value::List(_), Value::List(_)) => {
                if let (Some(from), Some(to)) = (Group::of(old), Group::of(new)) {
                    return self.group(&from, &to);
                }
            }
            (Value::Tuple(a), Value::Tuple(b)) if a.len() == b.len() => {
                return a.iter().zip(b).for_each(|(a, b)| self.node(a, b));
            }
            _ => {}
        }
        self.replace(old, new);
    }

    fn replace(&mut self, old: &Node, new: &Node) {
        self.edits.push((old.span.range(), self.new[new.span.range()].to_owned()));
    }

    fn group(&mut self, group: &Group<'_>, to: &Group<'_>) {
        let (old, new) = (&group.items, &to.items);
        let has_order = matches!(group.node.value, Value::List(_));
        let has_keys = old.iter().chain(new).all(|item| item.key.is_some());
        let steps = if has_keys && !(has_order && is_reordered(old, new)) {
            steps_by_key(old, new)
        } else {
            steps_by_value(old, new)
        };
        if !steps.iter().any(|step| matches!(step, Step::Change(..))) {
            return self.replace(group.node, to.node);
        }
        for step in steps {
            match step {
                Step::Change(from, to) => self.node(old[from].value, new[to].value),
                Step::Remove(from) => {
                    let range = self.extent(group.end_before(from), &old[from]);
                    self.edits.push((range, String::new()));
                }
                Step::Insert(behind, to) => {
                    let item = &self.new[new[to].start..new[to].end()];
                    self.insert(group, behind, item);
                }
            }
        }
    }

    /// Bytes of an item with its comma, the comments above it and the one behind it.
    ///
    /// - `end_before`: end of what stands before it
    fn extent(&self, end_before: usize, item: &GroupItem<'_>) -> Range<usize> {
        let before = self.comma(end_before).map_or(end_before, |comma| comma + 1);
        let gap = &self.text[before..item.start];
        let line = gap.find('\n').map(|newline| before + newline + 1);
        let comma = self.comma(item.end()).map_or(item.end(), |comma| comma + 1);
        let end = self.line_end(comma);
        match (line, end) {
            // Lines of its own.
            (Some(start), Some(end)) => start..(end + 1).min(self.text.len()),
            // The last one of a line leaves no comma behind.
            _ if comma == item.end() && self.is_bare(end_before..item.start) => end_before..comma,
            _ => {
                let rest = &self.text[comma..];
                let blanks = rest.len() - rest.trim_start_matches([' ', '\t']).len();
                item.start..comma + blanks
            }
        }
    }

    /// Returns whether bytes hold no more than blanks and commas.
    fn is_bare(&self, range: Range<usize>) -> bool {
        self.text[range].chars().all(|c| c == ',' || c.is_whitespace())
    }

    /// Puts an item behind another one, or first.
    fn insert(&mut self, group: &Group<'_>, behind: Option<usize>, item: &str) {
        let (open, old) = (group.open(), &group.items);
        let is_tall = self.text[open..old[0].start].contains('\n');
        let Some(behind) = behind else {
            let at = if is_tall { self.line_end(open).unwrap_or(open) } else { open };
            let text = if is_tall {
                format!("\n{}{item},", self.indentation(old[0].start))
            } else {
                format!("{item}, ")
            };
            return self.edits.push((at..at, text));
        };
        let before = &old[behind];
        if !is_tall {
            let at = before.end();
            return self.edits.push((at..at, format!(", {item}")));
        }
        let comma = self.comma(before.end());
        let text = format!("\n{}{item},", self.indentation(before.start));
        let at = comma.map_or(before.end(), |comma| comma + 1);
        if comma.is_none() && !self.edits.contains(&(at..at, ",".to_owned())) {
            self.edits.push((at..at, ",".to_owned()));
        }
        let at = self.line_end(at).unwrap_or(at);
        self.edits.push((at..at, text));
    }

    /// Place of the comma that follows, if only blanks and comments stand before it.
    fn comma(&self, mut at: usize) -> Option<usize> {
        loop {
            let rest = &self.text[at..];
            at += rest.len() - rest.trim_start().len();
            match self.comments.iter().find(|comment| comment.start == at) {
                Some(comment) => at = comment.end,
                None => return self.text[at..].starts_with(',').then_some(at),
            }
        }
    }

    /// End of the line, if nothing but blanks and a comment follow on it.
    fn line_end(&self, at: usize) -> Option<usize> {
        let rest = &self.text[at..];
        let start = at + rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
        let end = self.comments.iter().find(|comment| comment.start == start);
        let end = end.map_or(start, |comment| comment.end);
        let rest = &self.text[end..];
        let end = end + rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
        (end == self.text.len() || self.text[end..].starts_with('\n')).then_some(end)
    }

    /// Blanks at the start of the line of a place.
    fn indentation(&self, at: usize) -> &str {
        let line = self.text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let length = self.text[line..at].len() - self.text[line..at].trim_start().len();
        &self.text[line..line + length]
    }
}

/// Steps between items that have keys.
fn steps_by_key(old: &[GroupItem<'_>], new: &[GroupItem<'_>]) -> Vec<Step> {
    let place = |items: &[GroupItem<'_>], key| items.iter().position(|item| item.key == key);
    let mut steps: Vec<Step> = (0..old.len())
        .map(|from| match place(new, old[from].key) {
            Some(to) => Step::Change(from, to),
            None => Step::Remove(from),
        })
        .collect();
    let mut behind = None;
    for (to, item) in new.iter().enumerate() {
        match place(old, item.key) {
            Some(from) => behind = Some(from),
            None => steps.push(Step::Insert(behind, to)),
        }
    }
    steps
}

/// Steps between items of lists: equal ones at both ends stay, those between become one another in order.
fn steps_by_value(old: &[GroupItem<'_>], new: &[GroupItem<'_>]) -> Vec<Step> {
    let same = |(a, b): &(&GroupItem<'_>, &GroupItem<'_>)| is_same(a.value, b.value);
    let first = old.iter().zip(new).take_while(same).count();
    let rest = (&old[first..], &new[first..]);
    let last = rest.0.iter().rev().zip(rest.1.iter().rev()).take_while(same).count();
    let (from, to) = (first..old.len() - last, first..new.len() - last);
    let paired = from.len().min(to.len());
    let changed = (0..paired).map(|place| Step::Change(first + place, first + place));
    let removed = from.skip(paired).map(Step::Remove);
    let behind = (first + paired).checked_sub(1);
    let inserted = to.skip(paired).map(|place| Step::Insert(behind, place));
    changed.chain(removed).chain(inserted).collect()
}

/// Returns whether items of two lists stand in another order, or keys are not theirs alone.
fn is_reordered(old: &[GroupItem<'_>], new: &[GroupItem<'_>]) -> bool {
    let place = |key: Option<&str>| old.iter().position(|item| item.key == key);
    let is_first = |items: &[GroupItem<'_>]| {
        items.iter().enumerate().all(|(index, item)| {
            items.iter().position(|other| other.key == item.key) == Some(index)
        })
    };
    let places: Vec<usize> = new.iter().filter_map(|item| place(item.key)).collect();
    !is_first(old) || !is_first(new) || !places.is_sorted()
}

/// Name that a record has as a key, such as that of a band.
fn name_of(value: &Node) -> Option<&str> {
    let Value::Record(fields) = &value.inner().value else { return None };
    let name = fields.iter().find(|field| field.name == "name")?;
    match &name.value.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}

/// Items of a record, a list or a map whose keys are texts.
fn items(node: &Node) -> Option<Vec<GroupItem<'_>>> {
    let start = |node: &Node| node.span.start as usize;
    match &node.value {
        Value::Record(fields) => Some(
            fields
                .iter()
                .map(|field| GroupItem {
                    key: Some(field.name.as_str()),
                    start: field.name_span.start as usize,
                    value: &field.value,
                })
                .collect(),
        ),
        Value::List(values) => Some(
            values
                .iter()
                .map(|value| GroupItem { key: name_of(value), start: start(value), value })
                .collect(),
        ),
        Value::Map(entries) => entries
            .iter()
            .map(|(key, value)| match &key.value {
                Value::Text(text) => {
                    Some(GroupItem { key: Some(text.as_str()), start: start(key), value })
                }
                _ => None,
            })
            .collect(),
        _ => None,
    }
}

/// The value in `Some(..)`, which need not be written.
fn without_some(node: &Node) -> &Node {
    match &node.value {
        Value::Named(named) if named.name == "Some" => {
            match named.body.as_ref().map(|b| &b.value) {
                Some(Value::Tuple(items)) if items.len() == 1 => &items[0],
                _ => node,
            }
        }
        _ => node,
    }
}

/// Returns whether two values are the same, wherever they stand.
fn is_same(a: &Node, b: &Node) -> bool {
    let (a, b) = (without_some(a), without_some(b));
    let all =
        |a: &[Node], b: &[Node]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b));
    match (&a.value, &b.value) {
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (
            Value::Integer { negative, magnitude },
            Value::Integer { negative: sign, magnitude: other },
        ) => negative == sign && magnitude == other,
        (Value::Float(a), Value::Float(b)) => a.to_bits() == b.to_bits(),
        (Value::Text(a), Value::Text(b)) | (Value::Formula(a), Value::Formula(b)) => a == b,
        (Value::List(a), Value::List(b)) | (Value::Tuple(a), Value::Tuple(b)) => all(a, b),
        (Value::Record(a), Value::Record(b)) => {
            a.len() == b.len()
                && a.iter().zip(b).all(|(a, b)| a.name == b.name && is_same(&a.value, &b.value))
        }
        (Value::Map(a), Value::Map(b)) => {
            a.len() == b.len()
                && a.iter().zip(b).all(|(a, b)| is_same(&a.0, &b.0) && is_same(&a.1, &b.1))
        }
        (Value::Named(a), Value::Named(b)) => {
            a.name == b.name
                && match (&a.body, &b.body) {
                    (Some(a), Some(b)) => is_same(a, b),
                    (None, None) => true,
                    // A word with keys that have defaults may go without parentheses.
                    (Some(body), None) | (None, Some(body)) => {
                        matches!(&body.value, Value::Tuple(items) if items.is_empty())
                    }
                }
        }
        _ => false,
    }
}
