//! Our reader beside that of the `ron` crate.

use std::collections::BTreeMap;

use super::{Node, Value, parse};

/// A value of either reader, as far as both tell it.
#[derive(Clone, Debug, PartialEq)]
enum Plain {
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Self>),
    Map(BTreeMap<String, Self>),
}

fn ours(node: &Node) -> Option<Plain> {
    Some(match &node.value {
        Value::Bool(value) => Plain::Bool(*value),
        Value::Integer { negative, magnitude } => {
            Plain::Number(if *negative { -(*magnitude as f64) } else { *magnitude as f64 })
        }
        Value::Float(value) => Plain::Number(*value),
        Value::Text(text) => Plain::Text(text.clone()),
        Value::Formula(text) => Plain::Text(format!("={text}")),
        Value::List(items) | Value::Tuple(items) => {
            Plain::List(items.iter().map(ours).collect::<Option<_>>()?)
        }
        Value::Record(fields) => {
            let field = |f: &super::Field| Some((f.name.clone(), ours(&f.value)?));
            Plain::Map(fields.iter().map(field).collect::<Option<_>>()?)
        }
        Value::Map(entries) => {
            let entry = |(key, value): &(Node, Node)| Some((key_of(ours(key)?)?, ours(value)?));
            Plain::Map(entries.iter().map(entry).collect::<Option<_>>()?)
        }
        Value::Named(named) => ours(named.body.as_ref()?)?,
        Value::BadNumber(_) => return None,
    })
}

fn key_of(key: Plain) -> Option<String> {
    match key {
        Plain::Text(key) => Some(key),
        _ => None,
    }
}

fn theirs(value: &ron::Value) -> Option<Plain> {
    Some(match value {
        ron::Value::Bool(value) => Plain::Bool(*value),
        ron::Value::Number(number) => Plain::Number(number.into_f64()),
        ron::Value::String(text) => Plain::Text(text.clone()),
        ron::Value::Seq(items) => Plain::List(items.iter().map(theirs).collect::<Option<_>>()?),
        ron::Value::Map(entries) => {
            let entry = |(key, value): (&ron::Value, &ron::Value)| {
                Some((key_of(theirs(key)?)?, theirs(value)?))
            };
            Plain::Map(entries.iter().map(entry).collect::<Option<_>>()?)
        }
        ron::Value::Unit => Plain::List(Vec::new()),
        _ => return None,
    })
}

#[test]
fn both_readers_agree_on_what_is_ron_and_what_it_says() {
    let both = [
        "1",
        "-1",
        "+1",
        "1_000",
        "0x1f",
        "0xAB_CD",
        "0o17",
        "0b101",
        "1.5",
        "-1.5e-3",
        ".5",
        "1.",
        "1e3",
        "2.5E+2",
        "18446744073709551615",
        "true",
        "false",
        r#""""#,
        r#""a\"b\\c\n\r\t\0\x41\u{e9}\u{1F332}""#,
        "r\"raw \\n\"",
        "r#\"a \"quoted\" one\"#",
        "r##\"a \"# b\"##",
        "\"two\nlines\"",
        "[]",
        "[1, 2, 3]",
        "[1, 2, 3,]",
        "(1, 2)",
        "(1, \"a\", [true],)",
        "(a: 1, b: (c: 2))",
        "Name(a: 1, _b2: 2,)",
        "{}",
        "{\"a\": 1, \"b\": [2]}",
        "// comment\n1 // after",
        "/* a /* nested */ b */ 1",
        "()",
        "  [ 1 ,\t2 ]\r\n",
        "\"=formula\"",
        "(r#type: 1)",
        "[\"ä\", \"\u{1F332}\"]",
        "#![enable(implicit_some)]\n(a: 1)",
    ];
    for text in both {
        let own = parse(text).unwrap_or_else(|error| panic!("{text}: {}", error.message));
        let other: ron::Value =
            ron::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(ours(&own), theirs(&other), "{text}");
    }
    let neither = [
        "",
        "1 2",
        "[1 2]",
        "[1, , 2]",
        "[",
        "(1",
        "{\"a\": 1",
        "{\"a\" 1}",
        "(a: 1, 2)",
        "\"open",
        "1.2.3",
        "0x",
        "0b12",
        "--1",
        "r#\"open\"",
        "/* open",
        "\"\\q\"",
        "\"\\u{110000}\"",
        "[1]]",
        "(,)",
        "@",
        "1e",
        "\"\\x4\"",
    ];
    for text in neither {
        assert!(parse(text).is_err(), "{text}");
        assert!(ron::from_str::<ron::Value>(text).is_err(), "{text}");
    }
}

#[test]
fn every_node_spans_its_own_text() {
    let text = "Scene(a: [1, (x: \"é\")], b: Name, c: { \"k\": -2.5e3 })";
    let tree = parse(text).unwrap_or_else(|error| panic!("{}", error.message));
    let own = |node: &Node| text[node.span.range()].to_owned();
    assert_eq!(own(&tree), text);
    let Value::Record(fields) = &tree.inner().value else { panic!("{tree:?}") };
    let values: Vec<_> = fields.iter().map(|field| own(&field.value)).collect();
    assert_eq!(values, ["[1, (x: \"é\")]", "Name", "{ \"k\": -2.5e3 }"]);
    let names: Vec<_> = fields.iter().map(|field| &text[field.name_span.range()]).collect();
    assert_eq!(names, ["a", "b", "c"]);
}
