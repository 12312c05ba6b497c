use glam::{DVec2, DVec3, UVec2};

use super::{SensorPlace, image_measures, resolve_plane, stop_criteria, system_of, view};
use crate::components::{
    Channels, Fisheye, Footprint, ImageSamples, ImageSensor, Look, Mapping, Optics, Orthographic,
    Perspective, Picture, Stand,
};
use crate::document::{self, Cover, FisheyeProjection, Sensor};
use crate::systems::Resources;

/// Samples per pixel if the scene does not say.
const SAMPLES: u32 = 64;

/// Image sensor of a source that the author wrote; `None` if it takes no image.
pub(super) fn image(
    sensor: &Sensor,
    place: &SensorPlace,
    resources: &Resources,
) -> Option<ImageSensor> {
    let (size, samples, measure, picture, system) = match sensor {
        Sensor::Orthographic {
            size_px,
            samples_per_px,
            samples_per_m2,
            measure,
            picture,
            system,
            ..
        } => {
            let per_pixel = ImageSamples::PerPixel(samples_per_px.unwrap_or(SAMPLES));
            let samples = samples_per_m2.map_or(per_pixel, ImageSamples::PerArea);
            // `run/pixels.rs` counts pixels of a given side once the stage is known.
            (size_px.unwrap_or((1, 1)), samples, measure, picture, system)
        }
        Sensor::Perspective { size_px, samples_per_px, measure, picture, system, .. }
        | Sensor::Fisheye { size_px, samples_per_px, measure, picture, system, .. } => {
            (*size_px, ImageSamples::PerPixel(*samples_per_px), measure, picture, system)
        }
        Sensor::Directions { .. } | Sensor::Photons { .. } => return None,
    };
    Some(ImageSensor {
        size: UVec2::from(size),
        optics: camera(sensor, place)?,
        samples,
        until: stop_criteria(sensor),
        measure: image_measures(measure),
        picture: resolve_picture(picture, resources)?,
        system: system_of(*system),
    })
}

fn resolve_picture(picture: &document::Picture, resources: &Resources) -> Option<Picture> {
    // `document::check` has seen that the bands are there.
    let band = |name: &str| resources.bands.iter().position(|band| band.name == name);
    Some(match picture {
        document::Picture::Quicklook => Picture::Quicklook,
        document::Picture::Bands { red, green, blue, exposure_stops } => Picture::Colours {
            channels: Channels::Bands([band(red)?, band(green)?, band(blue)?]),
            exposure: *exposure_stops,
        },
        document::Picture::Cie { exposure_stops } => {
            Picture::Colours { channels: Channels::Cie, exposure: *exposure_stops }
        }
    })
}

fn camera(sensor: &Sensor, place: &SensorPlace) -> Option<Optics> {
    Some(match sensor {
        Sensor::Orthographic {
            pixel_m,
            extent_m,
            cover,
            center_m,
            zenith_deg,
            azimuth_deg,
            virtual_plane,
            ..
        } => {
            let middle = place.corner + 0.5 * place.size;
            // `document::check` asks for exactly one of the two.
            let footprint = match (cover, extent_m) {
                (None, Some(extent)) => Footprint::Rectangle {
                    extent: DVec2::from(*extent),
                    center: center_m.map_or(middle, DVec2::from),
                },
                (Some(Cover::WholeScene), _) | (None, None) => Footprint::WholeScene,
            };
            let view = view(*zenith_deg, *azimuth_deg);
            let plane = resolve_plane(virtual_plane.as_ref(), place.corner, place.size);
            Optics::Orthographic(Orthographic { footprint, pixel: *pixel_m, view, plane })
        }
        Sensor::Perspective {
            position_m, target_m, up, fov_deg, above_ground, sees_sky, ..
        } => Optics::Perspective(Perspective {
            stand: Stand {
                position: DVec3::from(*position_m),
                look: Look::Target(DVec3::from(*target_m)),
                up: DVec3::from(*up),
                above_ground: *above_ground,
            },
            field: DVec2::new(fov_deg.0.to_radians(), fov_deg.1.to_radians()),
            sees_sky: *sees_sky,
        }),
        Sensor::Fisheye {
            position_m,
            look,
            up,
            fov_deg,
            projection,
            above_ground,
            sees_sky,
            ..
        } => {
            let (look, usual_up) = look_of(look);
            Optics::Fisheye(Fisheye {
                stand: Stand {
                    position: DVec3::from(*position_m),
                    look,
                    up: up.map_or(usual_up, DVec3::from),
                    above_ground: *above_ground,
                },
                mapping: mapping(projection),
                field: fov_deg.to_radians(),
                sees_sky: *sees_sky,
            })
        }
        Sensor::Directions { .. } | Sensor::Photons { .. } => return None,
    })
}

/// Direction or target of a camera, and the default of the direction that is up in its image.
fn look_of(look: &document::Look) -> (Look, DVec3) {
    match look {
        document::Look::Up => (Look::Direction(DVec3::Z), DVec3::Y),
        document::Look::Down => (Look::Direction(DVec3::NEG_Z), DVec3::Y),
        document::Look::Towards { zenith_deg, azimuth_deg } => {
            (Look::Direction(view(*zenith_deg, *azimuth_deg).direction()), DVec3::Z)
        }
        document::Look::Target { at_m } => (Look::Target(DVec3::from(*at_m)), DVec3::Z),
    }
}

fn mapping(projection: &FisheyeProjection) -> Mapping {
    match projection {
        FisheyeProjection::Equisolid => Mapping::Equisolid,
        FisheyeProjection::Equidistant => Mapping::Equidistant,
        FisheyeProjection::Orthographic => Mapping::Orthographic,
        FisheyeProjection::Stereographic => Mapping::Stereographic,
    }
}
