//! Light that was scattered once, by integration alone.

use glam::DVec3;

use super::Part;
use super::walk::{Answer, Ask, Walk};
use crate::accel::Ray;
use crate::extract::{Light, Stage};
use crate::film::Sums;
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
pub(super) struct FirstOrder {
    radiance: Vec<f32>,
    sampler: Sampler,
    direction: DVec3,
    has_met: bool,
    part: Part,
    orders_apart: bool,
    rays: u64,
}

impl FirstOrder {
    /// For stages with this many lanes; with the parts apart if asked for.
    pub(super) fn new(lanes: usize, orders_apart: bool) -> Self {
        Self {
            radiance: vec![0.0; lanes],
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

impl Walk for FirstOrder {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.radiance.fill(0.0);
        (self.sampler, self.direction, self.has_met) = (sampler, ray.direction, false);
    }

    fn go_on(&mut self, stage: &Stage, Answer { hit, .. }: Answer) -> Ask {
        let Some(hit) = hit.filter(|hit| !stage.is_cut(hit)) else { return Ask::END };
        self.has_met = true;
        self.part = Part::of(1, stage.is_ground(&hit));
        let wo = -self.direction;
        let bsdf = &stage.surface(&hit).bsdf;
        let [of_sun, across_sun, of_sky, across_sky] = self.sampler.next_event();
        let mut add = |towards: DVec3, share: &[f32], scale: f64| {
            let Some(scattering) = bsdf.eval(hit.normal, wo, towards) else { return };
            self.rays += 1;
            if stage.geometry.occluded(&hit.leave(towards)) {
                return;
            }
            let scale = (scale * Light::RADIANCE_OF_SHARE) as f32;
            for (radiance, (share, f)) in self.radiance.iter_mut().zip(share.iter().zip(scattering))
            {
                *radiance += share * f * scale;
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
        Ask::END
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.radiance.fill(0.0);
        self.part = Part::Uncollided;
        if let Some(dome) = &stage.light.dome {
            for (radiance, share) in self.radiance.iter_mut().zip(&*dome.share) {
                *radiance = share * Light::RADIANCE_OF_SHARE as f32;
            }
        }
        true
    }

    fn values(&self) -> &[f32] {
        &self.radiance
    }

    /// Adds the whole and, with orders apart, its parts in a row.
    fn add_to(&self, sums: &mut Sums, cell: usize) {
        if !self.orders_apart {
            return sums.add(cell, &self.radiance, 1.0);
        }
        let bands = sums.bands() / Self::spectra(true);
        sums.add_with(cell, |channel| {
            let (spectrum, lane) = (channel / bands, channel % bands);
            let of_part = |spectrum: usize| Part::ALL[spectrum - 1] == self.part;
            if spectrum == 0 || of_part(spectrum) { self.radiance[lane].into() } else { 0.0 }
        });
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
