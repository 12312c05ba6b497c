use super::Angles;
use super::directional::BandModel;
use crate::components::RpvParameters;

/// Cosine of 85°, to which [`RpvParameters`] limit both directions: beyond, the model would reflect more light
/// than it receives.
const LEAST_COSINE: f64 = 0.087_155_742_747_658_17;

/// `π f = ρ0 [μi μo (μi + μo)]^(k-1) (1 - Θ²) / (1 + 2 Θ cos g + Θ²)^1.5 [1 + (1 - ρc) / (1 + G)]`, with the
/// phase angle `g` and `G² = tan²θi + tan²θo - 2 tan θi tan θo cos φ`.
///
/// Source: Rahman, Pinty & Verstraete (1993), J. Geophys. Res. 98 (D11), 20791–20801.
impl BandModel for RpvParameters {
    const KINKS: &'static [f64] = &[LEAST_COSINE];

    fn f(&self, angles: &Angles) -> f32 {
        let [cos_i, cos_o] = [angles.cos_i, angles.cos_o].map(|c| c.max(LEAST_COSINE as f32));
        let minnaert = (cos_i * cos_o * (cos_i + cos_o)).powf(self.k - 1.0);
        let asymmetry = self.asymmetry;
        let squared = asymmetry * asymmetry;
        let cosines = 1.0 + 2.0 * asymmetry * angles.cos_phase() + squared;
        let henyey_greenstein = (1.0 - squared) / (cosines * cosines.sqrt());
        let hot_spot = 1.0 + (1.0 - self.hot_spot) / (1.0 + angles.hot_spot_distance());
        self.rho0 * minnaert * henyey_greenstein * hot_spot
    }
}
