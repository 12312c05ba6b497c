use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::bilambertian::BiLambertian;
use super::{BsdfSample, Importance, Interaction, Lobe, LobeSpectrum, SceneSpectra, SpectrumId};
use crate::components::{GlossyOptics, LeafCoating};
use crate::geometry::basis;
use crate::sampling::cosine_direction;

/// A rough dielectric coating over a diffuse leaf, alike on both sides.
///
/// `f = F(wi·h) D(h) G / (4 μi μo) + [1 - E(μi)] [1 - E(μo)] / (1 - Ē) ρ/π` on one side and the second term with
/// `τ` between sides, with the half vector `h`, Fresnel's reflectance `F` of a dielectric, Beckmann's
/// distribution of facets `D` and the V-groove masking `G`. `E(μ)` is the fraction that the coating reflects and
/// `Ē` its mean over directions: what the coating reflects does not reach the leaf's body, so that the leaf
/// never reflects more than it receives, and the model is reciprocal.
///
/// Source: Cook & Torrance (1982), ACM Trans. Graph. 1, 7–24, for the specular lobe, normalised as in Walter et
/// al. (2007), Eurographics Symposium on Rendering, 195–206; Kelemen & Szirmay-Kalos (2001), Eurographics short
/// presentations, for the coupling. Bousquet et al. (2005), Remote Sens. Environ. 98, 201–211, fitted leaves
/// with such a lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct GlossyLeaf {
    body: BiLambertian,
    coating: LeafCoating,
    /// `Ē = 2 ∫ E μ dμ`.
    mean_reflected: f64,
}

/// Intervals of cosines in the table of `E`.
const INTERVALS: usize = 128;

impl LeafCoating {
    /// A coating with this refractive index and roughness.
    #[must_use]
    pub fn new(refractive_index: f64, roughness: f64) -> Self {
        let node = |node| node as f64 / INTERVALS as f64;
        let reflected = |cosine| coating_reflectance(refractive_index, roughness, cosine);
        let reflected = (0..=INTERVALS).map(node).map(reflected).collect();
        Self { refractive_index, roughness, reflected }
    }
}

impl GlossyLeaf {
    /// The model of these optics.
    #[must_use]
    pub fn new(optics: &GlossyOptics, spectra: &mut SceneSpectra) -> Self {
        let GlossyOptics { body, coating } = optics;
        // Exact for the interpolated table: Simpson's rule for a product of two linear functions.
        let step = 1.0 / INTERVALS as f64;
        let simpson = |(node, pair): (usize, &[f64])| {
            let (low, high) = (node as f64 * step, (node + 1) as f64 * step);
            let middle = 4.0 * low.midpoint(high) * pair[0].midpoint(pair[1]);
            (low * pair[0] + middle + high * pair[1]) * step / 6.0
        };
        let mean_reflected =
            2.0 * coating.reflected.windows(2).enumerate().map(simpson).sum::<f64>();
        let body = BiLambertian::new(body, spectra);
        Self { body, coating: coating.clone(), mean_reflected }
    }

    /// `E`, interpolated.
    fn reflected(&self, cosine: f64) -> f64 {
        let place = cosine.clamp(0.0, 1.0) * INTERVALS as f64;
        let node = (place as usize).min(INTERVALS - 1);
        let upper = place - node as f64;
        let nodes = &self.coating.reflected;
        nodes[node] * (1.0 - upper) + nodes[node + 1] * upper
    }

    /// Factor of the body's `ρ` and `τ` for a pair of cosines.
    fn coupling(&self, cos_o: f64, cos_i: f64) -> f32 {
        let enters = 1.0 - self.reflected(cos_i);
        (enters * (1.0 - self.reflected(cos_o)) / (1.0 - self.mean_reflected)) as f32
    }

    #[inline(never)]
    pub(super) fn f(&self, at: &Interaction<'_>, wi: DVec3) -> Option<Lobe> {
        let (cos_o, cos_i) = (at.cos_o(), at.normal.dot(wi).abs());
        let coupling = self.coupling(cos_o, cos_i);
        let body = self.body.spectrum(at, wi);
        if !at.is_same_side(wi) {
            let is_zero = at.models.spectra.is_zero(body);
            return (!is_zero).then(|| Lobe::from(body).scaled(coupling));
        }
        let specular = (PI * self.specular(at, wi)) as f32;
        let spectrum = LobeSpectrum::Sum([(SpectrumId::ONE, specular), (body, coupling)]);
        Some(Lobe { spectrum, scale: 1.0 })
    }

    /// Specular part of `f` on the side of `wo`.
    fn specular(&self, at: &Interaction<'_>, wi: DVec3) -> f64 {
        let (cos_o, cos_i) = (at.cos_o(), at.normal.dot(wi).abs());
        let Some(half) = half_vector(at, wi) else { return 0.0 };
        let cos_h = at.normal.dot(half).abs();
        let cos_d = wi.dot(half).abs();
        let fresnel = dielectric(cos_d, self.coating.refractive_index);
        fresnel * beckmann(cos_h, self.coating.roughness) * masking(cos_h, cos_o.min(cos_i), cos_d)
            / (4.0 * cos_i * cos_o)
    }

    /// Probabilities of the specular lobe, diffuse reflection and transmission.
    fn probabilities(&self, at: &Interaction<'_>, importance: Importance<'_>) -> Option<[f64; 3]> {
        let power = |lobe: Lobe| f64::from(at.models.power(&lobe, importance));
        let enters = 1.0 - self.reflected(at.cos_o());
        let [reflected, transmitted] = self.body.lobes(at);
        let powers = [
            power(Lobe::ONE) * (1.0 - enters),
            power(reflected) * enters,
            power(transmitted) * enters,
        ];
        let total: f64 = powers.iter().sum();
        (total > 0.0).then(|| powers.map(|power| power / total))
    }

    #[inline(never)]
    pub(super) fn sample_f(
        &self,
        at: &Interaction<'_>,
        importance: Importance<'_>,
        [lobe, u, v]: [f64; 3],
    ) -> Option<BsdfSample> {
        let [specular, diffuse, _] = self.probabilities(at, importance)?;
        let outward = if at.is_front() { at.normal } else { -at.normal };
        let wi = if lobe < specular {
            let half = self.sample_half_vector(outward, u, v);
            2.0 * at.wo.dot(half) * half - at.wo
        } else if lobe < specular + diffuse {
            cosine_direction(outward, u, v)
        } else {
            cosine_direction(-outward, u, v)
        };
        let is_reflected = lobe < specular + diffuse;
        if is_reflected != at.is_same_side(wi) {
            // The mirror direction lies below the surface: masked.
            return None;
        }
        let pdf = self.pdf(at, importance, wi);
        let weight = self.f(at, wi)?.scaled((at.normal.dot(wi).abs() / (PI * pdf)) as f32);
        Some(BsdfSample { wi, weight })
    }

    /// A normal of a facet about the surface's normal with the density `D cos θ`.
    fn sample_half_vector(&self, outward: DVec3, u: f64, v: f64) -> DVec3 {
        let tan2 = -self.coating.roughness.powi(2) * (1.0 - u).ln();
        let cosine = (1.0 + tan2).sqrt().recip();
        let (sin, cos) = (TAU * v).sin_cos();
        let radius = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (tangent, bitangent) = basis(outward);
        tangent * (radius * cos) + bitangent * (radius * sin) + outward * cosine
    }

    pub(super) fn pdf(&self, at: &Interaction<'_>, importance: Importance<'_>, wi: DVec3) -> f64 {
        let Some([specular, diffuse, transmitted]) = self.probabilities(at, importance) else {
            return 0.0;
        };
        let cosine = at.normal.dot(wi).abs() / PI;
        if !at.is_same_side(wi) {
            return transmitted * cosine;
        }
        let of_half = half_vector(at, wi).map_or(0.0, |half| {
            let cos_h = at.normal.dot(half).abs();
            beckmann(cos_h, self.coating.roughness) * cos_h / (4.0 * at.wo.dot(half).abs())
        });
        specular * of_half + diffuse * cosine
    }

    pub(super) fn scattered_fraction(&self, at: &Interaction<'_>) -> Lobe {
        self.with_coating(at, self.body.scattered(at))
    }

    pub(super) fn absorbed_fraction(&self, at: &Interaction<'_>) -> Lobe {
        let enters = 1.0 - self.reflected(at.cos_o());
        self.body.absorbed_fraction(at).scaled(enters as f32)
    }

    pub(super) fn reflected_fraction(&self, at: &Interaction<'_>) -> Lobe {
        self.with_coating(at, self.body.reflected(at))
    }

    /// `E + (1 - E) S` of a fraction of the body.
    fn with_coating(&self, at: &Interaction<'_>, body: SpectrumId) -> Lobe {
        let coating = self.reflected(at.cos_o()) as f32;
        let spectrum = LobeSpectrum::Sum([(SpectrumId::ONE, coating), (body, 1.0 - coating)]);
        Lobe { spectrum, scale: 1.0 }
    }
}

fn half_vector(at: &Interaction<'_>, wi: DVec3) -> Option<DVec3> {
    (at.wo + wi).try_normalize()
}

/// Beckmann's density of facets, sr⁻¹: `exp(-tan²θ / m²) / (π m² cos⁴θ)`, of which `∫ D cos θ dω = 1`.
fn beckmann(cosine: f64, roughness: f64) -> f64 {
    let cos2 = cosine * cosine;
    let m2 = roughness * roughness;
    if cos2 <= 0.0 { 0.0 } else { ((cos2 - 1.0) / (cos2 * m2)).exp() / (PI * m2 * cos2 * cos2) }
}

/// Fraction of facets that others do not hide, V grooves: `min(1, 2 cos θh cos θ / cos d)` with the larger of the two
/// angles from the surface's normal.
fn masking(cos_h: f64, least_cosine: f64, cos_d: f64) -> f64 {
    (2.0 * cos_h * least_cosine / cos_d).min(1.0)
}

/// Fresnel's reflectance of unpolarised light for a dielectric.
fn dielectric(cosine: f64, refractive_index: f64) -> f64 {
    let n2 = refractive_index * refractive_index;
    let inside = (n2 - 1.0 + cosine * cosine).max(0.0).sqrt();
    let perpendicular = (cosine - inside) / (cosine + inside);
    let parallel = (n2 * cosine - inside) / (n2 * cosine + inside);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// `E`: fraction of light from a zenith angle that the coating reflects, `∫ f cos θ dω`, over normals of facets
/// that are even in their own density.
fn coating_reflectance(refractive_index: f64, roughness: f64, cosine: f64) -> f64 {
    const POINTS: u32 = 96;
    let cosine = cosine.max(1e-4);
    let wo = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let place = |index: u32| (f64::from(index) + 0.5) / f64::from(POINTS);
    let mut sum = 0.0;
    for i in 0..POINTS {
        // Beyond the last facet normals that matter the density is below e⁻¹⁶.
        let tan2 = -roughness.powi(2) * (1.0 - place(i)).ln();
        let cos_h = (1.0 + tan2).sqrt().recip();
        let sin_h = tan2.sqrt() * cos_h;
        for j in 0..POINTS {
            let (sin, cos) = (PI * place(j)).sin_cos();
            let half = DVec3::new(sin_h * cos, sin_h * sin, cos_h);
            let cos_d = wo.dot(half);
            let wi = 2.0 * cos_d * half - wo;
            if cos_d <= 0.0 || wi.z <= 0.0 {
                continue;
            }
            let fresnel = dielectric(cos_d, refractive_index);
            sum += fresnel * masking(cos_h, cosine.min(wi.z), cos_d) * cos_d / (cosine * cos_h);
        }
    }
    (sum / f64::from(POINTS * POINTS)).clamp(0.0, 1.0)
}
