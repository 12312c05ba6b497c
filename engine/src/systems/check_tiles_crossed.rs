use glam::DVec2;
use hecs::World;

use super::Resources;
use super::measure_extents::MOST_TILES_HIGH;
use crate::document::{Diagnostic, PhotonMeasure, ScenePath, Sensor, Sun, Views};

/// Tiles that a ray between sun or sensor and the ground may cross: beyond, a single ray takes milliseconds.
const MOST_TILES_CROSSED: f64 = 1e5;

/// A direction that rays come from or go to, and what asks for it.
struct Slope {
    path: ScenePath,
    what: &'static str,
    zenith_deg: f64,
}

/// Refuses sun and views so low that rays cross too many tiles of a periodic scene. Reads `document::Sun`,
/// `document::Sensor` and the resource `extents`.
pub(super) fn check_tiles_crossed(world: &mut World, resources: &mut Resources) {
    let Some(tile) = resources.extents.tile else { return };
    let height = resources.extents.high - resources.extents.low;
    if height / tile.min_element() > MOST_TILES_HIGH {
        // That was reported.
        return;
    }
    for slope in slopes(world, resources) {
        let tiles = slope.zenith_deg.to_radians().tan() * height / tile.min_element();
        if tiles > MOST_TILES_CROSSED {
            resources.report(too_low(&slope, tiles, height, tile));
        }
    }
}

/// Directions of sun and sensors.
fn slopes(world: &World, resources: &Resources) -> Vec<Slope> {
    let mut slopes = Vec::new();
    if let Ok(sun) = world.get::<&Sun>(resources.sun)
        && let Some((zenith, _)) = sun.angles_deg()
    {
        let key = if sun.zenith_deg.is_some() { "zenith_deg" } else { "position" };
        let zenith_deg = zenith + 0.5 * sun.disc_deg;
        slopes.push(Slope { path: ScenePath::from("sun").key(key), what: "the sun", zenith_deg });
    }
    for (name, &entity) in &resources.sensors {
        let sensor = world.get::<&Sensor>(entity).expect("`spawn` gives sensors their source");
        let path = ScenePath::from("sensors").name(name);
        match &*sensor {
            Sensor::Orthographic(sensor) => slopes.push(Slope {
                path: path.key("zenith_deg"),
                what: "the sensor",
                zenith_deg: sensor.zenith_deg,
            }),
            Sensor::Directions(sensor) => {
                slopes.extend(lowest(&sensor.views, &path.key("views")));
            }
            Sensor::Photons(sensor) => {
                for (index, measure) in sensor.measure.iter().enumerate() {
                    if let PhotonMeasure::BrfViews(views) | PhotonMeasure::RadianceViews(views) =
                        measure
                    {
                        slopes.extend(lowest(views, &path.key("measure").index(index)));
                    }
                }
            }
            Sensor::Perspective(_) | Sensor::Fisheye(_) => {}
        }
    }
    slopes
}

/// The lowest of some views.
fn lowest(views: &Views, path: &ScenePath) -> Option<Slope> {
    let (path, zenith_deg) = match views {
        Views::List(list) => {
            let zeniths = list.iter().map(|&(zenith, _)| zenith).enumerate();
            let (index, zenith) = zeniths.max_by(|a, b| a.1.total_cmp(&b.1))?;
            (path.index(index).index(0), zenith)
        }
        Views::PrincipalPlane { max_deg, .. } | Views::CrossPlane { max_deg, .. } => {
            (path.key("max_deg"), *max_deg)
        }
    };
    Some(Slope { path, what: "the view", zenith_deg })
}

fn too_low(slope: &Slope, tiles: f64, height: f64, tile: DVec2) -> Diagnostic {
    let Slope { path, what, zenith_deg } = slope;
    let highest = (MOST_TILES_CROSSED * tile.min_element() / height).atan().to_degrees();
    let message = format!(
        "{what} at zenith {zenith_deg}° is so low that each ray crosses {tiles:.0} tiles of {} x {} m on \
         its way through a scene that is {height} m high; at most {MOST_TILES_CROSSED} are followed",
        tile.x, tile.y
    );
    let help = format!(
        "write a zenith angle of at most {}, a larger terrain, or `boundary: Isolated`",
        (highest * 1e4).floor() / 1e4
    );
    Diagnostic::error(path, message).help(help)
}
