//! Numbers and titles on axes.

/// A number on an axis, with at most four digits.
#[must_use]
pub fn tick(value: f64) -> String {
    let size = value.abs();
    if size < 1e-30 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.2e}");
    }
    let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    if digits == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// `zenith_deg` as `zenith (°)`.
#[must_use]
pub fn axis_title(name: &str) -> String {
    let (name, unit) = match name.rsplit_once('_') {
        Some((name, "deg")) => (name, "°"),
        Some((name, "k")) => (name, "K"),
        Some((name, "m2")) => (name, "m²"),
        Some((name, unit @ ("m" | "nm" | "s" | "sr"))) => (name, unit),
        _ => return name.replace('_', " "),
    };
    format!("{} ({unit})", name.replace('_', " "))
}

/// Smallest range that holds all numbers, and some room about them.
#[must_use]
pub fn range_of(values: impl IntoIterator<Item = f64>) -> std::ops::Range<f64> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let room = match 0.07 * (high - low) {
        room if room > 1e-9 * high.abs() => room,
        _ if high == 0.0 => 0.5,
        _ => 0.1 * high.abs(),
    };
    low - room..high + room
}

/// Ratio of the largest values of lines from which on the smaller one is not legible on the axis of the larger one.
const UNLIKE: f64 = 4.0;

/// Returns whether values are so unlike in size that they need axes of their own.
///
/// - `peaks`: largest absolute value of each line; those of lines without values, or of 0 alone, do not count
#[must_use]
pub fn are_unlike(peaks: impl IntoIterator<Item = f64>) -> bool {
    let known = peaks.into_iter().filter(|peak| peak.is_finite() && *peak > 0.0);
    let (low, high) =
        known.fold((f64::INFINITY, 0.0_f64), |(low, high), peak| (low.min(peak), high.max(peak)));
    high > UNLIKE * low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 0.31, 0.012_345, 1234.56, 3.0e-5, 300.0, -2.5, 1e6].map(tick);
        assert_eq!(texts, ["0", "0.31", "0.01235", "1235", "3.00e-5", "300", "-2.5", "1.00e6"]);
    }

    #[test]
    fn units_stand_behind_names() {
        assert_eq!(axis_title("zenith_deg"), "zenith (°)");
        assert_eq!(axis_title("relative_azimuth_deg"), "relative azimuth (°)");
        assert_eq!(axis_title("soil_k"), "soil (K)");
        assert_eq!(axis_title("band"), "band");
    }

    #[test]
    fn bands_of_a_tenth_need_an_axis_of_their_own() {
        assert!(are_unlike([0.4, 0.04]) && !are_unlike([0.4, 0.11]));
        assert!(!are_unlike([0.4, 0.0, f64::NAN]) && !are_unlike([]));
    }
}
