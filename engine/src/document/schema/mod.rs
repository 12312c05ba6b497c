//! `record!` and `choice!`: one declaration gives a document type its Rust form with a constructor, its reader
//! (every error with its place, unknown keys with the nearest known one), its writer, its description, and
//! serde's `Serialize` and `Deserialize`.
//!
//! `key: Type` must be written, `key: Type = default` may be left out. `name as keys: Type` puts the keys of the
//! record `Type` among those of its owner, where a `= default` replaces the defaults of the record. The text
//! behind the type's name is what a person calls it; that behind `=>` shows how a key is written where it is
//! missing; a key that has both stands in examples. A variant holds nothing, `(Type)`, the keys of a record
//! `(..Record)`, or a few keys of its own `{ key: Type }`.
//!
//! The reader of scene files in [`super::read`] and serde read the same language, apart from formulas and included files.
//! Scene files are for people, so our reader stays: serde stops at the first error, knows no places after parsing,
//! and lets the last of repeated keys of a map win (ron 0.12).

#[macro_use]
mod key;
#[macro_use]
mod record;
#[macro_use]
mod choice;

use std::borrow::Cow;
use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{
    self, Deserialize, DeserializeSeed, Deserializer, MapAccess, VariantAccess, Visitor,
};
use serde::ser::{SerializeStruct as _, Serializer};

use super::decode::{Decode, Fields, Reader};
use super::describe::{self, Book, SchemaKey};
use super::encode::Encode;
use super::leaves::Walk;
use super::ron_text::{Item, Node, Text};

/// Keys as serde reads them, in any order.
pub(super) trait ReadKeys: Sized {
    /// Name of the type, or of the variant.
    const NAME: &'static str;
    /// All keys, in the order of their declaration.
    const KEYS: &'static [&'static str];

    /// Value with the defaults of its keys, and with placeholders for keys that must be written.
    fn start() -> Self;

    /// Reads the value of a key; false if there is no such key.
    fn read_key<'de, A: MapAccess<'de>>(
        &mut self,
        name: &str,
        map: &mut A,
    ) -> Result<bool, A::Error>;

    /// First key that must be written and is not among those read.
    fn missing(read: &[String]) -> Option<&'static str>;
}

/// A type with keys. They stand in parentheses of their own, in those of a variant, or among the keys of another
/// record, whose defaults (`base`) then replace the declared ones.
pub(super) trait Record: ReadKeys + Clone + PartialEq {
    /// Name of such a value in messages: `the sun`.
    const KIND: &'static str;

    /// Documentation of the type.
    fn doc() -> String;

    /// Keys that stand in examples, with how each is written.
    fn examples(base: Option<&Self>) -> Vec<(&'static str, String)>;

    /// Descriptions of the keys.
    fn describe_keys(base: Option<&Self>, book: &mut Book) -> Vec<SchemaKey>;

    /// Reads the keys.
    fn decode_keys<'a>(fields: &Fields<'a>, base: Option<&Self>, reader: &mut Reader<'a>) -> Self;

    /// Appends the keys that differ from their defaults.
    fn encode_keys(&self, base: Option<&Self>, items: &mut Vec<Item>);

    /// Visits the leaves of the values.
    fn visit_keys<'a>(&'a self, walk: &mut Walk<'_, 'a>);

    /// Serializes the keys that differ from their defaults.
    fn serialize_keys<S: serde::ser::SerializeStruct>(
        &self,
        base: Option<&Self>,
        out: &mut S,
    ) -> Result<(), S::Error>;
}

impl<T: Record> Decode for T {
    fn expected() -> Cow<'static, str> {
        T::KIND.into()
    }

    fn example() -> String {
        example_of_keys(&T::examples(None))
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        book.describe(T::NAME, |book| describe::record(&T::doc(), T::describe_keys(None, book)))
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match Fields::of_record(node, T::NAME, T::KIND, T::KEYS) {
            Some(fields) => {
                fields.refuse_others(reader);
                T::decode_keys(&fields, None, reader)
            }
            None => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        T::start()
    }
}

impl<T: Record> Encode for T {
    fn encode(&self) -> Text {
        let mut items = Vec::new();
        self.encode_keys(None, &mut items);
        Text::record("", items)
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        self.visit_keys(walk);
    }
}

/// Adds how a key is written: required keys, and those with an example of their own.
pub(super) fn add_example<T: Decode>(
    examples: &mut Vec<(&'static str, String)>,
    name: &'static str,
    has_default: bool,
    example: Option<&'static str>,
) {
    match example {
        Some(example) => examples.push((name, example.to_owned())),
        None if !has_default => examples.push((name, T::example())),
        None => {}
    }
}

/// `(zenith_deg: 30.0)` from keys and examples.
pub(super) fn example_of_keys(keys: &[(&'static str, String)]) -> String {
    let keys: Vec<_> = keys.iter().map(|(name, example)| format!("{name}: {example}")).collect();
    format!("({})", keys.join(", "))
}

/// Number of keys in all parts.
pub(super) const fn count(parts: &[&[&str]]) -> usize {
    let (mut sum, mut part) = (0, 0);
    while part < parts.len() {
        sum += parts[part].len();
        part += 1;
    }
    sum
}

/// Keys of all parts, one after the other; `N` is [`count`].
pub(super) const fn join<const N: usize>(parts: &[&[&'static str]]) -> [&'static str; N] {
    let mut keys = [""; N];
    let (mut at, mut part) = (0, 0);
    while part < parts.len() {
        let mut index = 0;
        while index < parts[part].len() {
            keys[at] = parts[part][index];
            at += 1;
            index += 1;
        }
        part += 1;
    }
    keys
}

/// Position of a variant among all of its type.
pub(super) fn variant_index(variants: &[&str], name: &str) -> u32 {
    variants.iter().position(|variant| *variant == name).unwrap_or(0) as u32
}

/// Serializes a record as a struct.
pub(super) fn serialize_record<T: Record, S: Serializer>(
    record: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut out = serializer.serialize_struct(T::NAME, T::KEYS.len())?;
    record.serialize_keys(None, &mut out)?;
    out.end()
}

/// Deserializes keys from a struct.
pub(super) fn deserialize_keys<'de, T: ReadKeys, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    deserializer.deserialize_struct(T::NAME, T::KEYS, KeysVisitor(PhantomData))
}

/// Deserializes the keys of a variant, whose name may stand alone if all keys have defaults.
pub(super) fn deserialize_variant<'de, T: ReadKeys, A: VariantAccess<'de>>(
    access: A,
) -> Result<T, A::Error> {
    let is_written = Cell::new(false);
    let seed = KeysSeed { is_written: &is_written, keys: PhantomData };
    match access.newtype_variant_seed(seed) {
        Err(_no_parentheses) if !is_written.get() && T::missing(&[]).is_none() => Ok(T::start()),
        other => other,
    }
}

/// Deserializes keys, and notes that there is something to read them from.
struct KeysSeed<'a, T> {
    is_written: &'a Cell<bool>,
    keys: PhantomData<T>,
}

impl<'de, T: ReadKeys> DeserializeSeed<'de> for KeysSeed<'_, T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error> {
        self.is_written.set(true);
        deserialize_keys(deserializer)
    }
}

struct KeysVisitor<T>(PhantomData<T>);

impl<'de, T: ReadKeys> Visitor<'de> for KeysVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the keys of `{}`", T::NAME)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<T, A::Error> {
        let mut value = T::start();
        let mut read: Vec<String> = Vec::new();
        while let Some(Identifier(name)) = map.next_key()? {
            if read.contains(&name) {
                return Err(de::Error::custom(format!("the key `{name}` is given twice")));
            }
            if !value.read_key(&name, &mut map)? {
                return Err(de::Error::unknown_field(&name, T::KEYS));
            }
            read.push(name);
        }
        match T::missing(&read) {
            Some(name) => Err(de::Error::missing_field(name)),
            None => Ok(value),
        }
    }
}

/// Name of a key or of a variant.
pub(super) struct Identifier(pub(super) String);

impl<'de> Deserialize<'de> for Identifier {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_identifier(IdentifierVisitor)
    }
}

struct IdentifierVisitor;

impl Visitor<'_> for IdentifierVisitor {
    type Value = Identifier;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Identifier, E> {
        Ok(Identifier(name.to_owned()))
    }
}
