//! What to write for a sensor that takes too much memory.

use crate::components::{Layers, Per, PhotonMeasure, Sensor};

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
        Sensor::Image(image) => {
            let size = (image.size.as_dvec2() * share.sqrt()).as_uvec2();
            image.size = Some(size).filter(|size| size.min_element() > 0)?;
            (".size_px".to_owned(), format!("`size_px: ({}, {})`", size.x, size.y))
        }
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

/// The same or up to a tenth more, with two digits.
fn rounded_up(value: f64) -> f64 {
    format!("{:.1e}", 1.05 * value).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        for value in [1.0, 1.01, 1.049, 2.34, 9.95, 0.3, 1e-9, 7.77e5] {
            let rounded = rounded_up(value);
            assert!((1.0..1.11).contains(&(rounded / value)), "{value}: {rounded}");
            assert!(format!("{rounded:e}").len() <= "1.2e-10".len(), "{rounded}");
        }
    }
}
