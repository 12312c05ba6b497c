//! Numbers, strings, lists, maps and tuples.

use std::borrow::Cow;
use std::hash::Hash;

use indexmap::IndexMap;
use serde_json::json;

use super::super::describe::Book;
use super::super::leaves::LeafValue;
use super::super::path::Step;
use super::super::ron_text::{Node, Value, decimal_advice};
use super::super::scene::Param;
use super::{Decode, Reader};

impl Decode for f64 {
    fn expected() -> Cow<'static, str> {
        "a number".into()
    }

    fn example() -> String {
        "1.0".to_owned()
    }

    fn schema(_: &mut Book) -> serde_json::Value {
        json!({ "anyOf": [{ "type": "number" }, { "type": "string", "pattern": "^=" }] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match node.value {
            Value::Float(value) => value,
            Value::Formula(_) => match reader.computed(node).and_then(Param::number) {
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

/// Returns whether a float is a whole number that it holds exactly.
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

            fn schema(_: &mut Book) -> serde_json::Value {
            json!({ "anyOf": [{ "type": "integer", "minimum": 0 }, { "type": "string", "pattern": "^=" }] })
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
                    _ => match reader.computed(node).and_then(Param::number) {
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

    fn schema(_: &mut Book) -> serde_json::Value {
        json!({ "type": "boolean" })
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

    fn schema(_: &mut Book) -> serde_json::Value {
        json!({ "type": "string" })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::Text(text) => text.clone(),
            // Where formulas have no place, the sign is part of the text.
            Value::Formula(text) if !reader.computed.contains_key(&node.span.start) => {
                format!("={text}")
            }
            Value::Formula(_) => match reader.computed(node) {
                Some(Param::Text(text)) => text.clone(),
                _ => reader.mismatch(node),
            },
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

    fn schema(book: &mut Book) -> serde_json::Value {
        json!({ "anyOf": [T::schema(book), { "const": "None" }] })
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

    fn schema(book: &mut Book) -> serde_json::Value {
        json!({ "type": "array", "items": T::schema(book) })
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

/// Key of a map.
pub(in super::super) trait MapKey: Hash + Eq + Sized {
    /// The key that is written as this name.
    fn of_node(name: &str, node: &Node, reader: &Reader<'_>) -> Self;

    /// The key as a name.
    fn as_name(&self) -> &str;

    /// The number, file or reference that the key holds, if it is one of these.
    fn leaf(&self) -> Option<LeafValue<'_>> {
        None
    }
}

impl MapKey for String {
    fn of_node(name: &str, _: &Node, _: &Reader<'_>) -> Self {
        name.to_owned()
    }

    fn as_name(&self) -> &str {
        self
    }
}

impl<K: MapKey, T: Decode> Decode for IndexMap<K, T> {
    fn expected() -> Cow<'static, str> {
        "a map `{..}`".into()
    }

    fn example() -> String {
        format!("{{ \"name\": {} }}", T::example())
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        json!({ "type": "object", "additionalProperties": T::schema(book) })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        let Value::Map(entries) = &node.value else { return reader.mismatch(node) };
        let mut map = Self::with_capacity(entries.len());
        for (key, value) in entries {
            let Value::Text(name) = &key.value else {
                match &key.value {
                    Value::Named(named) if named.body.is_none() => {
                        let message = format!("the key `{}` of a map needs quotes", named.name);
                        let help = format!("write `\"{}\": ..`", named.name);
                        reader.error(key.span, message, Some(help));
                    }
                    _ => {
                        reader.mismatch::<String>(key);
                    }
                }
                continue;
            };
            let value = reader.within(Step::Name(name.clone()), |reader| T::decode(value, reader));
            map.insert(K::of_node(name, key, reader), value);
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
            const IS_TUPLE: bool = true;

            fn expected() -> Cow<'static, str> {
                concat!(stringify!($count), " values in parentheses").into()
            }

            fn example() -> String {
                format!("({})", [$($type::example()),*].join(", "))
            }

            fn schema(book: &mut Book) -> serde_json::Value {
            json!({
                    "type": "array",
                    "prefixItems": [$($type::schema(book)),*],
                    "minItems": $count,
                    "maxItems": $count,
                })
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
                        let text = reader.text();
                        let comma = items.iter().find_map(|item| {
                            decimal_advice(text, item.span.start as usize)
                        });
                        let help = comma
                            .filter(|_| items.len() > $count)
                            .unwrap_or_else(|| format!("write, for example, `{}`", Self::example()));
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
