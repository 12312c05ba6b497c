//! Coordinate reference systems, as far as files say which one they use: the unit of coordinates and
//! heights, the zone of UTM, and whether two systems are the same.

mod compare;
mod name;
mod registry;
mod target;
mod wkt;

#[cfg(test)]
mod tests;

pub(crate) use compare::{Agreement, compare};
pub(crate) use name::from_name;
pub(crate) use registry::from_code;
pub use target::TargetSystem;
pub(crate) use wkt::from_wkt;

/// Coordinate reference system, as far as a file or a scene says.
#[derive(Clone, Debug, PartialEq)]
pub struct Crs {
    /// Name for messages, such as `EPSG:32632`.
    pub name: String,
    /// Number in the registry of EPSG, or of Esri where that is beyond.
    pub code: Option<u32>,
    /// Unit and kind of the coordinates.
    pub axes: Axes,
    /// Zone, if the projection is UTM.
    pub utm: Option<UtmZone>,
    /// Name of the geodetic datum, if it is known.
    pub datum: Option<String>,
    /// Unit and direction of its heights, if it says.
    pub heights: Option<Heights>,
    /// Well-known text, if the file holds it.
    pub wkt: Option<String>,
}

/// Unit and kind of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Axes {
    /// Metres east and north.
    Metres,
    /// Longitude and latitude.
    Degrees,
    /// East and north in another unit of length.
    Length(Length),
    /// Metres of a map of the whole world, such as Web Mercator, which are longer or shorter than
    /// those on the ground.
    World,
    /// Distances from the centre of the Earth.
    Geocentric,
    /// It does not say.
    Unknown,
}

/// Unit of length.
#[derive(Clone, Debug, PartialEq)]
pub struct Length {
    /// Name, such as `US survey foot`.
    pub name: String,
    /// Length, m.
    pub metres: f64,
}

/// Unit of heights and the direction in which they count.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Unit.
    pub unit: Length,
    /// True if they are depths, which count downwards.
    pub is_depth: bool,
}

/// Zone of UTM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UtmZone {
    /// Number, 1 to 60.
    pub number: u8,
    /// True if it lies south of the equator.
    pub is_south: bool,
}

impl Crs {
    /// A system of which only its name is known.
    #[must_use]
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            code: None,
            axes: Axes::Unknown,
            utm: None,
            datum: None,
            heights: None,
            wkt: None,
        }
    }

    /// Zone of UTM on a datum.
    #[must_use]
    pub fn of_utm(zone: UtmZone, datum: Option<&str>) -> Self {
        let name = match datum {
            Some(datum) => format!("{datum} / UTM zone {zone}"),
            None => format!("UTM zone {zone}"),
        };
        Self {
            axes: Axes::Metres,
            utm: Some(zone),
            datum: datum.map(str::to_owned),
            ..Self::named(name)
        }
    }
}

impl std::fmt::Display for UtmZone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.number, if self.is_south { "south" } else { "north" })
    }
}

impl Length {
    /// The metre.
    #[must_use]
    pub fn metre() -> Self {
        Self { name: "metre".to_owned(), metres: 1.0 }
    }

    /// Returns whether it is the metre.
    #[must_use]
    pub fn is_metre(&self) -> bool {
        (self.metres - 1.0).abs() < 1e-9
    }

    /// Unit by the name or abbreviation that files give it; `None` if it is no unit of length.
    #[must_use]
    pub fn from_name(text: &str) -> Option<Self> {
        let plain: String =
            text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
        let (name, metres) = match plain.as_str() {
            "m" | "metre" | "metres" | "meter" | "meters" => ("metre", 1.0),
            "ft" | "foot" | "feet" | "footinternational" | "internationalfoot"
            | "internationalfeet" | "ftint" | "footintl" | "feetintl" | "ift" => ("foot", 0.3048),
            "usft" | "ftus" | "ussurveyfoot" | "ussurveyfeet" | "footus" | "feetus" | "foot_us"
            | "usfoot" | "usfeet" | "surveyfoot" | "surveyfeet" | "ussft" | "sft" | "ftusa" => {
                ("US survey foot", 1200.0 / 3937.0)
            }
            "km" | "kilometre" | "kilometres" | "kilometer" | "kilometers" => ("kilometre", 1000.0),
            "dm" | "decimetre" | "decimetres" | "decimeter" | "decimeters" => ("decimetre", 0.1),
            "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => {
                ("centimetre", 0.01)
            }
            "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => {
                ("millimetre", 0.001)
            }
            "yd" | "yard" | "yards" => ("yard", 0.9144),
            "in" | "inch" | "inches" => ("inch", 0.0254),
            "fathom" | "fathoms" => ("fathom", 1.8288),
            "mi" | "mile" | "miles" => ("mile", 1609.344),
            _ => return None,
        };
        Some(Self { name: name.to_owned(), metres })
    }

    /// Unit by its number in the registry of EPSG; `None` if it is not known.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        let (name, metres) = match code {
            9001 => ("metre", 1.0),
            9002 => ("foot", 0.3048),
            9003 => ("US survey foot", 1200.0 / 3937.0),
            9005 => ("Clarke's foot", 0.304_797_265_4),
            9014 => ("fathom", 1.8288),
            9030 => ("nautical mile", 1852.0),
            9031 => ("German legal metre", 1.000_013_596_5),
            9033 => ("US survey chain", 79_200.0 / 3937.0),
            9034 => ("US survey link", 792.0 / 3937.0),
            9035 => ("US survey mile", 6_336_000.0 / 3937.0),
            9036 => ("kilometre", 1000.0),
            9037 => ("Clarke's yard", 0.914_391_796_2),
            9040 => ("British yard (Sears 1922)", 0.914_398_414_616_028_7),
            9041 => ("British foot (Sears 1922)", 0.304_799_471_538_676_2),
            9042 => ("British chain (Sears 1922)", 20.116_765_121_552_632),
            9080 => ("Indian foot", 0.304_799_510_248_146_94),
            9084 => ("Indian yard", 0.914_398_530_744_440_8),
            9093 => ("mile", 1609.344),
            9094 => ("Gold Coast foot", 0.304_799_710_181_508_8),
            9095 => ("British foot (1936)", 0.304_800_749_1),
            9096 => ("yard", 0.9144),
            9097 => ("chain", 20.1168),
            9098 => ("link", 0.201_168),
            1025 => ("millimetre", 0.001),
            1033 => ("centimetre", 0.01),
            _ => return None,
        };
        Some(Self { name: name.to_owned(), metres })
    }
}
