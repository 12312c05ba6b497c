//! Spectra that decided the paths of a run, which others may take the place of.

use std::io::{self, Read, Write};

use super::{Bsdf, SpectrumId, SurfaceModels};

/// Spectra that paths were chosen and ended by, in the representative bands of the run that traced them. A run keeps them
/// with its coefficients: they tell which other spectra the same paths can measure.
#[derive(Clone, Debug, PartialEq)]
pub struct PathSpectra {
    /// Numbers of the spectra of each surface.
    surfaces: Vec<[u32; 3]>,
    /// Values of each spectrum of the table, shape `[spectra, representative bands]`; no values of those that multiply no
    /// path.
    rows: Vec<Vec<f32>>,
}

/// Reason for which paths cannot measure other spectra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathMisfit {
    /// Other surfaces or other light.
    OtherSurfaces,
    /// A surface scatters light, or a source gives some, that was zero in all bands: no path followed it.
    NewLight,
}

/// Values below this fraction of a spectrum's largest one differ by nothing that counts.
const NEGLIGIBLE: f32 = 0.01;

impl PathSpectra {
    /// Spectra of these models; `None` if some surface is not diffuse.
    #[must_use]
    pub fn new(models: &SurfaceModels) -> Option<Self> {
        let spectra = &models.spectra;
        let row = |number: u32| {
            let id = SpectrumId::from_number(number);
            let values = spectra.representatives(id);
            let bands = spectra.representative_bands().bands().len();
            if spectra.is_factor(id) { values[..bands].to_vec() } else { Vec::new() }
        };
        Some(Self {
            surfaces: surfaces(models)?,
            rows: (0..spectra.count() as u32).map(row).collect(),
        })
    }

    /// Reason for which paths of these spectra cannot measure those of some models.
    #[must_use]
    pub fn misfit(&self, models: &SurfaceModels) -> Option<PathMisfit> {
        let spectra = &models.spectra;
        if surfaces(models).as_ref() != Some(&self.surfaces) || spectra.count() != self.rows.len() {
            return Some(PathMisfit::OtherSurfaces);
        }
        let is_new = |(number, row): (u32, &Vec<f32>)| {
            let id = SpectrumId::from_number(number);
            spectra.is_factor(id) && largest(row) == 0.0 && !spectra.is_zero(id)
        };
        (0..).zip(&self.rows).any(is_new).then_some(PathMisfit::NewLight)
    }

    /// Largest ratio of a band of some models, in any spectrum, to the band of the run that is most like it; with the
    /// band. Paths end too early for bands that are much brighter than all of the run.
    #[must_use]
    pub fn brightest(&self, models: &SurfaceModels) -> Option<(usize, f32)> {
        let factors = || (0..).zip(&self.rows).filter(|(_, row)| largest(row) > 0.0);
        let bands = factors().next()?.1.len();
        let ratio = |band: usize| {
            let to_band_of_run = |of_run: usize| {
                let ratios = factors().map(|(number, row)| {
                    let least = NEGLIGIBLE * largest(row);
                    let value = models.spectra.lanes(SpectrumId::from_number(number))[band];
                    value.max(least) / row[of_run].max(least)
                });
                ratios.fold(0.0, f32::max)
            };
            (0..bands).map(to_band_of_run).fold(f32::INFINITY, f32::min)
        };
        let all = (0..models.spectra.bands()).map(|band| (band, ratio(band)));
        all.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Writes them.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut number = |number: u32| out.write_all(&number.to_le_bytes());
        number(self.surfaces.len() as u32)?;
        self.surfaces.iter().flatten().try_for_each(|&spectrum| number(spectrum))?;
        number(self.rows.len() as u32)?;
        for row in &self.rows {
            number(row.len() as u32)?;
            row.iter().try_for_each(|value| number(value.to_bits()))?;
        }
        Ok(())
    }

    /// Reads what [`Self::save`] wrote.
    ///
    /// # Errors
    /// Errors of the reader.
    pub fn restore(input: &mut dyn Read) -> io::Result<Self> {
        let mut number = || {
            let mut bytes = [0; 4];
            input.read_exact(&mut bytes).map(|()| u32::from_le_bytes(bytes))
        };
        let mut surfaces = Vec::new();
        for _ in 0..number()? {
            surfaces.push([number()?, number()?, number()?]);
        }
        let mut rows = Vec::new();
        for _ in 0..number()? {
            let mut row = Vec::new();
            for _ in 0..number()? {
                row.push(f32::from_bits(number()?));
            }
            rows.push(row);
        }
        Ok(Self { surfaces, rows })
    }
}

/// Numbers of the spectra of each surface; `None` if some surface is not diffuse.
fn surfaces(models: &SurfaceModels) -> Option<Vec<[u32; 3]>> {
    let spectra = |bsdf: &Bsdf| match bsdf {
        Bsdf::BiLambertian(model) => Some(model.scattering_spectra().map(SpectrumId::number)),
        Bsdf::GlossyLeaf(_) | Bsdf::Rpv(_) | Bsdf::Soilspect(_) | Bsdf::Mapped(_) => None,
    };
    models.bsdfs.iter().map(spectra).collect()
}

fn largest(row: &[f32]) -> f32 {
    row.iter().copied().fold(0.0, f32::max)
}
