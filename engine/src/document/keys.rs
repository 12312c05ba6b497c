//! The page of all keys of the scene language, from the declarations that read and write it.

use std::fmt::Write as _;

use serde_json::Value;

use super::describe::{self, KEYS, VARIANT};
use super::diagnostic::nearest;
use super::formula::{functions_text, is_function};

/// Head of the page, above all types.
const HEAD: &str = "\
# Keys of the scene language

`sunfleck keys` prints this page, and `sunfleck keys NAME` what it says of one type, variant or key.

- A key whose default is `required` must be written; all others may be left out.
- Units stand behind the meaning: m, nm, degrees, K, W m⁻² nm⁻¹.
- Wherever a number stands, a formula of the scene's `params` may: `\"=90 - elevation\"`.
- Lists are `[a, b]`, tuples `(a, b)`, maps `{ \"name\": value }`.
";

/// A part of the page: a type, or a variant of one.
struct Section {
    /// Name of the type.
    of_type: String,
    /// Name of the variant.
    variant: Option<String>,
    heading: String,
    /// Text between the heading and the rows.
    text: String,
    /// Variants of the type without keys, each with its line of the text.
    plain: Vec<(String, String)>,
    /// Keys, each with its row of the table.
    rows: Vec<(String, String)>,
    /// Text behind the rows.
    example: String,
}

/// Names by which a person may ask for the section of formulas.
const FORMULA_NAMES: [&str; 5] = ["formula", "formulas", "function", "functions", "params"];

fn formula_section() -> String {
    format!("## Formulas\n\n{}\n", functions_text())
}

/// Markdown that describes every key of scene files: values, units, defaults and examples.
#[must_use]
pub fn keys_page() -> String {
    let mut page = format!("{HEAD}\n{}", formula_section());
    for section in sections() {
        page.push('\n');
        page += &section.markdown();
    }
    page
}

/// The part of the page about a type, a variant or a key, in any case of letters.
///
/// # Errors
/// If nothing has that name: the nearest name that there is.
pub fn keys_about(name: &str) -> Result<String, String> {
    let all = sections();
    let is_meant = |other: &str| other.eq_ignore_ascii_case(name);
    let mut parts: Vec<String> = all
        .iter()
        .filter(|section| match &section.variant {
            None => is_meant(&section.of_type),
            Some(variant) => is_meant(variant) || is_meant(&section.of_type),
        })
        .map(Section::markdown)
        .collect();
    for section in all.iter().filter(|section| !is_meant(&section.of_type)) {
        let lines = section.plain.iter().filter(|(variant, _)| is_meant(variant));
        parts.extend(lines.map(|(_, line)| section.with_line(line)));
    }
    for section in &all {
        let rows: Vec<_> = section.rows.iter().filter(|(key, _)| is_meant(key)).collect();
        if !rows.is_empty() {
            parts.push(
                section.with_rows(&rows.iter().map(|(_, row)| row.as_str()).collect::<Vec<_>>()),
            );
        }
    }
    let is_of_formulas = FORMULA_NAMES.iter().copied().any(is_meant) || is_function(name);
    if is_of_formulas {
        parts.push(formula_section());
    }
    if parts.is_empty() && !name.is_empty() {
        parts = parts_that_name(&all, name);
    }
    if !parts.is_empty() {
        return Ok(parts.join("\n"));
    }
    let types = all.iter().map(|section| section.of_type.as_str());
    let plain = all.iter().flat_map(|section| section.plain.iter().map(|(name, _)| name.as_str()));
    let variants = all.iter().filter_map(|section| section.variant.as_deref()).chain(plain);
    let keys = all.iter().flat_map(|section| section.rows.iter().map(|(key, _)| key.as_str()));
    Err(match nearest(name, types.chain(variants).chain(keys)) {
        Some(near) => format!("there is no key, type or variant `{name}`: did you mean `{near}`?"),
        None => format!("there is no key, type or variant `{name}`; `sunfleck keys` prints all"),
    })
}

/// Lines about variants that name this word among their values: an instrument or a spectrum of the library.
fn parts_that_name(all: &[Section], word: &str) -> Vec<String> {
    let is_in = |value: &str| {
        let mut words = value.split(|letter: char| !letter.is_alphanumeric());
        value.eq_ignore_ascii_case(word) || words.any(|other| other.eq_ignore_ascii_case(word))
    };
    let mut parts = Vec::new();
    for section in all {
        let names = |line: &str| line.split('`').skip(1).step_by(2).any(is_in);
        let lines = section.plain.iter().filter(|(_, line)| names(line));
        parts.extend(lines.map(|(_, line)| section.with_line(line)));
    }
    parts
}

impl Section {
    /// Heading of the type, and the line about one of its variants.
    fn with_line(&self, line: &str) -> String {
        format!("{}\n\n{line}\n", self.heading)
    }

    fn markdown(&self) -> String {
        let rows: Vec<_> = self.rows.iter().map(|(_, row)| row.as_str()).collect();
        let mut text = self.with_rows(&rows);
        if !self.example.is_empty() {
            text.extend(["\n", &self.example, "\n"]);
        }
        text
    }

    fn with_rows(&self, rows: &[&str]) -> String {
        let mut text = format!("{}\n", self.heading);
        if !self.text.is_empty() {
            text.extend(["\n", &self.text, "\n"]);
        }
        if !rows.is_empty() {
            text += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
            text += &rows.concat();
        }
        text
    }
}

fn sections() -> Vec<Section> {
    let mut sections = Vec::new();
    for (name, schema) in describe::types() {
        let mut head = Section {
            of_type: name.clone(),
            variant: None,
            heading: format!("## {name}"),
            text: description(&schema),
            plain: Vec::new(),
            rows: rows(&schema),
            example: String::new(),
        };
        let variants = schema["anyOf"].as_array().map_or(&[][..], Vec::as_slice);
        let (with_keys, plain): (Vec<&Value>, Vec<&Value>) =
            variants.iter().partition(|variant| variant[VARIANT][KEYS].is_array());
        if !plain.is_empty() {
            head.plain = plain.into_iter().map(plain_variant).collect();
            let lines: Vec<_> = head.plain.iter().map(|(_, line)| line.as_str()).collect();
            let text = std::mem::take(&mut head.text);
            head.text = match text.as_str() {
                "" => lines.join("\n"),
                _ => format!("{text}\n\n{}", lines.join("\n")),
            };
        }
        sections.push(head);
        for variant in with_keys {
            let of_variant = &variant[VARIANT];
            let variant_name = of_variant["name"].as_str().unwrap_or_default();
            sections.push(Section {
                of_type: name.clone(),
                variant: Some(variant_name.to_owned()),
                heading: format!("### {variant_name} ({name})"),
                text: description(variant),
                plain: Vec::new(),
                rows: rows(of_variant),
                example: format!("Example: `{}`", example(of_variant)),
            });
        }
    }
    sections
}

/// Name of a variant without keys, and a line about it.
fn plain_variant(variant: &Value) -> (String, String) {
    let of_variant = &variant[VARIANT];
    let name = of_variant["name"].as_str().unwrap_or_default();
    let mut line = format!("- `{name}`");
    if !of_variant["holds"].is_null() {
        line = format!("- `{name}(..)` with {}", value_of(&of_variant["holds"]));
    }
    let text = description(variant);
    if !text.is_empty() {
        line.extend([": ", &text]);
    }
    if !of_variant["holds"].is_null() {
        line.extend([" Example: `", example(of_variant), "`"]);
    }
    (name.to_owned(), line)
}

fn rows(schema: &Value) -> Vec<(String, String)> {
    let keys = schema[KEYS].as_array().map_or(&[][..], Vec::as_slice);
    keys.iter()
        .map(|key| {
            let name = key["name"].as_str().unwrap_or_default().to_owned();
            let default = match (key["default"].as_str(), key["example"].as_str()) {
                (Some("None"), None) => "none".to_owned(),
                (Some("None"), Some(example)) => format!("none, e.g. {}", code(example)),
                (Some(default), _) => code(default),
                (None, example) => {
                    format!("required, e.g. {}", code(example.unwrap_or_default()))
                }
            };
            let meaning = description(&key["schema"]);
            let value = value_of(&key["schema"]);
            let mut row = String::new();
            // Writing to a string cannot fail.
            let _infallible = writeln!(row, "| `{name}` | {value} | {default} | {meaning} |");
            (name, row)
        })
        .collect()
}

fn description(schema: &Value) -> String {
    schema["description"].as_str().unwrap_or_default().replace('|', "\\|")
}

fn example(variant: &Value) -> &str {
    variant["example"].as_str().unwrap_or_default()
}

fn code(text: &str) -> String {
    format!("`{}`", text.replace('|', "\\|"))
}

/// Description of the values that a schema allows.
fn value_of(schema: &Value) -> String {
    if let Some(reference) = schema["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap_or_default();
        return format!("[{name}](#{})", name.to_ascii_lowercase());
    }
    if let Some(choices) = schema["anyOf"].as_array() {
        let is_said = |choice: &&Value| choice["pattern"].is_null() && choice["const"] != "None";
        let all: Vec<_> = choices.iter().filter(is_said).map(value_of).collect();
        return all.join(" or ");
    }
    if let Some(items) = schema["prefixItems"].as_array() {
        return format!("({})", items.iter().map(value_of).collect::<Vec<_>>().join(", "));
    }
    match schema["type"].as_str() {
        Some("number") => "number".to_owned(),
        Some("integer") => "whole number".to_owned(),
        Some("boolean") => "`true` or `false`".to_owned(),
        Some("string") => "text".to_owned(),
        Some("array") => format!("list of {}", value_of(&schema["items"])),
        Some("object") => format!("map to {}", value_of(&schema["additionalProperties"])),
        _ => "value".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_language_is_on_the_page() {
        let page = keys_page();
        for key in ["size_px", "max_order", "heights_m", "chlorophyll_ug_cm2", "latitude_deg"] {
            assert!(page.contains(&format!("| `{key}` |")), "{key}");
        }
        // Every type that is referred to has a heading.
        for link in page.split("](#").skip(1) {
            let anchor = &link[..link.find(')').expect("a link ends")];
            let is_it = |line: &str| {
                line.strip_prefix("## ").is_some_and(|name| name.to_ascii_lowercase() == anchor)
            };
            assert!(page.lines().any(is_it), "{anchor}");
        }
    }

    #[test]
    fn a_key_has_its_default_and_a_required_one_an_example() {
        let camera = keys_about("Perspective").expect("a sensor");
        let required = "| `size_px` | (whole number, whole number) | required, e.g. `(256, 192)` |";
        assert!(camera.contains(required), "{camera}");
        let page = keys_about("Orthographic").expect("a sensor");
        assert!(page.contains("### Orthographic (Sensor)"), "{page}");
        assert!(page.contains("Columns and rows; either this or `pixel_m` is required."), "{page}");
        assert!(page.contains("| `azimuth_deg` | number | `180.0` |"), "{page}");
        let about = keys_about("AZIMUTH_deg").expect("a key");
        assert!(about.matches("| `azimuth_deg` |").count() > 2, "{about}");
    }

    #[test]
    fn every_variant_of_the_language_is_found_by_its_name() {
        for section in sections() {
            for (name, line) in &section.plain {
                let part = format!("## {}\n\n", section.of_type);
                let about = keys_about(name).expect("a variant");
                assert!(about.contains(line) && about.contains(&part), "{name}: {about}");
            }
        }
        assert_eq!(
            keys_about("perhectare").expect("a variant"),
            "## Stems\n\n- `PerHectare(..)` with number: Stems per hectare of the area where they may stand. Example: `PerHectare(400.0)`\n"
        );
        let library = keys_about("Library").expect("a variant");
        assert!(library.starts_with("## Spectrum\n\n- `Library(..)` with text: "), "{library}");
        assert_eq!(keys_about("bark_BIRCH").expect("a spectrum"), library);
        assert_eq!(keys_about("birch").expect("a word of it"), library);
        let instruments = keys_about("sentinel").expect("a word of an instrument");
        assert_eq!(instruments.matches("- `Sensor(..)`").count(), 2, "{instruments}");
        let sensor = keys_about("Sensor").expect("a type");
        assert!(sensor.contains("## BandSet\n\n- `Sensor(..)`"), "{sensor}");
    }

    #[test]
    fn an_unknown_name_has_a_nearest_one() {
        let error = keys_about("size_pix").expect_err("no such key");
        assert!(error.contains("did you mean `size_px`"), "{error}");
    }
}
