//! Bands, sun and sky.

use std::fmt::Write as _;
use sunfleck::counts::counted;

use anyhow::{Context as _, Result};

use super::conf::{self, Node};
use super::optics::HOTTEST_K;
use super::project::Project;
use super::report::Report;
use super::settings::{Choice, Rule};
use super::swept::Swept;
use super::text::{list, quoted};

/// Irradiance of the sun outside the atmosphere, from 280 to 4000 nm.
pub(super) const SOLAR: &str = include_str!("../../../../scenes/spectra/sun_astm_g173.csv");
/// File that the importer writes it to.
pub(super) const SOLAR_FILE: &str = "assets/sun_astm_g173.csv";
/// Range of its wavelengths, nm.
const SOLAR_RANGE: (f64, f64) = (280.0, 4000.0);

/// Centre and width of a band, nm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    center: f64,
    width: f64,
}

/// Bands of a project that names none.
const USUAL_BANDS: &str = "600:10,900:10";

/// Wavelengths up to here surfaces on Earth emit nothing that is measured, nm.
const EMISSION_STARTS: f64 = 2500.0;

/// The bands of `sensor.bands`.
pub(super) fn bands(sensor: &Node, report: &Report) -> Result<Vec<Band>> {
    let Some(node) = sensor.get("bands") else {
        let what = format!("{USUAL_BANDS}, as LESS has it");
        report.assumed(&sensor.path_of("bands"), sensor.lack_of("bands"), what);
        return Ok(parsed(USUAL_BANDS).expect("the usual bands are a list of bands"));
    };
    let bands = parsed(&node.text()?).map_err(|part| {
        let part = super::text::excerpt(part.trim());
        node.wrong(&format!("{part:?} is not `centre:width` in nm"))
    })?;
    if bands.iter().any(|band| band.center < EMISSION_STARTS)
        && sensor.flag_of("thermal_radiation").unwrap_or(false)
    {
        let what = "thermal radiation alone: surfaces on Earth emit next to nothing below 2500 nm";
        report.differs(&node.path, &node.shown(), what);
    }
    Ok(bands)
}

/// The bands of a list, or the item that is none.
fn parsed(text: &str) -> Result<Vec<Band>, String> {
    let text = text.trim().trim_end_matches(',');
    let band = |item: &str| {
        let (center, width) = item.split_once(':').unwrap_or((item, "0"));
        let band = Band { center: conf::finite(center)?, width: conf::finite(width)? };
        let is_valid = band.center > 0.0 && band.width >= 0.0 && band.width < 2.0 * band.center;
        is_valid.then_some(band)
    };
    text.split(',').map(|item| band(item).ok_or_else(|| item.to_owned())).collect()
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

    /// Returns true if the bands lie in the table of the sun's irradiance.
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
        let zenith = swept.term(sun, "sun_zenith", &Rule::SUN_ZENITH, &self.report)?;
        let azimuth = swept.term(sun, "sun_azimuth", &Rule::SUN_AZIMUTH, &self.report)?;
        let mut text = format!("sun: (\nzenith_deg: {zenith},\nazimuth_deg: {azimuth},\n");
        let spectrum = sun.get("sun_spectrum");
        let direct = spectrum.map(|node| self.irradiance(node)).transpose()?;
        if let Some(direct) = &direct {
            writeln!(text, "irradiance: Bands({}),", list(direct))?;
        } else if self.needs_solar_table() {
            writeln!(text, "irradiance: Table(file: {SOLAR_FILE:?}),")?;
            let what =
                "the sun of ASTM G173-03 in place of LESS's own table; BRF does not depend on it";
            self.report.differs("illumination.sun", "", what);
        } else if !self.is_thermal {
            text += "irradiance: Constant(1.0),\n";
            let what = "bands beyond the sun's table: an irradiance of 1 W m⁻² nm⁻¹, so that \
                        radiances are relative; give `sun.irradiance`";
            self.report.differs("illumination.sun", "", what);
        }
        text += "),\n";
        if illumination.flag_of("sun_calculator")? {
            let what = "angles kept as stored; the calculator of LESS 1.8.8 took the next month";
            self.report.differs("illumination.sun_calculator", "true", what);
        }
        if let Some(parameters) = illumination.get("calculator_params") {
            let what = "the angles are imported; `sun.position: Spa(..)` computes them anew";
            self.report.left_out(&parameters.path, &parameters.shown(), what);
            parameters.settle();
        }
        let atmosphere = illumination.need("atmosphere")?;
        text += &match (spectrum, &direct) {
            (Some(spectrum), Some(direct)) => self.sky_spectrum(atmosphere, spectrum, direct)?,
            _ => self.sky_fraction(atmosphere, swept)?,
        };
        text += &self.thermal_sky(atmosphere)?;
        Ok(text)
    }

    /// The sky of a project that gives the irradiance of the sun in numbers.
    fn sky_spectrum(&self, atmosphere: &Node, spectrum: &Node, direct: &[f64]) -> Result<String> {
        for key in ["percentage", "ats_type"] {
            if let Some(node) = atmosphere.get(key) {
                self.report.unneeded(&node.path, &node.shown(), "spectra are given in its place");
                node.settle();
            }
        }
        let diffuse = if let Some(node) = atmosphere.get("sky_spectrum") {
            self.irradiance(node)?
        } else {
            let lack = atmosphere.lack_of("sky_spectrum");
            let what = "0 in each band, as LESS has it";
            self.report.assumed(&atmosphere.path_of("sky_spectrum"), lack, what);
            vec![0.0; direct.len()]
        };
        let is_dark = |(sun, sky): (&f64, &f64)| *sun <= 0.0 && *sky <= 0.0;
        if let Some(band) = direct.iter().zip(&diffuse).position(is_dark)
            && !self.is_thermal
        {
            let what = format!("neither sun nor sky lights band {}", band + 1);
            return Err(spectrum.wrong(&what));
        }
        Ok(if diffuse.iter().any(|&value| value > 0.0) {
            format!("sky: Isotropic(irradiance: Bands({})),\n", list(&diffuse))
        } else {
            String::new()
        })
    }

    /// The sky as a share of all light.
    fn sky_fraction(&self, atmosphere: &Node, swept: &mut Swept<'_>) -> Result<String> {
        let types = Choice { choices: &[("SKY_TO_TOTAL", ())], may_be_absent: true };
        types.read(atmosphere, "ats_type", &self.report)?;
        if let Some(node) = atmosphere.get("sky_spectrum") {
            self.report.unneeded(&node.path, &node.shown(), "there is no `sun_spectrum` beside it");
            node.settle();
        }
        let Some(node) = atmosphere.get("percentage") else {
            let what = "0 in each band, as LESS has it: no sky";
            let lack = atmosphere.lack_of("percentage");
            self.report.assumed(&atmosphere.path_of("percentage"), lack, what);
            return Ok(String::new());
        };
        let mut values = node.numbers()?;
        if let Some(wrong) = values.iter().find(|&share| !(0.0..=1.0).contains(share)) {
            return Err(node.wrong(&format!("{wrong} is not between 0 and 1")));
        }
        let (count, bands) = (values.len(), self.bands.len());
        if count != bands {
            let is_even = values.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq());
            if count > bands && !is_even {
                return Err(node.wrong(&format!(
                    "has {}, `sensor.bands` has {bands}",
                    counted(count, "value")
                )));
            }
            let what = match count {
                _ if count > bands => {
                    format!("the first {bands} of {count} values, which are equal")
                }
                _ => format!("0 in the bands after the first {count}, as LESS's window has it"),
            };
            self.report.differs(&node.path, &node.shown(), what);
            values.resize(bands, 0.0);
        }
        if bands == 1 && swept.varies(node.name()) {
            let rule = Rule::SHARE;
            return Ok(format!(
                "sky: Fraction([{}]),\n",
                swept.term(atmosphere, "percentage", &rule, &self.report)?
            ));
        }
        Ok(if values.iter().any(|&value| value > 0.0) {
            format!("sky: Fraction({}),\n", list(&values))
        } else {
            String::new()
        })
    }

    /// The scene's `thermal_sky`.
    fn thermal_sky(&self, atmosphere: &Node) -> Result<String> {
        let Some(node) = atmosphere.get("AtsTemperature") else {
            if self.is_thermal {
                let lack = atmosphere.lack_of("AtsTemperature");
                let what = "the sky emits nothing";
                self.report.assumed(&atmosphere.path_of("AtsTemperature"), lack, what);
            }
            return Ok(String::new());
        };
        let name = node.text()?;
        let mean = match conf::finite(&name) {
            Some(kelvin) if (0.0..=HOTTEST_K).contains(&kelvin) => kelvin,
            Some(kelvin) if self.is_thermal => {
                return Err(node.wrong(&format!("{kelvin} K is no temperature")));
            }
            None if self.is_thermal => self
                .materials
                .mean_temperature(&name)
                .with_context(|| format!("{}: {}", node.place, node.path))?,
            _ => {
                if let Ok(kelvin) = self.materials.mean_temperature(&name) {
                    kelvin
                } else {
                    self.report.unneeded(&node.path, &node.shown(), "no thermal radiation");
                    return Ok(String::new());
                }
            }
        };
        Ok(format!("thermal_sky: BlackBody({mean:?}),\n"))
    }

    /// Irradiances, one for each band.
    fn irradiance(&self, node: &Node) -> Result<Vec<f64>> {
        let values = node.numbers()?;
        if values.len() != self.bands.len() {
            let (values, bands) = (counted(values.len(), "value"), self.bands.len());
            return Err(node.wrong(&format!("has {values}, `sensor.bands` has {bands}")));
        }
        match values.iter().find(|value| **value < 0.0) {
            Some(wrong) => Err(node.wrong(&format!("{wrong} is not an irradiance of 0 or more"))),
            None => Ok(values),
        }
    }

    /// Number of visible bands.
    pub(super) fn visible_bands(&self) -> usize {
        self.bands.iter().filter(|band| (380.0..=780.0).contains(&band.center)).count()
    }
}
