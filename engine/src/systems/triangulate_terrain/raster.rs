use glam::DVec2;

use super::land_cover::land_cover_cells;
use super::no_data::fill_no_data;
use super::steepness::warn_steepness;
use crate::assets::{Projection, Raster, RasterExtent};
use crate::components::TerrainPatch;
use crate::document::{Coordinates, Diagnostic, TerrainRaster};
use crate::geometry::Rectangle;
use crate::systems::Resources;
use crate::systems::georeference::{
    MapFrame, MapTransform, RasterQuantity, RasterSource, frame_projection, projection_of,
    read_georaster, target_of,
};
use crate::terrain::{self, Cells};

/// Heights beyond this are no heights on Earth, m: a value for no data that the file does not name.
const HIGHEST: f64 = 12_000.0;

/// Width of a raster in degrees may change by this from its middle to its edges.
const NARROWING: f64 = 0.01;

/// Ground of a raster.
pub(super) fn raster_patch(
    terrain: &TerrainRaster,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<TerrainPatch> {
    let (raster, rectangle) = read_heights(terrain, map, resources)?;
    let up = resources.frame.origin_m.2;
    let known = raster.values.iter().copied().filter(|height| !height.is_nan());
    let lowest = known.reduce(f64::min).unwrap_or(0.0);
    let shift = terrain.lowest_m.map_or(-up, |height| height - lowest);
    let heights = Cells {
        columns: raster.columns,
        rows: raster.rows,
        values: raster.values.iter().map(|height| height + shift).collect(),
        corner: rectangle.min,
        size: rectangle.size(),
    };
    warn_steepness(&heights, resources);
    let (cover, parts) = match (&terrain.material, &terrain.land_cover) {
        (Some(name), _) => {
            let material = resources.material(name, &["terrain", "material"].into())?;
            (None, vec![(name.to_string(), material)])
        }
        (None, Some(cover)) => {
            let (cells, parts) = land_cover_cells(cover, rectangle, map, resources)?;
            (Some(cells), parts)
        }
        (None, None) => return None,
    };
    let periodic = resources.is_periodic();
    let patch = terrain::raster(&heights, terrain.tolerance_m, cover.as_ref(), parts, periodic);
    let Some(mut patch) = patch else {
        let message = "none of its cells has data".to_owned();
        resources.report(Diagnostic::error(["terrain", "file"], message));
        return None;
    };
    patch.projection =
        frame_projection(map, resources).or_else(|| projection_of_raster(&raster, map, resources));
    Some(patch)
}

/// Reads the heights of a terrain; returns them with their rectangle, m, local frame. Sets the transform of the map.
fn read_heights(
    terrain: &TerrainRaster,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<(Raster, Rectangle)> {
    let TerrainRaster { file, coordinates, no_data, window, height_unit_m, size_m, .. } = terrain;
    let (east, north, _) = resources.frame.origin_m;
    let extent = window.as_ref().map(|window| {
        let corner = DVec2::from(window.corner_m) + DVec2::new(east, north);
        RasterExtent { min: corner, max: corner + DVec2::from(window.size_m) }
    });
    let path = ["terrain", "file"].into();
    let source = RasterSource {
        coordinates: coordinates.clone(),
        has_size: size_m.is_some(),
        height_unit_m: *height_unit_m,
        extent,
        ..RasterSource::new(file, &path, RasterQuantity::Heights)
    };
    let mut raster = read_georaster(&source, map, resources)?;
    if let Some(place) = &raster.place {
        map.axes = place.crs.axes.clone();
    }
    let (corner, size) = rectangle_of(&raster, terrain, map, resources)?;
    map.transform = raster.place.as_ref().map(|place| MapTransform {
        from: place.corner,
        to: corner,
        scale: size / (place.cell * raster.size_in_cells()),
        is_of_degrees: *coordinates != Some(Coordinates::Metres) && raster.is_in_degrees(),
        is_given: source.has_size || coordinates.is_some(),
    });
    fill_no_data(&mut raster, no_data, resources)?;
    if let Some(height) = raster.values.iter().find(|height| height.abs() > HIGHEST) {
        let message = format!("a height of {height} m is not of this Earth");
        let help = "if the heights are in centimetres, write `height_unit_m: 0.01` (0.1 for decimetres, \
                    0.3048 for feet); if it stands for no data, name it in the file's header \
                    (`gdal_edit.py -a_nodata`)";
        resources.report(Diagnostic::error(["terrain", "file"], message).help(help));
        return None;
    }
    Some((raster, Rectangle { min: corner, max: corner + size }))
}

/// Projection of the raster's coordinates, if they are those of the scene beyond its anchor.
fn projection_of_raster(
    raster: &Raster,
    map: &MapFrame,
    resources: &Resources,
) -> Option<Projection> {
    let place = raster.place.as_ref()?;
    let MapTransform { from, to, scale, is_of_degrees, .. } = map.transform?;
    let (x, y, _) = resources.frame.origin_m;
    let is_kept = to == from - DVec2::new(x, y) && scale == DVec2::ONE && !is_of_degrees;
    place.projection.clone().or_else(|| projection_of(&place.crs)).filter(|_| is_kept)
}

/// South-west corner and extent of a raster, m, local frame.
fn rectangle_of(
    raster: &Raster,
    terrain: &TerrainRaster,
    map: &MapFrame,
    resources: &mut Resources,
) -> Option<(DVec2, DVec2)> {
    let TerrainRaster { coordinates, corner_m, size_m, .. } = terrain;
    let (corner, size) = (corner_m.map(DVec2::from), size_m.map(DVec2::from));
    let Some(place) = &raster.place else {
        if size.is_none() {
            let message = "the file does not say how large its cells are".to_owned();
            let help = "write the extent of the whole raster: `size_m: (100.0, 100.0)`";
            resources.report(Diagnostic::error(["terrain", "file"], message).help(help));
        }
        return Some((corner.unwrap_or(DVec2::ZERO), size?));
    };
    let extent = place.cell * raster.size_in_cells();
    let problem = match coordinates {
        Some(Coordinates::Degrees) => {
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
        None if raster.is_in_degrees() => {
            let DVec2 { x, y } = place.corner;
            format!(
                "its coordinates are degrees: ({x:.6}, {y:.6}), in cells of {:.9}",
                place.cell.x
            )
        }
        _ => String::new(),
    };
    if !problem.is_empty() {
        let code = target_of(raster, map);
        let help = format!(
            "a scene is in metres: reproject it to UTM (`gdalwarp -t_srs {code} -r bilinear in \
                 out`), or write `coordinates: Degrees` to take small rasters for metres as in \
                 their middle, `coordinates: Metres` if they are metres after all"
        );
        resources.report(Diagnostic::error(["terrain", "file"], problem).help(help));
        return None;
    }
    let (x, y, _) = resources.frame.origin_m;
    Some((corner.unwrap_or(place.corner - DVec2::new(x, y)), size.unwrap_or(extent)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_at_45_north_has_the_length_of_the_tables() {
        // 78.847 km and 111.132 km on WGS 84, as any geodesy table says.
        let DVec2 { x, y } = metres_of_degree(45.0);
        assert!((x - 78_847.0).abs() < 1.0 && (y - 111_132.0).abs() < 1.0, "{x} {y}");
    }
}
