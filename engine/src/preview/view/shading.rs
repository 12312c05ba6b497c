//! Colours of what rays hit: sunlight with shadows, light of the sky, and a constant for what is scattered more often.

use glam::{DVec3, Vec3};

use crate::accel::{Hit, Ray};
use crate::appearance::{ColourSource, MaterialColour, material_colours, srgb};
use crate::extract::Stage;
use crate::run::LoadedScene;
use crate::sampling::cosine_direction;

/// Irradiance of the sun on a plane that faces it, and of the sky on the horizontal, relative; red, green, blue.
const SUN: Vec3 = Vec3::new(1.0, 0.95, 0.86);
const SKY: Vec3 = Vec3::new(0.24, 0.29, 0.36);

/// Light that reaches what neither the sun nor the sky lights directly, relative to that of the sky.
const SCATTERED: f32 = 0.4;

/// Colours of the sky at the horizon and in the zenith, and of what lies beyond the ground; sRGB, linear.
const HORIZON: Vec3 = Vec3::new(0.72, 0.80, 0.88);
const ZENITH: Vec3 = Vec3::new(0.22, 0.42, 0.74);
const BEYOND: Vec3 = Vec3::new(0.52, 0.55, 0.57);

/// Colour of the faces along which an isolated ground is cut out of the earth.
const EARTH: Vec3 = Vec3::new(0.19, 0.14, 0.10);

/// Colours of surfaces and light of a view.
#[derive(Clone, Debug)]
pub(super) struct Shading {
    sun: DVec3,
    /// Colours by surface of the stage.
    surfaces: Vec<SurfaceColour>,
    materials: Vec<MaterialColour>,
}

#[derive(Clone, Copy, Debug)]
struct SurfaceColour {
    front: Vec3,
    back: Vec3,
    transmitted: Vec3,
}

/// Hit whose shadow rays are traced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit {
    /// Colour of its reflection or transmission of sunlight, times the cosine.
    sunlit: Vec3,
    /// Colour of its reflection of the sky.
    skylit: Vec3,
    /// Direction in which it looks at the sky.
    sky: DVec3,
}

impl Shading {
    pub(super) fn new(loaded: &LoadedScene, stage: &Stage, sun: DVec3) -> Self {
        let materials = material_colours(&loaded.world.world, &loaded.world.resources);
        let colour = |name: &String| {
            let found = materials.iter().find(|material| material.name == *name);
            let found = found.expect("surfaces of a stage have materials of the scene");
            SurfaceColour {
                front: Vec3::from(found.front),
                back: Vec3::from(found.back),
                transmitted: Vec3::from(found.transmitted),
            }
        };
        let surfaces = stage.surface_names.iter().map(colour).collect();
        Self { sun, surfaces, materials: used(materials, stage) }
    }

    /// Origin of the colours, a line each.
    pub(super) fn told_colours(&self) -> Vec<String> {
        let origins = [
            (ColourSource::Spectrum, "colours by their spectra"),
            (ColourSource::Bands, "colours by the scene's bands"),
            (ColourSource::Kind, "colours assumed, as their spectra have no visible light"),
        ];
        let line = |(source, what): (ColourSource, &str)| {
            let of = self.materials.iter().filter(|material| material.source == source);
            let names: Vec<&str> = of.map(|material| material.name.as_str()).collect();
            (!names.is_empty()).then(|| format!("{what}: {}", names.join(", ")))
        };
        origins.into_iter().filter_map(line).collect()
    }

    /// Colour of a ray that hits nothing.
    pub(super) fn background(direction: DVec3) -> Vec3 {
        let height = direction.z as f32;
        if height >= 0.0 {
            HORIZON.lerp(ZENITH, height.powf(0.6))
        } else {
            BEYOND.lerp(HORIZON, (-8.0 * -height).exp().min(1.0))
        }
    }

    /// What lights a hit; `numbers` choose the direction in which it looks at the sky.
    pub(super) fn light(&self, stage: &Stage, ray: &Ray, hit: &Hit, numbers: [f64; 2]) -> Lit {
        let is_front = hit.normal.dot(ray.direction) < 0.0;
        let outwards = if is_front { hit.normal } else { -hit.normal };
        let sky = cosine_direction(outwards, numbers[0], numbers[1]);
        if stage.is_cut(hit) {
            let sunlit = EARTH * outwards.dot(self.sun).max(0.0) as f32;
            return Lit { sunlit, skylit: EARTH, sky };
        }
        let SurfaceColour { front, back, transmitted } = self.surfaces[hit.surface as usize];
        let reflected = if is_front { front } else { back };
        let cosine = outwards.dot(self.sun) as f32;
        let sunlit = if cosine > 0.0 { reflected * cosine } else { transmitted * -cosine };
        // Skylight from behind a leaf is taken to be that from before it.
        Lit { sunlit, skylit: reflected + transmitted, sky }
    }

    /// Shadow rays of a hit: towards the sun, and towards the sky.
    pub(super) fn shadow_rays(&self, hit: &Hit, lit: &Lit) -> [Ray; 2] {
        [hit.leave(self.sun), hit.leave(lit.sky)]
    }

    /// Colour of a hit whose shadow rays are traced.
    pub(super) fn colour(lit: &Lit, is_occluded: [bool; 2]) -> Vec3 {
        let sun = if is_occluded[0] { Vec3::ZERO } else { SUN * lit.sunlit };
        let sky = if is_occluded[1] {
            SCATTERED
        } else if lit.sky.z > 0.0 {
            1.0
        } else {
            // Light of the ground beyond.
            0.5
        };
        sun + sky * SKY * lit.skylit
    }
}

/// Colours of the materials that the stage has.
fn used(materials: Vec<MaterialColour>, stage: &Stage) -> Vec<MaterialColour> {
    let is_used = |material: &MaterialColour| stage.surface_names.contains(&material.name);
    materials.into_iter().filter(is_used).collect()
}

/// Sums of the colours of a pixel's samples, linear sRGB: those of surfaces are exposed, the background is not.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PixelColour {
    surface: Vec3,
    background: Vec3,
    /// Number of samples that hit a surface.
    hits: u32,
}

impl PixelColour {
    /// Colour of a sample that hit a surface.
    pub(super) fn from_surface(surface: Vec3) -> Self {
        Self { surface, background: Vec3::ZERO, hits: 1 }
    }

    /// Colour of a sample that hit nothing.
    pub(super) fn from_background(background: Vec3) -> Self {
        Self { surface: Vec3::ZERO, background, hits: 0 }
    }

    /// Adds the samples of another sum.
    pub(super) fn add(&mut self, other: Self) {
        self.surface += other.surface;
        self.background += other.background;
        self.hits += other.hits;
    }
}

/// Red, green and blue of a picture, so bright that nearly all of its surfaces are below white.
///
/// - `samples`: number of samples per pixel
pub(super) fn exposed(sums: &[PixelColour], samples: u32) -> Vec<u8> {
    let brightness = |sum: &PixelColour| sum.surface.max_element() / sum.hits.max(1) as f32;
    let mut bright: Vec<f32> = sums.iter().map(brightness).filter(|value| *value > 0.0).collect();
    let gain = if bright.is_empty() {
        1.0
    } else {
        let rank = (0.985 * (bright.len() - 1) as f64).round() as usize;
        let top = *bright.select_nth_unstable_by(rank, f32::total_cmp).1;
        // Bright sand stays bright: only what is darker than that is lifted.
        (0.85 / top).clamp(1.0, 6.0)
    };
    let scale = 1.0 / samples as f32;
    let pixel =
        |sum: &PixelColour| srgb((scale * (gain * sum.surface + sum.background)).to_array());
    sums.iter().flat_map(pixel).collect()
}
