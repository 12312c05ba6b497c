use super::Angles;
use super::directional::BandModel;
use crate::components::SoilspectParameters;

/// `π f = ω / [4 (μi + μo)] {[1 + B(g)] P(g, g') + H(μi) H(μo) - 1}` with the phase angle `g`, the angle `g'`
/// between the view and the mirror direction of the light, `B = B0 / (1 + tan(g/2) / h)`,
/// `P = 1 + b cos g + c (3 cos² g - 1) / 2 + b' cos g' + c' (3 cos² g' - 1) / 2` and
/// `H(μ) = (1 + 2 μ) / (1 + 2 μ √(1 - ω))`; at least 0.
///
/// Source: Jacquemoud, Baret & Hanocq (1992), Remote Sens. Environ. 41, 123–132.
impl BandModel for SoilspectParameters {
    fn f(&self, angles: &Angles) -> f32 {
        let legendre = |cosine: f32| (3.0 * cosine * cosine - 1.0) / 2.0;
        let (phase, mirror) = (angles.cos_phase(), angles.cos_mirror());
        let opposition = self.hot_spot / (1.0 + angles.tan_half_phase / self.roughness);
        let phase_function = 1.0
            + self.backward[0] * phase
            + self.backward[1] * legendre(phase)
            + self.forward[0] * mirror
            + self.forward[1] * legendre(mirror);
        let root = (1.0 - self.albedo).sqrt();
        let multiple = |cosine: f32| (1.0 + 2.0 * cosine) / (1.0 + 2.0 * cosine * root);
        let (cos_i, cos_o) = (angles.cos_i, angles.cos_o);
        let braces = (1.0 + opposition) * phase_function + multiple(cos_i) * multiple(cos_o) - 1.0;
        (self.albedo / (4.0 * (cos_i + cos_o)) * braces).max(0.0)
    }
}
