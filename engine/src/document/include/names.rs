//! Names of the definitions of an included file, once they are part of another scene.
//!
//! References and paths are completed where they are read (`scene/reference.rs`).

use super::super::ron_text::{Node, Value};

/// Puts a namespace before the name of everything that a file defines, and of the parameters that its
/// variants and its sweep change: the keys of its maps.
pub(super) fn qualify(file: &mut Node, namespace: &str) {
    let Some(fields) = super::fields(file) else { return };
    for field in fields {
        match (&mut field.value.value, field.name.as_str()) {
            (Value::Map(definitions), key) => {
                for (name, value) in definitions {
                    put_before(name, namespace);
                    if key == "variants" {
                        qualify_keys(value, namespace);
                    }
                }
            }
            (Value::Named(sweep), "sweep") => {
                if let Some(Value::Tuple(axes)) = sweep.body.as_mut().map(|body| &mut body.value) {
                    for axes in axes {
                        qualify_keys(axes, namespace);
                        qualify_items(axes, namespace);
                    }
                }
            }
            _ => {}
        }
    }
}

fn qualify_keys(map: &mut Node, namespace: &str) {
    if let Value::Map(entries) = &mut map.value {
        for (name, _) in entries {
            put_before(name, namespace);
        }
    }
}

/// Puts a namespace before the texts of a list.
fn qualify_items(list: &mut Node, namespace: &str) {
    if let Value::List(items) = &mut list.value {
        for name in items {
            put_before(name, namespace);
        }
    }
}

fn put_before(name: &mut Node, namespace: &str) {
    if let Value::Text(name) = &mut name.value {
        name.insert_str(0, namespace);
    }
}
