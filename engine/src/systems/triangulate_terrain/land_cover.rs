use std::collections::BTreeMap;

use crate::assets::Raster;
use crate::counts::counted;
use crate::document::{Diagnostic, LandCover, ScenePath, unknown_name};
use crate::geometry::{Rectangle, millimetres, place_text};
use crate::systems::Resources;
use crate::systems::georeference::{
    MapFrame, RasterQuantity, RasterSource, extent_on_map, locate_raster, read_georaster,
};
use crate::terrain::{Cells, Parts};

/// Classes that an error names.
const MOST_NAMED: usize = 8;

/// Part of the ground that each cell of a land cover belongs to, and the parts.
pub(super) fn land_cover_cells(
    cover: &LandCover,
    terrain: Rectangle,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<(Cells<u16>, Parts)> {
    let file = ScenePath::from(["terrain", "land_cover", "file"]);
    let source = RasterSource {
        extent: extent_on_map(terrain, map),
        ..RasterSource::new(&cover.file, &file, RasterQuantity::Classes)
    };
    let raster = read_georaster(&source, map, resources)?;
    for name in cover.classes.keys().filter(|name| name.parse::<f64>().is_err()) {
        if !raster.class_names.contains(name) {
            let known = raster.class_names.iter().map(String::as_str);
            let path = ScenePath::from(["terrain", "land_cover", "classes"]).name(name);
            resources.report(unknown_name(path, "class", name, known));
        }
    }
    let (low, size) = locate_raster(&raster, terrain, &file, map, resources)?;
    let (high, room) = (low + size, 1e-6 * terrain.size());
    if !(low.cmple(terrain.min + room).all() && high.cmpge(terrain.max - room).all()) {
        let Rectangle { min, max } = terrain;
        let message = format!(
            "the land cover reaches from {} to {} m, the heights from {} to {} m",
            place_text(low),
            place_text(high),
            place_text(min),
            place_text(max)
        );
        let help = "give every place a class, or cut the heights";
        resources.report(Diagnostic::error(file, message).help(help));
        return None;
    }
    let mut parts: Parts = Vec::new();
    let mut known: BTreeMap<u64, Option<u16>> = BTreeMap::new();
    let mut missing = Vec::new();
    let mut values = Vec::with_capacity(raster.values.len());
    for &class in &raster.values {
        // Cells without data are a class without a number; the sum makes 0 of -0.
        let key = if class.is_nan() { f64::NAN.to_bits() } else { (class + 0.0).to_bits() };
        let part = known.entry(key).or_insert_with(|| {
            let Some(material) = material_of(class, cover, &raster) else {
                missing.push(class);
                return None;
            };
            part_of_class(class, material, &mut parts, resources)
        });
        values.push(part.unwrap_or(0));
    }
    refuse_missing(missing, &raster, resources);
    if known.values().any(Option::is_none) {
        return None;
    }
    let (columns, rows) = (raster.columns, raster.rows);
    Some((Cells { columns, rows, values, corner: low, size }, parts))
}

/// Part of a class with this material; `None` after an error.
fn part_of_class(
    class: f64,
    material: &str,
    parts: &mut Parts,
    resources: &mut Resources,
) -> Option<u16> {
    let path = ScenePath::from(["terrain", "land_cover", "classes"]).name(class.to_string());
    let id = resources.material(material, &path)?;
    // Classes of one material need no border between them.
    let part = parts.iter().position(|(_, known)| *known == id).unwrap_or_else(|| {
        parts.push((material.to_owned(), id));
        parts.len() - 1
    });
    Some(part as u16)
}

/// Refuses classes that have no material, all in one error.
fn refuse_missing(mut missing: Vec<f64>, raster: &Raster, resources: &mut Resources) {
    let path = ["terrain", "land_cover", "classes"];
    if missing.iter().any(|class| class.is_nan()) {
        let message = "the land cover has cells without data";
        let help = "give them a class";
        resources.report(Diagnostic::error(path, message).help(help));
        missing.retain(|class| !class.is_nan());
    }
    missing.sort_by(f64::total_cmp);
    let Some(first) = missing.first() else { return };
    let shown: Vec<String> =
        missing.iter().take(MOST_NAMED).map(|&class| class_text(class, raster)).collect();
    let more = match missing.len() - shown.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let message = match missing.len() {
        1 => format!("class {} has no material", shown[0]),
        count => {
            format!("{} have no material: {}{more}", counted(count, "class"), shown.join(", "))
        }
    };
    let help = if missing.iter().any(|class| class.fract() != 0.0) {
        "classes are whole numbers: is this a raster of heights or of another quantity?".to_owned()
    } else if missing.len() == 1 {
        format!("add `\"{first}\": \"..\"` with the name of a material")
    } else {
        format!("add `\"{first}\": \"..\"` with the name of a material, and so on for each")
    };
    resources.report(Diagnostic::error(path, message).help(help));
}

/// Name of the material of a class.
fn material_of<'c>(class: f64, cover: &'c LandCover, raster: &Raster) -> Option<&'c str> {
    let name = class_name(class, raster);
    let is_written = |text: &str| text.parse::<f64>().ok() == Some(class);
    let entry = cover.classes.iter().find(|(key, _)| is_written(key) || Some(key.as_str()) == name);
    entry.map(|(_, material)| material.as_str())
}

/// Name of a class in the raster's file.
fn class_name(class: f64, raster: &Raster) -> Option<&str> {
    raster.class_names.get(class as usize).filter(|_| class >= 0.0).map(String::as_str)
}

/// A class for a message, with its name.
fn class_text(class: f64, raster: &Raster) -> String {
    let number = millimetres(class);
    class_name(class, raster)
        .map_or_else(|| number.to_string(), |name| format!("{number} (`{name}`)"))
}
