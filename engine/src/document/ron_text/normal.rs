//! The normal form of a text: its own words, numbers and comments, evenly laid out.

use super::comments::{Comment, comments};
use super::layout::{Group, Item, Text};
use super::{Named, Node, Value};

/// Text in its normal form; `tree` is the tree of the text.
///
/// Values stay as they are written. A group of values stands on one line where it has room and its author has put no
/// comma behind the last, one value a line elsewhere. Comments keep their places, and of blank lines between values
/// one.
pub(in super::super) fn normal_form(text: &str, tree: &Node) -> String {
    let (headers, comments) = comments(text);
    let last = headers.last().map_or(0, |header| header.end);
    let mut layout = Normal { text, comments, next: 0, last };
    let mut file: Vec<_> =
        headers.iter().map(|header| text[header.start..header.end].to_owned()).collect();
    layout.above(tree.span.start as usize, &mut file);
    if file.first().is_some_and(String::is_empty) {
        file.remove(0);
    }
    let mut stray = Vec::new();
    let value = layout.node(tree, &mut stray).into_file();
    file.extend(stray);
    let mut out = lines(&file);
    out.push_str(&value);
    let mut tail = Vec::new();
    layout.last = tree.span.end as usize;
    layout.above(text.len(), &mut tail);
    out.push_str(&lines(&tail));
    out
}

fn lines(lines: &[String]) -> String {
    lines.iter().flat_map(|line| [line, "\n"]).collect()
}

struct Normal<'a> {
    text: &'a str,
    comments: Vec<Comment>,
    /// The first comment that has not been placed.
    next: usize,
    /// End of what has been placed last.
    last: usize,
}

impl<'a> Normal<'a> {
    /// Comments that start before a byte, each a line, with the blank lines among them.
    fn above(&mut self, before: usize, lines: &mut Vec<String>) {
        while let Some(comment) = self.comments.get(self.next).filter(|c| c.start < before) {
            let (start, end) = (comment.start, comment.end);
            self.blank(start, lines);
            lines.push(self.text[start..end].trim_end().to_owned());
            (self.next, self.last) = (self.next + 1, end);
        }
        if before < self.text.len() {
            self.blank(before, lines);
        }
    }

    /// A blank line, where there are some up to a byte.
    fn blank(&mut self, before: usize, lines: &mut Vec<String>) {
        let gap = self.text.get(self.last..before).unwrap_or("");
        if gap.matches('\n').count() > 1 && lines.last().is_none_or(|line| !line.is_empty()) {
            lines.push(String::new());
        }
    }

    /// The comment on the line where the last value has ended.
    fn behind(&mut self) -> String {
        let Some(comment) = self.comments.get(self.next) else { return String::new() };
        let (start, end) = (comment.start, comment.end);
        let gap = self.text.get(self.last..start).unwrap_or("\n");
        let rest = self.text[end..].lines().next().unwrap_or("");
        let own = &self.text[start..end];
        let is_behind = gap.chars().all(|c| c == ',' || c.is_whitespace() && c != '\n')
            && !own.contains('\n')
            && rest.chars().all(|c| c == ',' || c.is_whitespace());
        if !is_behind {
            return String::new();
        }
        (self.next, self.last) = (self.next + 1, end);
        own.trim_end().to_owned()
    }

    fn raw(&self, node: &Node) -> &'a str {
        &self.text[node.span.range()]
    }

    /// A value; comments in odd places go to `above`.
    fn node(&mut self, node: &Node, above: &mut Vec<String>) -> Text {
        let text = match &node.value {
            Value::List(items) => self.group("[", "]", node, items.iter().map(|item| (None, item))),
            Value::Tuple(items) => {
                self.group("(", ")", node, items.iter().map(|item| (None, item)))
            }
            Value::Record(fields) => {
                let items =
                    fields.iter().map(|field| (Some(field.name_span.range()), &field.value));
                self.group("(", ")", node, items)
            }
            Value::Map(entries) => {
                let items = entries.iter().map(|(key, value)| (Some(key.span.range()), value));
                self.group("{", "}", node, items)
            }
            Value::Named(named) => self.named(named, above),
            _ => Text::Leaf(self.raw(node).to_owned()),
        };
        self.last = self.last.max(node.span.end as usize);
        text
    }

    fn named(&mut self, named: &Named, above: &mut Vec<String>) -> Text {
        let name = &self.text[named.name_span.range()];
        let Some(body) = &named.body else { return Text::Leaf(name.to_owned()) };
        match &body.value {
            Value::Tuple(items) if items.len() == 1 => {
                let before = items[0].span.start as usize;
                self.last = self.last.max(named.name_span.end as usize);
                self.loose(before, above);
                let inner = self.node(&items[0], above);
                self.loose(body.span.end as usize, above);
                Text::newtype(name, inner)
            }
            _ => match self.node(body, above) {
                Text::Leaf(leaf) => Text::Leaf(format!("{name}{leaf}")),
                Text::Group(group) => {
                    Text::Group(Group { open: format!("{name}{}", group.open), ..group })
                }
            },
        }
    }

    /// Comments before a byte that have no line of their own to go to.
    fn loose(&mut self, before: usize, above: &mut Vec<String>) {
        while let Some(comment) = self.comments.get(self.next).filter(|c| c.start < before) {
            above.push(self.text[comment.start..comment.end].trim_end().to_owned());
            (self.next, self.last) = (self.next + 1, comment.end);
        }
    }

    fn group<'n>(
        &mut self,
        open: &str,
        close: &str,
        node: &Node,
        values: impl Iterator<Item = (Option<std::ops::Range<usize>>, &'n Node)>,
    ) -> Text {
        self.last = node.span.start as usize + 1;
        let mut items = Vec::new();
        for (key, value) in values {
            let mut above = Vec::new();
            let start = key.as_ref().map_or(value.span.start as usize, |key| key.start);
            self.above(start, &mut above);
            if items.is_empty() && above.first().is_some_and(String::is_empty) {
                above.remove(0);
            }
            self.last = start;
            self.loose(value.span.start as usize, &mut above);
            let text = self.node(value, &mut above);
            self.loose(value.span.end as usize, &mut above);
            self.last = value.span.end as usize;
            let behind = self.behind();
            let key = key.map_or_else(String::new, |key| format!("{}: ", &self.text[key]));
            items.push(Item { above, behind, ..Item::new(None, key, text) });
        }
        let mut tail = Vec::new();
        let end = node.span.end as usize - 1;
        self.above(end, &mut tail);
        while tail.last().is_some_and(String::is_empty) {
            tail.pop();
        }
        let is_broken =
            !items.is_empty() && self.raw(node).contains('\n') && self.comma_before(end);
        let (open, close) = (open.to_owned(), close.to_owned());
        Text::Group(Group { open, items, close, tail, is_broken })
    }

    /// Returns whether a comma precedes a byte, comments aside.
    fn comma_before(&self, mut end: usize) -> bool {
        for comment in self.comments[..self.next].iter().rev() {
            if self.text[comment.end.min(end)..end].trim().is_empty() {
                end = comment.start;
            } else {
                break;
            }
        }
        self.text[..end].trim_end().ends_with(',')
    }
}
