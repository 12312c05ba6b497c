//! Numbers to places on a drawing.

use std::ops::Range;

/// Mapping from numbers to pixels along an axis.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    values: Range<f64>,
    pixels: Range<f64>,
    is_log: bool,
}

/// A number on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) text: String,
}

impl Scale {
    /// - `values`: finite and not empty
    /// - `is_log`: whether equal ratios are equally long; all values are positive then
    pub(super) const fn new(values: Range<f64>, pixels: Range<f64>, is_log: bool) -> Self {
        Self { values, pixels, is_log }
    }

    /// Place of a number, px.
    pub(super) fn at(&self, value: f64) -> f64 {
        let Range { start, end } = self.values;
        let fraction = if self.is_log {
            (value / start).ln() / (end / start).ln()
        } else {
            (value - start) / (end - start)
        };
        self.pixels.start + fraction * (self.pixels.end - self.pixels.start)
    }

    /// Round numbers along the axis, about `most` of them.
    pub(super) fn ticks(&self, most: usize) -> Vec<Tick> {
        let Range { start, end } = self.values;
        if self.is_log {
            return log_ticks(start, end, most);
        }
        let step = round_step((end - start) / most.max(1) as f64);
        let first = (start / step).ceil() as i64;
        let last = (end / step).floor() as i64;
        let tick = |number: i64| {
            let at = number as f64 * step;
            Tick { at, text: label(at, step) }
        };
        (first..=last).map(tick).collect()
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below a step.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= least * 0.999_999);
    factor.unwrap_or(10.0) * power
}

fn log_ticks(start: f64, end: f64, most: usize) -> Vec<Tick> {
    for factors in [&[1.0, 1.5, 2.0, 3.0, 5.0, 7.0][..], &[1.0, 2.0, 5.0], &[1.0]] {
        let powers = start.log10().floor() as i32..=end.log10().ceil() as i32;
        let all = powers.flat_map(|power| factors.iter().map(move |one| one * 10_f64.powi(power)));
        let inside: Vec<f64> = all.filter(|at| (start..=end).contains(at)).collect();
        if inside.len() <= most || factors.len() == 1 {
            let tick = |at| Tick { at, text: label(at, at / 10.0) };
            return inside.into_iter().map(tick).collect();
        }
    }
    Vec::new()
}

/// A number with as many decimals as its distance to the next one needs.
fn label(value: f64, step: f64) -> String {
    let size = value.abs().max(step);
    if !(1e-4..1e6).contains(&size) {
        // The least number of digits that tell neighbours apart.
        let digits = (size.log10().floor() - step.log10().floor()).max(0.0) as usize;
        let text = format!("{value:.digits$e}");
        return if value == 0.0 { "0".to_owned() } else { text.replace('-', "−") };
    }
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches('-').chars().all(|letter| matches!(letter, '0' | '.')) {
        return "0".to_owned();
    }
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: Range<f64>, is_log: bool, most: usize) -> Vec<String> {
        let scale = Scale::new(range, 0.0..100.0, is_log);
        scale.ticks(most).into_iter().map(|tick| tick.text).collect()
    }

    #[test]
    fn ticks_are_round_and_told_apart() {
        assert_eq!(texts(-0.04..0.43, false, 5), ["0", "0.1", "0.2", "0.3", "0.4"]);
        assert_eq!(
            texts(311.61..311.66, false, 5),
            ["311.61", "311.62", "311.63", "311.64", "311.65", "311.66"]
        );
        assert_eq!(texts(-75.0..75.0, false, 6), ["−50", "0", "50"]);
        assert_eq!(texts(400.0..12_000.0, true, 5), ["500", "1000", "2000", "5000", "10000"]);
        assert_eq!(texts(0.0..3e-9, false, 3), ["0", "1e−9", "2e−9", "3e−9"]);
    }

    #[test]
    fn ends_are_at_the_ends() {
        let scale = Scale::new(10.0..1000.0, 0.0..100.0, true);
        assert!((scale.at(100.0) - 50.0).abs() < 1e-9);
        let scale = Scale::new(1.0..3.0, 100.0..0.0, false);
        assert!((scale.at(1.0) - 100.0).abs() < 1e-9 && (scale.at(3.0)).abs() < 1e-9);
    }
}
