//! All that repeats a run.

use std::path::PathBuf;

/// Scene of a run as it was resolved, and what a run needs beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// The scene with the sensors that measured, as one line of RON.
    pub scene: String,
    /// Folder that paths in the scene are relative to.
    pub folder: PathBuf,
    /// Files that the run read.
    pub files: Vec<InputFile>,
    /// Factor on the numbers of samples.
    pub quality: f64,
    /// True if the run kept coefficients: its sums are made in another order.
    pub keeps_coefficients: bool,
    /// True if other scenes were measured on the same paths, so that a run alone has the same values but for rounding.
    pub is_joint: bool,
}

/// A file that a run read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// Path, relative to the folder of the scene if it is in there.
    pub path: PathBuf,
    /// Hash of what it holds (BLAKE3), hexadecimal.
    pub hash: String,
}
