//! RON text: its tokens, its tree, in which every node knows its place, and its layout. Nothing here knows scenes.
//!
//! The reader is ours, because `ron` with `serde` stops at the first error, keeps no places, and takes repeated
//! keys and `NaN` without an error.

mod comments;
mod layout;
mod lexer;
mod normal;
mod parser;
mod strange;
#[cfg(test)]
mod tests;

pub(super) use comments::{Comment, comments};
pub(super) use layout::{Group, Item, Text, quoted};
pub(super) use normal::normal_form;
pub(super) use parser::parse;
pub(super) use strange::decimal_advice;

/// Bytes of the text, from `start` up to but without `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// Byte after the last.
    pub end: u32,
}

impl Span {
    pub(super) fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, end: end as u32 }
    }

    /// The span of the same bytes where the text follows this number of other bytes.
    pub(super) fn shifted(self, by: usize) -> Self {
        Self { start: self.start + by as u32, end: self.end + by as u32 }
    }

    /// The bytes as a range, to index the text.
    #[must_use]
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its bytes.
    pub span: Span,
    /// Value.
    pub value: Value,
}

/// Value of a text.
#[derive(Clone, Debug)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// Number without a point.
    Integer {
        /// True of a number below 0.
        negative: bool,
        /// Its magnitude.
        magnitude: u64,
    },
    /// Number with a point or an exponent.
    Float(f64),
    /// A number that no scene can hold.
    BadNumber(BadNumber),
    /// Text in quotes.
    Text(String),
    /// Text that starts with `=`, without it.
    Formula(String),
    /// `[a, b]`.
    List(Vec<Node>),
    /// `(a, b)`; `()` too.
    Tuple(Vec<Node>),
    /// `(key: a)`.
    Record(Vec<Field>),
    /// `Name`, `Name(a)`, `Name(key: a)`.
    Named(Box<Named>),
    /// `{ "key": a }`.
    Map(Vec<(Node, Node)>),
}

/// Number that no scene can hold.
#[derive(Clone, Copy, Debug)]
pub enum BadNumber {
    /// Infinite, or not a number.
    NotFinite,
    /// Beyond 64 bits.
    TooLarge,
}

/// Key of a record with its value.
#[derive(Clone, Debug)]
pub struct Field {
    /// Key.
    pub name: String,
    /// Bytes of the key.
    pub name_span: Span,
    /// Value.
    pub value: Node,
}

/// Word with what it holds.
#[derive(Clone, Debug)]
pub struct Named {
    /// Word.
    pub name: String,
    /// Bytes of the word.
    pub name_span: Span,
    /// [`Value::Tuple`] or [`Value::Record`], or none.
    pub body: Option<Node>,
}

impl Node {
    /// Moves all places to where the text stands behind so many bytes.
    pub(super) fn shift(&mut self, by: usize) {
        self.span = self.span.shifted(by);
        match &mut self.value {
            Value::List(items) | Value::Tuple(items) => {
                for item in items {
                    item.shift(by);
                }
            }
            Value::Record(fields) => {
                for field in fields {
                    field.name_span = field.name_span.shifted(by);
                    field.value.shift(by);
                }
            }
            Value::Named(named) => {
                named.name_span = named.name_span.shifted(by);
                if let Some(body) = &mut named.body {
                    body.shift(by);
                }
            }
            Value::Map(entries) => {
                for (key, value) in entries {
                    key.shift(by);
                    value.shift(by);
                }
            }
            _ => {}
        }
    }

    /// The node that a path's next step starts from: names with one unnamed value, such as
    /// `Bands([..])` and `Some(..)`, are no step of a path.
    pub(super) fn inner(&self) -> &Self {
        let mut node = self;
        loop {
            match &node.value {
                Value::Named(named) => match &named.body {
                    Some(Self { value: Value::Tuple(items), .. }) if items.len() == 1 => {
                        node = &items[0];
                    }
                    Some(body) => node = body,
                    None => return node,
                },
                _ => return node,
            }
        }
    }

    /// Part of the node to underline: all of it on one line, else its first word or bracket.
    pub(super) fn head(&self, text: &str) -> Span {
        if text.get(self.span.range()).is_some_and(|own| own.contains('\n')) {
            self.opening()
        } else {
            self.span
        }
    }

    /// Its first word or bracket.
    pub(super) fn opening(&self) -> Span {
        match &self.value {
            Value::Named(named) => named.name_span,
            Value::List(_) | Value::Tuple(_) | Value::Record(_) | Value::Map(_) => {
                Span { start: self.span.start, end: self.span.start + 1 }
            }
            _ => self.span,
        }
    }

    /// `a number`, `a list`, `` `Periodic` ``.
    pub(super) fn describe(&self) -> String {
        match &self.value {
            Value::Bool(value) => format!("`{value}`"),
            Value::Integer { .. } | Value::Float(_) | Value::BadNumber(_) => "a number".to_owned(),
            Value::Text(_) => "a string".to_owned(),
            Value::Formula(_) => "a formula".to_owned(),
            Value::List(_) => "a list `[..]`".to_owned(),
            Value::Tuple(items) if items.is_empty() => "empty parentheses `()`".to_owned(),
            Value::Tuple(_) => "values in parentheses `(..)`".to_owned(),
            Value::Record(_) => "keys in parentheses `(key: ..)`".to_owned(),
            Value::Named(named) if named.body.is_some() => format!("`{}(..)`", named.name),
            Value::Named(named) => format!("the word `{}`", named.name),
            Value::Map(_) => "a map `{..}`".to_owned(),
        }
    }
}
