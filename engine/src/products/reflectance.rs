use std::f64::consts::PI;

/// Bidirectional reflectance factor: leaving radiance over that of an ideal white Lambertian target
/// in the same light, `BRF = π L / E`. Under a sky the same ratio is the HDRF.
///
/// - `relative`: `L / E`, sr⁻¹, shape `[.., bands]`
/// - returns: no unit, the same shape; above 1 is lawful (hot spot); NaN in a band without light
///
/// Source: Schaepman-Strub et al. (2006), Remote Sens. Environ. 103, 27-42.
#[must_use]
pub fn brf(relative: &[f64], irradiance: &[f64]) -> Vec<f64> {
    by_band(relative, irradiance, |l, e| if e > 0.0 { PI * l } else { f64::NAN })
}

/// Radiance, W m⁻² sr⁻¹ nm⁻¹, from `L / E` and the total horizontal irradiance `E`, W m⁻² nm⁻¹,
/// shape `[bands]`.
#[must_use]
pub fn radiance(relative: &[f64], irradiance: &[f64]) -> Vec<f64> {
    by_band(relative, irradiance, |l, e| l * e)
}

/// A share of the incident power in units of flux density over the scene's rectangle, W m⁻² nm⁻¹.
#[must_use]
pub fn flux_density(share: &[f64], irradiance: &[f64]) -> Vec<f64> {
    by_band(share, irradiance, |share, e| share * e)
}

/// A share of the incident power; NaN in a band without light.
#[must_use]
pub fn fraction(share: &[f64], irradiance: &[f64]) -> Vec<f64> {
    by_band(share, irradiance, |share, e| if e > 0.0 { share } else { f64::NAN })
}

fn by_band(values: &[f64], irradiance: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    values.iter().zip(irradiance.iter().cycle()).map(|(&value, &e)| f(value, e)).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{brf, radiance};

    #[test]
    fn a_lambertian_target_has_a_brf_equal_to_its_reflectance() {
        // L = ρ E / π, so L / E = ρ / π.
        let measured = brf(&[0.3 / PI, 0.5 / PI, 0.1 / PI, 0.2 / PI], &[2.0, 0.0]);
        assert!((measured[0] - 0.3).abs() < 1e-15 && (measured[2] - 0.1).abs() < 1e-15);
        assert!(measured[1].is_nan() && measured[3].is_nan(), "no light, no factor");
        assert!((radiance(&[0.3 / PI], &[2.0])[0] - 0.6 / PI).abs() < 1e-15);
    }
}
