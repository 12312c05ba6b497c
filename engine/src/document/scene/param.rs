//! Values of parameters.

use std::borrow::Cow;
use std::fmt;

use super::super::decode::{Decode, Reader};
use super::super::describe::Book;
use super::super::encode::Encode;
use super::super::ron_text::{Node, Text, Value};

/// Value of a parameter: a number, or a text that names a file, a material or a mesh, say.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Param {
    /// Number, for formulas.
    Number(f64),
    /// Text, in the place of a string: `file: "=leaf_file"`.
    Text(String),
}

impl Param {
    /// The number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Text(_) => None,
        }
    }

    /// Returns whether it can be used: numbers must be finite.
    #[must_use]
    pub fn is_lawful(&self) -> bool {
        self.number().is_none_or(f64::is_finite)
    }

    /// The value as another of the same kind, if it can be one: texts that are numbers, and numbers
    /// where texts are meant.
    #[must_use]
    pub fn like(&self, other: &Self) -> Option<Self> {
        match (self, other) {
            (Self::Text(text), Self::Number(_)) => {
                text.trim().parse().ok().filter(|number: &f64| number.is_finite()).map(Self::Number)
            }
            (Self::Number(number), Self::Text(_)) => Some(Self::Text(number.to_string())),
            _ => Some(self.clone()),
        }
    }
}

impl From<f64> for Param {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Param {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// Form of the value on the command line.
impl fmt::Display for Param {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl Decode for Param {
    fn expected() -> Cow<'static, str> {
        "a number or a string".into()
    }

    fn example() -> String {
        "1.0".to_owned()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [f64::schema(book), String::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::Text(text) => Self::Text(text.clone()),
            Value::Formula(_) => match reader.computed(node) {
                Some(value) => value.clone(),
                None => reader.mismatch(node),
            },
            Value::Integer { .. } | Value::Float(_) => Self::Number(f64::decode(node, reader)),
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        Self::Number(0.0)
    }
}

impl Encode for Param {
    fn encode(&self) -> Text {
        match self {
            Self::Number(number) => number.encode(),
            Self::Text(text) => text.encode(),
        }
    }
}
