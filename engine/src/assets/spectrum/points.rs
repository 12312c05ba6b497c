//! Points of a spectrum in the order of a file, and checks of their wavelengths.

use std::path::Path;

use super::super::AssetError;
use super::SpectrumPoint;
use crate::document::WavelengthUnit;
use crate::spectral::{LONGEST_NM, SHORTEST_NM};

/// Points that a reader has found so far.
pub(super) struct PointList<'a> {
    file: &'a Path,
    unit: WavelengthUnit,
    is_unit_given: bool,
    points: Vec<SpectrumPoint>,
    is_rising: bool,
    /// Wavelength before the next, in the file's unit.
    before: f64,
}

impl<'a> PointList<'a> {
    /// List of points whose wavelengths are in a unit, which the scene may have given.
    pub(super) fn new(file: &'a Path, unit: WavelengthUnit, is_unit_given: bool) -> Self {
        Self { file, unit, is_unit_given, points: Vec::new(), is_rising: true, before: f64::NAN }
    }

    /// Adds a point: its wavelength as it is written, and its line.
    pub(super) fn push(&mut self, written: f64, value: f64, line: usize) -> Result<(), AssetError> {
        let file = || self.file.to_owned();
        if written <= 0.0 {
            let what = "the wavelength".to_owned();
            return Err(AssetError::NotPositive { file: file(), line, what, value: written });
        }
        let wavelength = self.unit.nanometres(written);
        if let Some(&SpectrumPoint { wavelength: previous, .. }) = self.points.last() {
            if self.points.len() == 1 {
                self.is_rising = wavelength > previous;
            }
            let is_in_order =
                if self.is_rising { wavelength > previous } else { wavelength < previous };
            if !is_in_order {
                let (previous, wavelength) = (self.before, written);
                return Err(AssetError::WavelengthOrder {
                    file: file(),
                    line,
                    previous,
                    wavelength,
                });
            }
        }
        if !(SHORTEST_NM..=LONGEST_NM).contains(&wavelength) {
            let (file, unit, is_unit_given) = (file(), self.unit.name(), self.is_unit_given);
            return Err(AssetError::NoLight { file, line, written, unit, is_unit_given });
        }
        self.before = written;
        self.points.push(SpectrumPoint { wavelength, value, line });
        Ok(())
    }

    /// All points in order of wavelength.
    pub(super) fn finish(mut self) -> Result<Vec<SpectrumPoint>, AssetError> {
        match self.points.len() {
            0 => return Err(AssetError::NoRows { file: self.file.to_owned() }),
            1 => return Err(AssetError::ShortSpectrum { file: self.file.to_owned() }),
            _ => {}
        }
        if !self.is_rising {
            self.points.reverse();
        }
        Ok(self.points)
    }
}
