//! Tree to types: always a value, and every error on the way.

use std::borrow::Cow;
use std::collections::HashMap;

use indexmap::IndexMap;

use super::diagnostic::{Diagnostic, Place, nearest, suggestion};
use super::source::Source;
use super::syntax::{Field, Node, Span, Step, Value, path_of};

/// No more errors than this are kept: nobody reads them.
const ERRORS: usize = 100;

/// A type that can be read from the tree.
pub(super) trait Decode: Sized {
    /// What a person calls such a value: `a number`.
    fn expected() -> Cow<'static, str>;

    /// How one is written.
    fn example() -> String;

    /// The value; where it cannot be read, the reader is told and the value is a placeholder.
    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self;

    /// A value that stands where none could be read.
    fn placeholder() -> Self;
}

/// Where reading has come to, and what was wrong on the way.
pub(super) struct Reader<'a> {
    source: &'a Source,
    path: Vec<Step<'a>>,
    diagnostics: Vec<Diagnostic>,
    dropped: usize,
    /// What formulas came to, by their first byte; none where that was nothing.
    computed: HashMap<u32, Option<f64>>,
    /// Paths without a value, beside those of `diagnostics`.
    broken: Vec<String>,
    /// How the value of the key at this depth is written.
    example: Option<(usize, &'static str)>,
}

/// What was wrong with a tree.
pub(super) struct Findings {
    pub(super) diagnostics: Vec<Diagnostic>,
    /// How many more errors there were.
    pub(super) dropped: usize,
    /// Paths without a value.
    pub(super) broken: Vec<String>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self {
            source,
            path: Vec::new(),
            diagnostics: Vec::new(),
            dropped: 0,
            computed: HashMap::new(),
            broken: Vec::new(),
            example: None,
        }
    }

    /// What was wrong.
    pub(super) fn finish(self) -> Findings {
        let Self { diagnostics, dropped, mut broken, .. } = self;
        broken.extend(diagnostics.iter().map(|error| error.path.clone()));
        Findings { diagnostics, dropped, broken }
    }

    fn mark_broken(&mut self) {
        if self.broken.len() < ERRORS {
            self.broken.push(path_of(&self.path));
        }
    }

    pub(super) fn text(&self) -> &'a str {
        self.source.text()
    }

    /// Reads something one step down.
    pub(super) fn within<T>(&mut self, step: Step<'a>, read: impl FnOnce(&mut Self) -> T) -> T {
        self.path.push(step);
        let value = read(self);
        self.path.pop();
        value
    }

    /// Something wrong where reading has come to.
    pub(super) fn error(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        let error = Diagnostic::error(path_of(&self.path), message).at(self.place_of(span));
        self.push(Diagnostic { help, ..error });
    }

    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < ERRORS {
            self.diagnostics.push(diagnostic);
        } else {
            self.dropped += 1;
        }
    }

    pub(super) fn place_of(&self, span: Span) -> Place {
        self.source.place_of(span)
    }

    /// What a formula came to; none where it was wrong, which has been reported.
    pub(super) fn set_computed(&mut self, formula: &Node, value: Option<f64>) {
        self.computed.insert(formula.span.start, value);
    }

    fn computed(&self, formula: &Node) -> Option<f64> {
        self.computed.get(&formula.span.start).copied().flatten()
    }

    /// A value of the wrong kind.
    pub(super) fn mismatch<T: Decode>(&mut self, node: &Node) -> T {
        let computed = self.computed.get(&node.span.start).copied();
        let reported = matches!(node.value, Value::BadNumber(_)) || computed == Some(None);
        if !reported {
            let found = match computed.flatten() {
                Some(value) => format!("a formula that gives {value:?}"),
                None => node.describe(),
            };
            let message = format!("expected {}, found {found}", T::expected());
            let example = match self.example {
                Some((depth, example)) if depth == self.path.len() => example.to_owned(),
                _ => T::example(),
            };
            let help = format!("write, for example, `{example}`");
            self.error(node.head(self.text()), message, Some(help));
        }
        T::placeholder()
    }

    fn number_error<T: Decode>(&mut self, node: &Node, message: String, help: Option<String>) -> T {
        self.error(node.span, message, help);
        T::placeholder()
    }
}

impl Decode for f64 {
    fn expected() -> Cow<'static, str> {
        "a number".into()
    }

    fn example() -> String {
        "1.0".to_owned()
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match node.value {
            Value::Float(value) => value,
            Value::Formula(_) => match reader.computed(node) {
                Some(value) => value,
                None => reader.mismatch(node),
            },
            Value::Integer { negative, magnitude } => {
                if negative {
                    -(magnitude as Self)
                } else {
                    magnitude as Self
                }
            }
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        0.0
    }
}

/// Whether a float is a whole number that it holds exactly.
fn is_whole(value: f64) -> bool {
    value.fract() == 0.0 && (0.0..=9e15).contains(&value)
}

macro_rules! decode_integer {
    ($type:ty) => {
        impl Decode for $type {
            fn expected() -> Cow<'static, str> {
                "a whole number".into()
            }

            fn example() -> String {
                "1".to_owned()
            }

            fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
                match node.value {
                    Value::Integer { negative, magnitude } if !negative || magnitude == 0 => {
                        Self::try_from(magnitude).unwrap_or_else(|_out_of_range| {
                            let message =
                                format!("expected a whole number of at most {}", Self::MAX);
                            reader.number_error(node, message, None)
                        })
                    }
                    Value::Integer { magnitude, .. } => {
                        let message =
                            format!("expected a whole number of at least 0, found -{magnitude}");
                        reader.number_error(node, message, None)
                    }
                    Value::Float(value) => {
                        let message = format!("expected a whole number, found {value:?}");
                        let help = is_whole(value).then(|| format!("write `{value:.0}`"));
                        reader.number_error(node, message, help)
                    }
                    _ => match reader.computed(node) {
                        Some(value) if is_whole(value) && value < 2_f64.powi(Self::BITS as i32) => {
                            value as Self
                        }
                        _ => reader.mismatch(node),
                    },
                }
            }

            fn placeholder() -> Self {
                0
            }
        }
    };
}

decode_integer!(u32);
decode_integer!(u64);

impl Decode for bool {
    fn expected() -> Cow<'static, str> {
        "`true` or `false`".into()
    }

    fn example() -> String {
        "true".to_owned()
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match node.value {
            Value::Bool(value) => value,
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        false
    }
}

impl Decode for String {
    fn expected() -> Cow<'static, str> {
        "a string".into()
    }

    fn example() -> Self {
        "\"name\"".to_owned()
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::Text(text) => text.clone(),
            // Where formulas have no place, the sign is part of the text.
            Value::Formula(text) if !reader.computed.contains_key(&node.span.start) => {
                format!("={text}")
            }
            Value::Named(named) if named.body.is_none() => {
                let message = format!("expected a string, found the word `{}`", named.name);
                reader.error(node.span, message, Some(format!("write `\"{}\"`", named.name)));
                Self::placeholder()
            }
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        Self::new()
    }
}

/// A bare value, `Some(value)` or `None`.
impl<T: Decode> Decode for Option<T> {
    fn expected() -> Cow<'static, str> {
        T::expected()
    }

    fn example() -> String {
        T::example()
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        if let Value::Named(named) = &node.value {
            match (named.name.as_str(), named.body.as_ref().map(|body| &body.value)) {
                ("None", None) => return None,
                ("Some", Some(Value::Tuple(items))) if items.len() == 1 => {
                    return Some(T::decode(&items[0], reader));
                }
                _ => {}
            }
        }
        Some(T::decode(node, reader))
    }

    fn placeholder() -> Self {
        None
    }
}

impl<T: Decode> Decode for Vec<T> {
    fn expected() -> Cow<'static, str> {
        "a list `[..]`".into()
    }

    fn example() -> String {
        format!("[{}]", T::example())
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        let Value::List(items) = &node.value else { return reader.mismatch(node) };
        let read = |(index, item)| reader.within(Step::Index(index), |r| T::decode(item, r));
        items.iter().enumerate().map(read).collect()
    }

    fn placeholder() -> Self {
        Self::new()
    }
}

impl<T: Decode> Decode for IndexMap<String, T> {
    fn expected() -> Cow<'static, str> {
        "a map `{..}`".into()
    }

    fn example() -> String {
        format!("{{ \"name\": {} }}", T::example())
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        let Value::Map(entries) = &node.value else { return reader.mismatch(node) };
        let mut map = Self::with_capacity(entries.len());
        for (key, value) in entries {
            let Value::Text(name) = &key.value else {
                reader.mismatch::<String>(key);
                continue;
            };
            let value = reader.within(Step::Key(name), |reader| T::decode(value, reader));
            map.insert(name.clone(), value);
        }
        map
    }

    fn placeholder() -> Self {
        Self::new()
    }
}

macro_rules! decode_tuple {
    ($count:literal: $($type:ident $index:tt),*) => {
        impl<$($type: Decode),*> Decode for ($($type,)*) {
            fn expected() -> Cow<'static, str> {
                concat!(stringify!($count), " values in parentheses").into()
            }

            fn example() -> String {
                format!("({})", [$($type::example()),*].join(", "))
            }

            fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
                match &node.value {
                    Value::Tuple(items) if items.len() == $count => {
                        ($(reader.within(
                            Step::Index($index),
                            |reader| $type::decode(&items[$index], reader),
                        ),)*)
                    }
                    Value::Tuple(items) => {
                        let message = format!(
                            concat!("expected ", stringify!($count), " values, found {}"),
                            items.len()
                        );
                        let help = format!("write, for example, `{}`", Self::example());
                        reader.error(node.head(reader.text()), message, Some(help));
                        Self::placeholder()
                    }
                    _ => reader.mismatch(node),
                }
            }

            fn placeholder() -> Self {
                ($($type::placeholder(),)*)
            }
        }
    };
}

decode_tuple!(2: A 0, B 1);
decode_tuple!(3: A 0, B 1, C 2);

/// The keys of a record or of a variant.
pub(super) struct Fields<'a> {
    list: &'a [Field],
    /// What to underline where a key is missing.
    head: Span,
    /// What a person calls the owner: `the sun`.
    owner: &'static str,
    known: &'static [&'static str],
}

impl<'a> Fields<'a> {
    /// Keys of a record, with or without its type's name.
    pub(super) fn of_record(
        node: &'a Node,
        type_name: &str,
        owner: &'static str,
        known: &'static [&'static str],
    ) -> Option<Self> {
        let head = node.opening();
        let value = match &node.value {
            Value::Named(named) if named.name == type_name => &named.body.as_ref()?.value,
            value => value,
        };
        let list = match value {
            Value::Record(fields) => fields.as_slice(),
            Value::Tuple(items) if items.is_empty() => &[],
            _ => return None,
        };
        Some(Self { list, head, owner, known })
    }

    fn unknown(&self) -> impl Iterator<Item = &'a Field> {
        let known = self.known;
        self.list.iter().filter(|field| !known.contains(&field.name.as_str()))
    }

    /// Reports every key that is not among those known.
    pub(super) fn refuse_others(&self, reader: &mut Reader<'a>) {
        let known = self.known;
        for field in self.unknown() {
            let name = field.name.as_str();
            let (message, help) = match later(self.owner, name) {
                Some((what, instead)) => {
                    (format!("this version does not know {what} yet"), instead.to_owned())
                }
                None if known.is_empty() => (
                    format!("no key `{name}` in {}", self.owner),
                    format!("{} has no keys", self.owner),
                ),
                None => (
                    format!("no key `{name}` in {}", self.owner),
                    suggestion(name, known, "keys here"),
                ),
            };
            reader.within(Step::Key(name), |reader| {
                reader.error(field.name_span, message, Some(help));
            });
        }
    }

    fn find(&self, name: &str) -> Option<&'a Field> {
        self.list.iter().find(|field| field.name == name)
    }

    pub(super) fn required<T: Decode>(
        &self,
        name: &'static str,
        example: Option<&'static str>,
        reader: &mut Reader<'a>,
    ) -> T {
        reader.within(Step::Key(name), |reader| match self.find(name) {
            Some(field) => {
                reader.example = example.map(|example| (reader.path.len(), example));
                T::decode(&field.value, reader)
            }
            // Under a name like this one it is there, and that has been reported.
            None if self
                .unknown()
                .any(|f| nearest(&f.name, self.known.iter().copied()) == Some(name)) =>
            {
                reader.mark_broken();
                T::placeholder()
            }
            None => {
                let message = format!("{} lacks the key `{name}`", self.owner);
                let example = example.map_or_else(T::example, str::to_owned);
                let help = format!("write, for example, `{name}: {example}`");
                reader.error(self.head, message, Some(help));
                T::placeholder()
            }
        })
    }

    pub(super) fn optional<T: Decode>(
        &self,
        name: &'static str,
        default: impl FnOnce() -> T,
        reader: &mut Reader<'a>,
    ) -> T {
        match self.find(name) {
            Some(field) => reader.within(Step::Key(name), |reader| T::decode(&field.value, reader)),
            None => default(),
        }
    }
}

/// What the language will know, but this version does not.
fn later(owner: &str, name: &str) -> Option<(&'static str, &'static str)> {
    match (owner, name) {
        ("the scene", "include") => {
            Some(("`include`", "write the included values into this file and take the key out"))
        }
        ("the scene", "sweep") => {
            Some(("`sweep`", "take the key out and run the scene once a point with `--set`"))
        }
        ("instances", "Scatter") => {
            Some(("`Scatter(..)`", "write the places with `List(..)` or `Table(..)`"))
        }
        _ => None,
    }
}

/// A variant of a choice, as written.
pub(super) struct Variant<'a> {
    pub(super) name: &'a str,
    name_span: Span,
    body: Option<&'a Node>,
}

impl<'a> Variant<'a> {
    pub(super) fn of(node: &'a Node) -> Option<Self> {
        match &node.value {
            Value::Named(named) => Some(Self {
                name: &named.name,
                name_span: named.name_span,
                body: named.body.as_ref(),
            }),
            _ => None,
        }
    }

    /// `Periodic`.
    pub(super) fn unit<T>(&self, value: T, reader: &mut Reader<'a>) -> T {
        if let Some(body) = self.body
            && !matches!(&body.value, Value::Tuple(items) if items.is_empty())
        {
            let message = format!("`{}` takes no values", self.name);
            let help = format!("write `{}` alone", self.name);
            reader.error(body.head(reader.text()), message, Some(help));
        }
        value
    }

    /// `Constant(0.3)`.
    pub(super) fn newtype<T: Decode>(&self, example: Option<&str>, reader: &mut Reader<'a>) -> T {
        let items = match self.body.map(|body| &body.value) {
            Some(Value::Tuple(items)) => items.as_slice(),
            _ => &[],
        };
        if let [item] = items {
            return T::decode(item, reader);
        }
        let example = example.map_or_else(T::example, str::to_owned);
        let found = match self.body.map(|body| &body.value) {
            None => "none".to_owned(),
            Some(Value::Record(_)) => "keys".to_owned(),
            Some(_) => items.len().to_string(),
        };
        let message = format!("`{}` takes one value, found {found}", self.name);
        let help = format!("write, for example, `{}({example})`", self.name);
        reader.error(self.name_span, message, Some(help));
        T::placeholder()
    }

    /// `Plane(size_m: ..)`; the name alone stands for a variant with defaults only.
    pub(super) fn fields(
        &self,
        owner: &'static str,
        known: &'static [&'static str],
        reader: &mut Reader<'a>,
    ) -> Option<Fields<'a>> {
        let list = match self.body.map(|body| &body.value) {
            None => &[],
            Some(Value::Record(fields)) => fields.as_slice(),
            Some(Value::Tuple(items)) if items.is_empty() => &[],
            Some(_) => {
                let message = format!("{owner} takes keys, found values without");
                let help = format!("write `key: value`; keys here: {}", known.join(", "));
                reader.error(self.name_span, message, Some(help));
                return None;
            }
        };
        Some(Fields { list, head: self.name_span, owner, known })
    }

    /// A name that no variant has.
    pub(super) fn unknown<T: Decode>(
        &self,
        kind: &str,
        known: &[&'static str],
        reader: &mut Reader<'a>,
    ) -> T {
        let expected = T::expected();
        let (message, help) = match later(kind, self.name) {
            Some((what, instead)) => {
                (format!("this version does not know {what} yet"), instead.to_owned())
            }
            None => (
                format!("expected {expected}, found `{}`", self.name),
                suggestion(self.name, known, "choices here"),
            ),
        };
        reader.error(self.name_span, message, Some(help));
        T::placeholder()
    }
}

/// `(zenith_deg: 30.0)` from keys and examples.
pub(super) fn example_of_keys(keys: &[Option<(&'static str, String)>]) -> String {
    let keys: Vec<_> =
        keys.iter().flatten().map(|(name, example)| format!("{name}: {example}")).collect();
    format!("({})", keys.join(", "))
}
