//! What a definition is called, and what it names, once it is part of another scene.

use super::super::syntax::{Node, Value};

/// Keys whose strings are names of the scene's own definitions: alone, in a list, as the values of
/// a map, or, where those are no strings, as its keys.
const NAMES: [&str; 7] =
    ["classes", "leaf_material", "material", "mesh", "of", "parts", "wood_material"];

/// Keys whose strings are patterns of names, one before each slash and one at the end.
const PATTERNS: [&str; 2] = ["hide", "select"];

/// Keys whose strings are paths of files.
const FILES: [&str; 1] = ["file"];

/// Variants whose string is a name of the scene's own definitions.
const NAMING_VARIANTS: [&str; 1] = ["Named"];

/// Whether the strings of a key are names or paths.
#[cfg(test)]
pub(in super::super) fn is_reference(key: &str) -> bool {
    role(key) != Role::Plain || NAMING_VARIANTS.contains(&key)
}

/// What a string stands for.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Plain,
    Name,
    Pattern,
    File,
}

/// Puts the namespace before every name that a file defines or uses, and the folder before every
/// path in it.
pub(super) fn qualify(file: &mut Node, namespace: &str, folder: &str) {
    let with = Qualify { namespace, folder };
    let Some(fields) = super::fields(file) else { return };
    for field in fields {
        match (&mut field.value.value, field.name.as_str()) {
            (Value::Map(map), key) => {
                for (name, value) in map {
                    with.text(name, Role::Name);
                    match (&mut value.value, key) {
                        // What a variant changes are parameters.
                        (Value::Map(changes), "variants") => {
                            for (name, _) in changes {
                                with.text(name, Role::Name);
                            }
                        }
                        _ => with.walk(value, Role::Plain),
                    }
                }
            }
            (Value::Named(sweep), "sweep") => {
                if let Some(body) = &mut sweep.body
                    && let Value::Tuple(items) = &mut body.value
                {
                    for item in items {
                        with.keys(item);
                    }
                }
            }
            (value, key) => {
                if let (Value::List(items), "instances") = (value, key) {
                    for instances in items {
                        with.own_name(instances);
                    }
                }
                with.walk(&mut field.value, role(key));
            }
        }
    }
}

fn role(key: &str) -> Role {
    if NAMES.contains(&key) {
        Role::Name
    } else if PATTERNS.contains(&key) {
        Role::Pattern
    } else if FILES.contains(&key) {
        Role::File
    } else {
        Role::Plain
    }
}

struct Qualify<'a> {
    namespace: &'a str,
    folder: &'a str,
}

impl Qualify<'_> {
    fn text(&self, node: &mut Node, role: Role) {
        let Value::Text(text) = &mut node.value else { return };
        match role {
            Role::Plain => {}
            Role::Name => text.insert_str(0, self.namespace),
            Role::Pattern => {
                let names = text.split('/').map(|name| format!("{}{name}", self.namespace));
                *text = names.collect::<Vec<_>>().join("/");
            }
            Role::File if std::path::Path::new(text.as_str()).is_absolute() => {}
            Role::File => text.insert_str(0, self.folder),
        }
    }

    /// The name of instances.
    fn own_name(&self, instances: &mut Node) {
        let Value::Named(variant) = &mut instances.value else { return };
        let Some(Value::Record(fields)) = variant.body.as_mut().map(|body| &mut body.value) else {
            return;
        };
        for field in fields.iter_mut().filter(|field| field.name == "name") {
            self.text(&mut field.value, Role::Name);
        }
    }

    fn keys(&self, node: &mut Node) {
        if let Value::Map(map) = &mut node.value {
            for (key, _) in map {
                self.text(key, Role::Name);
            }
        }
    }

    fn walk(&self, node: &mut Node, own: Role) {
        match &mut node.value {
            Value::Text(_) => self.text(node, own),
            Value::List(items) | Value::Tuple(items) => {
                for item in items {
                    self.walk(item, own);
                }
            }
            Value::Record(fields) => {
                for field in fields {
                    self.walk(&mut field.value, role(&field.name));
                }
            }
            Value::Map(map) => {
                let texts = map.iter().all(|(_, value)| matches!(value.value, Value::Text(_)));
                for (key, value) in map.iter_mut() {
                    if !texts {
                        self.text(key, own);
                    }
                    self.walk(value, own);
                }
            }
            Value::Named(named) => {
                let role =
                    if NAMING_VARIANTS.contains(&named.name.as_str()) { Role::Name } else { own };
                if let Some(body) = &mut named.body {
                    self.walk(body, role);
                }
            }
            _ => {}
        }
    }
}
