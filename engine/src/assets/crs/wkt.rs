//! Well-known text of coordinate reference systems, version 1 (as GDAL and Esri write it) and 2.
//! Source: OGC 01-009 and OGC 18-010r7.

use super::compare::plain;
use super::{Axes, Crs, Heights, Length, UtmZone, from_code};

/// Longest text, bytes.
const LONGEST: usize = 1 << 16;

/// Deepest nesting of brackets.
const DEEPEST: usize = 32;

/// `NAME[value, value, OTHER[..]]`.
#[derive(Debug, Default)]
struct WktNode {
    name: String,
    /// Texts and numbers in order.
    values: Vec<String>,
    children: Vec<Self>,
}

impl WktNode {
    fn child(&self, names: &[&str]) -> Option<&Self> {
        self.children.iter().find(|child| names.contains(&child.name.as_str()))
    }

    fn text(&self) -> &str {
        self.values.first().map_or("", String::as_str)
    }

    fn number(&self) -> Option<f64> {
        self.values.get(1)?.parse().ok()
    }

    /// A number of the registry of EPSG.
    fn code(&self) -> Option<u32> {
        let id = self.child(&["AUTHORITY", "ID"])?;
        id.values.get(1)?.parse().ok()
    }

    /// Unit of the coordinates: that of the node, or else that of its first axis.
    fn unit(&self) -> Option<Length> {
        const UNITS: [&str; 2] = ["LENGTHUNIT", "UNIT"];
        let axis = || self.child(&["AXIS"]).and_then(|axis| axis.child(&UNITS));
        let unit = self.child(&UNITS).or_else(axis)?;
        let metres = unit.number()?;
        // The name of a unit may be anything; its length is what counts.
        let name = Length::from_name(unit.text())
            .filter(|known| (known.metres - metres).abs() < 1e-7 * metres)
            .map_or_else(|| unit.text().to_owned(), |known| known.name);
        Some(Length { name, metres })
    }

    /// Parameter of a projection by one of its names, letters and digits alone.
    fn parameter(&self, names: &[&str]) -> Option<f64> {
        let is_named = |node: &&Self| names.contains(&plain(node.text()).as_str());
        self.children.iter().filter(|node| node.name == "PARAMETER").find(is_named)?.number()
    }
}

/// The system that a text describes; `None` if it is no such text.
pub(crate) fn from_wkt(text: &str) -> Option<Crs> {
    let node = parse(text)?;
    let crs = system(&node)?;
    Some(Crs { wkt: Some(text.trim().to_owned()), ..crs })
}

fn system(node: &WktNode) -> Option<Crs> {
    let known = node.code().and_then(from_code);
    let named = Crs { code: node.code(), ..Crs::named(node.text()) };
    Some(match node.name.as_str() {
        "PROJCS" | "PROJCRS" | "PROJECTEDCRS" => projected(node, known, named),
        "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS" | "GEODCRS" | "GEODETICCRS" => {
            let is_geocentric = known.as_ref().is_some_and(|crs| crs.axes == Axes::Geocentric);
            let axes = if is_geocentric { Axes::Geocentric } else { Axes::Degrees };
            Crs { axes, ..known.unwrap_or(named) }
        }
        "GEOCCS" => Crs { axes: Axes::Geocentric, ..named },
        "COMPD_CS" | "COMPOUNDCRS" => {
            let mut parts = node.children.iter().filter_map(system);
            let first = parts.next()?;
            let heights = parts.find_map(|part| part.heights);
            Crs { heights, ..first }
        }
        "BOUNDCRS" => system(node.child(&["SOURCECRS"])?.children.first()?)?,
        "VERT_CS" | "VERTCS" | "VERTCRS" | "VERTICALCRS" => {
            let of_code = known.and_then(|crs| crs.heights);
            let axis = |node: &WktNode| node.values.get(1).map(|text| text.to_ascii_uppercase());
            let is_down = node.child(&["AXIS"]).and_then(axis).as_deref() == Some("DOWN");
            let is_depth = is_down || of_code.as_ref().is_some_and(|heights| heights.is_depth);
            let unit = node.unit().or(of_code.map(|heights| heights.unit));
            let heights = Heights { unit: unit.unwrap_or_else(Length::metre), is_depth };
            Crs { heights: Some(heights), ..named }
        }
        "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" => {
            let axes = node.unit().map_or(Axes::Unknown, axes_of);
            Crs { axes, code: None, ..named }
        }
        _ => return None,
    })
}

fn axes_of(unit: Length) -> Axes {
    if unit.is_metre() { Axes::Metres } else { Axes::Length(unit) }
}

fn projected(node: &WktNode, known: Option<Crs>, named: Crs) -> Crs {
    const METHODS: [&str; 2] = ["PROJECTION", "METHOD"];
    let base = node.child(&["GEOGCS", "BASEGEOGCRS", "BASEGEODCRS", "GEOGCRS"]);
    let datum = base.and_then(|base| base.child(&["DATUM", "ENSEMBLE"])).map(WktNode::text);
    let conversion = node.child(&["CONVERSION"]).unwrap_or(node);
    let method = conversion.child(&METHODS).map(|method| plain(method.text()));
    let method = method.unwrap_or_default();
    let is_cylindric = [
        "mercatorauxiliarysphere",
        "popularvisualisationpseudomercator",
        "mercator",
        "mercator1sp",
        "mercator2sp",
        "mercatorvarianta",
        "mercatorvariantb",
        "equidistantcylindrical",
        "equirectangular",
        "platecarree",
        "cylindricalequalarea",
        "lambertcylindricalequalarea",
        "millercylindrical",
    ]
    .contains(&method.as_str());
    let is_known_regional = known.as_ref().is_some_and(|crs| crs.axes != Axes::World);
    let mut crs = known.unwrap_or(named);
    if let Some(unit) = node.unit() {
        let is_world = crs.axes == Axes::World || is_cylindric && !is_known_regional;
        crs.axes = if is_world && unit.is_metre() { Axes::World } else { axes_of(unit) };
    }
    let utm = zone_of(conversion, &method, node.unit().map_or(1.0, |unit| unit.metres));
    if crs.utm.is_none() {
        crs.utm = utm.filter(|_| !matches!(crs.axes, Axes::World));
    }
    if crs.datum.is_none() {
        crs.datum = datum.map(|name| name.trim_start_matches("D_").replace('_', " "));
    }
    crs
}

/// Zone of UTM, by the numbers of the projection.
fn zone_of(conversion: &WktNode, method: &str, metres: f64) -> Option<UtmZone> {
    if !method.starts_with("transversemercator") && method != "gausskruger" {
        return None;
    }
    let near = |value: f64, wanted: f64| (value - wanted).abs() < 1e-6 * wanted.abs().max(1.0);
    let scale = conversion.parameter(&["scalefactor", "scalefactoratnaturalorigin"])?;
    let east = conversion.parameter(&["falseeasting"])? * metres;
    let north = conversion.parameter(&["falsenorthing"])? * metres;
    let origin =
        conversion.parameter(&["latitudeoforigin", "latitudeofnaturalorigin"]).unwrap_or(0.0);
    let meridian = conversion.parameter(&["centralmeridian", "longitudeofnaturalorigin"])?;
    let number = (meridian + 183.0) / 6.0;
    let is_utm = near(scale, 0.9996)
        && near(east, 500_000.0)
        && near(origin, 0.0)
        && (near(north, 0.0) || near(north, 1e7))
        && near(number, number.round())
        && (1.0..=60.0).contains(&number.round());
    is_utm.then(|| UtmZone { number: number.round() as u8, is_south: near(north, 1e7) })
}

fn parse(text: &str) -> Option<WktNode> {
    if text.len() > LONGEST {
        return None;
    }
    let text = text.trim_start_matches('\u{feff}').trim();
    let mut stack: Vec<WktNode> = Vec::new();
    let mut word = String::new();
    let mut letters = text.chars().peekable();
    let mut is_quoted = false;
    while let Some(letter) = letters.next() {
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                letters.next();
                word.push('"');
            }
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => word.push(letter),
            '[' | '(' => {
                if stack.len() == DEEPEST {
                    return None;
                }
                let name = std::mem::take(&mut word).trim().to_ascii_uppercase();
                stack.push(WktNode { name, ..WktNode::default() });
            }
            ',' | ']' | ')' => {
                let value = std::mem::take(&mut word);
                let node = stack.last_mut()?;
                if !value.trim().is_empty() {
                    node.values.push(value.trim().to_owned());
                }
                if letter != ',' {
                    let node = stack.pop()?;
                    match stack.last_mut() {
                        Some(parent) => parent.children.push(node),
                        None => return Some(node),
                    }
                }
            }
            _ => word.push(letter),
        }
    }
    None
}
