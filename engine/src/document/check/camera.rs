//! Sensors that take images.

use super::super::diagnostic::unknown_name;
use super::super::scene::{
    Cover, Fisheye, FisheyeProjection, ImageOptions, Look, Orthographic, Perspective, Picture,
    Scene, Terrain, TerrainPlane,
};
use super::pixels::{check_pixels, check_size};
use super::{Report, ScenePath};

type Point = (f64, f64, f64);

pub(super) fn check_orthographic(
    path: &ScenePath,
    sensor: &Orthographic,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let Orthographic {
        size_px,
        pixel_m,
        extent_m,
        cover: _,
        center_m,
        zenith_deg,
        azimuth_deg,
        samples_per_px,
        samples_per_m2,
        image: ImageOptions { picture, .. },
        virtual_plane: _,
    } = sensor;
    check_pixels(path, *size_px, *pixel_m, *extent_m, scene, report);
    check_picture(path, picture, scene, report);
    if let Some((width, height)) = extent_m {
        report.above_zero(path.key("extent_m").index(0), *width);
        report.above_zero(path.key("extent_m").index(1), *height);
    }
    check_cover(path, sensor, report);
    if let Some((x, y)) = center_m {
        report.finite(path.key("center_m"), &[*x, *y]);
    }
    report.zenith(path.key("zenith_deg"), *zenith_deg);
    report.azimuth(path.key("azimuth_deg"), *azimuth_deg);
    if let Some(samples) = samples_per_px {
        check_samples(path, *samples, report);
    }
    if let Some(density) = samples_per_m2 {
        check_sample_density(path, *density, sensor, report);
    }
}

/// Checks that the image covers either a rectangle or the whole scene.
fn check_cover(path: &ScenePath, sensor: &Orthographic, report: &mut Report<'_>) {
    let Orthographic { extent_m, cover, center_m, .. } = sensor;
    match (extent_m, cover) {
        (None, None) => {
            let message = "the image covers nothing: it has neither `extent_m` nor `cover`";
            let help = "write `extent_m: (50.0, 50.0)` for so many metres of the scene, or \
                        `cover: WholeScene`";
            report.error(path, message, help);
        }
        (Some(_), Some(Cover::WholeScene)) => {
            let message = "`cover` and `extent_m` both say how much of the scene is shown";
            report.error(path.key("cover"), message, "take one of the two out");
        }
        (None, Some(Cover::WholeScene)) if center_m.is_some() => {
            let message = "the middle of the whole scene is known";
            let help = "take `center_m` out, or write `extent_m` in place of `cover`";
            report.error(path.key("center_m"), message, help);
        }
        _ => {}
    }
}

/// Checks the number of samples per square metre.
fn check_sample_density(
    path: &ScenePath,
    density: f64,
    sensor: &Orthographic,
    report: &mut Report<'_>,
) {
    let Orthographic { size_px, pixel_m, extent_m, samples_per_px, .. } = sensor;
    report.above_zero(path.key("samples_per_m2"), density);
    if samples_per_px.is_some() {
        let message = "`samples_per_m2` and `samples_per_px` both say how many samples";
        report.error(path.key("samples_per_m2"), message, "take one of the two out");
    }
    let pixel = match (size_px, pixel_m, extent_m) {
        (_, Some(side), _) => Some(side * side),
        (Some((columns, rows)), None, Some((width, height))) => {
            Some(width * height / (f64::from(*columns) * f64::from(*rows)))
        }
        _ => None,
    };
    if let Some(pixel) = pixel {
        let most = f64::from(MOST_SAMPLES);
        if pixel.is_finite() && density * pixel > most {
            let message = format!("this makes more than {most} samples in a pixel of {pixel} m²");
            let help = format!("write at most {}", (most / pixel).floor());
            report.error(path.key("samples_per_m2"), message, help);
        }
    }
}

pub(super) fn check_perspective(
    path: &ScenePath,
    sensor: &Perspective,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let Perspective {
        size_px,
        position_m,
        target_m,
        up,
        fov_deg,
        above_ground,
        sees_sky: _,
        samples_per_px,
        image: ImageOptions { picture, .. },
    } = sensor;
    check_size(path, *size_px, scene, report);
    check_picture(path, picture, scene, report);
    check_samples(path, *samples_per_px, report);
    check_position(path, *position_m, *above_ground, scene, report);
    let target = path.key("target_m");
    if let Some(ahead) = check_target(&target, *position_m, *target_m, report) {
        let is_written = *up != (0.0, 0.0, 1.0);
        check_up(&path.key(if is_written { "up" } else { "target_m" }), *up, ahead, report);
    }
    for (axis, angle) in [fov_deg.0, fov_deg.1].into_iter().enumerate() {
        if !(angle > 0.0 && angle < 180.0) {
            let message =
                format!("expected an angle of view above 0 and below 180°, found {angle}");
            let help = if angle >= 180.0 {
                "a flat film shows less than 180°: write `Fisheye(..)` for more"
            } else {
                "a camera with 40° across and 30° down has `fov_deg: (40.0, 30.0)`"
            };
            report.error(path.key("fov_deg").index(axis), message, help);
        }
    }
}

pub(super) fn check_fisheye(
    path: &ScenePath,
    sensor: &Fisheye,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let Fisheye {
        size_px,
        position_m,
        look,
        up,
        fov_deg,
        projection,
        above_ground,
        sees_sky: _,
        samples_per_px,
        image: ImageOptions { picture, .. },
    } = sensor;
    check_size(path, *size_px, scene, report);
    check_picture(path, picture, scene, report);
    check_samples(path, *samples_per_px, report);
    check_position(path, *position_m, *above_ground, scene, report);
    let (ahead, usual_up) = match look {
        Look::Up => (Some((0.0, 0.0, 1.0)), (0.0, 1.0, 0.0)),
        Look::Down => (Some((0.0, 0.0, -1.0)), (0.0, 1.0, 0.0)),
        Look::Towards { zenith_deg, azimuth_deg } => {
            (check_towards(path, *zenith_deg, *azimuth_deg, report), (0.0, 0.0, 1.0))
        }
        Look::Target { at_m } => {
            let target = path.key("look").key("at_m");
            (check_target(&target, *position_m, *at_m, report), (0.0, 0.0, 1.0))
        }
    };
    if let Some(ahead) = ahead {
        let key = if up.is_some() { "up" } else { "look" };
        check_up(&path.key(key), up.unwrap_or(usual_up), ahead, report);
    }
    let (most, what) = match projection {
        FisheyeProjection::Equisolid => (360.0, "an equisolid"),
        FisheyeProjection::Equidistant => (360.0, "an equidistant"),
        FisheyeProjection::Orthographic => (180.0, "an orthographic"),
        FisheyeProjection::Stereographic => (350.0, "a stereographic"),
    };
    if !(*fov_deg > 0.0 && *fov_deg <= most) {
        let message =
            format!("expected an angle of view above 0 and up to {most}°, found {fov_deg}");
        let help = if *fov_deg > 0.0 {
            format!("{what} image ends there; a hemisphere is `fov_deg: 180.0`")
        } else {
            "a hemisphere is `fov_deg: 180.0`".to_owned()
        };
        report.error(path.key("fov_deg"), message, help);
    }
}

/// Samples that a pixel may have.
const MOST_SAMPLES: u32 = 1 << 24;

/// Bands between the ends of the visible that make colours.
const COLOUR_BANDS: usize = 10;

fn check_picture(path: &ScenePath, picture: &Picture, scene: &Scene, report: &mut Report<'_>) {
    let path = path.key("picture");
    let exposure = match picture {
        Picture::Quicklook => None,
        Picture::Bands { red, green, blue, exposure_stops } => {
            for (key, name) in [("red", red), ("green", green), ("blue", blue)] {
                let bands = || scene.bands.iter().map(|band| band.name.as_str());
                if !bands().any(|band| band == name) && report.is_readable("bands") {
                    report.push(unknown_name(path.key(key), "band", name, bands()));
                }
            }
            exposure_stops.as_ref()
        }
        Picture::Cie { exposure_stops } => {
            let visible = scene
                .bands
                .iter()
                .filter(|band| band.nominal_nm().is_some_and(|nm| (380.0..=780.0).contains(&nm)))
                .count();
            if visible < COLOUR_BANDS && report.is_readable("bands") {
                let message = format!(
                    "colours need {COLOUR_BANDS} bands or more from 380 to 780 nm, found {visible}"
                );
                let help = "write more bands, or `picture: Bands(red: .., green: .., blue: ..)`";
                report.error(&path, message, help);
            }
            exposure_stops.as_ref()
        }
    };
    if let Some(stops) = exposure
        && !(-30.0..=30.0).contains(stops)
    {
        let message = format!("expected -30 to 30 stops, found {stops}");
        let help = "each stop doubles the brightness; leave it out for an automatic exposure";
        report.error(path.key("exposure_stops"), message, help);
    }
}

fn check_samples(path: &ScenePath, samples: u32, report: &mut Report<'_>) {
    if !(2..=MOST_SAMPLES).contains(&samples) {
        let message = format!("expected 2 to {MOST_SAMPLES} samples, found {samples}");
        let help = match samples {
            0 | 1 => "1 sample gives no error estimate: write 2 or more",
            _ => "write fewer samples, or average runs of several seeds",
        };
        report.error(path.key("samples_per_px"), message, help);
    }
}

fn check_position(
    path: &ScenePath,
    (x, y, z): Point,
    above_ground: bool,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let path = path.key("position_m");
    report.finite(&path, &[x, y, z]);
    let ground = match &scene.terrain {
        _ if above_ground => 0.0,
        Terrain::Plane(TerrainPlane { height_m, .. }) => *height_m,
        // Known only when its file is read.
        Terrain::Raster(_) | Terrain::Mesh { .. } => return,
    };
    if z <= ground && report.is_readable("terrain") {
        let message =
            format!("the camera is not above the ground, whose height here is {ground} m");
        let help = format!(
            "write a greater height: `({x:?}, {y:?}, {:?})` is 1.5 m above the ground",
            ground + 1.5
        );
        report.error(path, message, help);
    }
}

/// The direction from a camera to its target, if there is one; not of unit length.
fn check_target(
    path: &ScenePath,
    position: Point,
    target: Point,
    report: &mut Report<'_>,
) -> Option<Point> {
    report.finite(path, &[target.0, target.1, target.2]);
    let ahead = (target.0 - position.0, target.1 - position.1, target.2 - position.2);
    if length(ahead) == 0.0 {
        let message = "the target is the camera's own position: it looks nowhere";
        let (x, y, z) = position;
        let help = format!("write a point to look at: `({x:?}, {:?}, {z:?})` lies north", y + 10.0);
        report.error(path, message, help);
        return None;
    }
    Some(ahead)
}

fn check_towards(
    path: &ScenePath,
    zenith_deg: f64,
    azimuth_deg: f64,
    report: &mut Report<'_>,
) -> Option<Point> {
    report.azimuth(path.key("look").key("azimuth_deg"), azimuth_deg);
    if !(0.0..=180.0).contains(&zenith_deg) {
        let message = format!("expected an angle from the vertical, 0 to 180°, found {zenith_deg}");
        let help = "0 looks up, 90 to the horizon, 180 down";
        report.error(path.key("look").key("zenith_deg"), message, help);
        return None;
    }
    let (zenith, azimuth) = (zenith_deg.to_radians(), azimuth_deg.to_radians());
    Some((zenith.sin() * azimuth.sin(), zenith.sin() * azimuth.cos(), zenith.cos()))
}

/// Sines of less than this between view and up are no angle that a person means.
const ALONG: f64 = 1e-6;

fn check_up(path: &ScenePath, up: Point, ahead: Point, report: &mut Report<'_>) {
    let (ux, uy, uz) = up;
    let (ax, ay, az) = ahead;
    report.finite(path, &[ux, uy, uz]);
    let across = (ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux);
    if length(across) <= ALONG * length(up) * length(ahead) {
        let message = if length(up) == 0.0 {
            "this is no direction"
        } else {
            "what is up in the image lies along the view"
        };
        let is_vertical = ax.hypot(ay) <= ALONG * az.abs();
        let help = if is_vertical {
            "write `up: (0.0, 1.0, 0.0)`: north is then at the top of the image"
        } else {
            "write `up: (0.0, 0.0, 1.0)`: what stands upright is then upright in the image"
        };
        report.error(path, message, help);
    }
}

fn length((x, y, z): Point) -> f64 {
    x.hypot(y).hypot(z)
}
