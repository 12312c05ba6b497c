//! Criteria that end a measurement.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::super::decode::{Decode, Reader};
use super::super::describe::Book;
use super::super::encode::Encode;
use super::super::leaves::Walk;
use super::super::ron_text::{Node, Text, Value};
use super::Map;

choice! {
    /// Criteria that end a measurement.
    pub enum StopCriterion ("an end of the measurement") {
        /// The median relative standard error of each product that the sensor reports is at most this;
        /// of an image it is that of its pixels.
        RelError(f64 => "0.005"),
        /// The median relative standard error of each of these products is at most this: names as in `summary.json`.
        RelErrors(Map<f64> => "{ \"brf\": 0.005 }"),
        /// It has run for this number of seconds.
        Seconds(f64 => "60.0"),
        /// Samples per pixel or direction; of `Photons`, the number of packets.
        Samples(u64 => "1000"),
    }
}

/// Ends of a measurement, one or a list: the first that holds ends it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "OneOrMany", into = "OneOrMany")]
pub struct Ends(pub Vec<StopCriterion>);

/// Form of [`Ends`] in files.
#[derive(Clone, Serialize, Deserialize)]
#[serde(untagged)]
enum OneOrMany {
    One(StopCriterion),
    Many(Vec<StopCriterion>),
}

impl From<OneOrMany> for Ends {
    fn from(ends: OneOrMany) -> Self {
        match ends {
            OneOrMany::One(end) => end.into(),
            OneOrMany::Many(ends) => Self(ends),
        }
    }
}

impl From<Ends> for OneOrMany {
    fn from(ends: Ends) -> Self {
        match <[StopCriterion; 1]>::try_from(ends.0) {
            Ok([end]) => Self::One(end),
            Err(ends) => Self::Many(ends),
        }
    }
}

impl From<StopCriterion> for Ends {
    fn from(end: StopCriterion) -> Self {
        Self(vec![end])
    }
}

impl Decode for Ends {
    fn expected() -> Cow<'static, str> {
        "an end of the measurement or a list of them".into()
    }

    fn example() -> String {
        StopCriterion::example()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [StopCriterion::schema(book), Vec::<StopCriterion>::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::List(_) => Self(Vec::decode(node, reader)),
            _ => StopCriterion::decode(node, reader).into(),
        }
    }

    fn placeholder() -> Self {
        StopCriterion::placeholder().into()
    }
}

impl Encode for Ends {
    fn encode(&self) -> Text {
        match self.0.as_slice() {
            [end] => end.encode(),
            _ => self.0.encode(),
        }
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        match self.0.as_slice() {
            [end] => end.visit(walk),
            _ => self.0.visit(walk),
        }
    }
}
