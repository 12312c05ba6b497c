//! `record!`: a type with keys.

/// Keys as serde reads them: for a record, and for the keys of a variant.
macro_rules! read_keys {
    ($name:ident, $shown:expr; { $($field:ident $(as $keys:ident)?: $type:ty $(= $default:expr)?),* }) => {
        impl crate::document::schema::ReadKeys for $name {
            const NAME: &'static str = $shown;
            const KEYS: &'static [&'static str] = {
                const PARTS: &[&[&str]] = &[$(key!(@names $field $(as $keys)?: $type)),*];
                &crate::document::schema::join::<{ crate::document::schema::count(PARTS) }>(PARTS)
            };

            fn start() -> Self {
                Self { $($field: key!(@start $type $(= $default)?)),* }
            }

            fn read_key<'de, A: serde::de::MapAccess<'de>>(
                &mut self,
                name: &str,
                map: &mut A,
            ) -> Result<bool, A::Error> {
                $(key!(@read name, map, self.$field; $field $(as $keys)?: $type);)*
                Ok(false)
            }

            fn missing(read: &[String]) -> Option<&'static str> {
                // A type whose keys all have defaults misses none.
                let _: &[String] = read;
                $(key!(@missing read; $field $(as $keys)?: $type $(= $default)?);)*
                None
            }
        }
    };
}

macro_rules! record {
    ($(#[$meta:meta])* pub struct $name:ident ($kind:literal) {
        $($(#[$field_meta:meta])* $field:ident $(as $keys:ident)? : $type:ty
            $(=> $example:literal)? $(= $default:expr)?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name { $($(#[$field_meta])* pub $field: $type),* }

        constructor!($name; $($field: $type $(= $default)?,)*);

        read_keys!($name, stringify!($name); { $($field $(as $keys)?: $type $(= $default)?),* });

        impl crate::document::schema::Record for $name {
            const KIND: &'static str = $kind;

            fn doc() -> String {
                crate::document::describe::doc(&[$(stringify!($meta)),*])
            }

            fn examples(base: Option<&Self>) -> Vec<(&'static str, String)> {
                let mut out = Vec::new();
                $(key!(
                    @examples out,
                    key!(@default base.map(|base| &base.$field); $type $(= $default)?),
                    key!(@example $($example)?);
                    $field $(as $keys)?: $type
                );)*
                out
            }

            fn describe_keys(
                base: Option<&Self>,
                book: &mut crate::document::describe::Book,
            ) -> Vec<crate::document::describe::SchemaKey> {
                let mut out = Vec::new();
                $(key!(
                    @describe out, book,
                    key!(@default base.map(|base| &base.$field); $type $(= $default)?),
                    key!(@example $($example)?),
                    crate::document::describe::doc(&[$(stringify!($field_meta)),*]);
                    $field $(as $keys)?: $type
                );)*
                out
            }

            fn decode_keys<'a>(
                fields: &crate::document::decode::Fields<'a>,
                base: Option<&Self>,
                reader: &mut crate::document::decode::Reader<'a>,
            ) -> Self {
                Self {
                    $($field: key!(
                        @decode fields, reader,
                        key!(@default base.map(|base| &base.$field); $type $(= $default)?),
                        key!(@example $($example)?);
                        $field $(as $keys)?: $type
                    )),*
                }
            }

            fn encode_keys(
                &self,
                base: Option<&Self>,
                items: &mut Vec<crate::document::ron_text::Item>,
            ) {
                $(key!(
                    @encode items, &self.$field,
                    key!(@default base.map(|base| &base.$field); $type $(= $default)?);
                    $field $(as $keys)?: $type
                );)*
            }

            fn visit_keys<'a>(&'a self, walk: &mut crate::document::leaves::Walk<'_, 'a>) {
                $(key!(@walk walk, &self.$field; $field $(as $keys)?: $type);)*
            }

            fn serialize_keys<S: serde::ser::SerializeStruct>(
                &self,
                base: Option<&Self>,
                out: &mut S,
            ) -> Result<(), S::Error> {
                $(key!(
                    @serialize out, &self.$field,
                    key!(@default base.map(|base| &base.$field); $type $(= $default)?);
                    $field $(as $keys)?: $type
                );)*
                Ok(())
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                crate::document::schema::serialize_record(self, serializer)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                crate::document::schema::deserialize_keys(deserializer)
            }
        }
    };
}
