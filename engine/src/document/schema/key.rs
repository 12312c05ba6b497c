//! `key!`: the part of one key in each function that `record!` and `choice!` generate.
//!
//! `name: Type` is a key; `name as keys: Type` stands for all keys of the record `Type`.

macro_rules! key {
    (@names $field:ident: $type:ty) => {
        &[stringify!($field)]
    };
    (@names $field:ident as keys: $type:ty) => {
        <$type as crate::document::schema::ReadKeys>::KEYS
    };

    // Default of a key; `$base` is the one that a record gives which has this record's keys among its own.
    (@default $base:expr; $type:ty) => {{
        let base: Option<&$type> = $base;
        base.cloned()
    }};
    (@default $base:expr; $type:ty = $default:expr) => {{
        let base: Option<&$type> = $base;
        Some(base.cloned().unwrap_or_else(|| $default))
    }};

    (@start $type:ty) => {
        <$type as crate::document::decode::Decode>::placeholder()
    };
    (@start $type:ty = $default:expr) => {
        $default
    };

    (@example) => {
        None
    };
    (@example $example:literal) => {
        Some($example)
    };

    (@examples $out:ident, $default:expr, $example:expr; $field:ident: $type:ty) => {
        crate::document::schema::add_example::<$type>(
            &mut $out,
            stringify!($field),
            $default.is_some(),
            $example,
        )
    };
    (@examples $out:ident, $default:expr, $example:expr; $field:ident as keys: $type:ty) => {
        $out.extend(<$type as crate::document::schema::Record>::examples($default.as_ref()))
    };

    (@describe $out:ident, $book:ident, $default:expr, $example:expr, $doc:expr; $field:ident: $type:ty) => {
        $out.push(crate::document::describe::SchemaKey::new::<$type>(
            stringify!($field),
            $doc,
            $default,
            $example,
            $book,
        ))
    };
    (@describe $out:ident, $book:ident, $default:expr, $example:expr, $doc:expr; $field:ident as keys: $type:ty) => {
        $out.extend(<$type as crate::document::schema::Record>::describe_keys(
            $default.as_ref(),
            $book,
        ))
    };

    (@decode $fields:ident, $reader:ident, $default:expr, $example:expr; $field:ident: $type:ty) => {
        $fields.key::<$type>(stringify!($field), $default, $example, $reader)
    };
    (@decode $fields:ident, $reader:ident, $default:expr, $example:expr; $field:ident as keys: $type:ty) => {
        <$type as crate::document::schema::Record>::decode_keys(
            &$fields,
            $default.as_ref(),
            $reader,
        )
    };

    (@encode $items:ident, $value:expr, $default:expr; $field:ident: $type:ty) => {
        if $default.as_ref() != Some($value) {
            $items.push(crate::document::ron_text::Text::item(
                stringify!($field),
                crate::document::encode::Encode::encode($value),
            ));
        }
    };
    (@encode $items:ident, $value:expr, $default:expr; $field:ident as keys: $type:ty) => {
        crate::document::schema::Record::encode_keys($value, $default.as_ref(), $items)
    };

    (@walk $walk:ident, $value:expr; $field:ident: $type:ty) => {
        $walk.below(stringify!($field).into(), $value)
    };
    (@walk $walk:ident, $value:expr; $field:ident as keys: $type:ty) => {
        crate::document::encode::Encode::visit($value, $walk)
    };

    (@serialize $out:ident, $value:expr, $default:expr; $field:ident: $type:ty) => {
        if $default.as_ref() != Some($value) {
            $out.serialize_field(stringify!($field), $value)?;
        }
    };
    (@serialize $out:ident, $value:expr, $default:expr; $field:ident as keys: $type:ty) => {
        crate::document::schema::Record::serialize_keys($value, $default.as_ref(), $out)?;
    };

    (@read $name:ident, $map:ident, $value:expr; $field:ident: $type:ty) => {
        if $name == stringify!($field) {
            $value = $map.next_value()?;
            return Ok(true);
        }
    };
    (@read $name:ident, $map:ident, $value:expr; $field:ident as keys: $type:ty) => {
        if crate::document::schema::ReadKeys::read_key(&mut $value, $name, $map)? {
            return Ok(true);
        }
    };

    (@missing $read:ident; $field:ident $(as keys)?: $type:ty = $default:expr) => {};
    (@missing $read:ident; $field:ident: $type:ty) => {
        if !$read.iter().any(|name| name == stringify!($field)) {
            return Some(stringify!($field));
        }
    };
    (@missing $read:ident; $field:ident as keys: $type:ty) => {
        if let Some(missing) = <$type as crate::document::schema::ReadKeys>::missing($read) {
            return Some(missing);
        }
    };
}

/// `new` for a type with keys that must be written, `Default` for any other.
macro_rules! constructor {
    // A scene has a constructor of its own.
    (Scene; $($keys:tt)*) => {};
    ($name:ident; $($keys:tt)*) => {
        constructor!(@sort $name [] []; $($keys)*);
    };
    (@sort $name:ident [$($required:tt)*] [$($default:tt)*];
        $field:ident: $type:ty = $value:expr, $($rest:tt)*) => {
        constructor!(@sort $name [$($required)*] [$($default)* $field: $value,]; $($rest)*);
    };
    (@sort $name:ident [$($required:tt)*] [$($default:tt)*]; $field:ident: $type:ty, $($rest:tt)*) => {
        constructor!(@sort $name [$($required)* $field: $type,] [$($default)*]; $($rest)*);
    };
    (@sort $name:ident [] [$($default:tt)*];) => {
        impl Default for $name {
            fn default() -> Self {
                Self { $($default)* }
            }
        }
    };
    (@sort $name:ident [$($field:ident: $type:ty,)+] [$($default:tt)*];) => {
        impl $name {
            /// Value with these keys; all others have their defaults.
            #[must_use]
            pub fn new($($field: $type),+) -> Self {
                Self { $($field,)+ $($default)* }
            }
        }
    };
}
