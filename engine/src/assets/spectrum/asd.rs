//! Binary files of ASD spectrometers, versions 1 to 8.
//!
//! The spectrum of the target starts at byte 484; since version 2 that of the white reference follows it, and the
//! reflectance is their ratio. Source: ASD Inc., "Indico version 8 file format", table of the spectrum file header.

use std::path::Path;

use super::super::AssetError;
use super::super::text;
use super::points::PointList;
use super::{SpectrumColumns, SpectrumFormat, SpectrumProblem, SpectrumTable};
use crate::document::{ValueUnit, WavelengthUnit};

/// Bytes of the header.
const HEADER: usize = 484;

/// Bytes of the flag and the two times between the spectrum and the description of the reference.
const REFERENCE_HEADER: usize = 18;

/// Largest file, bytes: spectra have some thousands of channels of 8 bytes.
const LARGEST: u64 = 64 << 20;

/// Kind of the values that a file shows.
const REFLECTANCE: u8 = 1;
const TRANSMITTANCE: u8 = 6;
const KINDS: [&str; 9] = [
    "raw counts",
    "reflectances",
    "radiances",
    "values without unit",
    "irradiances",
    "a quality index",
    "transmittances",
    "values of an unknown kind",
    "absorbances",
];

/// Returns whether a file begins as those of ASD do.
pub(super) fn is_asd(head: &[u8]) -> bool {
    let version = head.get(..3).unwrap_or_default();
    let is_version = version == b"ASD"
        || (version.starts_with(b"as")
            && version.get(2).is_some_and(|c| (b'2'..=b'8').contains(c)));
    is_version && head.len() >= HEADER && head[..HEADER].contains(&0)
}

/// A file as bytes, read at places that may be behind its end.
struct Bytes<'a> {
    file: &'a Path,
    bytes: Vec<u8>,
}

impl Bytes<'_> {
    fn at<const N: usize>(&self, place: usize) -> Result<[u8; N], AssetError> {
        let bytes = self.bytes.get(place..place + N).and_then(|bytes| bytes.try_into().ok());
        bytes.ok_or_else(|| {
            let (found, needed) = (self.bytes.len() as u64, (place + N) as u64);
            SpectrumProblem::CutOff { found, needed }.of(self.file)
        })
    }

    fn real(&self, place: usize) -> Result<f64, AssetError> {
        Ok(f64::from(f32::from_le_bytes(self.at(place)?)))
    }

    /// Numbers of a spectrum.
    fn spectrum(&self, place: usize, channels: usize, kind: u8) -> Result<Vec<f64>, AssetError> {
        let number = |channel: usize| match kind {
            0 => self.real(place + 4 * channel),
            1 => Ok(f64::from(i32::from_le_bytes(self.at(place + 4 * channel)?))),
            _ => Ok(f64::from_le_bytes(self.at(place + 8 * channel)?)),
        };
        (0..channels).map(number).collect()
    }
}

/// Reads the reflectance or transmittance of a file.
pub(super) fn read(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let format = SpectrumFormat::Asd;
    for (asked, key) in [(columns.wavelength, "wavelength"), (columns.value, "value")] {
        if let Some(name) = asked {
            return Err(SpectrumProblem::NoColumns { format, name: name.to_owned(), key }.of(path));
        }
    }
    let bytes = text::size(path)?;
    if bytes > LARGEST {
        return Err(AssetError::TooLarge { file: path.to_owned(), bytes, most: LARGEST });
    }
    let bytes = Bytes { file: path, bytes: text::read(path)? };
    let wrong = |problem: String| SpectrumProblem::Asd { problem }.of(path);
    let [shown] = bytes.at(186)?;
    if ![REFLECTANCE, TRANSMITTANCE].contains(&shown) {
        let kind = KINDS.get(usize::from(shown)).unwrap_or(&KINDS[7]);
        return Err(wrong(format!("holds {kind}")));
    }
    let [kind] = bytes.at(199)?;
    let size = match kind {
        0 | 1 => 4,
        2 => 8,
        _ => return Err(wrong("does not say of which type its numbers are".to_owned())),
    };
    let channels = usize::from(u16::from_le_bytes(bytes.at(204)?));
    let mut values = bytes.spectrum(HEADER, channels, kind)?;
    if !bytes.bytes.starts_with(b"ASD") {
        let reference = HEADER + channels * size;
        if i16::from_le_bytes(bytes.at(reference)?) == 0 {
            return Err(wrong("holds no white reference".to_owned()));
        }
        let described = reference + REFERENCE_HEADER;
        let length = usize::from(u16::from_le_bytes(bytes.at(described)?));
        let white = bytes.spectrum(described + 2 + length, channels, kind)?;
        for (value, white) in values.iter_mut().zip(white) {
            *value = if white == 0.0 { f64::NAN } else { *value / white };
        }
    }
    let (first, step) = (bytes.real(191)?, bytes.real(195)?);
    let mut points = PointList::new(path, WavelengthUnit::Nanometres, false);
    for (channel, value) in values.into_iter().enumerate() {
        points.push(first + step * channel as f64, value, channel + 1)?;
    }
    Ok(SpectrumTable {
        format,
        points: points.finish()?,
        value: if shown == REFLECTANCE { "reflectance" } else { "transmittance" }.to_owned(),
        others: Vec::new(),
        unit: Some(ValueUnit::Fraction),
    })
}
