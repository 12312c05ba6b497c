use crate::counts::counted;
use std::path::{Path, PathBuf};

use super::super::AssetError;
use super::SpectrumFormat;

/// Error of a file of spectra, with advice.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum SpectrumProblem {
    #[error(
        "nothing in {format} says in which unit its wavelengths are; it begins {shown}; write `wavelength_unit: \
         Nanometres` beside `file`, or `Micrometres`, `Angstroms` or `Wavenumbers`"
    )]
    NoWavelengthUnit { format: SpectrumFormat, shown: String },
    #[error("is {format}, which holds its wavelengths; take `wavelengths: {other:?}` out")]
    NeedlessWavelengths { format: SpectrumFormat, other: PathBuf },
    #[error(
        "is a spectrum of the USGS library, whose wavelengths stand in a file of their own; write its name beside \
         `file`, `wavelengths: {example:?}`"
    )]
    NoWavelengths { example: String },
    #[error(
        "holds wavelengths of the USGS library; name a file of values as `file`, and this one as `wavelengths`"
    )]
    WavelengthsAlone,
    #[error(
        "holds {}, and {} {}; name those of the same spectrometer",
        counted(.values, "value"),
        .other.display(),
        counted(.wavelengths, "wavelength")
    )]
    UnlikeLengths { values: usize, wavelengths: usize, other: PathBuf },
    #[error(
        "is an ENVI spectral library of {count} spectra; write the one that is meant, `value: {example:?}`; it holds {names}"
    )]
    ManySpectra { count: usize, example: String, names: String },
    #[error(
        "has no spectrum {name:?}; if {nearest:?} is meant, write `value: {nearest:?}`; it holds {names}"
    )]
    UnknownSpectrum { name: String, nearest: String, names: String },
    #[error("is an ENVI spectral library whose header {header:?} {problem}")]
    Library { header: String, problem: String },
    #[error("is {format}; it has no column {name:?}: take `{key}` out")]
    NoColumns { format: SpectrumFormat, name: String, key: &'static str },
    #[error(
        "is a file of an ASD spectrometer that {problem}; export the reflectance as text with ViewSpec Pro, and name \
         that file"
    )]
    Asd { problem: String },
    #[error(
        "has {found} bytes, and its header says {needed}; it is cut off, or its header is wrong"
    )]
    CutOff { found: u64, needed: u64 },
}

impl SpectrumProblem {
    /// The error about a file.
    pub(super) fn of(self, file: &Path) -> AssetError {
        AssetError::Spectrum { file: file.to_owned(), problem: self }
    }
}

/// Names of spectra for a message, which may be many.
pub(super) fn list(names: &[String]) -> String {
    const MOST: usize = 20;
    let shown = names.iter().take(MOST).map(|name| format!("{name:?}"));
    let more = names.len().saturating_sub(MOST);
    let more = (more > 0).then(|| format!("{more} more"));
    shown.chain(more).collect::<Vec<_>>().join(", ")
}
