//! Number of pixels of an image.

use glam::DVec2;

use super::super::diagnostic::Diagnostic;
use super::super::scene::Scene;
use super::sensor::VALUES;
use super::{Report, ScenePath};
use crate::counts::counted;
use crate::geometry::PixelGrid;

/// Pixels that an image may have in a row or a column.
const MOST_PIXELS: u32 = 65536;

/// Checks the number of pixels where it is written.
pub(super) fn check_size(
    path: &ScenePath,
    (columns, rows): (u32, u32),
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let at = path.key("size_px");
    for (axis, pixels) in [columns, rows].into_iter().enumerate() {
        if !(1..=MOST_PIXELS).contains(&pixels) {
            let message = format!("expected 1 to {MOST_PIXELS} pixels, found {pixels}");
            report.error(at.index(axis), message, "`size_px` is (columns, rows)");
        }
    }
    let values = f64::from(columns) * f64::from(rows) * scene.bands.len() as f64;
    if values > VALUES {
        let message = format!(
            "{columns} x {rows} pixels in {} are more than an image may hold",
            counted(scene.bands.len(), "band")
        );
        report.error(at, message, format!("keep the product below {VALUES}"));
    }
}

/// Checks what a parallel projection says of its pixels: their number, or their side and, with it,
/// their number if the extent is written.
pub(super) fn check_pixels(
    path: &ScenePath,
    size_px: Option<(u32, u32)>,
    pixel_m: Option<f64>,
    extent_m: Option<(f64, f64)>,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let at = path.key("pixel_m");
    if let Some(size) = size_px {
        check_size(path, size, scene, report);
    }
    match (size_px, pixel_m) {
        (Some(_), Some(_)) => {
            let message = "`pixel_m` and `size_px` both say how many pixels the image has";
            report.error(&at, message, "take one of the two out");
        }
        (None, None) if report.is_whole(path) => {
            let message =
                "nothing says how many pixels the image has: neither `size_px` nor `pixel_m`";
            let help = "write `size_px: (256, 256)` for columns and rows, or `pixel_m: 0.5` for the \
                        side of a pixel in metres";
            report.error(path, message, help);
        }
        _ => {}
    }
    let Some(side) = pixel_m else { return };
    report.above_zero(&at, side);
    if let Some((width, height)) = extent_m
        && [side, width, height].iter().all(|length| *length > 0.0 && length.is_finite())
        && let Some(problem) =
            too_many_pixels(&at, DVec2::new(width, height), side, scene.bands.len())
    {
        report.push(problem);
    }
}

/// Returns a problem at `path` if square pixels of a side [m] that cover an extent [m] are more than an
/// image may have.
#[must_use]
pub(crate) fn too_many_pixels(
    path: &ScenePath,
    extent: DVec2,
    side: f64,
    bands: usize,
) -> Option<Diagnostic> {
    let most = f64::from(MOST_PIXELS);
    let counts = PixelGrid::covering(extent, side).counts;
    let DVec2 { x: columns, y: rows } = counts;
    let message = if counts.max_element() > most {
        format!("{columns} x {rows} pixels of {side} m: expected 1 to {most} each way")
    } else if columns * rows * bands as f64 > VALUES {
        format!(
            "{columns} x {rows} pixels of {side} m in {} are more than an image may hold",
            counted(bands, "band")
        )
    } else {
        return None;
    };
    let by_area = (extent.element_product() * bands as f64 / VALUES).sqrt();
    let least = rounded_up((extent.max_element() / most).max(by_area));
    Some(Diagnostic::error(path, message).help(format!("write at least `pixel_m: {least:?}`")))
}

/// Returns the value or up to a tenth more, with two digits.
#[must_use]
pub(crate) fn rounded_up(value: f64) -> f64 {
    format!("{:.1e}", 1.05 * value).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        for value in [1.0, 1.01, 1.049, 2.34, 9.95, 0.3, 1e-9, 7.77e5] {
            let rounded = rounded_up(value);
            assert!((1.0..1.11).contains(&(rounded / value)), "{value}: {rounded}");
            assert!(format!("{rounded:e}").len() <= "1.2e-10".len(), "{rounded}");
        }
    }

    #[test]
    fn the_side_that_an_error_advises_is_accepted() {
        let path = ScenePath::root();
        for (extent, bands) in [
            (DVec2::new(7e4, 1.0), 1),
            (DVec2::new(5e4, 5e4), 3),
            (DVec2::new(1.0, 3e5), 1),
            (DVec2::new(65537.0, 3.0), 2100),
        ] {
            let problem = too_many_pixels(&path, extent, 1.0, bands).expect("too many");
            let help = problem.help.expect("advice");
            let side = help.split("pixel_m: ").nth(1).expect("a side").trim_end_matches('`');
            let side: f64 = side.parse().expect("a number");
            assert!(too_many_pixels(&path, extent, side, bands).is_none(), "{extent}: {side}");
        }
        assert!(too_many_pixels(&path, DVec2::splat(65536.0), 1.0, 1).is_some());
        assert!(too_many_pixels(&path, DVec2::splat(40000.0), 1.0, 1).is_none());
    }
}
