//! Light that was scattered once, by integration alone.

use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

use glam::DVec3;

use super::history::{History, LitBands};
use super::tracer::PathTracer;
use crate::accel::Ray;
use crate::extract::{DiscPoint, Stage};
use crate::sampling::{Key, Sampler, cosine_direction};
use crate::scattering::SpectrumId;
use crate::transport::ScatteringOrder;
use crate::transport::band_blocks::{BLOCK, Block};
use crate::transport::ray_queue::{RayQueue, RayResults};

/// Radiance over irradiance, `L / E` in sr⁻¹, of light that was scattered exactly once: light of sun and sky
/// that the first surface along a ray sends back. There is no random walk, no choice of lobes and no roulette:
/// the points on the film, on the sun's disc and on the sky are low-discrepancy points of two dimensions each.
///
/// Directions towards the sky have the density `|cos θ| / π` about the normal over the upper hemisphere: one
/// below the horizon is replaced by its opposite, which lies on the other side of the surface at the same angle.
/// So `f |cos θ| / pdf` is `π f` of either side: its only noise is occlusion of the sky, for Lambertian surfaces.
#[derive(Clone, Debug)]
pub(in crate::transport) struct FirstOrderPath {
    history: History,
    sampler: Sampler,
    direction: DVec3,
    has_hit: bool,
    part: ScatteringOrder,
    separates_orders: bool,
    rays: u64,
}

impl FirstOrderPath {
    /// A path, with its parts kept apart on request.
    pub(in crate::transport) fn new(separates_orders: bool) -> Self {
        Self {
            history: History::default(),
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            has_hit: false,
            part: ScatteringOrder::Uncollided,
            separates_orders,
            rays: 0,
        }
    }

    /// Number of spectra: the whole and, on request, its parts, none of which is multiply scattered.
    pub(in crate::transport) const fn spectrum_count(separates_orders: bool) -> usize {
        if separates_orders { ScatteringOrder::ALL.len() } else { 1 }
    }
}

impl PathTracer for FirstOrderPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        (self.sampler, self.direction, self.has_hit) = (sampler, ray.direction, false);
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, _: &mut RayQueue) {
        let Some(hit) = results.hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_hit = true;
        self.part = ScatteringOrder::from_order(1, stage.is_ground(hit));
        let surface = stage.interaction(hit, -self.direction);
        let [sun_u, sun_v, sky_u, sky_v] = self.sampler.next_4d();
        let mut add = |wi: DVec3, (source, bands): (SpectrumId, LitBands), scale: f64| {
            let Some(f) = surface.f(wi) else { return };
            self.rays += 1;
            if !stage.geometry.occluded(&hit.leave(wi)) {
                self.history.light(f, source, (scale * FRAC_1_PI) as f32, bands);
            }
        };
        for beam in &stage.light.beams {
            let sun = beam.towards(DiscPoint { u: sun_u, v: sun_v });
            // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
            let source = (beam.share, LitBands::from(&beam.bands));
            add(sun, source, hit.normal.dot(sun).abs() / sun.z);
        }
        if let Some(dome) = &stage.light.dome {
            let sky = cosine_direction(hit.normal, sky_u, sky_v);
            let sky = if sky.z < 0.0 { -sky } else { sky };
            // A horizontal ray would never leave a flat scene.
            if sky.z > 0.0 {
                add(sky, (dome.share, LitBands::ALL), 1.0);
            }
        }
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.history.clear();
        self.part = ScatteringOrder::Uncollided;
        if let Some(dome) = &stage.light.dome {
            self.history.see(dome.share, FRAC_1_PI as f32);
        }
        true
    }

    fn spectrum_count(&self) -> usize {
        Self::spectrum_count(self.separates_orders)
    }

    /// The whole and, with separate orders, its parts in a row.
    #[inline(always)]
    fn write_radiance(&self, stage: &Stage, bands: Range<usize>, radiance: &mut [Block]) {
        let [whole, parts @ ..] = radiance else { return };
        self.history.radiance(&stage.models, self.history.len(), bands, whole);
        for (part, values) in ScatteringOrder::ALL.iter().zip(parts) {
            *values = if *part == self.part { *whole } else { [0.0; BLOCK] };
        }
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
