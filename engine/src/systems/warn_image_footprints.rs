use glam::{DVec2, Vec2Swizzles as _};
use hecs::World;

use super::Resources;
use crate::components::TerrainPatch;
use crate::document::{Cover, Diagnostic, Orthographic, ScenePath, Sensor};
use crate::geometry::{PixelGrid, place_text};

/// Warns of images whose middle lies beside the ground of an isolated scene, and of nadir images that reach beyond it.
/// Reads `document::Sensor` and [`TerrainPatch`].
pub(super) fn warn_image_footprints(world: &mut World, resources: &mut Resources) {
    let Ok(patch) = world.get::<&TerrainPatch>(resources.terrain) else { return };
    if resources.is_periodic() {
        return;
    }
    let (corner, size) = (patch.corner, patch.size);
    let (low, high) = (corner, corner + size);
    for (name, &entity) in &resources.sensors {
        let sensor = world.get::<&Sensor>(entity).expect("`spawn` gives sensors their source");
        let Sensor::Orthographic(Orthographic {
            pixel_m,
            extent_m: Some(extent),
            cover: None::<Cover>,
            center_m,
            zenith_deg,
            azimuth_deg,
            ..
        }) = &*sensor
        else {
            continue;
        };
        let center = center_m.map_or(corner + 0.5 * size, DVec2::from);
        let path = ScenePath::from("sensors").name(name).key("extent_m");
        let ground =
            format!("the ground reaches from {} to {} m", place_text(low), place_text(high));
        if center.cmplt(low).any() || center.cmpgt(high).any() {
            let message = "the middle of the image lies beside the ground";
            let warning = Diagnostic::warning(path, message).help(ground);
            resources.messages.report(warning);
            continue;
        }
        // Turned by anything else, or seen aslant, the image is no rectangle along the axes.
        let quarters = azimuth_deg / 90.0;
        if *zenith_deg != 0.0 || quarters.fract() != 0.0 {
            continue;
        }
        let extent = DVec2::from(*extent);
        let shown = pixel_m.map_or(extent, |side| PixelGrid::covering(extent, side).extent);
        let mut half = 0.5 * shown;
        if quarters % 2.0 != 0.0 {
            half = half.yx();
        }
        let seen = ((center + half).min(high) - (center - half).max(low)).max(DVec2::ZERO);
        let beyond = 1.0 - (seen / (2.0 * half)).element_product();
        // Not the rounding of the extent.
        if beyond > 1e-9 {
            let share = 100.0 * beyond;
            let message = format!("{share:.1} % of the image lies beside the ground");
            let help = format!("{ground}; what lies beside it holds no data");
            resources.messages.report(Diagnostic::warning(path, message).help(help));
        }
    }
}
