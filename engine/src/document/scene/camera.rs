//! How images are taken.

use std::borrow::Cow;

use super::super::decode::{Decode, Reader, Variant};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;

choice! {
    /// What an orthographic image covers where it is no rectangle of its own.
    pub enum Cover ("what an image covers") {
        /// All that stands on the terrain's rectangle, from whichever side.
        WholeScene,
    }
}

choice! {
    /// Where a fisheye camera looks.
    pub enum Look ("where a camera looks") {
        /// Straight up; north is at the top of the image and east on its left, as in a photograph.
        Up,
        /// Straight down; north is at the top of the image.
        Down,
        /// In a direction.
        Towards {
            /// Angle of the view from the upward vertical, degrees: 90 is the horizon.
            zenith_deg: f64 => "90.0",
            /// Where the camera looks, clockwise from north, degrees.
            azimuth_deg: f64 = 0.0,
        },
        /// At a point.
        Target {
            /// The point, m.
            at_m: (f64, f64, f64) => "(0.0, 0.0, 0.0)",
        },
    }
}

choice! {
    /// How angles off the axis become distances from the middle of a fisheye image.
    pub enum FisheyeProjection ("a fisheye projection") {
        /// As sin(θ/2): equal areas of the image are equal solid angles.
        Equisolid,
        /// As θ.
        Equidistant,
        /// As sin θ: equal areas of the image are equal shares of the irradiance.
        Orthographic,
        /// As tan(θ/2): circles stay circles.
        Stereographic,
    }
}

choice! {
    /// How the PNG of an image is coloured. The numbers are in the other files.
    pub enum Picture ("a picture") {
        /// For a first look: bands chosen by wavelength, each stretched.
        Quicklook,
        /// Three bands.
        Bands {
            /// Band that is shown as red.
            red: String => "\"nir\"",
            /// Band that is shown as green.
            green: String => "\"red\"",
            /// Band that is shown as blue.
            blue: String => "\"green\"",
            /// Stops over the exposure that shows a white surface on the horizontal as white;
            /// automatic if absent.
            exposure_stops: Option<f64> = None,
        },
        /// What a person would see in daylight, from ten bands or more between 380 and 780 nm.
        Cie {
            /// Stops over the exposure that shows a white surface on the horizontal as white;
            /// automatic if absent.
            exposure_stops: Option<f64> = None,
        },
    }
}
