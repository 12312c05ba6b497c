//! The eye: spectra of surfaces in daylight to colours of a screen.

/// Linear sRGB of a reflectance factor of 1 in each band, lit by D65; all bands together are white.
///
/// Spectra are straight between the bands' centres, and constant beyond the outermost. Only bands
/// from 380 to 780 nm count.
#[must_use]
pub fn daylight(wavelengths: &[f64]) -> Vec<[f64; 3]> {
    let mut order: Vec<usize> =
        (0..wavelengths.len()).filter(|&i| (380.0..=780.0).contains(&wavelengths[i])).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let mut tristimulus = vec![[0.0; 3]; wavelengths.len()];
    let (Some(&shortest), Some(&longest)) = (order.first(), order.last()) else {
        return tristimulus;
    };
    for step in 0..=80 {
        let wavelength = 380.0 + 5.0 * f64::from(step);
        let light = matching(wavelength).map(|value| value * d65(wavelength));
        let mut add = |band: usize, share: f64| {
            for (sum, value) in tristimulus[band].iter_mut().zip(light) {
                *sum += share * value;
            }
        };
        let next = order.partition_point(|&band| wavelengths[band] <= wavelength);
        if next == 0 {
            add(shortest, 1.0);
        } else if next == order.len() {
            add(longest, 1.0);
        } else {
            let (below, above) = (order[next - 1], order[next]);
            let (low, high) = (wavelengths[below], wavelengths[above]);
            let share = (wavelength - low) / (high - low);
            add(below, 1.0 - share);
            add(above, share);
        }
    }
    // The fit's white is that of D65 to 1 %: the rest is taken out.
    let sum = |axis: usize| tristimulus.iter().map(|xyz| xyz[axis]).sum::<f64>();
    let scale = [0, 1, 2].map(|axis| WHITE[axis] / sum(axis));
    tristimulus
        .iter()
        .map(|xyz| {
            let [x, y, z] = [0, 1, 2].map(|axis| xyz[axis] * scale[axis]);
            SRGB_FROM_XYZ.map(|row| row[0] * x + row[1] * y + row[2] * z)
        })
        .collect()
}

/// Tristimulus values of D65 with Y = 1.
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];

/// Linear sRGB from CIE XYZ. Source: IEC 61966-2-1, its primaries inverted.
const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// sRGB from its linear form. Source: IEC 61966-2-1.
#[must_use]
pub fn transfer(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Colour matching functions x̄, ȳ, z̄ of the CIE 1931 standard observer (2°), at a wavelength in nm.
///
/// Source: Wyman, Sloan and Shirley (2013), J. Comput. Graph. Tech. 2(2), 1-11: the fit of several
/// lobes.
fn matching(wavelength: f64) -> [f64; 3] {
    let lobe = |middle: f64, below: f64, above: f64| {
        let t = (wavelength - middle) / if wavelength < middle { below } else { above };
        (-0.5 * t * t).exp()
    };
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7)
            - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

/// Relative power of the standard illuminant D65 at a wavelength from 380 to 780 nm.
///
/// Source: CIE 15:2004, table T.1, every 10 nm.
fn d65(wavelength: f64) -> f64 {
    const TABLE: [f64; 41] = [
        49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
        115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342,
        95.788, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778,
        78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054,
        63.3828,
    ];
    let place = ((wavelength - 380.0) / 10.0).clamp(0.0, 40.0);
    let low = (place as usize).min(39);
    let share = place - low as f64;
    TABLE[low] * (1.0 - share) + TABLE[low + 1] * share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_observer_sees_d65_where_the_standard_has_it() {
        let mut xyz = [0.0; 3];
        for step in 0..=80 {
            let wavelength = 380.0 + 5.0 * f64::from(step);
            for (sum, value) in xyz.iter_mut().zip(matching(wavelength)) {
                *sum += value * d65(wavelength);
            }
        }
        let sum: f64 = xyz.iter().sum();
        // CIE 15:2004: x = 0.31272, y = 0.32903. The fit's authors state errors of about 1 %.
        assert!((xyz[0] / sum / 0.312_72 - 1.0).abs() < 0.01, "{xyz:?}");
        assert!((xyz[1] / sum / 0.329_03 - 1.0).abs() < 0.01, "{xyz:?}");
    }
}
