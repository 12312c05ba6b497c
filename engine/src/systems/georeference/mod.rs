//! Coordinates of the map: reference systems of files, and rasters at their place in the local frame.

mod crs;
mod raster;

use glam::DVec2;

use super::Resources;
use crate::assets::{Axes, Crs, Raster};
use crate::document::{Diagnostic, ScenePath};
use crate::geometry::{Rectangle, place_text};
use crate::terrain::Cells;

pub(super) use crs::{check_crs, frame_projection, name_target, projection_of};
pub(super) use raster::{
    RasterQuantity, RasterSource, check_georaster, extent_on_map, read_georaster, target_of,
};

/// Coordinate reference system of the scene.
#[derive(Clone, Debug)]
pub struct CoordinateSystem {
    pub(super) crs: Crs,
    /// Source that names it: `frame.crs` or a file.
    pub(super) owner: String,
}

/// Relation between the map and the local frame, a component of the terrain.
#[derive(Clone, Debug)]
pub struct MapFrame {
    /// Coordinate reference system of the scene, if it is known.
    pub(super) crs: Option<CoordinateSystem>,
    /// Coordinates of rasters in the local frame; `None` if the raster of the terrain has no georeference.
    pub(super) transform: Option<MapTransform>,
    /// Unit and kind of the coordinates of the terrain's raster.
    pub(super) axes: Axes,
}

/// Transformation of coordinates of the map to the local frame: `to + (place - from) scale`, m.
#[derive(Clone, Copy, Debug)]
pub struct MapTransform {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    pub(super) scale: DVec2,
    pub(super) is_of_degrees: bool,
    /// True if the scene says what the coordinates of the terrain's file are.
    pub(super) is_given: bool,
}

impl MapTransform {
    /// Transformation by the anchor of the frame.
    pub(super) fn from_frame(resources: &Resources) -> Self {
        let (x, y, _) = resources.frame.origin_m;
        Self {
            from: DVec2::new(x, y),
            to: DVec2::ZERO,
            scale: DVec2::ONE,
            is_of_degrees: false,
            is_given: false,
        }
    }

    /// Place in the local frame of a place on the map, m.
    pub(super) fn apply(&self, place: DVec2) -> DVec2 {
        self.to + (place - self.from) * self.scale
    }
}

impl MapFrame {
    /// Map of the frame, before the terrain's raster is read.
    pub(super) fn from_frame(resources: &Resources) -> Self {
        let transform = Some(MapTransform::from_frame(resources));
        Self { crs: resources.frame_crs.clone(), transform, axes: Axes::Unknown }
    }
}

/// South-west corner and extent of a raster, m, local frame: by the georeference of the terrain's raster, or the
/// whole terrain if one of the two rasters has no georeference.
pub(super) fn locate_raster(
    raster: &Raster,
    terrain: Rectangle,
    path: &ScenePath,
    map: &MapFrame,
    resources: &mut Resources,
) -> Option<(DVec2, DVec2)> {
    let (Some(place), Some(reference)) = (&raster.place, map.transform) else {
        return Some((terrain.min, terrain.size()));
    };
    if raster.is_in_degrees() != reference.is_of_degrees {
        let (own, others) = if reference.is_of_degrees {
            ("metres", "the terrain's are degrees")
        } else {
            ("degrees", "a scene is in metres")
        };
        let message = format!("its coordinates are {own}, but {others}");
        let target =
            if reference.is_of_degrees { "EPSG:4326".to_owned() } else { target_of(raster, map) };
        let help = format!(
            "reproject it to the coordinates of the others: `gdalwarp -t_srs {target} -r near in out`"
        );
        resources.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let corner = reference.to + (place.corner - reference.from) * reference.scale;
    Some((corner, place.cell * raster.size_in_cells() * reference.scale))
}

/// Reads a raster that covers at least a part of the terrain.
pub(super) fn read_raster_on_terrain(
    source: &RasterSource<'_>,
    terrain: Rectangle,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<Cells<f64>> {
    let path = source.path;
    let raster = read_georaster(source, map, resources)?;
    let (corner, size) = locate_raster(&raster, terrain, path, map, resources)?;
    let end = corner + size;
    if !(corner.cmplt(terrain.max).all() && end.cmpgt(terrain.min).all()) {
        let message = format!(
            "it reaches from {} to {} m, the terrain from {} to {} m",
            place_text(corner),
            place_text(end),
            place_text(terrain.min),
            place_text(terrain.max)
        );
        let help = "rasters lie where their files say, less `frame.origin_m`";
        resources.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let (columns, rows) = (raster.columns, raster.rows);
    Some(Cells { columns, rows, values: raster.values, corner, size })
}
