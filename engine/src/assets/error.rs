use crate::counts::{counted, existing};
use std::io;
use std::path::PathBuf;

use super::crown::CrownError;
use super::crs::TargetSystem;
use super::gltf::GltfError;
use super::ply::PlyError;
use super::raster::RasterError;
use super::spectrum::SpectrumProblem;

/// Error of a file that a scene cannot use: the file, the line where it has lines, and advice.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum AssetError {
    #[error("{}: cannot be read: {cause}", .file.display())]
    Unreadable { file: PathBuf, cause: io::Error },
    #[error("{}: is a directory or a device; name a file", .file.display())]
    NotAFile { file: PathBuf },
    #[error(
        "{}:{line}: is not UTF-8 text ({guess}); save the file as UTF-8 text",
        .file.display()
    )]
    NotText { file: PathBuf, line: usize, guess: &'static str },
    #[error("{}: is {found}, and `{reader}` reads {wanted}; {remedy}", .file.display())]
    OtherFormat {
        file: PathBuf,
        found: String,
        reader: &'static str,
        wanted: &'static str,
        remedy: String,
    },
    #[error("{}:{line}: is longer than {most} bytes; this is no text table or OBJ file", .file.display())]
    LineTooLong { file: PathBuf, line: usize, most: usize },
    #[error("{}:{line}: {what} is {found:?}; write a finite number such as 1.5 or 2e-3", .file.display())]
    BadNumber { file: PathBuf, line: usize, what: String, found: String },
    #[error("{}:{line}: {what} is {found:?}; {advice}", .file.display())]
    OddNumber { file: PathBuf, line: usize, what: String, found: String, advice: String },
    #[error("{}:{line}: {what} is {value}; write a number above 0", .file.display())]
    NotPositive { file: PathBuf, line: usize, what: String, value: f64 },
    #[error(
        "{}:{line}: coordinate {value:e} m is too large to keep; check the file and the length of \
         its unit",
        .file.display()
    )]
    TooFar { file: PathBuf, line: usize, value: f64 },
    #[error("{}: holds more than {most} {what}; split it into several files", .file.display())]
    TooMany { file: PathBuf, what: &'static str, most: usize },
    #[error("{}: the unit's length is {unit_m} m; write a finite number above 0", .file.display())]
    BadUnit { file: PathBuf, unit_m: f64 },
    #[error(
        "{}: holds no face that has an area; a mesh needs lines such as `v 0 0 0` and `f 1 2 3`, \
         or triangles",
        .file.display()
    )]
    NoFaces { file: PathBuf },

    #[error("{}:{line}: this vertex has {found} coordinates; write three: `v x y z`", .file.display())]
    ShortVertex { file: PathBuf, line: usize, found: usize },
    #[error("{}:{line}: this face has {found} corners; write at least three", .file.display())]
    ShortFace { file: PathBuf, line: usize, found: usize },
    #[error(
        "{}:{line}: this face has {found} corners, more than {most}; split it into triangles",
        .file.display()
    )]
    LongFace { file: PathBuf, line: usize, found: usize, most: usize },
    #[error(
        "{}:{line}: the outline of this face crosses itself too often; split it into triangles",
        .file.display()
    )]
    TangledFace { file: PathBuf, line: usize },
    #[error(
        "{}:{line}: {found:?} is no corner; write a vertex index as 7, 7/1, 7//3, 7/1/3 or -1",
        .file.display()
    )]
    BadCorner { file: PathBuf, line: usize, found: String },
    #[error(
        "{}:{line}: corner {index} names no vertex, and there {} above it; count from 1 at the first, \
         or from -1 backwards",
        .file.display(),
        existing(.count, "vertex")
    )]
    NoSuchVertex { file: PathBuf, line: usize, index: i64, count: usize },

    #[error("{}: holds no rows", .file.display())]
    NoRows { file: PathBuf },
    #[error("{}:{line}: has no header above it; write the names of its columns there: {wanted}", .file.display())]
    NoHeader { file: PathBuf, line: usize, wanted: String },
    #[error("{}:{line}: there is no column {column:?}; write {nearest:?} or one of {known:?}", .file.display())]
    UnknownColumn {
        file: PathBuf,
        line: usize,
        column: String,
        nearest: String,
        known: Vec<String>,
    },
    #[error("{}:{line}: column {column:?} is missing among {found:?}; add it", .file.display())]
    MissingColumn { file: PathBuf, line: usize, column: String, found: Vec<String> },
    #[error("{}:{line}: {problem}; {help}", .file.display())]
    NoStemPlaces { file: PathBuf, line: usize, problem: String, help: String },
    #[error(
        "{}:{line}: the header calls a column {own:?} which `columns` in the scene calls {given:?}; take \
         `columns` out, or write its names in the order of the file",
        .file.display()
    )]
    ContradictedColumn { file: PathBuf, line: usize, own: String, given: String },
    #[error("{}:{line}: columns {first:?} and {second:?} say the same; keep one", .file.display())]
    RepeatedColumn { file: PathBuf, line: usize, first: String, second: String },
    #[error(
        "{}:{line}: has {} for {}{advice}",
        .file.display(),
        counted(.found, "value"),
        counted(.wanted, "column")
    )]
    WrongFieldCount {
        file: PathBuf,
        line: usize,
        found: usize,
        wanted: usize,
        advice: &'static str,
    },
    #[error("{}:{line}: the normal is zero; write a direction", .file.display())]
    ZeroNormal { file: PathBuf, line: usize },
    #[error(
        "{}:{line}: wavelength {wavelength} follows {previous}; sort the rows by wavelength, \
         each once",
        .file.display()
    )]
    WavelengthOrder { file: PathBuf, line: usize, previous: f64, wavelength: f64 },
    #[error(
        "{}:{line}: there is no column {column:?} among {found:?}; if {nearest:?} is meant, write \
         `{key}: {nearest:?}` in the scene; titles may stand above a header, not in its place",
        .file.display()
    )]
    NoSuchColumn {
        file: PathBuf,
        line: usize,
        column: String,
        found: Vec<String>,
        key: &'static str,
        nearest: String,
    },
    #[error("{}: {problem}", .file.display())]
    Spectrum { file: PathBuf, problem: SpectrumProblem },
    #[error(
        "{}:{line}: a wavelength of {written} ({}`{unit}`) is no light; write the `wavelength_unit` of the \
         table in the scene: `Nanometres`, `Micrometres`, `Angstroms` or `Wavenumbers`",
        .file.display(), if *.is_unit_given { "" } else { "taken as " }
    )]
    NoLight { file: PathBuf, line: usize, written: f64, unit: &'static str, is_unit_given: bool },
    #[error("{}: holds one wavelength; a spectrum needs two or more", .file.display())]
    ShortSpectrum { file: PathBuf },

    #[error("{}: has {bytes} bytes, more than {most}; split it into several files", .file.display())]
    TooLarge { file: PathBuf, bytes: u64, most: u64 },
    #[error("{}: is no GeoJSON: {reason}", .file.display())]
    NotGeoJson { file: PathBuf, reason: String },
    #[error("{}: holds a {found}, which has no area; keep its polygons only", .file.display())]
    NoArea { file: PathBuf, found: &'static str },
    #[error("{}: holds no polygon", .file.display())]
    NoPolygon { file: PathBuf },
    #[error(
        "{}: ring {ring} of the file has {found} different corners; three or more enclose an area",
        .file.display()
    )]
    ShortRing { file: PathBuf, ring: usize, found: usize },
    #[error("{}:{line}: this hole has no outline before it; write the outline first", .file.display())]
    HoleOfNothing { file: PathBuf, line: usize },
    #[error(
        "{}: is in degrees (from {x:.5}, {y:.5}), but a scene is in metres; convert it to a projected \
         system: `ogr2ogr -t_srs EPSG:{} metres.geojson {}` ({}), or `Export > Save Features As` in QGIS",
        .file.display(), .target.code, .file.display(), .target.reason
    )]
    InDegrees { file: PathBuf, x: f64, y: f64, target: TargetSystem },
    #[error(
        "{}: is in {what} ({system}), but a scene is in metres on the ground; convert it: `ogr2ogr \
         -t_srs EPSG:{} metres.geojson {}` ({})",
        .file.display(), .target.code, .file.display(), .target.reason
    )]
    NotInMetres { file: PathBuf, what: String, system: String, target: TargetSystem },

    #[error("{}: {problem}", .file.display())]
    Ply { file: PathBuf, problem: PlyError },
    #[error("{}: {problem}", .file.display())]
    Gltf { file: PathBuf, problem: GltfError },
    #[error("{}: {problem}", .file.display())]
    Raster { file: PathBuf, problem: RasterError },
    #[error("face {face} has no area; its corners must not lie on a line")]
    FlatFace { face: usize },
    #[error("the outline of face {face} crosses itself too often; split it into triangles")]
    CrossedFace { face: usize },
    #[error("a corner of face {face} lies too far away to keep")]
    FarFace { face: usize },
    #[error(transparent)]
    Crown(#[from] CrownError),
}

impl AssetError {
    /// The error of a text that is no number, with what to write instead if that is known.
    pub(super) fn bad_number(
        file: PathBuf,
        line: usize,
        what: String,
        text: &str,
        advice: Option<String>,
    ) -> Self {
        let found = excerpt(text);
        match advice {
            Some(advice) => Self::OddNumber { file, line, what, found, advice },
            None => Self::BadNumber { file, line, what, found },
        }
    }
}

/// The beginning of a text that may be long, for a message.
pub(super) fn excerpt(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
