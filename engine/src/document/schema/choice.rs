//! `choice!`: a type with variants.

macro_rules! choice {
    ($(#[$meta:meta])* pub enum $name:ident ($kind:literal) {
        $($(#[$variant_meta:meta])* $variant:ident
            $((..$record:ty))?
            $(($tuple:ty $(=> $tuple_example:literal)?))?
            $({ $($(#[$field_meta:meta])* $field:ident : $type:ty
                $(=> $example:literal)? $(= $default:expr)?),* $(,)? })?
        ),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        #[allow(
            clippy::large_enum_variant,
            reason = "a document holds few of them, and programs write them without boxes"
        )]
        pub enum $name {
            $($(#[$variant_meta])* $variant
                $(($record))?
                $(($tuple))?
                $({ $($(#[$field_meta])* $field: $type),* })?
            ),*
        }

        impl $name {
            /// Names of the variants.
            const VARIANTS: &'static [&'static str] = &[$(stringify!($variant)),*];
        }

        impl crate::document::decode::Decode for $name {
            fn expected() -> std::borrow::Cow<'static, str> {
                $kind.into()
            }

            fn example() -> String {
                first_of!($({ variant!(
                    @example $variant $((..$record))? $(($tuple $(=> $tuple_example)?))?
                    $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                ) })*)
            }

            fn schema(book: &mut crate::document::describe::Book) -> serde_json::Value {
                use crate::document::describe::{doc, variant};
                book.describe(stringify!($name), |book| {
                    let variants = vec![$(variant(
                        stringify!($variant),
                        &doc(&[$(stringify!($variant_meta)),*]),
                        variant!(@describe book; $variant $((..$record))? $(($tuple))? $({ $(
                            $(#[$field_meta])* $field: $type $(=> $example)? $(= $default)?
                        ),* })?),
                        &variant!(
                            @example $variant $((..$record))? $(($tuple $(=> $tuple_example)?))?
                            $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                        ),
                    )),*];
                    serde_json::json!({
                        "description": doc(&[$(stringify!($meta)),*]),
                        "anyOf": variants,
                    })
                })
            }

            fn decode<'a>(
                node: &'a crate::document::ron_text::Node,
                reader: &mut crate::document::decode::Reader<'a>,
            ) -> Self {
                let Some(written) = crate::document::decode::Variant::of(node) else {
                    return reader.mismatch(node);
                };
                match written.name {
                    $(stringify!($variant) => variant!(
                        @decode written, reader;
                        $variant $((..$record))? $(($tuple $(=> $tuple_example)?))?
                        $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                    ),)*
                    _ => written.unknown(Self::VARIANTS, reader),
                }
            }

            fn placeholder() -> Self {
                first_of!($({ variant!(
                    @start $variant $((..$record))? $(($tuple))?
                    $({ $($field: $type $(= $default)?),* })?
                ) })*)
            }
        }

        impl crate::document::encode::Encode for $name {
            fn encode(&self) -> crate::document::ron_text::Text {
                match self {
                    $(variant!(@pattern value $variant $((..$record))? $(($tuple))? $({ $($field),* })?)
                        => variant!(
                            @encode value; $variant $((..$record))? $(($tuple))?
                            $({ $($field: $type $(= $default)?),* })?
                        ),)*
                }
            }

            fn visit<'a>(&'a self, walk: &mut crate::document::leaves::Walk<'_, 'a>) {
                // A choice between names alone has no leaves.
                let _: &mut _ = walk;
                match self {
                    $(variant!(@pattern value $variant $((..$record))? $(($tuple))? $({ $($field),* })?)
                        => variant!(
                            @walk walk, value; $variant $((..$record))? $(($tuple))? $({ $($field: $type),* })?
                        ),)*
                }
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                use crate::document::schema::variant_index;
                match self {
                    $(variant!(@pattern value $variant $((..$record))? $(($tuple))? $({ $($field),* })?)
                        => {
                            let index = variant_index(Self::VARIANTS, stringify!($variant));
                            variant!(
                                @serialize serializer, stringify!($name), index, value;
                                $variant $((..$record))? $(($tuple))?
                                $({ $($field: $type $(= $default)?),* })?
                            )
                        })*
                }
            }
        }

        const _: () = {
            struct Choice;

            impl<'de> serde::de::Visitor<'de> for Choice {
                type Value = $name;

                fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                    f.write_str($kind)
                }

                fn visit_enum<A: serde::de::EnumAccess<'de>>(
                    self,
                    data: A,
                ) -> Result<$name, A::Error> {
                    #[allow(unused_imports, reason = "variants without values use one of the two")]
                    use serde::de::{Error as _, VariantAccess as _};
                    let (crate::document::schema::Identifier(name), access) = data.variant()?;
                    match name.as_str() {
                        $(stringify!($variant) => variant!(
                            @deserialize access, $name;
                            $variant $((..$record))? $(($tuple))?
                            $({ $($field: $type $(= $default)?),* })?
                        ),)*
                        _ => Err(A::Error::unknown_variant(&name, <$name>::VARIANTS)),
                    }
                }
            }

            impl<'de> serde::Deserialize<'de> for $name {
                fn deserialize<D: serde::Deserializer<'de>>(
                    deserializer: D,
                ) -> Result<Self, D::Error> {
                    deserializer.deserialize_enum(stringify!($name), Self::VARIANTS, Choice)
                }
            }
        };
    };
}

macro_rules! first_of {
    ({ $($first:tt)* } $($rest:tt)*) => {
        $($first)*
    };
}

/// The part of one variant in each function that `choice!` generates.
macro_rules! variant {
    (@example $variant:ident) => {
        stringify!($variant).to_owned()
    };
    (@example $variant:ident (..$record:ty)) => {{
        let keys = <$record as crate::document::schema::Record>::examples(None);
        stringify!($variant).to_owned() + &crate::document::schema::example_of_keys(&keys)
    }};
    (@example $variant:ident ($tuple:ty => $example:literal)) => {
        concat!(stringify!($variant), "(", $example, ")").to_owned()
    };
    (@example $variant:ident ($tuple:ty)) => {
        format!(
            "{}({})",
            stringify!($variant),
            <$tuple as crate::document::decode::Decode>::example(),
        )
    };
    (@example $variant:ident { $($field:ident: $type:ty $(=> $example:literal)? $(= $default:expr)?),* }) => {{
        let mut keys = Vec::new();
        $(key!(
            @examples keys, key!(@default None; $type $(= $default)?), key!(@example $($example)?);
            $field: $type
        );)*
        stringify!($variant).to_owned() + &crate::document::schema::example_of_keys(&keys)
    }};

    (@describe $book:ident; $variant:ident) => {{
        let _: &mut _ = $book;
        None
    }};
    (@describe $book:ident; $variant:ident (..$record:ty)) => {{
        let keys = <$record as crate::document::schema::Record>::describe_keys(None, $book);
        Some(crate::document::describe::record("", keys))
    }};
    (@describe $book:ident; $variant:ident ($tuple:ty)) => {
        Some(<$tuple as crate::document::decode::Decode>::schema($book))
    };
    (@describe $book:ident; $variant:ident { $($(#[$meta:meta])* $field:ident: $type:ty
        $(=> $example:literal)? $(= $default:expr)?),* }
    ) => {{
        let mut keys = Vec::new();
        $(key!(
            @describe keys, $book, key!(@default None; $type $(= $default)?), key!(@example $($example)?),
            doc(&[$(stringify!($meta)),*]);
            $field: $type
        );)*
        Some(crate::document::describe::record("", keys))
    }};

    (@decode $written:ident, $reader:ident; $variant:ident) => {
        $written.unit(Self::$variant, $reader)
    };
    (@decode $written:ident, $reader:ident; $variant:ident (..$record:ty)) => {{
        let keys = <$record as crate::document::schema::ReadKeys>::KEYS;
        match $written.fields(concat!("`", stringify!($variant), "(..)`"), keys, $reader) {
            Some(fields) => {
                fields.refuse_others($reader);
                Self::$variant(<$record as crate::document::schema::Record>::decode_keys(
                    &fields, None, $reader,
                ))
            }
            None => <Self as crate::document::decode::Decode>::placeholder(),
        }
    }};
    (@decode $written:ident, $reader:ident; $variant:ident ($tuple:ty $(=> $example:literal)?)) => {
        Self::$variant($written.newtype::<$tuple>(key!(@example $($example)?), $reader))
    };
    (@decode $written:ident, $reader:ident; $variant:ident { $($field:ident: $type:ty
        $(=> $example:literal)? $(= $default:expr)?),* }
    ) => {{
        const KEYS: &[&str] = &[$(stringify!($field)),*];
        match $written.fields(concat!("`", stringify!($variant), "(..)`"), KEYS, $reader) {
            Some(fields) => {
                fields.refuse_others($reader);
                Self::$variant {
                    $($field: key!(
                        @decode fields, $reader, key!(@default None; $type $(= $default)?),
                        key!(@example $($example)?);
                        $field: $type
                    )),*
                }
            }
            None => <Self as crate::document::decode::Decode>::placeholder(),
        }
    }};

    (@start $variant:ident) => {
        Self::$variant
    };
    (@start $variant:ident (..$record:ty)) => {
        Self::$variant(<$record as crate::document::schema::ReadKeys>::start())
    };
    (@start $variant:ident ($tuple:ty)) => {
        Self::$variant(<$tuple as crate::document::decode::Decode>::placeholder())
    };
    (@start $variant:ident { $($field:ident: $type:ty $(= $default:expr)?),* }) => {
        Self::$variant { $($field: key!(@start $type $(= $default)?)),* }
    };

    (@pattern $value:ident $variant:ident) => {
        Self::$variant
    };
    (@pattern $value:ident $variant:ident ($(..)? $held:ty)) => {
        Self::$variant($value)
    };
    (@pattern $value:ident $variant:ident { $($field:ident),* }) => {
        Self::$variant { $($field),* }
    };

    (@encode $value:ident; $variant:ident) => {
        crate::document::ron_text::Text::Leaf(stringify!($variant).to_owned())
    };
    (@encode $value:ident; $variant:ident (..$record:ty)) => {{
        let mut items = Vec::new();
        crate::document::schema::Record::encode_keys($value, None, &mut items);
        crate::document::ron_text::Text::record(stringify!($variant), items)
    }};
    (@encode $value:ident; $variant:ident ($tuple:ty)) => {
        crate::document::ron_text::Text::newtype(
            stringify!($variant),
            crate::document::encode::Encode::encode($value),
        )
    };
    (@encode $value:ident; $variant:ident { $($field:ident: $type:ty $(= $default:expr)?),* }) => {{
        let mut items = Vec::new();
        $(key!(@encode items, $field, key!(@default None; $type $(= $default)?); $field: $type);)*
        crate::document::ron_text::Text::record(stringify!($variant), items)
    }};

    (@walk $walk:ident, $value:ident; $variant:ident) => {
        ()
    };
    (@walk $walk:ident, $value:ident; $variant:ident ($(..)? $held:ty)) => {
        crate::document::encode::Encode::visit($value, $walk)
    };
    (@walk $walk:ident, $value:ident; $variant:ident { $($field:ident: $type:ty),* }) => {{
        $(key!(@walk $walk, $field; $field: $type);)*
    }};

    (@serialize $serializer:ident, $name:expr, $index:ident, $value:ident; $variant:ident) => {
        $serializer.serialize_unit_variant($name, $index, stringify!($variant))
    };
    (@serialize $serializer:ident, $name:expr, $index:ident, $value:ident; $variant:ident ($(..)? $held:ty)) => {
        $serializer.serialize_newtype_variant($name, $index, stringify!($variant), $value)
    };
    (@serialize $serializer:ident, $name:expr, $index:ident, $value:ident;
        $variant:ident { $($field:ident: $type:ty $(= $default:expr)?),* }
    ) => {{
        use serde::ser::SerializeStructVariant as _;
        let count = [$(stringify!($field)),*].len();
        let mut out =
            $serializer.serialize_struct_variant($name, $index, stringify!($variant), count)?;
        $(key!(@serialize out, $field, key!(@default None; $type $(= $default)?); $field: $type);)*
        out.end()
    }};

    (@deserialize $access:ident, $name:ident; $variant:ident) => {
        $access.unit_variant().map(|()| $name::$variant)
    };
    (@deserialize $access:ident, $name:ident; $variant:ident (..$record:ty)) => {
        crate::document::schema::deserialize_variant($access).map($name::$variant)
    };
    (@deserialize $access:ident, $name:ident; $variant:ident ($tuple:ty)) => {
        $access.newtype_variant().map($name::$variant)
    };
    (@deserialize $access:ident, $name:ident; $variant:ident {
        $($field:ident: $type:ty $(= $default:expr)?),*
    }) => {{
        struct Keys { $($field: $type),* }
        read_keys!(Keys, stringify!($variant); { $($field: $type $(= $default)?),* });
        let keys = crate::document::schema::deserialize_variant($access)?;
        let Keys { $($field),* } = keys;
        Ok($name::$variant { $($field),* })
    }};
}
