//! Bands, sun and sky.

use std::fmt::Write as _;

use anyhow::{Context as _, Result};

use super::Project;
use super::conf::{self, Node};
use super::swept::Swept;
use super::text::{list, quoted};

/// Irradiance of the sun outside the atmosphere, from 280 to 4000 nm.
pub(super) const SOLAR: &str = include_str!("../../../scenes/spectra/sun_astm_g173.csv");
/// Where the importer puts it.
pub(super) const SOLAR_FILE: &str = "assets/sun_astm_g173.csv";
/// What it covers, nm.
const SOLAR_RANGE: (f64, f64) = (280.0, 4000.0);

/// Centre and width of a band, nm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    center: f64,
    width: f64,
}

/// The bands of `sensor.bands`.
pub(super) fn bands(sensor: &Node) -> Result<Vec<Band>> {
    let node = sensor.need("bands")?;
    let text = node.text()?;
    let band = |part: &str| {
        let (center, width) = part.split_once(':').unwrap_or((part, "0"));
        let band = Band { center: conf::finite(center)?, width: conf::finite(width)? };
        (band.center > 0.0 && band.width >= 0.0).then_some(band)
    };
    let read = |part: &str| {
        band(part).ok_or_else(|| node.wrong(&format!("{part:?} is not `centre:width` in nm")))
    };
    text.split(',').map(read).collect()
}

impl Project {
    /// The scene's `bands`.
    pub(super) fn bands_ron(&self) -> Result<String> {
        let mut text = "bands: [\n".to_owned();
        let mut names: Vec<String> = Vec::new();
        for Band { center, width } in &self.bands {
            let mut name = format!("{center}nm");
            if names.contains(&name) {
                name = format!("{name}_{}", names.len() + 1);
            }
            write!(text, "(name: {}, center_nm: {center:?}, width_nm: {width:?}", quoted(&name))?;
            text +=
                if self.is_thermal { ", source: Emission),\n" } else { ", source: Sunlight),\n" };
            names.push(name);
        }
        Ok(text + "],\n")
    }

    /// Whether the bands lie in the table of the sun's irradiance.
    pub(super) fn needs_solar_table(&self) -> bool {
        let (low, high) = SOLAR_RANGE;
        let lies_within = |band: &Band| {
            band.center - 0.5 * band.width >= low && band.center + 0.5 * band.width <= high
        };
        let is_given = self.conf.at(&["illumination", "sun", "sun_spectrum"]).is_some();
        !self.is_thermal && !is_given && self.bands.iter().all(lies_within)
    }

    /// The scene's `sun`, `sky` and `thermal_sky`.
    pub(super) fn light_ron(&self, swept: &mut Swept<'_>) -> Result<String> {
        let illumination = self.conf.need("illumination")?;
        let sun = illumination.need("sun")?;
        let zenith = sun.need("sun_zenith")?;
        let angle = zenith.number()?;
        if !(0.0..90.0).contains(&angle) {
            return Err(zenith.wrong(&format!("{angle}° is not from 0 to below 90")));
        }
        let mut text = "sun: (\n".to_owned();
        writeln!(text, "zenith_deg: {},", swept.term(zenith)?)?;
        writeln!(text, "azimuth_deg: {},", swept.term(sun.need("sun_azimuth")?)?)?;
        let spectrum = sun.get("sun_spectrum");
        if let Some(spectrum) = spectrum {
            writeln!(text, "irradiance: Bands({}),", list(&self.per_band(spectrum)?))?;
        } else if self.needs_solar_table() {
            writeln!(text, "irradiance: Table(file: {SOLAR_FILE:?}),")?;
            let what =
                "the sun of ASTM G173-03 in place of LESS's own table; BRF does not depend on it";
            self.report.add("illumination.sun", "", what);
        } else if !self.is_thermal {
            let what = "bands beyond the sun's table: an irradiance of 1; give `sun.irradiance`";
            self.report.add("illumination.sun", "", what);
        }
        text += "),\n";
        if let Some(calculator) = illumination.get("sun_calculator")
            && calculator.flag()?
        {
            let what = "angles kept as stored; the calculator of LESS 1.8.8 took the next month";
            self.report.add(&calculator.path, "true", what);
        }
        if let Some(parameters) = illumination.get("calculator_params") {
            let what = "not imported: the angles are; `sun.position: Spa(..)` computes them anew";
            self.report.add(&parameters.path, &parameters.shown(), what);
            parameters.settle();
        }
        let Some(atmosphere) = illumination.get("atmosphere") else { return Ok(text) };
        self.sky(atmosphere, spectrum.is_some(), &mut text, swept)?;
        Ok(text)
    }

    fn sky(
        &self,
        atmosphere: &Node,
        is_manual: bool,
        text: &mut String,
        swept: &mut Swept<'_>,
    ) -> Result<()> {
        if let Some(kind) = atmosphere.get("ats_type") {
            let name = kind.text()?;
            if name != "SKY_TO_TOTAL" {
                return Err(kind.wrong(&format!(
                    "{name:?} has no equal in sunfleck: choose SKY_TO_TOTAL and its percentages"
                )));
            }
        }
        let shares = atmosphere.get("percentage");
        if let Some(sky) = atmosphere.get("sky_spectrum").filter(|_| is_manual) {
            let values = self.per_band(sky)?;
            if values.iter().any(|&value| value > 0.0) {
                writeln!(text, "sky: Isotropic(irradiance: Bands({})),", list(&values))?;
            }
            if let Some(shares) = shares {
                shares.settle();
            }
        } else if let Some(shares) = shares {
            let values = self.per_band(shares)?;
            if let Some(wrong) = values.iter().find(|&share| !(0.0..=1.0).contains(share)) {
                return Err(shares.wrong(&format!("{wrong} is not between 0 and 1")));
            }
            if self.bands.len() == 1 && swept.varies(shares.name()) {
                writeln!(text, "sky: Fraction([{}]),", swept.term(shares)?)?;
            } else if values.iter().any(|&value| value > 0.0) {
                writeln!(text, "sky: Fraction({}),", list(&values))?;
            }
        }
        if let Some(node) = atmosphere.get("AtsTemperature") {
            let name = node.text()?;
            let mean = match conf::finite(&name) {
                Some(kelvin) => kelvin,
                None => {
                    self.materials.mean_temperature(&name).with_context(|| node.place.clone())?
                }
            };
            writeln!(text, "thermal_sky: BlackBody({mean:?}),")?;
        }
        Ok(())
    }

    /// A list with a value for each band.
    fn per_band(&self, node: &Node) -> Result<Vec<f64>> {
        let values = node.numbers()?;
        if values.len() != self.bands.len() {
            let (n, bands) = (values.len(), self.bands.len());
            let values = if n == 1 { "value" } else { "values" };
            return Err(node.wrong(&format!("has {n} {values}, `sensor.bands` has {bands}")));
        }
        Ok(values)
    }

    /// Bands in which a person sees.
    pub(super) fn visible_bands(&self) -> usize {
        self.bands.iter().filter(|band| (380.0..=780.0).contains(&band.center)).count()
    }
}
