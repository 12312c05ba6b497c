//! The scene language as a JSON schema, from the same declarations that read and write it.

use serde_json::{Map, Value, json};

use super::decode::Decode;
use super::encode::Encode;
use super::scene::Scene;

/// Descriptions of the language's types, each once.
#[derive(Debug, Default)]
pub(super) struct Book {
    types: Map<String, Value>,
    /// Names of the types, in the order in which they were met.
    order: Vec<String>,
}

impl Book {
    /// A reference to a type, which is described where it is first met.
    pub(super) fn describe(&mut self, name: &str, of: impl FnOnce(&mut Self) -> Value) -> Value {
        if !self.types.contains_key(name) {
            self.order.push(name.to_owned());
            // Types may hold themselves.
            self.types.insert(name.to_owned(), Value::Null);
            let described = of(self);
            self.types.insert(name.to_owned(), described);
        }
        json!({ "$ref": format!("#/$defs/{name}") })
    }
}

/// JSON schema (draft 2020-12) of scene files: every key with its description, which keys must be
/// written, which are known.
///
/// JSON has fewer shapes than RON. A variant `Obj(file: ..)` is `{ "Obj": { "file": .. } }`, `Periodic`
/// alone a string, `(1, 2)` an array; a string `"=expr"` may stand for any number, and `"=name"` of a
/// parameter that is a text for any string.
#[must_use]
pub fn json_schema() -> String {
    let mut book = Book::default();
    let root = Scene::schema(&mut book);
    // A path alone will do.
    if let Some(include) = book.types.get_mut("Include") {
        *include = json!({ "anyOf": [include.take(), { "type": "string" }] });
    }
    let mut schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "sunfleck scene, format 1",
        "$ref": root["$ref"],
        "$defs": book.types,
    });
    leave_out_annotations(&mut schema);
    format!("{schema:#}\n")
}

/// Annotation of records: keys in the order of their declaration, with defaults and examples as RON.
pub(super) const KEYS: &str = "x-keys";

/// Annotation of variants: name, what they hold, an example as RON.
pub(super) const VARIANT: &str = "x-variant";

/// All types of the language with their annotated schemas, in the order in which `Scene` leads to them.
pub(super) fn types() -> Vec<(String, Value)> {
    let mut book = Book::default();
    Scene::schema(&mut book);
    let Book { mut types, order } = book;
    order
        .into_iter()
        .map(|name| {
            let schema = types.get_mut(&name).map_or(Value::Null, Value::take);
            (name, schema)
        })
        .collect()
}

/// All types of the language as JSON: pairs of a name and a schema, in the order in which `Scene` leads to them. Beside
/// what [`json_schema`] says, records have `x-keys`: name, schema, default and example of each key as RON, in the order
/// of their declaration; variants have `x-variant`: name, and `x-keys` or `holds`.
#[must_use]
pub fn types_json() -> String {
    json!(types()).to_string()
}

/// Takes out what is not part of JSON schemas.
fn leave_out_annotations(schema: &mut Value) {
    match schema {
        Value::Object(entries) => {
            entries.remove(KEYS);
            entries.remove(VARIANT);
            entries.values_mut().for_each(leave_out_annotations);
        }
        Value::Array(items) => items.iter_mut().for_each(leave_out_annotations),
        _ => {}
    }
}

/// A key of a record.
pub(super) struct SchemaKey {
    pub(super) name: &'static str,
    pub(super) doc: String,
    pub(super) schema: Value,
    /// Default as RON; none if the key must be written.
    pub(super) default: Option<String>,
    /// Example as RON.
    pub(super) example: Option<String>,
}

impl SchemaKey {
    pub(super) fn new<T: Decode + Encode>(
        name: &'static str,
        doc: String,
        default: Option<T>,
        example: Option<&'static str>,
        book: &mut Book,
    ) -> Self {
        let example = match (example, &default) {
            (Some(example), _) => Some(example.to_owned()),
            (None, Some(_)) => None,
            (None, None) => Some(T::example()),
        };
        let default = default.map(|default| default.encode().into_line());
        Self { name, doc, schema: T::schema(book), default, example }
    }
}

/// A record, or the keys of a variant.
pub(super) fn record(doc: &str, keys: Vec<SchemaKey>) -> Value {
    let required: Vec<_> =
        keys.iter().filter(|key| key.default.is_none()).map(|key| key.name).collect();
    let annotations: Vec<_> = keys
        .iter()
        .map(|SchemaKey { name, doc, schema, default, example }| {
            let schema = with_description(schema.clone(), doc);
            json!({ "name": name, "schema": schema, "default": default, "example": example })
        })
        .collect();
    let properties: Map<String, Value> = keys
        .into_iter()
        .map(|key| (key.name.to_owned(), with_description(key.schema, &key.doc)))
        .collect();
    let mut schema = json!({
        KEYS: annotations,
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    if !doc.is_empty() {
        schema["description"] = doc.into();
    }
    schema
}

/// A variant: its name alone, or its name with what it holds.
pub(super) fn variant(name: &str, doc: &str, holds: Option<Value>, example: &str) -> Value {
    let mut annotation = json!({ "name": name, "example": example });
    let Some(holds) = holds else {
        return with_description(json!({ "const": name, VARIANT: annotation }), doc);
    };
    // Keys of its own, or one value.
    match holds.get(KEYS) {
        Some(keys) => annotation[KEYS] = keys.clone(),
        None => annotation["holds"] = holds.clone(),
    }
    let may_be_bare = holds["required"].as_array().is_some_and(Vec::is_empty);
    let object = json!({
        "type": "object",
        "properties": { name: holds },
        "required": [name],
        "additionalProperties": false,
    });
    let mut schema =
        if may_be_bare { json!({ "anyOf": [object, { "const": name }] }) } else { object };
    schema[VARIANT] = annotation;
    with_description(schema, doc)
}

fn with_description(mut schema: Value, doc: &str) -> Value {
    if let Some(keys) = schema.as_object_mut().filter(|_| !doc.is_empty()) {
        keys.insert("description".to_owned(), doc.into());
    }
    schema
}

/// The text of doc comments, as `stringify!` shows their attributes.
pub(super) fn doc(attributes: &[&str]) -> String {
    let lines = attributes.iter().filter_map(|attribute| {
        let text = attribute.strip_prefix("doc")?;
        let (start, end) = (text.find('"')? + 1, text.rfind('"')?);
        text.get(start..end).map(str::trim)
    });
    lines.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    #[test]
    fn every_reference_of_the_schema_leads_somewhere() {
        fn refs<'a>(schema: &'a Value, found: &mut BTreeSet<&'a str>) {
            match schema {
                Value::Object(keys) => {
                    if let Some(Value::String(reference)) = keys.get("$ref") {
                        found.insert(reference);
                    }
                    for schema in keys.values() {
                        refs(schema, found);
                    }
                }
                Value::Array(items) => {
                    for schema in items {
                        refs(schema, found);
                    }
                }
                _ => {}
            }
        }
        let schema: Value = serde_json::from_str(&super::json_schema()).expect("JSON");
        let mut found = BTreeSet::new();
        refs(&schema, &mut found);
        assert!(found.len() > 20, "{found:?}");
        for reference in found {
            let at = schema.pointer(reference.trim_start_matches('#')).expect(reference);
            assert!(at.is_object(), "{reference}");
        }
        let format = &schema["$defs"]["Scene"]["properties"]["format"];
        assert_eq!(format["description"], "Version of the language; this is version 1.");
        let required = &schema["$defs"]["Scene"]["required"];
        assert_eq!(required, &serde_json::json!(["format", "bands", "terrain", "sensors"]));
    }
}
