//! Strings that mean something beyond themselves: names of definitions and paths of files.
//!
//! In an included file they are relative to it. Reading puts the namespace of the file before its names and the
//! folder of the file before its paths, so that no later stage knows of files.

use std::borrow::Cow;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::ops::Deref;
use std::path::Path;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::super::decode::{Decode, MapKey, Reader};
use super::super::describe::Book;
use super::super::encode::Encode;
use super::super::leaves::{LeafValue, Target, Walk};
use super::super::ron_text::{Node, Text};
use super::{Map, Material, Prototype, Scene, Spectrum};

/// A type whose values the scene defines by name.
pub trait Definition: Sized + 'static {
    /// Name of such a definition in messages: `material`.
    const KIND: &'static str;
    /// Key of the scene that holds the definitions: `materials`.
    const KEY: &'static str;

    /// All definitions of a scene.
    fn all(scene: &Scene) -> &Map<Self>;
}

macro_rules! definition {
    ($($type:ty: $kind:literal, $key:ident;)*) => {
        $(impl Definition for $type {
            const KIND: &'static str = $kind;
            const KEY: &'static str = stringify!($key);

            fn all(scene: &Scene) -> &Map<Self> {
                &scene.$key
            }
        })*
    };
}

definition! {
    Material: "material", materials;
    Prototype: "mesh", meshes;
    Spectrum: "spectrum", spectra;
}

fn target<T: Definition>() -> Target {
    Target {
        kind: T::KIND,
        key: T::KEY,
        is_defined: |scene, name| T::all(scene).contains_key(name),
        names: |scene| T::all(scene).keys().map(String::as_str).collect(),
    }
}

/// Name of a definition of the scene.
pub struct Ref<T> {
    name: String,
    definition: PhantomData<fn() -> T>,
}

impl<T> Ref<T> {
    /// The name.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.name
    }
}

impl<T: Definition> Ref<T> {
    /// The definition in a scene, if there is one.
    #[must_use]
    pub fn find<'s>(&self, scene: &'s Scene) -> Option<&'s T> {
        T::all(scene).get(&self.name)
    }
}

impl<T> Clone for Ref<T> {
    fn clone(&self) -> Self {
        self.name.clone().into()
    }
}

impl<T> fmt::Debug for Ref<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.name, f)
    }
}

impl<T> fmt::Display for Ref<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

impl<T> PartialEq for Ref<T> {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl<T> Eq for Ref<T> {}

impl<T> PartialEq<str> for Ref<T> {
    fn eq(&self, other: &str) -> bool {
        self.name == other
    }
}

impl<T> PartialEq<&str> for Ref<T> {
    fn eq(&self, other: &&str) -> bool {
        self.name == *other
    }
}

impl<T> Hash for Ref<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl<T> Deref for Ref<T> {
    type Target = str;

    fn deref(&self) -> &str {
        &self.name
    }
}

impl<T> From<String> for Ref<T> {
    fn from(name: String) -> Self {
        Self { name, definition: PhantomData }
    }
}

impl<T> From<&str> for Ref<T> {
    fn from(name: &str) -> Self {
        name.to_owned().into()
    }
}

impl<T> Serialize for Ref<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name)
    }
}

impl<'de, T> Deserialize<'de> for Ref<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(Self::from)
    }
}

impl<T: Definition> MapKey for Ref<T> {
    fn of_node(name: &str, node: &Node, reader: &Reader<'_>) -> Self {
        format!("{}{name}", reader.namespace(node)).into()
    }

    fn as_name(&self) -> &str {
        &self.name
    }

    fn leaf(&self) -> Option<LeafValue<'_>> {
        Some(LeafValue::Reference { target: target::<T>(), name: &self.name })
    }
}

/// A string that reading completes by the file that it stands in.
macro_rules! qualified {
    ($(#[$meta:meta])* $name:ident, |$text:ident, $node:ident, $reader:ident| $qualify:expr, |$value:ident| $leaf:expr) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(String);

        impl Deref for $name {
            type Target = str;

            fn deref(&self) -> &str {
                &self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&self.0)
            }
        }

        impl From<String> for $name {
            fn from(text: String) -> Self {
                Self(text)
            }
        }

        impl From<&str> for $name {
            fn from(text: &str) -> Self {
                Self(text.to_owned())
            }
        }

        impl PartialEq<str> for $name {
            fn eq(&self, other: &str) -> bool {
                self.0 == other
            }
        }

        impl PartialEq<&str> for $name {
            fn eq(&self, other: &&str) -> bool {
                self.0 == *other
            }
        }

        string!($name[], |$text, $node, $reader| $qualify, |$value| $leaf);
    };
}

/// Implements reading, writing and visiting of a string type.
macro_rules! string {
    ($name:ty[$($generics:tt)*], |$text:ident, $node:ident, $reader:ident| $qualify:expr, |$value:ident| $leaf:expr) => {
        impl $($generics)* Decode for $name {
            fn expected() -> Cow<'static, str> {
                String::expected()
            }

            fn example() -> String {
                <String as Decode>::example()
            }

            fn schema(book: &mut Book) -> serde_json::Value {
                String::schema(book)
            }

            fn decode<'a>($node: &'a Node, $reader: &mut Reader<'a>) -> Self {
                let $text = String::decode($node, $reader);
                Self::from($qualify)
            }

            fn placeholder() -> Self {
                Self::from(String::new())
            }
        }

        impl $($generics)* Encode for $name {
            fn encode(&self) -> Text {
                (**self).to_owned().encode()
            }

            fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
                let $value: &'a Self = self;
                let leaf: Option<LeafValue<'a>> = $leaf;
                if let Some(leaf) = leaf {
                    walk.leaf(leaf);
                }
            }
        }
    };
}

string!(
    Ref<T>[<T: Definition>],
    |name, node, reader| reader.namespace(node).to_owned() + &name,
    |value| Some(LeafValue::Reference { target: target::<T>(), name: value })
);

qualified!(
    /// Path of a file, relative to the folder of the scene file unless it is absolute.
    FilePath,
    |path, node, reader| if Path::new(&path).is_absolute() {
        path
    } else {
        reader.folder(node).to_owned() + &path
    },
    |value| Some(LeafValue::File(value))
);

impl AsRef<Path> for FilePath {
    fn as_ref(&self) -> &Path {
        self.0.as_ref()
    }
}

qualified!(
    /// Name that instances give themselves.
    InstancesName,
    |name, node, reader| reader.namespace(node).to_owned() + &name,
    |_value| None
);

qualified!(
    /// Pattern for names of instances and meshes, such as `plot 7/*`.
    NamePattern,
    |pattern, node, reader| {
        let namespace = reader.namespace(node);
        let names: Vec<_> = pattern.split('/').map(|name| format!("{namespace}{name}")).collect();
        names.join("/")
    },
    |_value| None
);
