//! Classes of the ground.

use std::collections::BTreeMap;

use super::Spawner;
use super::georaster::{Quantity, RasterSource};
use crate::assets::Raster;
use crate::document::{Diagnostic, LandCover, unknown_name};
use crate::geometry::Rectangle;
use crate::terrain::{Cells, Parts};

impl Spawner<'_> {
    /// The part of each cell of a land cover, and the parts.
    pub(super) fn land_cover(
        &mut self,
        cover: &LandCover,
        terrain: Rectangle,
    ) -> Option<(Cells<u16>, Parts)> {
        let source = RasterSource {
            extent: self.extent_of(terrain),
            ..RasterSource::new(&cover.file, "terrain.land_cover.file", Quantity::Classes)
        };
        let raster = self.georaster(&source)?;
        for name in cover.classes.keys().filter(|name| name.parse::<f64>().is_err()) {
            if !raster.class_names.contains(name) {
                let known = raster.class_names.iter().map(String::as_str);
                let path = format!("terrain.land_cover.classes.{name}");
                self.problems.push(unknown_name(path, "class", name, known));
            }
        }
        let (low, size) = self.lay(&raster, terrain, "terrain.land_cover.file")?;
        let (high, room) = (low + size, 1e-6 * terrain.size());
        if !(low.cmple(terrain.min + room).all() && high.cmpge(terrain.max - room).all()) {
            let Rectangle { min, max } = terrain;
            let message = format!(
                "the land cover reaches from ({}, {}) to ({}, {}) m, the heights from ({}, {}) to \
                 ({}, {}) m",
                low.x, low.y, high.x, high.y, min.x, min.y, max.x, max.y
            );
            let help = "give every place a class, or cut the heights";
            self.problems.push(Diagnostic::error("terrain.land_cover.file", message).help(help));
            return None;
        }
        let mut parts: Parts = Vec::new();
        let mut known: BTreeMap<i64, Option<u16>> = BTreeMap::new();
        let mut values = Vec::with_capacity(raster.values.len());
        for &class in &raster.values {
            // Classes are whole numbers; what has no data is a class without a number.
            let key = if class.is_nan() { i64::MIN } else { class as i64 };
            let part =
                known.entry(key).or_insert_with(|| self.class(class, cover, &raster, &mut parts));
            values.push(part.unwrap_or(0));
        }
        if known.values().any(Option::is_none) {
            return None;
        }
        let (columns, rows) = (raster.columns, raster.rows);
        Some((Cells { columns, rows, values, corner: low, size }, parts))
    }

    /// The part of a class; a note if it has no material.
    fn class(
        &mut self,
        class: f64,
        cover: &LandCover,
        raster: &Raster,
        parts: &mut Parts,
    ) -> Option<u16> {
        let path = "terrain.land_cover.classes";
        let number = class.to_string();
        let name = raster.class_names.get(class as usize).filter(|_| class >= 0.0);
        let written = |text: &str| text.parse::<f64>().ok() == Some(class);
        let material = cover
            .classes
            .iter()
            .find(|(key, _)| written(key) || Some(*key) == name)
            .map(|(_, material)| material);
        let Some(material) = material else {
            let message = match name {
                _ if class.is_nan() => "the land cover has cells without data".to_owned(),
                Some(name) => format!("class {number} (`{name}`) has no material"),
                None => format!("class {number} has no material"),
            };
            let help = if class.is_nan() {
                "give them a class".to_owned()
            } else {
                format!("add `\"{number}\": \"..\"` with the name of a material")
            };
            self.problems.push(Diagnostic::error(path, message).help(help));
            return None;
        };
        let id = self.known_material(material, &format!("{path}.{number}"))?;
        // Classes of one material need no border between them.
        let part = parts.iter().position(|(_, known)| *known == id).unwrap_or_else(|| {
            parts.push((material.clone(), id));
            parts.len() - 1
        });
        Some(part as u16)
    }
}
