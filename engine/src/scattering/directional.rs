//! Opaque models whose reflection depends on both directions and differs by band.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::{Angles, BsdfSample, Interaction, Lobe, LobeSpectrum, SceneSpectra, SpectrumId};
use crate::components::DirectionalOptics;
use crate::sampling::cosine_direction;

/// Reflection in one band of an opaque surface: isotropic, alike on both sides, reciprocal, `f(wi, wo) = f(wo, wi)`, and
/// without narrow peaks beside the hot spot, as directions are sampled by the cosine.
pub trait BandModel: Copy + Sync {
    /// Cosines of zenith angles at which `f` has a kink: panels of the integration of its fractions end there.
    const KINKS: &'static [f64] = &[];

    /// `π f`, at least 0.
    fn f(&self, angles: &Angles) -> f32;
}

/// A model with its parameters in each band. Directions are sampled by the cosine.
#[derive(Clone, Debug, PartialEq)]
pub struct Directional<B> {
    bands: Vec<B>,
    fractions: FractionTable,
    /// The representative bands.
    representatives: Vec<u32>,
    /// Minimum of `π f` in these by the cosine of `wo`, shape `[nodes of the fractions, representatives]`: a part of what any
    /// of the bands that each stands for scatters, so that none is ruled out where the representative reflects
    /// nothing. Empty if each band represents itself.
    least: Vec<Vec<f32>>,
}

impl<B: BandModel> Directional<B> {
    /// The model of these optics. Adds its fractions to the spectra.
    #[must_use]
    pub fn new(optics: &DirectionalOptics<B>, spectra: &mut SceneSpectra) -> Self {
        let DirectionalOptics { bands, dhr } = optics;
        let fractions = FractionTable::new(dhr, spectra);
        let (bands, representatives, least) = (bands.clone(), Vec::new(), Vec::new());
        let mut model = Self { bands, fractions, representatives, least };
        model.choose_representatives(spectra);
        model
    }

    /// Takes over the representative bands of the spectra.
    pub(super) fn choose_representatives(&mut self, spectra: &SceneSpectra) {
        let chosen = spectra.representative_bands();
        self.representatives = chosen.bands().to_vec();
        let nodes = self.fractions.scattered.iter().filter(|_| !chosen.are_all());
        self.least = nodes.map(|&node| chosen.least_of(spectra.lanes(node))).collect();
    }

    /// `π f` for some pairs of directions, by which representative bands are chosen; each of shape `[bands]`.
    pub(super) fn shapes(&self) -> Vec<Vec<f32>> {
        let direction = |zenith: f64, azimuth: f64| {
            let ((sin, cos), (y, x)) = (zenith.to_radians().sin_cos(), azimuth.sin_cos());
            DVec3::new(sin * x, sin * y, cos)
        };
        let pairs = [
            (direction(0.0, 0.0), direction(0.0, 0.0)),
            (direction(30.0, 0.0), direction(30.0, 0.0)),
            (direction(30.0, 0.0), direction(30.0, PI)),
            (direction(60.0, 0.0), direction(0.0, 0.0)),
            (direction(60.0, 0.0), direction(60.0, 0.5 * PI)),
            (direction(75.0, 0.0), direction(60.0, 0.0)),
            (direction(75.0, 0.0), direction(60.0, PI)),
        ];
        let shape = |(wo, wi)| {
            let angles = Angles::new(DVec3::Z, wo, wi);
            self.bands.iter().map(|band| band.f(&angles)).collect()
        };
        pairs.into_iter().map(shape).collect()
    }

    pub(super) fn scattered_fraction(&self, at: &Interaction<'_>) -> Lobe {
        FractionTable::at(&self.fractions.scattered, at.cos_o())
    }

    pub(super) fn absorbed_fraction(&self, at: &Interaction<'_>) -> Lobe {
        FractionTable::at(&self.fractions.absorbed, at.cos_o())
    }

    /// Writes `π f` in a range of lanes.
    pub(super) fn evaluate(&self, angles: &Angles, lanes: Range<usize>, values: &mut [f32]) {
        for (lane, value) in lanes.zip(values) {
            *value = self.bands.get(lane).map_or(0.0, |band| band.f(angles));
        }
    }

    /// Writes `π f` in the representative bands: at least a part of what any of the bands that each stands for scatters.
    pub(super) fn evaluate_representatives(&self, angles: &Angles, values: &mut [f32]) {
        values.fill(0.0);
        for (value, &band) in values.iter_mut().zip(&self.representatives) {
            *value = self.bands[band as usize].f(angles);
        }
        if !self.least.is_empty() {
            let node = (f64::from(angles.cos_o).sqrt() * INTERVALS as f64) as usize;
            for (value, least) in values.iter_mut().zip(&self.least[node.min(INTERVALS)]) {
                *value = value.max(*least);
            }
        }
    }
}

/// `π f` of a model that depends on both directions; `None` between the two sides.
#[inline(never)]
pub(super) fn f(at: &Interaction<'_>, wi: DVec3) -> Option<Lobe> {
    let spectrum = LobeSpectrum::Model(at.surface, Angles::new(at.normal, at.wo, wi));
    at.is_same_side(wi).then_some(Lobe { spectrum, scale: 1.0 })
}

/// Samples the cosine.
#[inline(never)]
pub(super) fn sample_f(at: &Interaction<'_>, [_, u, v]: [f64; 3]) -> Option<BsdfSample> {
    let wi = cosine_direction(if at.is_front() { at.normal } else { -at.normal }, u, v);
    // f |cos θ| / pdf = π f.
    f(at, wi).map(|weight| BsdfSample { wi, weight })
}

/// `cos θ / π` on the side of `wo`.
pub(super) fn pdf(at: &Interaction<'_>, wi: DVec3) -> f64 {
    if at.is_same_side(wi) { at.normal.dot(wi).abs() / PI } else { 0.0 }
}

/// Scattered and absorbed fraction of light by the cosine of its zenith angle. Nodes are even in the square
/// root of the cosine, denser towards grazing directions; values between nodes are interpolated.
#[derive(Clone, Debug, PartialEq)]
struct FractionTable {
    scattered: Vec<SpectrumId>,
    absorbed: Vec<SpectrumId>,
}

/// Intervals between nodes: the error of interpolation is below 1e-4.
const INTERVALS: usize = 64;

impl FractionTable {
    /// Adds fractions to the spectra, from DHR of shape `[bands, nodes]`.
    fn new(dhr: &[Vec<f32>], spectra: &mut SceneSpectra) -> Self {
        let (mut scattered, mut absorbed) = (Vec::new(), Vec::new());
        for node in 0..=INTERVALS {
            let of_node = || dhr.iter().map(move |band| band[node]);
            absorbed.push(spectra.add_counted(of_node().map(|dhr| 1.0 - dhr)));
            scattered.push(spectra.add(of_node()));
        }
        Self { scattered, absorbed }
    }

    /// Interpolates between the two nodes about a cosine.
    fn at(nodes: &[SpectrumId], cosine: f64) -> Lobe {
        let place = cosine.clamp(0.0, 1.0).sqrt() * INTERVALS as f64;
        let node = (place as usize).min(INTERVALS - 1);
        let upper = (place - node as f64) as f32;
        let spectrum = LobeSpectrum::Sum([(nodes[node], 1.0 - upper), (nodes[node + 1], upper)]);
        Lobe { spectrum, scale: 1.0 }
    }
}

fn node_cosine(node: usize) -> f64 {
    (node as f64 / INTERVALS as f64).powi(2)
}

/// A band in which a model has no physical meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelFault {
    /// Band, from 0.
    pub band: usize,
    /// Zenith angle of the light, rad.
    pub zenith: f64,
    /// Directional-hemispherical reflectance there.
    pub dhr: f64,
}

impl<B: BandModel> DirectionalOptics<B> {
    /// Integrates a model in each band.
    ///
    /// # Errors
    /// The first band that reflects more light than it receives, or less than none, from any direction.
    pub fn new(bands: Vec<B>) -> Result<Self, ModelFault> {
        let rows: Vec<_> = (0..bands.len())
            .into_par_iter()
            .map(|band| {
                let mut row = Vec::with_capacity(INTERVALS + 1);
                for node in 0..=INTERVALS {
                    let cosine = node_cosine(node);
                    let dhr = dhr(&bands[band], cosine);
                    if node.is_multiple_of(CHECKED) && !(0.0..=1.0).contains(&dhr) {
                        return Err(ModelFault { band, zenith: cosine.acos(), dhr });
                    }
                    // Above 1 by the error of the quadrature at most.
                    row.push((dhr as f32).clamp(0.0, 1.0));
                }
                Ok(row)
            })
            .collect();
        let dhr = rows.into_iter().collect::<Result<_, _>>()?;
        Ok(Self { bands, dhr })
    }
}

/// Nodes of which one is checked.
const CHECKED: usize = 4;

/// Nodes and weights of the Gauss-Legendre rule with eight points on [0, 1].
const GAUSS: [(f64, f64); 8] = [
    (0.019_855_071_751_231_9, 0.050_614_268_145_188_1),
    (0.101_666_761_293_186_6, 0.111_190_517_226_687_2),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_6),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_6),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_2),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_1),
];

/// Cosine of 85°: grazing directions, where models change fast, have a panel of their own.
const GRAZING: f64 = 0.087_155_742_747_658_17;

/// Directional-hemispherical reflectance `∫ f cos θi dωi` for light from a zenith angle.
///
/// Panels of a Gauss-Legendre rule over `cos² θi` meet at the angle of the light, where models have their hot
/// spot, at grazing angles and at the kinks of the model; azimuths are denser towards the hot spot.
fn dhr<B: BandModel>(band: &B, cosine: f64) -> f64 {
    let cosine = cosine.max(1e-6);
    let wo = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let kinks = B::KINKS.iter().map(|kink| kink * kink);
    let ends = [0.0, GRAZING * GRAZING, cosine * cosine, 1.0];
    let mut borders: Vec<f64> = ends.into_iter().chain(kinks).collect();
    borders.sort_by(f64::total_cmp);
    let mut sum = 0.0;
    for panel in borders.windows(2) {
        let width = panel[1] - panel[0];
        for (x, weight) in GAUSS {
            // Denser towards both ends of the panel.
            let (place, slope) = (x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x));
            let cos_i = (panel[0] + width * place).sqrt();
            let sin_i = (1.0 - cos_i * cos_i).max(0.0).sqrt();
            for half in [0.0, 0.5] {
                for (y, weight_of_azimuth) in GAUSS {
                    let y = half + 0.5 * y;
                    let (sin, cos) = (PI * y * y).sin_cos();
                    let wi = DVec3::new(sin_i * cos, sin_i * sin, cos_i);
                    let f = f64::from(band.f(&Angles::new(DVec3::Z, wo, wi)));
                    sum += f * width * weight * slope * weight_of_azimuth * y;
                }
            }
        }
    }
    // dω cos θ / π = d(cos² θ) dφ / 2π; both halves of the azimuth, and 0.5 · 2 y for its density.
    sum
}
