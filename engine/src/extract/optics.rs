//! Quantities of a world that differ by band: surfaces, light and emission.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::DVec3;
use hecs::World;

use crate::components::{
    BlackBody, Emission, MaterialId, Name, SceneId, SkyLight, SunLight, SurfaceOptics,
};

/// All quantities of a world that differ by band, and its sun. Worlds that differ in nothing else can be joined: their bands
/// then ride on the same paths.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneOptics {
    /// Materials that are used.
    pub(super) materials: BTreeMap<MaterialId, MaterialOptics>,
    /// Suns of the bands; none, or one for each band.
    pub(super) suns: Vec<BandSun>,
    pub(super) sky: Option<SkyLight>,
    pub(super) emission: Option<Emission>,
    /// Number of bands.
    pub(super) bands: usize,
}

/// The sun of some bands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BandSun {
    /// Bands that it lights.
    pub(super) bands: Range<usize>,
    /// Unit vector towards its middle.
    pub(super) direction: DVec3,
    /// Angular radius of its disc, rad.
    pub(super) radius: f64,
    /// Irradiance perpendicular to its beam, W m⁻² nm⁻¹, shape `[its bands]`.
    pub(super) irradiance: Vec<f64>,
}

impl BandSun {
    fn new(sun: &SunLight) -> Self {
        let SunLight { direction, radius, irradiance } = sun;
        let bands = 0..irradiance.len();
        Self { bands, direction: *direction, radius: *radius, irradiance: irradiance.clone() }
    }
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MaterialOptics {
    pub(super) name: String,
    pub(super) surface: SurfaceOptics,
    /// Emission of a black surface of its temperature, where a sensor measures it.
    pub(super) body: Option<BlackBody>,
}

impl SceneOptics {
    /// The optics of a world. Reads [`SurfaceOptics`], [`BlackBody`], [`SunLight`], [`SkyLight`] and [`Emission`].
    #[must_use]
    pub fn from_world(world: &World, bands: usize) -> Self {
        let mut query = world.query::<(&SceneId, &Name, &SurfaceOptics, Option<&BlackBody>)>();
        let materials = query.iter().map(|(id, name, surface, body)| {
            let (name, surface, body) = (name.0.clone(), surface.clone(), body.cloned());
            (MaterialId(id.0), MaterialOptics { name, surface, body })
        });
        Self {
            materials: materials.collect(),
            suns: world.query::<&SunLight>().iter().map(BandSun::new).collect(),
            sky: world.query::<&SkyLight>().iter().next().cloned(),
            emission: world.query::<&Emission>().iter().next().cloned(),
            bands,
        }
    }

    /// Number of bands.
    #[must_use]
    pub const fn bands(&self) -> usize {
        self.bands
    }

    /// Irradiance of the sun on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub(super) fn beam_irradiance(&self) -> Vec<f64> {
        let mut irradiance = vec![0.0; self.bands];
        for sun in &self.suns {
            for (sum, e) in irradiance[sun.bands.clone()].iter_mut().zip(&sun.irradiance) {
                *sum = e * sun.direction.z;
            }
        }
        irradiance
    }

    /// Irradiance of the sky on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub(super) fn sky_irradiance(&self) -> Vec<f64> {
        let sky = self.sky.as_ref();
        sky.map_or_else(|| vec![0.0; self.bands], |sky| sky.irradiance.clone())
    }

    /// Total irradiance on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    #[must_use]
    pub fn irradiance(&self) -> Vec<f64> {
        let both = self.beam_irradiance().into_iter().zip(self.sky_irradiance());
        both.map(|(sun, sky)| sun + sky).collect()
    }

    /// Returns whether the sky gives light in some band.
    #[must_use]
    pub fn has_sky(&self) -> bool {
        let gives_light = |sky: &SkyLight| {
            sky.irradiance.iter().zip(self.irradiance()).any(|(&sky, all)| (sky / all) as f32 > 0.0)
        };
        self.sky.as_ref().is_some_and(gives_light)
    }

    /// Places of joined scenes of the same sun.
    pub fn suns_of_scenes(&self, scenes: usize) -> impl Iterator<Item = Range<usize>> {
        let place = move |band: usize| band * scenes / self.bands;
        self.suns.iter().map(move |sun| place(sun.bands.start)..place(sun.bands.end))
    }

    /// The bands of all of these, one behind the other. Neighbours of the same sun share it.
    ///
    /// # Panics
    /// If there is none, or they differ in anything but values by band and the positions of their suns.
    #[must_use]
    pub fn joined(all: &[&Self]) -> Self {
        let mut joined = (*all.first().expect("something to join")).clone();
        for &next in &all[1..] {
            joined.join(next);
        }
        joined
    }

    fn join(&mut self, next: &Self) {
        assert!(self.materials.keys().eq(next.materials.keys()), "{ALIKE}");
        for (material, next) in self.materials.values_mut().zip(next.materials.values()) {
            material.surface.join(&next.surface);
            join(&mut material.body, next.body.as_ref(), |body, next| {
                body.sunlit.extend(&next.sunlit);
                body.shaded.extend(&next.shaded);
            });
        }
        assert!(self.suns.is_empty() == next.suns.is_empty(), "{ALIKE}");
        for sun in &next.suns {
            self.join_sun(sun);
        }
        join(&mut self.sky, next.sky.as_ref(), |sky, next| sky.irradiance.extend(&next.irradiance));
        join(&mut self.emission, next.emission.as_ref(), |emission, next| {
            emission.bands.extend(&next.bands);
            emission.sky.extend(&next.sky);
        });
        self.bands += next.bands;
    }

    /// Adds the sun of bands that follow those so far.
    fn join_sun(&mut self, sun: &BandSun) {
        let bands = self.bands + sun.bands.start..self.bands + sun.bands.end;
        let is_same = |last: &&mut BandSun| {
            last.bands.end == bands.start
                && (last.direction, last.radius) == (sun.direction, sun.radius)
        };
        if let Some(last) = self.suns.last_mut().filter(is_same) {
            last.bands.end = bands.end;
            last.irradiance.extend(&sun.irradiance);
        } else {
            self.suns.push(BandSun { bands, ..sun.clone() });
        }
    }
}

const ALIKE: &str =
    "scenes that are joined differ in values by band and in their suns' positions alone";

/// Joins two values, of which there are both or none.
fn join<T>(value: &mut Option<T>, next: Option<&T>, join: impl FnOnce(&mut T, &T)) {
    match (value, next) {
        (Some(value), Some(next)) => join(value, next),
        (None, None) => {}
        _ => panic!("{ALIKE}"),
    }
}
