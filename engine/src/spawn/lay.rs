use glam::DVec2;

use super::Spawner;
use super::georaster::RasterSource;
use crate::assets::Raster;
use crate::document::Diagnostic;
use crate::geometry::{Rectangle, place_text};
use crate::terrain::Cells;

/// How the coordinates of rasters become those of the scene: `to + (place - from) scale`, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Georeference {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    pub(super) scale: DVec2,
    pub(super) is_of_degrees: bool,
    /// True if the scene says what the coordinates of the terrain's file are.
    pub(super) is_given: bool,
}

impl Spawner<'_> {
    /// South-west corner and extent of a further raster, m, local frame: where it lies in the
    /// coordinates of the terrain's, and over the whole terrain if one of the two does not say where.
    pub(super) fn lay(
        &mut self,
        raster: &Raster,
        terrain: Rectangle,
        path: &str,
    ) -> Option<(DVec2, DVec2)> {
        let (Some(place), Some(reference)) = (&raster.place, self.georeference) else {
            return Some((terrain.min, terrain.size()));
        };
        if raster.is_in_degrees() != reference.is_of_degrees {
            let (own, others) = if reference.is_of_degrees {
                ("metres", "the terrain's are degrees")
            } else {
                ("degrees", "a scene is in metres")
            };
            let message = format!("its coordinates are {own}, but {others}");
            let target = if reference.is_of_degrees {
                "EPSG:4326".to_owned()
            } else {
                self.target_of(raster)
            };
            let help = format!(
                "reproject it to the coordinates of the others: `gdalwarp -t_srs {target} -r near in out`"
            );
            self.problems.push(Diagnostic::error(path, message).help(help));
            return None;
        }
        let corner = reference.to + (place.corner - reference.from) * reference.scale;
        Some((corner, place.cell * raster.size_in_cells() * reference.scale))
    }

    /// A raster on the terrain, of which it covers at least a part.
    pub(super) fn cells(
        &mut self,
        source: &RasterSource<'_>,
        terrain: Rectangle,
    ) -> Option<Cells<f64>> {
        let path = source.path;
        let raster = self.georaster(source)?;
        let (corner, size) = self.lay(&raster, terrain, path)?;
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
            self.problems.push(Diagnostic::error(path, message).help(help));
            return None;
        }
        let (columns, rows) = (raster.columns, raster.rows);
        Some(Cells { columns, rows, values: raster.values, corner, size })
    }
}
