//! What a definition is called, and what it names, once it is part of another scene.

use super::super::syntax::{Node, Value};

/// Keys whose strings are names of the scene's own definitions: alone, in a list or as the values of
/// a map.
const NAMES: [&str; 7] =
    ["classes", "leaf_material", "material", "mesh", "of", "parts", "wood_material"];

/// Keys whose strings are patterns of names, one before each slash and one at the end.
const PATTERNS: [&str; 2] = ["hide", "select"];

/// Keys whose strings are paths of files.
const FILES: [&str; 1] = ["file"];

/// Variants whose string is a name of the scene's own definitions.
const NAMING_VARIANTS: [&str; 1] = ["Named"];

/// Keys whose map has such names as its keys, by the variant that they stand in.
const NAMES_AS_KEYS: [(&str, &str); 1] = [("Scatter", "of")];

/// Whether the strings of a key are names or paths.
#[cfg(test)]
pub(in super::super) fn is_reference(key: &str) -> bool {
    Role::of_key(key) != Role::Plain || NAMING_VARIANTS.contains(&key)
}

/// What a string stands for.
#[derive(Clone, Copy, PartialEq)]
pub(in super::super) enum Role {
    Plain,
    Name,
    /// The keys of a map are names.
    Keys,
    Pattern,
    File,
}

impl Role {
    /// What the strings of a key stand for.
    pub(in super::super) fn of_key(key: &str) -> Self {
        if NAMES.contains(&key) {
            Self::Name
        } else if PATTERNS.contains(&key) {
            Self::Pattern
        } else if FILES.contains(&key) {
            Self::File
        } else {
            Self::Plain
        }
    }

    /// What the strings of a node stand for that has this role by its key.
    pub(in super::super) fn within(self, mut node: &Node) -> Self {
        while let Value::Named(named) = &node.value {
            if NAMING_VARIANTS.contains(&named.name.as_str()) {
                return Self::Name;
            }
            match named.body.as_ref().map(|body| (body, &body.value)) {
                Some((_, Value::Tuple(items))) if items.len() == 1 => node = &items[0],
                _ => break,
            }
        }
        self
    }

    /// Puts the namespace of a file before a name, and its folder before a path.
    pub(in super::super) fn qualify(self, text: &mut String, namespace: &str, folder: &str) {
        match self {
            Self::Plain | Self::Keys => {}
            Self::Name => text.insert_str(0, namespace),
            Self::Pattern => {
                let names = text.split('/').map(|name| format!("{namespace}{name}"));
                *text = names.collect::<Vec<_>>().join("/");
            }
            Self::File if std::path::Path::new(text.as_str()).is_absolute() => {}
            Self::File => text.insert_str(0, folder),
        }
    }
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
                with.walk(&mut field.value, Role::of_key(key));
            }
        }
    }
}

struct Qualify<'a> {
    namespace: &'a str,
    folder: &'a str,
}

impl Qualify<'_> {
    fn text(&self, node: &mut Node, role: Role) {
        if let Value::Text(text) = &mut node.value {
            role.qualify(text, self.namespace, self.folder);
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
                    self.walk(&mut field.value, Role::of_key(&field.name));
                }
            }
            Value::Map(map) => {
                for (key, value) in map.iter_mut() {
                    if own == Role::Keys {
                        self.text(key, Role::Name);
                    }
                    self.walk(value, own);
                }
            }
            Value::Named(named) => {
                let name = named.name.as_str();
                let role = if NAMING_VARIANTS.contains(&name) { Role::Name } else { own };
                match named.body.as_mut().map(|body| &mut body.value) {
                    Some(Value::Record(fields)) => {
                        for field in fields {
                            let has_keys = NAMES_AS_KEYS.contains(&(name, field.name.as_str()));
                            let role =
                                if has_keys { Role::Keys } else { Role::of_key(&field.name) };
                            self.walk(&mut field.value, role);
                        }
                    }
                    Some(_) => {
                        if let Some(body) = &mut named.body {
                            self.walk(body, role);
                        }
                    }
                    None => {}
                }
            }
            _ => {}
        }
    }
}
