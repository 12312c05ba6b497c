use std::f64::consts::PI;

use glam::DVec3;

use super::{Scattered, Spectrum};
use crate::components::SurfaceOptics;
use crate::geometry::basis;
use crate::sampling::cosine_hemisphere;

/// Lambertian reflection of each side and Lambertian transmission: `f = ρ/π` where `wi` and `wo`
/// lie on the same side and `τ/π` where they do not.
#[derive(Clone, Debug, PartialEq)]
pub struct BiLambertian {
    front: Side,
    back: Side,
    transmitted: Spectrum,
}

/// Shares of the light that arrives on one side.
#[derive(Clone, Debug, PartialEq)]
struct Side {
    reflected: Spectrum,
    /// ρ + τ.
    scattered: Spectrum,
    /// 1 - ρ - τ.
    absorbed: Spectrum,
}

impl BiLambertian {
    /// The model of these optics.
    #[must_use]
    pub fn new(optics: &SurfaceOptics) -> Self {
        let tau = optics.transmittance();
        let side = |rho: &[f32]| {
            // ρ + τ = 1 may round to an ulp above 1, which would absorb less than nothing.
            let scattered = rho.iter().zip(tau).map(|(r, t)| (r + t).min(1.0));
            Side {
                reflected: Spectrum::new(rho.iter().copied()),
                absorbed: Spectrum::new(scattered.clone().map(|scattered| 1.0 - scattered)),
                scattered: Spectrum::new(scattered),
            }
        };
        let transmitted = Spectrum::new(tau.iter().copied());
        Self { front: side(optics.front()), back: side(optics.back()), transmitted }
    }

    fn side(&self, normal: DVec3, wo: DVec3) -> &Side {
        if normal.dot(wo) >= 0.0 { &self.front } else { &self.back }
    }

    pub(super) fn eval(&self, normal: DVec3, wo: DVec3, wi: DVec3) -> Option<&Spectrum> {
        let same_side = (normal.dot(wo) >= 0.0) == (normal.dot(wi) >= 0.0);
        let lobe = if same_side { &self.side(normal, wo).reflected } else { &self.transmitted };
        (!lobe.is_black()).then_some(lobe)
    }

    pub(super) fn scattered(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        &self.side(normal, wo).scattered
    }

    pub(super) fn absorbed(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        &self.side(normal, wo).absorbed
    }

    pub(super) fn reflected(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        &self.side(normal, wo).reflected
    }

    pub(super) fn sample(
        &self,
        normal: DVec3,
        wo: DVec3,
        power: impl Fn(&Spectrum) -> f32,
        [lobe, u, v]: [f64; 3],
    ) -> Option<Scattered<'_>> {
        let reflected = &self.side(normal, wo).reflected;
        let power = |lobe: &Spectrum| f64::from(if lobe.is_black() { 0.0 } else { power(lobe) });
        let (back, through) = (power(reflected), power(&self.transmitted));
        let total = back + through;
        if total <= 0.0 {
            return None;
        }
        let reflects = lobe * total < back;
        let (chosen, probability) =
            if reflects { (reflected, back / total) } else { (&self.transmitted, through / total) };
        let outward = if (normal.dot(wo) >= 0.0) == reflects { normal } else { -normal };
        let (tangent, bitangent) = basis(outward);
        let local = cosine_hemisphere(u, v);
        let direction = tangent * local.x + bitangent * local.y + outward * local.z;
        Some(Scattered { direction, spectrum: chosen, scale: (1.0 / probability) as f32 })
    }

    /// Density of `sample`, sr⁻¹, for tests: `P(lobe) |cos θ| / π`.
    #[must_use]
    pub fn pdf(&self, normal: DVec3, wo: DVec3, wi: DVec3, throughput: &[f32]) -> f64 {
        let power = |lobe: &Spectrum| -> f64 {
            throughput.iter().zip(lobe.iter()).map(|(w, s)| f64::from(w * s)).sum()
        };
        let (back, through) = (power(&self.side(normal, wo).reflected), power(&self.transmitted));
        let same_side = (normal.dot(wo) >= 0.0) == (normal.dot(wi) >= 0.0);
        let chosen = if same_side { back } else { through };
        if chosen == 0.0 { 0.0 } else { chosen / (back + through) * normal.dot(wi).abs() / PI }
    }
}
