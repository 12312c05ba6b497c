//! Colours of materials as a person sees them in daylight.

use hecs::World;

use crate::components::{MaterialId, SurfaceOptics, TerrainPatch};
use crate::document::Material;
use crate::spectral::observer::{daylight, transfer};
use crate::systems::{Resources, VISIBLE_NM, visible_optics};

/// Origin of a material's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourSource {
    /// Its spectra in the visible range, by the CIE observer.
    Spectrum,
    /// The scene's bands, which include blue, green and red ones.
    Bands,
    /// The kind of surface: a leaf, ground or anything else, as bright as in a visible band if the scene has one.
    Kind,
}

/// Colour of a material in daylight, linear sRGB, fractions of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialColour {
    /// Name of the material.
    pub name: String,
    /// Reflection of the front side.
    pub front: [f32; 3],
    /// Reflection of the back side.
    pub back: [f32; 3],
    /// Transmission.
    pub transmitted: [f32; 3],
    /// True if it is a leaf.
    pub is_leaf: bool,
    /// Origin of the colour.
    pub source: ColourSource,
}

/// Colours of leaves, the ground and all else whose spectra say nothing: reflection and transmission.
const LEAF: [[f32; 3]; 2] = [[0.055, 0.105, 0.03], [0.035, 0.085, 0.012]];
const GROUND: [f32; 3] = [0.24, 0.185, 0.13];
const WOOD: [f32; 3] = [0.16, 0.125, 0.095];

/// Colours of all materials of a world, by [`MaterialId`].
#[must_use]
pub fn material_colours(world: &World, resources: &Resources) -> Vec<MaterialColour> {
    let visible = visible_optics(world, resources);
    let mut terrains = world.query::<&TerrainPatch>();
    let ground: Vec<MaterialId> =
        terrains.iter().flat_map(|patch| patch.materials.0.iter().copied()).collect();
    let wavelengths: Vec<f64> =
        resources.responses.all().iter().map(crate::spectral::BandResponse::center).collect();
    let colour = |(index, (name, &entity)): (usize, (&String, &hecs::Entity))| {
        let is_leaf = world.get::<&Material>(entity).is_ok_and(|material| material.is_leaf());
        let optics = world.get::<&SurfaceOptics>(entity).ok();
        let in_bands = optics.as_deref().map(Fractions::new);
        let (source, [front, back, transmitted]) = match visible.get(index) {
            Some(Some(optics)) => {
                (ColourSource::Spectrum, Fractions::new(optics).colours(&VISIBLE_NM))
            }
            _ => match in_bands {
                Some(fractions) if has_colours(&wavelengths) => {
                    (ColourSource::Bands, fractions.colours(&wavelengths))
                }
                fractions => {
                    let is_ground = ground.contains(&MaterialId(index as u32));
                    let colours = by_kind(is_leaf, is_ground, fractions.as_ref(), &wavelengths);
                    (ColourSource::Kind, colours)
                }
            },
        };
        MaterialColour { name: name.clone(), front, back, transmitted, is_leaf, source }
    };
    resources.materials.iter().enumerate().map(colour).collect()
}

/// sRGB of linear sRGB.
#[must_use]
pub fn srgb([r, g, b]: [f32; 3]) -> [u8; 3] {
    [r, g, b].map(|value| (255.0 * transfer(f64::from(value).clamp(0.0, 1.0))).round() as u8)
}

/// Fractions of the light that a surface reflects and transmits, shape `[bands]` each.
struct Fractions {
    front: Vec<f64>,
    back: Vec<f64>,
    transmitted: Vec<f64>,
}

impl Fractions {
    fn new(optics: &SurfaceOptics) -> Self {
        let wide = |values: &[f32]| values.iter().map(|&value| f64::from(value)).collect();
        // Light from halfway between the zenith and the horizon stands for all directions.
        let middle = |dhr: &Vec<Vec<f32>>| -> Vec<f64> {
            let value = |nodes: &Vec<f32>| nodes.get(nodes.len() / 2).copied().unwrap_or(0.0);
            dhr.iter().map(|nodes| f64::from(value(nodes))).collect()
        };
        let opaque = |dhr: Vec<f64>| Self {
            transmitted: vec![0.0; dhr.len()],
            back: dhr.clone(),
            front: dhr,
        };
        match optics {
            SurfaceOptics::Rpv(model) => opaque(middle(&model.dhr)),
            SurfaceOptics::Soilspect(model) => opaque(middle(&model.dhr)),
            SurfaceOptics::Mapped(map) => opaque(map.mean()),
            SurfaceOptics::BiLambertian(body) => Self {
                front: wide(body.front()),
                back: wide(body.back()),
                transmitted: wide(body.transmittance()),
            },
            SurfaceOptics::GlossyLeaf(leaf) => Self {
                front: wide(leaf.body.front()),
                back: wide(leaf.body.back()),
                transmitted: wide(leaf.body.transmittance()),
            },
        }
    }

    /// Colours of the front, the back and the light that passes.
    fn colours(&self, wavelengths: &[f64]) -> [[f32; 3]; 3] {
        let weights = daylight(wavelengths);
        let colour = |values: &Vec<f64>| {
            let mut sum = [0.0; 3];
            for (weight, value) in weights.iter().zip(values) {
                for (sum, weight) in sum.iter_mut().zip(weight) {
                    *sum += weight * value;
                }
            }
            // Some greens are more saturated than a screen.
            sum.map(|value: f64| value.clamp(0.0, 1.0) as f32)
        };
        [colour(&self.front), colour(&self.back), colour(&self.transmitted)]
    }
}

/// Returns whether bands include blue, green and red ones.
fn has_colours(wavelengths: &[f64]) -> bool {
    let has = |low: f64, high: f64| wavelengths.iter().any(|nm| (low..high).contains(nm));
    has(420.0, 505.0) && has(505.0, 590.0) && has(590.0, 700.0)
}

/// Colours of a material of unknown spectrum.
fn by_kind(
    is_leaf: bool,
    is_ground: bool,
    fractions: Option<&Fractions>,
    wavelengths: &[f64],
) -> [[f32; 3]; 3] {
    let [reflected, transmitted] = match (is_leaf, is_ground) {
        (true, _) => LEAF,
        (false, true) => [GROUND, [0.0; 3]],
        (false, false) => [WOOD, [0.0; 3]],
    };
    let visible = wavelengths.iter().position(|nm| (420.0..700.0).contains(nm));
    let brightness = visible.zip(fractions).and_then(|(band, fractions)| {
        let channel =
            if wavelengths[band] >= 590.0 { 0 } else { usize::from(wavelengths[band] < 505.0) + 1 };
        Some(*fractions.front.get(band)? as f32 / reflected[channel])
    });
    let factor = brightness.unwrap_or(1.0).clamp(0.3, 4.0);
    let reflected = reflected.map(|value| (factor * value).min(0.9));
    [reflected, reflected, transmitted]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_have_colours_if_they_hold_blue_green_and_red() {
        assert!(has_colours(&[490.0, 560.0, 665.0, 842.0]));
        assert!(!has_colours(&[560.0, 665.0, 842.0]));
        assert!(!has_colours(&[660.0, 865.0]));
    }

    #[test]
    fn dark_and_bright_ground_differ_in_one_visible_band() {
        let fractions = |value| Fractions {
            front: vec![value, 0.4],
            back: vec![value, 0.4],
            transmitted: vec![0.0; 2],
        };
        let red = |value| by_kind(false, true, Some(&fractions(value)), &[660.0, 865.0])[0][0];
        assert!((red(0.12) - 0.12).abs() < 1e-6 && (red(0.3) - 0.3).abs() < 1e-6);
        let without = by_kind(false, true, Some(&fractions(0.12)), &[865.0, 10_000.0])[0];
        assert_eq!(without.map(f32::to_bits), GROUND.map(f32::to_bits));
    }
}
