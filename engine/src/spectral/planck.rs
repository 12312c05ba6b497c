use super::{BandResponse, BandWindow};
use crate::units::{BOLTZMANN, LIGHT_SPEED, NM_PER_M, PLANCK};

/// `2 h c²`, W m² sr⁻¹.
const FIRST_RADIATION: f64 = 2.0 * PLANCK * LIGHT_SPEED * LIGHT_SPEED;

/// `h c / k`, m K.
const SECOND_RADIATION: f64 = PLANCK * LIGHT_SPEED / BOLTZMANN;

/// Positive nodes of the eight-point Gauss-Legendre rule on [-1, 1], with their weights.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Beyond this many units of `h c / (λ k T)` above the least of a band nothing adds to its mean.
const NEGLIGIBLE: f64 = 60.0;

/// Widest panel of the quadrature in units of `h c / (λ k T)`: the rule is then exact to 1e-15.
const PANEL: f64 = 1.5;

/// Planck's spectral radiance of a black body, W m⁻² sr⁻¹ nm⁻¹; 0 at 0 K.
///
/// - `wavelength_nm`: above 0
/// - `temperature_k`: 0 or above
///
/// Source: Planck's law with the constants of the SI (2019).
#[must_use]
pub fn planck(wavelength_nm: f64, temperature_k: f64) -> f64 {
    if temperature_k <= 0.0 {
        return 0.0;
    }
    let wavenumber = NM_PER_M / wavelength_nm;
    let x = SECOND_RADIATION * wavenumber / temperature_k;
    FIRST_RADIATION * wavenumber.powi(5) / x.exp_m1() / NM_PER_M
}

/// Mean of Planck's radiance over a band, W m⁻² sr⁻¹ nm⁻¹; at its centre where it has no width.
#[must_use]
pub fn planck_mean(band: &BandResponse, temperature_k: f64) -> f64 {
    mean_and_slope(band, temperature_k).0
}

/// Derivative of [`planck_mean`] by temperature, W m⁻² sr⁻¹ nm⁻¹ K⁻¹.
#[must_use]
pub fn planck_mean_slope(band: &BandResponse, temperature_k: f64) -> f64 {
    mean_and_slope(band, temperature_k).1
}

/// Temperature of the black body whose mean radiance over the band is `radiance`, K: the inverse of
/// [`planck_mean`].
///
/// 0 for a radiance of 0; NaN for one that is negative, infinite or not a number.
#[must_use]
pub fn brightness_temperature(band: &BandResponse, radiance: f64) -> f64 {
    if radiance == 0.0 {
        return 0.0;
    }
    if !(radiance > 0.0 && radiance.is_finite()) {
        return f64::NAN;
    }
    // ln L is nearly a straight line in 1 / T, and convex: Newton's steps go to the root from the
    // left and never beyond it.
    let wavenumber = NM_PER_M / band.center();
    let at_center = FIRST_RADIATION * wavenumber.powi(5) / (radiance * NM_PER_M);
    let mut inverse = at_center.ln_1p() / (SECOND_RADIATION * wavenumber);
    for _ in 0..100 {
        let (mean, slope) = mean_and_slope(band, inverse.recip());
        // d ln L / d(1/T) = -T² L' / L.
        let step = (mean / radiance).ln() * mean * inverse * inverse / slope;
        // Where everything underflows there is no step to trust.
        if !step.is_finite() {
            return f64::NAN;
        }
        let next = (inverse + step).max(0.5 * inverse);
        let is_close = (next - inverse).abs() <= 1e-15 * inverse;
        inverse = next;
        if is_close {
            break;
        }
    }
    inverse.recip()
}

/// Mean radiance over the band and its derivative by temperature.
fn mean_and_slope(band: &BandResponse, temperature: f64) -> (f64, f64) {
    if temperature <= 0.0 {
        return (0.0, 0.0);
    }
    match band {
        BandResponse::Window(window) => mean_of_window(*window, temperature),
        BandResponse::Curve(curve) => {
            let rule = curve.smooth_rule().iter();
            let (mean, slope) = rule.fold((0.0, 0.0), |(mean, slope), &(wavelength, weight)| {
                let radiance = weight * planck(wavelength, temperature);
                let x = SECOND_RADIATION / temperature * NM_PER_M / wavelength;
                (mean + radiance, slope + radiance * slope_factor(x))
            });
            (mean, slope / temperature)
        }
    }
}

/// Mean radiance over a window and its derivative by temperature.
fn mean_of_window(window: BandWindow, temperature: f64) -> (f64, f64) {
    let BandWindow { center, width } = window;
    let per_wavenumber = SECOND_RADIATION / temperature;
    if width <= 0.0 {
        let mean = planck(center, temperature);
        return (mean, mean * slope_factor(per_wavenumber * NM_PER_M / center) / temperature);
    }
    // In wavenumbers ν = 1/λ the integrand B dλ = c₁ ν³ / (exp(c₂ ν / T) - 1) dν is smooth.
    let low = NM_PER_M / (center + 0.5 * width);
    let high = NM_PER_M / (center - 0.5 * width);
    // 1/λ₁ - 1/λ₂ without the cancellation of a narrow band.
    let range = width / NM_PER_M * low * high;
    let range_used = range.min(NEGLIGIBLE / per_wavenumber);
    let panels = (range_used * per_wavenumber / PANEL).ceil().max(1.0);
    let half = 0.5 * range_used / panels;
    let (mut sum, mut slope) = (0.0, 0.0);
    for panel in 0..panels as u32 {
        let middle = low + half * f64::from(2 * panel + 1);
        for (node, weight) in GAUSS {
            for wavenumber in [middle - half * node, middle + half * node] {
                let x = per_wavenumber * wavenumber;
                let value = weight * wavenumber.powi(3) / x.exp_m1();
                sum += value;
                slope += value * slope_factor(x);
            }
        }
    }
    let scale = FIRST_RADIATION * half / width;
    (sum * scale, slope * scale / temperature)
}

/// `d ln B / d ln T = x / (1 - e⁻ˣ)`.
fn slope_factor(x: f64) -> f64 {
    -x / (-x).exp_m1()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn band(center: f64, width: f64) -> BandResponse {
        BandResponse::Window(BandWindow { center, width })
    }

    /// Numbers of an independent program, W m⁻² sr⁻¹ µm⁻¹.
    #[test]
    fn radiance_is_that_of_tables() {
        for (micrometres, kelvin, expected) in [
            (10.0, 300.0, 9.924_033_3),
            (10.0, 290.0, 8.400_687_4),
            (11.0, 300.0, 9.573_180_2),
            (12.0, 300.0, 8.961_372_3),
            (8.0, 300.0, 9.078_357_4),
            (4.0, 300.0, 0.721_976_42),
            (10.5, 273.15, 6.226_154),
        ] {
            let radiance = planck(micrometres * 1e3, kelvin) * 1e3;
            assert!((radiance / expected - 1.0).abs() < 1e-7, "{micrometres}: {radiance}");
        }
    }

    /// 8 to 14 µm at 300 K: 54.93346 W m⁻² sr⁻¹; all wavelengths: σ T⁴ / π.
    #[test]
    fn means_are_those_of_known_integrals() {
        let window = planck_mean(&band(11_000.0, 6_000.0), 300.0) * 6_000.0;
        assert!((window / 54.933_46 - 1.0).abs() < 1e-7, "{window}");
        // From 0.2 mm down to 100 nm; beyond 0.2 mm lie (15 / π⁴) x³ / 3 of all, less 3 x / 8 of that.
        let (low, high) = (100.0, 2e8);
        let all = planck_mean(&band(0.5 * (low + high), high - low), 300.0) * (high - low);
        let x = SECOND_RADIATION * NM_PER_M / high / 300.0;
        let beyond = 15.0 / std::f64::consts::PI.powi(4) * x.powi(3) * (1.0 - 0.375 * x) / 3.0;
        let expected = 5.670_374_419e-8 * 300_f64.powi(4) / std::f64::consts::PI * (1.0 - beyond);
        assert!((all / expected - 1.0).abs() < 1e-9, "{all} {expected}");
    }

    #[test]
    fn a_band_without_width_is_its_centre_and_narrow_ones_tend_to_it() {
        let center = planck(10_500.0, 290.0);
        assert!((planck_mean(&band(10_500.0, 0.0), 290.0) - center).abs() <= f64::EPSILON * center);
        for width in [1e-9, 1e-3, 1.0] {
            let mean = planck_mean(&band(10_500.0, width), 290.0);
            assert!((mean / center - 1.0).abs() < 1e-8, "{width}: {mean} {center}");
        }
    }

    #[test]
    fn cold_and_unlawful_values_are_told_apart() {
        let window = band(10_500.0, 1_000.0);
        assert_eq!(planck_mean(&window, 0.0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(brightness_temperature(&window, 0.0).to_bits(), 0.0_f64.to_bits());
        assert!(brightness_temperature(&window, -1.0).is_nan());
        assert!(brightness_temperature(&window, f64::NAN).is_nan());
        assert!(brightness_temperature(&window, f64::INFINITY).is_nan());
    }

    proptest! {
        #[test]
        fn brightness_temperature_inverts_the_mean(
            temperature in 60.0..3000.0_f64,
            center in 3_000.0..100_000.0_f64,
            width in prop_oneof![Just(0.0), 0.0..1.9_f64],
        ) {
            let window = band(center, center * width);
            let found = brightness_temperature(&window, planck_mean(&window, temperature));
            prop_assert!((found - temperature).abs() < 1e-9, "{found} {temperature}");
        }

        /// The slope is that of a central difference, whose own error is about 1e-7.
        #[test]
        fn the_slope_is_the_derivative(
            temperature in 100.0..1000.0_f64,
            center in 3_000.0..30_000.0_f64,
            width in 0.0..1.5_f64,
        ) {
            let window = band(center, center * width);
            let step = 1e-4 * temperature;
            let rise = planck_mean(&window, temperature + step) - planck_mean(&window, temperature - step);
            let slope = planck_mean_slope(&window, temperature);
            prop_assert!((rise / (2.0 * step) / slope - 1.0).abs() < 1e-5, "{rise} {slope}");
        }
    }
}
