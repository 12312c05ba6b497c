//! GDAL's metadata of a band: scale, offset, unit and value for no data, in tag 42112 of a `GeoTIFF` and in
//! the `.aux.xml` beside a file. Source: GDAL's documentation of `GTiff` and PAM.

use super::super::crs::{Crs, Heights, Length, from_wkt};
use super::{Assumed, RasterError, is_no_data, is_usual_no_data, parse_no_data};

/// Metadata of a band.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BandMetadata {
    pub(super) no_data: Option<f64>,
    pub(super) scale: Option<f64>,
    pub(super) offset: Option<f64>,
    /// Unit of the values as it is written.
    pub(super) unit: Option<String>,
}

/// Transformation of the numbers in a file to values: `scale number + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// Factor on the numbers.
    pub scale: f64,
    /// Summand in the unit of the values.
    pub offset: f64,
}

impl BandMetadata {
    /// Metadata with another scaling, if there is one.
    pub(super) fn scaled(self, scaling: Option<Scaling>) -> Self {
        match scaling {
            Some(Scaling { scale, offset }) => {
                Self { scale: Some(scale), offset: Some(offset), ..self }
            }
            None => self,
        }
    }

    /// Reads what the text of tag 42112 says of a band, which is counted from 0.
    pub(super) fn from_tag(text: &str, sample: usize) -> Result<Self, RasterError> {
        let mut band = Self::default();
        for item in text.split("<Item ").skip(1) {
            let Some((attributes, rest)) = item.split_once('>') else { continue };
            let value = unescaped(rest.split('<').next().unwrap_or_default());
            let attribute = |name: &str| attribute(attributes, name);
            // Items without a band are those of the file, which the first band has.
            if attribute("sample").map_or(sample != 0, |text| text != sample.to_string()) {
                continue;
            }
            match attribute("role").as_deref() {
                Some("scale") => band.scale = Some(number("scale", &value)?),
                Some("offset") => band.offset = Some(number("offset", &value)?),
                Some("unittype") => band.unit = Some(value),
                _ => {}
            }
        }
        Ok(band)
    }

    /// Reads what the text of an `.aux.xml` says of a band, which is counted from 0, with the coordinate reference system
    /// that it names.
    pub(super) fn from_auxiliary(
        text: &str,
        index: usize,
    ) -> Result<(Self, Option<Crs>), RasterError> {
        let first = text.split("<PAMRasterBand").skip(1).find(|band| {
            let attributes = band.split('>').next().unwrap_or_default();
            let number = attribute(attributes, "band");
            number.map_or(index == 0, |number| number == (index + 1).to_string())
        });
        let band = first.and_then(|band| band.split("</PAMRasterBand>").next()).unwrap_or_default();
        let element = |name: &str| element(band, name);
        let real = |name: &'static str| element(name).map(|text| number(name, &text)).transpose();
        let no_data = element("NoDataValue");
        let no_data = no_data.map(|text| {
            parse_no_data(&text)
                .ok_or(RasterError::BadMetadata { what: "NoDataValue", found: text })
        });
        let band = Self {
            no_data: no_data.transpose()?,
            scale: real("Scale")?,
            offset: real("Offset")?,
            unit: element("UnitType"),
        };
        let head = text.split("<PAMRasterBand").next().unwrap_or_default();
        Ok((band, self::element(head, "SRS").and_then(|wkt| from_wkt(&wkt))))
    }

    /// This, and where it says nothing what the other one says.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            no_data: self.no_data.or(other.no_data),
            scale: self.scale.or(other.scale),
            offset: self.offset.or(other.offset),
            unit: self.unit.or(other.unit),
        }
    }

    /// Makes values of the numbers that a file holds: NaN where there is no data. Returns the most
    /// frequent of the values that stand for no data without being named.
    pub(super) fn apply(&self, values: &mut [f64]) -> Option<Assumed> {
        let (scale, offset) = (self.scale.unwrap_or(1.0), self.offset.unwrap_or(0.0));
        let is_plain = self.scale.is_none_or(|scale| scale.to_bits() == 1_f64.to_bits())
            && self.offset.is_none_or(|offset| offset.abs() == 0.0);
        let mut assumed: Vec<Assumed> = Vec::new();
        for value in values {
            if is_no_data(*value, self.no_data) {
                *value = f64::NAN;
            } else if is_usual_no_data(*value) {
                let is_same = |known: &Assumed| known.value.to_bits() == value.to_bits();
                match assumed.iter().position(is_same) {
                    Some(known) => assumed[known].count += 1,
                    None if assumed.len() < 16 => assumed.push(Assumed { value: *value, count: 1 }),
                    None => {}
                }
                *value = f64::NAN;
            } else if !is_plain {
                *value = *value * scale + offset;
            }
        }
        assumed.into_iter().max_by_key(|assumed| assumed.count)
    }

    /// Unit of heights: of the band, or else of the vertical system.
    pub(super) fn heights(&self, of_crs: Option<&Heights>) -> Result<Option<Heights>, RasterError> {
        let Some(unit) = self.unit.as_deref().and_then(Length::from_name) else {
            return Ok(of_crs.cloned());
        };
        let is_depth = of_crs.is_some_and(|heights| heights.is_depth);
        match of_crs {
            Some(heights) if (heights.unit.metres - unit.metres).abs() > 1e-5 * unit.metres => {
                let (one, other) = (unit.name, heights.unit.name.clone());
                Err(RasterError::TwoHeightUnits { one, other })
            }
            _ => Ok(Some(Heights { unit, is_depth })),
        }
    }
}

/// Names and wavelengths of all bands in tag 42112.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BandItems {
    /// Number of the band, name of the item and value.
    items: Vec<(usize, String, String)>,
}

impl BandItems {
    pub(super) fn from_tag(text: &str) -> Self {
        let item = |item: &str| {
            let (attributes, rest) = item.split_once('>')?;
            // GDAL escapes twice.
            let value = unescaped(&unescaped(rest.split('<').next()?));
            let sample = attribute(attributes, "sample")?.parse().ok()?;
            Some((sample, attribute(attributes, "name")?.to_lowercase(), value))
        };
        Self { items: text.split("<Item ").skip(1).filter_map(item).collect() }
    }

    fn get(&self, band: usize, name: &str) -> Option<&str> {
        let is_it = |item: &&(usize, String, String)| item.0 == band && item.1 == name;
        self.items.iter().find(is_it).map(|item| item.2.as_str())
    }

    pub(super) fn name(&self, band: usize) -> Option<String> {
        self.get(band, "description").map(str::to_owned)
    }

    /// Centre wavelength, nm: by GDAL's own item, in micrometres, or by that of ENVI files with its unit.
    pub(super) fn wavelength_nm(&self, band: usize) -> Option<f64> {
        let number = |name: &str| self.get(band, name)?.parse::<f64>().ok();
        let units = self.get(band, "wavelength_units").map(str::to_lowercase);
        match units.as_deref() {
            Some("nanometers") => number("wavelength"),
            Some("micrometers") => number("wavelength").map(|um| 1000.0 * um),
            _ => number("central_wavelength_um").map(|um| 1000.0 * um),
        }
    }
}

fn number(what: &'static str, text: &str) -> Result<f64, RasterError> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| RasterError::BadMetadata { what, found: text.to_owned() })
}

/// Value of an attribute in `name="value" name="value"`.
fn attribute(attributes: &str, name: &str) -> Option<String> {
    let (_, rest) = attributes.split_once(&format!("{name}=\""))?;
    Some(unescaped(rest.split('"').next()?))
}

/// Text of the first element of a name.
fn element(text: &str, name: &str) -> Option<String> {
    let opened = format!("<{name}");
    let mut rest = text;
    loop {
        (_, rest) = rest.split_once(&opened)?;
        if rest.starts_with(['>', ' ']) {
            break;
        }
    }
    let (_, rest) = rest.split_once('>')?;
    Some(unescaped(rest.split_once(&format!("</{name}>"))?.0.trim()))
}

fn unescaped(text: &str) -> String {
    text.replace("&quot;", "\"")
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&apos;", "'")
        .replace("&amp;", "&")
}
