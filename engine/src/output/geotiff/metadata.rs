//! Texts of a `GeoTIFF`: provenance, names, units and wavelengths of bands, colours of classes.

use std::fmt::Write as _;

use super::super::Source;
use super::super::envi::ImageRaster;
use super::super::provenance::{RECIPE, RecipeForm};
use crate::products::{Class, Image};

/// Provenance in one line, as in the other formats, without the recipe.
pub(super) fn description(source: &Source<'_>, raster: ImageRaster) -> String {
    let all = source.provenance(RecipeForm::Packed).into_iter();
    let all = all.filter(|(key, _)| *key != RECIPE).map(|(key, value)| format!("{key}: {value}"));
    let heading =
        (raster == ImageRaster::Errors).then(|| "standard errors and coverage".to_owned());
    heading.into_iter().chain(all).collect::<Vec<_>>().join("; ")
}

/// Program that has written the file.
pub(super) fn software(source: &Source<'_>) -> String {
    format!("sunfleck {}", source.report.version)
}

/// Metadata as GDAL reads them: provenance of the file; name, unit and centre wavelength of each band.
pub(super) fn gdal(
    source: &Source<'_>,
    image: &Image,
    raster: ImageRaster,
    classes: Option<&[Class]>,
) -> String {
    let mut text = "<GDALMetadata>\n".to_owned();
    let mut item = |attributes: &str, value: &str| {
        // GDAL escapes twice, and reads so. Writing to a string does not fail.
        let _infallible =
            writeln!(text, "  <Item {attributes}>{}</Item>", escaped(&escaped(value)));
    };
    for (key, value) in source.provenance(RecipeForm::Readable) {
        item(&format!("name=\"sunfleck_{key}\""), &value);
    }
    for (number, class) in classes.unwrap_or_default().iter().enumerate() {
        item(&format!("name=\"class_{}\"", number + 1), &class.name);
    }
    let unit = &source.product.unit;
    for (band, (name, nm)) in image.bands.iter().zip(source.wavelengths(image)).enumerate() {
        let name = match raster {
            ImageRaster::Values => name.clone(),
            ImageRaster::Errors => format!("{name}_se"),
        };
        item(&format!("name=\"DESCRIPTION\" sample=\"{band}\" role=\"description\""), &name);
        item(&format!("name=\"UNITTYPE\" sample=\"{band}\" role=\"unittype\""), unit);
        if nm.is_finite() {
            item(&format!("name=\"wavelength\" sample=\"{band}\""), &nm.to_string());
            item(&format!("name=\"wavelength_units\" sample=\"{band}\""), "Nanometers");
            let domain = format!("sample=\"{band}\" domain=\"IMAGERY\"");
            let micrometres = (nm / 1000.0).to_string();
            item(&format!("name=\"CENTRAL_WAVELENGTH_UM\" {domain}"), &micrometres);
        }
    }
    if raster == ImageRaster::Errors {
        let band = image.bands.len();
        item(&format!("name=\"DESCRIPTION\" sample=\"{band}\" role=\"description\""), "coverage");
        item(&format!("name=\"UNITTYPE\" sample=\"{band}\" role=\"unittype\""), "1");
    }
    text.push_str("</GDALMetadata>\n");
    text
}

/// `text` as XML holds it.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            letter if letter.is_control() => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// Colours of numbers of classes: red of all 256 bytes, green, blue, of 16 bits.
pub(super) fn colour_map(classes: &[Class]) -> Vec<u16> {
    let mut colours = vec![0; 3 * 256];
    for (number, class) in classes.iter().enumerate() {
        for (channel, value) in class.colour.into_iter().enumerate() {
            colours[channel * 256 + number + 1] = u16::from(value) * 257;
        }
    }
    colours
}
