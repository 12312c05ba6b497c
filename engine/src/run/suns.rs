//! Suns of points of a sweep that are traced on the same paths.

use indexmap::IndexMap;

use crate::document::{Scene, Sensor, Spectrum, Sun};

/// Maximum number of suns whose points share paths: each point of a path sends a shadow ray to each of them, so that with
/// more suns a path's own rays cost next to nothing anyway.
const MOST_SUNS: usize = 64;

/// The sun as far as it decides the paths of a scene: where some start at sensors, its position does not.
pub(super) fn sun_of_paths(scene: &Scene) -> Option<Sun> {
    let sun = Sun { irradiance: Spectrum::Constant(1.0), ..scene.sun.clone()? };
    let sensors = || scene.sensors.values();
    let azimuth = sensors().any(Sensor::follows_sun).then(|| sun.known_azimuth_deg()).flatten();
    let is_up = sun.angles_deg().is_some();
    if is_up && sensors().all(Sensor::is_traced_from_sun) {
        return Some(sun);
    }
    let azimuth_deg = azimuth.unwrap_or(0.0);
    // Without a zenith angle it is below the horizon, and gives no light.
    let zenith_deg = is_up.then_some(0.0);
    Some(Sun { zenith_deg, azimuth_deg, position: None, ..sun })
}

/// Groups of points that can share paths, at most this number in each. Points of the same sun follow each other: the bands
/// of a sun then do.
pub(super) fn grouped_by_sun(
    points: Vec<usize>,
    suns: &[Option<Sun>],
    most: usize,
) -> Vec<Vec<usize>> {
    let mut of_suns: IndexMap<Option<[u64; 2]>, Vec<usize>> = IndexMap::new();
    for index in points {
        let angles = suns[index].as_ref().and_then(Sun::angles_deg);
        let angles = angles.map(|(zenith, azimuth)| [zenith, azimuth].map(f64::to_bits));
        of_suns.entry(angles).or_default().push(index);
    }
    let of_suns: Vec<Vec<usize>> = of_suns.into_values().collect();
    let parts = of_suns.len().div_ceil(MOST_SUNS).max(1);
    let parts = of_suns.chunks(of_suns.len().div_ceil(parts).max(1));
    parts
        .flat_map(|part| part.concat().chunks(most).map(<[usize]>::to_vec).collect::<Vec<_>>())
        .collect()
}
