use std::ops::Range;

use glam::{DVec2, DVec3};

use super::SceneOptics;
use super::optics::BandSun;
use crate::sampling::{Sampler, concentric_disc};
use crate::scattering::{SceneSpectra, SpectrumId};

/// Light of a stage, in units of the total irradiance on the horizontal plane, band by band.
///
/// Transport computes with a total irradiance of 1, so that what it finds is `L / E`: π times that
/// is the BRF, and times `E` it is the radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Suns, even those that shine in no band: they decide which points are sunlit. Scenes whose bands are joined have
    /// one for each position of their suns, in the order of its bands; others have one at most.
    pub suns: Vec<Beam>,
    /// Suns that shine in some band.
    pub beams: Vec<Beam>,
    /// The sky, if it shines in some band.
    pub dome: Option<Dome>,
    /// Total irradiance `E` on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub irradiance: Vec<f64>,
}

/// The sun of some bands.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Bands that it lights, and no other sun.
    pub bands: Range<usize>,
    /// Unit vector towards the sun's middle.
    pub direction: DVec3,
    /// The sun's disc; without one its light is parallel.
    pub disc: Option<SunDisc>,
    /// Fraction of the total horizontal irradiance that is each band's sun's.
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
    #[must_use]
    pub fn towards(&self, point: DiscPoint) -> DVec3 {
        let DiscPoint { u, v } = point;
        self.disc.as_ref().map_or(self.direction, |disc| disc.direction(u, v))
    }
}

/// Two uniform numbers: a point of the discs of all suns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscPoint {
    /// First number.
    pub u: f64,
    /// Second number.
    pub v: f64,
}

impl DiscPoint {
    /// One draw for all of these suns, if any has a disc.
    pub fn sample(suns: &[Beam], sampler: &mut Sampler) -> Self {
        let has_disc = suns.iter().any(|sun| sun.disc.is_some());
        let [u, v, ..] = if has_disc { sampler.next_4d() } else { [0.5; 4] };
        Self { u, v }
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
        // Packets start with a share of the light; with several suns all paths start at sensors.
        let is_counted = optics.suns.len() > 1;
        // A band without any light has no share of it: all it can measure is zero.
        let mut share = |part: &[f64]| {
            let share = |(&part, &total)| if total > 0.0 { (part / total) as f32 } else { 0.0 };
            let shares = part.iter().zip(&irradiance).map(share);
            if is_counted { spectra.add_counted(shares) } else { spectra.add(shares) }
        };
        let beam_share = share(&beam_irradiance);
        let sky_share = share(&sky_irradiance);
        let beam = |sun: &BandSun| Beam {
            bands: sun.bands.clone(),
            direction: sun.direction,
            disc: SunDisc::new(sun.direction, sun.radius),
            share: beam_share,
        };
        let suns: Vec<Beam> = optics.suns.iter().map(beam).collect();
        let shares = spectra.lanes(beam_share);
        let shines = |sun: &&Beam| shares[sun.bands.clone()].iter().any(|share| *share > 0.0);
        Self {
            beams: suns.iter().filter(shines).cloned().collect(),
            suns,
            dome: (!spectra.is_zero(sky_share)).then_some(Dome { share: sky_share }),
            irradiance,
        }
    }
}
