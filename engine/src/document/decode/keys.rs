//! Keys of records, and variants of choices.

use super::super::diagnostic::{nearest, suggestion};
use super::super::params::plain_number;
use super::super::path::Step;
use super::super::ron_text::{Field, Node, Span, Value};
use super::advice::other_name;
use super::{Decode, ERRORS, Reader};

/// Names of the angle of the sun above the horizon.
const ELEVATIONS: [&str; 6] =
    ["elevation_deg", "elevation", "altitude_deg", "altitude", "height_deg", "elevation_angle"];

/// The keys of a record or of a variant.
pub(in super::super) struct Fields<'a> {
    list: &'a [Field],
    /// Part of the text to underline where a key is missing.
    head: Span,
    /// Name of the owner in messages: `the sun`.
    owner: &'static str,
    known: &'static [&'static str],
}

impl<'a> Fields<'a> {
    /// Keys of a record, with or without its type's name.
    pub(in super::super) fn of_record(
        node: &'a Node,
        type_name: &str,
        owner: &'static str,
        known: &'static [&'static str],
    ) -> Option<Self> {
        let head = node.opening();
        let value = match &node.value {
            Value::Named(named) if named.name == type_name => &named.body.as_ref()?.value,
            value => value,
        };
        let list = match value {
            Value::Record(fields) => fields.as_slice(),
            Value::Tuple(items) if items.is_empty() => &[],
            _ => return None,
        };
        Some(Self { list, head, owner, known })
    }

    fn unknown(&self) -> impl Iterator<Item = &'a Field> {
        let known = self.known;
        self.list.iter().filter(|field| !known.contains(&field.name.as_str()))
    }

    /// Reports every key that is not among those known.
    pub(in super::super) fn refuse_others(&self, reader: &mut Reader<'a>) {
        let known = self.known;
        for field in self.unknown() {
            if !reader.has_room() {
                continue;
            }
            let name = field.name.as_str();
            let (message, help) = match self.owner {
                "`Lambertian(..)`" if name == "transmittance" => (
                    "a `Lambertian(..)` surface is opaque: it has no transmittance".to_owned(),
                    "write `Leaf(..)` for one that light passes through".to_owned(),
                ),
                "the sun" if ELEVATIONS.contains(&name) => {
                    let zenith = plain_number(&field.value).map(|elevation| 90.0 - elevation);
                    let zenith =
                        zenith.map_or_else(|| "..".to_owned(), |zenith| format!("{zenith:?}"));
                    (
                        format!("no key `{name}` in the sun"),
                        format!(
                            "write `zenith_deg: {zenith}`: the zenith angle is 90° less the elevation"
                        ),
                    )
                }
                "`Plane(..)`" | "`Mesh(..)`" if name == "land_cover" => (
                    format!("no land cover on {}: classes lie on a raster of heights", self.owner),
                    "write `Raster(file: \"heights.asc\", land_cover: ..)`, where all heights may \
                     be the same; the parts of a mesh have materials of their own"
                        .to_owned(),
                ),
                _ if known.is_empty() => (
                    format!("no key `{name}` in {}", self.owner),
                    format!("{} has no keys", self.owner),
                ),
                _ => (
                    format!("no key `{name}` in {}", self.owner),
                    suggestion(name, known, "keys here"),
                ),
            };
            reader.within(Step::Key(name.to_owned().into()), |reader| {
                reader.error(field.name_span, message, Some(help));
            });
        }
    }

    fn find(&self, name: &str) -> Option<&'a Field> {
        self.list.iter().find(|field| field.name == name)
    }

    fn is_misspelt(&self, name: &str) -> bool {
        let known = || self.known.iter().copied();
        self.unknown().take(ERRORS).any(|field| nearest(&field.name, known()) == Some(name))
    }

    /// Value of a key; its default, or an error where there is none, if it is missing.
    pub(in super::super) fn key<T: Decode>(
        &self,
        name: &'static str,
        default: Option<T>,
        example: Option<&'static str>,
        reader: &mut Reader<'a>,
    ) -> T {
        // The example of a key with a default is for its owner.
        let example = if default.is_some() { None } else { example };
        reader.within(name.into(), |reader| {
            if let Some(field) = self.find(name) {
                return reader.by_example(example, |reader| T::decode(&field.value, reader));
            }
            let is_lost = self.may_be_lost(reader);
            if let Some(default) = default {
                if is_lost {
                    reader.mark_broken();
                }
                return default;
            }
            // Under a name like this one it is there, and that has been reported.
            if is_lost || self.is_misspelt(name) {
                reader.mark_broken();
            } else {
                let message = format!("{} lacks the key `{name}`", self.owner);
                let example = example.map_or_else(T::example, str::to_owned);
                let help = format!("write, for example, `{name}: {example}`");
                reader.error(self.head, message, Some(help));
            }
            T::placeholder()
        })
    }

    /// Returns whether a missing key may stand in a file that could not be included.
    fn may_be_lost(&self, reader: &Reader<'_>) -> bool {
        self.owner == "the scene" && reader.has_lost_files()
    }
}

/// A variant of a choice, as written.
pub(in super::super) struct Variant<'a> {
    pub(in super::super) name: &'a str,
    name_span: Span,
    body: Option<&'a Node>,
}

impl<'a> Variant<'a> {
    pub(in super::super) fn of(node: &'a Node) -> Option<Self> {
        match &node.value {
            Value::Named(named) => Some(Self {
                name: &named.name,
                name_span: named.name_span,
                body: named.body.as_ref(),
            }),
            _ => None,
        }
    }

    /// `Periodic`.
    pub(in super::super) fn unit<T>(&self, value: T, reader: &mut Reader<'a>) -> T {
        if let Some(body) = self.body
            && !matches!(&body.value, Value::Tuple(items) if items.is_empty())
        {
            let message = format!("`{}` takes no values", self.name);
            let help = format!("write `{}` alone", self.name);
            reader.error(body.head(reader.text()), message, Some(help));
        }
        value
    }

    /// `Constant(0.3)`; of a tuple `Uniform(0.5, 1.5)`.
    pub(in super::super) fn newtype<T: Decode>(
        &self,
        example: Option<&'static str>,
        reader: &mut Reader<'a>,
    ) -> T {
        let items = match self.body.map(|body| &body.value) {
            Some(Value::Tuple(items)) => items.as_slice(),
            _ => &[],
        };
        let is_spread = T::IS_TUPLE
            && !items.is_empty()
            && !matches!(items, [Node { value: Value::Tuple(_), .. }]);
        if let Some(body) = self.body.filter(|_| is_spread) {
            return T::decode(body, reader);
        }
        if let [item] = items {
            return reader.by_example(example, |reader| T::decode(item, reader));
        }
        let example = example.map_or_else(T::example, str::to_owned);
        let found = match self.body.map(|body| &body.value) {
            None => "none".to_owned(),
            Some(Value::Record(_)) => "keys".to_owned(),
            Some(_) => items.len().to_string(),
        };
        let wanted = if T::IS_TUPLE { T::expected() } else { "one value".into() };
        let message = format!("`{}` takes {wanted}, found {found}", self.name);
        let help = format!("write, for example, `{}({example})`", self.name);
        reader.error(self.name_span, message, Some(help));
        T::placeholder()
    }

    /// `Plane(size_m: ..)`; the name alone stands for a variant with defaults only.
    pub(in super::super) fn fields(
        &self,
        owner: &'static str,
        known: &'static [&'static str],
        reader: &mut Reader<'a>,
    ) -> Option<Fields<'a>> {
        let list = match self.body.map(|body| &body.value) {
            None => &[],
            Some(Value::Record(fields)) => fields.as_slice(),
            Some(Value::Tuple(items)) if items.is_empty() => &[],
            Some(_) => {
                let message = format!("{owner} takes keys, found values without");
                let help = format!("write `key: value`; keys here: {}", known.join(", "));
                reader.error(self.name_span, message, Some(help));
                return None;
            }
        };
        Some(Fields { list, head: self.name_span, owner, known })
    }

    /// A name that no variant has.
    pub(in super::super) fn unknown<T: Decode>(
        &self,
        known: &[&'static str],
        reader: &mut Reader<'a>,
    ) -> T {
        let expected = T::expected();
        let message = format!("expected {expected}, found `{}`", self.name);
        let help = suggestion(self.name, known, "choices here");
        let help = match other_name(&expected, self.name) {
            Some(advice) => format!("{advice}; choices here: {}", known.join(", ")),
            None if self.body.is_none() => reader.word_advice(&expected, self.name).unwrap_or(help),
            None => help,
        };
        reader.error(self.name_span, message, Some(help));
        T::placeholder()
    }
}
