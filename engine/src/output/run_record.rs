//! Bands of a run as its `summary.json` holds them.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use serde::Deserialize;

use super::manifest::SUMMARY;
use crate::spectral::{BandResponse, ResponseRecord};

/// Bands, light and responses of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// Names of the bands.
    pub bands: Vec<String>,
    /// Centre wavelengths, nm, shape `[bands]`.
    pub wavelengths_nm: Vec<f64>,
    /// Irradiance on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`; empty if the file does not say it.
    pub irradiance: Vec<f64>,
    /// Responses, shape `[bands]`; empty if the file does not say them.
    pub responses: Vec<BandResponse>,
}

#[derive(Deserialize)]
struct Record {
    bands: Vec<String>,
    wavelengths_nm: Vec<f64>,
    #[serde(default)]
    irradiance: Vec<f64>,
    #[serde(default)]
    responses: Vec<ResponseRecord>,
}

impl RunRecord {
    /// Reads the record of the run whose results are in a folder; `None` if there is none.
    #[must_use]
    pub fn read(folder: &Path) -> Option<Self> {
        let path = folder.join(SUMMARY);
        // Opening a pipe would wait for its writer.
        fs::metadata(&path).ok().filter(fs::Metadata::is_file)?;
        let record: Record =
            serde_json::from_reader(BufReader::new(File::open(path).ok()?)).ok()?;
        let responses = record.responses.into_iter().map(BandResponse::try_from);
        Some(Self {
            bands: record.bands,
            wavelengths_nm: record.wavelengths_nm,
            irradiance: record.irradiance,
            responses: responses.collect::<Result<_, _>>().ok()?,
        })
    }
}
