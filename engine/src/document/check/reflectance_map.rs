//! Maps of the ground's reflectance.

use super::super::diagnostic::unknown_name;
use super::super::scene::{Param, RasterBands, ReflectanceMap, Scene};
use super::{Report, ScenePath};

/// Checks a map of reflectance as far as that takes no file.
pub(super) fn check_reflectance_map(
    path: &ScenePath,
    map: &ReflectanceMap,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    if let Some(scale) = map.scale
        && !(scale.is_finite() && scale != 0.0)
    {
        let message = format!("expected a number other than 0, found {scale}");
        let help = "write 1.0 for fractions, 0.01 for percent, 0.0001 for 0 to 10000";
        report.error(path.key("scale"), message, help);
    }
    report.finite(path.key("offset"), &[map.offset]);
    if map.offset != 0.0 && map.scale.is_none() {
        let help = "write both, in place of those of the file: `scale: 0.0001, offset: -0.1`";
        report.error(path.key("offset"), "there is an `offset`, but no `scale`", help);
    }
    let path = path.key("bands");
    match &map.bands {
        RasterBands::All(band) => check_band_number(&path, band, report),
        RasterBands::Each(bands) => {
            for (name, band) in bands {
                let path = path.name(name);
                check_band_number(&path, band, report);
                if !scene.bands.iter().any(|band| band.name == *name) {
                    let known = scene.bands.iter().map(|band| band.name.as_str());
                    report.push(unknown_name(path, "band", name, known));
                }
            }
            let missing = scene.bands.iter().map(|band| &band.name);
            let missing: Vec<String> = missing
                .filter(|name| !bands.contains_key(*name))
                .take(20)
                .map(|name| format!("`{name}`"))
                .collect();
            if !missing.is_empty() && report.is_readable("bands") {
                let message = format!("no band of the raster is given for {}", missing.join(", "));
                let help = "name one for each band of the scene: by its number from 1, or its name";
                report.error(path, message, help);
            }
        }
        RasterBands::Wavelengths => {}
    }
}

fn check_band_number(path: &ScenePath, band: &Param, report: &mut Report<'_>) {
    let is_lawful = |number: f64| number >= 1.0 && number.fract() == 0.0 && number <= 65_535.0;
    if let Some(number) = band.number().filter(|&number| !is_lawful(number)) {
        let message = format!("expected the number of a band, from 1, found {number}");
        report.error(path, message, "the first band of a raster is 1, as GDAL counts");
    }
}
