//! What to write for a sensor that takes too much memory.

use crate::components::{ImageSensor, Layers, Optics, Orthographic, Per, PhotonMeasure, Sensor};
use crate::document::rounded_up;
use crate::geometry::PixelGrid;

/// A sensor that takes less, and what makes it so.
pub(super) struct Smaller {
    pub(super) sensor: Sensor,
    /// Key below the sensor at which this is written.
    pub(super) key: String,
    /// What to write there.
    pub(super) text: String,
}

/// A sensor like this with a share of its pixels, of its views, or of the cells that one of its measures
/// counts in; `None` if nothing would be left, or nobody can choose.
pub(super) fn smaller(sensor: &Sensor, measure: usize, share: f64) -> Option<Smaller> {
    let mut sensor = sensor.clone();
    let (key, text) = match &mut sensor {
        Sensor::Image(image) => fewer_pixels(image, share)?,
        Sensor::Directions(directions) => {
            let views = (directions.views.len() as f64 * share) as usize;
            directions.views.truncate(views);
            (views > 0).then(|| (".views".to_owned(), format!("at most {views} views")))?
        }
        Sensor::Photons(photons) => {
            let text = coarser(photons.measure.get_mut(measure)?, share)?;
            (format!(".measure[{measure}]"), text)
        }
    };
    Some(Smaller { sensor, key, text })
}

/// Gives an image a share of its pixels; returns the key and what to write there.
fn fewer_pixels(image: &mut ImageSensor, share: f64) -> Option<(String, String)> {
    if let Optics::Orthographic(Orthographic { pixel: Some(side), .. }) = &mut image.optics {
        let extent = image.size.as_dvec2() * *side;
        *side = rounded_up(*side / share.sqrt());
        image.size = PixelGrid::covering(extent, *side).counts.as_uvec2();
        return Some((".pixel_m".to_owned(), format!("`pixel_m: {side:?}`")));
    }
    let size = (image.size.as_dvec2() * share.sqrt()).as_uvec2();
    image.size = Some(size).filter(|size| size.min_element() > 0)?;
    Some((".size_px".to_owned(), format!("`size_px: ({}, {})`", size.x, size.y)))
}

/// Makes a measure count in a share of its cells.
fn coarser(measure: &mut PhotonMeasure, share: f64) -> Option<String> {
    // Least numbers of cells are those of the scene language.
    let fewer = |cells: &mut u32| {
        *cells = Some((f64::from(*cells) * share) as u32).filter(|cells| *cells >= 4)?;
        Some(*cells)
    };
    Some(match measure {
        PhotonMeasure::BrfCells(cells) => format!("`BrfCells({})`", fewer(cells)?),
        PhotonMeasure::RadianceCells(cells) => format!("`RadianceCells({})`", fewer(cells)?),
        PhotonMeasure::Fluxes { pixel, .. } => {
            *pixel = rounded_up(*pixel / share.sqrt());
            format!("`pixel_m: {pixel:?}`")
        }
        PhotonMeasure::Fapar(Layers::Thickness(thickness)) => {
            *thickness = rounded_up(*thickness / share);
            format!("`layer_m: {thickness:?}`")
        }
        PhotonMeasure::Absorbed(per @ Per::Triangle) => {
            *per = Per::Instance;
            "`per: Instance`".to_owned()
        }
        _ => return None,
    })
}
