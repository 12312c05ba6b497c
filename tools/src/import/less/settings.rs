//! Settings that may be absent: their defaults, the values that they may have, choices by name.

use anyhow::Result;

use super::conf::Node;
use super::report::Report;
use super::text;

/// A number of a project.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// Value where the project has none: that of a new project or of LESS's window.
    default: f64,
    /// Description of the values that it may have.
    expected: &'static str,
    is_valid: fn(f64) -> bool,
}

impl Rule {
    const fn new(default: f64, expected: &'static str, is_valid: fn(f64) -> bool) -> Self {
        Self { default, expected, is_valid }
    }

    pub(super) const SUN_ZENITH: Self =
        Self::new(45.0, "an angle from 0 to below 90°", |v| (0.0..90.0).contains(&v));
    pub(super) const SUN_AZIMUTH: Self = Self::new(90.0, AZIMUTH, is_azimuth);
    pub(super) const VIEW_ZENITH: Self =
        Self::new(0.0, "an angle from 0 to below 90°", |v| (0.0..90.0).contains(&v));
    pub(super) const VIEW_AZIMUTH: Self = Self::new(180.0, AZIMUTH, is_azimuth);
    pub(super) const FOV_X: Self = Self::new(40.0, FOV, is_fov);
    pub(super) const FOV_Y: Self = Self::new(30.0, FOV, is_fov);
    pub(super) const PIXELS: Self =
        Self::new(100.0, "a whole number from 1 to 65536", |v| is_whole(v, 1.0, 65536.0));
    pub(super) const SAMPLES: Self =
        Self::new(128.0, "a whole number from 1 to 16777216", |v| is_whole(v, 1.0, 16_777_216.0));
    pub(super) const EXTENT: Self =
        Self::new(100.0, "a length above 0 and up to 10000000 m", |v| v > 0.0 && v <= 1e7);
    pub(super) const RESOLUTION: Self =
        Self::new(0.02, "a length from 0.000001 to 10000 m", |v| (1e-6..=1e4).contains(&v));
    pub(super) const CELLS: Self =
        Self::new(150.0, "a whole number from 4 to 100000", |v| is_whole(v, 4.0, 100_000.0));
    pub(super) const SHARE: Self = Self::new(0.0, "between 0 and 1", |v| (0.0..=1.0).contains(&v));
    pub(super) const ROULETTE_ORDER: Self =
        Self::new(5.0, "a whole number from 0 on", |v| is_whole(v, 0.0, f64::from(u32::MAX)));

    /// A coordinate, m; it may have any value.
    pub(super) const fn coordinate(default: f64) -> Self {
        Self::new(default, "a number of metres", |v| v.abs() <= 1e9)
    }

    /// A full angle of view of at most `is_valid`'s limit.
    pub(super) const fn fisheye(expected: &'static str, is_valid: fn(f64) -> bool) -> Self {
        Self::new(165.0, expected, is_valid)
    }

    /// The number of a key, or the default, which the report then names.
    pub(super) fn read(&self, parent: &Node, key: &str, report: &Report) -> Result<f64> {
        let Some(node) = parent.get(key) else {
            let what = format!("{}, as LESS has it", self.default);
            report.assumed(&parent.path_of(key), parent.lack_of(key), what);
            return Ok(self.default);
        };
        let number = node.number()?;
        match self.fault(number) {
            Some(fault) => Err(node.wrong(&fault)),
            None => Ok(number),
        }
    }

    /// The reason why a number is not valid.
    pub(super) fn fault(&self, number: f64) -> Option<String> {
        (!(self.is_valid)(number)).then(|| format!("{number} is not {}", self.expected))
    }
}

const AZIMUTH: &str = "an angle from -360 to 360°";
const FOV: &str = "an angle above 0 and below 180°";

fn is_azimuth(value: f64) -> bool {
    (-360.0..=360.0).contains(&value)
}

fn is_fov(value: f64) -> bool {
    value > 0.0 && value < 180.0
}

fn is_whole(value: f64, least: f64, most: f64) -> bool {
    value.fract() == 0.0 && (least..=most).contains(&value)
}

/// A choice by name, in any case of letters.
pub(super) struct Choice<'a, T> {
    /// Names and values; the first is the default.
    pub(super) choices: &'a [(&'a str, T)],
    /// True if real projects lack the key, so that its absence needs no remark.
    pub(super) may_be_absent: bool,
}

impl<T: Copy> Choice<'_, T> {
    /// The value of a key; the default, with a remark, where the key has no value or an unknown one.
    pub(super) fn read(&self, parent: &Node, key: &str, report: &Report) -> Result<T> {
        let (usual, default) = self.choices[0];
        let Some(node) = parent.get(key) else {
            if !self.may_be_absent {
                let what = format!("{usual}, as LESS has it");
                report.assumed(&parent.path_of(key), parent.lack_of(key), what);
            }
            return Ok(default);
        };
        let name = node.text()?;
        if let Some((_, value)) =
            self.choices.iter().find(|(known, _)| known.eq_ignore_ascii_case(&name))
        {
            return Ok(*value);
        }
        let known: Vec<_> = self.choices.iter().map(|(known, _)| *known).collect();
        let what = format!("not one of {}: taken as {usual}", known.join(", "));
        report.differs(&node.path, &text::excerpt(&name), what);
        Ok(default)
    }
}
