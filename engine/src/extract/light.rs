use glam::{DVec2, DVec3};

use super::SceneOptics;
use crate::sampling::{Sampler, concentric_disc};
use crate::scattering::{SceneSpectra, SpectrumId};

/// Light of a stage, in units of the total irradiance on the horizontal plane, band by band.
///
/// Transport computes with a total irradiance of 1, so that what it finds is `L / E`: π times that
/// is the BRF, and times `E` it is the radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The sun, even if it shines in no band: it decides which points are sunlit.
    pub sun: Option<Beam>,
    /// The sun, if it shines in some band.
    pub beam: Option<Beam>,
    /// The sky, if it shines in some band.
    pub dome: Option<Dome>,
    /// Total irradiance `E` on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub irradiance: Vec<f64>,
}

/// The sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Unit vector towards the sun's middle.
    pub direction: DVec3,
    /// The sun's disc; without one its light is parallel.
    pub disc: Option<SunDisc>,
    /// Its fraction of the total horizontal irradiance.
    pub share: SpectrumId,
}

/// A solar disc of even radiance, wholly above the horizon.
///
/// Seen from above, the cap of directions that it fills is an ellipse. A uniform point of that
/// ellipse has, as a direction, the density `cos θ` that makes all directions give the horizontal
/// plane the same flux: its irradiance is exact, whatever is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunDisc {
    middle: DVec2,
    /// Semi-axes of the ellipse: across the sun's azimuth, and along it.
    across: DVec2,
    along: DVec2,
}

impl SunDisc {
    /// About this direction, with this angular radius, rad; `None` for a radius of 0.
    #[must_use]
    pub fn new(direction: DVec3, radius: f64) -> Option<Self> {
        let (sin, cos) = radius.sin_cos();
        let horizontal = direction.truncate().try_normalize().unwrap_or(DVec2::Y);
        (radius > 0.0).then_some(Self {
            middle: direction.truncate() * cos,
            across: horizontal.perp() * sin,
            along: horizontal * (sin * direction.z),
        })
    }

    /// Direction towards a point of the disc, from two uniform numbers, with a density in
    /// proportion to the cosine of its zenith angle.
    #[must_use]
    pub fn direction(&self, u: f64, v: f64) -> DVec3 {
        let at = concentric_disc(u, v);
        let plan = self.middle + self.across * at.x + self.along * at.y;
        plan.extend((1.0 - plan.length_squared()).max(f64::MIN_POSITIVE).sqrt())
    }
}

impl Beam {
    /// Unit vector towards a point of the sun. Light of a horizontal irradiance `E` from there gives
    /// a surface with the normal `n` the irradiance `E |n·ω| / ω_z`.
    pub fn towards(&self, sampler: &mut Sampler) -> DVec3 {
        self.disc.as_ref().map_or(self.direction, |disc| {
            let [u, v, ..] = sampler.next_4d();
            disc.direction(u, v)
        })
    }
}

/// The isotropic sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Dome {
    /// Its fraction of the total horizontal irradiance; its radiance is this over π.
    pub share: SpectrumId,
}

impl Light {
    /// Light of sun and sky. Adds their spectra to the table.
    pub(super) fn new(optics: &SceneOptics, spectra: &mut SceneSpectra) -> Self {
        let (beam_irradiance, sky_irradiance) = (optics.beam_irradiance(), optics.sky_irradiance());
        let irradiance = optics.irradiance();
        // A band without any light has no share of it: all it can measure is zero.
        let mut share = |part: &[f64]| {
            spectra.add(
                part.iter()
                    .zip(&irradiance)
                    .map(|(&part, &total)| if total > 0.0 { (part / total) as f32 } else { 0.0 }),
            )
        };
        let beam_share = share(&beam_irradiance);
        let sky_share = share(&sky_irradiance);
        let sun = optics.sun.as_ref().map(|sun| Beam {
            direction: sun.direction,
            disc: SunDisc::new(sun.direction, sun.radius),
            share: beam_share,
        });
        Self {
            beam: sun.clone().filter(|beam| !spectra.is_zero(beam.share)),
            sun,
            dome: (!spectra.is_zero(sky_share)).then_some(Dome { share: sky_share }),
            irradiance,
        }
    }
}
