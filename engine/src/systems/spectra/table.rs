//! Means over bands of spectra from tables, and checks of such tables.

use std::path::Path;

use super::file::read_columns;
use super::{STRONG, SpectrumQuantity, band_mean, warn_wide_bands};
use crate::assets::{SpectrumPoint, SpectrumTable};
use crate::counts::agreeing;
use crate::document::{Diagnostic, ScenePath, TabulatedSpectrum, ValueUnit, WavelengthUnit};
use crate::spectral::BandResponse;
use crate::systems::Resources;

/// Reflectances that noise and white references make may lie this far above 1 or below 0.
const NOISE: f64 = 0.05;

/// A value further below 0 than this is a mark for no data, not noise.
const MARK: f64 = -0.5;

/// Values beyond this, in the file's unit, are implausible too.
const HUGE: f64 = 1e5;

/// Wavelengths, nm, where the water vapour of the air absorbs so much that spectra of the field are
/// noise there, and where spectrometers end.
const NOISY_NM: [(f64, f64); 4] =
    [(0.0, 400.0), (1330.0, 1470.0), (1770.0, 2000.0), (2350.0, f64::INFINITY)];

/// Largest reflectance of a table, below which fractions were taken for percent: no leaf, soil or bark is so dark.
const SMALL: f64 = 0.01;

/// Step between wavelengths, nm, over which spectra of leaves and soils are no straight lines.
const WIDE_GAP_NM: f64 = 50.0;

/// A band and its response.
#[derive(Clone, Copy)]
struct SeenBand<'b> {
    name: &'b str,
    response: &'b BandResponse,
}

/// A table of which the scene asks for means over bands.
struct Values<'a> {
    table: &'a SpectrumTable,
    /// Values of its points in the unit of the scene.
    scaled: Vec<f64>,
    file: &'a str,
    path: ScenePath,
}

/// Mean in each band of a spectrum that a table holds.
pub(super) fn table_means(
    spectrum: &TabulatedSpectrum,
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    let TabulatedSpectrum { source, unit, scale } = spectrum;
    let path = path.key("file");
    let table = read_columns(source, &path, resources)?;
    let is_fraction = quantity.is_fraction();
    // A scale that the scene gives is that of the values as they stand.
    let of_file = table.unit.filter(|_| is_fraction && *scale >= 1.0);
    let percent = if unit.or(of_file) == Some(ValueUnit::Percent) { 0.01 } else { 1.0 };
    if !is_fraction && unit.is_some() {
        let message = "`unit` is that of reflectances and transmittances, and this is a radiance \
                           or an irradiance";
        let help = "write `scale`, the factor that makes its values W m⁻² nm⁻¹";
        return Err(Box::new(Diagnostic::error(path, message).help(help)));
    }
    let values = table.points.iter().map(|point| point.value * scale * percent).collect();
    let values = Values { table: &table, scaled: values, file: &source.file, path };
    let mut warnings = Vec::new();
    values.warn_other_columns(&mut warnings);
    if is_fraction {
        values.warn_small(&mut warnings);
        values.check_scale()?;
        values.warn_noise(&mut warnings);
    } else if quantity == SpectrumQuantity::Irradiance {
        values.warn_strong(&mut warnings);
    }
    let bands = resources.bands.iter().zip(resources.responses.all());
    let means = bands.map(|(band, response)| {
        let band = SeenBand { name: &band.name, response };
        values.check_band(band, is_fraction, &mut warnings)?;
        let mean = values.mean(band, |points| band_mean(response, points, quantity, resources));
        let mean =
            mean.map_err(|_outside| Box::new(values.outside(band, source.wavelength_unit)))?;
        Ok(if is_fraction { values.within_bounds(mean, band, &mut warnings) } else { mean })
    });
    let means = means.collect::<Result<Vec<f64>, Box<Diagnostic>>>();
    if is_fraction {
        let points: Vec<_> = values.points().collect();
        warn_wide_bands(&points, &values.path, resources);
    }
    for warning in warnings {
        resources.messages.report_once(warning);
    }
    means
}

impl Values<'_> {
    /// Wavelengths, nm, and values in the unit of the scene, without marks for no data.
    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let indices = (0..self.scaled.len()).filter(|&index| !self.is_mark(index));
        indices.map(|index| (self.table.points[index].wavelength, self.scaled[index]))
    }

    fn is_mark(&self, index: usize) -> bool {
        let written = self.table.points[index].value;
        !written.is_finite() || written.abs() >= HUGE || self.scaled[index] < MARK
    }

    /// Place of a value in its file, and the value.
    fn place(&self, index: usize) -> String {
        let SpectrumPoint { line, .. } = self.table.points[index];
        let file = Path::new(self.file).display();
        let (value, shown) = (&self.table.value, self.shown(index));
        if self.table.format.has_lines() {
            format!("{file}:{line}: column {value:?} is {shown}")
        } else {
            format!("{file}: channel {line} of {value:?} is {shown}")
        }
    }

    /// A value as the file has it.
    fn shown(&self, index: usize) -> String {
        let written = self.table.points[index].value;
        match written {
            _ if written.is_nan() => "empty".to_owned(),
            _ if written.abs() >= 1e7 => format!("{written:e}"),
            _ => format!("{written}"),
        }
    }

    fn error(&self, message: String, help: String) -> Diagnostic {
        Diagnostic::error(&self.path, message).help(help)
    }

    /// Points that are no marks and of which this holds.
    fn find(&self, is_meant: impl Fn(usize, f64) -> bool) -> Vec<usize> {
        let is_meant = |&index: &usize| !self.is_mark(index) && is_meant(index, self.scaled[index]);
        (0..self.scaled.len()).filter(is_meant).collect()
    }

    fn is_noisy(&self, index: usize) -> bool {
        let wavelength = self.table.points[index].wavelength;
        NOISY_NM.iter().any(|&(low, high)| (low..=high).contains(&wavelength))
    }

    /// Refuses a table whose values cannot be fractions, wherever the bands lie.
    fn check_scale(&self) -> Result<(), Box<Diagnostic>> {
        let high = self.find(|_, value| value > 1.0 + NOISE);
        let is_noise = high.iter().all(|&index| self.is_noisy(index));
        if is_noise && 2 * high.len() <= self.scaled.len() {
            return Ok(());
        }
        let Some(&largest) =
            high.iter().max_by(|&&a, &&b| self.scaled[a].total_cmp(&self.scaled[b]))
        else {
            return Ok(());
        };
        let message = format!(
            "{}{}, but a reflectance or transmittance is a fraction from 0 to 1",
            self.place(largest),
            match high.len() {
                1 => String::new(),
                more =>
                    format!(", and {} more {} above 1", more - 1, agreeing(more - 1, "is", "are")),
            }
        );
        let help = match self.scaled[largest] {
            value if value <= 110.0 => {
                "if the table is in percent, write `unit: Percent` beside `file`; if this is a fault of \
                 the measurement, take the row out"
            }
            value if value <= 1100.0 => {
                "if the table holds thousandths, write `scale: 0.001` beside `file`"
            }
            _ => "if the table holds fractions times 10000, write `scale: 0.0001` beside `file`",
        };
        Err(Box::new(self.error(message, help.to_owned())))
    }

    /// Warns of values that are a little outside what is possible.
    fn warn_noise(&self, warnings: &mut Vec<Diagnostic>) {
        let odd = self.find(|_, value| !(0.0..=1.0).contains(&value));
        let excess = |&&index: &&usize| (self.scaled[index] - 0.5).abs();
        let worst = odd.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)));
        if let Some(&worst) = worst {
            let others = match odd.len() {
                1 => String::new(),
                more => {
                    let lie = agreeing(more - 1, "lies", "lie");
                    format!(", and {} more {lie} outside 0 to 1", more - 1)
                }
            };
            let message = format!("{}{others}: taken for noise", self.place(worst));
            let help = "a mean over a band is kept within 0 to 1; if it is none, correct the table or \
                        write its `unit` or `scale`";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
    }

    /// Warns of a table of several columns of which the scene names none.
    fn warn_other_columns(&self, warnings: &mut Vec<Diagnostic>) {
        if self.table.others.is_empty() {
            return;
        }
        let others: Vec<_> = self.table.others.iter().map(|name| format!("{name:?}")).collect();
        let message = format!(
            "{}: the values are taken from the column {:?}, and there are {} too",
            self.file,
            self.table.value,
            others.join(", ")
        );
        let help = format!("write the one that is meant, such as `value: {:?}`", self.table.value);
        warnings.push(Diagnostic::warning(&self.path, message).help(help));
    }

    /// Warns of fractions that a unit or a scale makes so small that they were fractions before.
    fn warn_small(&self, warnings: &mut Vec<Diagnostic>) {
        let all = self.find(|_, _| true);
        let largest = all.iter().max_by(|&&a, &&b| self.scaled[a].total_cmp(&self.scaled[b]));
        let Some(&largest) = largest else { return };
        let (written, scaled) = (self.table.points[largest].value, self.scaled[largest]);
        if written <= 1.0 && scaled < SMALL && scaled < 0.5 * written {
            let message =
                format!("{}, its largest value, and is taken as {scaled:.3e}", self.place(largest));
            let help = "if the table holds fractions, write `unit: Fraction` and leave `scale` out";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
    }

    /// Warns of a band between rows that lie far apart: what is between them is not known.
    fn warn_gap(&self, band: SeenBand<'_>, warnings: &mut Vec<Diagnostic>) {
        let points = &self.table.points;
        let mut steps: Vec<f64> =
            points.windows(2).map(|pair| pair[1].wavelength - pair[0].wavelength).collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps[steps.len() / 2];
        let used = &points[self.used(band)];
        let widest = used
            .windows(2)
            .map(|pair| (pair[0].wavelength, pair[1].wavelength))
            .max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
        if let Some((from, to)) = widest
            && to - from > WIDE_GAP_NM
            && to - from > 5.0 * usual
        {
            let message = format!(
                "{}: no value between {from} and {to} nm, and band `{}` is made of a straight line between them",
                self.file, band.name
            );
            let help = "take a table that covers the band, or move the band";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
    }

    fn warn_strong(&self, warnings: &mut Vec<Diagnostic>) {
        let strong = self.find(|_, value| value > STRONG);
        let largest = strong.iter().max_by(|&&a, &&b| self.scaled[a].total_cmp(&self.scaled[b]));
        if let Some(&largest) = largest {
            let message = format!(
                "{}: the sun has at most 2.2 W m⁻² nm⁻¹ outside the atmosphere",
                self.place(largest)
            );
            let help = "if the table is in W m⁻² µm⁻¹ or mW m⁻² nm⁻¹, write `scale: 0.001` beside \
                        `file`; results that are ratios do not depend on it";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
    }

    /// Points that the mean over a band is made of.
    fn used(&self, band: SeenBand<'_>) -> std::ops::Range<usize> {
        let (low, high) = band.response.range();
        let points = &self.table.points;
        let from = points.partition_point(|point| point.wavelength <= low).saturating_sub(1);
        let to = points.partition_point(|point| point.wavelength < high);
        from..(to + 1).min(points.len()).max(from + 1)
    }

    /// Refuses a band that needs values which the table does not have.
    fn check_band(
        &self,
        band: SeenBand<'_>,
        is_fraction: bool,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(), Box<Diagnostic>> {
        for index in self.used(band) {
            let wavelength = self.table.points[index].wavelength;
            let needed = format!("band `{}` needs a value at {wavelength} nm", band.name);
            if self.is_mark(index) {
                return Err(Box::new(self.error(
                    format!("{}, a no-data mark, and {needed}", self.place(index)),
                    "take the row out, so that a straight line joins its neighbours, or move the band"
                        .to_owned(),
                )));
            }
            let value = self.scaled[index];
            if is_fraction && !(-NOISE..=1.0 + NOISE).contains(&value) {
                return Err(Box::new(self.error(
                    format!("{}, which is no reflectance, and {needed}", self.place(index)),
                    "correct the row or take it out, or move the band".to_owned(),
                )));
            }
        }
        if is_fraction {
            self.warn_zeros(band, warnings);
            self.warn_gap(band, warnings);
        }
        Ok(())
    }

    /// Warns of zeros between values that are far from it: deleted channels, mostly.
    fn warn_zeros(&self, band: SeenBand<'_>, warnings: &mut Vec<Diagnostic>) {
        let is_zero = |index: usize| self.scaled[index] == 0.0;
        let Some(zero) = self.used(band).find(|&index| is_zero(index)) else { return };
        let before = (0..zero).rev().find(|&index| !is_zero(index));
        let after = (zero..self.scaled.len()).find(|&index| !is_zero(index));
        let is_far = |index: Option<usize>| index.is_some_and(|index| self.scaled[index] > NOISE);
        if is_far(before) && is_far(after) {
            let message = format!(
                "{} between values above {NOISE}, and band `{}` is made of it",
                self.place(zero),
                band.name
            );
            let help = "if 0 marks a deleted channel, take the row out";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
    }

    /// A mean of the points that a band sees.
    fn mean<E>(
        &self,
        band: SeenBand<'_>,
        mean: impl FnOnce(&[(f64, f64)]) -> Result<f64, E>,
    ) -> Result<f64, E> {
        let used = self.used(band);
        let points = self.table.points[used.clone()].iter().zip(&self.scaled[used]);
        let points: Vec<_> = points.map(|(point, &value)| (point.wavelength, value)).collect();
        mean(&points)
    }

    /// A mean of fractions, from 0 to 1.
    fn within_bounds(&self, mean: f64, band: SeenBand<'_>, warnings: &mut Vec<Diagnostic>) -> f64 {
        let taken = mean.clamp(0.0, 1.0);
        if !(0.0..=1.0).contains(&mean) {
            let message = format!(
                "the mean of {} in band `{}` is {mean:.6}: {taken} is taken",
                self.file, band.name
            );
            let help = "correct the table if that is not noise";
            warnings.push(Diagnostic::warning(&self.path, message).help(help));
        }
        taken
    }

    /// The error that a band reaches outside the table, with a unit in which it would not.
    fn outside(&self, band: SeenBand<'_>, unit: Option<WavelengthUnit>) -> Diagnostic {
        let points: Vec<_> =
            self.table.points.iter().map(|point| (point.wavelength, 0.0)).collect();
        let (low, high) = band.response.range();
        let message = match band.response.mean(&points) {
            Err(error) => format!("band `{}`: {error}", band.name),
            Ok(_) => format!("band `{}` reaches outside {}", band.name, self.file),
        };
        let other = WavelengthUnit::ALL.into_iter().filter(|_| unit.is_none()).find(|unit| {
            let ends = [points.first(), points.last()];
            let ends = ends.map(|end| end.map_or(f64::NAN, |end| unit.nanometres(end.0)));
            ends[0].min(ends[1]) <= low && high <= ends[0].max(ends[1])
        });
        let problem = Diagnostic::error(&self.path, message);
        match other {
            Some(unit) => problem.help(format!(
                "if the wavelengths of the table are in another unit, write `wavelength_unit: {}` beside \
                 `file`",
                unit.name()
            )),
            None => problem,
        }
    }
}
