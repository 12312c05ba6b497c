//! Leaf reflectance and transmittance from leaf chemistry: PROSPECT-D and PROSPECT-PRO.
//!
//! A leaf is a pile of `N` plates of refractive index `n(λ)` and absorption `k(λ)`, the first of
//! which is met within a cone of 40° around its normal, all others by diffuse light.
//!
//! Source: Jacquemoud & Baret (1990), Remote Sens. Environ. 34, 75–91 (plates and layers); Féret et
//! al. (2017), Remote Sens. Environ. 193, 204–215 (PROSPECT-D); Féret et al. (2021), Remote Sens.
//! Environ. 252, 112173 (PROSPECT-PRO). The table `prospect_pro.csv` of optical constants, 400 to
//! 2500 nm in steps of 1 nm, is that of the R package `prospect`, copyright (c) 2020-present
//! Jean-Baptiste Féret, MIT licence: see `NOTICE` beside it.

use std::sync::LazyLock;

/// First wavelength of the table, nm.
const FIRST_NM: usize = 400;

/// Largest angle of incidence on the first plate, degrees.
const FIRST_CONE_DEG: f64 = 40.0;

/// Depth of the continued fraction of E₁: at 1 it leaves 1e-16, further out far less.
const E1_DEPTH: u32 = 160;

/// Composition of a leaf.
///
/// PROSPECT-D has `dry_matter`, PROSPECT-PRO has `protein` and `carbon` in its place; all that is
/// given absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafChemistry {
    /// Leaf structure parameter N, number of plates, at least 1; 1 to 3 in real leaves.
    pub n: f64,
    /// Chlorophyll a + b, µg cm⁻².
    pub chlorophyll: f64,
    /// Carotenoids, µg cm⁻².
    pub carotenoid: f64,
    /// Anthocyanins, µg cm⁻².
    pub anthocyanin: f64,
    /// Brown pigments, arbitrary units.
    pub brown: f64,
    /// Equivalent water thickness, cm.
    pub water: f64,
    /// Dry matter, g cm⁻².
    pub dry_matter: f64,
    /// Proteins, g cm⁻².
    pub protein: f64,
    /// Carbon-based constituents other than proteins, g cm⁻².
    pub carbon: f64,
}

/// Reflectance and transmittance of a leaf, each as points (wavelength nm, value): whole nanometres from 400 to 2500.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafSpectrum {
    /// Directional-hemispherical reflectance, no unit.
    pub reflectance: Vec<(f64, f64)>,
    /// Directional-hemispherical transmittance, no unit.
    pub transmittance: Vec<(f64, f64)>,
}

/// A leaf that cannot be.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum ChemistryError {
    #[error("leaf structure n is {value}; write a number of at least 1, such as 1.5")]
    Structure { value: f64 },
    #[error("{what} is {value}; write a finite number, 0 or above")]
    Content { what: &'static str, value: f64 },
}

/// Optical constants at one wavelength.
struct Constants {
    refractive_index: f64,
    /// Specific absorption in the order of [`LeafChemistry::contents`], per its unit.
    absorption: [f64; 8],
}

static TABLE: LazyLock<Vec<Constants>> = LazyLock::new(|| {
    let number = |text: &str| match text {
        "" => 0.0,
        text => text.parse().expect("the table holds numbers only"),
    };
    let row = |line: &str| {
        let mut values = line.split(',').map(number);
        let refractive_index = values.next().unwrap_or_default();
        Constants { refractive_index, absorption: [(); 8].map(|()| values.next().unwrap_or(0.0)) }
    };
    include_str!("prospect_pro.csv").lines().skip(1).map(row).collect()
});

/// Reflectance and transmittance of a leaf in steps of 1 nm.
///
/// # Errors
/// A structure parameter below 1, or a content that is negative or not finite.
pub fn leaf_spectrum(leaf: &LeafChemistry) -> Result<LeafSpectrum, ChemistryError> {
    leaf_spectrum_at(leaf, |_| true)
}

/// Reflectance and transmittance of a leaf at those wavelengths, nm, that are needed, and at both ends.
///
/// # Errors
/// Those of [`leaf_spectrum`].
pub fn leaf_spectrum_at(
    leaf: &LeafChemistry,
    is_needed: impl Fn(f64) -> bool,
) -> Result<LeafSpectrum, ChemistryError> {
    let contents = leaf.contents();
    if !(leaf.n >= 1.0 && leaf.n.is_finite()) {
        return Err(ChemistryError::Structure { value: leaf.n });
    }
    if let Some(&(what, value)) = contents.iter().find(|(_, v)| !(*v >= 0.0 && v.is_finite())) {
        return Err(ChemistryError::Content { what, value });
    }
    let mut spectrum = LeafSpectrum { reflectance: Vec::new(), transmittance: Vec::new() };
    for (step, constants) in TABLE.iter().enumerate() {
        let wavelength = (FIRST_NM + step) as f64;
        let is_end = step == 0 || step + 1 == TABLE.len();
        if !(is_end || is_needed(wavelength)) {
            continue;
        }
        let absorbed = contents.iter().zip(constants.absorption).map(|(&(_, c), k)| c * k);
        let k = absorbed.sum::<f64>() / leaf.n;
        let (reflectance, transmittance) = plates(constants.refractive_index, k, leaf.n);
        spectrum.reflectance.push((wavelength, reflectance));
        spectrum.transmittance.push((wavelength, transmittance));
    }
    Ok(spectrum)
}

impl LeafChemistry {
    fn contents(&self) -> [(&'static str, f64); 8] {
        [
            ("chlorophyll", self.chlorophyll),
            ("carotenoid", self.carotenoid),
            ("anthocyanin", self.anthocyanin),
            ("brown", self.brown),
            ("water", self.water),
            ("dry matter", self.dry_matter),
            ("protein", self.protein),
            ("carbon", self.carbon),
        ]
    }
}

/// Reflectance and transmittance of `layers` plates of refractive index `n`, each of absorption `k`.
fn plates(n: f64, k: f64, layers: f64) -> (f64, f64) {
    // Transmission through the inside of a plate for diffuse light (Jacquemoud & Baret, eq. 15).
    let tau = if k == 0.0 { 1.0 } else { ((1.0 - k) * (-k).exp() + k * k * e1(k)).max(0.0) };

    // Interfaces: air to leaf within the cone and diffuse, leaf to air diffuse.
    let t_cone = interface(FIRST_CONE_DEG, n);
    let t_in = interface(90.0, n);
    let (r_cone, r_in) = (1.0 - t_cone, 1.0 - t_in);
    let t_out = t_in / (n * n);
    let r_out = 1.0 - t_out;

    // One plate, as the first and as any other.
    let bounces = 1.0 - (r_out * tau).powi(2);
    let t_first = t_cone * tau * t_out / bounces;
    let r_first = r_cone + r_out * tau * t_first;
    let t = t_in * tau * t_out / bounces;
    let r = r_in + r_out * tau * t;

    // The first plate over the pile of the other ones.
    let (r_rest, t_rest) = pile(r, t, layers - 1.0);
    let bounces = 1.0 - r_rest * r;
    (r_first + t_first * r_rest * t / bounces, t_first * t_rest / bounces)
}

/// Reflectance and transmittance of a pile of `count` plates, not necessarily a whole number.
///
/// Source: Stokes (1862), Proc. R. Soc. Lond. 11, 545–556, in powers of 1/b, which cannot overflow.
fn pile(r: f64, t: f64, count: f64) -> (f64, f64) {
    // Without absorption a and b are 1 and the formulas 0/0; this is their limit.
    if 1.0 - r - t <= 4.0 * f64::EPSILON {
        let t_pile = t / (t + (1.0 - t) * count);
        return (1.0 - t_pile, t_pile);
    }
    let root = ((1.0 + r + t) * (1.0 + r - t) * (1.0 - r + t) * (1.0 - r - t)).sqrt();
    let a = (1.0 + r * r - t * t + root) / (2.0 * r);
    let inverse_b = 2.0 * t / (1.0 - r * r + t * t + root);
    let q = inverse_b.powf(count);
    let determinant = a * a - q * q;
    (a * (1.0 - q * q) / determinant, q * (a * a - 1.0) / determinant)
}

/// Transmissivity of the boundary from air to a medium of refractive index `n`, the mean over both
/// polarisations and over isotropic light within `cone_deg` of the normal.
///
/// Source: Stern (1964), Appl. Opt. 3, 111–113; Allen (1973), J. Opt. Soc. Am. 63, 664–666.
fn interface(cone_deg: f64, n: f64) -> f64 {
    let (n2, sin2) = (n * n, cone_deg.to_radians().sin().powi(2));
    let (plus, minus) = (n2 + 1.0, n2 - 1.0);
    let a = 0.5 * (n + 1.0).powi(2);
    let k = -0.25 * minus * minus;
    let b2 = sin2 - 0.5 * plus;
    // For the whole hemisphere the root is 0, which rounding would miss.
    let b1 = if sin2 < 1.0 { (b2 * b2 + k).sqrt() } else { 0.0 };
    let b = b1 - b2;

    // Perpendicular, then parallel polarisation: integrals between a and b.
    let ts = |x: f64| k * k / (6.0 * x.powi(3)) + k / x - 0.5 * x;
    let scaled = |x: f64| 2.0 * plus * x - minus * minus;
    let tp = -2.0 * n2 * (b - a) / plus.powi(2) - 2.0 * n2 * plus * (b / a).ln() / minus.powi(2)
        + 0.5 * n2 * (1.0 / b - 1.0 / a)
        + 16.0 * n2.powi(2) * (n2.powi(2) + 1.0) * (scaled(b) / scaled(a)).ln()
            / (plus.powi(3) * minus.powi(2))
        + 16.0 * n2.powi(3) * (1.0 / scaled(b) - 1.0 / scaled(a)) / plus.powi(3);
    (ts(b) - ts(a) + tp) / (2.0 * sin2)
}

/// Exponential integral `E₁(x) = ∫ₓ^∞ e⁻ᵗ/t dt` for x > 0, to a few units of the last place.
///
/// Source: Abramowitz & Stegun (1964), 5.1.11 (series) and 5.1.22 (continued fraction).
fn e1(x: f64) -> f64 {
    if x <= 1.0 {
        let mut term = 1.0;
        let mut sum = -x.ln() - std::f64::consts::EULER_GAMMA;
        // At 1 the twentieth term is below 1e-19.
        for k in 1..=20 {
            let k = f64::from(k);
            term *= -x / k;
            sum -= term / k;
        }
        return sum;
    }
    // Evaluated backwards.
    let mut tail = x;
    for k in (1..=E1_DEPTH).rev() {
        let k = f64::from(k);
        tail = x + k / (1.0 + k / tail);
    }
    (-x).exp() / tail
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#[allow(clippy::float_cmp, reason = "table values and wavelengths are exact")]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const BARE: LeafChemistry = LeafChemistry {
        n: 1.0,
        chlorophyll: 0.0,
        carotenoid: 0.0,
        anthocyanin: 0.0,
        brown: 0.0,
        water: 0.0,
        dry_matter: 0.0,
        protein: 0.0,
        carbon: 0.0,
    };

    fn at(spectrum: &[(f64, f64)], wavelength: usize) -> f64 {
        let (at, value) = spectrum[wavelength - FIRST_NM];
        assert_eq!(at, wavelength as f64);
        value
    }

    #[test]
    fn the_table_is_whole() {
        assert_eq!(TABLE.len(), 2101);
        let columns = include_str!("prospect_pro.csv").lines().all(|l| l.split(',').count() == 9);
        assert!(columns);
        assert_eq!(TABLE[0].refractive_index, 1.5115);
        assert_eq!(TABLE[0].absorption[0], 6.48815e-2);
        assert_eq!(TABLE[2100].refractive_index, 1.2736);
        assert_eq!(TABLE[2100].absorption[7], 42.6366);
    }

    /// Numbers of the authors' own program.
    #[test]
    fn prospect_pro_gives_the_published_spectrum() {
        let leaf = LeafChemistry {
            n: 1.2,
            chlorophyll: 30.0,
            carotenoid: 10.0,
            anthocyanin: 1.0,
            water: 0.015,
            dry_matter: 0.009,
            protein: 0.001,
            carbon: 0.009,
            ..BARE
        };
        let LeafSpectrum { reflectance, transmittance } = leaf_spectrum(&leaf).unwrap();
        for (wavelength, r, t) in [
            (450, 0.041_067, 0.002_513),
            (550, 0.120_001, 0.183_620),
            (670, 0.036_717, 0.019_379),
            (800, 0.348_160, 0.489_116),
            (1240, 0.314_357, 0.473_502),
            (1650, 0.202_250, 0.374_442),
            (2200, 0.066_537, 0.184_474),
        ] {
            assert!((at(&reflectance, wavelength) - r).abs() <= 0.5e-6, "{wavelength}");
            assert!((at(&transmittance, wavelength) - t).abs() <= 0.5e-6, "{wavelength}");
        }
    }

    /// PROSPECT-5 had other pigments and another refractive index; at 2200 nm both agree.
    #[test]
    fn prospect_5_agrees_where_its_constants_were_kept() {
        let leaf = LeafChemistry {
            n: 2.1,
            chlorophyll: 40.0,
            carotenoid: 10.0,
            brown: 0.1,
            water: 0.015,
            dry_matter: 0.009,
            ..BARE
        };
        let LeafSpectrum { reflectance, transmittance } = leaf_spectrum(&leaf).unwrap();
        assert!((at(&reflectance, 2200) - 0.1780).abs() <= 0.5e-4);
        assert!((at(&transmittance, 2200) - 0.1604).abs() <= 0.5e-4);
    }

    #[test]
    fn e1_agrees_with_the_printed_tables() {
        for (x, exact) in [
            (0.01, 4.037_929_576_538_114),
            (0.5, 0.559_773_594_776_160_8),
            (1.0, 0.219_383_934_395_520_27),
            (1.000_000_1, 0.219_383_897_607_579_83),
            (2.0, 0.048_900_510_708_061_12),
            (10.0, 4.156_968_929_685_324e-6),
        ] {
            let error = (e1(x) / exact - 1.0).abs();
            assert!(error <= 8.0 * f64::EPSILON, "{x}: {} {error:e}", e1(x));
        }
    }

    /// Fresnel's formulas, averaged numerically over the cone.
    #[test]
    fn interfaces_transmit_the_mean_of_fresnels_formulas() {
        for n in [1.25, 1.35, 1.5] {
            for cone in [FIRST_CONE_DEG, 90.0_f64] {
                let steps = 200_000;
                // Isotropic light: uniform in sin².
                let largest = cone.to_radians().sin().powi(2);
                let mean = (0..steps).map(|step| {
                    let sin2 = largest * (f64::from(step) + 0.5) / f64::from(steps);
                    let (cos_i, cos_t) = ((1.0 - sin2).sqrt(), (1.0 - sin2 / (n * n)).sqrt());
                    let s = ((cos_i - n * cos_t) / (cos_i + n * cos_t)).powi(2);
                    let p = ((n * cos_i - cos_t) / (n * cos_i + cos_t)).powi(2);
                    1.0 - 0.5 * (s + p)
                });
                let mean = mean.sum::<f64>() / f64::from(steps);
                let exact = interface(cone, n);
                assert!((exact - mean).abs() < 1e-6, "{n} {cone}: {exact} {mean}");
            }
        }
    }

    #[test]
    fn a_leaf_of_nothing_absorbs_nothing() {
        for n in [1.0, 1.5, 3.0, 100.0] {
            let leaf = leaf_spectrum(&LeafChemistry { n, ..BARE }).unwrap();
            for ((_, r), (_, t)) in leaf.reflectance.iter().zip(&leaf.transmittance) {
                assert!((r + t - 1.0).abs() < 1e-12, "{n}: {r} {t}");
            }
        }
    }

    #[test]
    fn unlawful_leaves_are_errors() {
        for n in [0.99, -1.0, f64::NAN, f64::INFINITY] {
            let error = leaf_spectrum(&LeafChemistry { n, ..BARE }).unwrap_err();
            assert!(matches!(error, ChemistryError::Structure { .. }), "{error}");
        }
        let error = leaf_spectrum(&LeafChemistry { water: -1e-9, ..BARE }).unwrap_err();
        assert_eq!(error.to_string(), "water is -0.000000001; write a finite number, 0 or above");
        assert!(leaf_spectrum(&LeafChemistry { brown: f64::NAN, ..BARE }).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Whatever is in it, a leaf sends out light that it received, and no more.
        #[test]
        fn leaves_conserve_energy(
            n in 1.0..4.0_f64,
            contents in prop::array::uniform8(prop_oneof![Just(0.0), 1e-12..1e-3_f64, 0.0..1e3_f64, 1e3..1e12_f64]),
        ) {
            let [chlorophyll, carotenoid, anthocyanin, brown, water, dry_matter, protein, carbon] =
                contents;
            let leaf = leaf_spectrum(&LeafChemistry {
                n, chlorophyll, carotenoid, anthocyanin, brown, water, dry_matter, protein, carbon,
            }).unwrap();
            for ((_, r), (_, t)) in leaf.reflectance.iter().zip(&leaf.transmittance) {
                prop_assert!(*r > 0.0 && *t >= 0.0 && r + t <= 1.0 + 4.0 * f64::EPSILON, "{r} {t}");
            }
        }
    }

    #[test]
    fn wavelengths_that_are_needed_have_the_values_of_the_whole_spectrum() {
        let all = leaf_spectrum(&BARE).unwrap();
        let some = leaf_spectrum_at(&BARE, |nm| (700.0..=710.0).contains(&nm)).unwrap();
        let chosen = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
            let is_chosen = |nm: f64| nm == 400.0 || nm == 2500.0 || (700.0..=710.0).contains(&nm);
            points.iter().copied().filter(|(nm, _)| is_chosen(*nm)).collect()
        };
        assert_eq!(some.reflectance.len(), 13);
        assert_eq!(some.reflectance, chosen(&all.reflectance));
        assert_eq!(some.transmittance, chosen(&all.transmittance));
    }
}
