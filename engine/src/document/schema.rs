//! `record!` and `choice!`: one declaration gives a document type its Rust form, its reader (every
//! error with its place, unknown keys with the nearest known one) and its writer.
//!
//! `key: Type` must be written, `key: Type = default` may be. The text behind the type's name is
//! what a person calls it; that behind `=>` shows how a key is written where it is missing; a key that has both stands in examples.

macro_rules! record {
    ($(#[$meta:meta])* pub struct $name:ident ($kind:literal) {
        $($(#[$field_meta:meta])* $field:ident : $type:ty
            $(=> $example:literal)? $(= $default:expr)?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name { $($(#[$field_meta])* pub $field: $type),* }

        impl Decode for $name {
            const KEYS: &'static [&'static str] = &[$(stringify!($field)),*];

            fn expected() -> Cow<'static, str> {
                $kind.into()
            }

            fn example() -> String {
                example_of_keys(&[
                    $(example_of_key!($field: $type $(=> $example)? $(= $default)?)),*
                ])
            }

            fn schema(book: &mut crate::document::describe::Book) -> serde_json::Value {
                use crate::document::describe::{doc, record};
                book.describe(stringify!($name), |book| record(
                    &doc(&[$(stringify!($meta)),*]),
                    vec![$(crate::document::describe::Key {
                        name: stringify!($field),
                        doc: doc(&[$(stringify!($field_meta)),*]),
                        schema: <$type>::schema(book),
                        default: default_of_key!($type $(= $default)?),
                        example: example_of_key!($field: $type $(=> $example)? $(= $default)?)
                            .map(|(_, example)| example),
                    }),*],
                ))
            }

            fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
                match Fields::of_record(node, stringify!($name), $kind, Self::KEYS) {
                    Some(fields) => {
                        fields.refuse_others(reader);
                        Self {
                            $($field: decode_key!(
                                fields, reader, $field: $type $(=> $example)? $(= $default)?
                            )),*
                        }
                    }
                    None => reader.mismatch(node),
                }
            }

            fn placeholder() -> Self {
                Self { $($field: placeholder_of_key!($type $(= $default)?)),* }
            }
        }

        impl Encode for $name {
            fn encode(&self) -> Text {
                let mut items = Vec::new();
                let Self { $($field),* } = self;
                $(encode_key!(items, $field: $type $(= $default)?);)*
                Text::record("", items)
            }

            fn numbers<'a>(&'a self, walk: &mut crate::document::numbers::Walk<'_, 'a>) {
                use crate::document::numbers::Step;
                let Self { $($field),* } = self;
                $(walk.below(Step::Key(stringify!($field)), $field);)*
            }
        }
    };
}

macro_rules! choice {
    ($(#[$meta:meta])* pub enum $name:ident ($kind:literal) {
        $($(#[$variant_meta:meta])* $variant:ident
            $(($tuple:ty $(=> $tuple_example:literal)?))?
            $({ $($(#[$field_meta:meta])* $field:ident : $type:ty
                $(=> $example:literal)? $(= $default:expr)?),* $(,)? })?
        ),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            $($(#[$variant_meta])* $variant
                $(($tuple))?
                $({ $($(#[$field_meta])* $field: $type),* })?
            ),*
        }

        impl Decode for $name {
            fn expected() -> Cow<'static, str> {
                $kind.into()
            }

            fn example() -> String {
                first_of!(example_of_variant: $({
                    $variant
                    $(($tuple $(=> $tuple_example)?))?
                    $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                })*)
            }

            fn schema(book: &mut crate::document::describe::Book) -> serde_json::Value {
                use crate::document::describe::{doc, variant};
                book.describe(stringify!($name), |book| {
                    let variants = vec![$(variant(
                        stringify!($variant),
                        &doc(&[$(stringify!($variant_meta)),*]),
                        schema_of_variant!(book $(($tuple))? $({ $(
                            $(#[$field_meta])* $field: $type $(=> $example)? $(= $default)?
                        ),* })?),
                        &{
                            #[allow(unused_imports, reason = "only variants with keys use it")]
                            use crate::document::decode::example_of_keys;
                            example_of_variant!(
                                $variant
                                $(($tuple $(=> $tuple_example)?))?
                                $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                            )
                        },
                    )),*];
                    serde_json::json!({
                        "description": doc(&[$(stringify!($meta)),*]),
                        "anyOf": variants,
                    })
                })
            }

            fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
                let Some(written) = Variant::of(node) else { return reader.mismatch(node) };
                match written.name {
                    $(stringify!($variant) => decode_variant!(
                        written, reader, $variant
                        $(($tuple $(=> $tuple_example)?))?
                        $({ $($field: $type $(=> $example)? $(= $default)?),* })?
                    ),)*
                    _ => written.unknown(&[$(stringify!($variant)),*], reader),
                }
            }

            fn placeholder() -> Self {
                first_of!(placeholder_of_variant: $({
                    $variant $(($tuple))? $({ $($field: $type $(= $default)?),* })?
                })*)
            }
        }

        impl Encode for $name {
            fn encode(&self) -> Text {
                match self {
                    $(encode_variant!(
                        @pattern value $variant $(($tuple))? $({ $($field),* })?
                    ) => encode_variant!(
                        @text value $variant $(($tuple))? $({ $($field: $type $(= $default)?),* })?
                    ),)*
                }
            }

            fn numbers<'a>(&'a self, walk: &mut crate::document::numbers::Walk<'_, 'a>) {
                // A choice between names alone has no numbers.
                let _: &mut _ = walk;
                match self {
                    $(encode_variant!(
                        @pattern value $variant $(($tuple))? $({ $($field),* })?
                    ) => encode_variant!(
                        @numbers walk value $variant $(($tuple))? $({ $($field),* })?
                    ),)*
                }
            }
        }
    };
}

macro_rules! default_of_key {
    ($type:ty) => {
        None
    };
    ($type:ty = $default:expr) => {{
        let default: $type = $default;
        Some(default.encode().into_line())
    }};
}

macro_rules! schema_of_variant {
    ($book:ident) => {{
        let _: &mut _ = $book;
        None
    }};
    ($book:ident ($tuple:ty)) => {
        Some(<$tuple>::schema($book))
    };
    ($book:ident { $($(#[$meta:meta])* $field:ident: $type:ty
        $(=> $example:literal)? $(= $default:expr)?),* }
    ) => {
        Some(crate::document::describe::record("", vec![$(crate::document::describe::Key {
            name: stringify!($field),
            doc: doc(&[$(stringify!($meta)),*]),
            schema: <$type>::schema($book),
            default: default_of_key!($type $(= $default)?),
            example: example_of_key!($field: $type $(=> $example)? $(= $default)?)
                .map(|(_, example)| example),
        }),*]))
    };
}

macro_rules! first_of {
    ($of:ident: { $($first:tt)* } $($rest:tt)*) => {
        $of!($($first)*)
    };
}

macro_rules! example_of_key {
    ($field:ident: $type:ty => $example:literal) => {
        Some((stringify!($field), $example.to_owned()))
    };
    ($field:ident: $type:ty) => {
        Some((stringify!($field), <$type>::example()))
    };
    ($field:ident: $type:ty => $example:literal = $default:expr) => {
        Some((stringify!($field), $example.to_owned()))
    };
    ($field:ident: $type:ty = $default:expr) => {
        None::<(&str, String)>
    };
}

macro_rules! decode_key {
    ($fields:ident, $reader:ident, $field:ident: $type:ty => $example:literal) => {
        $fields.required::<$type>(stringify!($field), Some($example), $reader)
    };
    ($fields:ident, $reader:ident, $field:ident: $type:ty) => {
        $fields.required::<$type>(stringify!($field), None, $reader)
    };
    ($fields:ident, $reader:ident, $field:ident: $type:ty
        $(=> $example:literal)? = $default:expr
    ) => {
        $fields.optional::<$type>(stringify!($field), || $default, $reader)
    };
}

macro_rules! placeholder_of_key {
    ($type:ty) => {
        <$type>::placeholder()
    };
    ($type:ty = $default:expr) => {
        $default
    };
}

macro_rules! encode_key {
    ($items:ident, $field:ident: $type:ty) => {
        $items.push(Text::item(stringify!($field), $field.encode()))
    };
    ($items:ident, $field:ident: $type:ty = $default:expr) => {
        let default: $type = $default;
        if differs($field, &default) {
            $items.push(Text::item(stringify!($field), $field.encode()));
        }
    };
}

macro_rules! example_of_variant {
    ($variant:ident) => {
        stringify!($variant).to_owned()
    };
    ($variant:ident ($tuple:ty => $example:literal)) => {
        concat!(stringify!($variant), "(", $example, ")").to_owned()
    };
    ($variant:ident ($tuple:ty)) => {
        format!("{}({})", stringify!($variant), <$tuple>::example())
    };
    ($variant:ident { $($field:ident: $type:ty $(=> $example:literal)? $(= $default:expr)?),* }) => {
        format!("{}{}", stringify!($variant), example_of_keys(&[
            $(example_of_key!($field: $type $(=> $example)? $(= $default)?)),*
        ]))
    };
}

macro_rules! decode_variant {
    ($written:ident, $reader:ident, $variant:ident) => {
        $written.unit(Self::$variant, $reader)
    };
    ($written:ident, $reader:ident, $variant:ident ($tuple:ty)) => {
        Self::$variant($written.newtype::<$tuple>(None, $reader))
    };
    ($written:ident, $reader:ident, $variant:ident ($tuple:ty => $example:literal)) => {
        Self::$variant($written.newtype::<$tuple>(Some($example), $reader))
    };
    ($written:ident, $reader:ident, $variant:ident { $($field:ident: $type:ty
        $(=> $example:literal)? $(= $default:expr)?),* }
    ) => {{
        const KEYS: &[&str] = &[$(stringify!($field)),*];
        match $written.fields(concat!("`", stringify!($variant), "(..)`"), KEYS, $reader) {
            Some(fields) => {
                fields.refuse_others($reader);
                Self::$variant {
                    $($field: decode_key!(
                        fields, $reader, $field: $type $(=> $example)? $(= $default)?
                    )),*
                }
            }
            None => Self::placeholder(),
        }
    }};
}

macro_rules! placeholder_of_variant {
    ($variant:ident) => {
        Self::$variant
    };
    ($variant:ident ($tuple:ty)) => {
        Self::$variant(<$tuple>::placeholder())
    };
    ($variant:ident { $($field:ident: $type:ty $(= $default:expr)?),* }) => {
        Self::$variant { $($field: placeholder_of_key!($type $(= $default)?)),* }
    };
}

macro_rules! encode_variant {
    (@pattern $value:ident $variant:ident) => {
        Self::$variant
    };
    (@pattern $value:ident $variant:ident ($tuple:ty)) => {
        Self::$variant($value)
    };
    (@pattern $value:ident $variant:ident { $($field:ident),* }) => {
        Self::$variant { $($field),* }
    };
    (@numbers $walk:ident $value:ident $variant:ident) => {
        ()
    };
    (@numbers $walk:ident $value:ident $variant:ident ($tuple:ty)) => {
        $value.numbers($walk)
    };
    (@numbers $walk:ident $value:ident $variant:ident { $($field:ident),* }) => {{
        $($walk.below(crate::document::numbers::Step::Key(stringify!($field)), $field);)*
    }};
    (@text $value:ident $variant:ident) => {
        Text::Leaf(stringify!($variant).to_owned())
    };
    (@text $value:ident $variant:ident ($tuple:ty)) => {
        Text::newtype(stringify!($variant), $value.encode())
    };
    (@text $value:ident $variant:ident { $($field:ident: $type:ty $(= $default:expr)?),* }) => {{
        let mut items = Vec::with_capacity(16);
        $(encode_key!(items, $field: $type $(= $default)?);)*
        Text::record(stringify!($variant), items)
    }};
}
