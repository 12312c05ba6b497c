//! The sun's irradiance on a clear day.
//!
//! Source: ASTM G173-03, "Standard Tables for Reference Solar Spectral Irradiances: Direct Normal and
//! Hemispherical on 37° Tilted Surface", column "direct + circumsolar" (SMARTS 2.9.2, air mass 1.5,
//! 1.42 cm of water, aerosol optical depth 0.084 at 500 nm). `astm_g173_direct.txt` holds its values
//! [W m⁻² nm⁻¹] from 280 to 4000 nm as the Python package pvlib distributes them: see `NOTICE` beside it.

use std::sync::LazyLock;

use super::{BandWindow, OutsideSpectrum, band_mean, planck, planck_mean};

/// Last wavelength of the table, nm.
pub const ASTM_G173_END_NM: f64 = 4000.0;

/// Effective temperature of the sun, K.
///
/// Source: IAU 2015 Resolution B3 on nominal solar conversion constants.
const SUN_K: f64 = 5772.0;

/// Points (wavelength nm, W m⁻² nm⁻¹).
static TABLE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let values = include_str!("astm_g173_direct.txt").split_whitespace();
    let values = values.map(|value| value.parse().expect("the table holds numbers only"));
    wavelengths().zip(values).collect()
});

/// Wavelengths of the table, nm: 0.5 nm apart up to 400, 1 nm up to 1700, then 1702 and 5 nm apart.
fn wavelengths() -> impl Iterator<Item = f64> {
    let fine = (0..240).map(|step| 280.0 + 0.5 * f64::from(step));
    let medium = (400..=1700).map(f64::from);
    let coarse = (341..=800).map(|step| 5.0 * f64::from(step));
    fine.chain(medium).chain([1702.0]).chain(coarse)
}

/// Mean irradiance of the sun over a band on a plane that faces it, W m⁻² nm⁻¹, exact for straight
/// lines between the points of ASTM G173; beyond its end that of a black body as warm as the sun that
/// joins it there.
///
/// # Errors
/// A band that reaches below 280 nm.
pub fn solar_irradiance(center_nm: f64, width_nm: f64) -> Result<f64, OutsideSpectrum> {
    let (low, high) = (center_nm - 0.5 * width_nm, center_nm + 0.5 * width_nm);
    if high <= ASTM_G173_END_NM {
        return band_mean(&TABLE, center_nm, width_nm);
    }
    let last = TABLE.last().map_or(f64::NAN, |&(_, irradiance)| irradiance);
    let factor = last / planck(ASTM_G173_END_NM, SUN_K);
    let from = low.max(ASTM_G173_END_NM);
    let window = BandWindow { center: 0.5 * (from + high), width: high - from };
    let beyond = factor * planck_mean(window, SUN_K);
    if low >= ASTM_G173_END_NM {
        return Ok(beyond);
    }
    let inside_width = ASTM_G173_END_NM - low;
    let inside = band_mean(&TABLE, 0.5 * (low + ASTM_G173_END_NM), inside_width)?;
    Ok((inside * inside_width + beyond * (high - from)) / (high - low))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    /// The standard gives 900.14 W m⁻² of direct and circumsolar irradiance from 280 to 4000 nm.
    #[test]
    fn the_table_is_that_of_the_standard() {
        assert_eq!(wavelengths().count(), 2002);
        assert_eq!(TABLE.len(), 2002);
        let total = solar_irradiance(2140.0, 3720.0).unwrap() * 3720.0;
        assert!((total - 900.14).abs() < 0.05, "{total}");
        let at = |wavelength| solar_irradiance(wavelength, 0.0).unwrap();
        assert_eq!(at(280.0).to_bits(), 2.5361e-26_f64.to_bits());
        assert_eq!(at(1702.0).to_bits(), TABLE[1541].1.to_bits());
        assert_eq!(at(4000.0).to_bits(), 0.007_119_9_f64.to_bits());
    }

    #[test]
    fn beyond_the_table_the_sun_is_a_black_body_that_joins_it() {
        let at = |center, width| solar_irradiance(center, width).unwrap();
        assert!((at(4000.001, 0.0) / at(4000.0, 0.0) - 1.0).abs() < 1e-5);
        // Two halves are the whole.
        let whole = at(4000.0, 200.0);
        let halves = 0.5 * (at(3950.0, 100.0) + at(4050.0, 100.0));
        assert!((whole / halves - 1.0).abs() < 1e-12);
        // 6.8e-5 sr of a black body, without the atmosphere: 2.4e-4 at 10 µm.
        let thermal = at(10_000.0, 0.0);
        assert!((1e-4..3e-4).contains(&thermal), "{thermal}");
        assert!(solar_irradiance(279.0, 0.0).is_err());
    }
}
