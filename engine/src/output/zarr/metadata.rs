//! JSON documents of a store.

use std::io;

use serde_json::{Map, Value, json};

use super::super::dataset::{Attribute, Attributes, Dataset, ValueType, Variable};
use super::chunks::{Chunking, LEVEL};

/// Name of a document in the store, and the document.
type NamedDocument = (String, Value);

/// Documents of the store itself.
pub(super) fn of_group(dataset: &Dataset<'_>) -> Vec<NamedDocument> {
    vec![
        (".zgroup".to_owned(), json!({ "zarr_format": 2 })),
        (".zattrs".to_owned(), Value::Object(attributes(&dataset.attributes))),
    ]
}

/// Documents of an array.
pub(super) fn of_array(
    variable: &Variable<'_>,
    dataset: &Dataset<'_>,
    chunking: &Chunking,
) -> [NamedDocument; 2] {
    let data_type = match variable.values.value_type() {
        ValueType::Float => "<f4".to_owned(),
        ValueType::Double => "<f8".to_owned(),
        ValueType::Integer => "<i4".to_owned(),
        ValueType::Text { letters, .. } => format!("<U{letters}"),
    };
    let array = json!({
        "zarr_format": 2,
        "shape": chunking.shape(),
        "chunks": chunking.chunk(),
        "dtype": data_type,
        "compressor": { "id": "zlib", "level": LEVEL },
        "fill_value": if variable.has_fill { json!("NaN") } else { Value::Null },
        "order": "C",
        "filters": null,
    });
    let mut own = attributes(&variable.attributes);
    let names = variable.dimensions.iter().map(|&place| dataset.dimensions[place].name.as_str());
    own.insert("_ARRAY_DIMENSIONS".to_owned(), names.collect());
    if let Some(system) = system(variable, dataset) {
        own.insert("_CRS".to_owned(), system);
    }
    let name = &variable.name;
    [(format!("{name}/.zarray"), array), (format!("{name}/.zattrs"), Value::Object(own))]
}

/// All documents as one.
pub(super) fn consolidated(documents: Vec<NamedDocument>) -> Value {
    let metadata: Map<String, Value> = documents.into_iter().collect();
    json!({ "zarr_consolidated_format": 1, "metadata": metadata })
}

/// Text of a document.
pub(super) fn text(document: &Value) -> io::Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(document)?;
    text.push(b'\n');
    Ok(text)
}

fn attributes(attributes: &Attributes) -> Map<String, Value> {
    let value = |attribute: &Attribute| match attribute {
        Attribute::Text(text) => json!(text),
        Attribute::Numbers(numbers) => scalar_or_list(numbers),
        Attribute::Floats(numbers) => scalar_or_list(numbers),
    };
    attributes.0.iter().map(|(name, attribute)| (name.clone(), value(attribute))).collect()
}

fn scalar_or_list<T: serde::Serialize>(numbers: &[T]) -> Value {
    match numbers {
        [number] => json!(number),
        all => json!(all),
    }
}

/// The system of a variable with a grid mapping, as GDAL reads it.
fn system(variable: &Variable<'_>, dataset: &Dataset<'_>) -> Option<Value> {
    let text = |variable: &Variable<'_>, name: &str| {
        variable.attributes.0.iter().find_map(|(known, value)| match value {
            Attribute::Text(text) if known == name => Some(text.clone()),
            _ => None,
        })
    };
    let mapping = text(variable, "grid_mapping")?;
    let mapping = dataset.variables.iter().find(|variable| variable.name == mapping)?;
    let mut system = Map::new();
    if let Some(wkt) = text(mapping, "crs_wkt") {
        system.insert("wkt".to_owned(), json!(wkt));
    }
    if let Some(code) = text(mapping, "epsg_code") {
        let code = code.trim_start_matches("EPSG:");
        let url = format!("http://www.opengis.net/def/crs/EPSG/0/{code}");
        system.insert("url".to_owned(), json!(url));
    }
    Some(Value::Object(system))
}
