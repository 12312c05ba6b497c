//! Species, size and orientation of the tree at each place.

use glam::DVec2;
use rayon::prelude::*;

use super::distribution::draw;
use crate::components::{Lean, Placement, PrototypeId, Scale};
use crate::document::Distribution;
use crate::sampling::Key;

/// Species that may take a place.
#[derive(Clone, Copy, Debug)]
pub struct Species<'a> {
    /// Name, which is the key of its random numbers.
    pub name: &'a str,
    /// Share of the stems, at least 0; only ratios count.
    pub share: f64,
    /// Mesh of its trees.
    pub prototype: PrototypeId,
    /// Height of the mesh above its origin, m.
    pub height: f64,
}

/// Distributions of the size and orientation of trees.
#[derive(Clone, Copy, Debug)]
pub struct Habit<'a> {
    /// Turn about the vertical, degrees.
    pub yaw_deg: &'a Distribution,
    /// Lean, degrees.
    pub tilt_deg: &'a Distribution,
    /// Azimuth of the lean, degrees.
    pub tilt_azimuth_deg: &'a Distribution,
    /// Height to which the mesh is scaled, m.
    pub height_m: Option<&'a Distribution>,
    /// Further scale.
    pub scale: &'a Distribution,
    /// Further vertical scale.
    pub scale_vertical: Option<&'a Distribution>,
    /// Depth of the mesh's origin below the ground, m.
    pub sink_m: f64,
}

/// Trees at places on the ground, whose height is `ground`; a place without ground has none.
///
/// Each species draws an exponential waiting time of rate `share` for each stem from a stream of its own, and the
/// shortest time takes the place. So shares hold, and a further species changes only the stems that it takes.
pub fn instantiate_trees(
    places: &[DVec2],
    species: &[Species<'_>],
    habit: &Habit<'_>,
    ground: impl Fn(DVec2) -> Option<f64> + Sync,
    stream: Key,
) -> Vec<Placement> {
    let rivals: Vec<(Key, &Species<'_>)> = species
        .iter()
        .filter(|species| species.share > 0.0)
        .map(|species| (stream.path("species").path(species.name), species))
        .collect();
    let of = ["yaw", "tilt", "tilt_azimuth", "height", "scale", "scale_vertical"]
        .map(|purpose| stream.path(purpose));
    let tree = |number: usize, place: DVec2| {
        let number = number as u64;
        let arrivals = rivals
            .iter()
            .map(|(key, species)| (-key.uniform(number).ln() / species.share, species));
        let (_, species) = arrivals.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        let [yaw, tilt, tilt_azimuth, height, scale, vertical] = of.map(|key| key.index(number));
        let whole = habit.height_m.map_or(1.0, |of| draw(of, height) / species.height);
        let scale = draw(habit.scale, scale);
        let vertical = habit.scale_vertical.map_or(scale, |of| draw(of, vertical));
        Some(Placement {
            prototype: species.prototype,
            position: place.extend(ground(place)? - habit.sink_m),
            yaw: draw(habit.yaw_deg, yaw).to_radians() as f32,
            scale: Scale {
                horizontal: (whole * scale) as f32,
                vertical: (whole * vertical) as f32,
            },
            lean: Lean {
                tilt: draw(habit.tilt_deg, tilt).to_radians() as f32,
                azimuth: draw(habit.tilt_azimuth_deg, tilt_azimuth).to_radians() as f32,
            },
        })
    };
    places.par_iter().enumerate().filter_map(|(number, &place)| tree(number, place)).collect()
}
