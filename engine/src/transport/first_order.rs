//! Light that was scattered once, by integration alone.

use std::ops::Range;

use glam::DVec3;

use super::Part;
use super::history::{BLOCK, Block, History};
use super::walk::{Answer, Asks, Walk};
use crate::accel::Ray;
use crate::extract::{Light, Stage};
use crate::geometry::basis;
use crate::sampling::{Key, Sampler, cosine_hemisphere};

/// Radiance over irradiance, `L / E` in sr⁻¹, of light that was scattered exactly once: what the first
/// surface along a ray sends back of sun and sky. Neither a walk nor a choice of lobes nor roulette:
/// the point on the film, that of the sun's disc and that of the sky are low-discrepancy points of two
/// dimensions each.
///
/// Of the sky, directions about the normal are drawn with the density `|cos θ| / π` over the upper
/// hemisphere: one below the horizon is replaced by its opposite, which sees the other side of the
/// surface at the same angle. So `f |cos θ| / pdf` is `π f` of whichever side it is: without noise but
/// for what hides the sky.
#[derive(Clone, Debug)]
pub(super) struct FirstOrder<'a> {
    history: History<'a>,
    sampler: Sampler,
    direction: DVec3,
    has_met: bool,
    part: Part,
    orders_apart: bool,
    rays: u64,
}

impl FirstOrder<'_> {
    /// With the parts apart if asked for.
    pub(super) fn new(orders_apart: bool) -> Self {
        Self {
            history: History::default(),
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            has_met: false,
            part: Part::Uncollided,
            orders_apart,
            rays: 0,
        }
    }

    /// Spectra in a row: the whole and, on request, its parts, of which no light is multiply scattered.
    pub(super) const fn spectra(orders: bool) -> usize {
        if orders { Part::ALL.len() } else { 1 }
    }
}

impl<'a> Walk<'a> for FirstOrder<'a> {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        (self.sampler, self.direction, self.has_met) = (sampler, ray.direction, false);
    }

    fn go_on(&mut self, stage: &'a Stage, Answer { hit, .. }: Answer<'_>, _: &mut Asks) {
        let Some(hit) = hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_met = true;
        self.part = Part::of(1, stage.is_ground(hit));
        let wo = -self.direction;
        let bsdf = &stage.surface(hit).bsdf;
        let [of_sun, across_sun, of_sky, across_sky] = self.sampler.next_event();
        let mut add = |towards: DVec3, share: &'a [f32], scale: f64| {
            let Some(scattering) = bsdf.eval(hit.normal, wo, towards) else { return };
            self.rays += 1;
            if !stage.geometry.occluded(&hit.leave(towards)) {
                let scale = (scale * Light::RADIANCE_OF_SHARE) as f32;
                self.history.light(scattering, share, scale);
            }
        };
        if let Some(beam) = &stage.light.beam {
            let disc = beam.disc.as_ref();
            let sun = disc.map_or(beam.direction, |disc| disc.direction(of_sun, across_sun));
            // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
            add(sun, &beam.share, hit.normal.dot(sun).abs() / sun.z);
        }
        if let Some(dome) = &stage.light.dome {
            let (tangent, bitangent) = basis(hit.normal);
            let local = cosine_hemisphere(of_sky, across_sky);
            let sky = tangent * local.x + bitangent * local.y + hit.normal * local.z;
            let sky = if sky.z < 0.0 { -sky } else { sky };
            // A horizontal ray would never leave a flat scene.
            if sky.z > 0.0 {
                add(sky, &dome.share, 1.0);
            }
        }
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, stage: &'a Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.history.clear();
        self.part = Part::Uncollided;
        if let Some(dome) = &stage.light.dome {
            self.history.see(&dome.share, Light::RADIANCE_OF_SHARE as f32);
        }
        true
    }

    fn spectra(&self) -> usize {
        Self::spectra(self.orders_apart)
    }

    /// The whole and, with orders apart, its parts in a row.
    #[inline(always)]
    fn show(&self, bands: Range<usize>, found: &mut [Block]) {
        let [whole, parts @ ..] = found else { return };
        self.history.light_of(self.history.len(), bands, whole);
        for (part, values) in Part::ALL.iter().zip(parts) {
            *values = if *part == self.part { *whole } else { [0.0; BLOCK] };
        }
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
