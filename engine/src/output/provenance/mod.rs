//! Origin of results: what every file says of it, and how it is read again.
//!
//! Each format holds keys and values in its own way; the value of `recipe` repeats the run ([`RecipeRecord`]).
//!
//! | format | keys and values | recipe |
//! |---|---|---|
//! | `summary.json` | keys of the object | an object |
//! | EXR | JSON in the attribute `comments` | as JSON |
//! | PNG | `iTXt` chunks | as JSON |
//! | `GeoTIFF` | items `sunfleck_..` of the metadata of GDAL | as JSON |
//! | Zarr, `NetCDF` | global attributes | as JSON |
//! | SVG | JSON in the element `metadata` | as JSON |
//! | ENVI | `description` of the header | packed |
//! | CSV, PLY | comments | packed |

mod extract;
mod read;
mod record;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;

pub use read::{RecordError, read_record};
pub use record::RecipeRecord;
pub(super) use record::RecipeTexts;

use super::Source;
use crate::products::Report;

/// Key of the recipe.
pub(super) const RECIPE: &str = "recipe";

/// Form of a recipe in a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RecipeForm {
    /// As JSON, if it is short.
    Readable,
    /// Compressed text of letters, digits and a few signs alone, for formats that split or change texts.
    Packed,
}

/// Keys and values that every file of a sensor contains.
pub(super) fn of_sensor(
    report: &Report,
    sensor: &str,
    recipe: &RecipeTexts,
    form: RecipeForm,
) -> Vec<(&'static str, String)> {
    let params = report.params.iter().map(|(name, value)| format!("{name}={value}"));
    let params = params.collect::<Vec<_>>().join(" ");
    let mut all = vec![
        ("scene", in_a_line(&report.scene)),
        ("params", in_a_line(&params)),
        ("hash", in_a_line(&report.hash)),
        ("version", in_a_line(&report.version)),
        ("seed", report.seed.to_string()),
        ("sensor", in_a_line(sensor)),
        (RECIPE, recipe.text(form).to_owned()),
    ];
    let may_lack = |key: &str| key == "params" || key == RECIPE;
    all.retain(|(key, value)| !may_lack(key) || !value.is_empty());
    all
}

impl Source<'_> {
    /// Keys and values that every file of a product contains.
    pub(super) fn provenance(&self, form: RecipeForm) -> Vec<(&'static str, String)> {
        let mut all = of_sensor(self.report, self.sensor, self.recipe, form);
        let product =
            [("product", in_a_line(&self.product.name)), ("unit", in_a_line(&self.product.unit))];
        // The recipe is long: it comes last.
        let place = all.iter().position(|(key, _)| *key == RECIPE).unwrap_or(all.len());
        all.splice(place..place, product);
        all
    }

    /// Keys and values as one JSON object.
    pub(super) fn provenance_json(&self) -> String {
        let all = self.provenance(RecipeForm::Readable);
        let all = all.into_iter().map(|(key, value)| (key.to_owned(), value.into()));
        serde_json::Value::Object(all.collect()).to_string()
    }
}

/// A text in one line: a line break in a title must not end a comment.
fn in_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
