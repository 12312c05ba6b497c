//! `record!` and `choice!`: one declaration gives a document type its Rust form, its reader (every
//! error with its place, unknown keys with the nearest known one) and its writer.

macro_rules! record {
    ($(#[$meta:meta])* pub struct $name:ident {
        $($(#[$field_meta:meta])* $field:ident : $type:ty $(= $default:expr)?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name { $($(#[$field_meta])* pub $field: $type),* }
    };
}

macro_rules! choice {
    ($(#[$meta:meta])* pub enum $name:ident {
        $($(#[$variant_meta:meta])* $variant:ident
            $(($($tuple:tt)*))?
            $({ $($(#[$field_meta:meta])* $field:ident : $type:ty $(= $default:expr)?),* $(,)? })?
        ),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            $($(#[$variant_meta])* $variant
                $(($($tuple)*))?
                $({ $($(#[$field_meta])* $field: $type),* })?
            ),*
        }
    };
}
