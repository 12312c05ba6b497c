//! Emitted radiance, backward from the sensor, in absolute units.

use glam::DVec3;

use super::directions::{Means, Rounds, projections, walk_views};
use super::image::walk_pixels;
use super::{Camera, ImageOutcome, ViewsOutcome, Walk, Watch, roulette};
use crate::accel::{Hit, Ray};
use crate::components::{Stop, View};
use crate::extract::{Stage, Thermal};
use crate::sampling::{Key, Sampler};

/// Emitted radiance of each pixel, W m⁻² sr⁻¹ nm⁻¹; 0 in bands that hold none.
///
/// At each point of a random walk the surface adds `(1 - ρ - τ) B(T)` with the reflectance of the
/// side that is seen, and the sky adds its radiance where the walk leaves the scene. Nothing of the
/// sun is in it. `T` is the sunlit temperature where the sun is visible from the point, on whichever
/// side of the surface: a leaf is too thin for two temperatures.
#[must_use]
pub fn measure_image_thermal(
    stage: &Stage,
    camera: &Camera,
    samples: u32,
    key: Key,
    watch: Watch<'_>,
) -> ImageOutcome {
    let path = || ThermalPath::new(stage);
    walk_pixels(stage, (camera, samples), key, watch, stage.bands, path)
}

/// Emitted radiance of what each view sees of the scene, shape `[views, bands]`, see
/// [`measure_image_thermal`]; `elapsed` tells the seconds since the start.
///
/// # Panics
/// If there is no condition to end.
#[must_use]
pub fn measure_directions_thermal(
    stage: &Stage,
    views: &[View],
    until: &[Stop],
    key: Key,
    elapsed: &dyn Fn() -> f64,
    watch: Watch<'_>,
) -> ViewsOutcome {
    let projections = projections(stage, views);
    // The last column counts the rays that met the scene.
    let columns = stage.bands + 1;
    Rounds::measure(
        (views.len(), columns),
        until,
        (elapsed, watch),
        |range, rows| walk_views(stage, &projections, range, key, rows, || ThermalPath::new(stage)),
        |rows, _| Means::of_met(rows).median_relative_error(),
    )
    .of_met()
}

/// A random walk from the sensor that gathers what surfaces and the sky emit.
#[derive(Clone, Debug)]
struct ThermalPath {
    throughput: Vec<f32>,
    /// Shape `[bands + 1]` or longer; behind the bands stands a 1.
    radiance: Vec<f32>,
    rays: u64,
}

impl ThermalPath {
    fn new(stage: &Stage) -> Self {
        Self {
            throughput: vec![0.0; stage.lanes()],
            radiance: vec![0.0; stage.lanes() + 1],
            rays: 0,
        }
    }

    fn closest(&mut self, stage: &Stage, ray: &Ray) -> Option<Hit> {
        self.rays += 1;
        stage.geometry.closest(ray)
    }

    /// Adds what the surface emits towards `-direction`.
    fn add_surface(
        &mut self,
        stage: &Stage,
        thermal: &Thermal,
        (hit, scattered): (&Hit, &[f32]),
        sampler: &mut Sampler,
    ) {
        let warmth = &thermal.surfaces[hit.surface as usize];
        let is_sunlit = warmth.knows_sun
            && stage.light.sun.as_ref().is_some_and(|sun| {
                self.rays += 1;
                !stage.geometry.occluded(&hit.leave(sun.towards(sampler)))
            });
        let black = if is_sunlit { &warmth.sunlit } else { &warmth.shaded };
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), (black, scattered)) in paths.zip(black.iter().zip(scattered)) {
            *radiance += weight * (1.0 - scattered) * black;
        }
    }

    fn walk(
        &mut self,
        stage: &Stage,
        thermal: &Thermal,
        mut ray: Ray,
        sampler: &mut Sampler,
    ) -> bool {
        self.throughput.copy_from_slice(&thermal.bands);
        let mut order = 0;
        loop {
            let Some(hit) = self.closest(stage, &ray) else {
                if order > 0 && ray.direction.z > 0.0 {
                    let paths = self.radiance.iter_mut().zip(&self.throughput);
                    for ((radiance, weight), sky) in paths.zip(&*thermal.sky) {
                        *radiance += weight * sky;
                    }
                }
                return order > 0;
            };
            let bsdf = &stage.surface(&hit).bsdf;
            let wo = -ray.direction;
            self.add_surface(stage, thermal, (&hit, bsdf.scattered(hit.normal, wo)), sampler);
            if order == stage.rules.max_order {
                return true;
            }
            order += 1;
            let [lobe, u, v, chance] = sampler.next_event();
            let Some(scattered) = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])
            else {
                return true;
            };
            for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
                *weight *= factor * scattered.scale;
            }
            if !roulette::survives(&stage.rules, order, &mut self.throughput, chance) {
                return true;
            }
            ray = hit.leave(scattered.direction);
        }
    }
}

impl Walk for ThermalPath {
    fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool {
        self.radiance.fill(0.0);
        self.radiance[stage.bands] = 1.0;
        let Some(thermal) = &stage.thermal else { return false };
        // Padding behind the bands has no weight, so the 1 there stays.
        self.walk(stage, thermal, ray, sampler)
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        let Some(thermal) = &stage.thermal else { return false };
        self.radiance[..thermal.sky.len()].copy_from_slice(&thermal.sky);
        self.radiance[stage.bands] = 1.0;
        direction.z > 0.0
    }

    fn values(&self) -> &[f32] {
        &self.radiance
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
