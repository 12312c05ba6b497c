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
        assert_eq!(axis_title("band"), "band");
    }
}
