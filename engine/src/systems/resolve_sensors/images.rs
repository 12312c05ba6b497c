use glam::{DVec2, DVec3, UVec2};

use super::{SensorPlace, resolve_plane};
use crate::components::{
    CameraPlacement, Channels, FisheyeOptics, Footprint, ImageSamples, ImageSensor, LookAt, Optics,
    OrthographicOptics, PerspectiveOptics, PictureColours, View,
};
use crate::document::{self, Cover, Sensor};
use crate::systems::Resources;

/// Samples per pixel if the scene does not say.
const SAMPLES: u32 = 64;

/// Image sensor of a source that the author wrote; `None` if it takes no image.
pub(super) fn image(
    sensor: &Sensor,
    place: &SensorPlace,
    resources: &Resources,
) -> Option<ImageSensor> {
    let image = sensor.image_options()?;
    let (size, samples) = match sensor {
        Sensor::Orthographic(sensor) => {
            let per_pixel = ImageSamples::PerPixel(sensor.samples_per_px.unwrap_or(SAMPLES));
            let samples = sensor.samples_per_m2.map_or(per_pixel, ImageSamples::PerArea);
            // `run/pixels.rs` counts pixels of a given side once the stage is known.
            (sensor.size_px.unwrap_or((1, 1)), samples)
        }
        Sensor::Perspective(sensor) => {
            (sensor.size_px, ImageSamples::PerPixel(sensor.samples_per_px))
        }
        Sensor::Fisheye(sensor) => (sensor.size_px, ImageSamples::PerPixel(sensor.samples_per_px)),
        Sensor::Directions(_) | Sensor::Photons(_) => return None,
    };
    Some(ImageSensor {
        size: UVec2::from(size),
        optics: camera(sensor, place)?,
        samples,
        until: sensor.until().to_vec(),
        measure: image.measure.clone(),
        is_denoised: image.denoised,
        picture: resolve_picture(&image.picture, resources)?,
        system: image.system,
    })
}

fn resolve_picture(picture: &document::Picture, resources: &Resources) -> Option<PictureColours> {
    // `document::check` has seen that the bands are there.
    let band = |name: &str| resources.bands.iter().position(|band| band.name == name);
    Some(match picture {
        document::Picture::Quicklook => PictureColours::Quicklook,
        document::Picture::Bands { red, green, blue, exposure_stops } => PictureColours::Colours {
            channels: Channels::Bands([band(red)?, band(green)?, band(blue)?]),
            exposure: *exposure_stops,
        },
        document::Picture::Cie { exposure_stops } => {
            PictureColours::Colours { channels: Channels::Cie, exposure: *exposure_stops }
        }
    })
}

fn camera(sensor: &Sensor, place: &SensorPlace) -> Option<Optics> {
    Some(match sensor {
        Sensor::Orthographic(sensor) => Optics::Orthographic(OrthographicOptics {
            footprint: footprint(sensor, place),
            pixel: sensor.pixel_m,
            view: View::from_degrees(sensor.zenith_deg, sensor.azimuth_deg),
            plane: resolve_plane(sensor.virtual_plane.as_ref(), place.corner, place.size),
        }),
        Sensor::Perspective(sensor) => Optics::Perspective(PerspectiveOptics {
            placement: CameraPlacement {
                position: DVec3::from(sensor.position_m),
                look: LookAt::Target(DVec3::from(sensor.target_m)),
                up: DVec3::from(sensor.up),
                above_ground: sensor.above_ground,
            },
            field: DVec2::new(sensor.fov_deg.0.to_radians(), sensor.fov_deg.1.to_radians()),
            sees_sky: sensor.sees_sky,
        }),
        Sensor::Fisheye(sensor) => {
            let (look, usual_up) = look_at(&sensor.look);
            Optics::Fisheye(FisheyeOptics {
                placement: CameraPlacement {
                    position: DVec3::from(sensor.position_m),
                    look,
                    up: sensor.up.map_or(usual_up, DVec3::from),
                    above_ground: sensor.above_ground,
                },
                projection: sensor.projection,
                field: sensor.fov_deg.to_radians(),
                sees_sky: sensor.sees_sky,
            })
        }
        Sensor::Directions(_) | Sensor::Photons(_) => return None,
    })
}

/// Part of the scene that a parallel projection shows.
fn footprint(sensor: &document::Orthographic, place: &SensorPlace) -> Footprint {
    // `document::check` asks for exactly one of the two.
    match (&sensor.cover, sensor.extent_m) {
        (None, Some(extent)) => Footprint::Rectangle {
            extent: DVec2::from(extent),
            center: sensor.center_m.map_or(place.corner + 0.5 * place.size, DVec2::from),
        },
        (Some(Cover::WholeScene), _) | (None, None) => Footprint::WholeScene,
    }
}

/// Direction or target of a camera, and the default of the direction that is up in its image.
fn look_at(look: &document::Look) -> (LookAt, DVec3) {
    match look {
        document::Look::Up => (LookAt::Direction(DVec3::Z), DVec3::Y),
        document::Look::Down => (LookAt::Direction(DVec3::NEG_Z), DVec3::Y),
        document::Look::Towards { zenith_deg, azimuth_deg } => {
            let view = View::from_degrees(*zenith_deg, *azimuth_deg);
            (LookAt::Direction(view.direction()), DVec3::Z)
        }
        document::Look::Target { at_m } => (LookAt::Target(DVec3::from(*at_m)), DVec3::Z),
    }
}
