use glam::DVec2;

use super::Site;
use crate::assets;
use crate::components::PlantingAreas;
use crate::document::{Area, Diagnostic, ScenePath};
use crate::geometry::{Polygon, Rectangle, place_text};
use crate::placement::{PlacementError, Region};
use crate::systems::Resources;
use crate::systems::coordinate_advice::area_advice;
use crate::systems::georeference::{check_crs, name_target};

/// Part of the terrain that instances may stand on; leaves the polygons at the site.
pub(super) fn region(
    terrain: Rectangle,
    inside: &[Area],
    outside: &[Area],
    site: &mut Site<'_>,
) -> Option<Region> {
    let mut owners = Vec::new();
    let mut read = |key, areas: &[Area], site: &mut Site<'_>| {
        let mut polygons = Vec::new();
        for (index, area) in areas.iter().enumerate() {
            let path = site.path.key(key).index(index);
            let of_area = polygons_of(area, &path, site)?;
            warn_area_beside(area, &of_area, terrain, &path, site.resources);
            owners.extend(of_area.iter().map(|_| path.clone()));
            polygons.extend(of_area);
        }
        Some(polygons)
    };
    let (inside, outside) = (read("inside", inside, site), read("outside", outside, site));
    let (inside, outside) = (inside?, outside?);
    let region = Region::new(terrain, &inside, &outside);
    site.areas = PlantingAreas { inside, outside };
    match region {
        Ok(region) => Some(region),
        Err(error) => {
            let (path, help) = match &error {
                PlacementError::CrossesItself { polygon, .. } => (
                    owners.get(*polygon as usize).cloned().unwrap_or_default(),
                    "list the corners of each ring in the order of its outline".to_owned(),
                ),
                PlacementError::NoGround => {
                    let Rectangle { min, max } = terrain;
                    let help = format!(
                        "the terrain reaches from {} to {} m, local frame",
                        place_text(min),
                        place_text(max)
                    );
                    (site.path.clone(), help)
                }
                _ => (site.path.clone(), String::new()),
            };
            let problem = Diagnostic::error(path, error.to_string());
            site.report(if help.is_empty() { problem } else { problem.help(help) });
            None
        }
    }
}

/// Polygons of an area in the local frame.
fn polygons_of(area: &Area, path: &ScenePath, site: &mut Site<'_>) -> Option<Vec<Polygon>> {
    let crs;
    let (read, is_georeferenced) = match area {
        Area::Polygon { outline_m, holes_m } => {
            let ring = |ring: &Vec<(f64, f64)>| ring.iter().copied().map(DVec2::from).collect();
            let rings = std::iter::once(outline_m).chain(holes_m).map(ring).collect();
            return Some(vec![Polygon { rings }]);
        }
        Area::GeoJson { file, georeferenced } => {
            let (areas, named) = match assets::read_geojson(&site.resources.file(file)) {
                Ok(areas) => (Ok(areas.polygons), areas.crs),
                Err(error) => (Err(error), None),
            };
            crs = named.map(|crs| (crs, file));
            (areas, *georeferenced)
        }
        Area::Table { file, georeferenced } => {
            crs = None;
            (assets::read_polygons(&site.resources.file(file)), *georeferenced)
        }
    };
    match read {
        Ok(mut polygons) => {
            if is_georeferenced {
                if let Some((crs, file)) = &crs {
                    let at = path.key("file");
                    check_crs(crs, file, &at, &mut site.map, site.resources)?;
                }
                let (x, y, _) = site.resources.frame.origin_m;
                let corners = polygons.iter_mut().flat_map(|polygon| &mut polygon.rings).flatten();
                corners.for_each(|corner| *corner -= DVec2::new(x, y));
            }
            Some(polygons)
        }
        Err(mut error) => {
            name_target(&mut error, &site.map);
            site.report(Diagnostic::error(path.key("file"), error.to_string()));
            None
        }
    }
}

/// Warns of an area that lies beside the terrain.
fn warn_area_beside(
    area: &Area,
    polygons: &[Polygon],
    terrain: Rectangle,
    path: &ScenePath,
    resources: &mut Resources,
) {
    let corners = || polygons.iter().flat_map(|polygon| &polygon.rings).flatten().copied();
    let low = corners().fold(DVec2::INFINITY, DVec2::min);
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
    let Rectangle { min, max } = terrain;
    if low.cmplt(max).all() && high.cmpgt(min).all() {
        return;
    }
    let message = "the area lies beside the terrain and has no effect";
    let help = format!(
        "it reaches from {} to {} m, the terrain from {} to {} m, local frame: {}",
        place_text(low),
        place_text(high),
        place_text(min),
        place_text(max),
        area_advice(area, polygons, terrain, resources)
    );
    resources.report(Diagnostic::warning(path, message).help(help));
}
