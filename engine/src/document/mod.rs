//! The scene language: what a scene file may say, reading it with places, and writing it.

#[macro_use]
mod schema;
mod check;
mod decode;
mod describe;
mod diagnostic;
mod discrete;
mod edit;
mod encode;
mod expand;
mod format;
mod formula;
mod include;
mod keys;
mod leaves;
mod legible;
mod param_uses;
mod params;
mod parsed;
mod path;
mod read;
mod ron_text;
mod scene;
mod source;
mod sun;

pub use check::check;
pub(crate) use check::{
    HEIGHT, IRRADIANCE, LENGTH, LawfulRange, SCALE, check_maps, rounded_up, too_many_pixels,
};
pub use describe::{json_schema, types_json};
pub(crate) use diagnostic::suggestion;
pub use diagnostic::{Diagnostic, Place, Severity, nearest, unknown_name};
pub use discrete::discrete_difference;
pub use edit::with_values_of;
pub use format::{format, format_file};
pub use keys::{keys_about, keys_page};
pub(crate) use legible::legible;
pub use parsed::ParsedScene;
pub use path::{ScenePath, Step};
pub use read::{ReadError, ReadOptions, Reading, read_file, read_text, text_of_file, tree_of_text};
pub use ron_text::{BadNumber, Field, Named, Node, Span, Value};
pub use scene::*;
pub use source::Source;
pub use sun::SunDay;
