//! Legends: the meaning of the colours of a picture.

use crate::products::{Channels, Class, Image};

/// Legend of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Legend {
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
}

impl Legend {
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
