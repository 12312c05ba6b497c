//! Lengths and places for messages.

use glam::DVec2;

/// A length, m, rounded to whole millimetres, without the digits that sums and differences of coordinates of
/// a map leave behind.
#[must_use]
pub fn millimetres(length: f64) -> f64 {
    // The sum makes 0 of -0.
    (1e3 * length).round() / 1e3 + 0.0
}

/// A place for a message, `(432110.5, 5412310)`.
#[must_use]
pub fn place_text(place: DVec2) -> String {
    format!("({}, {})", millimetres(place.x), millimetres(place.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_written_without_the_noise_of_differences() {
        let place = DVec2::new(432_140.91 - 432_100.0, 5_412_302.52 - 5_412_300.0);
        assert_eq!(place_text(place), "(40.91, 2.52)");
        assert_eq!(place_text(DVec2::new(-2e-17, 15.630_000_000_004_657)), "(0, 15.63)");
        assert_eq!(place_text(DVec2::new(432_110.5, 5_412_310.0)), "(432110.5, 5412310)");
    }
}
