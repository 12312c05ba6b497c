//! Reflectances that scenes may use by name. Sources are in the heads of the files and in `../NOTICE`.

use std::sync::LazyLock;

/// Reflectance that comes with sunfleck.
#[derive(Debug)]
struct LibrarySpectrum {
    name: &'static str,
    /// Points (wavelength nm, reflectance).
    points: Vec<(f64, f64)>,
}

/// Columns of all tables.
static SPECTRA: LazyLock<Vec<LibrarySpectrum>> = LazyLock::new(|| {
    let tables = [include_str!("litter_bark_wood.csv"), include_str!("snow.csv")];
    tables.into_iter().flat_map(columns).collect()
});

/// Reflectances of dry and of wet soil, which [`soil_reflectance`] mixes.
static SOIL: LazyLock<Vec<LibrarySpectrum>> =
    LazyLock::new(|| columns(include_str!("soil.csv")).collect());

/// Names of all spectra.
pub fn library_names() -> impl Iterator<Item = &'static str> {
    SPECTRA.iter().map(|spectrum| spectrum.name)
}

/// Points (wavelength nm, reflectance) of a spectrum; `None` if none has this name.
#[must_use]
pub fn library_spectrum(name: &str) -> Option<&'static [(f64, f64)]> {
    SPECTRA.iter().find(|spectrum| spectrum.name == name).map(|spectrum| spectrum.points.as_slice())
}

/// Points (wavelength nm, reflectance) of a soil: `b (d ρ_dry + (1 - d) ρ_wet)`, 400 to 2500 nm.
///
/// - `dryness`: d, 0 (wet) to 1 (dry)
/// - `brightness`: b, 1 for the soils that were measured
///
/// Source: the two soils of PROSAIL; Jacquemoud et al. (2009), Remote Sens. Environ. 113, S56.
#[must_use]
pub fn soil_reflectance(dryness: f64, brightness: f64) -> Vec<(f64, f64)> {
    let [dry, wet] = [&SOIL[0].points, &SOIL[1].points];
    let mix = |(dry, wet): (&(f64, f64), &(f64, f64))| {
        (dry.0, brightness * (dryness * dry.1 + (1.0 - dryness) * wet.1))
    };
    dry.iter().zip(wet).map(mix).collect()
}

/// Columns of a table behind its wavelengths.
fn columns(text: &'static str) -> impl Iterator<Item = LibrarySpectrum> {
    let mut rows = text.lines().filter(|line| !line.starts_with('#'));
    let header = rows.next().expect("a table has a header");
    let number = |text: &str| text.parse::<f64>().expect("the tables hold numbers");
    let rows: Vec<Vec<f64>> = rows.map(|row| row.split(',').map(number).collect()).collect();
    header.split(',').enumerate().skip(1).map(move |(column, name)| LibrarySpectrum {
        name,
        points: rows.iter().map(|row| (row[0], row[column])).collect(),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#[allow(clippy::float_cmp, reason = "values of tables come out exact")]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_reflectances_at_rising_wavelengths() {
        assert_eq!(library_names().count(), 21 + 4);
        for name in library_names() {
            let points = library_spectrum(name).unwrap();
            assert!(points.len() > 100, "{name}");
            assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0), "{name}");
            assert!(points.iter().all(|(_, value)| (0.0..=1.0).contains(value)), "{name}");
            assert!(points[0].0 <= 400.0 && points[points.len() - 1].0 >= 2450.0, "{name}");
        }
        assert!(library_spectrum("bark").is_none());
    }

    /// Values of the tables that are known from elsewhere: PROSAIL's soils at 400 and 2500 nm.
    #[test]
    fn soils_are_mixtures_of_a_dry_and_a_wet_one() {
        let ends = |points: &[(f64, f64)]| [points[0].1, points[points.len() - 1].1];
        assert_eq!(ends(&soil_reflectance(1.0, 1.0)), [0.2377, 0.4464]);
        assert_eq!(ends(&soil_reflectance(0.0, 1.0)), [0.03208, 0.04885]);
        let [half, _] = ends(&soil_reflectance(0.5, 0.8));
        assert!((half - 0.8 * 0.5 * (0.2377 + 0.03208)).abs() < 1e-15);
    }
}
