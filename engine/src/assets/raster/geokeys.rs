//! Coordinate reference systems from the keys of a `GeoTIFF`. Source: OGC `GeoTIFF` 1.1 (OGC
//! 19-008r4), section 7.

use super::super::crs::{Axes, Crs, Heights, Length, UtmZone, from_code};

/// Keys by their numbers.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const CITATION: u16 = 1026;
const GEODETIC_CRS: u16 = 2048;
const GEODETIC_CITATION: u16 = 2049;
const PROJECTED_CRS: u16 = 3072;
const PROJECTED_CITATION: u16 = 3073;
const PROJECTION: u16 = 3074;
const LINEAR_UNIT: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
const VERTICAL_CRS: u16 = 4096;
const VERTICAL_UNIT: u16 = 4099;

/// Tags that hold values of keys.
const REALS: u16 = 34736;
const TEXTS: u16 = 34737;

/// A key whose value is written in another way than by a number of the registry.
const USER_DEFINED: u16 = 32767;

/// Keys of a file and the tags that hold their values.
#[derive(Debug, Default)]
pub(super) struct GeoKeys {
    pub(super) directory: Vec<u16>,
    pub(super) reals: Vec<f64>,
    pub(super) texts: String,
}

impl GeoKeys {
    /// Number, place of the value, count, value.
    fn entry(&self, key: u16) -> Option<[u16; 4]> {
        let entries = self.directory.chunks_exact(4).skip(1);
        entries.filter_map(|entry| entry.try_into().ok()).find(|entry: &[u16; 4]| entry[0] == key)
    }

    /// A number that stands in the directory itself; none for 0, "undefined".
    fn number(&self, key: u16) -> Option<u16> {
        let [_, place, _, value] = self.entry(key)?;
        (place == 0 && value != 0).then_some(value)
    }

    fn real(&self, key: u16) -> Option<f64> {
        let [_, place, _, index] = self.entry(key)?;
        (place == REALS).then(|| self.reals.get(usize::from(index)).copied()).flatten()
    }

    fn text(&self, key: u16) -> Option<&str> {
        let [_, place, count, start] = self.entry(key)?;
        let (start, end) = (usize::from(start), usize::from(start) + usize::from(count));
        let text = self.texts.get(start..end.min(self.texts.len()))?;
        let text = text.trim_end_matches(['|', '\0']).trim();
        (place == TEXTS && !text.is_empty()).then_some(text)
    }

    /// Returns whether coordinates are those of the centres of cells.
    pub(super) fn is_point(&self) -> bool {
        self.number(RASTER_TYPE) == Some(2)
    }

    /// The system, as far as the keys say.
    pub(super) fn crs(&self) -> Crs {
        let code = |key| self.number(key).filter(|code| *code != USER_DEFINED);
        let projected = code(PROJECTED_CRS).and_then(|code| from_code(code.into()));
        let geodetic = code(GEODETIC_CRS).and_then(|code| from_code(code.into()));
        let geographic = || Crs { axes: Axes::Degrees, ..self.named(GEODETIC_CITATION) };
        let mut crs = match self.number(MODEL_TYPE) {
            Some(2) => geodetic.unwrap_or_else(geographic),
            Some(3) => Crs { axes: Axes::Geocentric, ..self.named(GEODETIC_CITATION) },
            Some(1) => projected.unwrap_or_else(|| self.user_defined(geodetic.as_ref())),
            _ => projected.or(geodetic).unwrap_or_else(|| self.named(CITATION)),
        };
        self.set_unit(&mut crs);
        self.set_heights(&mut crs);
        crs
    }

    fn named(&self, key: u16) -> Crs {
        Crs::named(self.text(key).or_else(|| self.text(CITATION)).unwrap_or_default())
    }

    /// A projection that is described by its parts.
    fn user_defined(&self, geodetic: Option<&Crs>) -> Crs {
        // EPSG numbers the projection of UTM zones from 16001 in the north, from 16101 in the south.
        let zone = match self.number(PROJECTION) {
            Some(code @ 16001..=16060) => Some((code - 16000, false)),
            Some(code @ 16101..=16160) => Some((code - 16100, true)),
            _ => None,
        };
        let named = Crs { axes: Axes::Metres, ..self.named(PROJECTED_CITATION) };
        let Some((number, is_south)) = zone else {
            return named;
        };
        let datum = geodetic.and_then(|crs| match crs.code {
            Some(4326) => Some("WGS 84"),
            Some(4258) => Some("ETRS89"),
            Some(4269) => Some("NAD83"),
            Some(4267) => Some("NAD27"),
            Some(4230) => Some("ED50"),
            _ => None,
        });
        Crs::of_utm(UtmZone { number: number as u8, is_south }, datum)
    }

    /// Unit of the coordinates by its own keys, held against that of the system.
    fn set_unit(&self, crs: &mut Crs) {
        if matches!(crs.axes, Axes::Degrees | Axes::Geocentric) {
            return;
        }
        let unit = match self.number(LINEAR_UNIT) {
            Some(USER_DEFINED) => self
                .real(LINEAR_UNIT_SIZE)
                .map(|metres| Length { name: format!("unit of {metres} m"), metres }),
            Some(code) => {
                let unknown = || Length { name: format!("EPSG unit {code}"), metres: f64::NAN };
                Some(Length::from_code(code.into()).unwrap_or_else(unknown))
            }
            None => None,
        };
        let Some(unit) = unit else { return };
        let of_code = match (&crs.axes, crs.code) {
            (Axes::Metres, Some(_)) => Some(Length::metre()),
            (Axes::Length(of_code), Some(_)) => Some(of_code.clone()),
            (Axes::World, _) if unit.is_metre() => return,
            _ => None,
        };
        match of_code {
            Some(of_code) if (of_code.metres - unit.metres).abs() < 1e-5 * unit.metres => {}
            // Which of the two the coordinates are in cannot be known.
            Some(of_code) => {
                let name = format!(
                    "the unit {} by {}, but the unit {} by the unit's own key",
                    of_code.name, crs.name, unit.name
                );
                crs.axes = Axes::Length(Length { name, metres: f64::NAN });
            }
            None if unit.is_metre() => crs.axes = Axes::Metres,
            None => crs.axes = Axes::Length(unit),
        }
    }

    /// Unit of the heights: of its own key, or else of the vertical system.
    fn set_heights(&self, crs: &mut Crs) {
        let code = self.number(VERTICAL_CRS).filter(|code| *code != USER_DEFINED);
        if let Some(heights) = code.and_then(|code| from_code(code.into())?.heights) {
            crs.heights = Some(heights);
        }
        let unit = self.number(VERTICAL_UNIT).and_then(|code| Length::from_code(code.into()));
        if let Some(unit) = unit {
            let is_depth = crs.heights.as_ref().is_some_and(|heights| heights.is_depth);
            crs.heights = Some(Heights { unit, is_depth });
        }
    }
}
