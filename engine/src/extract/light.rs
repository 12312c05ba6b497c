use std::f64::consts::PI;

use glam::DVec3;
use hecs::World;

use crate::components::{Sky, Sun};
use crate::scattering::padded;

/// What lights a stage, in units of the total irradiance on the horizontal plane, band by band.
///
/// Transport computes with a total irradiance of 1, so that what it finds is `L / E`: π times that
/// is the BRF, and times `E` it is the radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The sun, if it shines.
    pub beam: Option<Beam>,
    /// The sky, if it shines.
    pub dome: Option<Dome>,
    /// Total irradiance `E` on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub irradiance: Vec<f64>,
}

/// The sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Unit vector towards the sun.
    pub direction: DVec3,
    /// Its share of the total horizontal irradiance, shape `[lanes]`.
    pub share: Box<[f32]>,
}

/// The isotropic sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Dome {
    /// Its share of the total horizontal irradiance, shape `[lanes]`; its radiance is this over π.
    pub share: Box<[f32]>,
}

impl Light {
    pub(super) fn of(world: &World, bands: usize) -> Self {
        let sun = world.query::<&Sun>().iter().next().cloned();
        let sky = world.query::<&Sky>().iter().next().cloned();
        let beam_irradiance: Vec<f64> = sun.as_ref().map_or_else(
            || vec![0.0; bands],
            |sun| sun.irradiance.iter().map(|e| e * sun.direction.z).collect(),
        );
        let sky_irradiance = sky.map_or_else(|| vec![0.0; bands], |sky| sky.irradiance);
        let irradiance: Vec<f64> =
            beam_irradiance.iter().zip(&sky_irradiance).map(|(sun, sky)| sun + sky).collect();
        // A band without any light has no share of it: all it can measure is zero.
        let share = |part: &[f64]| {
            padded(
                part.iter()
                    .zip(&irradiance)
                    .map(|(&part, &total)| if total > 0.0 { (part / total) as f32 } else { 0.0 }),
            )
        };
        let shines = |share: &[f32]| share.iter().any(|&s| s > 0.0);
        let beam_share = share(&beam_irradiance);
        let sky_share = share(&sky_irradiance);
        Self {
            beam: sun
                .filter(|_| shines(&beam_share))
                .map(|sun| Beam { direction: sun.direction, share: beam_share }),
            dome: shines(&sky_share).then_some(Dome { share: sky_share }),
            irradiance,
        }
    }

    /// Radiance of the sky over its share of the irradiance, sr⁻¹.
    pub const RADIANCE_OF_SHARE: f64 = 1.0 / PI;
}
