//! The ground.

use std::borrow::Cow;

use super::super::decode::{Decode, Reader, Variant, example_of_keys};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;

choice! {
    /// The ground.
    pub enum Terrain ("a terrain") {
        /// Horizontal rectangle.
        Plane {
            /// Extent to the east and to the north, m.
            size_m: (f64, f64) => "(100.0, 100.0)",
            /// Material.
            material: String => r#""soil""#,
            /// South-west corner, m.
            corner_m: (f64, f64) = (0.0, 0.0),
            /// Height, m.
            height_m: f64 = 0.0,
        },
    }
}

choice! {
    /// What lies beyond the terrain's rectangle.
    pub enum Boundary ("a boundary") {
        /// The same scene again, without end.
        Periodic,
        /// Nothing.
        Isolated,
    }
}
