//! Number of pixels of images whose pixels have a given side.

use hecs::World;

use crate::components::{Name, Optics, ResolvedSensor};
use crate::document::{Diagnostic, ScenePath, too_many_pixels};
use crate::extract::Stage;
use crate::geometry::PixelGrid;
use crate::transport::wanted_footprint;

use super::Failure;

/// Counts the pixels of each parallel projection that names their side: what the whole scene covers is
/// known only of a stage; each has this number of bands. Returns a note for each footprint that grows to whole pixels.
///
/// # Errors
/// If an image has more pixels than it may have.
pub(super) fn count_pixels(
    world: &mut World,
    stage: &Stage,
    bands: usize,
) -> Result<Vec<String>, Failure> {
    let mut problems: Vec<Diagnostic> = Vec::new();
    let mut notes: Vec<String> = Vec::new();
    for (name, sensor) in world.query_mut::<(&Name, &mut ResolvedSensor)>() {
        let ResolvedSensor::Image(image) = sensor else { continue };
        let Optics::Orthographic(optics) = &image.optics else { continue };
        let Some(side) = optics.pixel else { continue };
        let (_, extent) = wanted_footprint(optics, stage);
        let path = ScenePath::from("sensors").name(&name.0).key("pixel_m");
        if let Some(problem) = too_many_pixels(&path, extent, side, bands) {
            problems.push(problem);
            continue;
        }
        let grid = PixelGrid::covering(extent, side);
        image.size = grid.counts.as_uvec2();
        if grid.has_grown {
            notes.push(format!(
                "sensors.{}: {} x {} m are not whole pixels of {side} m; the image shows {} x {} m around the same middle, {} x {} pixels",
                name.0,
                shown(extent.x),
                shown(extent.y),
                shown(grid.extent.x),
                shown(grid.extent.y),
                image.size.x,
                image.size.y
            ));
        }
    }
    notes.sort_unstable();
    if problems.is_empty() { Ok(notes) } else { Err(Failure::Problems(problems)) }
}

/// A length without the rounding of its computation, m.
fn shown(length: f64) -> f64 {
    (length * 1e6).round() / 1e6
}
