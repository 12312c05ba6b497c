//! Advice for a sensor that takes too much memory.

use crate::components::{
    ImageSensor, Layers, Optics, OrthographicOptics, Per, PhotonMeasure, ResolvedSensor,
};
use crate::document::{ScenePath, rounded_up};
use crate::geometry::PixelGrid;

/// Sensor that takes less memory, and the change that makes it smaller.
pub(super) struct Smaller {
    pub(super) sensor: ResolvedSensor,
    /// Path of the value to change.
    pub(super) path: ScenePath,
    /// Text to write there.
    pub(super) text: String,
}

/// Sensor with a fraction of its pixels, its views, or the cells of one of its measures; `None` if nothing would be left,
/// or if the measure has no such choice.
pub(super) fn smaller(
    sensor: &ResolvedSensor,
    path: &ScenePath,
    measure: usize,
    fraction: f64,
) -> Option<Smaller> {
    let mut sensor = sensor.clone();
    let (path, text) = match &mut sensor {
        ResolvedSensor::Image(image) => {
            let (key, text) = fewer_pixels(image, fraction)?;
            (path.key(key), text)
        }
        ResolvedSensor::Directions(directions) => {
            let views = (directions.views.len() as f64 * fraction) as usize;
            directions.views.truncate(views);
            (views > 0).then(|| (path.key("views"), format!("at most {views} views")))?
        }
        ResolvedSensor::Photons(photons) => {
            let text = coarser(&mut photons.products.get_mut(measure)?.measure, fraction)?;
            (path.key("measure").index(measure), text)
        }
    };
    Some(Smaller { sensor, path, text })
}

/// Reduces the pixels of an image to a fraction; returns the key and the text to write there.
fn fewer_pixels(image: &mut ImageSensor, fraction: f64) -> Option<(&'static str, String)> {
    if let Optics::Orthographic(OrthographicOptics { pixel: Some(side), .. }) = &mut image.optics {
        let extent = image.size.as_dvec2() * *side;
        *side = rounded_up(*side / fraction.sqrt());
        image.size = PixelGrid::covering(extent, *side).counts.as_uvec2();
        return Some(("pixel_m", format!("`pixel_m: {side:?}`")));
    }
    let size = (image.size.as_dvec2() * fraction.sqrt()).as_uvec2();
    image.size = Some(size).filter(|size| size.min_element() > 0)?;
    Some(("size_px", format!("`size_px: ({}, {})`", size.x, size.y)))
}

/// Reduces the cells of a measure to a fraction; returns the text to write.
fn coarser(measure: &mut PhotonMeasure, fraction: f64) -> Option<String> {
    // Least numbers of cells are those of the scene language.
    let fewer = |cells: &mut u32| {
        *cells = Some((f64::from(*cells) * fraction) as u32).filter(|cells| *cells >= 4)?;
        Some(*cells)
    };
    Some(match measure {
        PhotonMeasure::BrfCells(cells) => format!("`BrfCells({})`", fewer(cells)?),
        PhotonMeasure::RadianceCells(cells) => format!("`RadianceCells({})`", fewer(cells)?),
        PhotonMeasure::Fluxes { pixel_m, .. } => {
            *pixel_m = rounded_up(*pixel_m / fraction.sqrt());
            format!("`pixel_m: {pixel_m:?}`")
        }
        PhotonMeasure::Fapar { layer_m: Layers::Thickness(thickness) } => {
            *thickness = rounded_up(*thickness / fraction);
            format!("`layer_m: {thickness:?}`")
        }
        PhotonMeasure::Absorbed { per: per @ Per::Triangle } => {
            *per = Per::Instance;
            "`per: Instance`".to_owned()
        }
        _ => return None,
    })
}
