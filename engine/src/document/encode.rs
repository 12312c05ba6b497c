//! Types to text that the reader reads back as equal.
//!
//! The `ron` crate reads and writes these types too, through serde (`engine/tests/language/writing.rs` compares the two).
//! Scenes that people go on with are written here: keys with their default are left out, short values stay on one
//! line, definitions are in the order of the language, and numbers have no more digits than they need.

use indexmap::IndexMap;

use super::decode::MapKey;
use super::leaves::{LeafValue, Walk};
use super::path::Step;
use super::ron_text::{Item, Text, quoted};

/// A type that can be written.
pub(super) trait Encode {
    fn encode(&self) -> Text;

    /// Visits the leaves in it.
    fn visit<'a>(&'a self, _: &mut Walk<'_, 'a>) {}
}

impl Encode for f64 {
    fn encode(&self) -> Text {
        // The shortest decimal that is read back as the same number.
        Text::Leaf(format!("{self:?}"))
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        walk.leaf(LeafValue::Number(*self));
    }
}

impl Encode for u32 {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for u64 {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for bool {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for String {
    fn encode(&self) -> Text {
        Text::Leaf(quoted(self, false))
    }
}

impl<T: Encode> Encode for Option<T> {
    fn encode(&self) -> Text {
        self.as_ref().map_or_else(|| Text::Leaf("None".to_owned()), T::encode)
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        if let Some(value) = self {
            value.visit(walk);
        }
    }
}

impl<T: Encode> Encode for Vec<T> {
    fn encode(&self) -> Text {
        let items = self.iter().map(|item| Item::new(None, String::new(), item.encode())).collect();
        Text::group("[".to_owned(), items, "]")
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        for (index, item) in self.iter().enumerate() {
            walk.below(Step::Index(index), item);
        }
    }
}

impl<K: MapKey, T: Encode> Encode for IndexMap<K, T> {
    fn encode(&self) -> Text {
        let entry = |(key, value): (&K, &T)| {
            let key = key.as_name();
            Item::new(Some(Step::Name(key.to_owned())), quoted(key, true) + ": ", value.encode())
        };
        Text::group("{".to_owned(), self.iter().map(entry).collect(), "}")
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        for (key, value) in self {
            walk.key(key.as_name(), key.leaf());
            walk.below(Step::Name(key.as_name().to_owned()), value);
        }
    }
}

macro_rules! encode_tuple {
    ($($type:ident $index:tt),*) => {
        impl<$($type: Encode),*> Encode for ($($type,)*) {
            fn encode(&self) -> Text {
                Text::record("", vec![$(Item::new(None, String::new(), self.$index.encode())),*])
            }

            fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
                $(walk.below(Step::Index($index), &self.$index);)*
            }
        }
    };
}

encode_tuple!(A 0, B 1);
encode_tuple!(A 0, B 1, C 2);
