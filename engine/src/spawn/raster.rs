use std::collections::BTreeMap;

use glam::DVec2;

use super::Spawner;
use super::lay::Georeference;
use crate::assets::{Projection, Raster, Unit, read_raster};
use crate::components::TerrainPatch;
use crate::document::{Coordinates, Diagnostic, LandCover, NoData, Terrain, unknown_name};
use crate::geometry::Rectangle;
use crate::terrain::{self, Cells, Parts};

/// Heights beyond this are no heights on Earth, m: a value for no data that the file does not name.
const HIGHEST: f64 = 12_000.0;

/// Width of a raster in degrees may change by this from its middle to its edges.
const NARROWING: f64 = 0.01;

impl Spawner<'_> {
    /// The terrain of a raster.
    pub(super) fn raster(&mut self) -> Option<TerrainPatch> {
        let scene = self.scene;
        let Terrain::Raster {
            file,
            material,
            land_cover,
            tolerance_m,
            coordinates,
            no_data,
            lowest_m,
            ..
        } = &scene.terrain
        else {
            return None;
        };
        let mut raster = self.read(file, "terrain.file")?;
        let (corner, size) = self.rectangle_of(&raster)?;
        self.georeference = raster.place.as_ref().map(|place| Georeference {
            from: place.corner,
            to: corner,
            scale: size / (place.cell * raster.size_in_cells()),
            is_of_degrees: *coordinates != Some(Coordinates::Metres) && raster.is_in_degrees(),
        });
        self.fill(&mut raster, no_data)?;
        let known = || raster.values.iter().filter(|height| !height.is_nan());
        let beyond = known().find(|height| height.abs() > HIGHEST);
        if let Some(height) = beyond {
            let message = format!("a height of {height} m is not of this Earth");
            let help = "if it stands for no data, name it in the file's header";
            self.problems.push(Diagnostic::error("terrain.file", message).help(help));
            return None;
        }
        let lowest = known().copied().reduce(f64::min).unwrap_or(0.0);
        let shift = lowest_m.map_or(-scene.frame.origin_m.2, |height| height - lowest);
        let heights = Cells {
            columns: raster.columns,
            rows: raster.rows,
            values: raster.values.iter().map(|height| height + shift).collect(),
            corner,
            size,
        };
        let (cover, parts) = match (material, land_cover) {
            (Some(name), _) => {
                (None, vec![(name.clone(), self.known_material(name, "terrain.material")?)])
            }
            (None, Some(cover)) => {
                let (cells, parts) =
                    self.land_cover(cover, Rectangle { min: corner, max: corner + size })?;
                (Some(cells), parts)
            }
            (None, None) => return None,
        };
        let periodic = self.is_periodic();
        let mut patch = terrain::raster(&heights, *tolerance_m, cover.as_ref(), parts, periodic);
        if let Some(patch) = &mut patch {
            patch.projection = self.projection(&raster);
        }
        if patch.is_none() {
            let message = "none of its cells has data".to_owned();
            self.problems.push(Diagnostic::error("terrain.file", message));
        }
        patch
    }

    /// Projection of the raster's coordinates, if they are those of the scene beyond its anchor.
    fn projection(&self, raster: &Raster) -> Option<Projection> {
        let place = raster.place.as_ref()?;
        let Georeference { from, to, scale, is_of_degrees } = self.georeference?;
        let (x, y, _) = self.scene.frame.origin_m;
        let is_kept = to == from - DVec2::new(x, y) && scale == DVec2::ONE && !is_of_degrees;
        place.projection.clone().filter(|_| is_kept)
    }

    pub(super) fn read(&mut self, file: &str, path: &str) -> Option<Raster> {
        let file = self.file(file);
        self.files.extend(crate::assets::companion(&file));
        match read_raster(&file) {
            Ok(raster) => Some(raster),
            Err(error) => {
                self.problems.push(Diagnostic::error(path, error.to_string()));
                None
            }
        }
    }

    /// South-west corner and extent of a raster, m, local frame.
    fn rectangle_of(&mut self, raster: &Raster) -> Option<(DVec2, DVec2)> {
        let scene = self.scene;
        let Terrain::Raster { coordinates, corner_m, size_m, .. } = &scene.terrain else {
            return None;
        };
        let (corner, size) = (corner_m.map(DVec2::from), size_m.map(DVec2::from));
        let Some(place) = &raster.place else {
            if size.is_none() {
                let message = "the file does not say how large its cells are".to_owned();
                let help = "write the extent of the whole raster: `size_m: (100.0, 100.0)`";
                self.problems.push(Diagnostic::error("terrain.file", message).help(help));
            }
            return Some((corner.unwrap_or(DVec2::ZERO), size?));
        };
        let extent = place.cell * raster.size_in_cells();
        let problem = match (coordinates, &place.unit) {
            (Some(Coordinates::Degrees), _) => {
                let latitude = place.corner.y + 0.5 * extent.y;
                let narrowing = latitude.to_radians().tan().abs() * 0.5 * extent.y.to_radians();
                if narrowing < NARROWING && latitude.abs() < 89.0 {
                    let size = size.unwrap_or(extent * metres_of_degree(latitude));
                    return Some((corner.unwrap_or(DVec2::ZERO), size));
                }
                let narrowing = 100.0 * narrowing;
                format!("its rows differ in length by {narrowing:.1} % from its middle's")
            }
            _ if size.is_some() => String::new(),
            (None, _) if raster.is_in_degrees() => {
                let DVec2 { x, y } = place.corner;
                format!("its coordinates are degrees: ({x}, {y}), in cells of {}", place.cell.x)
            }
            (None, Unit::Other(name)) => format!("its coordinates are in {name}"),
            _ => String::new(),
        };
        if !problem.is_empty() {
            // Six degrees a zone, from the date line eastwards.
            let zone = ((place.corner.x + 0.5 * extent.x + 180.0) / 6.0).floor() as i64 + 1;
            let half = if place.corner.y < 0.0 { 7 } else { 6 };
            let code = if (1..=60).contains(&zone) && raster.is_in_degrees() {
                format!("EPSG:32{half}{zone:02}")
            } else {
                "EPSG:326..".to_owned()
            };
            let help = format!(
                "a scene is in metres: reproject it to UTM (`gdalwarp -t_srs {code} -r bilinear in \
                 out`), or write `coordinates: Degrees` to take small rasters for metres as in \
                 their middle, `coordinates: Metres` if they are metres after all"
            );
            self.problems.push(Diagnostic::error("terrain.file", problem).help(help));
            return None;
        }
        let (x, y, _) = scene.frame.origin_m;
        Some((corner.unwrap_or(place.corner - DVec2::new(x, y)), size.unwrap_or(extent)))
    }

    /// Deals with cells without data.
    fn fill(&mut self, raster: &mut Raster, no_data: &NoData) -> Option<()> {
        let missing = raster.missing();
        if missing == 0 {
            return Some(());
        }
        match no_data {
            NoData::Refuse => {
                let (all, help) = (
                    raster.values.len(),
                    "write `no_data: Neighbours` to fill them from around, `Height(0.0)` to level \
                     them, or `Hole` to leave them out",
                );
                let message = format!("{missing} of its {all} cells have no data");
                self.problems.push(Diagnostic::error("terrain.file", message).help(help));
                return None;
            }
            NoData::Neighbours => grow(raster),
            NoData::Height(height) => {
                raster.values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = *height);
            }
            NoData::Hole => {}
        }
        Some(())
    }

    /// The part of each cell of a land cover, and the parts.
    fn land_cover(&mut self, cover: &LandCover, terrain: Rectangle) -> Option<(Cells<u16>, Parts)> {
        let raster = self.read(&cover.file, "terrain.land_cover.file")?;
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

/// Length of a degree of longitude and latitude, m, on the WGS 84 ellipsoid.
///
/// Source: radii of curvature in the prime vertical and in the meridian, NIMA TR8350.2 (2000).
fn metres_of_degree(latitude: f64) -> DVec2 {
    const SEMI_MAJOR: f64 = 6_378_137.0;
    const FLATTENING: f64 = 1.0 / 298.257_223_563;
    const SQUARED_ECCENTRICITY: f64 = FLATTENING * (2.0 - FLATTENING);
    let (sin, cos) = latitude.to_radians().sin_cos();
    let root = (1.0 - SQUARED_ECCENTRICITY * sin * sin).sqrt();
    let meridian = SEMI_MAJOR * (1.0 - SQUARED_ECCENTRICITY) / root.powi(3);
    DVec2::new(SEMI_MAJOR / root * cos, meridian) * 1_f64.to_radians()
}

/// Gives cells without data the mean of their eight neighbours that have any, ring by ring.
fn grow(raster: &mut Raster) {
    let (columns, rows) = (raster.columns, raster.rows);
    let around = |cell: usize| {
        let (x, y) = (cell % columns, cell / columns);
        let (xs, ys) =
            (x.saturating_sub(1)..(x + 2).min(columns), y.saturating_sub(1)..(y + 2).min(rows));
        ys.flat_map(move |y| xs.clone().map(move |x| y * columns + x))
    };
    let mut candidates: Vec<usize> =
        (0..raster.values.len()).filter(|&cell| raster.values[cell].is_nan()).collect();
    while !candidates.is_empty() {
        let mut ring = Vec::new();
        for &cell in &candidates {
            let known = around(cell).map(|c| raster.values[c]).filter(|height| !height.is_nan());
            let (sum, count) =
                known.fold((0.0, 0), |(sum, count), height| (sum + height, count + 1));
            if count > 0 {
                ring.push((cell, sum / f64::from(count)));
            }
        }
        for &(cell, height) in &ring {
            raster.values[cell] = height;
        }
        // The next ring lies around this one: to ask all cells each time would never end.
        let next = ring.iter().flat_map(|&(cell, _)| around(cell));
        candidates = next.filter(|&cell| raster.values[cell].is_nan()).collect();
        candidates.sort_unstable();
        candidates.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_at_45_north_has_the_length_of_the_tables() {
        // 78.847 km and 111.132 km on WGS 84, as any geodesy table says.
        let DVec2 { x, y } = metres_of_degree(45.0);
        assert!((x - 78_847.0).abs() < 1.0 && (y - 111_132.0).abs() < 1.0, "{x} {y}");
    }

    #[test]
    fn cells_without_data_are_filled_ring_by_ring() {
        let nan = f64::NAN;
        let values = vec![1.0, nan, nan, 4.0];
        let mut raster =
            Raster { columns: 4, rows: 1, values, place: None, class_names: Vec::new() };
        grow(&mut raster);
        assert_eq!(raster.values, [1.0, 1.0, 4.0, 4.0]);
        // Of one known cell among 2^20, a thousand rings: in no time.
        let mut values = vec![nan; 1 << 20];
        values[0] = 7.0;
        let mut raster = Raster {
            columns: 1 << 10,
            rows: 1 << 10,
            values,
            place: None,
            class_names: Vec::new(),
        };
        grow(&mut raster);
        assert!(raster.values.iter().all(|&height| (height - 7.0).abs() < 1e-12));
    }
}
