/// The largest `f32` that is not above `value`.
#[must_use]
pub fn round_down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value { nearest.next_down() } else { nearest }
}

/// The smallest `f32` that is not below `value`.
#[must_use]
pub fn round_up(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outward_rounding_brackets_the_value() {
        for value in [0.1, -0.1, 1.0, 1e30, -1e-30, 5_500_000.3] {
            let (low, high) = (round_down(value), round_up(value));
            assert!(f64::from(low) <= value && value <= f64::from(high));
            assert!(low.to_bits().abs_diff(high.to_bits()) <= 1);
        }
        assert!(round_up(f64::INFINITY).is_infinite());
    }
}
