/// The wavelengths that a band sees, all alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandWindow {
    /// Centre, nm.
    pub center: f64,
    /// Full width, nm; 0 is the centre alone.
    pub width: f64,
}

/// A band that reaches beyond the wavelengths at which a spectrum is known.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the band from {low} to {high} nm reaches outside the spectrum, which is given from {first} to \
     {last} nm; extend the spectrum or move the band"
)]
pub struct OutsideSpectrum {
    /// Lower edge of the band, nm.
    pub low: f64,
    /// Upper edge of the band, nm.
    pub high: f64,
    /// First wavelength of the spectrum, nm; NaN if it has none.
    pub first: f64,
    /// Last wavelength of the spectrum, nm; NaN if it has none.
    pub last: f64,
}

/// Mean of a spectrum over a band, `(1/w) ∫ f dλ` over `[c - w/2, c + w/2]`, exact for the straight
/// lines that join its points; `f(c)` where `w = 0`.
///
/// - `points`: (wavelength nm, value), shape `[points]`, wavelengths rising
/// - returns: in the unit of the values
///
/// # Errors
/// A band that reaches outside the wavelengths of the points, is not finite or has a negative width.
pub fn band_mean(
    points: &[(f64, f64)],
    center_nm: f64,
    width_nm: f64,
) -> Result<f64, OutsideSpectrum> {
    let (low, high) = (center_nm - 0.5 * width_nm, center_nm + 0.5 * width_nm);
    let end = |point: Option<&(f64, f64)>| point.map_or(f64::NAN, |&(wavelength, _)| wavelength);
    let (first, last) = (end(points.first()), end(points.last()));
    // Edges come of a sum of decimals: one that misses the end by its rounding is the end.
    let rounding = 4.0 * f64::EPSILON;
    let inside = low >= first * (1.0 - rounding) && high <= last * (1.0 + rounding);
    // A width of NaN is caught here too.
    if !(inside && low <= high) {
        return Err(OutsideSpectrum { low, high, first, last });
    }
    let (low, high) = (low.clamp(first, last), high.clamp(first, last));
    if low >= high {
        return Ok(value_at(points, low));
    }
    // The corners of the curve within the band, between its two edges.
    let from = points.partition_point(|&(wavelength, _)| wavelength <= low);
    let to = points.partition_point(|&(wavelength, _)| wavelength < high);
    let ends = [(low, value_at(points, low)), (high, value_at(points, high))];
    let mut previous = ends[0];
    let mut integral = 0.0;
    for &next in points[from..to].iter().chain(&ends[1..]) {
        integral += 0.5 * (next.0 - previous.0) * (previous.1 + next.1);
        previous = next;
    }
    Ok(integral / (high - low))
}

/// The straight line between the two points around a wavelength; beyond all points the value of the last one there.
pub(super) fn value_at(points: &[(f64, f64)], wavelength: f64) -> f64 {
    let after = points.partition_point(|&(at, _)| at < wavelength);
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (_, Some(&(at, value))) if at <= wavelength => value,
        (Some(a), Some(&b)) => {
            let part = (wavelength - a.0) / (b.0 - a.0);
            a.1 * (1.0 - part) + b.1 * part
        }
        (Some((_, value)), None) | (None, Some(&(_, value))) => value,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#[allow(clippy::float_cmp, reason = "these values come out exact")]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const POINTS: [(f64, f64); 4] = [(400.0, 0.0), (500.0, 1.0), (600.0, 1.0), (700.0, 0.0)];

    #[test]
    fn means_are_the_integrals_of_straight_lines() {
        let mean = |center, width| band_mean(&POINTS, center, width).unwrap();
        assert_eq!(mean(450.0, 0.0), 0.5);
        assert_eq!(mean(500.0, 0.0), 1.0);
        assert_eq!(mean(450.0, 20.0), 0.5);
        assert_eq!(mean(550.0, 300.0), 2.0 / 3.0);
        // Half of [490, 510] rises from 0.9 to 1.
        assert!((mean(500.0, 20.0) - 0.975).abs() < 1e-15);
        assert_eq!(mean(400.0, 0.0), 0.0);
        assert_eq!(mean(700.0, 0.0), 0.0);
    }

    #[test]
    fn a_band_outside_the_spectrum_is_an_error_that_names_its_range() {
        let error = band_mean(&POINTS, 405.0, 20.0).unwrap_err();
        assert_eq!(error, OutsideSpectrum { low: 395.0, high: 415.0, first: 400.0, last: 700.0 });
        assert!(error.to_string().contains("from 400 to 700 nm"), "{error}");
        assert!(band_mean(&POINTS, 700.1, 0.0).is_err());
        assert!(band_mean(&POINTS, f64::NAN, 0.0).is_err());
        assert!(band_mean(&POINTS, 500.0, f64::NAN).is_err());
        assert!(band_mean(&POINTS, 500.0, -1.0).is_err());
        assert!(band_mean(&POINTS, 500.0, f64::INFINITY).is_err());
        assert!(band_mean(&[], 500.0, 0.0).is_err());
    }

    #[test]
    fn rounding_of_an_edge_is_not_outside() {
        // 400.15 - 0.3 / 2 comes out just below 400.
        let points = [(400.15 - 0.5 * 0.3 + 1e-13, 1.0), (500.0, 3.0)];
        assert!(400.15 - 0.5 * 0.3 < points[0].0);
        assert!(band_mean(&points, 400.15, 0.3).is_ok());
    }

    proptest! {
        /// A straight line's mean is its value at the centre, wherever points lie on it.
        #[test]
        fn the_mean_of_a_straight_line_is_its_middle(
            steps in prop::collection::vec(0.1..50.0_f64, 1..20),
            slope in -2.0..2.0_f64,
            center in 0.0..1.0_f64,
            width in 0.0..1.0_f64,
        ) {
            let mut wavelength = 400.0;
            let mut points = vec![(wavelength, 1.0)];
            for step in steps {
                wavelength += step;
                points.push((wavelength, 1.0 + slope * (wavelength - 400.0)));
            }
            let range = wavelength - 400.0;
            let center = 400.0 + range * center;
            let width = width * 2.0 * (center - 400.0).min(wavelength - center);
            let mean = band_mean(&points, center, width).unwrap();
            let exact = 1.0 + slope * (center - 400.0);
            prop_assert!((mean - exact).abs() < 1e-9 * (1.0 + range), "{mean} {exact}");
        }
    }
}
