//! Legends: the meaning of the colours of a picture.

use super::scale::tick;
use crate::products::{Channels, Class, Image};

/// Legend of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PictureLegend {
    /// Meaning of its colours.
    pub(super) entries: Entries,
    /// Names of bands that are dark in every pixel and not shown.
    pub(super) dark: Vec<String>,
    /// Colour and meaning of the value 0, if it has a colour of its own.
    pub(super) zero: Option<Class>,
}

/// Meaning of the colours of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Entries {
    /// Values of bands, each a ramp.
    Bars(Vec<Bar>),
    /// Classes, and how pixels come by their colours.
    Classes(Vec<Class>, &'static str),
    /// Lines of text.
    Text(Vec<String>),
}

/// A band that is shown as a ramp from black to the colour of its channels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bar {
    /// Name of the band.
    pub(super) name: String,
    /// Centre wavelength of the band, nm, if it is known.
    pub(super) wavelength: Option<f64>,
    /// True for each of red, green and blue that shows the band.
    pub(super) channels: [bool; 3],
    /// Values that are black and of full brightness.
    pub(super) low: f32,
    pub(super) high: f32,
    /// True where values lie below `low`, and above `high`: they have the colours of the ends.
    pub(super) is_clipped: [bool; 2],
}

impl Bar {
    /// Texts of its ends and its middle: `≤ 0.02`, `0.165`, `≥ 0.31` where values lie beyond the ends.
    pub(super) fn numbers(&self) -> [String; 3] {
        let [low, middle, high] =
            [self.low, 0.5 * (self.low + self.high), self.high].map(|value| tick(value.into()));
        let end = |is_clipped, sign: char, text: String| {
            if is_clipped { format!("{sign} {text}") } else { text }
        };
        [end(self.is_clipped[0], '≤', low), middle, end(self.is_clipped[1], '≥', high)]
    }
}

/// The one bar of several that have the same range: grey, as it stands for all of their colours. `None` of a single bar,
/// and where ranges differ.
pub(super) fn common_bar(bars: &[Bar]) -> Option<Bar> {
    let (first, others) = bars.split_first().filter(|(_, others)| !others.is_empty())?;
    let is_alike = |bar: &Bar| (bar.low, bar.high) == (first.low, first.high);
    others.iter().all(is_alike).then(|| Bar {
        channels: [true; 3],
        is_clipped: [0, 1].map(|end| bars.iter().any(|bar| bar.is_clipped[end])),
        ..first.clone()
    })
}

impl PictureLegend {
    pub(super) fn classes(classes: &[Class], how: &'static str) -> Self {
        Self { entries: Entries::Classes(classes.to_vec(), how), dark: Vec::new(), zero: None }
    }

    /// Legend of a picture that shows a white surface in full brightness at a gain of 1.
    pub(super) fn exposed(image: &Image, channels: Channels, gain: f64) -> Self {
        let what = match channels {
            Channels::Bands(bands) => {
                let name = |band: usize| image.bands.get(band).map_or("", String::as_str);
                let [r, g, b] = bands.map(name);
                format!("red: {r}, green: {g}, blue: {b}")
            }
            Channels::Cie => "natural colours (CIE 1931, sRGB)".to_owned(),
        };
        let exposure = format!("exposure {:+.1} stops over white", gain.log2());
        Self { entries: Entries::Text(vec![what, exposure]), dark: Vec::new(), zero: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(low: f32, is_clipped: [bool; 2]) -> Bar {
        let (name, channels) = (String::new(), [true, false, false]);
        Bar { name, wavelength: None, channels, low, high: 0.5, is_clipped }
    }

    #[test]
    fn ends_beyond_which_values_lie_say_so() {
        assert_eq!(bar(0.1, [false, true]).numbers(), ["0.1", "0.3", "≥ 0.5"]);
        assert_eq!(bar(0.1, [true, false]).numbers(), ["≤ 0.1", "0.3", "0.5"]);
    }

    #[test]
    fn bars_of_one_range_are_one() {
        let one = bar(0.1, [false, true]);
        let common = common_bar(&[one.clone(), bar(0.1, [true, false])]).expect("one range");
        assert_eq!((common.is_clipped, common.channels), ([true; 2], [true; 3]));
        assert_eq!(common_bar(&[one.clone(), bar(0.2, [false; 2])]), None);
        assert_eq!(common_bar(&[one]), None);
    }
}
