//! Spectral bands and their responses.

use std::borrow::Cow;
use std::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

use super::super::decode::{Decode, Reader};
use super::super::describe::Book;
use super::super::diagnostic::{Diagnostic, suggestion};
use super::super::encode::Encode;
use super::super::leaves::Walk;
use super::super::path::ScenePath;
use super::super::ron_text::{Node, Text, Value};
use super::{BandSource, SpectrumFile};
use crate::spectral::{BandResponse, BandWindow, SensorBand, sensor_bands, sensor_names};

record! {
    /// A spectral band.
    pub struct Band ("a band") {
        /// Its name in all outputs.
        name: String => r#""red""#,
        /// Centre wavelength of `Box` and `Gaussian`, nm. Bands of curves have that of their centroid without it.
        center_nm: Option<f64> => "660.0" = None,
        /// Full width of `Box`, nm, 0 means the centre wavelength alone; full width at half maximum of `Gaussian`.
        width_nm: f64 = 0.0,
        /// Relative response to the wavelengths: values of the band are means weighted with it.
        response: Response = Response::Box,
        /// Sources of its radiance.
        source: BandSource = BandSource::Auto,
    }
}

choice! {
    /// Relative response of a band to the wavelengths. Irradiances are averaged with it; reflectances and
    /// transmittances in all but a `Box` with the product of it and the sun's irradiance, where that is a spectrum
    /// (`Constant` and `Bands` have no wavelengths): then reflectance times irradiance is what is reflected.
    pub enum Response ("a spectral response") {
        /// Alike from `center_nm - width_nm / 2` to `center_nm + width_nm / 2`.
        Box,
        /// Normal curve around `center_nm` whose full width at half maximum is `width_nm`.
        Gaussian,
        /// Points (wavelength nm, relative response), joined by straight lines; 0 beyond.
        Points(Vec<(f64, f64)> => "[(640.0, 0.0), (660.0, 1.0), (680.0, 0.0)]"),
        /// Points from a file, as those of a spectrum.
        Table(..SpectrumFile),
        /// A band of a sensor that sunfleck knows: their names.
        Sensor((String, String) => r#""Sentinel-2A MSI", "B4""#),
    }
}

choice! {
    /// Bands of a whole sensor, in place of a list.
    pub enum BandSet ("bands of a sensor") {
        /// Bands of a sensor that sunfleck knows, by its name and theirs; all of them if the list is empty. Published curves
        /// of `Sentinel-2A MSI`, `Sentinel-2B MSI`, `Landsat 5 TM`, `Landsat 7 ETM+`, `Landsat 8 OLI`, `Landsat 8 TIRS`,
        /// `Landsat 9 OLI-2`, `Landsat 9 TIRS-2`, `Terra MODIS`, `Aqua MODIS`, `Terra ASTER` and `RapidEye MSI`; nominal
        /// boxes of `Sentinel-2C MSI`; normal curves of `EnMAP HSI` (widths are approximate) and `PRISMA HYC`.
        Sensor((String, Vec<String>) => r#""Sentinel-2A MSI", ["B4", "B8A"]"#),
        /// Normal curves at even steps, named by their centres: `"700nm"`.
        Hyperspectral {
            /// Centre of the first band, nm.
            from_nm: f64 => "400.0",
            /// Centre of the last band, nm, or a little more.
            to_nm: f64 => "1000.0",
            /// Distance of centres, nm.
            step_nm: f64 => "10.0",
            /// Full width at half maximum, nm.
            fwhm_nm: f64 => "10.0",
        },
    }
}

/// Largest number of bands of `Hyperspectral`.
const MOST_BANDS: f64 = 65_536.0;

/// Spectral bands, in the order of all band lists: a list, or those of a [`BandSet`], which become a list when they are
/// read. Serde reads lists alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Bands(pub Vec<Band>);

/// Problem of a set of bands, and what to write instead.
struct SetProblem {
    message: String,
    help: String,
}

impl From<Vec<Band>> for Bands {
    fn from(bands: Vec<Band>) -> Self {
        Self(bands)
    }
}

impl Deref for Bands {
    type Target = [Band];

    fn deref(&self) -> &[Band] {
        &self.0
    }
}

impl DerefMut for Bands {
    fn deref_mut(&mut self) -> &mut [Band] {
        &mut self.0
    }
}

impl Decode for Bands {
    fn expected() -> Cow<'static, str> {
        "a list of bands, or those of a sensor".into()
    }

    fn example() -> String {
        Vec::<Band>::example()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [Vec::<Band>::schema(book), BandSet::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::List(_) => Self(Vec::decode(node, reader)),
            Value::Named(_) => BandSet::decode(node, reader).bands().map_or_else(
                |SetProblem { message, help }| {
                    if !message.is_empty() {
                        reader.error(node.head(reader.text()), message, Some(help));
                    }
                    reader.mark_broken();
                    Self::placeholder()
                },
                Self,
            ),
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        Self(Vec::new())
    }
}

impl Encode for Bands {
    fn encode(&self) -> Text {
        self.0.encode()
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        self.0.visit(walk);
    }
}

impl BandSet {
    fn bands(&self) -> Result<Vec<Band>, SetProblem> {
        match self {
            Self::Sensor((sensor, bands)) => {
                let known = known_bands(sensor)?;
                let all: Vec<String> = if bands.is_empty() {
                    known.iter().map(|band| band.name.clone()).collect()
                } else {
                    bands.clone()
                };
                let band = |name: &String| {
                    known_band(sensor, name)?;
                    let response = Response::Sensor((sensor.clone(), name.clone()));
                    Ok(Band { response, ..Band::new(name.clone()) })
                };
                all.iter().map(band).collect()
            }
            Self::Hyperspectral { from_nm, to_nm, step_nm, fwhm_nm } => {
                hyperspectral(*from_nm, *to_nm, *step_nm, *fwhm_nm)
            }
        }
    }
}

fn hyperspectral(from: f64, to: f64, step: f64, fwhm: f64) -> Result<Vec<Band>, SetProblem> {
    let is_range = from > 0.0 && to >= from && to.is_finite() && step > 0.0 && fwhm > 0.0;
    let steps = ((to - from) / step + 1e-9).floor();
    if !is_range || !fwhm.is_finite() || steps >= MOST_BANDS {
        let message = format!(
            "no bands from {from} to {to} nm, {step} nm apart and {fwhm} nm wide: wavelengths rise, all four numbers \
             are above 0, and there are at most {MOST_BANDS} bands"
        );
        let help = "write, for example, `Hyperspectral(from_nm: 400.0, to_nm: 1000.0, step_nm: 10.0, fwhm_nm: 10.0)`";
        return Err(SetProblem { message, help: help.to_owned() });
    }
    let band = |index: u32| {
        // Rounded, so that 400.1 + 3 × 0.1 is called 400.4.
        let center = ((from + step * f64::from(index)) * 1e6).round() / 1e6;
        let name = format!("{center}nm");
        Band {
            center_nm: Some(center),
            width_nm: fwhm,
            response: Response::Gaussian,
            ..Band::new(name)
        }
    };
    Ok((0..=steps as u32).map(band).collect())
}

fn known_bands(sensor: &str) -> Result<&'static [SensorBand], SetProblem> {
    sensor_bands(sensor).ok_or_else(|| {
        let known: Vec<&str> = sensor_names().collect();
        SetProblem {
            message: format!("no sensor `{sensor}`"),
            help: suggestion(sensor, &known, "known are"),
        }
    })
}

fn known_band(sensor: &str, band: &str) -> Result<&'static SensorBand, SetProblem> {
    let bands = known_bands(sensor)?;
    bands.iter().find(|known| known.name == band).ok_or_else(|| {
        let known: Vec<&str> = bands.iter().map(|band| band.name.as_str()).collect();
        SetProblem {
            message: format!("{sensor} has no band `{band}`"),
            help: suggestion(band, &known, "it has"),
        }
    })
}

impl Band {
    /// Centre wavelength, nm: as written, or that of the sensor; `None` if only a curve tells.
    #[must_use]
    pub fn nominal_nm(&self) -> Option<f64> {
        self.center_nm.or_else(|| match &self.response {
            Response::Sensor((sensor, band)) => {
                known_band(sensor, band).ok().map(|band| band.response.center())
            }
            Response::Box | Response::Gaussian | Response::Points(_) | Response::Table(_) => None,
        })
    }

    /// Its response, unless it stands in a file. `path` is that of the band.
    ///
    /// # Errors
    /// A sensor or a band that is not known, points that are no response, and a centre that is missing.
    pub fn known_response(
        &self,
        path: &ScenePath,
    ) -> Result<Option<BandResponse>, Box<Diagnostic>> {
        let error = |key: &'static str, message: String, help: &str| {
            Box::new(Diagnostic::error(path.key(key), message).help(help))
        };
        let center = || {
            let message = format!("band `{}` lacks the key `center_nm`", self.name);
            let help = "write, for example, `center_nm: 660.0`";
            self.center_nm.ok_or_else(|| error("center_nm", message, help))
        };
        let response = match &self.response {
            Response::Box => {
                BandResponse::Window(BandWindow { center: center()?, width: self.width_nm })
            }
            Response::Gaussian => BandResponse::gaussian(center()?, self.width_nm),
            Response::Points(points) => {
                let help =
                    "write, for example, `Points([(640.0, 0.0), (660.0, 1.0), (680.0, 0.0)])`";
                BandResponse::from_points(points.clone())
                    .map_err(|problem| error("response", problem.to_string(), help))?
            }
            Response::Sensor((sensor, band)) => {
                let band = known_band(sensor, band);
                band.map_err(|SetProblem { message, help }| error("response", message, &help))?
                    .response
                    .clone()
            }
            Response::Table(_) => return Ok(None),
        };
        Ok(Some(response))
    }
}
