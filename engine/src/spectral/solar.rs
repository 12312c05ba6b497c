//! The sun's irradiance on a plane that faces it: on a clear day, and outside the atmosphere.
//!
//! Sources: ASTM G173-03, "Standard Tables for Reference Solar Spectral Irradiances: Direct Normal and
//! Hemispherical on 37° Tilted Surface", column "direct + circumsolar" (SMARTS 2.9.2, air mass 1.5,
//! 1.42 cm of water, aerosol optical depth 0.084 at 500 nm). `astm_g173_direct.txt` holds its values
//! [W m⁻² nm⁻¹] from 280 to 4000 nm as the Python package pvlib distributes them. ASTM E490-00a, "Standard Solar Constant
//! and Zero Air Mass Solar Spectral Irradiance Tables": `astm_e490.csv`, from 119.5 nm to 1 mm, as pyspectral distributes
//! it. See `NOTICE` beside them.

use std::sync::LazyLock;

use super::{BandResponse, BandWindow, OutsideSpectrum, band_mean, planck, planck_mean};

/// Effective temperature of the sun, K.
///
/// Source: IAU 2015 Resolution B3 on nominal solar conversion constants.
const SUN_K: f64 = 5772.0;

/// Distance of points beyond the end of a table for bands of curves, nm.
const STEP_BEYOND: f64 = 10.0;

/// A standard spectrum of the sun.
#[derive(Debug)]
pub struct SolarSpectrum {
    /// Its name in messages.
    pub name: &'static str,
    table: LazyLock<Vec<(f64, f64)>>,
}

/// Direct and circumsolar irradiance under a clear sky at air mass 1.5.
pub static ASTM_G173: SolarSpectrum = SolarSpectrum {
    name: "ASTM G173",
    table: LazyLock::new(|| {
        let values = include_str!("astm_g173_direct.txt").split_whitespace();
        let values = values.map(|value| value.parse().expect("the table holds numbers only"));
        wavelengths().zip(values).collect()
    }),
};

/// Irradiance outside the atmosphere.
pub static ASTM_E490: SolarSpectrum = SolarSpectrum {
    name: "ASTM E490",
    table: LazyLock::new(|| {
        let rows = include_str!("astm_e490.csv").lines().filter(|line| !line.starts_with('#'));
        let number = |text: &str| text.parse::<f64>().expect("the table holds numbers only");
        let point = |line: &str| {
            let (wavelength, value) = line.split_once(',').expect("the table has two columns");
            (number(wavelength), number(value))
        };
        rows.skip(1).map(point).collect()
    }),
};

/// Wavelengths of ASTM G173, nm: 0.5 nm apart up to 400, 1 nm up to 1700, then 1702 and 5 nm apart.
fn wavelengths() -> impl Iterator<Item = f64> {
    let fine = (0..240).map(|step| 280.0 + 0.5 * f64::from(step));
    let medium = (400..=1700).map(f64::from);
    let coarse = (341..=800).map(|step| 5.0 * f64::from(step));
    fine.chain(medium).chain([1702.0]).chain(coarse)
}

impl SolarSpectrum {
    /// Points (wavelength nm, W m⁻² nm⁻¹).
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.table
    }

    /// Last wavelength of the table, nm.
    #[must_use]
    pub fn end_nm(&self) -> f64 {
        self.last().0
    }

    fn last(&self) -> (f64, f64) {
        *self.table.last().expect("the tables have rows")
    }

    /// Factor on a black body as warm as the sun that joins the table at its end.
    fn beyond(&self) -> f64 {
        let (end, last) = self.last();
        last / planck(end, SUN_K)
    }

    /// Mean irradiance of the sun in a band on a plane that faces it, W m⁻² nm⁻¹, exact for straight
    /// lines between the points of the table; beyond its end that of a black body as warm as the sun that
    /// joins it there.
    ///
    /// # Errors
    /// A band that reaches below the first wavelength: a window at all, a curve with more than 1 %.
    pub fn mean(&self, band: &BandResponse) -> Result<f64, OutsideSpectrum> {
        let ((low, high), end) = (band.range(), self.end_nm());
        if high <= end {
            return band.mean(&self.table);
        }
        let BandResponse::Window(window) = band else { return band.mean(&self.points_to(high)) };
        let mean_beyond = |from: f64| {
            let window = BandWindow { center: 0.5 * (from + high), width: high - from };
            self.beyond() * planck_mean(&BandResponse::Window(window), SUN_K)
        };
        if low >= end {
            return Ok(mean_beyond(low.max(end)));
        }
        let inside_width = end - low;
        let inside = band_mean(&self.table, 0.5 * (low + end), inside_width)?;
        Ok((inside * inside_width + mean_beyond(end) * (high - end)) / window.width)
    }

    /// Points up to a wavelength beyond the end.
    fn points_to(&self, high: f64) -> Vec<(f64, f64)> {
        let (end, factor) = (self.end_nm(), self.beyond());
        let steps = ((high - end) / STEP_BEYOND).ceil().max(1.0);
        let beyond = (1..=steps as u32).map(|step| {
            let wavelength = end + (high - end) * f64::from(step) / steps;
            (wavelength, factor * planck(wavelength, SUN_K))
        });
        self.table.iter().copied().chain(beyond).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    fn mean(center: f64, width: f64) -> f64 {
        ASTM_G173.mean(&BandResponse::Window(BandWindow { center, width })).unwrap()
    }

    /// The standard gives a solar constant of 1366.1 W m⁻².
    #[test]
    fn outside_the_atmosphere_the_solar_constant_comes() {
        let (first, end) = (ASTM_E490.points()[0].0, ASTM_E490.end_nm());
        let window = BandWindow { center: 0.5 * (first + end), width: end - first };
        let total = ASTM_E490.mean(&BandResponse::Window(window)).unwrap() * window.width;
        assert!((total - 1366.1).abs() < 0.1, "{total}");
    }

    /// The standard gives 900.14 W m⁻² of direct and circumsolar irradiance from 280 to 4000 nm.
    #[test]
    fn the_table_is_that_of_the_standard() {
        assert_eq!(wavelengths().count(), 2002);
        assert_eq!(ASTM_G173.points().len(), 2002);
        let total = mean(2140.0, 3720.0) * 3720.0;
        assert!((total - 900.14).abs() < 0.05, "{total}");
        let at = |wavelength| mean(wavelength, 0.0);
        assert_eq!(at(280.0).to_bits(), 2.5361e-26_f64.to_bits());
        assert_eq!(at(1702.0).to_bits(), ASTM_G173.points()[1541].1.to_bits());
        assert_eq!(at(4000.0).to_bits(), 0.007_119_9_f64.to_bits());
    }

    #[test]
    fn beyond_the_table_the_sun_is_a_black_body_that_joins_it() {
        let at = mean;
        assert!((at(4000.001, 0.0) / at(4000.0, 0.0) - 1.0).abs() < 1e-5);
        // Two halves are the whole.
        let whole = at(4000.0, 200.0);
        let halves = 0.5 * (at(3950.0, 100.0) + at(4050.0, 100.0));
        assert!((whole / halves - 1.0).abs() < 1e-12);
        // 6.8e-5 sr of a black body, without the atmosphere: 2.4e-4 at 10 µm.
        let thermal = at(10_000.0, 0.0);
        assert!((1e-4..3e-4).contains(&thermal), "{thermal}");
        let window = BandWindow { center: 279.0, width: 0.0 };
        assert!(ASTM_G173.mean(&BandResponse::Window(window)).is_err());
    }
}
