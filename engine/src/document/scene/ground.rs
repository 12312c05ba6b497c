//! The ground and what stands on it.

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

choice! {
    /// Instances of mesh prototypes.
    pub enum Instances ("instances") {
        /// Places from a text table.
        Table {
            /// Path, relative to the scene file.
            file: String => r#""stand.csv""#,
            /// Mesh that stands there.
            of: String => r#""tree""#,
            /// Names of the columns where the file has no header: `x_m`, `y_m`, `z_m`, `yaw_deg`
            /// or `yaw_rad`, `tilt_deg`, `tilt_azimuth_deg`, `scale`, `scale_vertical`.
            columns: Option<Vec<String>> = None,
        },
        /// Places written here.
        List {
            /// Mesh that stands there.
            of: String => r#""tree""#,
            /// Positions, m.
            at_m: Vec<(f64, f64, f64)> => "[(20.0, 30.0, 0.0)]",
            /// Turn of each (counter-clockwise seen from above), degrees; none if empty.
            yaw_deg: Vec<f64> = Vec::new(),
            /// Scale of each; 1 if empty.
            scale: Vec<f64> = Vec::new(),
        },
    }
}

/// Columns that a table of instances may have.
pub const INSTANCE_COLUMNS: [&str; 9] = [
    "x_m",
    "y_m",
    "z_m",
    "yaw_deg",
    "yaw_rad",
    "tilt_deg",
    "tilt_azimuth_deg",
    "scale",
    "scale_vertical",
];
